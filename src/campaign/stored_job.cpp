#include "campaign/stored_job.hpp"

#include <algorithm>

namespace clearway::campaign {

experiment::RunJob stored_job(const results::Store& store, const experiment::RunKey& key,
                              const std::filesystem::path& output) {
    const auto& conditions = store.manifest().conditions;
    const auto condition = std::ranges::find(conditions, key.condition, &experiment::ConditionSpec::name);
    const std::filesystem::path scenario = std::filesystem::absolute(store.scenario_folder(key.scenario));
    experiment::RunJob job;
    job.scenario = key.scenario;
    job.scenario_file = scenario / "scenario.toml";
    job.network_folder = scenario / "network";
    job.study_seed = store.manifest().study_seed;
    job.replication = key.replication;
    job.traffic_model = condition->traffic_model;
    job.conditions = {*condition};
    job.output = std::filesystem::absolute(output);
    return job;
}

}  // namespace clearway::campaign
