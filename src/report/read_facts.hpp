#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "analysis/summary.hpp"
#include "core/settings.hpp"
#include "report/comparison.hpp"
#include "report/facts.hpp"
#include "results/store.hpp"

namespace clearway::report {

/// What the tables and the report show of a run folder:
///
///     what results::Store holds                      runs, failures, manifest
///     scenarios/SCENARIO/network.svg                 picture of the network; optional
///     scenarios/SCENARIO/wide_edges.json             edges with three or more lanes for cars; optional
///     scenarios/SCENARIO/counts.csv                  counted flows; optional
///     scenarios/SCENARIO/roads.json                  roads, signals and stations; optional
///     scenarios/SCENARIO/outlook.json                what to expect of preemption; optional
///     scenarios/SCENARIO/streets.json                street names by edge; optional
///     training/NAME/losses.csv, summary.json         trainings, by NAME; optional
///     command.txt                                    the command that made the study; optional
///     study.toml                                     its file; optional
///
/// Reads only. Smaller differences of EV times than `least_relevant_s` do not count. `chosen` is the
/// condition that first screens and their figures show, by name. Throws core::InputError for a folder that is
/// not a run folder, for damaged files, and for a chosen condition that is compared with nothing.
StudyFacts read_facts(const std::filesystem::path& folder, double least_relevant_s = usual_least_relevant_s,
                      const analysis::Reference& reference = {}, const std::string& chosen = {});

/// The same from results that have been read and summarised already.
StudyFacts facts_of(const results::Store& store, const results::Results& results,
                    const analysis::Summary& summary, double least_relevant_s = usual_least_relevant_s,
                    const std::string& chosen = {});

/// What tables and figures call the conditions of a run folder, by scenario and name, and what they are
/// compared with: `Ours`, `its counterpart with policy Ours`.
struct Titles {
    ConditionTitleMap conditions;
    std::string reference;
};
Titles titles_of(const results::Store& store, const analysis::Summary& summary,
                 const analysis::Reference& reference);

/// What the conditions of a run folder are called, by name, with titles that the study file gave.
core::Settings titles_of(const results::Store& store);
/// The titles that the study itself gives names and values of factors (StudyConfig::titles).
core::Settings given_titles_of(const results::Store& store);

/// Whether an SVG file may go into the page as it is: one <svg> element without scripts, event handlers,
/// foreign elements or external resources. Run folders may come from others, so an unsafe picture is left
/// out.
bool is_safe_picture(std::string_view svg);

/// Reads one training folder. The title says which pairs it learned from. Throws core::InputError naming file
/// and line.
LossCurve read_losses(const std::filesystem::path& training_folder);

}  // namespace clearway::report
