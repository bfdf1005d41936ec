#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "report/facts.hpp"
#include "results/store.hpp"

namespace clearway::report::detail {

// Files beside a scenario's runs. Each function throws core::InputError for a damaged file.

/// `wide_edges.json`; nothing if the file is missing.
std::optional<std::vector<WideEdge>> wide_edges_in(const std::filesystem::path& file);

/// `streets.json`: names by edge; empty if the file is missing.
std::map<std::string, std::string> streets_in(const std::filesystem::path& file);

/// `titles.json` of the study (StudyConfig::titles); empty if the file is missing.
core::Settings titles_in(const std::filesystem::path& file);

/// `controls.json` of the study (StudyConfig::controls); empty if the file is missing.
core::Settings controls_in(const std::filesystem::path& file);

/// The sentence of `outlook.json`; empty likewise, and without signals.
std::string outlook_in(const std::filesystem::path& file);

/// `roads.json`; nothing for folders of versions that did not write it.
std::optional<RoadMap> roads_in(const std::filesystem::path& file);

/// `counts.csv`: counted flows, each with the mean flow of the runs of the scenario's first condition; empty
/// if the file is missing.
std::vector<FlowFacts> flows_in(const std::filesystem::path& file, const results::Results& results,
                                const ScenarioFacts& scenario);

}  // namespace clearway::report::detail
