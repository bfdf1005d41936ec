#pragma once

#include <functional>
#include <vector>

#include "report/detail/writer.hpp"
#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {

constexpr NumberStyle typeset(int decimals, Sign sign = Sign::negative_only) {
    return {decimals, Script::typeset, sign};
}

/// `difference` where something is compared.
inline std::string estimate_or_nothing(const MaybeEstimate& difference, NumberStyle style,
                                       double factor = 1.0) {
    return difference ? estimate(difference, style, factor) : std::string();
}

/// One figure per scenario.
std::vector<Figure> figures_of(const StudyFacts& study,
                               const std::function<Figure(const ScenarioFacts&)>& figure);

}  // namespace clearway::report::detail
