#include "report/detail/traffic_facts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "analysis/estimate.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "metrics/counts.hpp"

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
            journey.signals.push_back({row.signal, row.state, row.distance_m, at_s, std::max(at_s, end_s)});
        }
    }
    return journeys;
}

/// Conditions that are shown: the baseline and those that help the EVs most.
std::vector<const ConditionFacts*> shown_conditions(const ScenarioFacts& scenario) {
    std::vector<const ConditionFacts*> compared;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (condition.is_compared()) compared.push_back(&condition);
    }
    std::ranges::stable_sort(compared, {}, [](const ConditionFacts* condition) {
        return condition->outcome(Measure::emergency_restricted_time).difference.mean.value_or(0.0);
    });
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

std::vector<JourneyFacts> journeys_in(const results::Store& store, const ScenarioFacts& scenario) {
    const std::vector<const ConditionFacts*> conditions = shown_conditions(scenario);
    if (conditions.empty()) return {};
    const ConditionFacts& first = *conditions[std::min<std::size_t>(1, conditions.size() - 1)];
    const double gain_s = -first.outcome(Measure::emergency_restricted_time).difference.mean.value_or(0.0);
    constexpr std::uint32_t looked_at = 3;  // as many replications as keep journeys
    std::vector<JourneyFacts> journeys;
    std::optional<Typical> shown;
    for (std::uint32_t replication = 0;
         replication < std::min<std::uint64_t>(looked_at, scenario.replications); ++replication) {
        std::vector<std::map<std::string, JourneyFacts>> runs;
        for (const ConditionFacts* condition : conditions)
            runs.push_back(
                journeys_of(store.read_traffic({scenario.name, condition->name, replication}).journeys));
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

std::vector<FlowFacts> flows_in(const std::filesystem::path& file, const results::Results& results,
                                const std::string& scenario, const std::string& condition) {
    if (!std::filesystem::exists(file)) return {};
    double runs = 0.0;
    std::map<std::string, double> sums;
    for (const results::RunRecord& run : results.runs) {
        if (run.key.scenario != scenario || run.key.condition != condition) continue;
        ++runs;
        for (const metrics::ApproachRow& row : run.traffic.approaches)
            sums[row.edge] += row.flow_per_hour;
    }
    std::vector<FlowFacts> flows;
    for (const metrics::EdgeCount& count : metrics::read_counts(file)) {
        FlowFacts& flow = flows.emplace_back();
        flow.edge = count.edge;
        flow.counted_per_hour = count.vehicles_per_hour;
        if (runs == 0.0) continue;
        flow.modelled_per_hour = sums[count.edge] / runs;
        flow.geh = analysis::geh(*flow.modelled_per_hour, count.vehicles_per_hour);
    }
    return flows;
}

std::map<std::string, std::string> streets_in(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) return {};
    try {
        return nlohmann::json::parse(core::read_file(file)).get<std::map<std::string, std::string>>();
    } catch (const nlohmann::json::exception& error) {
        throw core::InputError(core::Problem{file.string(), error.what(),
                                             "an object of edges and their street names",
                                             "Remove the file, or create the run folder again"});
    }
}

}  // namespace clearway::report::detail
