#include "scenario_import/sumo/draw.hpp"

#include <cmath>

#include "core/ids.hpp"
#include "core/random.hpp"

namespace clearway::scenario_import::detail {

double uniform(const std::string& id, std::uint64_t counter) {
    const core::KeyedRandom random(core::StudySeed{}, core::Replication{});
    return random.uniform(core::Purpose::demand, core::vehicle_key(id).value, counter);
}

std::size_t copies(const std::string& id, double scale) {
    const double whole = std::floor(scale);
    const bool one_more = uniform(id, NamedDraw::copies_by_scale) < scale - whole;
    return static_cast<std::size_t>(whole) + static_cast<std::size_t>(one_more);
}

}  // namespace clearway::scenario_import::detail
