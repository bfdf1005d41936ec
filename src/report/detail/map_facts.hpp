#pragma once

#include <filesystem>
#include <optional>

#include "report/facts.hpp"
#include "results/store.hpp"

namespace clearway::report::detail {

/// `roads.json` of a scenario; nothing for folders of versions that did not write it. Throws core::InputError
/// for a damaged one.
std::optional<RoadMap> roads_in(const std::filesystem::path& file);

/// The maps of the condition that a scenario's first screen is about, from all replications that it shares
/// with its baseline. `roads` are the scenario's. Nothing without a condition to compare, or if the runs did
/// not keep edge times.
std::optional<ScenarioMap> map_in(const results::Store& store, const StudyFacts& study,
                                  const ScenarioFacts& scenario, RoadMap roads);

}  // namespace clearway::report::detail
