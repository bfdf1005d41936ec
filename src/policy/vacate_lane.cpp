#include "policy/vacate_lane.hpp"

#include "policy/detail/view.hpp"

namespace clearway::policy {
namespace {

using detail::LanePlan;
using detail::LeaseWriter;
using detail::VehicleAhead;
using detail::View;

class Vacating {
  public:
    Vacating(const View& view, const VacateLaneConfig& config, const traffic::BelievedVehicle& emergency,
             LeaseWriter& write)
        : view_(view),
          config_(config),
          emergency_(emergency),
          write_(write),
          ahead_(view.vehicles_ahead(emergency, core::Metres(config.horizon_m))),
          audience_(view.belief(), emergency.key, config),
          plan_({view, emergency, ahead_, audience_}, config, config.horizon_m) {}

    void ask() {
        if (ahead_.empty()) return;
        detail::follow(plan_, emergency_, config_.change_ahead_s, write_);
        for (const VehicleAhead& other : ahead_) {
            if (audience_.has(*other.vehicle)) ask(other);
        }
    }

  private:
    void ask(const VehicleAhead& other) {
        const traffic::BelievedVehicle& vehicle = *other.vehicle;
        if (!view_.is_on_route(vehicle) || view_.network().edge(*view_.edge_of(vehicle)).internal) return;
        const auto column = plan_.column_of(vehicle.state.lane);
        if (!column) return;
        if (column != plan_.column_at(other.distance_m)) {
            write_.add(vehicle.key, traffic::HoldLane{}, "stays out of an emergency vehicle's way",
                       emergency_.key);
        } else if (const auto target = view_.way_out(vehicle, ahead_, config_.side_room_m)) {
            write_.add(vehicle.key, traffic::ChangeLane{*target}, "in an emergency vehicle's way",
                       emergency_.key);
        }
    }

    const View& view_;
    const VacateLaneConfig& config_;
    const traffic::BelievedVehicle& emergency_;
    LeaseWriter& write_;
    std::vector<VehicleAhead> ahead_;
    Audience audience_;
    LanePlan plan_;
};

}  // namespace

void VacateLane::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const View view(context_.network, belief);
    LeaseWriter write("vacate_lane", context_.period, belief.time, leases, config_.lease_s);
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles())
        Vacating(view, config_, emergency, write).ask();
}

}  // namespace clearway::policy
