#include "campaign/equip_rounds.hpp"

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/response.hpp"
#include "campaign/detail/lock_findings.hpp"
#include "campaign/detail/run_cost.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/terminal.hpp"
#include "experiment/conditions.hpp"
#include "experiment/equipped_signals.hpp"
#include "experiment/related_conditions.hpp"
#include "metrics/restricted_time.hpp"
#include "study/reuse.hpp"

namespace clearway::campaign {
namespace {

constexpr const char* fresh_prefix = "fresh-";
/// Candidates that a lazy search is assumed to try for each later place. From small cities.
constexpr std::size_t likely_tries = 2;
/// Of the estimate on fresh seeds: with each number of signals, none, all, alone, and the baseline.
std::size_t fresh_runs(std::size_t budget, std::uint32_t replications) {
    return replications * (budget + 4);
}

EquipOutcome outcome_of(const results::Results& results, const std::string& condition) {
    EquipOutcome outcome;
    outcome.emergency_s.resize(results.manifest.replications);
    outcome.others_s.resize(results.manifest.replications);
    outcome.trips_s.resize(results.manifest.replications);
    for (analysis::Values& counts : outcome.events)
        counts.resize(results.manifest.replications);
    for (const results::RunRecord& run : results.runs) {
        if (run.key.condition != condition) continue;
        outcome.emergency_s.at(run.key.replication) = run.metrics.emergency_restricted_travel_time_s;
        outcome.others_s.at(run.key.replication) = run.metrics.others_time_loss_s;
        const double horizon_s = analysis::horizon_s(run).value_or(0.0);
        for (const metrics::VehicleRow& vehicle : run.vehicles)
            if (vehicle.vehicle_class == traffic::VehicleClass::emergency)
                outcome.trips_s[run.key.replication][vehicle.id] =
                    metrics::restricted_travel_time_s(vehicle, horizon_s);
        for (std::size_t event = 0; event < equip_events.size(); ++event)
            outcome.events[event].at(run.key.replication) =
                static_cast<double>(run.metrics.*equip_events[event].count);
    }
    return outcome;
}

/// Of runs in traffic: an emergency vehicle alone on the road meets no lock.
report::UnsoundRuns unsound_runs(const results::Results& results, const std::string& alone) {
    report::UnsoundRuns unsound;
    for (const results::RunRecord& run : results.runs) {
        if (run.key.condition == alone) continue;
        ++unsound.runs;
        unsound.locked += run.metrics.locks > 0 ? 1 : 0;
        unsound.held_up += metrics::is_held_up(run.metrics) ? 1 : 0;
        unsound.lost_vehicles += run.metrics.emergency_count - run.metrics.emergency_arrived;
        unsound.collisions += run.metrics.collisions;
        unsound.vehicles += run.metrics.vehicle_count;
    }
    return unsound;
}

/// Leaves no empty folder around one that was refused.
results::Store prepared_folder(const study::Plan& plan, const RunOptions& options) {
    try {
        return prepare_run_folder(plan, options);
    } catch (const core::InputError&) {
        std::error_code ignored;
        std::filesystem::remove(options.folder.parent_path(), ignored);  // only if it is empty
        throw;
    }
}

/// Takes the runs of equal conditions from folders beside, if they are of the same scenario and seed.
void take_over(const study::Plan& plan, const results::Store& store) {
    for (const auto& entry : std::filesystem::directory_iterator(store.folder().parent_path())) {
        const std::filesystem::path& folder = entry.path();
        if (!folder.filename().string().starts_with(fresh_prefix) || folder == store.folder() ||
            !std::filesystem::exists(folder / "manifest.json"))
            continue;
        const results::Store source = results::Store::open(folder);
        results::Manifest alike = plan.manifest;
        alike.conditions = source.manifest().conditions;
        alike.replications = source.manifest().replications;
        if (alike == source.manifest()) study::reuse(store, folder);
    }
}

std::size_t count_of(const std::map<analysis::SignalSet, std::set<std::uint32_t>>& wanted) {
    std::size_t count = 0;
    for (const auto& [set, replications] : wanted)
        count += replications.size();
    return count;
}

}  // namespace

std::string lock_warning(const report::UnsoundRuns& unsound, const std::string& calmer) {
    if (!unsound.say_little()) return "";
    return core::wrapped(
               fmt::format("In the first round {}: such runs say little of signals. With less traffic:",
                           unsound.words()),
               0) +
           "\n  " + calmer + "\n";
}

std::string late_warning(const EquipForecast& forecast, double first_look_s, double within_s) {
    constexpr double slack = 1.25;
    if (within_s <= 0.0 || forecast.first_look == 0) return "";
    const double whole_s =
        first_look_s * static_cast<double>(forecast.likely()) / static_cast<double>(forecast.first_look);
    if (whole_s <= slack * within_s) return "";
    return core::wrapped(
               fmt::format("clearway: at this pace the search takes about {}, not {}: runs are slower than "
                           "foretold. Ctrl-C says what is known by then and keeps the runs.",
                           clock_words(whole_s), clock_words(within_s)),
               0) +
           "\n";
}

EquipRounds::EquipRounds(EquipQuestion question, RunOptions options)
    : question_(std::move(question)),
      options_(std::move(options)),
      progress_("runs", 0, core::Progress::style_for_stderr()) {
    question_.budget = std::min(question_.budget, question_.signals.size());
}

experiment::ConditionSpec EquipRounds::with(analysis::SignalSet set) const {
    std::ranges::sort(set);
    experiment::ConditionSpec condition = question_.base;
    std::vector<std::string> ids = question_.today;
    for (const std::size_t candidate : set)
        ids.push_back(question_.signals.at(candidate));
    const std::string equipped =
        ids.empty() ? experiment::none_equipped : fmt::format("{}", fmt::join(ids, ","));
    condition.settings[experiment::equipped_setting] = equipped;
    condition.name += ids.empty() ? "_none_equipped"
                                  : fmt::format("_equipped_{}", core::content_hash(equipped).substr(0, 8));
    return condition;
}

std::uint64_t EquipRounds::fresh_seed() const {
    constexpr std::uint64_t last = std::numeric_limits<std::int64_t>::max();
    return question_.config.seed == last ? 0 : question_.config.seed + 1;
}

analysis::SignalSet EquipRounds::effective(const analysis::SignalSet& set, std::uint32_t replication) const {
    analysis::SignalSet passed;
    for (const std::size_t candidate : question_.passed[replication])
        if (core::contains(set, candidate)) passed.push_back(candidate);
    return passed;
}

void EquipRounds::add_missing(const std::vector<analysis::SignalSet>& sets, std::size_t replications,
                              Wanted& wanted) const {
    for (const analysis::SignalSet& set : sets) {
        for (std::uint32_t replication = 0; replication < replications; ++replication) {
            const analysis::SignalSet passed = effective(set, replication);
            if (!known_.contains({passed, replication})) wanted[passed].insert(replication);
        }
    }
}

std::size_t EquipRounds::later_runs(std::size_t places, std::size_t tries, std::uint32_t replications) const {
    std::size_t passed = 0;
    for (const analysis::SignalSet& set : std::span(question_.passed).first(replications))
        passed += set.size();
    const std::size_t candidates = std::max<std::size_t>(question_.signals.size(), 1);
    return (places * tries * passed + candidates - 1) / candidates;
}

std::vector<analysis::SignalSet> EquipRounds::none_and_each() const {
    std::vector<analysis::SignalSet> sets = {{}};
    for (std::size_t candidate = 0; candidate < question_.signals.size(); ++candidate)
        sets.push_back({candidate});
    return sets;
}

EquipForecast EquipRounds::forecast(std::size_t budget, std::uint32_t replications) const {
    assert(replications <= question_.passed.size());
    std::vector<analysis::SignalSet> sets = none_and_each();
    if (budget > 1)
        for (const auto& pair : question_.pairs)
            sets.emplace_back(pair.begin(), pair.end());
    if (sets.size() == 1) return {.fresh = fresh_runs(budget, replications)};
    Wanted first;
    Wanted all;
    add_missing(sets, analysis::equip_looks(replications).front(), first);
    add_missing(sets, replications, all);
    EquipForecast forecast;
    forecast.first_look = count_of(first);
    forecast.race = count_of(all) - forecast.first_look;
    for (std::size_t place = 2; place <= budget; ++place)
        forecast.later_most += later_runs(1, question_.signals.size() + 1 - place, replications);
    forecast.later = question_.search == analysis::Search::thorough
                         ? forecast.later_most
                         : std::min(forecast.later_most, later_runs(budget - 1, likely_tries, replications));
    forecast.fresh = fresh_runs(budget, replications);
    return forecast;
}

results::Results EquipRounds::run(const study::Plan& plan, const RunOptions& options) {
    const results::Store store = prepared_folder(plan, options);
    if (plan.manifest.study_seed != question_.config.seed) take_over(plan, store);
    std::size_t resumed = 0;
    const StudyResult result = run_part(plan, store, options, [&](const StudyProgress& now) {
        resumed = now.resumed;
        progress_.begin_at(resumed_ + resumed);
        progress_.expect(done_ + now.total + expected_);
        progress_.update(done_ + now.done + now.failed, failed_ + now.failed, doing_);
    });
    done_ += result.progress.done + result.progress.failed;
    resumed_ += resumed;
    failed_ += result.progress.failed;
    if (is_interrupted(result.exit_code)) {
        progress_.finish();
        throw core::Error(result.exit_code,
                          fmt::format("interrupted after {} runs; they are kept in {}. To continue:\n  {}",
                                      done_, options_.folder.string(), options_.command));
    }
    if (result.progress.failed > 0)
        core::print_message(fmt::format(
            "clearway: {} of {} runs failed in {}; `clearway report {}` names them\n", result.progress.failed,
            plan.run_count(), options.folder.string(), options.folder.string()));
    return results::read_results(store, results::VehicleRows::emergency);
}

void EquipRounds::add_condition(const analysis::SignalSet& set, study::StudyConfig& config) const {
    const experiment::ConditionSpec& condition = config.conditions.emplace_back(with(set));
    std::vector<std::string> equipped;
    if (!question_.today.empty()) equipped.emplace_back("today's");
    for (const std::size_t candidate : set)
        equipped.push_back(fmt::format("#{}", question_.numbers.at(candidate)));
    if (equipped.empty()) equipped.emplace_back("none");
    config.titles[condition.name] =
        fmt::format("{}: {} equipped", question_.base.name, fmt::join(equipped, ", "));
}

study::StudyConfig EquipRounds::round_of(const Wanted& wanted) const {
    study::StudyConfig config = question_.config;
    config.conditions = {experiment::baseline_for(question_.base)};
    for (const auto& [set, replications] : wanted)
        add_condition(set, config);
    return config;
}

void EquipRounds::require_fits() const {
    Wanted wanted;
    add_missing(none_and_each(), analysis::equip_looks(question_.config.replications).front(), wanted);
    RunOptions options = options_;
    options.folder /= first_round;
    const study::Plan plan = plan_for(round_of(wanted), options);
    study::require_ready(plan, options.folder);
    results::Store::require_fits(options.folder, plan.manifest);
}

std::string EquipRounds::same_with_other_seeds() const {
    RunOptions options = options_;
    const results::Manifest own = plan_for(round_of({{{}, {0}}}), options).manifest;
    const auto same = [&](const results::Manifest& other) {
        results::Manifest alike = own;
        alike.replications = other.replications;
        alike.conditions = other.conditions;
        return alike == other && other.replications != own.replications &&
               core::contains(other.conditions, own.conditions.back());
    };
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(options_.folder.parent_path() / ".", none)) {
        const std::filesystem::path folder = options_.folder.parent_path() / entry.path().filename();
        if (!std::filesystem::exists(folder / first_round / "manifest.json", none)) continue;
        const results::Manifest other = results::Store::open(folder / first_round).manifest();
        if (same(other))
            return fmt::format("clearway: {} holds the same search with {} seeds: --seeds {} continues it\n",
                               folder.string(), other.replications, other.replications);
    }
    return "";
}

