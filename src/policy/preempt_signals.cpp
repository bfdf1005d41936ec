#include "policy/preempt_signals.hpp"

#include <algorithm>
#include <optional>

#include "policy/detail/approach.hpp"
#include "roads/short_loops.hpp"

namespace clearway::policy {
namespace {

/// Whether every way that the emergency vehicle may take ends at standing vehicles.
bool leads_into_a_queue(const roads::Signal& signal, const detail::Approach& approach,
                        const detail::Room& room, double least_m) {
    return std::ranges::all_of(
        approach.own_links, [&](std::uint16_t link) { return room.is_blocked(signal.links[link], least_m); });
}

}  // namespace

PreemptSignals::PreemptSignals(const PolicyContext& context, PreemptSignalsConfig config,
                               RequestMemorySettings memory)
    : ConfiguredPolicy(context, config), memory_(memory) {
    if (config_.short_block_m > 0.0)
        is_careful_ = roads::on_short_loops(context_.network, config_.short_block_m);
    if (config_.timing != HoldTiming::lead)
        planner_.emplace(detail::HoldPlanner::Settings{
            config_.emergency_worth, config_.least_gain_s, config_.longest_early_s, config_.longest_late_s,
            config_.timing == HoldTiming::queues ? detail::ModelSight::all : detail::ModelSight::none});
}

double PreemptSignals::arrival_s(const detail::View& view, const traffic::BelievedVehicle& emergency,
                                 double distance_m) const {
    const double slowest_mps = config_.slowest_share * view.allowed_speed(emergency).value;
    const double speed_mps = std::max<double>(emergency.state.speed_mps, slowest_mps);
    return distance_m / std::max(speed_mps, 0.1);
}

void PreemptSignals::ask(const traffic::BelievedGraph& belief,
                         std::vector<traffic::PriorityRequest>& wanted) const {
    const detail::View view(context_.network, belief);
    const roads::Network& network = context_.network;
    for (const traffic::BelievedVehicle& own : belief.own_states) {
        if (!view.is_on_route(own)) continue;
        std::set<core::SignalIndex> listed;
        for (detail::Approach& approach : detail::approaches(view, own, core::Metres(config_.horizon_m))) {
            if (!listed.insert(approach.signal).second) continue;
            const roads::SignalLink& way =
                network.signal(approach.signal).links[approach.own_links.front()].front();
            traffic::PriorityRequest request;
            request.vehicle = own.key;
            request.signal = approach.signal;
            request.edge_in = network.lane(way.from).edge;
            request.edge_out = network.lane(way.to).edge;
            request.connections = std::move(approach.own_links);
            request.distance_m = approach.distance_m;
            request.eta = belief.time + core::Seconds(arrival_s(view, own, approach.distance_m));
            request.window = core::Seconds(memory_.window_s);
            request.sent = belief.time;
            request.motion = own.state;
            wanted.push_back(std::move(request));
        }
    }
}

void PreemptSignals::hear(std::span<const traffic::PriorityRequest> messages) {
    if (!table_) table_.emplace(memory_, detail::RequestTable::Reach{config_.horizon_m, config_.halted_mps});
    inbox_.insert(inbox_.end(), messages.begin(), messages.end());
}

std::vector<RequestKey> PreemptSignals::open_requests() const {
    return table_ ? table_->open() : std::vector<RequestKey>{};
}

std::vector<detail::Arrival> PreemptSignals::arrivals(const detail::View& view) {
    if (table_) {
        table_->update(view, inbox_);
        inbox_.clear();
        return table_->arrivals(view.belief().time);
    }
    std::vector<detail::Arrival> found;
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        int number = 0;
        for (detail::Approach& approach :
             detail::approaches(view, emergency, core::Metres(config_.horizon_m)))
            found.push_back({emergency, std::move(approach), ++number, 0.0, std::nullopt});
    }
    return found;
}

bool PreemptSignals::stands_back(const detail::Arrival& arrival, const detail::Room* room,
                                 bool is_asked) const {
    const core::SignalIndex signal = arrival.approach.signal;
    if (is_careful_.empty() || !is_careful_[signal.value]) return false;
    if (config_.signals_ahead > 0 && arrival.number > config_.signals_ahead) return true;
    return room != nullptr && !is_asked &&
           leads_into_a_queue(context_.network.signal(signal), arrival.approach, *room, config_.exit_room_m);
}

double PreemptSignals::early_s(const detail::View& view, const detail::Arrival& arrival) const {
    const double left_m = std::max(0.0, arrival.approach.distance_m - arrival.moved_m);
    const double until_s = arrival.announced_s.value_or(arrival_s(view, arrival.emergency, left_m));
    const auto halted = static_cast<double>(detail::queue_ahead(
        view, arrival.emergency, {arrival.moved_m, arrival.approach.distance_m}, config_.halted_mps));
    return until_s - std::min(config_.lead_s + config_.lead_per_halted_s * halted, config_.longest_lead_s);
}

bool PreemptSignals::is_due(const detail::View& view, const detail::Arrival& arrival, bool is_asked) {
    if (is_asked && !planner_) return true;
    const double early_s = this->early_s(view, arrival);
    return planner_ ? planner_->is_due(view, arrival, early_s, is_asked) : early_s <= 0.0;
}

void PreemptSignals::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("preempt_signals", context_.period, belief.time, leases, config_.lease_s);
    if (planner_) planner_->begin(view);
    std::set<RequestKey> asked;
    std::optional<detail::Room> room;
    if (!is_careful_.empty() && config_.exit_room_m > 0.0)
        room.emplace(context_.network, belief, config_.halted_mps);
    for (const detail::Arrival& arrival : arrivals(view)) {
        const RequestKey request{arrival.emergency.key, arrival.approach.signal};
        const bool is_asked = asked_.contains(request);
        if (stands_back(arrival, room ? &*room : nullptr, is_asked)) continue;
        if (!is_due(view, arrival, is_asked)) continue;
        asked.insert(request);
        write.add(request.second, traffic::HoldGreen{arrival.approach.links, arrival.approach.own_links},
                  "an emergency vehicle arrives", request.first);
    }
    asked_ = std::move(asked);
}

}  // namespace clearway::policy
