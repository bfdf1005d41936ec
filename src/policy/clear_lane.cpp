#include "policy/clear_lane.hpp"

#include <algorithm>
#include <optional>

#include "policy/detail/gap_search.hpp"
#include "policy/detail/view.hpp"

namespace clearway::policy {
namespace {

using detail::LeaseWriter;
using detail::VehicleAhead;
using detail::View;

/// A neighbouring lane, and the time gained on it, s.
struct FasterLane {
    core::LaneIndex lane;
    double gain_s = 0.0;
};

/// Clears the way of one emergency vehicle.
class Way {
  public:
    Way(const View& view, const ClearLaneConfig& config, const traffic::BelievedVehicle& emergency,
        LeaseWriter& write)
        : view_(view),
          config_(config),
          emergency_(emergency),
          write_(write),
          audience_(view.belief(), emergency.key, config),
          route_(view.route_of(emergency.key)),
          ahead_(view.vehicles_ahead(emergency, core::Metres(std::max(config.horizon_m, config.choice_m)))) {}

    void clear() {
        if (const auto wanted = choose_lane()) {
            write_.add(emergency_.key, traffic::ChangeLane{view_.network().lane(wanted->lane).number},
                       "less delay ahead", emergency_.key);
            open_beside(wanted->lane);
            make_for_gap(*wanted);
        }
        for (const VehicleAhead& ahead : ahead_) {
            if (ahead.distance_m > config_.horizon_m) break;
            if (audience_.has(*ahead.vehicle)) ask(ahead);
        }
    }

  private:
    /// The lane `distance_m` ahead when the emergency vehicle starts on lane `start`.
    core::LaneIndex lane_at(core::LaneIndex start, double distance_m) const {
        traffic::MotionState state = emergency_.state;
        state.lane = start;
        return roads::advance(view_.network(), route_, state, core::Metres(distance_m)).state.lane;
    }

    void ask(const VehicleAhead& ahead) {
        const traffic::BelievedVehicle& vehicle = *ahead.vehicle;
        if (!view_.is_on_route(vehicle)) return;
        const roads::Lane& lane = view_.network().lane(vehicle.state.lane);
        if (view_.network().edge(lane.edge).internal) return;
        const core::LaneIndex ours = lane_at(emergency_.state.lane, ahead.distance_m);
        if (ours == vehicle.state.lane) {
            if (const auto target = view_.way_out(vehicle, ahead_, config_.side_room_m))
                write_.add(vehicle.key, traffic::ChangeLane{*target}, "ahead of an emergency vehicle",
                           emergency_.key);
        } else if (view_.network().lane(ours).edge == lane.edge) {
            write_.add(vehicle.key, traffic::HoldLane{}, "keeps out of an emergency vehicle's lane",
                       emergency_.key);
        }
    }

    /// Expected time over the next `choice_m` when starting on `lane`, s.
    double time_on(core::LaneIndex lane) const {
        const double free_mps = std::max(view_.allowed_speed(emergency_).value, config_.crawl_mps);
        const double free_s = config_.choice_m / free_mps;
        double behind_slowest_s = free_s;
        double standing_s = 0.0;
        for (const VehicleAhead& ahead : ahead_) {
            if (ahead.distance_m > config_.choice_m) break;
            const traffic::MotionState& state = ahead.vehicle->state;
            if (lane_at(lane, ahead.distance_m) != state.lane) continue;
            const bool leaves = ahead.vehicle->vehicle_class == traffic::VehicleClass::automated;
            const double weight = leaves ? config_.automated_weight : 1.0;
            if (state.speed_mps < config_.halted_mps) {
                standing_s += weight * config_.halted_delay_s;
                continue;
            }
            const double its_s =
                (config_.choice_m - ahead.distance_m) / std::max<double>(state.speed_mps, config_.crawl_mps);
            behind_slowest_s = std::max(behind_slowest_s, free_s + weight * std::max(0.0, its_s - free_s));
        }
        return behind_slowest_s + standing_s;
    }

    std::optional<FasterLane> choose_lane() const {
        const core::EdgeIndex edge = *view_.edge_of(emergency_);
        if (view_.network().edge(edge).internal) return std::nullopt;
        const double here_s = time_on(emergency_.state.lane);
        std::optional<FasterLane> best;
        double best_s = here_s - config_.worth_s;
        for (const std::uint32_t number : view_.usable_neighbours(emergency_)) {
            const core::LaneIndex lane = view_.network().lane_of(edge, number);
            const double there_s = time_on(lane);
            if (there_s < best_s) {
                best_s = there_s;
                best = FasterLane{lane, here_s - there_s};
            }
        }
        return best;
    }

    /// The nearest vehicle behind on the wanted lane drops back, if it is automated.
    void open_beside(core::LaneIndex wanted) {
        const traffic::BelievedVehicle* nearest = nullptr;
        for (const traffic::BelievedVehicle& vehicle : view_.belief().vehicles) {
            const double behind_m = emergency_.state.lane_position_m - vehicle.state.lane_position_m;
            if (vehicle.key == emergency_.key || vehicle.state.lane != wanted || behind_m < 0.0 ||
                behind_m > config_.beside_m)
                continue;
            if (nearest == nullptr || vehicle.state.lane_position_m > nearest->state.lane_position_m)
                nearest = &vehicle;
        }
        if (nearest == nullptr || !audience_.has(*nearest)) return;
        drive_at(*nearest, config_.gap_factor * emergency_.state.speed_mps, "opens a gap");
    }

    /// The emergency vehicle falls back to the nearest gap on the wanted lane if the lane gains enough; an
    /// automated vehicle behind the gap keeps it open.
    void make_for_gap(const FasterLane& wanted) {
        const detail::Headways headways{config_.usual_headway_s, config_.automated_headway_s};
        const auto gap = detail::nearest_gap(view_, emergency_, wanted.lane, headways);
        if (!gap || gap->shift_m >= 0.0 || gap->flow_mps < config_.slowest_mps) return;
        const double back_m = -gap->shift_m;
        if (wanted.gain_s - back_m / gap->flow_mps < config_.gap_worth_s) return;
        drive_at(emergency_, gap->flow_mps - std::min(config_.fall_back_mps, back_m / config_.fall_back_s),
                 "falls back to a gap");
        if (gap->behind == nullptr || !audience_.has(*gap->behind)) return;
        const double room_m = emergency_.state.lane_position_m - back_m - gap->behind->state.lane_position_m;
        if (room_m < config_.keep_open_m)
            drive_at(*gap->behind, config_.gap_factor * gap->flow_mps, "keeps a gap open");
    }

    void drive_at(const traffic::BelievedVehicle& vehicle, double speed_mps, const char* reason) {
        const double least_mps = std::max(speed_mps, config_.slowest_mps);
        const core::MetresPerSecond speed(std::min(least_mps, view_.allowed_speed(vehicle).value));
        write_.add(vehicle.key, traffic::DriveAt{speed}, reason, emergency_.key);
    }

    const View& view_;
    const ClearLaneConfig& config_;
    const traffic::BelievedVehicle& emergency_;
    LeaseWriter& write_;
    Audience audience_;
    roads::Route route_;
    std::vector<VehicleAhead> ahead_;
};

}  // namespace

void ClearLane::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const View view(context_.network, belief);
    LeaseWriter write("clear_lane", context_.period, belief.time, leases, config_.lease_s);
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        Way(view, config_, emergency, write).clear();
    }
}

}  // namespace clearway::policy