report::UnsoundRuns EquipRounds::first_unsound() const {
    const std::filesystem::path folder = options_.folder / first_round;
    if (!std::filesystem::exists(folder / "manifest.json")) return {};
    return unsound_runs(results::read_results(results::Store::open(folder), results::VehicleRows::emergency),
                        "");
}

void EquipRounds::run_round(const Wanted& wanted) {
    std::map<std::string, const Replications*> replications_of;
    std::string names;
    for (const auto& [set, replications] : wanted) {
        const std::string name = with(set).name;
        replications_of[name] = &replications;
        names += fmt::format("{} {}\n", name, fmt::join(replications, " "));
    }
    RunOptions options = options_;
    ++rounds_;
    options.folder /=
        rounds_ == 1 ? first_round : fmt::format("round-{}", core::content_hash(names).substr(0, 6));
    study::Plan plan = plan_for(round_of(wanted), options);
    for (study::PlannedUnit& planned : plan.units) {
        std::erase_if(planned.unit.conditions, [&](const experiment::ConditionSpec& condition) {
            const auto found = replications_of.find(condition.name);
            return found == replications_of.end() || !found->second->contains(planned.unit.replication);
        });
    }
    std::erase_if(plan.units,
                  [](const study::PlannedUnit& planned) { return planned.unit.conditions.empty(); });
    const results::Results results = run(plan, options);
    const std::string warning = rounds_ == 1 ? lock_warning(unsound_runs(results, ""), question_.calmer) : "";
    if (!warning.empty()) core::print_message("clearway: " + warning);
    for (const auto& [set, replications] : wanted) {
        const EquipOutcome outcome = outcome_of(results, with(set).name);
        for (const std::uint32_t replication : replications)
            known_[{set, replication}] = outcome.emergency_s[replication];
    }
}

