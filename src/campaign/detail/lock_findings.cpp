#include "campaign/detail/lock_findings.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "campaign/detail/way_findings.hpp"
#include "core/counted.hpp"
#include "report/locks.hpp"

namespace clearway::campaign::detail {
namespace {

/// `3 of 6 runs lock, 2 held up by it; 8.8 s in locks a vehicle; 11 collisions a run`.
std::string words_of(const LockTrial& trial, std::uint32_t trials) {
    if (trial.locked == 0)
        return fmt::format("none of {} runs locks; {:.0f} collisions a run", trials, trial.collisions);
    return fmt::format(
        "{} of {} runs lock, {} held up by it; {:.2g} s in locks a vehicle; {:.0f} collisions a run",
        trial.locked, trials, trial.held_up == 0 ? "none" : std::to_string(trial.held_up), trial.stood_s,
        trial.collisions);
}

constexpr std::size_t most_places = 3;

std::string place_of(const metrics::LockRow& lock, const roads::Network& network) {
    const std::string junction = ", junction " + lock.junction;
    const auto edge = network.find_edge(lock.edge);
    return edge ? road_words(network.edge(*edge), junction) : "edge " + lock.edge + junction;
}

/// `3 at Avenue X (edge 12, junction 34)`, where most are first.
std::string places_of(const std::vector<metrics::LockRow>& locks, const roads::Network& network) {
    std::map<std::string, std::size_t> counts;
    for (const metrics::LockRow& lock : locks)
        ++counts[place_of(lock, network)];
    std::vector<std::pair<std::string, std::size_t>> places(counts.begin(), counts.end());
    std::ranges::stable_sort(places, std::ranges::greater{}, &std::pair<std::string, std::size_t>::second);
    const std::size_t shown = std::min(places.size(), most_places);
    std::vector<std::string> texts;
    for (std::size_t row = 0; row < shown; ++row)
        texts.push_back(fmt::format("{} at {}", places[row].second, places[row].first));
    const std::string more =
        shown < places.size() ? fmt::format(", and at {} more", places.size() - shown) : "";
    return core::listed(texts) + more;
}

}  // namespace

Finding trials_finding(const LockTrials& trials) {
    const std::string setting = fmt::format("time.ignore_junction_blocker_s = {:g}", trials.ignored_after_s);
    const LockTrial& own = trials.ignores ? trials.with : trials.without;
    const LockTrial& other = trials.ignores ? trials.without : trials.with;
    const std::string text = fmt::format(
        "{} {}, as here, {}. {}, {}", trials.ignores ? "with" : "without", setting,
        words_of(own, trials.trials), trials.ignores ? "Without" : "With it", words_of(other, trials.trials));
    std::vector<std::string> advice;
    if (other.stood_s < own.stood_s)
        advice.push_back(trials.ignores ? "take " + setting + " out of scenario.toml"
                                        : setting + " in scenario.toml");
    if (own.held_up > 0)
        advice.emplace_back(
            "less traffic, or a look at the junctions that traffic.locks of a run's run.json names");
    else if (advice.empty() && 2 * own.locked > trials.trials)
        advice.push_back(
            fmt::format("these locks hold no run up; less traffic makes fewer: {}", report::less_traffic));
    const Grade grade = own.held_up > 0 ? Grade::falls_short : own.locked > 0 ? Grade::note : Grade::ok;
    return {trials_name, grade, text, fmt::format("{}", fmt::join(advice, "; "))};
}

Finding locks_finding(const results::RunRecord& record, const std::vector<metrics::LockRow>& locks,
                      const Checked& checked, const std::string& less) {
    const metrics::RunMetrics& run = record.metrics;
    if (run.locks == 0)
        return {locks_name, Grade::ok,
                fmt::format("none in this run of seed {}, {:.0f} s; other seeds may lock: --lock-trials 6 "
                            "looks, with 12 more runs",
                            record.provenance.study_seed, run.simulated_s)};
    const std::string emergency = run.locked_emergency_vehicles == 0
                                      ? ""
                                      : fmt::format(", {} of them EV", run.locked_emergency_vehicles);
    const bool ignored = checked.config.time.ignore_junction_blocker_s.value_or(-1.0) >= 0.0;
    return {
        locks_name, metrics::is_held_up(run) ? Grade::falls_short : Grade::note,
        fmt::format("{} in this run of seed {}, {}; {} stood in {}{}: {}", core::counted(run.locks, "lock"),
                    record.provenance.study_seed, report::longest_words(run.locks, run.longest_lock_s),
                    core::counted(run.locked_vehicles, "vehicle"), run.locks == 1 ? "it" : "them", emergency,
                    places_of(locks, checked.network)),
        report::lock_remedy(ignored ? report::Blockers::ignored : report::Blockers::respected, less) +
            "; --lock-trials 6 counts the runs that lock"};
}

void count_trial(const metrics::RunMetrics& run, std::uint32_t trials, LockTrial& trial) {
    if (run.locks > 0) ++trial.locked;
    if (metrics::is_held_up(run)) ++trial.held_up;
    if (run.vehicle_count > 0)
        trial.stood_s += run.locked_vehicle_s / static_cast<double>(run.vehicle_count) / trials;
    trial.collisions += static_cast<double>(run.collisions) / trials;
}

}  // namespace clearway::campaign::detail
