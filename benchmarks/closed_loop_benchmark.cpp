// The whole loop against SUMO's bare step, in one run: the dense city (8 times the dissertation's traffic)
// under outages, repaired by the corrected GraphSAGE over the whole network, with the policy of the
// dissertation. `coupling` is everything but SUMO's own step: reading, sensing, graph, prediction, policy,
// commands and metrics, as a share of SUMO's step.

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <benchmark/benchmark.h>

#include "loop/unit_run.hpp"

namespace {

using namespace clearway;

std::filesystem::path temporary_folder() {
    std::string folder = (std::filesystem::temp_directory_path() / "clearway-benchmark-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no temporary folder");
    return folder;
}

experiment::RunJob dense_city(const std::filesystem::path& folder) {
    scenario::Options options;
    options.set("variant", "dense");
    const scenario::ScenarioConfig config = scenario::load("city", options);
    scenario::store(config, folder);
    scenario::build_network(config, folder);
    experiment::RunJob unit;
    unit.scenario = config.name;
    unit.scenario_file = folder / "scenario.toml";
    unit.network_folder = folder;
    unit.output = folder;
    return unit;
}

experiment::ConditionSpec condition(const std::string& failure, const std::string& predictor,
                                    const std::string& part) {
    experiment::ConditionSpec spec;
    spec.name = "benchmark";
    spec.failure = failure;
    spec.predictor = predictor;
    if (!part.empty()) spec.policies = {part};
    return spec;
}

void closed_loop(benchmark::State& state, const experiment::ConditionSpec& spec) {
    const std::filesystem::path folder = temporary_folder();
    const experiment::RunJob unit = dense_city(folder);
    results::RunTiming timing;
    double vehicle_steps = 0.0;
    for (auto _ : state) {
        loop::UnitRun run(unit, folder / "demand", folder / "work");
        vehicle_steps += static_cast<double>(run.finish_here(spec, timing).metrics.vehicle_steps);
    }
    state.counters["coupling"] = timing.coupling_s / timing.simulator_s;
    state.counters["simulator_ns_per_vehicle_step"] = 1e9 * timing.simulator_s / vehicle_steps;
    state.counters["peak_MiB"] = static_cast<double>(timing.peak_kib) / 1024.0;
    std::filesystem::remove_all(folder);
}

}  // namespace

BENCHMARK_CAPTURE(closed_loop, baseline, condition("perfect", "none", ""))
    ->Iterations(1)
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(closed_loop, graph_simulation, condition("perfect", "none", "dissertation"))
    ->Iterations(1)
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(closed_loop, graph_graphsage, condition("B10", "graphsage_corrected", "dissertation"))
    ->Iterations(1)
    ->Unit(benchmark::kSecond);
