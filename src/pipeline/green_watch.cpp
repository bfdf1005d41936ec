#include "pipeline/green_watch.hpp"

#include <algorithm>
#include <cassert>

#include "roads/route.hpp"

namespace clearway::pipeline {
namespace {

/// Farther ahead than signals are ever asked, m.
constexpr double horizon_m = 5000.0;

bool is_green(traffic::RequestStatus status) {
    return status == traffic::RequestStatus::granted || status == traffic::RequestStatus::watch_other_traffic;
}

}  // namespace

void GreenWatch::step(std::span<const traffic::SignalStatus> signals, const truth::Snapshot& snapshot,
                      const traffic::Roster& roster) {
    const double now_s = snapshot.time.value;
    for (const traffic::SignalStatus& signal : signals) {
        for (const traffic::SignalCall& call : signal.calls) {
            if (call.emergency == core::VehicleKey{} || !is_green(call.status)) continue;
            const policy::RequestKey key{call.emergency, signal.signal};
            const auto [green, begins] = greens_.try_emplace(key);
            green->second.seen_s = now_s;
            if (!begins) continue;
            ++counts_.greens;
            green->second.began_s = now_s;
            green->second.line = line_ahead(key, snapshot, roster);
        }
    }
    for (auto& [key, green] : greens_)
        green.is_used = green.is_used || has_passed(key, green, snapshot);
    std::erase_if(greens_, [&](const auto& entry) {
        const Green& green = entry.second;
        if (green.seen_s == now_s) return false;
        if (!green.is_used) {
            ++counts_.useless;
            counts_.useless_s += now_s - green.began_s;
        }
        return true;
    });
}

std::optional<std::uint32_t> GreenWatch::line_ahead(const policy::RequestKey& key,
                                                    const truth::Snapshot& snapshot,
                                                    const traffic::Roster& roster) const {
    const auto row = snapshot.row_of(key.first);
    const traffic::VehicleInfo* const info = roster.find(key.first);
    if (!row || info == nullptr || !info->route.exists() || !snapshot.lane[*row].exists())
        return std::nullopt;
    const roads::Route route = roster.route(info->route);
    const traffic::MotionState state = snapshot.motion(*row);
    if (state.route_edge >= route.size()) return std::nullopt;
    const auto lines = roads::signals_ahead(network_, route, state, core::Metres(horizon_m));
    const auto line = std::ranges::find(lines, key.second, &roads::StopLine::signal);
    if (line == lines.end()) return std::nullopt;
    const auto edge = std::find(route.begin() + state.route_edge, route.end(), line->edge);
    assert(edge != route.end());
    return static_cast<std::uint32_t>(edge - route.begin());
}

bool GreenWatch::has_passed(const policy::RequestKey& key, const Green& green,
                            const truth::Snapshot& snapshot) const {
    if (!green.line) return false;
    const auto row = snapshot.row_of(key.first);
    if (!row) return true;
    const traffic::MotionState state = snapshot.motion(*row);
    if (state.route_edge != *green.line) return state.route_edge > *green.line;
    return state.lane.exists() && network_.edge(network_.lane(state.lane).edge).internal;
}

}  // namespace clearway::pipeline
