#pragma once

#include "policy/detail/gap_search.hpp"
#include "policy/part.hpp"

namespace clearway::policy {

/// Numbers of ClearLane.
struct ClearLaneConfig {
    /// Lanes are cleared this far ahead; (0, 1000]. 150 m: 300 m helped less in the merge scenario and cost
    /// others 2 to 7 % of time loss (measured when lanes were compared over 800 m).
    double horizon_m = 150.0;
    /// An automated vehicle at most this far behind the emergency vehicle's front opens a gap, >= 0; assumed:
    /// a gap of two cars.
    double beside_m = 20.0;
    /// At this share of the emergency vehicle's speed, or of that lane's where it keeps a gap open, (0, 1].
    double gap_factor = 0.8;
    double slowest_mps = 5.0;  ///< But not below, > 0; as the dissertation part.
    /// Where no gap is beside, the emergency vehicle falls back to one that gains this, >= 0; dense merge: 2
    /// s is no better.
    double gap_worth_s = 3.0;
    detail::Headways headways;   ///< A gap leaves these to both sides.
    double fall_back_mps = 5.0;  ///< Slower than that lane's traffic by at most this, > 0; 3 m/s helped less.
    double fall_back_s = 4.0;    ///< And by no more than leads to the gap in this time, > 0; assumed.
    /// An automated vehicle nearer behind such a gap keeps it open, >= 0; 90 m is no better.
    double keep_open_m = 60.0;
    /// Stretch over which lanes are compared, (0, 5000]. 1000 m: 800 m (with `worth_s` 1) cut the time loss
    /// of emergency vehicles at the sparse merge by 3 % less, at the dense one by 0.7 % more; 1200 m by 2 %
    /// more at the sparse one and at the others' cost.
    double choice_m = 1000.0;
    double halted_delay_s = 2.0;  ///< A standing vehicle ahead costs this much, >= 0; saturation headway.
    /// Delay by vehicles that will leave the lane counts only this much, [0, 1]; assumed.
    double automated_weight = 0.5;
    /// A lane must be this much faster for a change, >= 0. At 1 s it came only when whoever is ahead had
    /// slowed the emergency vehicle down already.
    double worth_s = 0.5;
};

/// Clears the lane of emergency vehicles: automated vehicles ahead on it leave it early, those on the
/// neighbouring lanes stay there, and one beside opens a gap when the emergency vehicle wants that lane. The
/// emergency vehicle takes the lane with the least delay ahead; where no gap is beside on a lane that gains
/// seconds it falls back to one, which an automated vehicle behind keeps open. Only lanes that continue are
/// used.
class ClearLane : public Part {
  public:
    explicit ClearLane(const PartContext& context, ClearLaneConfig config = {});

    std::string_view name() const override { return "clear_lane"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    PartContext context_;
    ClearLaneConfig config_;
};

}  // namespace clearway::policy
