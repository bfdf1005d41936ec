#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/settings.hpp"
#include "experiment/link_job.hpp"
#include "links/link_benchmark.hpp"
#include "links/link_judgement.hpp"

namespace clearway::links {

/// A predictor to judge.
struct LinkPredictor {
    std::string name;
    std::string model_file;   ///< Empty: as shipped.
    core::Settings settings;  ///< That differ from the defaults.
};
/// `link_threshold=0.4 `, a setting after the other; empty for defaults.
std::string settings_text(const LinkPredictor& predictor);

/// On which seeds figures are taken. Thresholds are always chosen on the validation seeds.
enum class LinkSplit { test, validation };

/// Which predictors are judged on what, and where the runs are kept.
struct LinkPlan {
    LinkBenchmark benchmark;
    std::vector<LinkPredictor> predictors;
    LinkSplit split = LinkSplit::test;
    std::string against;  ///< Empty: the strongest predictor of the plan that does not learn.
    std::filesystem::path folder;

    const SeedRange& own_seeds() const {
        return split == LinkSplit::test ? benchmark.test : benchmark.validation;
    }
    /// Against whom errors are compared; empty when only predictors that learn are there.
    std::string opponent() const;
};

/// Where the runs of a plan are: `runs/SCENARIO/REPLICATION/PREDICTOR-KEY.links`, where the key follows from
/// everything that the content depends on, the program that does the runs included.
class LinkRunFiles {
  public:
    /// `worker_hash` identifies that program. The plan outlives the files. Reads the files of the scenarios.
    LinkRunFiles(const LinkPlan& plan, std::string worker_hash);

    std::filesystem::path file(const scenario::ScenarioConfig& config, std::uint32_t replication,
                               const LinkPredictor& predictor) const;
    /// Where the scenario itself is kept.
    std::filesystem::path scenario_folder(const scenario::ScenarioConfig& config) const;

  private:
    const std::string& hash_of(const scenario::ScenarioConfig& config) const;
    std::string key(const scenario::ScenarioConfig& config, const LinkPredictor& predictor) const;

    const LinkPlan& plan_;
    std::string worker_hash_;
    std::map<std::string, std::string> scenario_hashes_;  ///< By that of the configuration alone.
};

/// What the folder lacks: one order for each scenario and replication, in the plan's job. Stores and builds
/// the scenarios that have one. Throws core::Error.
std::vector<experiment::LinkJob> missing_runs(const LinkPlan& plan, const LinkRunFiles& files);

/// What a plan's runs came to.
struct LinkVerdict {
    std::vector<LinkResult> results;
    std::vector<LinkGain> gains;
};
/// Reads the runs, all of which are there, and judges, with progress on standard error. Throws
/// core::InputError for a damaged one.
LinkVerdict judge(const LinkPlan& plan, const LinkRunFiles& files);

}  // namespace clearway::links
