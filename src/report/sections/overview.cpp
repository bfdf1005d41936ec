// The first screen: for each scenario what its best condition does, in a sentence, three tiles and a badge.

#include "report/overview.hpp"

#include <initializer_list>
#include <string>

#include <fmt/format.h>

#include "experiment/condition_words.hpp"
#include "report/controls.hpp"
#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"
#include "report/shared_sentences.hpp"
#include "report/tiles.hpp"

namespace clearway::report::detail {
namespace {

std::string tile_markup(const Tile& tile) {
    const char* const tone = tile.tone == Tile::Tone::better  ? " better"
                             : tile.tone == Tile::Tone::worse ? " worse"
                                                              : "";
    std::string lines;
    for (const std::string& detail : tile.details)
        lines += fmt::format("<p class=\"note\">{}</p>", escaped(detail));
    return fmt::format("<div class=\"tile{}\"><h4>{}</h4><p class=\"figure\">{}</p><p>{}</p>{}</div>\n", tone,
                       tile.subject, escaped(tile.figure), escaped(tile.meaning), lines);
}

/// The title, which of an import begins with the name that stands before it.
std::string without_name(const ScenarioFacts& scenario) {
    const std::string name = scenario.name + ", ";
    return scenario.title.starts_with(name) ? scenario.title.substr(name.size()) : scenario.title;
}

void write_notes(std::initializer_list<std::string> notes, Writer& writer) {
    for (const std::string& note : notes)
        if (!note.empty()) writer.markup(fmt::format("<p class=\"note\">{}</p>\n", escaped(note)));
}

void write_words(const StudyFacts& study, const ScenarioFacts& scenario, const ConditionFacts& condition,
                 Writer& writer) {
    constexpr Script script = Script::typeset;
    const std::string title = scenario.title.empty() || scenario.title == scenario.name
                                  ? ""
                                  : fmt::format("<small>{}</small>", escaped(without_name(scenario)));
    const Badge badge = badge_of(scenario, condition, script);
    writer.markup(fmt::format("<h3>{}{}</h3>\n<p class=\"headline\">{}</p>\n", escaped(scenario.name), title,
                              escaped(scenario_headline(scenario, condition, script))));
    writer.markup(coarse_step_note(scenario.step_length_s));
    const std::string policies = experiment::policy_words(condition.condition);
    const std::string failing = experiment::failure_words(condition.condition);
    write_notes({policies.empty() ? "" : fmt::format("{}: {}.", condition.title, policies),
                 failing.empty() ? "" : fmt::format("What fails: {}.", failing), scenario.assumptions,
                 scenario.outlook, kept_requests_sentence(scenario), unsent_messages_sentence(scenario)},
                writer);
    writer.markup(fmt::format("<p class=\"badge {}\">{}</p>\n",
                              badge.runs == Badge::Runs::enough ? "enough" : "few", escaped(badge.words)));
    const bool has_block =
        condition.met_incident.vehicles > 0 || !unmet_incident_sentence(scenario, condition).empty();
    const std::string incident = has_block ? tile_markup(incident_tile(scenario, condition, script)) : "";
    writer.markup("<div class=\"tiles\">\n" + tile_markup(emergency_tile(scenario, condition, script)) +
                  incident + tile_markup(others_tile(scenario, condition, script)) +
                  tile_markup(safety_tile(scenario, condition, script)) + "</div>\n");
    write_notes({privilege_sentence(scenario, condition, script), controls_note(scenario, condition, script),
                 failing_sentence(scenario, condition, script), failing_note(scenario, condition, script),
                 incidents_sentence(scenario, script), locks_sentence(scenario, condition),
                 among_conditions(study, scenario), worst_trips(scenario, condition, script)},
                writer);
}

}  // namespace

void overview_section(const StudyFacts& study, Writer& writer) {
    for (const ScenarioFacts& scenario : study.scenarios) {
        const ConditionFacts* const condition = featured_condition(study, scenario);
        if (condition == nullptr) continue;
        writer.markup("<div class=\"glance\">\n");
        write_words(study, scenario, *condition, writer);
        writer.figures({gain_map_figure(scenario),
                        timespace_figure(scenario, looks_of(study, scenario), *condition),
                        ways_figure(scenario), tradeoff_figure(study, scenario), reach_figure(scenario)});
        writer.markup("</div>\n");
    }
}

}  // namespace clearway::report::detail
