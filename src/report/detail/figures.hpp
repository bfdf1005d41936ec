#pragma once

#include <string>

#include "report/detail/markup.hpp"
#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {

inline constexpr double right_edge = 388.0;  ///< Of the drawing area; the rest keeps the last label inside.
inline constexpr double left_edge = 52.0;    ///< Room for the labels of y.
inline constexpr double label_space = 44.0;  ///< Below the drawing area.

inline NumberStyle typeset(int decimals, Sign sign = Sign::negative_only) {
    return {decimals, Script::typeset, sign};
}

// Each function returns a whole <figure>: caption, drawing, legend and the data behind it in <details>. Empty
// text if there is nothing to draw.

/// Paired differences with 95 % intervals: EV travel time, emergency waiting time and the others' time loss
/// on one axis in seconds, so that gain and cost can be compared by eye.
std::string forest_figure(const ScenarioFacts& scenario);

/// Share of EVs that arrived within a time, by condition.
std::string distribution_figure(const ScenarioFacts& scenario);

/// EV travel time of each replication, a line from the baseline to the condition.
std::string slopes_figure(const ScenarioFacts& scenario);

/// Half width of the interval of the EV travel time difference over the number of replications.
std::string precision_figure(const ScenarioFacts& scenario);
/// Whether each condition has enough replications for the least relevant difference.
DataTable precision_table(const ScenarioFacts& scenario);

/// Time lost on each approach compared with the baseline, the largest changes first.
std::string approach_figure(const ScenarioFacts& scenario, const ConditionFacts& condition);
/// Halted vehicles on the other approaches around an EV's passage.
std::string recovery_figure(const ScenarioFacts& scenario);
/// Time and distance of an EV with the signals on its route, one figure per journey of the scenario.
std::string journey_figures(const ScenarioFacts& scenario);

/// Train and test loss over epochs (Fig. 4).
std::string loss_figure(const LossCurve& curve);

/// The scenario's picture, inlined.
std::string network_figure(const ScenarioFacts& scenario);

}  // namespace clearway::report::detail
