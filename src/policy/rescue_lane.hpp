#pragma once

#include <map>

#include "policy/ask.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/cooperation.hpp"

namespace clearway::policy {

/// Settings of RescueLane.
struct RescueLaneConfig : AskSettings {
    double horizon_m = 300.0;
    double behind_m = 50.0;
    double slow_mps = 14.0;
    double least_limit_mps = 17.0;
    double signal_m = 600.0;
    double stagger_m = 60.0;
    /// They are apart when there is this much between them along the road; with the emergency vehicle
    /// beside the rear one, its own length more. Assumed: an ambulance of 6.5 m that steers round one after
    /// the other.
    static constexpr double apart_m = 12.0;
    /// One of them, or else the vehicle ahead of one, then drives at this share of its speed. Assumed: 1 m/s
    /// in a jam of 2 m/s.
    static constexpr double stagger_share = 0.5;
    double room_m = 0.4;
    /// The rescue lane moves between other lanes if that passes this many fewer vehicles that are not
    /// asked. Assumed: moving it takes longer than passing one.
    static constexpr double switch_worth = 2.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = RescueLaneConfig;
        using core::Field;
        table(
            Field{"horizon_m", "m", &C::horizon_m, 10.0, 2000.0, "The lane is opened this far ahead",
                  "as vacate_lane"},
            Field{"behind_m", "m", &C::behind_m, 0.0, 200.0,
                  "Vehicles whose fronts are up to this far behind the emergency vehicle's are asked, too",
                  "assumed: its own length, a truck that catches up beside it, and as much again"},
            Field{"slow_mps", "m/s", &C::slow_mps, 0.1, 60.0,
                  "If a vehicle ahead is slower than this, all vehicles are asked",
                  "50 km/h, assumed: faster traffic leaves a lane instead"},
            Field{"least_limit_mps", "m/s", &C::least_limit_mps, 0.0, 60.0,
                  "It stands back on roads with a lower limit",
                  "60 km/h, above the usual limit of towns: there, vehicles must change lanes to turn"},
            Field{"signal_m", "m", &C::signal_m, 0.0, 5000.0,
                  "It stands back while a signal on the emergency vehicle's route is this near, ahead or "
                  "passed; 0: never",
                  "twice horizon_m: who is asked has as far again to reach the lane for its turn"},
            Field{"stagger_m", "m", &C::stagger_m, 0.0, 500.0,
                  "Two vehicles abreast that leave too little room for the emergency vehicle are moved apart "
                  "within this distance; 0: never",
                  "assumed: it takes ten seconds"},
            Field{"room_m", "m", &C::room_m, 0.0, 2.0,
                  "Room that the emergency vehicle needs beside it, both sides together",
                  "as privilege.margin_m"},
            detail::lifetime_field<C>());
        AskSettings::fields(table);
    }
};

/// Before slow traffic on several lanes the vehicles of the leftmost lanes keep to the left edge of their
/// lanes and the others to the right edge, so that the emergency vehicle can drive between them
/// (privilege.between_lanes). It lies between the two leftmost lanes, or where fewer vehicles that are not
/// asked stand beside it. Vehicles beside or just behind the emergency vehicle keep to their edge too, or
/// they would hold it where it is; so do fast vehicles that approach the slow ones, or they would drive on
/// between the lanes. Two abreast that leave too little room, such as two trucks or two vehicles that are not
/// asked, would block it: one of them, or else the vehicle ahead of one, slows down until they are apart.
/// Needs the sublane model. It is for fast roads without signals. Elsewhere it stands back: vehicles that
/// keep to the edge of their lane cannot change lanes, and one that has to turn blocks the junction.
class RescueLane : public ConfiguredPolicy<RescueLaneConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "rescue_lane"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    /// Lowest lane number left of the rescue lane, counted from the leftmost lane: 0 is between the two
    /// leftmost lanes.
    std::map<core::VehicleKey, std::uint32_t> place_;
};

}  // namespace clearway::policy
