// Writes a run folder as a study leaves it, without simulating: synthetic_study DIR RUNS OTHERS.
//
// Two scenarios and ten conditions share RUNS runs; each has three emergency vehicles and OTHERS others,
// forty approaches and the recovery after each emergency vehicle, so that files have the sizes of the city's.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/random.hpp"
#include "results/store.hpp"
#include "results/synthetic.hpp"

namespace {

using namespace clearway;

constexpr std::uint32_t conditions = 10;
constexpr std::uint32_t scenarios = 2;

results::Manifest manifest_of(std::uint32_t runs) {
    results::Manifest manifest = results::synthetic::manifest(runs / (scenarios * conditions));
    manifest.conditions.resize(1);
    for (std::uint32_t number = 1; number + 1 < conditions; ++number) {
        experiment::ConditionSpec condition;
        condition.name = "policy_" + std::to_string(number);
        condition.policies = {"dissertation"};
        manifest.conditions.push_back(condition);
    }
    experiment::ConditionSpec solo;
    solo.name = "solo";
    solo.traffic_model = experiment::TrafficModel::free_flow;
    manifest.conditions.push_back(solo);
    return manifest;
}

void add_traffic(const core::KeyedRandom& random, std::uint64_t run, metrics::TrafficTables& traffic) {
    for (std::uint64_t edge = 0; edge < 40; ++edge) {
        for (const auto vehicle_class : {traffic::VehicleClass::human, traffic::VehicleClass::automated})
            traffic.approaches.push_back({"edge-" + std::to_string(edge), vehicle_class, 10 + edge, 12.5,
                                          50.0 + random.uniform(core::Purpose::demand, run, edge), 360.0});
    }
    for (int offset = -60; offset <= 240; offset += 5)
        traffic.recovery.push_back(
            {static_cast<double>(offset), 9, random.uniform(core::Purpose::driver, run, offset + 60)});
}

results::RunRecord run_of(const experiment::RunKey& key, const experiment::ConditionSpec& condition,
                          int others) {
    const core::KeyedRandom random(core::StudySeed{1}, core::Replication{key.replication});
    const std::uint64_t number = core::fnv1a64(experiment::to_text(key));
    results::RunRecord run = results::synthetic::record(key);
    run.condition = condition;
    run.vehicles.clear();
    const double gain_s = condition.policies.empty() ? 0.0 : 10.0;
    double sum_s = 0.0;
    for (std::uint64_t vehicle = 0; vehicle < 3; ++vehicle) {
        const double travel_s = 120.0 - gain_s + 20.0 * random.normal(core::Purpose::driver, vehicle) +
                                5.0 * random.normal(core::Purpose::demand, number, vehicle);
        sum_s += travel_s;
        run.vehicles.push_back(results::synthetic::vehicle("emergency_" + std::to_string(vehicle),
                                                           traffic::VehicleClass::emergency, travel_s));
    }
    for (int vehicle = 0; vehicle < others; ++vehicle)
        run.vehicles.push_back(results::synthetic::vehicle(
            "human_" + std::to_string(vehicle), traffic::VehicleClass::human,
            90.0 + 30.0 * random.uniform(core::Purpose::demand, number, 100 + vehicle)));
    run.metrics.emergency_restricted_travel_time_s = run.metrics.emergency_travel_time_s = sum_s / 3.0;
    run.metrics.emergency_time_loss_s = sum_s / 30.0;
    run.metrics.emergency_waiting_time_s = 12.0 * random.uniform(core::Purpose::demand, number, 50);
    run.metrics.others_time_loss_s = 30.0 + random.normal(core::Purpose::demand, number, 51);
    run.metrics.waiting_time_s = 9.0 + random.normal(core::Purpose::demand, number, 52);
    run.metrics.collisions = random.below(3, core::Purpose::demand, number, 53);
    run.metrics.vehicle_count = run.metrics.arrived = run.vehicles.size();
    run.metrics.emergency_count = run.metrics.emergency_arrived = 3;
    if (condition.traffic_model != experiment::TrafficModel::free_flow)
        add_traffic(random, number, run.traffic);
    return run;
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 4) {
        std::fprintf(stderr, "synthetic_study DIR RUNS OTHERS\n");
        return 2;
    }
    const results::Manifest manifest = manifest_of(static_cast<std::uint32_t>(std::atoi(arguments[2])));
    const results::Store store = results::Store::create(arguments[1], manifest);
    for (const experiment::ConditionSpec& condition : manifest.conditions) {
        for (const results::ScenarioEntry& scenario : manifest.scenarios) {
            for (std::uint32_t replication = 0; replication < manifest.replications; ++replication)
                results::synthetic::write(store, run_of({scenario.name, condition.name, replication},
                                                        condition, std::atoi(arguments[3])));
        }
    }
    return 0;
}
