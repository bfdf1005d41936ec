#pragma once

#include <cstdint>
#include <string>

#include "analysis/detail/pairing.hpp"
#include "analysis/estimate.hpp"
#include "traffic/command.hpp"

namespace clearway::analysis {

/// Vehicles of a condition by how they ended, over all complete runs.
struct OutcomeCounts {
    std::uint64_t arrived = 0;
    std::uint64_t running_at_end = 0;
    std::uint64_t teleported = 0;
    std::uint64_t not_inserted = 0;
    std::uint64_t removed = 0;

    OutcomeCounts& operator+=(const OutcomeCounts& more) {
        arrived += more.arrived;
        running_at_end += more.running_at_end;
        teleported += more.teleported;
        not_inserted += more.not_inserted;
        removed += more.removed;
        return *this;
    }
    std::uint64_t total() const { return arrived + lost(); }
    /// Those that did not arrive.
    std::uint64_t lost() const { return running_at_end + teleported + not_inserted + removed; }
    /// Of these, taken off the road: more time would not have let them arrive.
    std::uint64_t taken_off() const { return teleported + removed; }
};

/// Emergency vehicles of a run, by how they ended.
OutcomeCounts emergency_outcomes(const results::RunRecord& run);
/// All other vehicles, from the metrics, so their rows need not have been read.
OutcomeCounts other_outcomes(const results::RunRecord& run);

/// Reasons why a condition must not be called better than its baseline, or without effect, whatever the means
/// are. Verdicts, tables, curves, comparisons and gates all use this.
struct Objections {
    OutcomeCounts emergency;           ///< Over the replications that both have.
    OutcomeCounts baseline_emergency;  ///< Over the same replications.
    MaybeEstimate collisions;          ///< With emergency vehicles: surplus per run over the baseline.
    MaybeEstimate teleported;          ///< Other vehicles: surplus per run over the baseline.
    MaybeEstimate not_inserted;        ///< Likewise.
    bool unchecked = false;            ///< Ran without the simulator's safety checks.

    /// Whether it loses more than the baseline, in all or of those that were taken off the road. By number:
    /// one lost ambulance needs no interval.
    bool loses_emergency() const {
        return emergency.lost() > baseline_emergency.lost() ||
               emergency.taken_off() > baseline_emergency.taken_off();
    }
    /// Against any claim of a benefit for, or no effect on, emergency vehicles.
    bool on_emergency() const { return loses_emergency() || collisions || unchecked; }
    /// Against any claim of that kind about the other vehicles.
    bool on_others() const { return teleported || not_inserted || unchecked; }
};

/// `collisions`, `teleported` and `not_inserted` are set if the interval of the paired difference lies above
/// 0.
Objections objections_to(const detail::Runs& condition, const detail::Runs& baseline,
                         traffic::SafetyChecks safety_checks, double level = usual_level);

/// `lost 4 of 20 emergency vehicles (4 teleported; baseline 6 teleported)`, which need not be more than in
/// the baseline; empty if all arrived in both.
std::string lost_words(const Objections& objections);
/// `lost 13 of 20 emergency vehicles (13 teleported; baseline 0) and ran without safety checks`; empty if
/// there is no objection.
std::string emergency_objections(const Objections& objections);
/// `more other vehicles teleported (+3.2 per run [1.0, 5.4])`; empty if there is no objection.
std::string other_objections(const Objections& objections);
/// A short form for tables: `lost EVs`, `hit EVs`, `unchecked`; empty if there is no objection.
std::string emergency_objection_word(const Objections& objections);

}  // namespace clearway::analysis
