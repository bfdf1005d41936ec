#pragma once

#include "report/facts.hpp"
#include "results/store.hpp"

namespace clearway::report::detail {

/// Fills in what is known of the EVs' trips in a scenario's runs: distribution, worst trip, and how trips
/// differ from those of the same EVs in the baseline.
void add_trips(const results::Results& results, ScenarioFacts& scenario);

}  // namespace clearway::report::detail
