#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "metrics/restricted_time.hpp"
#include "results/synthetic.hpp"

namespace clearway::report::tests {

/// A study frozen for the snapshot of its report: two scenarios, a baseline, a condition that helps and costs
/// the others, one that does next to nothing, EVs alone; six replications, one of them failed, one missing,
/// one EV that does not arrive. Names try to break out of the page. All numbers are written here.
class FrozenStudy {
  public:
    explicit FrozenStudy(const std::filesystem::path& folder)
        : store_(results::Store::create(folder, manifest())) {
        for (const results::ScenarioEntry& scenario : store_.manifest().scenarios) {
            for (const experiment::ConditionSpec& condition : store_.manifest().conditions) {
                for (std::uint32_t replication = 0; replication < store_.manifest().replications;
                     ++replication)
                    add({scenario.name, condition.name, replication}, condition);
            }
        }
        write(folder / "command.txt", "./clearway study frozen.toml --out \"<runs>\"\n");
        write(folder / "scenarios" / "crossing" / "counts.csv",
              "edge,vehicles_per_hour\nnorth_in,500\nwest_in,700\n<i>nowhere</i>,40\n");
        write(folder / "scenarios" / "crossing" / "roads.json", R"({
            "edges": [
                {"id": "north_in", "to": [2, 3], "signal": true, "length_m": 300, "limit_mps": 15,
                 "shape_m": [0, 300, 0, 10]},
                {"id": "west_in", "to": [3], "signal": true, "length_m": 300, "limit_mps": 15,
                 "shape_m": [-300, 0, -10, 0]},
                {"id": "south_out", "to": [], "signal": false, "length_m": 600, "limit_mps": 15,
                 "shape_m": [0, -10, 0, -300]},
                {"id": "east_out", "to": [], "signal": false, "length_m": 900, "limit_mps": 15,
                 "shape_m": [10, 0, 900, 0]}],
            "signals": [{"id": "J<1>", "x_m": 0, "y_m": 0}],
            "stations": [{"edge": "north_in", "kind": "fire_station", "name": "<b>One</b>"}]})");
        write(folder / "scenarios" / "crossing" / "streets.json",
              R"({"north_in": "Long & <b>Short</b> Street"})");
    }

  private:
    static results::Manifest manifest() {
        results::Manifest manifest;
        manifest.study = "frozen";
        manifest.clearway_version = "0.1.0";
        manifest.clearway_build = "0123456789abcdef";
        manifest.sumo_version = "1.15.0";
        manifest.study_seed = 7;
        manifest.replications = 6;
        manifest.scenarios = {
            {"crossing", "v1", "Crossing", "name = \"crossing\"\n", "c1", "Map: <somebody>"},
            {"merge", "v1", "Merge", "name = \"merge\"\n", "c2", ""}};
        experiment::ConditionSpec baseline;
        baseline.name = "baseline";
        experiment::ConditionSpec helps;
        helps.name = "helps";
        helps.policies = {"corridor"};
        experiment::ConditionSpec hardly;
        hardly.name = "hardly";
        hardly.policies = {"dissertation"};
        hardly.safety_checks = traffic::SafetyChecks::off;
        experiment::ConditionSpec solo;
        solo.name = "solo";
        solo.traffic_model = experiment::TrafficModel::free_flow;
        manifest.conditions = {baseline, helps, hardly, solo};
        return manifest;
    }

    static double travel_time_s(const experiment::RunKey& key, int vehicle) {
        const double luck_s = 7.0 * ((key.replication * 5 + static_cast<std::uint32_t>(vehicle) * 3) % 6);
        if (key.condition == "solo") return 60.0;
        if (key.condition == "helps") return 75.0 + 0.5 * luck_s;
        if (key.condition == "hardly") return 99.75 + luck_s + 0.05 * key.replication;
        return 100.0 + luck_s;
    }

    static metrics::VehicleRow vehicle(const experiment::RunKey& key, int number) {
        metrics::VehicleRow row;
        row.id = "emergency<" + std::to_string(number) + ">";
        row.key = core::vehicle_key(row.id);
        row.vehicle_class = traffic::VehicleClass::emergency;
        row.kind = traffic::VehicleKind::ambulance;
        row.planned_depart_s = row.depart_s.emplace(60.0);
        row.depart_delay_s = 0.0;
        row.travel_time_s = travel_time_s(key, number);
        row.arrival_s = 60.0 + *row.travel_time_s;
        row.time_loss_s = *row.travel_time_s - 55.0;
        row.waiting_time_s = 0.25 * *row.time_loss_s;
        if (key.condition == "baseline" && key.replication == 4 && number == 1)
            row.outcome = metrics::VehicleOutcome::running_at_end;
        return row;
    }

