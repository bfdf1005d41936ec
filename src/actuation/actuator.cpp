#include "actuation/actuator.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <optional>

#include "actuation/detail/lease_queue.hpp"
#include "actuation/detail/signal_control.hpp"
#include "actuation/detail/stop_line.hpp"
#include "actuation/detail/vehicle_control.hpp"
#include "roads/exits.hpp"

namespace clearway::actuation {
namespace {

using traffic::Refusal;

/// Reaction time of a driver to yellow, s. Assumed to be short, because drivers expect it.
constexpr double reaction_s = 0.5;
/// Farther away than this, every vehicle can stop, m: 140 km/h and 4.5 m/s2 take 168 m.
constexpr double farthest_stop_m = 200.0;

std::optional<Refusal> check_way(const roads::Network& network, const std::vector<core::EdgeIndex>& edges) {
    const bool all_exist =
        std::ranges::all_of(edges, [&](core::EdgeIndex edge) { return edge.value < network.edges().size(); });
    if (edges.empty() || !all_exist) return Refusal::no_such_edge;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const auto exits = roads::exits(network, edges[i], roads::Driver::emergency);
        if (!std::ranges::binary_search(exits, edges[i + 1])) return Refusal::route_gap;
    }
    return std::nullopt;
}

/// Reason why a lease can never be carried out.
std::optional<Refusal> check_vehicle_action(const roads::Network& network, const traffic::Action& action) {
    if (std::holds_alternative<traffic::HoldGreen>(action) ||
        std::holds_alternative<traffic::AdjustGreen>(action))
        return Refusal::wrong_target;
    if (const auto* drive = std::get_if<traffic::DriveAt>(&action)) {
        if (!std::isfinite(drive->speed.value)) return Refusal::speed_not_finite;
        if (drive->speed.value < 0.0) return Refusal::speed_negative;
    }
    if (const auto* way = std::get_if<traffic::TakeRoute>(&action)) return check_way(network, way->edges);
    return std::nullopt;
}

std::optional<Refusal> check_signal_action(const roads::Network& network, core::SignalIndex signal,
                                           const traffic::Action& action) {
    if (signal.value >= network.signals().size()) return Refusal::no_such_signal;
    const std::vector<std::uint16_t>* links = nullptr;
    if (const auto* hold = std::get_if<traffic::HoldGreen>(&action)) links = &hold->links;
    if (const auto* adjustment = std::get_if<traffic::AdjustGreen>(&action)) links = &adjustment->links;
    if (links == nullptr) return Refusal::wrong_target;
    if (links->empty()) return Refusal::no_links;
    const std::size_t count = network.signal(signal).links.size();
    if (!std::ranges::all_of(*links, [&](std::uint16_t link) { return link < count; }))
        return Refusal::no_such_link;
    const auto* const hold = std::get_if<traffic::HoldGreen>(&action);
    const bool holds_own = hold == nullptr || std::ranges::all_of(hold->own_links, [&](std::uint16_t link) {
                               return std::ranges::find(*links, link) != links->end();
                           });
    return holds_own ? std::nullopt : std::optional(Refusal::own_link_not_held);
}

}  // namespace

struct Actuator::State {
    const roads::Network& network;
    Config config;
    detail::Ledger ledger;
    std::map<core::VehicleKey, detail::VehicleControl> vehicles;
    std::map<core::SignalIndex, detail::SignalControl> signals;
    std::vector<detail::LinkHistory> histories;                 ///< By signal.
    std::map<core::SignalIndex, detail::Clearance> clearances;  ///< Of signals that were ever asked for.
    std::optional<core::Seconds> last_step;
    std::vector<core::VehicleKey> heeding;
    std::vector<traffic::KnownIncident> incidents = {};
    std::vector<core::VehicleKey> keeping = {};  ///< Vehicles whose way no lease changes.
    detail::Lanes occupied = {};                 ///< Internal lanes with a vehicle on them, in this step.

