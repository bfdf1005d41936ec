#pragma once

#include "core/fields.hpp"
#include "policy/ask.hpp"
#include "policy/configured_policy.hpp"

namespace clearway::policy {

/// Settings of ClearLane.
struct ClearLaneConfig : AskSettings {
    double horizon_m = 150.0;
    double beside_m = 20.0;
    double gap_factor = 0.8;
    double slowest_mps = 5.0;
    double gap_worth_s = 3.0;
    double usual_headway_s = 1.0;
    double automated_headway_s = 0.5;
    double fall_back_mps = 5.0;
    double fall_back_s = 4.0;
    double keep_open_m = 60.0;
    double choice_m = 1000.0;
    double halted_mps = 0.5;
    double halted_delay_s = 2.0;
    double automated_weight = 0.5;
    double worth_s = 0.5;
    double crawl_mps = 1.0;
    double side_room_m = 12.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = ClearLaneConfig;
        using core::Field;
        table(
            Field{"horizon_m", "m", &C::horizon_m, 1.0, 1000.0, "Lanes are cleared this far ahead",
                  "trials at the merge: 300 m helps less and costs others more"},
            Field{"beside_m", "m", &C::beside_m, 0.0, 100.0,
                  "An automated vehicle at most this far behind the emergency vehicle's front opens a gap",
                  "assumed: a gap of two cars"},
            Field{"gap_factor", "1", &C::gap_factor, 0.1, 1.0,
                  "It drives at this share of the emergency vehicle's speed, or of its lane's speed when it "
                  "keeps a gap open",
                  "as the dissertation policy"},
            Field{"slowest_mps", "m/s", &C::slowest_mps, 0.1, 30.0, "But no slower than this",
                  "as the dissertation policy: faster than a queue, slower than a street"},
            Field{"gap_worth_s", "s", &C::gap_worth_s, 0.0, 60.0,
                  "If there is no gap alongside, the emergency vehicle falls back to one when the lane gains "
                  "this",
                  "trials at the dense merge: 2 s is no better"},
            Field{"usual_headway_s", "s", &C::usual_headway_s, 0.1, 5.0,
                  "Headway that a gap must leave to the vehicles ahead and behind",
                  "Intelligent Driver Model"},
            Field{"automated_headway_s", "s", &C::automated_headway_s, 0.1, 5.0,
                  "The same to an automated vehicle behind, which is asked to make more room",
                  "assumed: half"},
            Field{"fall_back_mps", "m/s", &C::fall_back_mps, 0.1, 20.0,
                  "The emergency vehicle falls back by at most this relative to that lane's traffic",
                  "trials: 3 m/s helps less"},
            Field{"fall_back_s", "s", &C::fall_back_s, 0.5, 60.0,
                  "And only as fast as needed to reach the gap in this time", "assumed"},
            Field{"keep_open_m", "m", &C::keep_open_m, 0.0, 500.0,
                  "An automated vehicle less than this behind such a gap keeps it open",
                  "trials: 90 m is no better"},
            Field{"choice_m", "m", &C::choice_m, 1.0, 5000.0, "Stretch over which lanes are compared",
                  "trials at the merge: 800 m helps less in sparse traffic, 1200 m costs others more"},
            Field{"halted_mps", "m/s", &C::halted_mps, 0.0, 5.0, "A slower vehicle counts as standing",
                  "assumed: walking pace is 1.4 m/s"},
            Field{"halted_delay_s", "s", &C::halted_delay_s, 0.0, 60.0,
                  "Delay caused by each vehicle that stands ahead", "saturation headway"},
            Field{"automated_weight", "1", &C::automated_weight, 0.0, 1.0,
                  "Weight of the delay caused by automated vehicles, which will leave the lane", "assumed"},
            Field{"worth_s", "s", &C::worth_s, 0.0, 60.0, "Time that a lane must gain for a lane change",
                  "at 1 s the EV changed lanes only after the vehicle ahead had slowed it down"},
            Field{"crawl_mps", "m/s", &C::crawl_mps, 0.1, 10.0,
                  "A slower vehicle counts as this fast when times are compared",
                  "assumed: keeps the times finite"},
            Field{"side_room_m", "m", &C::side_room_m, 0.0, 100.0,
                  "Vehicles closer than this along the road cannot move into the same lane side by side",
                  "assumed: two cars"},
            detail::lifetime_field<C>());
        AskSettings::fields(table);
    }
};

/// Clears the lane of emergency vehicles: automated vehicles ahead on it leave it early, those on the
/// neighbouring lanes stay there, and one alongside opens a gap when the emergency vehicle wants that lane.
/// The emergency vehicle takes the lane with the least delay ahead. If a lane gains seconds but has no gap
/// alongside, it falls back to a gap, which an automated vehicle behind keeps open. Only lanes that continue
/// are used. With `ask=linked`, automated vehicles are asked only where the believed graph links them with
/// the emergency vehicle; its own choice of lane reads places, as it needs nobody's help.
class ClearLane : public ConfiguredPolicy<ClearLaneConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "clear_lane"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;
};

}  // namespace clearway::policy
