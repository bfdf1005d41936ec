#include "sumo/session.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/machine_failure.hpp"
#include "core/read_failure.hpp"
#include "sumo/detail/commander.hpp"
#include "sumo/detail/gateway.hpp"
#include "sumo/detail/message_log.hpp"
#include "sumo/detail/name_table.hpp"
#include "sumo/detail/observer.hpp"
#include "sumo/detail/options.hpp"
#include "sumo/detail/outputs.hpp"
#include "sumo/detail/painter.hpp"
#include "traffic/obstacle.hpp"

namespace clearway::sumo {
namespace {

namespace gateway = detail::gateway;
using detail::Commander;
using detail::MessageCapture;
using detail::MessageLog;
using detail::NameTable;
using detail::Observer;
using detail::Outputs;
using detail::Painter;
using detail::Vehicle;

/// libsumo keeps its simulation in global variables: one session at a time, and none after a fault, because
/// the rest of the simulation cannot be trusted, not even to close.
enum class ProcessState : std::uint8_t { free, occupied, spoilt };
ProcessState process_state = ProcessState::free;

void occupy_process() {
    if (process_state == ProcessState::occupied)
        throw std::logic_error("this process has a session already; SUMO runs one simulation per process");
    if (process_state == ProcessState::spoilt)
        throw core::SimulatorError("SUMO failed in this process before; a new session needs a new process");
    process_state = ProcessState::occupied;
}

bool is_complete(const std::filesystem::path& trips) {
    constexpr std::string_view end = "</tripinfos>";
    const std::string text = core::read_file(trips);
    const std::size_t last = text.find_last_not_of(" \n");
    return last != std::string::npos && std::string_view(text).substr(0, last + 1).ends_with(end);
}

/// SUMO says nothing when the disk is full, but only a complete table has its end tag. A remote SUMO writes
/// its last lines after the connection has ended.
void require_complete(const std::filesystem::path& trips, core::Seconds patience) {
    constexpr auto pause = std::chrono::milliseconds(20);
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience.value);
    while (!is_complete(trips) && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(pause);
    if (!is_complete(trips)) throw core::cut_short(trips);
}

}  // namespace

struct Session::State {
    double step_wall_s = 0.0;
    State(std::unique_ptr<gateway::Sumo> simulator, SessionConfig given)
        : sumo(std::move(simulator)),
          config(std::move(given)),
          names(std::move(config.names)),
          observer(*sumo, names) {}

    void load();
    void take_over();
    /// Start of both kinds of session, once SUMO's simulation is loaded.
    void begin();
    void close();
    std::string fault_message(const char* doing, const std::string& what) const;

    /// Runs `work` with SUMO's messages going to the log. Its faults get time and log, and end the session;
    /// those of the machine are EnvironmentErrors.
    template <class Work>
    auto guarded(const char* doing, Work&& work) {
        if (!is_open) throw std::logic_error("the session is closed or has failed");
        const MessageCapture capture(*log);
        errno = 0;
        try {
            return work();
        } catch (const core::SimulatorError& fault) {
            const int reason = errno;
            is_open = false;
            process_state = ProcessState::spoilt;
            if (core::is_of_machine(reason))  // which SUMO does not tell, but leaves in errno
                throw core::EnvironmentError(
                    fmt::format("{}\nThe machine failed ({}), not the scenario: give the same command again",
                                fault_message(doing, fault.what()), std::strerror(reason)));
            throw core::SimulatorError(fault_message(doing, fault.what()));
        }
    }

