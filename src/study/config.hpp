#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "experiment/condition.hpp"
#include "results/manifest.hpp"
#include "results/run_limit.hpp"
#include "scenario/config.hpp"

namespace clearway::study {

/// What a user asks for: scenarios x conditions x replications.
struct StudyConfig {
    std::string name = "study";
    std::uint64_t seed = 1;
    std::uint32_t replications = 20;  ///< 1 to 100000. FHWA asks for at least 10.
    std::vector<scenario::ScenarioConfig> scenarios;
    std::map<std::string, core::Settings> scenario_factors;  ///< By scenario, for scenarios made by factors.
    std::vector<experiment::ConditionSpec> conditions;
    core::Settings titles = {};  ///< For reports: of conditions, and of texts that factors give them.
    /// What is wrong with titles that have nearly the name of a factor's value: it may be the value that is
    /// misspelt, so who plans the study checks its parts first.
    std::vector<core::Problem> doubtful_titles = {};
    core::Settings controls = {};  ///< For reports: a condition -> the one of which a part is off in it.
    std::string text = {};         ///< Of the study file; empty for a study that has none.
    /// Instead of a fixed number of replications; `replications` is then the number of the first round.
    std::optional<results::PrecisionTarget> precision;
    /// What it sets out to show; its seed must not have been used before (fresh_seeds.hpp).
    std::optional<results::AnalysisPlan> plan = std::nullopt;
    std::uint64_t most_runs = results::usual_most_runs;  ///< A plan with more runs is refused.
};

/// FHWA's minimum number of replications (Traffic Analysis Toolbox III, 2019 update); also the first round of
/// a study with a precision target.
inline constexpr std::uint32_t least_replications = 10;

/// How much of a study file runs.
enum class Extent : std::uint8_t {
    whole,
    quick,  ///< What [quick] selects; the name ends in `-quick`.
};

/// The file of that name, of Clearway's own (core::shipped) where there is no other; the name itself if there
/// is neither.
std::filesystem::path study_file(const std::filesystem::path& name);

/// Reads a study file. Strict: throws core::InputError with every problem found, each with file, line and
/// column.
///
///     name = "sensor-failure"
///     seed = 1
///     replications = 30
///     scenarios = ["merge", "my/crossing"]        # names, folders or files, relative to this file
///     conditions = ["baseline", "graph_graphsage", "solo"]
///
///     [[scenario]]                                # in addition to the named ones, with its own overrides
///     name = "crossing_dense"
///     from = "my/crossing"
///     variant = "dense"
///
///     [overrides]                                 # as the options of `clearway run`; all optional
///     variant = "dense"
///     step_length_s = 0.1
///
///     [precision]                                 # instead of replications
///     metric = "emergency_restricted_travel_time_s"
///     half_width = 2.0                            # of the 95 % interval, in the metric's unit
///     at_most = 200                               # replications
///
///     [factors]                                   # each with the values it takes
///     condition.failure = ["B5", "B20"]
///     failure.dark_share = [0.1, 0.3]
///     loop.policy_period_s = [0.5, 1.0]           # any setting of `clearway list settings`
///     preempt_signals.lead_s = [4, 8, 16]
///     set = [{ "clear_lane.beside_m" = 20, "clear_lane.gap_factor" = 0.8 }]   # several at a time
///     design = "all_combinations"                 # or "one_at_a_time"
///     scenario.demand.human = [40, 80]
///
///     [[condition]]                               # in addition to the named ones
///     name = "b20"
///     failure = "B20"
///     predictor = "graphsage_corrected"
///     policy = ["dissertation"]
///     set = { "dissertation.ahead_m" = 80, "graphsage_corrected.link_threshold" = 0.4 }
///     model = "my/net.weights"                    # relative to this file; none: the one in the program
///
///     [titles]                                    # in tables and figures, for names and values of factors
///     b20 = "One report in five"
///     "b20+lead_s=4" = "Early requests"
///
///     [controls]                                  # a condition -> the one of which a part is off in it
///     b20_no_repair = "b20"
///
///     [plan]                                      # what the study is to show; optional
///     metric = "emergency_restricted_travel_time_s"
///     alpha = 0.05                                # over all comparisons, by Holm
///     margin_s = 1.0                              # smaller differences count as none,
///     margin_share = 0.05                         # or those below this share of the delay, if that is more
///     [[plan.comparison]]
///     name = "links cut"
///     condition = "b20"
///     against = "baseline"
///     scenario = "merge"                          # none: in every scenario
///     claim = "difference"                        # or "equivalence"
///
///     [quick]                                     # what --quick runs instead; each key optional
///     seed = 2                                    # with a plan: another than the study's
///     replications = 3
///     scenarios = ["merge"]                       # of the scenarios above, by name
///     conditions = ["baseline", "b20"]            # of the conditions above
///
/// Extent::quick without [quick] in the file is a problem, too. `scenarios`, names, folders or files, take
/// the place of those of the file and lengthen the study's name.
StudyConfig read_study(const std::filesystem::path& name, Extent extent = Extent::whole,
                       std::uint64_t most_runs = results::usual_most_runs,
                       const std::vector<std::string>& scenarios = {});

}  // namespace clearway::study
