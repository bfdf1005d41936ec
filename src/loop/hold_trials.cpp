#include "loop/hold_trials.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "loop/closed_loop.hpp"
#include "loop/copy_of_run.hpp"
#include "roads/route.hpp"

namespace clearway::loop {
namespace {

/// A vehicle is near a signal: 43 s at 50 km/h. PreemptSignals looks as far.
constexpr core::Metres near_by{600.0};
/// From the moment when it comes near, the last time that is tried, s.
constexpr double last_s = 42.0;
/// So long the others are watched where their time has a price: the longest hold, and two cycles after it.
constexpr core::Seconds watched{240.0};

}  // namespace

HoldTrials::HoldTrials(const roads::Network& network, const experiment::LoopConfig& config,
                       std::vector<bool> equipped, std::filesystem::path folder)
    : network_(network), config_(config), equipped_(std::move(equipped)), folder_(std::move(folder)) {}

void HoldTrials::look(ClosedLoop& loop, core::Seconds horizon) {
    trials_.note(loop.events());
    for (std::uint32_t row = 0; row < loop.snapshot().size(); ++row)
        if (const auto request = due(loop, row)) try_holds(loop, *request, horizon);
}

std::optional<policy::RequestKey> HoldTrials::due(const ClosedLoop& loop, std::uint32_t row) {
    const truth::Snapshot& snapshot = loop.snapshot();
    if (snapshot.vehicle_class[row] != traffic::VehicleClass::emergency || !snapshot.lane[row].exists())
        return std::nullopt;
    const core::VehicleKey vehicle = snapshot.key[row];
    traffic::MotionState state;
    state.lane = snapshot.lane[row];
    state.lane_position_m = snapshot.lane_position_m[row];
    state.route_edge = snapshot.route_edge[row];
    const auto& route = loop.roster().route(loop.roster().find(vehicle)->route);
    double& next_s = next_s_.try_emplace(vehicle, 0.0).first->second;
    for (const roads::StopLine& line : roads::signals_ahead(network_, route, state, near_by)) {
        const bool is_equipped = equipped_.empty() || equipped_[line.signal.value];
        if (!is_equipped || line.links.empty() || !seen_.insert({vehicle, line.signal}).second) continue;
        if (snapshot.time.value + core::clock_tolerance_s < next_s) continue;
        next_s = snapshot.time.value + config_.holds_every_s;
        return policy::RequestKey{vehicle, line.signal};
    }
    return std::nullopt;
}

void HoldTrials::try_holds(ClosedLoop& loop, policy::RequestKey request, core::Seconds horizon) {
    const core::Seconds now = loop.snapshot().time;
    const core::Seconds watched_for = config_.others_price > 0.0 ? watched : core::Seconds{};
    const auto end_with = [&](std::optional<core::Seconds> from) {
        const auto change = [&] {
            if (from) loop.hold_from(request, *from);
            return true;
        };
        return in_copy(folder_,
                       [&] { return loop.end_after(change, request.first, horizon, folder_, watched_for); });
    };
    const auto cost_s = [&](const CopyEnd& end) {
        return end.arrival.value + config_.others_price * end.others_s;
    };
    double earliest_s = horizon.value;
    double least_s = std::numeric_limits<double>::infinity();
    std::optional<core::Seconds> best;
    for (int number = 0; number < config_.holds_tried; ++number) {
        const int last = config_.holds_tried - 2;  // behind it, never
        const core::Seconds from(number > last ? std::numeric_limits<double>::infinity()
                                               : now.value + last_s * number / std::max(last, 1));
        const CopyEnd end = end_with(from);
        earliest_s = std::min(earliest_s, end.arrival.value);
        if (cost_s(end) >= least_s) continue;
        least_s = cost_s(end);
        best = from;
    }
    trials_.add({request.first}, {earliest_s}, static_cast<std::uint64_t>(config_.holds_tried));
    if (config_.best_hold_taken != 0 && least_s < cost_s(end_with(std::nullopt)))
        loop.hold_from(request, *best);
}

}  // namespace clearway::loop
