#pragma once

#include <cstdint>
#include <string>

#include "analysis/summary.hpp"
#include "report/text.hpp"

namespace clearway::report {

/// `the longest 310 s`, of one lock `of 310 s`.
std::string longest_words(std::uint64_t locks, double longest_s);

/// `3 locks in 2 of 30 runs, the longest 310 s; 41 vehicles stood in them, 1 of them an EV`; empty where no
/// run locked.
std::string lock_words(const analysis::ConditionSummary& condition);

/// Whatever the density is, which multiplies that of the scenario's file.
inline constexpr double less_traffic_factor = 0.8;
inline constexpr const char* less_traffic = "0.8 times the present --density, or less";

/// The value of `--density` that makes traffic less where the present one is `density`: `0.8`.
std::string less_density(double density);

/// What makes locks fewer. `less`: how to get less traffic, `--density 0.7`. Plain text.
std::string lock_remedy(Blockers blockers, const std::string& less = less_traffic);

/// What the pairs in which a run locked do to a mean difference: `mean -23.6, median of pairs -19.0, mean of
/// the 23 pairs without a lock -18.8 [-20.9, -16.7]; replications for +-1: 112, without locks 97`; no
/// second mean where all locked. Empty where no pair locked. `half_width` is in the metric's unit.
std::string locked_pairs_words(const analysis::Comparison& comparison, double half_width, Script script);

}  // namespace clearway::report
