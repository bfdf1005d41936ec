#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.hpp"
#include "metrics/run_metrics.hpp"
#include "traffic/vehicle.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// How close vehicles near emergency vehicles come to rear-end collisions. It looks at pairs that follow each
/// other in one lane, lanes across junctions included, both of them within `near_m` of an emergency vehicle
/// or emergency vehicles themselves. Crossing paths are covered by the counts of collisions and red passages.
/// Pairs side by side in one lane (sublane model) are not conflicts.
///
/// With the gap g from front to rear bumper and the closing speed v, the time to collision is g / v and the
/// deceleration to avoid a crash is v^2 / (2 g) (SSAM's TTC and DRAC, at constant speeds).
class ConflictWatch {
  public:
    static constexpr float near_m = 100.0F;    ///< Assumed: about as far ahead as lanes are cleared in town.
    static constexpr float conflict_s = 1.5F;  ///< A shorter time to collision is a conflict (SSAM).

    /// One step; does not allocate once its buffers have grown.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster);

    /// Writes the least time to collision and the greatest deceleration, both empty if no vehicle closed in
    /// on another, and conflicts: a vehicle that stays below `conflict_s` for several steps is one.
    void describe(RunMetrics& metrics) const {
        metrics.emergency_least_ttc_s = least_ttc_s_;
        metrics.emergency_conflicts = conflicts_;
        metrics.emergency_greatest_drac_mps2 = greatest_drac_mps2_;
    }

  private:
    void find_near(const truth::Snapshot& snapshot);
    void judge(const truth::Snapshot& snapshot, const traffic::Roster& roster, core::VehicleIndex follower,
               core::VehicleIndex leader);
    void count_begun();

    std::optional<double> least_ttc_s_;
    std::optional<double> greatest_drac_mps2_;
    std::uint64_t conflicts_ = 0;
    std::vector<core::VehicleIndex> near_;
    std::vector<core::VehicleKey> in_conflict_;       ///< Sorted.
    std::vector<core::VehicleKey> were_in_conflict_;  ///< At the step before, sorted.
};

}  // namespace clearway::metrics::detail
