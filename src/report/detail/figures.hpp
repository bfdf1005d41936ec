#pragma once

#include <functional>
#include <vector>

#include "report/detail/writer.hpp"
#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {

inline constexpr double right_edge = 388.0;  ///< Of the drawing area; the rest keeps the last label inside.
inline constexpr double left_edge = 52.0;    ///< Room for the labels of y.
inline constexpr double label_space = 44.0;  ///< Below the drawing area.

inline NumberStyle typeset(int decimals, Sign sign = Sign::negative_only) {
    return {decimals, Script::typeset, sign};
}

/// A number, or the text for a missing one.
std::string cell(const std::optional<double>& value, NumberStyle style);

/// One figure per scenario.
std::vector<Figure> figures_of(const StudyFacts& study,
                               const std::function<Figure(const ScenarioFacts&)>& figure);

}  // namespace clearway::report::detail
