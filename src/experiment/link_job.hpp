#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/settings.hpp"
#include "experiment/loop_config.hpp"
#include "experiment/simulation.hpp"
#include "failures/failure_config.hpp"

namespace clearway::experiment {

/// One predictor to evaluate, and where its LinkRun goes.
struct JudgedPredictor {
    std::string name;
    std::string model_file;
    core::Settings settings;
    std::filesystem::path output;
    std::string part = {};  ///< Of one in Python: file, class and hash; empty: `name` says which.

    static constexpr void fields(const auto& table) {
        using Self = JudgedPredictor;
        table(core::Field{"name", "", &Self::name, 0, 0, "Name of the predictor", "given"},
              core::Field{"model_file", "", &Self::model_file, 0, 0, "Weights; empty: as shipped", "shipped"},
              core::Field{"settings", "", &Self::settings, 0, 0, "Settings that differ from their defaults",
                          "none"},
              core::Field{"output", "", &Self::output, 0, 0, "The file of its LinkRun", "given"},
              core::Field{"part", "", &Self::part, 0, 0, "File, class and hash of one in Python", "none"});
    }
    bool operator==(const JudgedPredictor&) const = default;
};

/// One simulation on which the links of predictors are evaluated. They do not act in it.
struct LinkJob : Simulation, LinkSettings {
    std::filesystem::path work_folder;
    std::vector<std::string> failures;
    std::vector<failures::Exits> exits;
    std::string policy;  ///< Acts on a perfect belief; empty: none.
    std::vector<JudgedPredictor> predictors;

    /// All members but the predictors.
    static constexpr void fields(const auto& table) {
        using Self = LinkJob;
        LinkSettings::fields(table);
        table(
            core::Field{"work_folder", "", &Self::work_folder, 0, 0, "For SUMO's files; removed at the end",
                        "given"},
            core::Field{"failures", "", &Self::failures, 0, 0, "Presets of sensing", "given"},
            core::Field{"exits", "", &Self::exits, 0, 0, "Whether it is known which vehicles left", "given"},
            core::Field{"policy", "", &Self::policy, 0, 0, "Acts in the traffic; empty: none", "none"});
    }
    bool operator==(const LinkJob&) const = default;
};

}  // namespace clearway::experiment
