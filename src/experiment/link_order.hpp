#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/settings.hpp"

namespace clearway::experiment {

/// One predictor to judge, and where its LinkRun goes.
struct LinkPredictorOrder {
    std::string name;
    std::string model_file;   ///< Empty: as shipped.
    core::Settings settings;  ///< Of the predictor, that differ from their defaults.
    std::filesystem::path output;

    bool operator==(const LinkPredictorOrder&) const = default;
};

/// One simulation in which predictors are judged: a scenario and replication without a policy.
struct LinkOrder {
    std::string scenario;
    std::filesystem::path scenario_file;   ///< The effective configuration, TOML.
    std::filesystem::path network_folder;  ///< Network built before.
    std::uint64_t study_seed = 1;
    std::uint32_t replication = 0;
    std::filesystem::path work_folder;  ///< For SUMO's files; removed in the end.
    std::vector<std::string> failures;  ///< Presets of sensing.
    std::vector<std::string> exits;     ///< `known`, `unknown`.
    std::vector<LinkPredictorOrder> predictors;

    bool operator==(const LinkOrder&) const = default;
};

/// JSON, for the worker's command line. `read_link_order` throws core::InputError.
std::string to_json(const LinkOrder& order);
LinkOrder read_link_order(const std::filesystem::path& file);

}  // namespace clearway::experiment
