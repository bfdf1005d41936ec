#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "report/facts.hpp"
#include "results/store.hpp"

namespace clearway::report::detail {

/// One emergency vehicle's journey under the baseline and the conditions that help most: of all journeys that
/// were kept, the one whose gain is nearest to the mean. Empty if none was kept.
std::vector<JourneyFacts> journeys_in(const results::Store& store, const ScenarioFacts& scenario);

/// Counted flows from the file, each with the mean flow of a condition's runs; empty if the file is missing.
/// Throws core::InputError for a damaged one.
std::vector<FlowFacts> flows_in(const std::filesystem::path& file, const results::Results& results,
                                const std::string& scenario, const std::string& condition);

/// Street names by edge; empty if the file is missing. Throws core::InputError for a damaged one.
std::map<std::string, std::string> streets_in(const std::filesystem::path& file);

}  // namespace clearway::report::detail
