#pragma once

#include <cstdint>
#include <string>

namespace clearway::scenario_import::detail {

/// Uniform in [0, 1) from an id and a counter, the same wherever it is drawn.
double uniform(const std::string& id, std::uint64_t counter);

/// Counters of draws besides those of a flow's departures, which count from 0. Never renumbered.
enum NamedDraw : std::uint64_t { member_of_distribution = 1'000'000'000, copies_by_scale };

/// How many there are of one that counts `scale` times: the whole part, and one more by chance.
std::size_t copies(const std::string& id, double scale);

}  // namespace clearway::scenario_import::detail
