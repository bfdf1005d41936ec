#include "metrics/detail/flow_watch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/match_rows.hpp"
#include "metrics/detail/signal_ways.hpp"
#include "metrics/detail/standing.hpp"

namespace clearway::metrics::detail {
namespace {

bool is_red(const std::string& state, std::uint16_t link) {
    return link < state.size() && (state[link] == 'r' || state[link] == 'u');
}

}  // namespace

void FlowWatch::step(const truth::Snapshot& snapshot, const std::vector<std::uint32_t>& before) {
    assert(before.size() == snapshot.size());
    const double now_s = snapshot.time.value;
    const double elapsed_s = last_s_ < 0.0 ? 0.0 : now_s - last_s_;
    last_s_ = now_s;
    const bool demand_departs = now_s <= layout_.demand_until_s;
    if (demand_departs) demand_time_s_ += elapsed_s;
    for (core::VehicleIndex row = 0; row < snapshot.size() && elapsed_s > 0.0; ++row) {
        if (before[row] != core::no_row) compare(snapshot, row, before[row], elapsed_s);
    }
    count_queues(snapshot, demand_departs ? elapsed_s : 0.0);
    lane_ = snapshot.lane;
    acceleration_mps2_ = snapshot.acceleration_mps2;
    shown_ = snapshot.signals.state;
}

void FlowWatch::compare(const truth::Snapshot& snapshot, core::VehicleIndex row, std::size_t before,
                        double elapsed_s) {
    if (snapshot.lane[row] != lane_[before]) pass(snapshot, row, lane_[before]);
    if (snapshot.vehicle_class[row] == traffic::VehicleClass::emergency) return;
    const float acceleration = snapshot.acceleration_mps2[row];
    if (-acceleration > hard_braking_mps2 && -acceleration_mps2_[before] <= hard_braking_mps2)
        ++hard_brakings_;
    const double jerk = (acceleration - acceleration_mps2_[before]) / elapsed_s;
    squared_jerk_ += jerk * jerk;
    ++jerk_count_;
}

void FlowWatch::pass(const truth::Snapshot& snapshot, core::VehicleIndex row, core::LaneIndex from) {
    const SignalWay* const taken = signal_way(layout_, from, snapshot.lane[row]);
    if (taken == nullptr) return;
    if (snapshot.time.value <= layout_.demand_until_s) ++passages_of_demand_;
    if (!was_red(snapshot, *taken)) return;
    const bool is_emergency = snapshot.vehicle_class[row] == traffic::VehicleClass::emergency;
    ++(is_emergency ? emergency_red_passages_ : others_red_passages_);
}

/// Red before and after the step: a vehicle that crosses while the signal changes gets the benefit of the
/// doubt.
bool FlowWatch::was_red(const truth::Snapshot& snapshot, const SignalWay& way) const {
    const std::size_t signal = way.signal.value;
    return signal < shown_.size() && signal < snapshot.signals.state.size() &&
           is_red(shown_[signal], way.link) && is_red(snapshot.signals.state[signal], way.link);
}

void FlowWatch::count_queues(const truth::Snapshot& snapshot, double elapsed_s) {
    std::ranges::fill(halted_, 0U);
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.speed_mps[row] >= standing_mps) continue;
        const std::uint32_t lane = snapshot.lane[row].value;
        if (lane >= layout_.approach_of_lane.size()) continue;
        const std::int32_t approach = layout_.approach_of_lane[lane];
        if (approach == RoadLayout::no_approach) continue;
        const auto place = static_cast<std::size_t>(approach);
        assert(place < halted_.size());
        if (!layout_.approaches[place].signal.exists()) continue;
        longest_queue_ = std::max(longest_queue_, ++halted_[place]);
        queue_time_s_ += elapsed_s;
    }
}

std::optional<double> FlowWatch::mean_queue_vehicles() const {
    const auto approaches = std::ranges::count_if(
        layout_.approaches, [](const Approach& approach) { return approach.signal.exists(); });
    if (approaches == 0 || demand_time_s_ <= 0.0) return std::nullopt;
    return queue_time_s_ / demand_time_s_ / static_cast<double>(approaches);
}

void FlowWatch::describe(RunMetrics& metrics) const {
    metrics.emergency_red_passages = emergency_red_passages_;
    metrics.others_red_passages = others_red_passages_;
    metrics.others_hard_brakings = hard_brakings_;
    if (jerk_count_ > 0)
        metrics.others_jerk_mps3 = std::sqrt(squared_jerk_ / static_cast<double>(jerk_count_));
    metrics.signal_queue_vehicles = mean_queue_vehicles();
    if (layout_.signal_ways.empty()) return;
    metrics.signal_longest_queue_vehicles = longest_queue_;
    if (demand_time_s_ > 0.0)
        metrics.signal_throughput_per_hour =
            static_cast<double>(passages_of_demand_) / demand_time_s_ * 3600.0;
}

}  // namespace clearway::metrics::detail
