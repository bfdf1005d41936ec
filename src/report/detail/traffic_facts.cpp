#include "report/detail/traffic_facts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

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

/// Of the pairs: a lost EV or a lock moves their mean to where no trip is.
double median_difference_s(const ConditionFacts& condition) {
    const auto& comparison = condition.outcome(primary).comparison;
    return comparison ? comparison->median.value_or(0.0) : 0.0;
}

/// Conditions that are shown: the baseline and those that help the EVs most.
std::vector<const ConditionFacts*> shown_conditions(const ScenarioFacts& scenario) {
    std::vector<const ConditionFacts*> compared;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.is_compared()) compared.push_back(&condition);
    }
    std::ranges::stable_sort(compared, {}, mean_difference_s);
    std::vector<const ConditionFacts*> shown;
    if (!scenario.conditions.empty()) shown.push_back(&scenario.conditions.front());
    for (const ConditionFacts* condition : compared) {
        if (shown.size() == drawn_journeys) break;
        shown.push_back(condition);
    }
    return shown;
}

/// A vehicle and how far its gain is from what is looked for, s.
struct Typical {
    std::string vehicle;
    double off_s = 0.0;
};

/// Of the vehicles that occur in all runs the one whose gain, from the first to the second run, is nearest to
/// `gain_s`; of equals the first. Nothing if there is none.
std::optional<Typical> typical_vehicle(const std::vector<std::map<std::string, JourneyFacts>>& runs,
                                       double gain_s) {
    std::optional<Typical> best;
    for (const auto& [vehicle, journey] : runs.front()) {
        const bool everywhere =
            std::ranges::all_of(runs, [&, &name = vehicle](const auto& run) { return run.contains(name); });
        if (!everywhere) continue;
        const JourneyFacts& with = runs[std::min<std::size_t>(1, runs.size() - 1)].at(vehicle);
        const double gained_s = journey.places.back().time_s - with.places.back().time_s;
        const double off_s = std::abs(gained_s - gain_s);
        if (!best || off_s < best->off_s) best = Typical{vehicle, off_s};
    }
    return best;
}

}  // namespace

const metrics::TrafficTables& RunTraffic::of(const experiment::RunKey& key) {
    const auto [place, is_new] = tables_.try_emplace(key);
    if (is_new) place->second = store_.read_traffic(key);
    return place->second;
}

std::vector<JourneyFacts> journeys_in(RunTraffic& traffic, const ScenarioFacts& scenario) {
    const std::vector<const ConditionFacts*> conditions = shown_conditions(scenario);
    if (conditions.empty()) return {};
    const ConditionFacts& first = *conditions[std::min<std::size_t>(1, conditions.size() - 1)];
    const double gain_s = -median_difference_s(first);
    constexpr std::uint32_t looked_at = 3;  // as many replications as keep journeys
    std::vector<JourneyFacts> journeys;
    std::optional<Typical> shown;
    for (std::uint32_t replication = 0;
         replication < std::min<std::uint64_t>(looked_at, scenario.replications); ++replication) {
        std::vector<std::map<std::string, JourneyFacts>> runs;
        for (const ConditionFacts* condition : conditions)
            runs.push_back(journeys_of(traffic.of({scenario.name, condition->name(), replication}).journeys));
        const std::optional<Typical> found = typical_vehicle(runs, gain_s);
        if (!found || (shown && shown->off_s <= found->off_s)) continue;
        shown = found;
        journeys.clear();
        for (std::size_t row = 0; row < runs.size(); ++row) {
            JourneyFacts& journey = journeys.emplace_back(std::move(runs[row].at(found->vehicle)));
            journey.condition = conditions[row]->label();
            journey.replication = replication;
        }
    }
    return journeys;
}

}  // namespace clearway::report::detail
