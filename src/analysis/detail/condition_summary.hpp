#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analysis/detail/pairing.hpp"
#include "analysis/summary.hpp"

namespace clearway::analysis::detail {

/// Resamples by number of rows, shared by all metrics with as many pairs.
class ResampleCache {
  public:
    explicit ResampleCache(double level) { config_.level = level; }
    const Resamples& of(std::size_t rows) {
        auto found = cache_.find(rows);
        if (found == cache_.end()) found = cache_.emplace(rows, Resamples(rows, config_)).first;
        return found->second;
    }
    double level() const { return config_.level; }

  private:
    BootstrapConfig config_;
    std::map<std::size_t, Resamples> cache_;
};

/// Runs and errors of a study by scenario and condition.
class Index {
  public:
    explicit Index(const results::Results& results) : replications_(results.manifest.replications) {
        for (const results::RunRecord& run : results.runs) {
            Runs& runs = runs_[{run.key.scenario, run.key.condition}];
            runs.resize(replications_);
            runs.at(run.key.replication) = &run;
        }
        for (const results::RunError& error : results.errors)
            ++errors_[{error.key.scenario, error.key.condition}];
    }
    Runs runs(const std::string& scenario, const std::string& condition) const {
        const auto found = runs_.find({scenario, condition});
        return found == runs_.end() ? Runs(replications_) : found->second;
    }
    std::size_t errors(const std::string& scenario, const std::string& condition) const {
        const auto found = errors_.find({scenario, condition});
        return found == errors_.end() ? 0 : found->second;
    }

  private:
    using Cell = std::pair<std::string, std::string>;
    std::size_t replications_;
    std::map<Cell, Runs> runs_;
    std::map<Cell, std::size_t> errors_;
};

/// All metrics of one condition, compared with nothing.
ConditionSummary describe_condition(const Index& index, const std::string& scenario,
                                    const experiment::ConditionSpec& condition, ResampleCache& resamples);

/// Compares a condition with its baseline, which has been summarised already.
void compare_conditions(const Runs& runs, const Runs& baseline_runs, const ConditionSummary& baseline,
                        ResampleCache& resamples, ConditionSummary& summary);

/// The threshold of a scenario unless the user gives one; 0 if no emergency vehicle arrived in any condition.
double threshold_of(const Index& index, const std::string& scenario,
                    const std::vector<experiment::ConditionSpec>& conditions, std::optional<double> given_s);

/// Adjusts each metric's p values over the conditions of a scenario.
void adjust(ScenarioSummary& scenario);

/// Adds a condition whose runs are not all there. `folder` says where they belong.
void add_unfinished(const std::string& scenario, const ConditionSummary& condition, const char* folder,
                    std::vector<Unpaired>& unpaired);

}  // namespace clearway::analysis::detail
