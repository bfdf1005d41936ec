#pragma once

#include <string>
#include <vector>

#include "results/manifest.hpp"
#include "results/record.hpp"
#include "results/store.hpp"

namespace clearway::results::synthetic {

/// Two scenarios, `baseline` and `treated`, `replications` seeds.
inline Manifest manifest(std::uint32_t replications = 2) {
    Manifest result;
    result.study = "synthetic";
    result.clearway_version = "0.1.0";
    result.sumo_version = "1.15.0";
    result.replications = replications;
    for (const char* scenario : {"alpha", "beta"})
        result.scenarios.push_back({scenario, "v1", "Scenario", "name = \"" + std::string(scenario) + "\"\n",
                                    std::string(32, 'a'), ""});
    experiment::ConditionSpec baseline;
    baseline.name = "baseline";
    experiment::ConditionSpec treated;
    treated.name = "treated";
    treated.policies = {"dissertation"};
    result.conditions = {baseline, treated};
    return result;
}

inline metrics::VehicleRow vehicle(const std::string& id, traffic::VehicleClass vehicle_class,
                                   double travel_time_s) {
    metrics::VehicleRow row;
    row.id = id;
    row.key = core::vehicle_key(id);
    row.vehicle_class = vehicle_class;
    row.kind = traffic::VehicleKind::car;
    row.planned_depart_s = 1.25;
    row.depart_s = 1.5;
    row.depart_delay_s = 0.25;
    row.arrival_s = 1.5 + travel_time_s;
    row.travel_time_s = travel_time_s;
    row.time_loss_s = 0.1 * travel_time_s;
    row.waiting_time_s = 0.0;
    row.waiting_count = 3;
    row.route_length_m = 1234.5;
    return row;
}

/// Where time was lost; names that need quotes.
inline metrics::TrafficTables traffic_tables() {
    metrics::TrafficTables tables;
    tables.approaches = {{"a,\"b", traffic::VehicleClass::automated, 3, 1.25, 7.5, 240.0}};
    tables.recovery = {{-5.0, 2, 0.5}, {0.0, 2, 1.5}};
    tables.journeys = {{"ev 1", "", "", 60.25, 0.0}, {"ev 1", "J\n2", "red", 61.0, 120.5}};
    tables.edge_times = {{"ev 1", "a,\"b", 60.25, 12.5}};
    tables.holds = {{"J\n2", 3, 41.5}};
    tables.locks = {{"a,\"b", "J\n2", 60.0, 81.25, 4, 1}};
    tables.considered = {{"ev 1", "a,\"b", 7}};
    return tables;
}

/// One EV and one other; the EV's travel time in s.
inline RunRecord record(const experiment::RunKey& key, double travel_time_s = 50.1) {
    RunRecord result;
    result.key = key;
    result.condition.name = key.condition;
    for (const experiment::ConditionSpec& condition : manifest().conditions) {
        if (condition.name == key.condition) result.condition = condition;
    }
    result.provenance = {"0.1.0", "1.15.0", std::string(32, 'a'), std::string(32, 'd'),
                         1,       77,       std::string(32, 'f')};
    result.vehicles = {vehicle("e,\"1\"", traffic::VehicleClass::emergency, travel_time_s),
                       vehicle("h1", traffic::VehicleClass::human, 80.0)};
    result.vehicles.push_back(result.vehicles.back());
    metrics::VehicleRow& waiting = result.vehicles.back();
    waiting = {};
    waiting.id = "h2";
    waiting.key = core::vehicle_key("h2");
    waiting.outcome = metrics::VehicleOutcome::not_inserted;
    result.metrics.emergency_restricted_travel_time_s = travel_time_s;
    result.metrics.emergency_travel_time_s = travel_time_s;
    result.metrics.emergency_count = 1;
    result.metrics.emergency_arrived = 1;
    result.metrics.vehicle_count = 3;
    result.metrics.collisions = key.replication;
    result.metrics.simulated_s = 600.25;
    return result;
}

/// A run as the study of `manifest` would have made it.
inline RunRecord in_study(RunRecord run, const Manifest& manifest) {
    const std::string trace_hash = run.provenance.trace_hash;
    const std::string demand_hash = run.provenance.demand_hash;
    const std::uint64_t simulator_seed = run.provenance.simulator_seed;
    run.provenance = planned_provenance(manifest, run.key.scenario);
    run.provenance.trace_hash = trace_hash;
    run.provenance.demand_hash = demand_hash;
    run.provenance.simulator_seed = simulator_seed;
    for (const experiment::ConditionSpec& condition : manifest.conditions)
        if (condition.name == run.key.condition) run.condition = condition;
    return run;
}

inline Store::Written write(const Store& store, const RunRecord& run, const RunTiming& timing = {}) {
    return store.write(in_study(run, store.manifest()), timing);
}

inline RunError error(const experiment::RunKey& key) {
    RunError result;
    result.key = key;
    result.cause = ErrorCause::signal;
    result.message = "killed by signal 11 (Segmentation fault)";
    result.signal = 11;
    result.attempts = 3;
    result.command = "clearway-run '/out/units/a b.json'";
    result.log_tail = "last \"words\"\n";
    return result;
}

}  // namespace clearway::results::synthetic
