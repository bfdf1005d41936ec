#pragma once

#include "policy/detail/gap_search.hpp"
#include "policy/part.hpp"

namespace clearway::policy {

/// Numbers of ClearLane.
struct ClearLaneConfig {
    /// Lanes are cleared this far ahead; (0, 1000]. 150 m: in the merge scenario 300 m helped less and cost
    /// others 2 to 7 % of time loss, 150 m nothing.
    double horizon_m = 150.0;
    double beside_m = 20.0;    ///< An automated vehicle at most this far behind the emergency vehicle's front
                               ///< opens a gap; assumed: a gap of two cars.
    double gap_factor = 0.8;   ///< By driving at this share of the emergency vehicle's speed, (0, 1].
    double slowest_mps = 5.0;  ///< But not below; as the dissertation part.
    /// Where no gap is beside, the emergency vehicle falls back to one that gains this; dense merge: 2 s is
    /// no better.
    double gap_worth_s = 3.0;
    detail::Headways headways;   ///< A gap leaves these to both sides.
    double fall_back_mps = 5.0;  ///< Slower than the traffic of that lane by at most this; 3 m/s helped less.
    double fall_back_s = 4.0;    ///< And by no more than leads to the gap in this time; assumed.
    /// An automated vehicle nearer behind such a gap keeps it open, by `gap_factor`; 90 m is no better.
    double keep_open_m = 60.0;
    /// Stretch over which lanes are compared, (0, 5000]. 1000 m: 800 m cut the time loss of emergency
    /// vehicles at the sparse merge by 3 % less; 1200 m by 2 % more there and less at the dense one.
    double choice_m = 1000.0;
    double halted_delay_s = 2.0;  ///< A standing vehicle ahead costs this much; saturation headway.
    double automated_weight =
        0.5;  ///< Delay by vehicles that will leave the lane counts only this much, [0, 1]; assumed.
    /// A lane must be this much faster for a change. 1 s: changed when already slowed down by who is ahead.
    double worth_s = 0.5;
};

/// Clears the lane of emergency vehicles: automated vehicles ahead on it leave it early, those on the
/// neighbouring lanes stay there, and one beside opens a gap when the emergency vehicle wants that lane. The
/// emergency vehicle takes the lane with the least delay ahead. Only lanes that continue are used.
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