    static void add_traffic(const experiment::RunKey& key, metrics::TrafficTables& traffic) {
        const bool helps = key.condition == "helps";
        const double luck_s = 3.0 * ((key.replication * 5) % 6);
        const auto row = [&](const char* edge, double baseline_s, double change_s) {
            return metrics::ApproachRow{edge,
                                        traffic::VehicleClass::human,
                                        40,
                                        0.5 * baseline_s,
                                        baseline_s + luck_s + (helps ? change_s + 0.2 * luck_s : 0.0),
                                        480.0 + luck_s};
        };
        traffic.approaches = {row("north_in", 300.0, 90.0), row("west_in", 500.0, -40.0)};
        for (const double offset_s : {-5.0, 0.0, 5.0, 10.0})
            traffic.recovery.push_back(
                {offset_s, 2, 1.0 + 0.1 * luck_s + (helps && offset_s == 5.0 ? 2.0 : 0.0)});
        const double half_s = 0.5 * travel_time_s(key, 0);
        traffic.edge_times = {{"emergency<0>", "north_in", 60.0, half_s},
                              {"emergency<0>", "south_out", 60.0 + half_s, half_s}};
        if (helps) traffic.holds = {{"J<1>", 1, 20.0 + luck_s}};
        if (key.replication >= 3) return;  // as many as keep journeys
        const double end_s = 60.0 + travel_time_s(key, 0);
        for (const auto& [time_s, distance_m] : {std::pair{60.0, 0.0}, {80.0, 200.0}, {end_s, 900.0}})
            traffic.journeys.push_back({"emergency<0>", "", "", time_s, distance_m});
        for (const auto& [time_s, distance_m] : {std::pair{60.0, 0.0}, {60.0 + travel_time_s(key, 1), 800.0}})
            traffic.journeys.push_back({"emergency<1>", "", "", time_s, distance_m});
        traffic.journeys.push_back({"emergency<0>", "J<1>", "red", 60.0, 220.0});
        traffic.journeys.push_back({"emergency<0>", "J<1>", "yellow", 88.0, 220.0});
        traffic.journeys.push_back({"emergency<0>", "J<1>", "green", 91.0, 220.0});
    }

    void add(const experiment::RunKey& key, const experiment::ConditionSpec& condition) {
        if (key.scenario == "merge" && key.condition == "hardly" && key.replication == 2) {
            results::RunError failure;
            failure.key = key;
            failure.cause = results::ErrorCause::signal;
            failure.message = "SUMO aborted <img src=x onerror=alert(1)>";
            failure.signal = 6;
            store_.write(failure);
            return;
        }
        if (key.scenario == "merge" && key.condition == "hardly" && key.replication == 3) return;
        results::RunRecord run;
        run.key = key;
        run.condition = condition;
        run.vehicles = {vehicle(key, 0), vehicle(key, 1)};
        const bool both = run.vehicles[1].outcome == metrics::VehicleOutcome::arrived;
        const double mean_s =
            both ? 0.5 * (travel_time_s(key, 0) + travel_time_s(key, 1)) : travel_time_s(key, 0);
        metrics::RunMetrics& numbers = run.metrics;
        numbers.emergency_travel_time_s = mean_s;
        numbers.emergency_restricted_travel_time_s =
            metrics::emergency_restricted_mean_s(run.vehicles, 180.0);
        numbers.emergency_time_loss_s = mean_s - 55.0;
        numbers.emergency_waiting_time_s = 0.25 * (mean_s - 55.0);
        numbers.emergency_depart_delay_s = numbers.depart_delay_s = 0.125;
        numbers.waiting_time_s = 12.5 + key.replication;
        numbers.others_time_loss_s =
            30.0 + key.replication + (key.condition == "helps" ? 1.5 + 0.25 * key.replication : 0.0);
        numbers.emergency_count = 2;
        numbers.emergency_arrived = both ? 2 : 1;
        numbers.vehicle_count = 50;
        numbers.arrived = both ? 50 : 49;
        numbers.unfinished = both ? 0 : 1;
        numbers.collisions = key.condition == "hardly" ? key.replication % 2 : 0;
        numbers.leases_issued = condition.policies.empty() ? 0 : 40 + key.replication;
        numbers.leases_refused = condition.policies.empty() ? 0 : key.replication;
        if (key.condition == "helps")
            run.leases = {{"corridor",
                           traffic::LeaseKind::change_lane,
                           30,
                           4,
                           21,
                           20,
                           {{traffic::Refusal::no_room_beside, 9}}},
                          {"corridor", traffic::LeaseKind::hold_green, 10, 90, 10, 10, {}}};
        if (key.condition == "hardly")
            run.leases = {{"dissertation<i>", traffic::LeaseKind::hold_green, 40, 0, 40, 40, {}}};
        if (condition.traffic_model != experiment::TrafficModel::free_flow && key.scenario == "crossing")
            add_traffic(key, run.traffic);
        results::synthetic::write(store_, run);
    }

    static void write(const std::filesystem::path& file, const std::string& text) {
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }

    results::Store store_;
};

}  // namespace clearway::report::tests
