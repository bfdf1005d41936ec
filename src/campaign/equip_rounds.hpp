#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/equipment.hpp"
#include "campaign/study_run.hpp"
#include "core/progress.hpp"
#include "experiment/condition.hpp"
#include "metrics/run_metrics.hpp"
#include "report/equipment.hpp"
#include "results/store.hpp"
#include "study/config.hpp"

namespace clearway::campaign {

/// Events of a run that are told beside the times.
struct EquipEvent {
    const char* title;
    std::uint64_t metrics::RunMetrics::*count;
};
inline constexpr std::array<EquipEvent, 4> equip_events = {
    {{"Collisions", &metrics::RunMetrics::collisions},
     {"Of them with an EV", &metrics::RunMetrics::emergency_collisions},
     {"Teleports", &metrics::RunMetrics::teleports},
     {"Emergency brakings", &metrics::RunMetrics::emergency_brakings}}};

/// What a set of equipped signals does, by replication; nothing for runs that failed.
struct EquipOutcome {
    analysis::Values emergency_s;              ///< `analysis::primary_metric`.
    analysis::Values others_s;                 ///< Mean time loss of the others.
    std::vector<analysis::TripTimes> trips_s;  ///< Of which `emergency_s` is the mean.
    std::array<analysis::Values, equip_events.size()> events;
};

/// Runs on fresh seeds, which had no part in the choice.
struct FreshOutcomes {
    EquipOutcome baseline, none, all, alone;
    std::vector<EquipOutcome> chosen;  ///< With the first signal, the first two, ...
    report::UnsoundRuns unsound;
};

/// What is searched, and for what.
struct EquipQuestion {
    study::StudyConfig config;                      ///< Scenario, seed and replications.
    experiment::ConditionSpec base;                 ///< The condition whose signals are chosen.
    std::vector<std::string> signals;               ///< Ids of the candidates.
    std::vector<std::size_t> numbers;               ///< Theirs, as `clearway scenario signals` counts.
    std::vector<std::string> today;                 ///< Ids of those that are equipped in every set.
    std::vector<analysis::SignalSet> passed;        ///< As EquipCandidates has them.
    std::vector<std::array<std::size_t, 2>> pairs;  ///< That are tried together.
    std::size_t budget = 1;
    analysis::Search search = analysis::Search::lazy;
    std::string calmer = {};  ///< The command with less traffic.
};

/// What becomes of runs in which vehicles lock each other, and the command with less traffic; empty where
/// none holds an emergency vehicle up.
std::string lock_warning(const report::UnsoundRuns& unsound, const std::string& calmer);

/// Runs that a search makes.
struct EquipForecast {
    std::size_t first_look = 0;  ///< All candidates, up to the first look of the race.
    std::size_t race = 0;        ///< The rest of the first place if no candidate leaves.
    std::size_t later = 0;       ///< Of the later places: with a lazy search assumed, two candidates a place.
    std::size_t later_most = 0;  ///< With every candidate at every place.
    std::size_t fresh = 0;

    std::size_t likely() const { return first_look + race + later + fresh; }
    std::size_t most() const { return first_look + race + later_most + fresh; }
};

/// That a search will take longer than `within_s`, by the time of its first look; empty where it will hardly.
std::string late_warning(const EquipForecast& forecast, double first_look_s, double within_s);

/// The runs behind a choice of signals, in folders below `options.folder`, so that the same call continues
/// what was interrupted. `round-01` and `round-xxxxxx` hold what the search needed: a set and a replication
/// whose emergency vehicles pass none of its signals but those of another set is the run of that set, and is
/// not made again. `fresh-xxxxxx` is a study with the next seed. One display on standard error shows the
/// progress of all. For one thread.
class EquipRounds {
  public:
    /// The folder of the first round, in every folder of a search.
    static constexpr const char* first_round = "round-01";

    EquipRounds(EquipQuestion question, RunOptions options);

    EquipForecast forecast() const { return forecast(question_.budget, question_.config.replications); }
    /// Of a search with another budget and fewer replications.
    EquipForecast forecast(std::size_t budget, std::uint32_t replications) const;

    /// Throws core::InputError where the folder of the first round holds another search.
    void require_fits() const;

    /// Names a folder beside that of the search, or itself, which holds the same one with another number of
    /// seeds; empty without one.
    std::string same_with_other_seeds() const;

    /// Makes the missing runs of these sets of candidates, of which the first has those that are chosen.
    /// Throws as prepare_run_folder and run_part do, and core::Error with its exit code when interrupted.
    std::vector<analysis::Values> measure(const std::vector<analysis::SignalSet>& sets,
                                          std::size_t replications);
    /// Makes the runs on fresh seeds; throws likewise.
    FreshOutcomes estimate(const analysis::SignalSet& chosen);
    std::uint64_t fresh_seed() const;
    /// Of the runs on fresh seeds; a whole study. Empty before `estimate`.
    const std::filesystem::path& fresh_folder() const { return fresh_folder_; }

    /// Of the runs of the first round that are there.
    report::UnsoundRuns first_unsound() const;

    /// So far, complete ones and failed ones.
    std::size_t runs() const { return done_; }
    std::size_t failed_runs() const { return failed_; }

    /// The condition with these candidates and those of today equipped, the others not.
    experiment::ConditionSpec with(analysis::SignalSet set) const;

  private:
    using Replications = std::set<std::uint32_t>;
    using Wanted = std::map<analysis::SignalSet, Replications>;

    /// No candidate, and each alone: what a race begins with, pairs apart.
    std::vector<analysis::SignalSet> none_and_each() const;
    /// The signals of a set that a replication's emergency vehicles pass: the others change nothing there.
    analysis::SignalSet effective(const analysis::SignalSet& set, std::uint32_t replication) const;
    /// Adds the runs that these sets need and that are neither known nor in `wanted`.
    void add_missing(const std::vector<analysis::SignalSet>& sets, std::size_t replications,
                     Wanted& wanted) const;
    /// Makes the missing runs of those sets of `racing` that have at most `largest` signals.
    void measure_up_to(std::size_t largest, const std::vector<analysis::SignalSet>& racing,
                       std::size_t replications);
    /// Adds the condition with these candidates, with a title that names them.
    void add_condition(const analysis::SignalSet& set, study::StudyConfig& config) const;
    study::StudyConfig round_of(const Wanted& wanted) const;
    void run_round(const Wanted& wanted);
    results::Results run(const study::Plan& plan, const RunOptions& options);
    /// Of `places`, with `tries` candidates at each.
    std::size_t later_runs(std::size_t places, std::size_t tries, std::uint32_t replications) const;

    EquipQuestion question_;
    RunOptions options_;
    std::filesystem::path fresh_folder_;
    std::map<std::pair<analysis::SignalSet, std::uint32_t>, std::optional<double>> known_;
    std::size_t rounds_ = 0;
    std::size_t done_ = 0, resumed_ = 0, failed_ = 0;
    std::size_t expected_ = 0;  ///< After the present round.
    std::string doing_;
    core::Progress progress_;
};

}  // namespace clearway::campaign