void EquipRounds::measure_up_to(std::size_t largest, const std::vector<analysis::SignalSet>& racing,
                                std::size_t replications) {
    std::vector<analysis::SignalSet> sets = racing;
    std::erase_if(sets, [&](const analysis::SignalSet& set) { return set.size() > largest; });
    Wanted wanted;
    add_missing(sets, replications, wanted);
    if (wanted.empty()) return;
    const std::size_t place = sets.front().size() + 1;
    const bool is_thorough = question_.search == analysis::Search::thorough;
    Wanted whole_race;
    add_missing(racing, place == 1 || is_thorough ? question_.config.replications : replications, whole_race);
    expected_ = count_of(whole_race) - count_of(wanted) +
                later_runs(question_.budget - place, is_thorough ? question_.signals.size() : likely_tries,
                           question_.config.replications) +
                fresh_runs(question_.budget, question_.config.replications);
    doing_ = fmt::format("place {} of {}, {} on {} seeds", place, question_.budget,
                         sets.size() == 2 ? "1 candidate" : fmt::format("{} candidates", sets.size() - 1),
                         replications);
    run_round(wanted);
}

std::vector<analysis::Values> EquipRounds::measure(const std::vector<analysis::SignalSet>& sets,
                                                   std::size_t replications) {
    // Pairs apart, so that a search for one signal is the beginning of one for two.
    const std::size_t chosen = sets.front().size();
    measure_up_to(chosen + 1, sets, replications);
    measure_up_to(chosen + 2, sets, replications);
    std::vector<analysis::Values> values;
    for (const analysis::SignalSet& set : sets) {
        analysis::Values& of_set = values.emplace_back();
        for (std::uint32_t replication = 0; replication < replications; ++replication)
            of_set.push_back(known_.at({effective(set, replication), replication}));
    }
    return values;
}

