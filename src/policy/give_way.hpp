#pragma once

#include <map>
#include <utility>

#include "policy/ask.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/cooperation.hpp"

namespace clearway::policy {

/// Settings of GiveWay.
struct GiveWayConfig : AskSettings {
    double lead_s = 6.0;
    /// And this much earlier per vehicle that stands ahead of it. Saturation headway.
    static constexpr double lead_per_halted_s = 2.0;
    /// But no earlier than this. Assumed.
    static constexpr double longest_lead_s = 20.0;
    double horizon_m = 300.0;
    double near_m = 60.0;
    /// A slower vehicle counts as standing. Assumed: walking pace is 1.4 m/s.
    static constexpr double halted_mps = 0.5;
    /// Arrival is estimated with at least this speed. Assumed: a standing queue moves once it has the way.
    static constexpr double slowest_mps = 5.0;
    double longest_s = 30.0;
    double fastest_road_mps = 17.0;
    double lease_s = 2.0;

    static constexpr void fields(const auto& table) {
        using C = GiveWayConfig;
        using core::Field;
        table(
            Field{
                "lead_s", "s", &C::lead_s, 0.0, 60.0,
                "Vehicles with right of way are asked from this long before the emergency vehicle's arrival",
                "as hold_cross"},
            Field{"horizon_m", "m", &C::horizon_m, 1.0, 2000.0,
                  "Junctions farther away than this are ignored", "assumed: the longest lead at 15 m/s"},
            Field{"near_m", "m", &C::near_m, 1.0, 500.0,
                  "Vehicles closer than this to the junction are asked",
                  "assumed: more than the usual braking distance in towns"},
            Field{"longest_s", "s", &C::longest_s, 1.0, 600.0,
                  "Longest time that a junction is kept free for one emergency vehicle, and that a vehicle "
                  "is asked to stand",
                  "assumed"},
            Field{"fastest_road_mps", "m/s", &C::fastest_road_mps, 1.0, 50.0,
                  "No vehicle is asked to stop on roads with a higher limit",
                  "60 km/h, above the usual limit of towns: on faster roads drivers do not expect a vehicle "
                  "to stop"},
            detail::lifetime_field<C>());
        AskSettings::fields(table);
    }
};

/// At junctions without signals where an emergency vehicle must yield, vehicles with right of way stop
/// before the junction until it has passed, and with them all vehicles behind. The queue ahead of the
/// emergency vehicle then goes, too. No vehicle is asked to stop in a roundabout, nor ahead of an emergency
/// vehicle.
class GiveWay : public ConfiguredPolicy<GiveWayConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "give_way"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    /// An emergency vehicle and the edge by which it comes to a junction.
    using Passage = std::pair<core::VehicleKey, core::EdgeIndex>;

    bool is_early(const detail::View& view, const traffic::BelievedVehicle& emergency,
                  double distance_m) const;

    // When the first of the requests was made that still go on.
    std::map<Passage, double> kept_free_s_;
    std::map<core::VehicleKey, double> held_s_;
};

}  // namespace clearway::policy
