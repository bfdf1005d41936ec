#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/estimate.hpp"
#include "analysis/summary.hpp"
#include "core/spellings.hpp"
#include "results/analysis_plan.hpp"

namespace clearway::analysis {

/// What a planned comparison has shown.
enum class Shown : std::uint8_t {
    better,      ///< A difference was claimed, and the condition takes less time.
    worse,       ///< A difference was claimed, and the condition takes more time.
    equivalent,  ///< Equivalence was claimed, and the whole interval lies within the margin.
    not_shown,   ///< The claim does not follow from the data. It is not refuted either.
    ruled_out,   ///< The condition loses more emergency vehicles than the other one.
    incomplete,  ///< Runs are missing or failed: the plan's pairs are not all there.
};
constexpr core::Spellings<Shown, 6> spellings(Shown) {
    return {{{Shown::better, "better"},
             {Shown::worse, "worse"},
             {Shown::equivalent, "equivalent"},
             {Shown::not_shown, "not_shown"},
             {Shown::ruled_out, "ruled_out"},
             {Shown::incomplete, "incomplete"}}};
}
using core::name;

/// One comparison of a plan in one scenario: condition - against, paired by replication.
struct PlannedFinding {
    results::PlannedComparison comparison;
    std::string scenario;
    std::size_t pairs = 0;         ///< Complete ones.
    MaybeEstimate difference;      ///< With an interval of the level 1 - alpha, for itself.
    std::optional<double> p;       ///< Paired t; of equivalence: the two one-sided tests.
    std::optional<double> holm_p;  ///< Adjusted over all findings of the plan.
    double margin_s = 0.0;         ///< For equivalence; the greater of both parts of the plan's margin.
    Shown shown = Shown::incomplete;
};

/// The findings of a study's plan: each comparison in each of its scenarios, in the order of the plan. Empty
/// without a plan. A comparison with missing runs keeps its place in Holm's adjustment, with a p of 1.
std::vector<PlannedFinding> planned_findings(const Summary& summary);

}  // namespace clearway::analysis