FreshOutcomes EquipRounds::estimate(const analysis::SignalSet& chosen) {
    const experiment::ConditionSpec baseline = experiment::baseline_for(question_.base);
    const experiment::ConditionSpec solo = experiment::built_in_condition("solo", "solo");
    study::StudyConfig config = question_.config;
    config.seed = fresh_seed();
    config.conditions = {baseline, question_.base};
    config.titles[question_.base.name] = question_.base.name + ": all equipped";
    add_condition({}, config);
    config.conditions.push_back(solo);
    for (std::size_t rank = 0; rank < chosen.size(); ++rank)
        add_condition({chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(rank) + 1}, config);
    RunOptions options = options_;
    const auto names = core::texts_of(config.conditions, &experiment::ConditionSpec::name);
    options.folder /=
        fresh_prefix + core::content_hash(fmt::format("{}", fmt::join(names, " "))).substr(0, 6);
    fresh_folder_ = options.folder;
    expected_ = 0;
    doing_ = "fresh seeds";
    const results::Results results = run(plan_for(config, options), options);
    progress_.finish();
    const auto of = [&](std::size_t condition) {
        return outcome_of(results, config.conditions[condition].name);
    };
    FreshOutcomes outcomes{of(0), of(2), of(1), of(3), {}, unsound_runs(results, solo.name)};
    for (std::size_t condition = 4; condition < config.conditions.size(); ++condition)
        outcomes.chosen.push_back(of(condition));
    return outcomes;
}

}  // namespace clearway::campaign
