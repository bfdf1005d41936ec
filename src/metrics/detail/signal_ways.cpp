#include "metrics/detail/signal_ways.hpp"

#include <algorithm>

namespace clearway::metrics::detail {

const SignalWay* signal_way(const RoadLayout& layout, core::LaneIndex from, core::LaneIndex to) {
    const std::vector<SignalWay>& ways = layout.signal_ways;
    for (auto one = std::ranges::lower_bound(ways, to, {}, &SignalWay::to);
         one != ways.end() && one->to == to; ++one) {
        if (!one->from.exists() || one->from == from) return &*one;
    }
    return nullptr;
}

}  // namespace clearway::metrics::detail
