#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "roads/network.hpp"

namespace clearway::roads::detail {

/// Along a lane at its limit, s; infinite where that is 0.
inline double free_flow_s(const Lane& lane) {
    return lane.speed_limit_mps > 0.0F ? static_cast<double>(lane.length_m) / lane.speed_limit_mps
                                       : std::numeric_limits<double>::infinity();
}

/// Edges of a search, the one with the least time first. Cleared, it keeps its memory.
class LeastFirst {
  public:
    using Entry = std::pair<double, std::uint32_t>;  ///< Time, s, and edge.

    bool empty() const { return entries_.empty(); }
    void clear() { entries_.clear(); }
    void push(double time_s, core::EdgeIndex edge) {
        entries_.emplace_back(time_s, edge.value);
        std::ranges::push_heap(entries_, std::greater{});
    }
    Entry pop() {
        std::ranges::pop_heap(entries_, std::greater{});
        const Entry least = entries_.back();
        entries_.pop_back();
        return least;
    }

  private:
    std::vector<Entry> entries_;
};

}  // namespace clearway::roads::detail
