#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "experiment/loop_config.hpp"
#include "failures/failure_config.hpp"
#include "links/compared_pair.hpp"
#include "prediction/candidates.hpp"
#include "scenario/config.hpp"

namespace clearway::links {

using failures::Exits;

/// Replications `first` to `first + count - 1`.
struct SeedRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;

    bool operator==(const SeedRange&) const = default;
};

/// What is wrong with the seeds of an evaluation: none for testing, none for choosing thresholds, or some
/// used for both. `where` is the option or file that set them.
std::vector<core::Problem> problems_of(const SeedRange& test, const SeedRange& validation,
                                       const std::string& where);

/// A scenario of a benchmark, and what acts in its traffic.
struct BenchmarkScenario {
    std::string label;   ///< Tells variants of a scenario apart; names the folder of its runs.
    std::string policy;  ///< Acts in the traffic, on a perfect belief; empty: none.
    scenario::ScenarioConfig config;
};

/// The part of a benchmark that is judged where somebody is in a hurry.
struct QuickBenchmark {
    std::uint32_t test = 3;  ///< Seeds at most.
    std::uint32_t validation = 2;
    std::vector<std::string> failures;  ///< Empty: all of the benchmark.
    std::vector<Exits> exits;           ///< Empty: all.
};

/// What predictors are evaluated on.
struct LinkBenchmark {
    std::string name;
    std::uint64_t study_seed = 1;
    SeedRange test;        ///< Figures are measured on these.
    SeedRange validation;  ///< Thresholds are chosen and settings tuned on these.
    std::vector<std::string> failures;
    std::vector<Exits> exits;
    prediction::CandidateReach candidates = prediction::CandidateReach::twins;
    experiment::LinkSettings links;
    std::vector<BenchmarkScenario> scenarios;
    std::vector<std::string> predictors;    ///< Judged where none are named; empty: `benchmark_predictors`.
    QuickBenchmark quick;                   ///< Table `[quick]`.
    std::vector<ComparedPair> comparisons;  ///< Confirmatory ones; all others are exploratory.
};

/// Reads a benchmark file (TOML, strict). Without a key `candidates` the candidates are those of
/// CandidateReach::reported, which were the only ones when `eval_v1` was frozen. Each scenario states the
/// hash of its effective configuration. Throws core::InputError with all problems, including a scenario that
/// has changed since the benchmark was frozen. Names of failures are not checked here; those of predictors
/// and policies are. Predictors that are code of the user come back absolute, and comparisons know them by
/// their class.
LinkBenchmark read_link_benchmark(const std::filesystem::path& file);

/// Predictors that a benchmark judges where neither it nor the user names any: those that there were when
/// `eval_v1` was frozen. Later ones (`gcn`, `gat`) are judged on it when they are named, and its figures stay
/// comparable.
const std::vector<std::string>& benchmark_predictors();
/// All predictors whose links can be judged: those that do not know the truth.
std::vector<std::string> judged_predictors();

}  // namespace clearway::links
