#include "roads/limits.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.hpp"

namespace clearway::roads {

void Limits::add(double limit_mps, double length_m) {
    if (limit_mps > 0.0)
        length_m_[static_cast<int>(std::lround(limit_mps / core::from_kmh(1.0).value))] += length_m;
}

std::string Limits::words() const {
    if (length_m_.empty()) return "";
    const auto usual = std::ranges::max_element(length_m_, {}, &std::pair<const int, double>::second);
    if (length_m_.size() == 1) return fmt::format("roads of {} km/h", usual->first);
    return fmt::format("roads of {} to {} km/h, mostly {}", length_m_.begin()->first,
                       length_m_.rbegin()->first, usual->first);
}

double limit_mps(const Network& network, const Edge& edge) {
    double fastest_mps = 0.0;
    if (edge.internal) return fastest_mps;
    for (const Lane& lane : network.lanes().subspan(edge.first_lane, edge.lane_count))
        if (lane.allows_cars) fastest_mps = std::max<double>(fastest_mps, lane.speed_limit_mps);
    return fastest_mps;
}

Limits limits_of(const Network& network) {
    Limits limits;
    for (const Edge& edge : network.edges())
        limits.add(limit_mps(network, edge), edge.length_m);
    return limits;
}

}  // namespace clearway::roads
