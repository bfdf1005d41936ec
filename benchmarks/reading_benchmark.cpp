// What it costs to read the state of every vehicle and signal after each step, against SUMO's own step, on
// the network of Berlin-Adlershof with random trips. Figures: ns per vehicle and step, and their ratio.

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/process.hpp"
#include "sumo/network_names.hpp"
#include "sumo/session.hpp"

namespace {

using namespace clearway;

constexpr double warm_up_s = 300.0;
constexpr double end_s = 700.0;

std::filesystem::path city() {
    const char* home = std::getenv("SUMO_HOME");
    return std::filesystem::path(home == nullptr ? "/usr/share/sumo" : home) / "tools/game/DRT/osm.net.xml";
}

/// Random trips until `end_s`, `per_second` of them each second; those without a way are left out.
std::filesystem::path random_routes(const std::filesystem::path& folder, const sumo::Names& names,
                                    double per_second) {
    std::vector<std::string> edges;
    for (const std::string& edge : names.edges) {
        if (!edge.starts_with(':')) edges.push_back(edge);
    }
    std::mt19937 generator(7);
    std::uniform_int_distribution<std::size_t> any(0, edges.size() - 1);
    std::ofstream trips(folder / "trips.xml");
    trips << "<routes>";
    for (int i = 0; i < end_s * per_second; ++i) {
        trips << fmt::format(R"(<trip id="t{}" depart="{}" from="{}" to="{}" departLane="best"/>)", i,
                             i / per_second, edges[any(generator)], edges[any(generator)]);
    }
    trips << "</routes>";
    trips.close();
    const core::Exit exit =
        core::run({.program = "duarouter",
                   .arguments = {"-n", city(), "-r", folder / "trips.xml", "-o", folder / "routes.xml",
                                 "--ignore-errors", "--no-warnings", "--xml-validation", "never"},
                   .environment = {},
                   .output = folder / "duarouter.log"});
    if (!exit.ok()) throw std::runtime_error("duarouter: " + exit.describe());
    return folder / "routes.xml";
}

void read_city(benchmark::State& state) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("clearway-reading-{}", ::getpid());
    std::filesystem::create_directories(folder);
    sumo::SessionConfig config;
    config.network = city();
    config.folder = folder;
    config.names = test::read_names(city());
    config.route_files = {random_routes(folder, config.names, static_cast<double>(state.range(0)) / 10.0)};
    double total_s = 0.0;
    double simulator_s = 0.0;
    double vehicle_steps = 0.0;
    double steps = 0.0;
    {
        sumo::Session session(config);
        while (session.time().value < warm_up_s)
            session.step();
        for (auto _ : state) {
            const auto started = std::chrono::steady_clock::now();
            session.step();
            total_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
            simulator_s += session.step_wall_time().value;
            vehicle_steps += static_cast<double>(session.snapshot().size());
            ++steps;
        }
    }
    std::filesystem::remove_all(folder);
    state.counters["vehicles"] = vehicle_steps / steps;
    state.counters["bare_step_ns"] = 1e9 * simulator_s / vehicle_steps;
    state.counters["reading_ns"] = 1e9 * (total_s - simulator_s) / vehicle_steps;
    state.counters["reading_per_bare_step"] = (total_s - simulator_s) / simulator_s;
}

// Argument: trips per 10 s. 1600 steps of 0.25 s, the same in every run.
BENCHMARK(read_city)->Arg(20)->Arg(200)->Iterations(1600)->Unit(benchmark::kMicrosecond);

}  // namespace
