#include "report/detail/traffic_facts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "report/overview.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::size_t drawn_journeys = 4;  // conditions of a scenario

/// Journeys of one run by vehicle, with times counted from the vehicle's first record.
std::map<std::string, JourneyFacts> journeys_of(const std::vector<metrics::JourneyRow>& rows) {
    std::map<std::string, JourneyFacts> journeys;
    for (const metrics::JourneyRow& row : rows) {
        if (row.signal.empty()) journeys[row.vehicle].places.push_back({row.time_s, row.distance_m});
    }
    for (auto& [vehicle, journey] : journeys) {
        journey.vehicle = vehicle;
        const double start_s = journey.places.front().time_s;
        const double end_s = journey.places.back().time_s - start_s;
        for (JourneyPlace& place : journey.places)
            place.time_s -= start_s;
        std::map<std::string, std::size_t> open;  // Signal and stop line -> index of the latest span.
        for (const metrics::JourneyRow& row : rows) {
            if (row.signal.empty() || row.vehicle != vehicle) continue;
            const std::string key = row.signal + '@' + std::to_string(row.distance_m);
            const double at_s = row.time_s - start_s;
            if (const auto before = open.find(key); before != open.end())
                journey.signals[before->second].to_s = at_s;
            open[key] = journey.signals.size();
            const bool known = row.state == "green" || row.state == "yellow";
            journey.signals.push_back(
                {row.signal, known ? row.state : "red", row.distance_m, at_s, std::max(at_s, end_s)});
        }
    }
    return journeys;
}

double mean_difference_s(const ConditionFacts* condition) {
    return analysis::mean_of(condition->difference(primary)).value_or(0.0);
}

/// Conditions that are shown: the baseline, the headline's and those that help the EVs most.
std::vector<const ConditionFacts*> shown_conditions(const ScenarioFacts& scenario,
                                                    const ConditionFacts* featured) {
    std::vector<const ConditionFacts*> compared;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.is_compared() && &condition != featured) compared.push_back(&condition);
    }
    std::ranges::stable_sort(compared, {}, mean_difference_s);
    if (featured != nullptr) compared.insert(compared.begin(), featured);
    const ConditionFacts* const baseline = featured == nullptr ? nullptr : scenario.baseline_of(*featured);
    std::vector<const ConditionFacts*> shown;
    if (!scenario.conditions.empty())
        shown.push_back(baseline == nullptr ? &scenario.conditions.front() : baseline);
    for (const ConditionFacts* condition : compared) {
        if (shown.size() == drawn_journeys) break;
        shown.push_back(condition);
    }
    return shown;
}

using Journeys = std::map<std::string, JourneyFacts>;  // of one run, by vehicle

/// A trip that could be shown.
struct Candidate {
    std::uint32_t replication = 0;
    std::string vehicle;
    double gain_s = 0.0;  ///< From the baseline to the headline's condition.
    bool passes_signals = false;
    bool arrived = false;
};

/// Adds the vehicles that occur in the runs of all conditions. `gains` are of those that arrived.
void add_candidates(std::uint32_t replication, const std::vector<Journeys>& runs,
                    const std::vector<TripGain>& gains, std::vector<Candidate>& candidates) {
    for (const auto& [vehicle, journey] : runs.front()) {
        const bool everywhere =
            std::ranges::all_of(runs, [&, &name = vehicle](const auto& run) { return run.contains(name); });
        if (!everywhere) continue;
        const JourneyFacts& with = runs[std::min<std::size_t>(1, runs.size() - 1)].at(vehicle);
        const bool arrived = std::ranges::any_of(gains, [&, &name = vehicle](const TripGain& gain) {
            return gain.replication == replication && gain.vehicle == name;
        });
        candidates.push_back({replication, vehicle, journey.places.back().time_s - with.places.back().time_s,
                              !with.signals.empty(), arrived});
    }
}

/// The one whose gain is nearest to the mean of all; of trips that arrived and pass signals, if there are
/// any: the others tell nothing of what was asked of signals. Most gains may be 0, which would not show what
/// the mean tells: of those that gain half of it, if any does. Candidates may not be empty.
Candidate typical_of(std::vector<Candidate> candidates, double mean_gain_s) {
    const auto prefer = [&](const auto& is_preferred) {
        if (std::ranges::any_of(candidates, is_preferred))
            std::erase_if(candidates, std::not_fn(is_preferred));
    };
    prefer([](const Candidate& one) { return one.arrived; });
    prefer([](const Candidate& one) { return one.passes_signals; });
    prefer([&](const Candidate& one) { return one.gain_s * mean_gain_s >= 0.5 * mean_gain_s * mean_gain_s; });
    return *std::ranges::min_element(
        candidates, {}, [&](const Candidate& one) { return std::abs(one.gain_s - mean_gain_s); });
}

}  // namespace

const metrics::TrafficTables& RunTraffic::of(const experiment::RunKey& key) {
    const auto [place, is_new] = tables_.try_emplace(key);
    if (is_new) place->second = store_.read_traffic(key);
    return place->second;
}

std::vector<JourneyFacts> journeys_in(RunTraffic& traffic, const StudyFacts& study,
                                      const ScenarioFacts& scenario) {
    const std::vector<const ConditionFacts*> conditions =
        shown_conditions(scenario, featured_condition(study, scenario));
    if (conditions.empty()) return {};
    std::vector<std::vector<Journeys>> runs(
        std::min<std::uint64_t>(metrics::journeys_kept, scenario.replications));
    static const std::vector<TripGain> none;
    const auto& gains = conditions.size() < 2 ? none : conditions[1]->trip_changes.gains;
    std::vector<Candidate> candidates;
    for (std::uint32_t replication = 0; replication < runs.size(); ++replication) {
        for (const ConditionFacts* condition : conditions)
            runs[replication].push_back(
                journeys_of(traffic.of({scenario.name, condition->name(), replication}).journeys));
        add_candidates(replication, runs[replication], gains, candidates);
    }
    if (candidates.empty()) return {};
    const double mean_gain_s = conditions.size() < 2 ? 0.0 : -mean_difference_s(conditions[1]);
    const Candidate shown = typical_of(std::move(candidates), mean_gain_s);
    std::vector<JourneyFacts> journeys;
    for (std::size_t row = 0; row < conditions.size(); ++row) {
        JourneyFacts& journey =
            journeys.emplace_back(std::move(runs[shown.replication][row].at(shown.vehicle)));
        journey.condition = conditions[row]->label();
        journey.replication = shown.replication;
    }
    return journeys;
}

}  // namespace clearway::report::detail
