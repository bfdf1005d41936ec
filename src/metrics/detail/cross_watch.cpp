#include "metrics/detail/cross_watch.hpp"

#include <algorithm>
#include <cassert>

namespace clearway::metrics::detail {

CrossWatch::CrossWatch(const RoadLayout& layout)
    : layout_(layout), windows_(layout.approaches.size()), is_open_(layout.approaches.size()) {
    for (const WatchedRoute& route : layout.routes) {
        for (const RouteSignal& signal : route.signals) {
            ++passages_;
            for (std::size_t approach = 0; approach < windows_.size(); ++approach) {
                if (layout.approaches[approach].signal == signal.signal &&
                    static_cast<std::int32_t>(approach) != signal.approach)
                    windows_[approach].emplace_back(signal.earliest_s, signal.earliest_s + window_s);
            }
        }
    }
    for (std::vector<Window>& windows : windows_) {
        std::ranges::sort(windows);
        std::vector<Window> apart;
        for (const Window& window : windows) {
            if (!apart.empty() && window.first <= apart.back().second)
                apart.back().second = std::max(apart.back().second, window.second);
            else
                apart.push_back(window);
        }
        windows = std::move(apart);
    }
}

void CrossWatch::step(const truth::Snapshot& snapshot) {
    assert(snapshot.time.value >= last_s_);
    const double now_s = snapshot.time.value;
    const double elapsed_s = last_s_ < 0.0 ? 0.0 : now_s - last_s_;
    last_s_ = now_s;
    bool any_open = false;
    for (std::size_t approach = 0; approach < windows_.size(); ++approach) {
        is_open_[approach] = std::ranges::any_of(windows_[approach], [&](const Window& window) {
            return window.first <= now_s && now_s <= window.second;
        });
        any_open = any_open || is_open_[approach] != 0;
    }
    if (!any_open || elapsed_s <= 0.0) return;
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        const std::uint32_t lane = snapshot.lane[row].value;
        if (lane >= layout_.approach_of_lane.size() ||
            snapshot.vehicle_class[row] == traffic::VehicleClass::emergency)
            continue;
        const std::int32_t approach = layout_.approach_of_lane[lane];
        if (approach == RoadLayout::no_approach || is_open_[static_cast<std::size_t>(approach)] == 0)
            continue;
        const float limit_mps = layout_.limit_of_lane_mps[lane];
        if (snapshot.speed_mps[row] < limit_mps)
            lost_s_ += elapsed_s * (1.0 - static_cast<double>(snapshot.speed_mps[row] / limit_mps));
    }
}

std::optional<double> CrossWatch::delay_s() const {
    if (passages_ == 0) return std::nullopt;
    return lost_s_ / static_cast<double>(passages_);
}

}  // namespace clearway::metrics::detail
