#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "traffic/preemption.hpp"

namespace clearway::scenario {

/// The network of a scenario on disk and in memory. Built once per scenario and shared by its replications.
struct BuiltNetwork {
    std::filesystem::path file;  ///< `network.net.xml`
    roads::Network network;
    std::string inputs_hash;  ///< Hash of the inputs and of how it was built from them.
    std::vector<traffic::Preemption> preemption = {};  ///< By signal; empty where the scenario names no file.
    std::vector<double> mean_times_s = {};             ///< By edge, 0 where not known; empty likewise.
};

/// Builds the network of `config` in `folder` with netconvert: from plain XML, or from a network file,
/// reduced to its largest car-connected component if the scenario says so. Faster roads are limited to
/// `limits.road_kmh` and then slowed as `[road]` says. Plain XML gets sidewalks and crossings if there are
/// pedestrians; network files keep those that they have. The result holds no time stamp and no path, so equal
/// inputs give equal bytes. Throws core::InputError naming file and cure for input that netconvert refuses,
/// for a network without edges open to cars, for a stretch of road that is not in it and for preemption
/// parameters that do not fit its signals (`preemption_of`) and for mean times of another one;
/// core::EnvironmentError when netconvert is missing.
BuiltNetwork build_network(const ScenarioConfig& config, const std::filesystem::path& folder);

/// Throws core::InputError when the network that `build_network` made in `folder` was changed since.
void require_unchanged_network(const std::filesystem::path& folder);

/// Opens what `build_network` made in `folder`, for example in another process.
BuiltNetwork open_network(const ScenarioConfig& config, const std::filesystem::path& folder);

/// An edge with more lanes for cars than the dissertation's networks have.
struct WideEdge {
    std::string id;
    std::string name;  ///< Street name or empty; text from a file.
    int car_lanes = 0;
};
/// Edges outside junctions with at least `lanes` lanes for cars, by id.
std::vector<WideEdge> wide_edges(const roads::Network& network, int lanes = 3);

}  // namespace clearway::scenario