    std::unique_ptr<gateway::Sumo> sumo;
    SessionConfig config;
    std::filesystem::path trip_file;
    bool is_remote = false;
    NameTable names;
    Observer observer;
    std::optional<MessageLog> log;
    std::optional<Commander> commander;
    std::optional<Painter> painter;
    Outputs outputs;
    truth::Snapshot snapshot;
    truth::Events events;
    bool is_open = false;
    int added_obstacles = 0;                                            ///< Less those removed.
    std::map<std::string, std::vector<std::string>> usual_permissions;  ///< Of closed lanes.
    std::map<std::string, double> usual_limits_mps;                     ///< Of limited lanes.
};

std::string Session::State::fault_message(const char* doing, const std::string& what) const {
    const std::string messages = log->last_lines();
    return fmt::format("{} at {} s: {}{}{}", doing, snapshot.time.value, what,
                       messages.empty() ? "" : "\nSUMO's last messages:\n", messages);
}

void Session::State::load() {
    config.folder = detail::prepare_folder(config.folder);
    trip_file = config.folder / detail::trip_file;
    detail::set_sumo_home();
    const std::set<int> before = Outputs::open_descriptors();
    log.emplace(config.folder / detail::log_file);
    snapshot.time = config.begin;
    is_open = true;
    guarded("SUMO cannot load the scenario", [&] {
        sumo->load(detail::arguments(config));
        begin();
        outputs = Outputs(before, config.folder);
    });
}

void Session::State::take_over() {
    core::make_folder(config.folder);
    log.emplace(config.folder / "connection.log");
    is_open = true;
    is_remote = true;
    guarded("SUMO cannot be taken over", [&] {
        trip_file = sumo->option("tripinfo-output");
        begin();
        observer.take_present();
    });
}

void Session::State::begin() {
    assert(is_open && !commander);
    const std::vector<std::string> signals = sumo->signal_ids();
    for (const std::string& signal : names.names().signals) {
        if (!core::contains(signals, signal))
            throw std::invalid_argument("SUMO's network has no signal '" + signal + "'");
    }
    const bool has_sublanes = std::stod(sumo->option("lateral-resolution")) > 0.0;
    commander.emplace(*sumo, observer.fleet(), names,
                      has_sublanes ? traffic::LateralModel::sublane : traffic::LateralModel::lane);
    observer.observe_signals(snapshot);
}

void Session::State::close() {
    if (!is_open) return;
    guarded("SUMO cannot end the simulation", [this] { sumo->close(); });
    is_open = false;
    process_state = ProcessState::free;
    if (!trip_file.empty()) require_complete(trip_file, core::Seconds(is_remote ? 30.0 : 0.0));
}

template <class Load>
void Session::open(Load&& load) {
    occupy_process();
    try {
        load();
    } catch (...) {
        if (process_state == ProcessState::occupied) {
            if (state_ && state_->is_open) state_->sumo->close();
            process_state = ProcessState::free;
        }
        throw;
    }
}

Session::Session(SessionConfig config) {
    detail::check(config);
    open([&] {
        state_ = std::make_unique<State>(gateway::in_this_process(), std::move(config));
        state_->load();
    });
}

Session::Session(RemoteSumo remote, const std::filesystem::path& folder, Names names) {
    open([&] {
        SessionConfig config;
        config.folder = folder;
        config.names = std::move(names);
        state_ = std::make_unique<State>(std::move(remote.sumo_), std::move(config));
        state_->take_over();
    });
}

Session::~Session() {
    try {
        state_->close();
    } catch (const std::exception&) {
        // A destructor cannot report errors. Callers that want to know call close().
    }
}

void Session::step() {
    state_->guarded("SUMO cannot step", [this] {
        const auto started = std::chrono::steady_clock::now();
        state_->sumo->step();
        state_->step_wall_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
        state_->observer.observe(state_->snapshot, state_->events);
    });
}

core::Seconds Session::step_wall_time() const {
    return core::Seconds(state_->step_wall_s);
}

core::Seconds Session::time() const {
    return state_->snapshot.time;
}

const truth::Snapshot& Session::snapshot() const {
    return state_->snapshot;
}

const truth::Events& Session::events() const {
    return state_->events;
}

const traffic::Roster& Session::roster() const {
    return state_->observer.roster();
}

int Session::expected_vehicles() const {
    return state_->guarded("SUMO cannot count vehicles",
                           [this] { return state_->sumo->expected_vehicles() - state_->added_obstacles; });
}

void Session::add(const traffic::EmergencyDeparture& departure) {
    state_->guarded("SUMO cannot add a vehicle", [&] {
        std::vector<core::Problem> problems;
        const std::string where = "emergency vehicle '" + departure.id + "'";
        if (!(departure.depart >= time()))
            problems.push_back({where, fmt::format("departs at {} s, in the past", departure.depart.value),
                                fmt::format("{} s or later", time().value), ""});
        const std::vector<std::string> types = state_->sumo->type_ids();
        if (!core::contains(types, departure.type))
            problems.push_back({where, "has the vehicle type '" + departure.type + "', which is not defined",
                                "", "Define it in an additional file."});
        if (departure.edges.empty()) problems.push_back({where, "has no route", "one edge or more", ""});
        for (const std::string& edge : departure.edges) {
            if (!state_->names.has_edge(edge))
                problems.push_back({where, "drives over edge '" + edge + "', which does not exist", "", ""});
        }
        if (!problems.empty()) throw core::InputError(std::move(problems));
        if (departure.bluelight == traffic::BlueLight::on)
            state_->sumo->set_type_parameter(departure.type, "has.bluelight.device", "true");
        if (departure.rerouting_s > 0.0) {
            state_->sumo->set_type_parameter(departure.type, "has.rerouting.device", "true");
            state_->sumo->set_type_parameter(departure.type, "device.rerouting.period",
                                             fmt::format("{}", departure.rerouting_s));
        }
        state_->sumo->add({.vehicle = departure.id,
                           .type = departure.type,
                           .edges = departure.edges,
                           .depart = fmt::format("{}", departure.depart.value),
                           .depart_lane = departure.depart_lane,
                           .depart_speed = departure.depart_speed,
                           .arrival = departure.arrival ? fmt::format("{:.2f}", departure.arrival->value)
                                                        : std::string("max")});
        state_->observer.declare_emergency(departure.id, departure.kind);
    });
}

void Session::add_obstacle(const std::string& id, core::LaneIndex lane, core::Metres position) {
    assert(id.starts_with(traffic::obstacle_prefix));
    constexpr double for_ever_s = 1e6;
    state_->guarded("SUMO cannot block a lane", [&] {
        const std::string& name = state_->names.names().lanes.at(lane.value);
        const std::size_t bar = name.rfind('_');
        // A vehicle has its front at its place, and stands on the lane as a whole where that is possible.
        const double length_m = state_->sumo->lane_length_m(name);
        constexpr double vehicle_m = 5.0;
        const double place_m = std::clamp(position.value, std::min(vehicle_m, length_m), length_m);
        state_->sumo->add_obstacle(
            id, "clearway.incident",
            {.edge = name.substr(0, bar),
             .lane_number = std::stoi(name.substr(bar + 1)),
             // In centimetres: the vehicle must not be beyond its stop by what rounding adds.
             .position_m = std::floor(100.0 * place_m) / 100.0,
             .duration_s = for_ever_s});
        ++state_->added_obstacles;
    });
}

bool Session::has_obstacle(const std::string& id) const {
    return state_->observer.obstacles().contains(id);
}

void Session::remove_obstacle(const std::string& id) {
    state_->guarded("SUMO cannot open a lane", [&] { state_->sumo->remove(id); });
    state_->observer.obstacles().erase(id);
    --state_->added_obstacles;
}

void Session::close_to_others(core::LaneIndex lane) {
    state_->guarded("SUMO cannot close a lane", [&] {
        const std::string& name = state_->names.names().lanes.at(lane.value);
        state_->usual_permissions.try_emplace(name, state_->sumo->allowed(name));
        state_->sumo->allow(name, {"emergency"});
    });
}

void Session::open_again(core::LaneIndex lane) {
    state_->guarded("SUMO cannot open a lane", [&] {
        const auto usual = state_->usual_permissions.find(state_->names.names().lanes.at(lane.value));
        if (usual == state_->usual_permissions.end()) return;
        state_->sumo->allow(usual->first, usual->second);
        state_->usual_permissions.erase(usual);
    });
}

void Session::limit(core::LaneIndex lane, std::optional<core::MetresPerSecond> limit) {
    state_->guarded("SUMO cannot limit the speed on a lane", [&] {
        const std::string& name = state_->names.names().lanes.at(lane.value);
        const auto usual = state_->usual_limits_mps.find(name);
        if (limit) {
            const double own_mps =
                usual == state_->usual_limits_mps.end() ? state_->sumo->lane_limit_mps(name) : usual->second;
            state_->usual_limits_mps.try_emplace(name, own_mps);
            state_->sumo->set_lane_limit(name, std::min(own_mps, limit->value));
        } else if (usual != state_->usual_limits_mps.end()) {
            state_->sumo->set_lane_limit(name, usual->second);
            state_->usual_limits_mps.erase(usual);
        }
    });
}

void Session::apply(std::span<const traffic::Command> commands) {
    state_->guarded("SUMO cannot carry out a command", [&] {
        for (const traffic::Command& command : commands) {
            state_->commander->carry_out(command);
        }
    });
}

void Session::stop_rerouting(core::VehicleKey vehicle) {
    state_->guarded("SUMO cannot stop rerouting a vehicle", [&] {
        const traffic::VehicleInfo* const info = roster().find(vehicle);
        if (info != nullptr) state_->sumo->stop_rerouting(info->id);
    });
}

std::uint64_t Session::skipped_commands() const {
    return state_->commander->skipped();
}

std::uint64_t Session::refused_commands() const {
    return state_->commander->refused();
}

void Session::draw(const Drawing& drawing) {
    state_->guarded("SUMO cannot draw", [&] {
        if (!state_->painter) state_->painter.emplace(*state_->sumo, state_->observer.fleet());
        state_->painter->draw(drawing);
    });
}

void Session::continue_in(const std::filesystem::path& folder) {
    core::make_folder(folder);
    state_->config.folder = std::filesystem::canonical(folder);
    state_->trip_file = state_->config.folder / detail::trip_file;
    state_->outputs.move_to(state_->config.folder);
}

void Session::close() {
    state_->close();
}

std::optional<bool> Session::could_change_lane(core::VehicleKey vehicle, truth::Neighbour direction) const {
    const Vehicle* found = state_->observer.fleet().find(vehicle);
    if (found == nullptr || !found->on_road) return std::nullopt;
    return state_->guarded("SUMO cannot check a lane change", [&] {
        return state_->sumo->could_change_lane(found->id, static_cast<int>(direction));
    });
}

std::optional<std::vector<truth::LaneOutlook>> Session::lane_outlook(core::VehicleKey vehicle) const {
    const Vehicle* found = state_->observer.fleet().find(vehicle);
    if (found == nullptr || !found->on_road) return std::nullopt;
    return state_->guarded("SUMO cannot look ahead", [&] {
        const std::string prefix = state_->sumo->edge_of(found->id) + "_";
        const double position_m = state_->sumo->lane_position_m(found->id);
        const std::vector<gateway::BestLane> lanes = state_->sumo->best_lanes(found->id);
        std::vector<truth::LaneOutlook> outlook;
        outlook.reserve(lanes.size());
        for (const gateway::BestLane& lane : lanes) {
            if (!lane.lane.starts_with(prefix)) continue;
            outlook.push_back(
                {.lane_number = static_cast<std::uint32_t>(std::stoul(lane.lane.substr(prefix.size()))),
                 .drivable_m = static_cast<float>(std::max(0.0, lane.length_m - position_m)),
                 .best_offset = lane.offset});
        }
        return outlook;
    });
}

std::optional<core::MetresPerSecond> Session::allowed_speed(core::VehicleKey vehicle) const {
    const Vehicle* found = state_->observer.fleet().find(vehicle);
    if (found == nullptr || !found->on_road) return std::nullopt;
    return state_->guarded("SUMO cannot report the allowed speed",
                           [&] { return core::MetresPerSecond(state_->sumo->allowed_speed_mps(found->id)); });
}

bool Session::is_stopped(core::VehicleKey vehicle) const {
    const Vehicle* found = state_->observer.fleet().find(vehicle);
    if (found == nullptr || !found->on_road) return false;
    return state_->guarded("SUMO cannot tell whether a vehicle is at a stop",
                           [&] { return state_->sumo->is_stopped(found->id); });
}

bool Session::has_pedestrian(core::LaneIndex crossing) const {
    const std::string& lane = state_->names.names().lanes.at(crossing.value);
    return state_->guarded("SUMO cannot report pedestrians on a crossing",
                           [&] { return state_->sumo->has_person(lane.substr(0, lane.rfind('_'))); });
}

std::string Session::running_program(core::SignalIndex signal) const {
    return state_->guarded("SUMO cannot report the program of a signal", [&] {
        return state_->sumo->signal_program(state_->names.names().signals.at(signal.value));
    });
}

const std::filesystem::path& Session::trip_file() const {
    return state_->trip_file;
}

std::vector<std::string> command_line(const SessionConfig& config) {
    detail::check(config);
    SessionConfig placed = config;
    placed.folder = detail::prepare_folder(config.folder);
    return detail::arguments(placed);
}

RemoteSumo::RemoteSumo(const std::string& host, int port, core::Seconds patience)
    : sumo_(gateway::at(host, port, patience)) {}
RemoteSumo::~RemoteSumo() = default;
RemoteSumo::RemoteSumo(RemoteSumo&&) noexcept = default;
RemoteSumo& RemoteSumo::operator=(RemoteSumo&&) noexcept = default;

void RemoteSumo::declare(const std::string& type, traffic::VehicleClass vehicle_class) {
    const std::vector<std::string> known = sumo_->type_ids();
    if (!core::contains(known, type))
        throw core::InputError({fmt::format("vehicle type '{}'", type), "is unknown to that SUMO",
                                "a type of its simulation", core::did_you_mean(type, known)});
    sumo_->set_type_parameter(type, traffic::class_parameter, std::string(traffic::name(vehicle_class)));
}

std::string RemoteSumo::option(const std::string& name) const {
    return sumo_->option(name);
}

std::string version() {
    const std::string text = gateway::in_this_process()->version();
    constexpr std::string_view prefix = "SUMO ";
    return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

}  // namespace clearway::sumo