    void watch(const traffic::SignalStates& shown, core::Seconds now) {
        assert(shown.state.size() <= histories.size());
        for (std::size_t row = 0; row < shown.state.size(); ++row)
            histories[row].watch(shown.state[row], now);
    }

    traffic::Preemption preemption_of(core::SignalIndex signal) const {
        return signal.value < config.preemption.size() ? config.preemption[signal.value]
                                                       : traffic::Preemption{};
    }

    std::optional<Refusal> check(const traffic::Lease& lease, core::Seconds now) const {
        if (!std::isfinite(lease.expiry.value) || lease.expiry <= now) return Refusal::expired_on_arrival;
        if (std::holds_alternative<traffic::StandBack>(lease.action)) return Refusal::stood_back;
        if (std::holds_alternative<traffic::Stretch>(lease.target)) return Refusal::wrong_target;
        if (const auto* signal = std::get_if<core::SignalIndex>(&lease.target))
            return check_signal_action(network, *signal, lease.action);
        return check_vehicle_action(network, lease.action);
    }
    /// Whether a vehicle could stop before the end of its lane with its usual deceleration, but only without
    /// a reaction time: if it got yellow now, it would brake hard.
    bool could_just_stop(const truth::Snapshot& snapshot, std::size_t row,
                         const traffic::Roster& roster) const {
        const double speed_mps = snapshot.speed_mps[row];
        const double left_m = network.lane(snapshot.lane[row]).length_m - snapshot.lane_position_m[row];
        if (left_m > farthest_stop_m) return false;
        const traffic::VehicleInfo* info = roster.find(snapshot.key[row]);
        if (info == nullptr) return false;
        assert(info->deceleration_mps2 > 0.0F);
        const double stop_m = speed_mps * speed_mps / (2.0 * info->deceleration_mps2);
        return left_m > stop_m && left_m < stop_m + reaction_s * speed_mps + detail::stop_line_gap_m;
    }
    detail::Lanes pressed_lanes(const truth::Snapshot& snapshot, const traffic::Roster& roster) const {
        detail::Lanes lanes;
        for (std::size_t row = 0; row < snapshot.size(); ++row) {
            const core::LaneIndex lane = snapshot.lane[row];
            if (lane.exists() && !network.edge(network.lane(lane).edge).internal &&
                could_just_stop(snapshot, row, roster))
                lanes.push_back(lane);
        }
        std::ranges::sort(lanes);
        return lanes;
    }
    void step_signals(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                      const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands) {
        if (signals.empty()) return;
        occupied.clear();
        for (const core::LaneIndex lane : snapshot.lane) {
            if (lane.exists() && network.edge(network.lane(lane).edge).internal) occupied.push_back(lane);
        }
        std::ranges::sort(occupied);
        std::optional<detail::Lanes> pressed;
        const auto find_pressed = [&]() -> const detail::Lanes& {
            if (!pressed) pressed = pressed_lanes(snapshot, roster);
            return *pressed;
        };
        const std::function<const detail::Lanes&()> look = std::cref(find_pressed);
        const std::string none;
        for (auto& [index, signal] : signals) {
            const bool known = index.value < snapshot.signals.state.size();
            const std::string& shown = known ? snapshot.signals.state[index.value] : none;
            const detail::SignalDuties duties{clearances.at(index), histories[index.value]};
            const detail::SignalTiming timing = detail::timing_of(config, preemption_of(index));
            signal.step({snapshot.time, shown, timing, occupied, look, self, duties}, ledger, commands);
        }
    }
    void take(const traffic::Lease& lease) {
        if (const auto* vehicle = std::get_if<core::VehicleKey>(&lease.target)) {
            if (std::holds_alternative<traffic::TakeRoute>(lease.action) &&
                std::ranges::find(keeping, *vehicle) != keeping.end())
                return;
            vehicles.try_emplace(*vehicle, *vehicle).first->second.offer(lease, ledger);
        } else {
            const core::SignalIndex signal = std::get<core::SignalIndex>(lease.target);
            assert(signal.value < network.signals().size());
            signals.try_emplace(signal, signal, network).first->second.offer(lease, ledger);
            if (!clearances.contains(signal))
                clearances.emplace(signal, detail::Clearance(config, network.signal(signal), network,
                                                             preemption_of(signal).pedestrian_clearance_s));
        }
    }
};

