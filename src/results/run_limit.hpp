#pragma once

#include <cstddef>
#include <cstdint>

namespace clearway::results {

/// Most replications of a study.
inline constexpr std::uint32_t most_replications = 100000;
/// Most runs of a study unless its user allows more. Published studies have at most some ten thousand; a
/// factor too many makes millions, whose plan alone would fill the memory.
inline constexpr std::uint64_t usual_most_runs = 100000;
/// Most that a user can allow. Lists of so many runs take some 500 MB.
inline constexpr std::uint64_t greatest_most_runs = 2000000;

/// The product, or the greatest number where it is greater: for counts before anything is made.
constexpr std::uint64_t product(std::uint64_t left, std::uint64_t right) {
    std::uint64_t result = 0;
    return __builtin_mul_overflow(left, right, &result) ? UINT64_MAX : result;
}

/// Runs of so many scenarios, conditions and replications.
constexpr std::uint64_t runs_of(std::size_t scenarios, std::size_t conditions, std::uint64_t replications) {
    return product(product(scenarios, conditions), replications);
}

}  // namespace clearway::results
