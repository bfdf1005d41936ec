#pragma once

#include <string>

#include "report/facts.hpp"

namespace clearway::report::detail {

// Each function returns a whole <figure>: caption, drawing, legend and the data behind it in <details>. Empty
// text where there is nothing to draw.

/// Paired differences with 95 % intervals: EV travel time, emergency waiting time and the others' time loss
/// on one axis in seconds, so that gain and cost can be compared by eye.
std::string forest_figure(const ScenarioFacts& scenario);

/// Share of EVs that arrived within a time, by condition.
std::string distribution_figure(const ScenarioFacts& scenario);

/// Train and test loss over epochs (Fig. 4).
std::string loss_figure(const LossCurve& curve);

/// The scenario's picture, inlined.
std::string network_figure(const ScenarioFacts& scenario);

}  // namespace clearway::report::detail
