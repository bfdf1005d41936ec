#include "policy/listing_5_5.hpp"

#include <algorithm>
#include <cmath>

#include "policy/detail/view.hpp"

namespace clearway::policy {
namespace {

using detail::LeaseWriter;
using detail::View;

/// One vehicle whose links are examined.
struct Links {
    const View& view;
    const Listing55Config& config;
    core::VehicleIndex row;
};

bool is_linked_to(const Links& links, traffic::VehicleClass wanted,
                  core::LaneIndex lane = core::LaneIndex::none()) {
    const View& view = links.view;
    return std::ranges::any_of(view.belief().links_of(links.row), [&](const traffic::BelievedLink& link) {
        const traffic::BelievedVehicle& other = view.belief().vehicles[link.neighbour];
        return links.config.counts(link) && other.vehicle_class == wanted &&
               (!lane.exists() || other.state.lane == lane);
    });
}

/// `calculate_score` is not printed. Section 4.3: "For emergency vehicles, a high score is assigned";
/// automated vehicles are slowed by "neighborhood data", which we read as being linked to an emergency
/// vehicle. The listing passes position, speed and lane without stating their use.
double score(const Links& links) {
    const traffic::VehicleClass vehicle_class = links.view.belief().vehicles[links.row].vehicle_class;
    if (vehicle_class == traffic::VehicleClass::emergency) return 1.0;
    if (vehicle_class == traffic::VehicleClass::automated &&
        is_linked_to(links, traffic::VehicleClass::emergency))
        return -1.0;
    return 0.0;
}

bool can_change_in_graph(const Links& links, std::uint32_t number) {
    const View& view = links.view;
    const traffic::BelievedVehicle& vehicle = view.belief().vehicles[links.row];
    const core::EdgeIndex edge = *view.edge_of(vehicle);
    if (number >= view.network().edge(edge).lane_count) return false;
    const core::LaneIndex lane = view.network().lane_of(edge, number);
    return std::ranges::none_of(view.belief().links_of(links.row), [&](const traffic::BelievedLink& link) {
        const traffic::MotionState& other = view.belief().vehicles[link.neighbour].state;
        return links.config.counts(link) && other.lane == lane &&
               std::abs(other.lane_position_m - vehicle.state.lane_position_m) < links.config.room_m;
    });
}

/// Lane rules of the listing for emergency vehicles. We read "center" as the lane next to the middle of the
/// road and "outer" as one lane away from it. Defect: without an automated vehicle on its lane the emergency
/// vehicle leaves the centre lane as soon as it can and returns at the next call, so it swings between lanes
/// on an empty road.
void change_lanes(const Links& links, LeaseWriter& write) {
    const View& view = links.view;
    const traffic::BelievedVehicle& vehicle = view.belief().vehicles[links.row];
    const auto edge = view.edge_of(vehicle);
    if (!edge || view.network().edge(*edge).internal) return;
    const std::uint32_t number = view.lane_number(vehicle);
    const std::uint32_t centre = view.network().edge(*edge).lane_count - 1;
    const auto change_to = [&](std::uint32_t target, const char* reason) {
        write.add(vehicle.key, traffic::ChangeLane{target}, reason, vehicle.key);
    };
    if (is_linked_to(links, traffic::VehicleClass::automated, vehicle.state.lane)) {
        // Defect: also for an automated vehicle behind, and without checking that the outer lane is free.
        if (number > 0) change_to(number - 1, "automated vehicle on the same lane: outer lane");
    } else if (number != centre) {
        if (can_change_in_graph(links, number + 1)) change_to(number + 1, "not on the centre lane");
    } else if (number > 0 && can_change_in_graph(links, number - 1)) {
        change_to(number - 1, "on the centre lane: outer lane if necessary");
    }
}

}  // namespace

/// Differences from the printed listing: its loop variable is `id`, but the body reads `vehicle_id`, which is
/// never assigned, so that one vehicle would decide for all; here each vehicle is judged by itself. A raised
/// speed stays within what the vehicle is allowed, because no vehicle is asked to break a limit here.
///
/// Defects kept: 1.1 times 0 is 0, so an emergency vehicle that stands is told to stand; the speed of an
/// automated vehicle that stays linked shrinks by a factor of 0.8 per call towards a standstill; and no speed
/// is ever released. SUMO's setSpeed holds until released, so every set speed is renewed here as long as the
/// vehicle is known.
void Listing55::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const View view(context_.network, belief);
    LeaseWriter write("listing_5_5", context_.period, belief.time, leases, config_.lease_s);
    if (config_.has_sufficient_edges(belief)) {
        for (core::VehicleIndex row = 0; row < belief.vehicles.size(); ++row) {
            const traffic::BelievedVehicle& vehicle = belief.vehicles[row];
            const Links links{view, config_, row};
            const double points = score(links);
            const double now_mps = vehicle.state.speed_mps;
            if (points > config_.raise_above) {
                set_speed_mps_[vehicle.key] =
                    std::min(now_mps * config_.raise_factor, view.allowed_speed(vehicle).value);
            } else if (points < config_.lower_below) {
                set_speed_mps_[vehicle.key] = now_mps * config_.lower_factor;
            }
            if (vehicle.vehicle_class == traffic::VehicleClass::emergency) change_lanes(links, write);
        }
    }
    std::erase_if(set_speed_mps_, [&](const auto& entry) { return belief.find(entry.first) == nullptr; });
    for (const auto& [vehicle, speed_mps] : set_speed_mps_) {
        write.add(vehicle, traffic::DriveAt{core::MetresPerSecond(speed_mps)}, "score", {},
                  core::Seconds(config_.set_speed_lease_s));
    }
}

}  // namespace clearway::policy
