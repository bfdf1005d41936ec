#include "report/detail/trip_facts.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

Distribution distribution_of(std::vector<double> seconds, std::uint64_t all) {
    Distribution distribution;
    distribution.arrived = seconds.size();
    distribution.all = all;
    std::sort(seconds.begin(), seconds.end());
    const std::size_t points = std::min(seconds.size(), distribution_points);
    for (std::size_t point = 1; point <= points; ++point) {
        const std::size_t rank = point * seconds.size() / points;  // the last point is the last value
        distribution.points.push_back(
            {seconds[rank - 1],
             static_cast<double>(rank) / static_cast<double>(std::max<std::uint64_t>(all, 1))});
    }
    return distribution;
}

const char* end_word(metrics::VehicleOutcome outcome) {
    switch (outcome) {
        case metrics::VehicleOutcome::arrived:
            return "";
        case metrics::VehicleOutcome::running_at_end:
            return "on the road at the end";
        case metrics::VehicleOutcome::teleported:
            return "teleported out of a jam";
        case metrics::VehicleOutcome::not_inserted:
            return "never found room to depart";
        case metrics::VehicleOutcome::removed:
            break;
    }
    return "removed";
}

WorstTrip trip_of(const metrics::VehicleRow& vehicle, std::uint32_t replication) {
    WorstTrip trip{vehicle.id, replication, vehicle.travel_time_s.value_or(0.0), end_word(vehicle.outcome)};
    if (!trip.end.empty() && vehicle.depart_s)
        trip.end += fmt::format(" at {:.0f} s", *vehicle.depart_s + trip.seconds);
    return trip;
}

bool is_worse(const WorstTrip& one, const WorstTrip& other) {
    return std::pair(!one.end.empty(), one.seconds) > std::pair(!other.end.empty(), other.seconds);
}

/// Travel times of the EVs that arrived, s, by replication and vehicle.
using Arrived = std::map<std::pair<std::uint32_t, std::string>, double>;

TripChanges changes_of(const Arrived& baseline, const Arrived& with) {
    TripChanges changes;
    double gained_s = 0.0;
    for (const auto& [trip, seconds] : with) {
        const auto before = baseline.find(trip);
        if (before == baseline.end()) continue;
        ++changes.trips;
        const double gain_s = before->second - seconds;
        changes.gains.push_back({trip.first, trip.second, gain_s});
        if (gain_s > felt_s) {
            ++changes.faster;
            gained_s += gain_s;
        }
        changes.slower += gain_s < -felt_s ? 1 : 0;
    }
    if (changes.faster > 0) changes.mean_faster_s = gained_s / static_cast<double>(changes.faster);
    return changes;
}

}  // namespace

void add_trips(const results::Results& results, ScenarioFacts& scenario) {
    std::vector<Arrived> arrived(scenario.conditions.size());
    std::vector<std::uint64_t> all(scenario.conditions.size(), 0);
    for (const results::RunRecord& run : results.runs) {
        const std::size_t place = run.key.scenario == scenario.name ? scenario.place_of(run.key.condition)
                                                                    : scenario.conditions.size();
        if (place == scenario.conditions.size()) continue;
        std::optional<WorstTrip>& worst = scenario.conditions[place].worst_trip;
        for (const metrics::VehicleRow& vehicle : run.vehicles) {
            if (vehicle.vehicle_class != traffic::VehicleClass::emergency) continue;
            ++all[place];
            WorstTrip trip = trip_of(vehicle, run.key.replication);
            if (!worst || is_worse(trip, *worst)) worst = std::move(trip);
            if (vehicle.outcome == metrics::VehicleOutcome::arrived && vehicle.travel_time_s)
                arrived[place].emplace(std::pair(run.key.replication, vehicle.id), *vehicle.travel_time_s);
        }
    }
    for (std::size_t place = 0; place < scenario.conditions.size(); ++place) {
        ConditionFacts& condition = scenario.conditions[place];
        std::vector<double> seconds;
        for (const auto& trip : arrived[place])
            seconds.push_back(trip.second);
        condition.distribution = distribution_of(std::move(seconds), all[place]);
        const std::size_t baseline = condition.is_compared() ? scenario.place_of(condition.baseline) : place;
        if (condition.is_compared() && baseline < scenario.conditions.size())
            condition.trip_changes = changes_of(arrived[baseline], arrived[place]);
    }
}

}  // namespace clearway::report::detail
