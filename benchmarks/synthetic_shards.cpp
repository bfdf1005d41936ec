// Writes the shards of a study that nobody ran, for measuring what file systems, merge and tables make of
// many runs.
//     synthetic_shards REPLICATIONS SHARDS DIR
// Two scenarios, five conditions, three vehicles a run; REPLICATIONS x 10 runs in DIR/shards. Nothing is
// flushed.
#include <cstdlib>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "results/detail/record_files.hpp"
#include "results/store.hpp"
#include "results/synthetic.hpp"
#include "study/plan.hpp"
#include "study/shard.hpp"

namespace {

using namespace clearway;
using results::synthetic::vehicle;

study::Plan plan_of(std::uint32_t replications) {
    study::StudyConfig config;
    config.name = "synthetic";
    config.replications = replications;
    for (const char* const name : {"alpha", "beta"})
        config.scenarios.emplace_back().name = name;
    for (const char* const name : {"baseline", "policy_a", "policy_b", "policy_c", "policy_d"}) {
        config.conditions.emplace_back().name = name;
        if (config.conditions.size() > 1) config.conditions.back().policies = {"corridor"};
    }
    return study::make_plan(config, {"0.1.0", "1.15.0"}, "synthetic");
}

results::RunRecord record_of(const experiment::RunKey& key) {
    results::RunRecord run;
    run.key = key;
    run.provenance = {"0.1.0", "1.15.0", std::string(32, 'a'), std::string(32, 'd'),
                      1,       77,       std::string(32, 'f')};
    const double travel_time_s = 40.0 + 0.001 * static_cast<double>(key.replication % 9973);
    run.vehicles = {vehicle("e0", traffic::VehicleClass::emergency, travel_time_s),
                    vehicle("h1", traffic::VehicleClass::human, 2.0 * travel_time_s),
                    vehicle("h2", traffic::VehicleClass::human, 3.0 * travel_time_s)};
    run.metrics.emergency_travel_time_s = travel_time_s;
    run.metrics.emergency_count = 1;
    run.metrics.emergency_arrived = 1;
    run.metrics.vehicle_count = 3;
    run.metrics.simulated_s = 600.25;
    return run;
}

void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

void write_run(const results::Store& store, const results::RunRecord& run) {
    const std::filesystem::path folder = store.run_folder(run.key);
    std::filesystem::create_directories(folder);
    const std::string vehicles = results::detail::vehicles_to_csv(run.vehicles);
    write(folder / "vehicles.csv", vehicles);
    write(folder / "run.json",
          results::detail::run_to_json(results::synthetic::in_study(run, store.manifest()), vehicles,
                                       store.manifest().clearway_build));
    write(folder / "timing.json", results::detail::timing_to_json({}));
}

void write_shard(const study::Plan& plan, const study::Shard& shard, const std::filesystem::path& root) {
    const std::filesystem::path folder = root / "shards" / fmt::format("{}-of-{}", shard.index, shard.count);
    study::claim(folder, shard);
    const results::Store store = results::Store::create(folder, plan.manifest);
    for (std::size_t number = 0; number < plan.units.size(); ++number) {
        if (!study::has_unit(shard, number)) continue;
        const experiment::RunJob& unit = plan.units[number].unit;
        for (const experiment::ConditionSpec& condition : unit.conditions)
            write_run(store, record_of({unit.scenario, condition.name, unit.replication}));
    }
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 4) {
        fmt::print(stderr, "synthetic_shards REPLICATIONS SHARDS DIR\n");
        return 2;
    }
    const auto replications = static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10));
    const auto shards = static_cast<std::uint32_t>(std::strtoul(arguments[2], nullptr, 10));
    const study::Plan plan = plan_of(replications);
    for (std::uint32_t index = 1; index <= shards; ++index)
        write_shard(plan, {index, shards}, arguments[3]);
}
