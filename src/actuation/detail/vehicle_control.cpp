#include "actuation/detail/vehicle_control.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "actuation/detail/stop_line.hpp"
#include "roads/exits.hpp"
#include "roads/route.hpp"
#include "roads/route_search.hpp"

namespace clearway::actuation::detail {
namespace {

using traffic::Refusal;

/// A lease may exceed the allowed speed by this much, m/s, because of rounding. The command does not.
constexpr double speed_tolerance_mps = 0.01;
/// Smaller changes of speed are not sent, m/s.
constexpr double speed_resolution_mps = 1e-3;
/// Longest single lane request, s: if a request outlives its lease by a fault, it does not bind the vehicle
/// longer (3 s: found in first trials).
constexpr double longest_lane_request_s = 3.0;
/// A lane request is renewed when it has less than this left, s: longer than the longest step (1 s).
constexpr double prolong_lane_request_s = 1.5;
/// Longest stop beside the road, s, if its end should get lost by a fault; longer than any lease.
constexpr double longest_stop_s = 600.0;
/// A vehicle off the road for longer than this does not come back, s.
constexpr double longest_absence_s = 600.0;

bool is_best_or_long(const truth::LaneOutlook& outlook) {
    return outlook.best_offset == 0 || outlook.drivable_m > roads::worth_following.value;
}

/// Way to a stop with the usual deceleration that begins in the next step, m.
double braking_m(const VehicleContext& around, core::VehicleIndex row, const traffic::VehicleInfo& info) {
    const double speed_mps = around.snapshot.speed_mps[row];
    return speed_mps * speed_mps / (2.0 * info.deceleration_mps2) + speed_mps * around.step.value;
}

bool is_closed(std::span<const core::EdgeIndex> way, std::span<const traffic::KnownIncident> incidents) {
    return std::ranges::any_of(way, [&](core::EdgeIndex edge) { return traffic::closes(incidents, edge); });
}

/// Whether the vehicle can still turn into `next` at the end of its edge: it could stop before the junction,
/// and has room for the changes of lane.
bool can_turn(const VehicleContext& around, core::VehicleIndex row, const traffic::VehicleInfo& info,
              core::EdgeIndex next) {
    constexpr double lane_change_m = 30.0;  // assumed: 2 to 3 s at 50 km/h
    const roads::Lane& own = around.network.lane(around.snapshot.lane[row]);
    const roads::Edge& edge = around.network.edge(own.edge);
    std::optional<std::uint32_t> fewest;
    for (std::uint32_t lane = edge.first_lane; lane < edge.first_lane + edge.lane_count; ++lane) {
        const auto exits = roads::exits(around.network, core::LaneIndex{lane}, roads::Driver::emergency);
        const bool leads = std::ranges::binary_search(exits, next);
        const std::uint32_t number = lane - edge.first_lane;
        const std::uint32_t changes = number > own.number ? number - own.number : own.number - number;
        if (leads) fewest = std::min(fewest.value_or(changes), changes);
    }
    const double left_m = own.length_m - around.snapshot.lane_position_m[row];
    return fewest && left_m > braking_m(around, row, info) + lane_change_m * *fewest;
}

}  // namespace

bool VehicleSettings::is_default() const {
    return !speed && !lane && freedom == traffic::LaneChangeFreedom::normal &&
           alignment == traffic::LateralAlignment::usual && privilege == traffic::JunctionPrivilege::none &&
           checks == traffic::SafetyChecks::on && !beside_road && !line;
}

VehicleControl::Channel VehicleControl::channel_of(const traffic::Action& action) {
    assert(!std::holds_alternative<traffic::HoldGreen>(action));
    assert(!std::holds_alternative<traffic::AdjustGreen>(action));
    if (std::holds_alternative<traffic::DriveAt>(action) ||
        std::holds_alternative<traffic::StopAtLine>(action))
        return speed;
    if (std::holds_alternative<traffic::TakeRoute>(action)) return way;
    return std::holds_alternative<traffic::PassRed>(action) ? privilege : lateral;
}

void VehicleControl::offer(const traffic::Lease& lease, Ledger& ledger) {
    assert(lease.target == traffic::Target(vehicle_));
    queues_[channel_of(lease.action)].offer(lease, ledger);
}

std::size_t VehicleControl::active() const {
    std::size_t sum = 0;
    for (const LeaseQueue& queue : queues_)
        sum += queue.size();
    return sum;
}

bool VehicleControl::is_idle(core::Seconds now) const {
    if (active() > 0) return false;
    return applied_.is_default() || (away_since_ && (now - *away_since_).value > longest_absence_s);
}

void VehicleControl::drop_all(Refusal reason, Ledger& ledger) {
    for (LeaseQueue& queue : queues_)
        queue.drop_all(reason, ledger);
}

void VehicleControl::step(const VehicleContext& around, Ledger& ledger,
                          std::vector<traffic::Command>& commands) {
    const core::Seconds now = around.snapshot.time;
    for (LeaseQueue& queue : queues_)
        queue.expire(now, ledger);
    const auto row = around.snapshot.row_of(vehicle_);
    const traffic::VehicleInfo* info = around.roster.find(vehicle_);
    if (!row || info == nullptr) {
        wait_off_road(now, ledger, commands);
        return;
    }
    away_since_.reset();
    if (info->vehicle_class == traffic::VehicleClass::human &&
        !std::ranges::binary_search(around.heeding, vehicle_))
        drop_all(Refusal::not_controllable, ledger);
    apply(judge(around, {*row, *info}, ledger), now, commands);
}

void VehicleControl::wait_off_road(core::Seconds now, Ledger& ledger,
                                   std::vector<traffic::Command>& commands) {
    if (!applied_.beside_road) {
        drop_all(Refusal::vehicle_gone, ledger);
        if (!away_since_) away_since_ = now;
        return;
    }
    HeldLease* const held = queues_[lateral].best();
    if (held == nullptr || !std::holds_alternative<traffic::PullAside>(held->lease.action))
        apply_stop(VehicleSettings{}, commands);
}

VehicleSettings VehicleControl::judge(const VehicleContext& around, const Place& place, Ledger& ledger) {
    assert(around.snapshot.lane[place.row].exists());
    VehicleSettings settings;
    for (LeaseQueue& queue : queues_) {
        for (HeldLease& held : queue.all()) {
            if (&held != queue.best()) LeaseQueue::refuse(held, Refusal::outranked, ledger);
        }
    }
    judge_speed(around, place, settings, ledger);
    judge_lateral(around, place, settings, ledger);
    judge_way(around, place, settings, ledger);
    if (HeldLease* held = queues_[privilege].best()) {
        if (place.info.vehicle_class == traffic::VehicleClass::emergency) {
            settings.privilege = traffic::JunctionPrivilege::pass_red;
            LeaseQueue::act(*held, ledger);
        } else {
            LeaseQueue::refuse(*held, Refusal::not_an_emergency_vehicle, ledger);
        }
    }
    if (around.safety_checks == traffic::SafetyChecks::off) {
        settings.freedom = traffic::LaneChangeFreedom::normal;
        if (active() > 0) settings.checks = traffic::SafetyChecks::off;
    }
    return settings;
}

void VehicleControl::judge_speed(const VehicleContext& around, const Place& place, VehicleSettings& settings,
                                 Ledger& ledger) {
    HeldLease* held = queues_[speed].best();
    if (held == nullptr) return;
    if (std::holds_alternative<traffic::StopAtLine>(held->lease.action) &&
        has_left_edge(around, place, *held)) {
        queues_[speed].end_best(ledger);
        return;
    }
    const auto* const drive = std::get_if<traffic::DriveAt>(&held->lease.action);
    if (drive == nullptr) return judge_line(around, place, settings, *held, ledger);
    const auto allowed = around.self.allowed_speed(vehicle_);
    if (!allowed) {
        LeaseQueue::refuse(*held, Refusal::vehicle_does_not_answer, ledger);
    } else if (drive->speed.value > allowed->value + speed_tolerance_mps) {
        LeaseQueue::refuse(*held, Refusal::above_allowed_speed, ledger);
    } else {
        settings.speed = std::min(drive->speed, *allowed);
        LeaseQueue::act(*held, ledger);
    }
}

/// Whether the vehicle has left the edge that the lease is about. The first call ties the lease to the
/// present edge.
bool VehicleControl::has_left_edge(const VehicleContext& around, const Place& place, HeldLease& held) {
    const core::EdgeIndex edge = around.network.lane(around.snapshot.lane[place.row]).edge;
    if (!held.edge.exists()) held.edge = edge;
    return held.edge != edge;
}

/// A stop at the line. One that needs more than the usual deceleration is refused, and one on a lane that the
/// vehicle has to leave first.
void VehicleControl::judge_line(const VehicleContext& around, const Place& place, VehicleSettings& settings,
                                HeldLease& held, Ledger& ledger) const {
    const core::LaneIndex index = around.snapshot.lane[place.row];
    const roads::Lane& lane = around.network.lane(index);
    if (around.network.edge(lane.edge).internal)
        return LeaseQueue::refuse(held, Refusal::on_a_junction, ledger);
    if (held.granted_on != lane.edge) {
        const double line_m = lane.length_m - stop_line_gap_m;
        const double room_m = line_m - around.snapshot.lane_position_m[place.row];
        if (line_m < 0.0 || braking_m(around, place.row, place.info) > std::max(0.0, room_m))
            return LeaseQueue::refuse(held, Refusal::cannot_stop_comfortably, ledger);
        const auto outlook = around.self.lane_outlook(vehicle_);
        if (!outlook || lane.number >= outlook->size())
            return LeaseQueue::refuse(held, Refusal::vehicle_does_not_answer, ledger);
        if (!is_best_or_long((*outlook)[lane.number]))
            return LeaseQueue::refuse(held, Refusal::lane_does_not_continue, ledger);
    }
    held.granted_on = lane.edge;
    settings.line = LineStop{index, lane.length_m - stop_line_gap_m};
    LeaseQueue::act(held, ledger);
}

/// Another way from the present edge on, as the vehicle could still take it.
void VehicleControl::judge_way(const VehicleContext& around, const Place& place, VehicleSettings& settings,
                               Ledger& ledger) {
    HeldLease* held = queues_[way].best();
    if (held == nullptr) return;
    if (place.info.vehicle_class != traffic::VehicleClass::emergency)
        return LeaseQueue::refuse(*held, Refusal::not_an_emergency_vehicle, ledger);
    const roads::Lane& lane = around.network.lane(around.snapshot.lane[place.row]);
    if (around.network.edge(lane.edge).internal)
        return LeaseQueue::refuse(*held, Refusal::on_a_junction, ledger);
    const std::vector<core::EdgeIndex>& asked = std::get<traffic::TakeRoute>(held->lease.action).edges;
    const auto& route = around.roster.route(place.info.route);
    const auto from = std::ranges::find(asked, lane.edge);
    const std::uint32_t at = around.snapshot.route_edge[place.row];
    if (from != asked.end() && at < route.size() &&
        std::equal(from, asked.end(), route.begin() + at, route.end()))
        return LeaseQueue::act(*held, ledger);
    if (from == asked.end() || at >= route.size() || asked.back() != route.back() ||
        roads::passes_its_end(std::span(route).subspan(at)))
        return LeaseQueue::refuse(*held, Refusal::route_elsewhere, ledger);
    const bool goes_on = std::next(from) != asked.end();
    if (goes_on && is_closed(std::span(std::next(from), std::prev(asked.end())), around.incidents))
        return LeaseQueue::refuse(*held, Refusal::closed, ledger);
    const bool turns_here = goes_on && (at + 1 >= route.size() || *std::next(from) != route[at + 1]);
    if (turns_here && !can_turn(around, place.row, place.info, *std::next(from)))
        return LeaseQueue::refuse(*held, Refusal::past_decision, ledger);
    settings.way.assign(from, asked.end());
}

void VehicleControl::judge_lateral(const VehicleContext& around, const Place& place,
                                   VehicleSettings& settings, Ledger& ledger) {
    HeldLease* held = queues_[lateral].best();
    if (held == nullptr) return;
    if (std::holds_alternative<traffic::HoldLane>(held->lease.action)) {
        settings.freedom = traffic::LaneChangeFreedom::strategic_only;
        LeaseQueue::act(*held, ledger);
    } else if (std::holds_alternative<traffic::PullAside>(held->lease.action)) {
        judge_aside(around, place, settings, *held, ledger);
    } else if (has_left_edge(around, place, *held)) {
        queues_[lateral].end_best(ledger);
    } else {
        settings.lane = judge_lane(around, place, *held, ledger);
        if (settings.lane) LeaseQueue::act(*held, ledger);
    }
}

/// In the sublane model the vehicle keeps to an edge of its lane. Without it, it stops beside the road, if it
/// can before the end of its lane; once it has begun to, it goes on.
void VehicleControl::judge_aside(const VehicleContext& around, const Place& place, VehicleSettings& settings,
                                 HeldLease& held, Ledger& ledger) const {
    if (around.lateral_model == traffic::LateralModel::sublane) {
        settings.freedom = traffic::LaneChangeFreedom::none;
        settings.alignment = std::get<traffic::PullAside>(held.lease.action).side == traffic::Side::right
                                 ? traffic::LateralAlignment::right
                                 : traffic::LateralAlignment::left;
        return LeaseQueue::act(held, ledger);
    }
    const roads::Lane& lane = around.network.lane(around.snapshot.lane[place.row]);
    const double room_m = lane.length_m - around.snapshot.lane_position_m[place.row] - stop_line_gap_m;
    if (!applied_.beside_road && around.network.edge(lane.edge).internal)
        return LeaseQueue::refuse(held, Refusal::on_a_junction, ledger);
    if (!applied_.beside_road && braking_m(around, place.row, place.info) > room_m)
        return LeaseQueue::refuse(held, Refusal::cannot_stop_comfortably, ledger);
    settings.beside_road = true;
    LeaseQueue::act(held, ledger);
}

std::optional<LaneRequest> VehicleControl::judge_lane(const VehicleContext& around, const Place& place,
                                                      HeldLease& held, Ledger& ledger) const {
    const auto refuse = [&](Refusal reason) {
        LeaseQueue::refuse(held, reason, ledger);
        return std::nullopt;
    };
    const roads::Lane& lane = around.network.lane(around.snapshot.lane[place.row]);
    const roads::Edge& edge = around.network.edge(lane.edge);
    const std::uint32_t target = std::get<traffic::ChangeLane>(held.lease.action).lane_number;
    if (edge.internal) return refuse(Refusal::on_a_junction);
    if (target >= edge.lane_count) return refuse(Refusal::no_such_lane);
    const roads::Lane& target_lane = around.network.lane(around.network.lane_of(lane.edge, target));
    const bool is_emergency = place.info.vehicle_class == traffic::VehicleClass::emergency;
    if (!(is_emergency ? target_lane.allows_emergency : target_lane.allows_cars))
        return refuse(Refusal::lane_not_allowed);
    const bool checked = around.safety_checks == traffic::SafetyChecks::on;
    if (checked) {
        const auto outlook = around.self.lane_outlook(vehicle_);
        if (!outlook || target >= outlook->size()) return refuse(Refusal::vehicle_does_not_answer);
        if (!is_best_or_long((*outlook)[target])) return refuse(Refusal::lane_does_not_continue);
    }
    if (target == lane.number) return LaneRequest{target, held.lease.expiry};
    const bool higher = target > lane.number;
    const auto direction = higher ? truth::Neighbour::higher : truth::Neighbour::lower;
    if (checked && !around.self.could_change_lane(vehicle_, direction).value_or(false))
        return refuse(Refusal::no_room_beside);
    return LaneRequest{higher ? lane.number + 1 : lane.number - 1, held.lease.expiry};
}

void VehicleControl::apply(const VehicleSettings& wanted, core::Seconds now,
                           std::vector<traffic::Command>& commands) {
    if (wanted.checks != applied_.checks)
        commands.push_back(traffic::SetSafetyChecks{vehicle_, wanted.checks});
    if (wanted.speed) {
        const bool same =
            applied_.speed && std::abs((*wanted.speed - *applied_.speed).value) < speed_resolution_mps;
        if (!same) {
            commands.push_back(traffic::SetSpeed{vehicle_, *wanted.speed});
            applied_.speed = wanted.speed;
        }
    } else if (applied_.speed) {
        commands.push_back(traffic::ReleaseSpeed{vehicle_});
        applied_.speed.reset();
    }
    if (wanted.freedom != applied_.freedom)
        commands.push_back(traffic::SetLaneChangeFreedom{vehicle_, wanted.freedom});
    if (wanted.alignment != applied_.alignment)
        commands.push_back(traffic::SetLateralAlignment{vehicle_, wanted.alignment});
    if (wanted.privilege != applied_.privilege)
        commands.push_back(traffic::SetJunctionPrivilege{vehicle_, wanted.privilege});
    applied_.checks = wanted.checks;
    applied_.freedom = wanted.freedom;
    applied_.alignment = wanted.alignment;
    applied_.privilege = wanted.privilege;
    apply_stop(wanted, commands);
    apply_lane(wanted, now, commands);
    if (!wanted.way.empty()) commands.push_back(traffic::SetRoute{vehicle_, wanted.way});
}

/// One stop at a time; beside the road goes before at the line. A stop at the start of the lane means as soon
/// as the usual deceleration allows.
void VehicleControl::apply_stop(const VehicleSettings& wanted, std::vector<traffic::Command>& commands) {
    const std::optional<LineStop> line = wanted.beside_road ? std::nullopt : wanted.line;
    if (wanted.beside_road == applied_.beside_road && line == applied_.line) return;
    if (applied_.beside_road || applied_.line) commands.push_back(traffic::ResumeFromStop{vehicle_});
    const core::Seconds longest(longest_stop_s);
    if (wanted.beside_road)
        commands.push_back(
            traffic::StopOnLane{vehicle_, core::Metres(0.0), longest, traffic::StopPlace::beside_road});
    else if (line)
        commands.push_back(traffic::StopOnLane{vehicle_, core::Metres(line->position_m), longest});
    applied_.beside_road = wanted.beside_road;
    applied_.line = line;
}

void VehicleControl::apply_lane(const VehicleSettings& wanted, core::Seconds now,
                                std::vector<traffic::Command>& commands) {
    std::optional<LaneRequest>& applied = applied_.lane;
    if (!wanted.lane) {
        if (applied && applied->until.value > now.value + time_tolerance_s)
            commands.push_back(traffic::ReleaseLane{vehicle_});
        applied.reset();
        return;
    }
    const bool same_lane = applied && applied->lane_number == wanted.lane->lane_number;
    if (same_lane && (applied->until.value >= wanted.lane->until.value ||
                      applied->until.value - now.value >= prolong_lane_request_s))
        return;
    const core::Seconds duration(std::min((wanted.lane->until - now).value, longest_lane_request_s));
    assert(duration.value > 0.0);
    commands.push_back(traffic::RequestLane{vehicle_, wanted.lane->lane_number, duration});
    applied = LaneRequest{wanted.lane->lane_number, now + duration};
}

void VehicleControl::restore(std::vector<traffic::Command>& commands) {
    if (!away_since_) apply(VehicleSettings{}, core::Seconds(0.0), commands);
}

}  // namespace clearway::actuation::detail