Actuator::Actuator(const roads::Network& network, Config config)
    : state_(std::make_unique<State>(State{network,
                                           config,
                                           {},
                                           {},
                                           {},
                                           std::vector<detail::LinkHistory>(network.signals().size()),
                                           {},
                                           {},
                                           {}})) {}

Actuator::~Actuator() = default;

void Actuator::accept(std::span<const traffic::Lease> leases, core::Seconds now,
                      std::span<const core::VehicleKey> unreachable) {
    assert(std::ranges::is_sorted(unreachable));
    for (const traffic::Lease& lease : leases) {
        std::optional<Refusal> reason = state_->check(lease, now);
        const auto* const vehicle = std::get_if<core::VehicleKey>(&lease.target);
        if (!reason && vehicle != nullptr && std::ranges::binary_search(unreachable, *vehicle))
            reason = Refusal::unreachable;
        if (!reason) {
            state_->take(lease);
            continue;
        }
        refuse({&lease, 1}, *reason);
    }
}

void Actuator::refuse(std::span<const traffic::Lease> leases, Refusal reason) {
    for (const traffic::Lease& lease : leases) {
        LeaseCounts& counts = state_->ledger.of(lease);
        ++counts.issued;
        ++counts.refused[reason];
    }
}

void Actuator::keep_way(core::VehicleKey vehicle) {
    state_->keeping.push_back(vehicle);
    const auto found = state_->vehicles.find(vehicle);
    if (found != state_->vehicles.end()) found->second.drop_way();
}

void Actuator::know(std::span<const traffic::KnownIncident> incidents) {
    state_->incidents.assign(incidents.begin(), incidents.end());
}

void Actuator::heed(std::span<const core::VehicleKey> drivers) {
    assert(std::ranges::is_sorted(drivers));
    state_->heeding.assign(drivers.begin(), drivers.end());
}

void Actuator::step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                    const truth::SelfKnowledge& self, std::vector<traffic::Command>& commands) {
    State& state = *state_;
    const core::Seconds now = snapshot.time;
    assert(!state.last_step || now > *state.last_step);
    const core::Seconds step = state.last_step ? now - *state.last_step : core::Seconds(0.0);
    state.last_step = now;
    const detail::VehicleContext around{
        state.network,
        snapshot,
        roster,
        self,
        state.config.safety_checks,
        state.config.lateral_model,
        step,
        state.heeding,
        state.incidents,
    };
    for (auto& [key, vehicle] : state.vehicles)
        vehicle.step(around, state.ledger, commands);
    state.watch(snapshot.signals, now);
    state.step_signals(snapshot, roster, self, commands);
    std::erase_if(state.vehicles, [&](const auto& entry) { return entry.second.is_idle(now); });
    std::erase_if(state.signals, [&](const auto& entry) { return entry.second.is_idle(now); });
}

void Actuator::restore_all(std::vector<traffic::Command>& commands) {
    for (auto& [key, vehicle] : state_->vehicles)
        vehicle.restore(commands);
    for (auto& [index, signal] : state_->signals)
        signal.restore(commands);
    state_->vehicles.clear();
    state_->signals.clear();
}

std::size_t Actuator::active() const {
    std::size_t sum = 0;
    for (const auto& [key, vehicle] : state_->vehicles)
        sum += vehicle.active();
    for (const auto& [index, signal] : state_->signals)
        sum += signal.active();
    return sum;
}

std::vector<traffic::SignalStatus> Actuator::signals() const {
    std::vector<traffic::SignalStatus> all;
    all.reserve(state_->signals.size());
    for (const auto& [index, signal] : state_->signals)
        all.push_back(signal.status(state_->last_step.value_or(core::Seconds(0.0))));
    return all;
}

const LeaseLedger& Actuator::counts() const {
    return state_->ledger.counts();
}

}  // namespace clearway::actuation
