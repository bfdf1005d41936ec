#pragma once

#include <vector>

#include "roads/route.hpp"

namespace clearway::roads {

/// The way ahead of one vehicle, walked once: its answer for any number of places is that of `distance_ahead`
/// for each of them, to the bit. A policy asks for all vehicles at each decision, and a walk for each of them
/// was 46 % of the instructions of the loop beside SUMO's (dense city, `corridor`).
class WayAhead {
  public:
    /// Throws as `distance_ahead` does. The network outlives the object. Allocates.
    WayAhead(const Network& network, Route route, const traffic::MotionState& state, core::Metres horizon);

    /// `distance_ahead` of the state to `other`. No allocation; cost: logarithmic in the lanes passed.
    std::optional<core::Metres> distance_to(const traffic::MotionState& other) const;

  private:
    /// An edge that is passed.
    struct Passed {
        core::EdgeIndex edge;
        std::uint32_t step = 0;  ///< Its place among the lanes passed.
        double start_m = 0.0;
    };
    /// A lane of a way across a junction that is passed, the way itself or another between the same edges.
    struct Inside {
        core::LaneIndex lane;
        std::uint32_t step = 0;   ///< Of the lane before the junction.
        double junction_m = 0.0;  ///< From the vehicle to the junction.
        double way_m = 0.0;       ///< From there to the start of the lane.
    };
    void add_junction(core::EdgeIndex from, core::EdgeIndex to, std::uint32_t step, double junction_m);
    std::optional<core::Metres> within(double distance_m) const;

    const Network& network_;
    double horizon_m_;
    std::vector<Passed> passed_;  ///< By edge, then in the order of driving.
    std::vector<Inside> inside_;  ///< By lane, then in the order of driving.
};

}  // namespace clearway::roads
