#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.hpp"
#include "metrics/road_layout.hpp"
#include "metrics/run_metrics.hpp"
#include "traffic/vehicle.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// How smoothly and how lawfully vehicles move: hard braking and jerk, passages of stop lines on green and
/// red, queues at signals. Linear in the vehicles on the road; does not allocate once its buffers have grown.
class FlowWatch {
  public:
    /// Braking of vehicles other than emergency vehicles counts as hard above this deceleration, m/s^2, which
    /// most drivers do not exceed (AASHTO Green Book, stopping sight distance).
    static constexpr float hard_braking_mps2 = 3.4F;

    /// The layout outlives the watch.
    explicit FlowWatch(const RoadLayout& layout) : layout_(layout), halted_(layout.approaches.size()) {}

    /// One step; `before` has the row that each vehicle had at the step before (core/match_rows.hpp). The
    /// first step only sets the clock.
    void step(const truth::Snapshot& snapshot, const std::vector<std::uint32_t>& before);

    /// Writes jerk (root mean square over steps and vehicles other than emergency vehicles), hard brakings,
    /// passages on red, and of signals: throughput while demand departs, and standing vehicles, most at once
    /// and mean over approaches and the time in which demand departs. Empty without any.
    void describe(RunMetrics& metrics) const;

  private:
    std::optional<double> mean_queue_vehicles() const;
    void compare(const truth::Snapshot& snapshot, core::VehicleIndex row, std::size_t before,
                 double elapsed_s);
    void pass(const truth::Snapshot& snapshot, core::VehicleIndex row, core::LaneIndex from);
    void count_queues(const truth::Snapshot& snapshot, double elapsed_s);
    bool was_red(const truth::Snapshot& snapshot, const SignalWay& way) const;

    const RoadLayout& layout_;
    std::uint64_t hard_brakings_ = 0;
    double squared_jerk_ = 0.0;
    std::uint64_t jerk_count_ = 0;
    std::uint64_t emergency_red_passages_ = 0;
    std::uint64_t others_red_passages_ = 0;
    std::uint64_t passages_of_demand_ = 0;
    double queue_time_s_ = 0.0;  ///< Vehicles x time, over all approaches to signals.
    std::uint32_t longest_queue_ = 0;
    double demand_time_s_ = 0.0;
    std::vector<std::uint32_t> halted_;  ///< By approach, now.
    double last_s_ = -1.0;
    /// State at the previous step, by its rows.
    std::vector<core::LaneIndex> lane_;
    std::vector<float> acceleration_mps2_;
    std::vector<std::string> shown_;
};

}  // namespace clearway::metrics::detail
