// Grid charts of a study's factors: what each combination does for emergency vehicles and to the others.

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/detail/figures.hpp"
#include "report/detail/grid.hpp"
#include "report/sections/sections.hpp"
#include "report/shared_sentences.hpp"
#include "report/verdict.hpp"

namespace clearway::report::detail {
namespace {

/// A condition of a scenario that was made by factors.
struct Made {
    const ScenarioFacts* scenario = nullptr;
    const ConditionFacts* condition = nullptr;
};

std::vector<Made> made_by_factors(const StudyFacts& study) {
    std::vector<Made> made;
    for (const ScenarioFacts& scenario : study.scenarios) {
        for (const ConditionFacts& condition : scenario.conditions) {
            if (condition.is_compared() && !condition.factors.empty() &&
                reference_of(study, scenario, condition) == nullptr)
                made.push_back({&scenario, &condition});
        }
    }
    return made;
}

/// A factor and its levels, in the order of the study.
struct Factor {
    std::string name;
    std::vector<std::string> levels;
    std::vector<std::string> titles;  ///< Of the levels.
};

/// What the conditions call a level of a factor.
std::string title_of(const std::vector<Made>& made, const std::string& factor, const std::string& level) {
    for (const Made& one : made) {
        const auto value = one.condition->factors.find(factor);
        const auto title = one.condition->factor_titles.find(factor);
        if (value != one.condition->factors.end() && value->second == level &&
            title != one.condition->factor_titles.end())
            return title->second;
    }
    return level;
}

/// Factors with at least two levels, in the order of their use: across, down, in panels. The one with most
/// levels goes down, where there is room; a single one across.
std::vector<Factor> varied(const std::vector<Made>& made) {
    std::map<std::string, std::vector<std::string>> levels;
    for (const Made& one : made) {
        for (const auto& [name, value] : one.condition->factors) {
            std::vector<std::string>& known = levels[name];
            if (!core::contains(known, value)) known.push_back(value);
        }
    }
    std::vector<Factor> factors;
    for (auto& [name, known] : levels) {
        if (known.size() > 1) factors.push_back({name, std::move(known), {}});
    }
    for (Factor& factor : factors) {
        for (const std::string& level : factor.levels)
            factor.titles.push_back(title_of(made, factor.name, level));
    }
    std::ranges::stable_sort(factors, std::greater{}, [](const Factor& one) { return one.levels.size(); });
    if (factors.size() > 1) std::swap(factors[0], factors[1]);
    return factors;
}

std::string level_of(const Made& made, const std::string& factor) {
    const auto found = made.condition->factors.find(factor);
    return found == made.condition->factors.end() ? std::string() : found->second;
}

/// `failure` of `condition.failure`.
std::string last_part(const std::string& factor) {
    return factor.substr(factor.rfind('.') + 1);
}

/// `repaired`, `lead 4 s`: the level of a factor in words.
std::string level_words(const Made& made, const std::string& factor) {
    constexpr std::string_view of_condition = "condition.";
    const auto found = made.condition->aspects.find(
        factor.starts_with(of_condition) ? factor.substr(of_condition.size()) : factor);
    return found == made.condition->aspects.end() ? "" : found->second;
}

/// All that the axes of a grid do not say: scenario, condition and the levels of the other factors.
std::vector<std::string> off_the_axes(const Made& made, const std::vector<Factor>& factors) {
    const std::string& scenario = made.scenario->name;  // what follows `+` was added by factors
    std::vector<std::string> parts = {scenario.substr(0, scenario.find('+')), made.condition->base_title};
    for (std::size_t factor = 2; factor < factors.size(); ++factor)
        parts.push_back(level_words(made, factors[factor].name));
    return parts;
}

// What is written behind a difference.
constexpr const char* objected = " (!)";
constexpr const char* unsent = " (n/a)";
constexpr const char* unsent_words = "(n/a) it sends no message that could be lost";

const char* mark_of(const ConditionFacts& condition, Measure measure) {
    if (!is_judged_by_messages(condition)) return unsent;
    return alone_mark(condition, measure);
}

GridCell cell_of(const Made& made, Measure measure) {
    const MaybeEstimate& difference = made.condition->difference(measure);
    if (!difference) return {};
    const Effect effect = effect_of(*made.condition, measure);
    const bool lost =
        measure == Measure::emergency_restricted_time && made.condition->objections.on_emergency();
    const analysis::Interval* const interval = shown_interval(difference);
    const char* const mark = lost ? objected : mark_of(*made.condition, measure);
    return {number(difference->mean, typeset(1, Sign::always)) + mark,
            !lost && !is_judged_by_messages(*made.condition) ? GridCell::Tone::neutral
            : lost || effect == Effect::worse                ? GridCell::Tone::worse
            : effect == Effect::better                       ? GridCell::Tone::better
                                                             : GridCell::Tone::neutral,
            interval == nullptr ? "" : interval_text(*interval, typeset(1))};
}

/// Headings of what is not the same in all of them, in the order of the study; a single panel has the name of
/// the scenario.
using Panels = std::vector<std::pair<std::string, std::vector<Made>>>;

Panels panels_of(const std::vector<Made>& made, const std::vector<Factor>& factors) {
    const std::vector<std::string> first = off_the_axes(made.front(), factors);
    std::vector<bool> differs(first.size(), false);
    for (const Made& one : made) {
        const std::vector<std::string> parts = off_the_axes(one, factors);
        for (std::size_t part = 0; part < parts.size(); ++part)
            differs[part] = differs[part] || parts[part] != first[part];
    }
    Panels panels;
    for (const Made& one : made) {
        const std::vector<std::string> parts = off_the_axes(one, factors);
        std::vector<std::string> heading;
        for (std::size_t part = 0; part < parts.size(); ++part)
            if (differs[part]) heading.push_back(parts[part]);
        const std::string words =
            heading.empty() ? first.front() : fmt::format("{}", fmt::join(heading, ", "));
        const auto known = std::ranges::find(panels, words, &Panels::value_type::first);
        (known == panels.end() ? panels.emplace_back(words, std::vector<Made>()) : *known)
            .second.push_back(one);
    }
    return panels;
}

/// `merge: ` where all are of one scenario; else empty, because panels name it.
std::string scenario_of(const std::vector<Made>& made) {
    const bool one =
        std::ranges::all_of(made, [&](const Made& other) { return other.scenario == made.front().scenario; });
    return one ? made.front().scenario->name + ": " : "";
}

/// What the headings of panels are: `predictor`, or `Condition` where they name more than factors.
std::string heading_name(const std::vector<Made>& made, const std::vector<Factor>& factors) {
    const bool same_base = std::ranges::all_of(made, [&](const Made& other) {
        return other.scenario == made.front().scenario &&
               other.condition->base_title == made.front().condition->base_title;
    });
    if (!same_base || factors.size() < 3) return "Condition";
    std::vector<std::string> names;
    for (auto factor = factors.begin() + 2; factor != factors.end(); ++factor)
        names.push_back(last_part(factor->name));
    return fmt::format("{}", fmt::join(names, ", "));
}

/// `n = 20 pairs`, or `n = 1 to 2 pairs`: on how many the differences rest.
std::string pairs_of(const std::vector<Made>& made, Measure measure) {
    std::vector<std::size_t> pairs;
    for (const Made& one : made) {
        const MaybeEstimate& difference = one.condition->difference(measure);
        pairs.push_back(difference ? difference->n : 0);
    }
    const auto [fewest, most] = std::ranges::minmax(pairs);
    return fmt::format("n = {}{}", fewest == most ? "" : fmt::format("{} to ", fewest),
                       counted(most, "pair"));
}

/// What a panel has at each level of the first factor, for one level of the second; null where nothing was
/// made.
std::vector<const Made*> row_of(const std::vector<Made>& panel, const std::vector<Factor>& factors,
                                const std::string& level) {
    const Factor& across = factors[0];
    std::vector<const Made*> row(across.levels.size(), nullptr);
    for (const Made& one : panel) {
        if (factors.size() > 1 && level_of(one, factors[1].name) != level) continue;
        const auto column = std::ranges::find(across.levels, level_of(one, across.name));
        if (column != across.levels.end())
            row[static_cast<std::size_t>(column - across.levels.begin())] = &one;
    }
    return row;
}

/// The second factor; where there is none, one level without a name.
Factor down_of(const std::vector<Factor>& factors) {
    return factors.size() > 1 ? factors[1] : Factor{"", {""}, {""}};
}

Grid grid_of(const std::string& heading, const std::vector<Made>& panel, const std::vector<Factor>& factors,
             Measure measure) {
    Grid grid;
    grid.heading = heading;
    grid.columns = factors[0].titles;
    const Factor down = down_of(factors);
    for (std::size_t level = 0; level < down.levels.size(); ++level) {
        Grid::Row row{down.titles[level], {}};
        for (const Made* const one : row_of(panel, factors, down.levels[level]))
            row.cells.push_back(one == nullptr ? GridCell{} : cell_of(*one, measure));
        grid.rows.push_back(std::move(row));
    }
    return grid;
}

/// `+2.5 [0.6, 4.4] ?`
std::string marked_estimate(const ConditionFacts& condition, Measure measure) {
    const std::string text = estimate_or_nothing(condition.difference(measure), typeset(1, Sign::always));
    return text.empty() ? text : text + mark_of(condition, measure);
}

/// The grids as one table, with the intervals for which a drawing has no room.
Table grid_table(const std::vector<Made>& made, const std::vector<Factor>& factors, Measure measure,
                 const std::string& name) {
    const Factor down = down_of(factors);
    const bool has_down = factors.size() > 1;
    const Panels panels = panels_of(made, factors);
    const bool has_heading = panels.size() > 1 || !has_down;
    DataTable table;
    if (has_heading) table.head.push_back(heading_name(made, factors));
    if (has_down) table.head.push_back(last_part(down.name));
    table.head.insert(table.head.end(), factors[0].titles.begin(), factors[0].titles.end());
    for (const auto& [heading, panel] : panels) {
        for (std::size_t level = 0; level < down.levels.size(); ++level) {
            std::vector<std::string>& row = table.rows.emplace_back();
            if (has_heading) row.push_back(heading);
            if (has_down) row.push_back(down.titles[level]);
            for (const Made* const one : row_of(panel, factors, down.levels[level]))
                row.push_back(one == nullptr ? std::string() : marked_estimate(*one->condition, measure));
        }
    }
    const auto note = [&](const char* mark, const std::string& words) {
        const bool is_used = std::ranges::any_of(made, [&](const Made& one) {
            return std::string_view(mark_of(*one.condition, measure)) == mark;
        });
        return is_used ? "; " + words : "";
    };
    return {name + "-grid",
            fmt::format("{}{}, by {}; {}, 95 % intervals in brackets{}{}", scenario_of(made),
                        labelled(measure, "difference to the baseline"), last_part(factors[0].name),
                        pairs_of(made, measure), note(shown_alone, shown_alone_words),
                        note(unsent, unsent_words)),
            table};
}

DataTable data_of(const std::vector<Made>& made, const std::vector<Factor>& factors, Measure measure) {
    DataTable table{{"Condition", "scenario"}, {}};
    for (const Factor& factor : factors)
        table.head.push_back(factor.name);
    table.head.push_back(labelled(measure, "difference") + " [95 %]");
    table.head.emplace_back("objection");
    for (const Made& one : made) {
        std::vector<std::string>& row = table.rows.emplace_back();
        row = {one.condition->label(), one.scenario->name};
        for (const Factor& factor : factors)
            row.push_back(level_of(one, factor.name));
        row.push_back(estimate(one.condition->difference(measure), typeset(2, Sign::always)));
        row.push_back(analysis::emergency_objection_word(one.condition->objections));
    }
    return table;
}

/// What the colours and marks of the cells mean.
std::vector<LegendEntry> entries_of(const std::vector<Grid>& grids) {
    std::vector<LegendEntry> entries = tone_entries(grids);
    if (has_mark(grids, objected)) entries.push_back({"", "(!) more EVs lost or hit, or safety checks off"});
    if (has_mark(grids, unsent)) entries.push_back({"", unsent_words});
    return entries;
}

Figure factors_figure(const std::vector<Made>& made, const std::vector<Factor>& factors, Measure measure,
                      const char* name, const std::string& caption) {
    std::vector<Grid> grids;
    const Panels panels = panels_of(made, factors);
    for (const auto& [heading, panel] : panels)  // a single one is named by the caption
        grids.push_back(grid_of(panels.size() > 1 ? heading : "", panel, factors, measure));
    Canvas canvas =
        draw_grids(caption, grids,
                   {fmt::format("{} [95 % interval]", caption),
                    fmt::format("across: {}{}", last_part(factors[0].name),
                                factors.size() > 1 ? "; down: " + last_part(factors[1].name) : "")});
    canvas.legend(entries_of(grids));
    return {name, scenario_of(made) + labelled(measure, "difference to the baseline"), canvas.finish(), "",
            data_of(made, factors, measure)};
}

}  // namespace

bool has_factors(const StudyFacts& study) {
    return !varied(made_by_factors(study)).empty();
}

void factors_section(const StudyFacts& study, Writer& writer) {
    const std::vector<Made> made = made_by_factors(study);
    const std::vector<Factor> factors = varied(made);
    if (factors.empty()) return;
    writer.markup(
        "<p>Mean paired difference to the baseline for every combination of the study\u2019s factors, s. A "
        "cell is coloured if its 95 % interval excludes 0 and the difference counts (blue: better, orange: "
        "worse). (!): the combination loses or hits more emergency vehicles than the baseline, or ran "
        "without "
        "safety checks. With many cells, one interval in twenty excludes 0 by chance.</p>\n");
    struct Shown {
        Measure measure;
        const char* name;
    };
    constexpr std::array<Shown, 2> all = {{{Measure::emergency_restricted_time, "factors-emergency"},
                                           {Measure::other_time_loss, "factors-others"}}};
    std::vector<Figure> figures;
    for (const Shown& shown : all)
        figures.push_back(
            factors_figure(made, factors, shown.measure, shown.name, labelled(shown.measure, "difference")));
    writer.figures(std::move(figures));
    writer.open_fold("The same with intervals");
    for (const Shown& shown : all)
        writer.table(grid_table(made, factors, shown.measure, shown.name));
    writer.close_fold();
}

}  // namespace clearway::report::detail
