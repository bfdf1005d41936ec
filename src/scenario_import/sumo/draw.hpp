#pragma once

#include <cstdint>
#include <string>

namespace clearway::scenario_import::detail {

/// Uniform in [0, 1) from an id and a counter; equal arguments give equal numbers.
double uniform(const std::string& id, std::uint64_t counter);

/// Counters of draws other than a flow's departures, which count from 0. Never renumber them.
enum NamedDraw : std::uint64_t { member_of_distribution = 1'000'000'000, copies_by_scale, routing_device };

/// Number of copies for a scale: its whole part, and one more with the probability of the rest.
std::size_t copies(const std::string& id, double scale);

}  // namespace clearway::scenario_import::detail
