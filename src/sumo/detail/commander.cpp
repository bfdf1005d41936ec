#include "sumo/detail/commander.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "core/counted.hpp"

namespace clearway::sumo::detail {
namespace {

constexpr int speed_mode_default = 31;
constexpr int speed_mode_pass_red = 15;
constexpr int lane_change_modes[] = {1621, 1537, 1536};                        // traffic::LaneChangeFreedom
constexpr const char* alignments[] = {nullptr, "right", "left", "arbitrary"};  // traffic::LateralAlignment
constexpr int mode_without_checks = 0;
constexpr double released_speed = -1.0;
/// A stop nearer than this to the place that was asked for is that one, m.
constexpr double same_place_m = 0.01;
constexpr std::string_view signal_letters = "GgyruosO";

void require(bool holds, const std::string& otherwise) {
    if (!holds) throw std::invalid_argument(otherwise);
}

void require_duration(const Vehicle& vehicle, core::Seconds duration) {
    require(
        std::isfinite(duration.value) && duration.value > 0.0,
        fmt::format("vehicle '{}': a duration of {} s is not a positive number", vehicle.id, duration.value));
}

}  // namespace

void Commander::carry_out(const traffic::Command& command) {
    std::visit([this](const auto& concrete) { run(concrete); }, command);
}

Vehicle* Commander::present(core::VehicleKey key) {
    Vehicle* vehicle = fleet_.find(key);
    if (vehicle == nullptr) ++skipped_;
    return vehicle;
}

Vehicle* Commander::on_road(core::VehicleKey key) {
    Vehicle* vehicle = fleet_.find(key);
    if (vehicle != nullptr && vehicle->on_road) return vehicle;
    ++skipped_;
    return nullptr;
}

void Commander::run(const traffic::SetSpeed& command) {
    require(std::isfinite(command.speed.value) && command.speed.value >= 0.0,
            fmt::format("a speed of {} m/s is not a finite number of at least 0", command.speed.value));
    if (const Vehicle* vehicle = present(command.vehicle)) sumo_.set_speed(vehicle->id, command.speed.value);
}

void Commander::run(const traffic::ReleaseSpeed& command) {
    if (const Vehicle* vehicle = present(command.vehicle)) sumo_.set_speed(vehicle->id, released_speed);
}

void Commander::run(const traffic::RequestLane& command) {
    const Vehicle* vehicle = on_road(command.vehicle);
    if (vehicle == nullptr) return;
    require_duration(*vehicle, command.duration);
    const std::string edge = sumo_.edge_of(vehicle->id);
    const auto lanes = static_cast<std::uint32_t>(sumo_.lane_count(edge));
    require(command.lane_number < lanes,
            fmt::format("vehicle '{}': edge '{}' has {}, none with number {}", vehicle->id, edge,
                        core::counted(lanes, "lane"), command.lane_number));
    sumo_.change_lane(vehicle->id, static_cast<int>(command.lane_number), command.duration.value);
}

void Commander::run(const traffic::ReleaseLane& command) {
    const Vehicle* vehicle = on_road(command.vehicle);
    // A request for the present lane that ends at once replaces the former one.
    if (vehicle != nullptr) sumo_.change_lane(vehicle->id, sumo_.lane_number(vehicle->id), 0.0);
}

void Commander::run(const traffic::SetLateralAlignment& command) {
    require(lateral_ == traffic::LateralModel::sublane,
            "lateral alignment has no effect without the sublane model (--lateral-resolution)");
    Vehicle* vehicle = present(command.vehicle);
    if (vehicle == nullptr) return;
    std::optional<std::string>& usual = vehicle->controls.usual_alignment;
    if (!usual) usual = sumo_.lateral_alignment(vehicle->id);
    const char* const side = alignments[static_cast<std::size_t>(command.alignment)];
    sumo_.set_lateral_alignment(vehicle->id, side == nullptr ? *usual : side);
}

void Commander::run(const traffic::SteerSideways& command) {
    require(lateral_ == traffic::LateralModel::sublane,
            "steering sideways has no effect without the sublane model (--lateral-resolution)");
    require(std::isfinite(command.shift.value),
            fmt::format("a shift of {} m sideways is not a finite number", command.shift.value));
    if (const Vehicle* vehicle = on_road(command.vehicle))
        sumo_.change_sublane(vehicle->id, command.shift.value);
}

void Commander::run(const traffic::SetJunctionPrivilege& command) {
    control(command.vehicle, [&](Controls& controls) { controls.privilege = command.privilege; });
}

void Commander::run(const traffic::SetLaneChangeFreedom& command) {
    control(command.vehicle, [&](Controls& controls) { controls.freedom = command.freedom; });
}

void Commander::run(const traffic::SetSafetyChecks& command) {
    control(command.vehicle, [&](Controls& controls) { controls.checks = command.checks; });
}

template <class Change>
void Commander::control(core::VehicleKey key, const Change& change) {
    Vehicle* const vehicle = present(key);
    if (vehicle == nullptr) return;
    change(vehicle->controls);
    set_modes(*vehicle);
}

void Commander::set_modes(const Vehicle& vehicle) const {
    assert(!vehicle.id.empty());
    const Controls& controls = vehicle.controls;
    if (controls.checks == traffic::SafetyChecks::off) {
        sumo_.set_speed_mode(vehicle.id, mode_without_checks);
        sumo_.set_lane_change_mode(vehicle.id, mode_without_checks);
        return;
    }
    const bool may_pass_red = controls.privilege == traffic::JunctionPrivilege::pass_red;
    sumo_.set_speed_mode(vehicle.id, may_pass_red ? speed_mode_pass_red : speed_mode_default);
    sumo_.set_lane_change_mode(vehicle.id, lane_change_modes[static_cast<std::size_t>(controls.freedom)]);
}

void Commander::run(const traffic::StopOnLane& command) {
    Vehicle* vehicle = on_road(command.vehicle);
    if (vehicle == nullptr) return;
    require_duration(*vehicle, command.duration);
    const double length_m = sumo_.lane_length_m(vehicle->lane_id);
    require(command.position.value >= 0.0 && command.position.value <= length_m,
            fmt::format("vehicle '{}': lane '{}' is {} m long, {} m is not on it", vehicle->id,
                        vehicle->lane_id, length_m, command.position.value));
    const double speed = sumo_.speed_mps(vehicle->id);
    const double nearest_m = sumo_.lane_position_m(vehicle->id) + speed * step_s_ +
                             speed * speed / (2.0 * vehicle->deceleration_mps2) + 0.1;
    const double position_m = std::max(command.position.value, nearest_m);
    if (position_m > length_m) {
        ++refused_;
        return;
    }
    run(traffic::ResumeFromStop{command.vehicle});
    assert(!vehicle->controls.own_stop && position_m <= length_m);
    sumo_.stop(vehicle->id, {.edge = sumo_.edge_of(vehicle->id),
                             .lane_number = sumo_.lane_number(vehicle->id),
                             .position_m = position_m,
                             .duration_s = command.duration.value,
                             .place = command.place});
    // SUMO sorts stops along the route, and the vehicle may have others.
    for (const gateway::StopPoint& stop : sumo_.stops(vehicle->id))
        if (stop.first == vehicle->lane_id && std::abs(stop.second - position_m) < same_place_m)
            vehicle->controls.own_stop = stop;
    if (!vehicle->controls.own_stop) ++refused_;
}

void Commander::run(const traffic::ResumeFromStop& command) {
    Vehicle* vehicle = present(command.vehicle);  // one beside the road is not on it
    if (vehicle == nullptr || !vehicle->controls.own_stop) return;
    const gateway::StopPoint own = *std::exchange(vehicle->controls.own_stop, std::nullopt);
    const std::vector<gateway::StopPoint> stops = sumo_.stops(vehicle->id);
    const auto found = std::ranges::find(stops, own);
    if (found == stops.end()) return;
    if (found == stops.begin() && sumo_.is_stopped(vehicle->id))
        sumo_.resume(vehicle->id);
    else
        sumo_.cancel_stop(vehicle->id, static_cast<int>(found - stops.begin()));
}

void Commander::run(const traffic::SetRoute& command) {
    Vehicle* const vehicle = on_road(command.vehicle);
    if (vehicle == nullptr) return;
    const std::vector<std::string>& names = names_.names().edges;
    std::vector<std::string> edges;
    for (const core::EdgeIndex edge : command.edges) {
        require(edge.value < names.size(),
                fmt::format("vehicle '{}': there is no edge with index {}", vehicle->id, edge.value));
        edges.push_back(names[edge.value]);
    }
    require(!edges.empty(), fmt::format("vehicle '{}': a way without edges", vehicle->id));
    if (edges.front() != sumo_.edge_of(vehicle->id) || !sumo_.set_route(vehicle->id, edges)) {
        ++refused_;
        return;
    }
    vehicle->route_id.clear();  // it is read again
}

const std::string& Commander::signal_name(core::SignalIndex signal) const {
    const std::vector<std::string>& signals = names_.names().signals;
    require(signal.value < signals.size(), fmt::format("there is no signal with index {}", signal.value));
    return signals[signal.value];
}

void Commander::run(const traffic::SetSignalState& command) {
    const std::string& signal = signal_name(command.signal);
    const std::size_t links = sumo_.signal_state(signal).size();
    require(command.state.size() == links,
            fmt::format("signal '{}': '{}' has {} for {}", signal, command.state,
                        core::counted(command.state.size(), "letter"), core::counted(links, "link")));
    require(
        command.state.find_first_not_of(signal_letters) == std::string::npos,
        fmt::format("signal '{}': '{}' has a letter other than {}", signal, command.state, signal_letters));
    if (!background_programs_.contains(signal))
        background_programs_.emplace(signal, sumo_.signal_program(signal));
    sumo_.set_signal_state(signal, command.state);
}

void Commander::run(const traffic::RestoreProgram& command) {
    const std::string& signal = signal_name(command.signal);
    const auto own = background_programs_.find(signal);
    const std::string program =
        own == background_programs_.end() ? sumo_.signal_program(signal) : own->second;
    if (command.phase) {
        const std::uint32_t phases = sumo_.phase_count(signal, program);
        require(*command.phase < phases,
                fmt::format("signal '{}': program '{}' has {} phases, none with number {}", signal, program,
                            phases, *command.phase));
    }
    if (own != background_programs_.end()) sumo_.set_signal_program(signal, program);
    background_programs_.erase(signal);
    if (!command.phase) return;
    sumo_.set_signal_phase(signal, *command.phase);
    if (command.lasting) sumo_.set_signal_phase_duration(signal, command.lasting->value);
}

}  // namespace clearway::sumo::detail
