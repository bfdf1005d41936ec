#pragma once

#include <optional>
#include <span>
#include <string>

#include "traffic/belief.hpp"
#include "traffic/lease.hpp"
#include "traffic/observation.hpp"

namespace clearway::truth {
struct Snapshot;
}

namespace clearway::trace {

// The first difference between two values, in words: `vehicles[3].state.x_m: 12.5, then 12.25`. Empty when
// all numbers are equal bit for bit and all texts are equal. Rosters are compared only for the vehicles that
// the values name.

std::optional<std::string> difference(const truth::Snapshot& one, const truth::Snapshot& other);
std::optional<std::string> difference(const traffic::Observation& one, const traffic::Observation& other);
std::optional<std::string> difference(const traffic::BelievedGraph& one, const traffic::BelievedGraph& other);
std::optional<std::string> difference(std::span<const traffic::Lease> one,
                                      std::span<const traffic::Lease> other);

}  // namespace clearway::trace
