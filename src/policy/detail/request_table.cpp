#include "policy/detail/request_table.hpp"

#include <algorithm>
#include <cassert>

namespace clearway::policy::detail {
namespace {

/// Room of a standing vehicle with its gap, m.
constexpr double standing_m = 7.5;
/// A vehicle was seen, and not only believed, if the report is not older than this: reports come at 1 Hz.
constexpr double sighting_s = 1.0;

const Approach* approach_to(const std::vector<Approach>& ahead, core::SignalIndex signal) {
    const auto found = std::ranges::find(ahead, signal, &Approach::signal);
    return found == ahead.end() ? nullptr : &*found;
}

/// Whether a signal is known to show green to none of the vehicle's ways.
bool is_shut(const traffic::BelievedGraph& belief, const Approach& approach) {
    if (approach.signal.value >= belief.signals.state.size()) return false;
    const std::string& shown = belief.signals.state[approach.signal.value];
    return !shown.empty() && std::ranges::none_of(approach.own_links, [&](std::uint16_t link) {
        return traffic::is_green_for(shown, link);
    });
}

}  // namespace

void RequestTable::update(const View& view, std::span<const traffic::PriorityRequest> messages) {
    for (const traffic::PriorityRequest& message : messages)
        take(view, message);
    const double now_s = view.belief().time.value;
    for (auto& [key, entry] : entries_) {
        if (entry.is_open) look(view, entry);
        if (entry.is_open && reckons()) reckon(view, entry);
        if (entry.is_open && is_over(entry, now_s)) entry.is_open = false;
    }
}

void RequestTable::take(const View& view, const traffic::PriorityRequest& message) {
    const RequestKey key{message.vehicle, message.signal};
    assert(message.sent <= view.belief().time);
    const auto known = entries_.find(key);
    if (message.type == traffic::RequestType::cancellation) {
        if (known != entries_.end()) known->second.is_open = false;
        return;
    }
    // The vehicle was seen behind the stop line while this message was on its way.
    if (known != entries_.end() && !known->second.is_open && message.sent.value <= known->second.measured_s)
        return;
    Entry& entry = entries_[key];
    const bool is_news = !entry.is_open || message.sent.value >= entry.measured_s;
    entry.message = message;
    entry.heard_s = view.belief().time.value;
    entry.is_open = true;
    if (is_news) {
        place(view, entry, {message.vehicle, traffic::VehicleClass::emergency, message.motion, 0.0F, 0.0F},
              message.sent.value);
        entry.reckoned_s = message.sent.value;
    }
}

void RequestTable::place(const View& view, Entry& entry, const traffic::BelievedVehicle& emergency,
                         double measured_s) const {
    entry.emergency = emergency;
    entry.measured_s = measured_s;
    entry.moved_m = 0.0;
    entry.is_seen = false;
    entry.ahead = approaches(view, emergency, core::Metres(reach_.horizon_m));
}

void RequestTable::look(const View& view, Entry& entry) const {
    const traffic::BelievedVehicle* const seen = view.belief().find(entry.message.vehicle);
    if (seen == nullptr || !view.is_on_route(*seen)) return;
    const double now_s = view.belief().time.value;
    const double seen_s = now_s - seen->age_s;
    const bool believes = settings_.memory == RequestMemory::graph;
    // What the graph makes of one report gets better with time; what it knows from before the message does
    // not.
    const bool is_newer = seen_s > entry.measured_s + core::clock_tolerance_s ||
                          (entry.is_seen && seen_s > entry.measured_s - core::clock_tolerance_s);
    if (!is_newer || (!believes && seen->age_s > sighting_s)) return;
    const auto lines = roads::signals_ahead(view.network(), view.route_of(seen->key), seen->state,
                                            core::Metres(reach_.horizon_m));
    const bool is_before =
        std::ranges::find(lines, entry.message.signal, &roads::StopLine::signal) != lines.end();
    if (!is_before) {
        entry.is_open = false;
        entry.measured_s = seen_s;
    } else if (believes) {
        place(view, entry, *seen, seen_s);
        entry.is_seen = true;
        entry.reckoned_s = now_s;  // The graph is about now, whatever the age of what it rests on.
    }
}

void RequestTable::reckon(const View& view, Entry& entry) const {
    const Approach* const own = approach_to(entry.ahead, entry.message.signal);
    if (own == nullptr) return;
    const double now_s = view.belief().time.value;
    const auto shut = std::ranges::find_if(entry.ahead, [&](const Approach& approach) {
        return approach.distance_m >= entry.moved_m && is_shut(view.belief(), approach);
    });
    const bool is_held = shut != entry.ahead.end() && shut->distance_m <= own->distance_m;
    double limit_m = is_held ? shut->distance_m : own->distance_m;
    const auto standing = static_cast<double>(
        queue_ahead(view, entry.emergency, {entry.moved_m, own->distance_m}, reach_.halted_mps));
    if (standing > 0.0) limit_m = std::min(limit_m, own->distance_m - standing * standing_m);
    const double free_m = entry.moved_m + entry.emergency.state.speed_mps * (now_s - entry.reckoned_s);
    entry.moved_m = std::max(entry.moved_m, std::min(free_m, limit_m));
    entry.reckoned_s = now_s;
    const bool may_have_passed = entry.moved_m >= own->distance_m && !is_held;
    if (!may_have_passed) entry.at_line_s.reset();
    if (may_have_passed && !entry.at_line_s) entry.at_line_s = now_s;
}

bool RequestTable::is_over(const Entry& entry, double now_s) const {
    const auto exceeds = [](double time_s, double limit_s) {
        return time_s > limit_s + core::clock_tolerance_s;
    };
    if (approach_to(entry.ahead, entry.message.signal) == nullptr) return true;
    if (exceeds(now_s - entry.message.sent.value, settings_.longest_memory_s)) return true;
    switch (settings_.memory) {
        case RequestMemory::forget:
            return exceeds(now_s - entry.heard_s, settings_.timeout_s);
        case RequestMemory::hold_eta:
            return exceeds(now_s - entry.message.eta.value, entry.message.window.value);
        case RequestMemory::dead_reckon:
        case RequestMemory::graph:
            return entry.at_line_s && exceeds(now_s - *entry.at_line_s, entry.message.window.value);
    }
    return true;
}

std::vector<Arrival> RequestTable::arrivals(core::Seconds now) const {
    std::vector<Arrival> found;
    for (const auto& [key, entry] : entries_) {
        if (!entry.is_open) continue;
        const Approach& own = *approach_to(entry.ahead, key.second);
        const int number = static_cast<int>(&own - entry.ahead.data()) + 1;
        std::optional<double> announced_s;
        const bool is_of_now = now.value - entry.measured_s < core::clock_tolerance_s;
        if (settings_.memory == RequestMemory::hold_eta && !is_of_now)
            announced_s = std::max(0.0, (entry.message.eta - now).value);
        found.push_back({entry.emergency, own, number, entry.moved_m, announced_s});
    }
    std::ranges::stable_sort(found, {}, [](const Arrival& arrival) {
        return std::pair(arrival.emergency.key, arrival.approach.distance_m - arrival.moved_m);
    });
    return found;
}

std::vector<RequestKey> RequestTable::open() const {
    std::vector<RequestKey> keys;
    for (const auto& [key, entry] : entries_) {
        if (entry.is_open) keys.push_back(key);
    }
    return keys;
}

}  // namespace clearway::policy::detail
