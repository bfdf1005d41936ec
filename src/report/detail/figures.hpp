#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "report/detail/axes.hpp"
#include "report/detail/writer.hpp"
#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {

/// A drawing of the page, one `<svg>` element with a view box, as a file of its own: with a size, a style
/// sheet and white paper. A picture with a style of its own keeps it.
std::string standalone(const std::string& drawing);
/// The same in a frame with a title above it and a note below it.
std::string standalone(const std::string& drawing, const std::string& title, const std::string& note);

// Figures of the first screen. Without a drawing if there is nothing to draw.

/// Extends the ranges by the places of a journey.
void include(const JourneyFacts& journey, Range& times, Range& distances);
/// Distance over time.
Points way_of(const JourneyFacts& journey);

/// Where the bars of the signals on a route are drawn, so that they do not lie on each other: at stop lines;
/// one that is less than `least_m` behind another shares its bar.
class BarPlaces {
  public:
    BarPlaces(std::initializer_list<const JourneyFacts*> journeys, double least_m);
    /// What a shared bar shows is the strictest of its signals. `journey` is one of those.
    std::vector<SignalSpan> bars_of(const JourneyFacts& journey) const;
    /// Says so, where a bar is shared; else empty.
    std::string note() const;

  private:
    double least_m_;
    std::vector<double> places_m_;  // ascending
    bool are_shared_ = false;
};

/// Map of the roads with the ways of the emergency vehicles in the colour and width of the seconds gained on
/// each edge, the ways that some took instead of others, the signals held, and the approaches on which others
/// lose time.
Figure gain_map_figure(const ScenarioFacts& scenario);

/// Map of one trip that took another way under the condition that the scenario's maps show than under its
/// baseline, with both ways.
Figure ways_figure(const ScenarioFacts& scenario);
/// Whether this is the trip of `timespace_figure`.
bool is_shown_trip(const ScenarioFacts& scenario, const ChangedWay& change);

/// Map of what an emergency vehicle reaches from its stations within some minutes with and without a
/// condition; what only one of the two reaches is marked.
Figure reach_figure(const ScenarioFacts& scenario);

/// Gain of the emergency vehicles over the cost to the others: one point for each condition with both
/// intervals, and the band of gains that do not count. Conditions have numbers, their places in the scenario.
Figure tradeoff_figure(const StudyFacts& study, const ScenarioFacts& scenario);

constexpr NumberStyle typeset(int decimals, Sign sign = Sign::negative_only) {
    return {decimals, Script::typeset, sign};
}

/// `difference` where something is compared.
inline std::string estimate_or_nothing(const MaybeEstimate& difference, NumberStyle style,
                                       double factor = 1.0) {
    return difference ? estimate(difference, style, factor) : std::string();
}

/// The things in which many conditions differ: colours and dashes show the levels of one (the policy, if it
/// is one of them), marks those of all others together, such as `outages, repaired`.
struct Crossing {
    struct Aspect {
        std::vector<std::string> names;   ///< Of ConditionFacts::aspects.
        std::vector<std::string> levels;  ///< In the order of the conditions.

        /// Counted from 1; 0 for others.
        std::size_t level_of(const ConditionFacts& condition) const;
    };
    Aspect colour;
    Aspect mark;
};
/// Nothing where numbers are clearer: few conditions, more levels than looks, settings turned alone.
std::optional<Crossing> crossing_of(const StudyFacts& study, const ScenarioFacts& scenario);

/// How each condition of a scenario looks, by its place: numbers are places, the condition that the headline
/// speaks of leads, and a crossing gives colours and marks.
struct Looks : std::vector<Series> {
    std::optional<Crossing> crossing = {};  ///< What gives colours and marks, if anything does.
};
Looks looks_of(const StudyFacts& study, const ScenarioFacts& scenario);
/// The places of conditions in the order in which they are drawn: what leads comes last, on top.
std::vector<std::size_t> drawing_order(const Looks& looks);

/// A figure with a line for each condition.
struct LineFigure {
    std::string title;
    double height = 0.0;               ///< Of one without panels.
    Axis x, y;                         ///< Places on the drawing are chosen for it, and the values of slots.
    std::optional<double> level = {};  ///< A horizontal line here.
};
/// Draws the condition of a place; its slot counts those of its panel.
using DrawLine = std::function<void(Plot&, std::size_t place, std::size_t slot, const Series&)>;
/// Draws the conditions of the places `drawn`: in one chart, or, where a crossing gives looks, in a panel for
/// each of its marks, all of one scale, with what is not crossed in each.
std::string line_figure(const LineFigure& figure, const ScenarioFacts& scenario, const Looks& looks,
                        const std::vector<std::size_t>& drawn, const DrawLine& draw);

/// Time and distance of one emergency vehicle of one replication, with and without a condition in one
/// drawing, and what the signals on its route showed in both.
Figure timespace_figure(const ScenarioFacts& scenario, const Looks& looks, const ConditionFacts& condition);

/// One figure per scenario.
std::vector<Figure> figures_of(const StudyFacts& study,
                               const std::function<Figure(const ScenarioFacts&, const Looks&)>& figure);

}  // namespace clearway::report::detail
