#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/settings.hpp"
#include "experiment/link_job.hpp"
#include "links/link_benchmark.hpp"
#include "links/link_comparisons.hpp"
#include "links/link_judgement.hpp"

namespace clearway::links {

/// A predictor to evaluate.
struct LinkPredictor {
    std::string name;
    std::string model_file;   ///< Empty: as shipped.
    core::Settings settings;  ///< Those that differ from the defaults.
    std::string part = {};  ///< Of one in Python: its file, class and hash; `name` is then that of its class.
};
/// `link_threshold=0.4 `, one setting after another; empty for defaults.
std::string settings_text(const LinkPredictor& predictor);

/// The seeds on which figures are measured. Thresholds are always chosen on the validation seeds.
enum class LinkSplit { test, validation };

/// Which predictors are evaluated on what, and where the runs are kept.
struct LinkPlan {
    LinkBenchmark benchmark;
    std::vector<LinkPredictor> predictors;
    LinkSplit split = LinkSplit::test;
    std::string against;  ///< Empty: the strongest predictor of the plan that is not learned.
    std::filesystem::path folder;

    const SeedRange& own_seeds() const {
        return split == LinkSplit::test ? benchmark.test : benchmark.validation;
    }
    /// The predictor that errors are compared with; empty if the plan has only learned predictors.
    std::string opponent() const;
    /// The benchmark's comparisons of which both predictors are in the plan.
    std::vector<ComparedPair> comparisons() const;
};

/// Paths of the runs of a plan: `runs/LABEL/REPLICATION/PREDICTOR-KEY.links`. The key is a hash of
/// everything that the content depends on, including the program that makes the runs.
class LinkRunFiles {
  public:
    /// `worker_hash` identifies that program. The plan outlives this object. Reads the scenarios' files.
    LinkRunFiles(const LinkPlan& plan, std::string worker_hash);

    std::filesystem::path file(const BenchmarkScenario& entry, std::uint32_t replication,
                               const LinkPredictor& predictor) const;
    /// Where the scenario itself is kept.
    std::filesystem::path scenario_folder(const scenario::ScenarioConfig& config) const;

  private:
    const std::string& hash_of(const scenario::ScenarioConfig& config) const;
    std::string key(const BenchmarkScenario& entry, const LinkPredictor& predictor) const;

    const LinkPlan& plan_;
    std::string worker_hash_;
    std::map<std::string, std::string> scenario_hashes_;  ///< By the hash of the configuration alone.
};

/// The runs that the folder lacks: one job per scenario and replication. Stores and builds the scenarios that
/// have a job. Throws core::Error.
std::vector<experiment::LinkJob> missing_runs(const LinkPlan& plan, const LinkRunFiles& files);

/// The results of a plan's runs.
struct LinkVerdict {
    std::vector<LinkResult> results;
    std::vector<LinkGain> gains;
    std::vector<LinkComparison> comparisons;
};
/// Reads and evaluates the runs, all of which must be there, with progress on standard error. Throws
/// core::InputError for a damaged run.
LinkVerdict judge(const LinkPlan& plan, const LinkRunFiles& files);

}  // namespace clearway::links
