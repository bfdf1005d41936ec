#include "loop/dispatcher.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

#include "loop/closed_loop.hpp"
#include "loop/copy_of_run.hpp"
#include "roads/closure.hpp"

namespace clearway::loop {
namespace {

using experiment::Dispatch;

}  // namespace

Dispatcher::Dispatcher(const roads::Network& network, DispatchOrders orders)
    : network_(network),
      orders_(std::move(orders)),
      fleet_(orders_.calls.stations),
      search_(network, roads::Driver::emergency),
      times_(network, search_, {}),
      noted_(-orders_.period.value) {}

void Dispatcher::see(const traffic::BelievedGraph& belief) {
    if (!reads_belief()) return;
    times_.see(belief, orders_.period);
    known_ = belief.incidents;
}

void Dispatcher::note(const truth::Snapshot& snapshot) {
    if (orders_.by != Dispatch::true_times || !is_waiting() ||
        now_.value + core::clock_tolerance_s < noted_.value + orders_.period.value)
        return;
    noted_ = now_;
    times_.turn_to(now_);
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] != traffic::VehicleClass::emergency)
            times_.add(snapshot.lane[row], snapshot.speed_mps[row], orders_.period);
    }
}

bool Dispatcher::is_closed(core::EdgeIndex edge) const {
    if (orders_.by == Dispatch::believed) return traffic::closes(known_, edge);
    if (orders_.by != Dispatch::true_times) return false;
    return std::ranges::any_of(orders_.incidents, [&](const scenario::PlacedIncident& placed) {
        const traffic::Incident& incident = placed.closed;
        return incident.edge == edge && incident.from.value <= now_.value && now_.value < incident.to.value &&
               roads::closes_to_emergency(network_, incident);
    });
}

std::vector<scenario::Sending> Dispatcher::candidates(const scenario::PlacedCall& call) {
    constexpr double pace = 1.0;
    const bool looks = orders_.by == Dispatch::believed || orders_.by == Dispatch::true_times;
    const auto edge_s = [&](core::EdgeIndex edge, double entered_s) {
        if (edge != call.edge && is_closed(edge)) return roads::no_way_s;
        return looks ? times_.at(edge, call.turnout.value + entered_s, pace) : search_.free_s(edge);
    };
    std::vector<scenario::Sending> found = fleet_.candidates(call, search_, edge_s);
    if (orders_.by == Dispatch::straight_line)
        for (scenario::Sending& each : found)
            each.cost = scenario::straight_m(network_, fleet_.stations()[each.station], call);
    return found;
}

void Dispatcher::step(ClosedLoop& loop, core::Seconds horizon) {
    now_ = loop.snapshot().time;
    trials_.note(loop.events());
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
    const bool is_last = next_unit_ + 1 == orders_.calls.calls[next_call_].units;
    // Before, the units of other stations may still be sent, too.
    if (orders_.units_tried > 0 && is_last && found.size() > 1)
        try_units(loop, horizon, chosen, std::move(found));
    send(loop, chosen);
}

void Dispatcher::try_units(ClosedLoop& loop, core::Seconds horizon, const scenario::Sending& chosen,
                           std::vector<scenario::Sending> others) {
    const scenario::PlacedCall& call = orders_.calls.calls[next_call_];
    const core::VehicleKey vehicle = core::vehicle_key(call.vehicle(next_unit_));
    std::ranges::stable_sort(others, {}, &scenario::Sending::cost);
    others.resize(std::min(others.size(), static_cast<std::size_t>(orders_.units_tried)));
    add_free_ways(call, others);
    std::map<std::size_t, double> arrivals_s;  // by station
    std::uint64_t tried = 0;
    for (const scenario::Sending& each : others) {
        if (each.station == chosen.station) continue;
        const core::Seconds arrival = in_copy(orders_.folder, [&] {
            const auto change = [&] {
                send(loop, each);
                step(loop, horizon);  // the other vehicles of this step
                return true;
            };
            return loop.end_after(change, vehicle, horizon, orders_.folder).arrival;
        });
        const auto [known, is_new] = arrivals_s.try_emplace(each.station, arrival.value);
        known->second = std::min(known->second, arrival.value);
        ++tried;
    }
    if (tried == 0) return;
    std::vector<double> others_s;
    for (const auto& [station, arrival_s] : arrivals_s)
        others_s.insert(others_s.end(), std::min(fleet_.stations()[station].units, call.units), arrival_s);
    std::vector<core::VehicleKey> vehicles;
    for (std::uint32_t unit = 0; unit <= next_unit_; ++unit)  // where one is missing, all later ones are
        vehicles.push_back(core::vehicle_key(call.vehicle(unit)));
    trials_.add(std::move(vehicles), std::move(others_s), tried);
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
    metrics::DispatchCounts counts = counts_;
    counts.units = trials_.result(horizon);
    return counts;
}

}  // namespace clearway::loop
