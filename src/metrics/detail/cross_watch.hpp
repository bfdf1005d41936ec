#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "metrics/road_layout.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// Time that vehicles lose on the cross streets of signals after emergency vehicles. The 15 minutes begin
/// when the emergency vehicle could be at the stop line if nothing delayed it: then they are the same in
/// every condition of a replication, and differences are those of one place and time. From each condition's
/// own passage, the baseline's would be counted later, when traffic may be another.
class CrossWatch {
  public:
    static constexpr double window_s = 900.0;

    /// The layout outlives the watch.
    explicit CrossWatch(const RoadLayout& layout);

    /// One step; the first only sets the clock.
    void step(const truth::Snapshot& snapshot);
    /// Vehicle-seconds per passage, over the approaches other than that of the emergency vehicle; nothing if
    /// no route passes a signal. Overlapping windows count once.
    std::optional<double> delay_s() const;

  private:
    using Window = std::pair<double, double>;

    const RoadLayout& layout_;
    std::vector<std::vector<Window>> windows_;  ///< By approach; ascending, apart.
    std::vector<std::uint8_t> is_open_;         ///< By approach, now.
    std::size_t passages_ = 0;
    double lost_s_ = 0.0;
    double last_s_ = -1.0;
};

}  // namespace clearway::metrics::detail
