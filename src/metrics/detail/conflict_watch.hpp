#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.hpp"
#include "traffic/vehicle.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// How close vehicles near emergency vehicles come to running into the one ahead: pairs that follow each
/// other on one lane, lanes across junctions included, both within `near_m` of an emergency vehicle or one
/// themselves. Ways that cross are left to the counts of collisions and red passages; pairs side by side in
/// one lane (sublane model) are no conflict.
///
/// With the gap g from front to rear and the closing speed v: time to collision g / v, and deceleration to
/// avoid a crash v^2 / (2 g) (SSAM's TTC and DRAC, at constant speeds).
class ConflictWatch {
  public:
    static constexpr float near_m = 100.0F;    ///< Assumed: as far as clearing reaches in town.
    static constexpr float conflict_s = 1.5F;  ///< Times to collision below it are conflicts (SSAM).

    /// One step; does not allocate once its buffers have grown.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster);

    /// Least time to collision, s; nothing where nobody closed in on anybody.
    std::optional<double> least_ttc_s() const { return least_ttc_s_; }
    std::optional<double> greatest_drac_mps2() const { return greatest_drac_mps2_; }
    /// A vehicle that stays below `conflict_s` for several steps is one conflict.
    std::uint64_t conflicts() const { return conflicts_; }

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
