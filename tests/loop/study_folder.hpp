#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "core/process.hpp"
#include "core/temporary_folder.hpp"
#include "experiment/job.hpp"
#include "loop/condition_run.hpp"
#include "results/store.hpp"
#include "scenario/config.hpp"
#include "scenario/network.hpp"

namespace clearway::test {

/// A run folder with one scenario, as study::prepare_folder leaves it, and units for it. Removed at the end.
class StudyFolder {
  public:
    StudyFolder(const std::string& scenario, const scenario::Options& options,
                std::vector<experiment::ConditionSpec> conditions)
        : config_(scenario::load(scenario, options)), conditions_(std::move(conditions)) {
        results::Manifest manifest;
        manifest.study = "test";
        const experiment::Provenance worker = loop::own_provenance();
        manifest.clearway_version = worker.clearway_version;
        manifest.sumo_version = worker.sumo_version;
        manifest.replications = 100;
        manifest.conditions = conditions_;
        manifest.scenarios.push_back({.name = config_.name,
                                      .version = config_.version,
                                      .title = config_.title,
                                      .configuration = scenario::to_toml(config_),
                                      .configuration_hash = scenario::scenario_hash(config_),
                                      .attribution = {}});
        const results::Store store = results::Store::create(folder_.path(), manifest);
        const std::filesystem::path home = store.scenario_folder(config_.name);
        scenario::store(config_, home);
        scenario::build_network(config_, home / "network");
    }

    results::Store store() const { return results::Store::open(folder_.path()); }
    const std::filesystem::path& path() const { return folder_.path(); }

    experiment::RunJob unit(std::uint32_t replication, experiment::TrafficModel traffic_model =
                                                           experiment::TrafficModel::standard) const {
        experiment::RunJob unit;
        unit.scenario = config_.name;
        unit.scenario_file = store().scenario_folder(config_.name) / "scenario.toml";
        unit.network_folder = store().scenario_folder(config_.name) / "network";
        unit.replication = replication;
        unit.traffic_model = traffic_model;
        unit.output = folder_.path();
        for (const experiment::ConditionSpec& condition : conditions_) {
            if (condition.traffic_model == traffic_model) unit.conditions.push_back(condition);
        }
        return unit;
    }

    /// Writes the unit's file and tells where it is.
    std::filesystem::path write(const experiment::RunJob& unit) const {
        const std::filesystem::path file =
            folder_.path() / ("unit-" + std::to_string(unit.replication) + "-" +
                              std::string(experiment::name(unit.traffic_model)) + ".json");
        core::write_atomically(file, experiment::to_json(unit));
        return file;
    }

    /// Runs a unit in a worker process; the worker's words are in `log`.
    core::Exit run(const experiment::RunJob& unit,
                   const std::map<std::string, std::string>& environment = {}) const {
        return core::run({.program = CLEARWAY_BINARY_DIR "/bin/clearway-run",
                          .arguments = {write(unit).string()},
                          .environment = environment,
                          .output = log()});
    }
    std::filesystem::path log() const { return folder_.path() / "worker.log"; }

  private:
    core::TemporaryFolder folder_;
    scenario::ScenarioConfig config_;
    std::vector<experiment::ConditionSpec> conditions_;
};

}  // namespace clearway::test
