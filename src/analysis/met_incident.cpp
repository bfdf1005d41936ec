#include "analysis/met_incident.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "analysis/response.hpp"
#include "metrics/restricted_time.hpp"

namespace clearway::analysis {
namespace {

using metrics::VehicleRow;

std::map<std::string, const VehicleRow*> emergency_vehicles(const results::RunRecord& run) {
    std::map<std::string, const VehicleRow*> vehicles;
    for (const VehicleRow& vehicle : run.vehicles)
        if (vehicle.vehicle_class == traffic::VehicleClass::emergency) vehicles[vehicle.id] = &vehicle;
    return vehicles;
}

}  // namespace

MetIncident met_incident(std::span<const results::RunRecord* const> runs,
                         std::span<const results::RunRecord* const> baseline, double level) {
    MetIncident met;
    std::vector<double> with_s;
    std::vector<double> without_s;
    for (std::size_t replication = 0; replication < std::min(runs.size(), baseline.size()); ++replication) {
        const results::RunRecord* const run = runs[replication];
        const results::RunRecord* const before = baseline[replication];
        if (run == nullptr || before == nullptr) continue;
        const auto same = emergency_vehicles(*run);
        const double horizon = horizon_s(*run).value_or(0.0);
        const double horizon_before = horizon_s(*before).value_or(0.0);
        double sum_s = 0.0;
        double sum_before_s = 0.0;
        double count = 0.0;
        for (const auto& [id, vehicle] : emergency_vehicles(*before)) {
            const auto found = same.find(id);
            if (!vehicle->incident_met_s || found == same.end()) continue;
            count += 1.0;
            met.still += found->second->incident_met_s ? 1 : 0;
            sum_s += metrics::restricted_travel_time_s(*found->second, horizon);
            sum_before_s += metrics::restricted_travel_time_s(*vehicle, horizon_before);
        }
        if (count == 0.0) continue;
        met.vehicles += static_cast<std::size_t>(count);
        with_s.push_back(sum_s / count);
        without_s.push_back(sum_before_s / count);
    }
    met.difference_s = estimate_difference(with_s, without_s, level);
    return met;
}

}  // namespace clearway::analysis
