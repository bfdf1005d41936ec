#include "loop/dispatcher.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "loop/closed_loop.hpp"
#include "loop/copy_of_run.hpp"
#include "roads/closure.hpp"

namespace clearway::loop {
namespace {

using experiment::Dispatch;

/// How often true times are taken, s: as beliefs by default.
constexpr double period_s = 0.5;

}  // namespace

Dispatcher::Dispatcher(const roads::Network& network, DispatchOrders orders)
    : network_(network),
      orders_(std::move(orders)),
      fleet_(orders_.calls.stations),
      search_(network, roads::Driver::emergency),
      times_(network, search_, {}),
      noted_(-period_s) {}

void Dispatcher::see(const traffic::BelievedGraph& belief, core::Seconds period) {
    if (!reads_belief()) return;
    times_.see(belief, period);
    known_ = belief.incidents;
}

void Dispatcher::note(const truth::Snapshot& snapshot) {
    if (orders_.by != Dispatch::true_times || !is_waiting() ||
        now_.value + core::clock_tolerance_s < noted_.value + period_s)
        return;
    noted_ = now_;
    times_.turn_to(now_);
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] != traffic::VehicleClass::emergency)
            times_.add(snapshot.lane[row], snapshot.speed_mps[row], core::Seconds(period_s));
    }
}

bool Dispatcher::is_closed(core::EdgeIndex edge, core::Seconds now) const {
    if (orders_.by == Dispatch::believed)
        return std::ranges::any_of(known_, [&](const traffic::KnownIncident& incident) {
            return incident.edge == edge && incident.closed_to_emergency;
        });
    if (orders_.by != Dispatch::true_times) return false;
    return std::ranges::any_of(orders_.incidents, [&](const scenario::PlacedIncident& placed) {
        const traffic::Incident& incident = placed.closed;
        return incident.edge == edge && incident.from.value <= now.value && now.value < incident.to.value &&
               roads::closes_to_emergency(network_, incident);
    });
}

std::vector<scenario::Sending> Dispatcher::candidates(const scenario::PlacedCall& call) {
    const bool looks = orders_.by == Dispatch::believed || orders_.by == Dispatch::true_times;
    const auto edge_s = [&](core::EdgeIndex edge, double entered_s) {
        if (edge != call.edge && is_closed(edge, now_)) return roads::no_way_s;
        return looks ? times_.at(edge, call.turnout.value + entered_s, 1.0) : search_.free_s(edge);
    };
    std::vector<scenario::Sending> found = fleet_.candidates(call, search_, edge_s);
    if (orders_.by == Dispatch::straight_line)
        for (scenario::Sending& each : found)
            each.cost = scenario::straight_m(network_, fleet_.stations()[each.station], call);
    return found;
}

void Dispatcher::step(ClosedLoop& loop, core::Seconds horizon) {
    now_ = loop.snapshot().time;
    for (const core::VehicleKey vehicle : loop.events().arrived)
        arrived_s_.emplace(vehicle, now_.value);
    note(loop.snapshot());
    while (is_waiting() && orders_.calls.calls[next_call_].at.value <= now_.value + core::clock_tolerance_s) {
        if (next_unit_ < orders_.calls.calls[next_call_].units) {
            answer(loop, horizon);
        } else {
            ++next_call_;
            next_unit_ = 0;
        }
    }
}

void Dispatcher::answer(ClosedLoop& loop, core::Seconds horizon) {
    std::vector<scenario::Sending> found = candidates(orders_.calls.calls[next_call_]);
    const scenario::Sending* const best = scenario::cheapest(found);
    if (best == nullptr) {
        ++counts_.missing;
        ++next_unit_;
        return;
    }
    const scenario::Sending chosen = *best;
    if (orders_.units_tried > 0 && found.size() > 1) try_units(loop, horizon, chosen, std::move(found));
    send(loop, chosen);
}

void Dispatcher::try_units(ClosedLoop& loop, core::Seconds horizon, const scenario::Sending& chosen,
                           std::vector<scenario::Sending> others) {
    const scenario::PlacedCall& call = orders_.calls.calls[next_call_];
    const core::VehicleKey vehicle = core::vehicle_key(call.vehicle(next_unit_));
    std::ranges::stable_sort(others, {}, &scenario::Sending::cost);
    others.resize(std::min(others.size(), static_cast<std::size_t>(orders_.units_tried)));
    add_free_ways(call, others);
    Trial trial{vehicle, std::numeric_limits<double>::infinity(), 0};
    for (const scenario::Sending& each : others) {
        if (each.station == chosen.station) continue;
        const core::Seconds arrival = in_copy(orders_.folder, [&] {
            const auto change = [&] {
                orders_.units_tried = 0;
                send(loop, each);
                step(loop, horizon);  // the other vehicles of this step
                return true;
            };
            return loop.arrival_after(change, vehicle, horizon, orders_.folder);
        });
        trial.best_s = std::min(trial.best_s, arrival.value);
        ++trial.units;
    }
    if (trial.units > 0) trials_.push_back(trial);
}

void Dispatcher::add_free_ways(const scenario::PlacedCall& call, std::vector<scenario::Sending>& others) {
    const auto free_s = [&](core::EdgeIndex edge, double) { return search_.free_s(edge); };
    const std::size_t stations = others.size();
    for (scenario::Sending& each : fleet_.candidates(call, search_, free_s)) {
        const auto same = std::find_if(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(stations),
                                       [&](const auto& other) { return other.station == each.station; });
        if (same != others.begin() + static_cast<std::ptrdiff_t>(stations) && same->way != each.way)
            others.push_back(std::move(each));
    }
}

void Dispatcher::send(ClosedLoop& loop, const scenario::Sending& sending) {
    const scenario::PlacedCall& call = orders_.calls.calls[next_call_];
    const std::string id = call.vehicle(next_unit_);
    const auto planned = std::ranges::find(orders_.vehicles, id, &traffic::EmergencyDeparture::id);
    assert(planned != orders_.vehicles.end());
    traffic::EmergencyDeparture departure = *planned;
    departure.edges.clear();
    for (const core::EdgeIndex edge : sending.way)
        departure.edges.push_back(network_.edge(edge).id);
    departure.depart = core::Seconds(std::max(departure.depart.value, now_.value));
    loop.send(departure, call.before_incident);
    fleet_.send_from(sending.station);
    ++counts_.sent;
    ++next_unit_;
}

metrics::DispatchCounts Dispatcher::result(core::Seconds horizon) const {
    constexpr double level_s = 1.0;  // the longest step
    metrics::DispatchCounts counts = counts_;
    for (const Trial& trial : trials_) {
        const auto arrived = arrived_s_.find(trial.vehicle);
        const double chosen_s = arrived == arrived_s_.end() ? horizon.value : arrived->second;
        const double regret_s = std::max(0.0, chosen_s - trial.best_s);
        ++counts.decisions;
        counts.regret_s += regret_s;
        counts.wrong += regret_s > level_s ? 1 : 0;
    }
    return counts;
}

}  // namespace clearway::loop
