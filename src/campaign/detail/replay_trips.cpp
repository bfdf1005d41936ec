#include "campaign/detail/replay_trips.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "report/overview.hpp"

namespace clearway::campaign {
namespace {

bool arrived(const metrics::VehicleRow& row) {
    return row.vehicle_class == traffic::VehicleClass::emergency &&
           row.outcome == metrics::VehicleOutcome::arrived && row.depart_s && row.arrival_s &&
           row.travel_time_s;
}

void add_trips(const results::RunRecord& baseline, const results::RunRecord& condition,
               std::vector<Trip>& trips) {
    for (const metrics::VehicleRow& there : condition.vehicles) {
        const auto before = std::ranges::find(baseline.vehicles, there.id, &metrics::VehicleRow::id);
        if (before == baseline.vehicles.end() || !arrived(*before) || !arrived(there)) continue;
        trips.push_back({.baseline = baseline.key,
                         .condition = condition.key,
                         .baseline_hash = baseline.provenance.trace_hash,
                         .condition_hash = condition.provenance.trace_hash,
                         .vehicle = there.id,
                         .gain_s = *before->travel_time_s - *there.travel_time_s,
                         .begin_s = std::min(*before->depart_s, *there.depart_s),
                         .end_s = std::max(*before->arrival_s, *there.arrival_s)});
    }
}

std::vector<Trip> ranked(std::vector<Trip> trips) {
    if (trips.empty()) return {};
    std::ranges::sort(trips, [](const Trip& one, const Trip& other) {
        return std::tie(one.gain_s, one.condition.replication, one.vehicle) <
               std::tie(other.gain_s, other.condition.replication, other.vehicle);
    });
    Trip median = trips[trips.size() / 2];
    median.rank = trips.size() == 1 ? "only" : "median";
    std::vector<Trip> shown = {median};
    if (trips.size() > 1) {
        shown.push_back(trips.back());
        shown.back().rank = "best";
    }
    if (trips.size() > 2) {
        shown.push_back(trips.front());
        shown.back().rank = "worst";
    }
    // Of two trips the upper one is the median and the best.
    if (trips.size() == 2) {
        shown.back() = trips.front();
        shown.back().rank = "worst";
        shown.front().rank = "best";
    }
    return shown;
}

}  // namespace

std::string Trip::title() const {
    const std::string difference =
        gain_s >= 0.0 ? fmt::format("{:.1f} s faster", gain_s) : fmt::format("{:.1f} s slower", -gain_s);
    return fmt::format("{}: the {} trip, {} in replication {}: {} with {}", condition.scenario, rank, vehicle,
                       condition.replication, difference, condition_title);
}

std::vector<Trip> trips_to_show(const results::Results& results, const report::StudyFacts& study,
                                const std::string& condition) {
    std::map<experiment::RunKey, const results::RunRecord*> runs;
    for (const results::RunRecord& run : results.runs)
        runs[run.key] = &run;
    std::vector<Trip> all;
    for (const report::ScenarioFacts& scenario : study.scenarios) {
        const std::size_t place = scenario.place_of(condition);
        const report::ConditionFacts* const shown =
            condition.empty()                    ? report::featured_condition(study, scenario)
            : place < scenario.conditions.size() ? &scenario.conditions[place]
                                                 : nullptr;
        const report::ConditionFacts* const baseline =
            shown == nullptr ? nullptr : scenario.baseline_of(*shown);
        if (baseline == nullptr || baseline == shown) continue;
        std::vector<Trip> trips;
        for (std::uint32_t replication = 0; replication < results.manifest.replications; ++replication) {
            const auto before = runs.find({scenario.name, baseline->name(), replication});
            const auto there = runs.find({scenario.name, shown->name(), replication});
            if (before != runs.end() && there != runs.end())
                add_trips(*before->second, *there->second, trips);
        }
        for (Trip& trip : trips) {
            trip.baseline_title = baseline->title;
            trip.condition_title = shown->title;
        }
        std::ranges::move(ranked(std::move(trips)), std::back_inserter(all));
    }
    return all;
}

}  // namespace clearway::campaign
