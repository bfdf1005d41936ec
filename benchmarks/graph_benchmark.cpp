// What the proximity graph costs per vehicle. Vehicles lie evenly at random in a square whose size gives the
// wanted number of vehicles within 50 m; TABLE I's city mix of classes (47 human, 26 automated, 7 emergency).
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/random.hpp"
#include "graph/proximity.hpp"

namespace {

using namespace clearway;

struct Crowd {
    std::vector<float> x_m;
    std::vector<float> y_m;
    std::vector<traffic::VehicleClass> vehicle_class;
    graph::Places places() const { return {x_m, y_m, vehicle_class}; }
};

traffic::VehicleClass class_from(double draw) {
    if (draw < 47.0 / 80.0) return traffic::VehicleClass::human;
    return draw < 73.0 / 80.0 ? traffic::VehicleClass::automated : traffic::VehicleClass::emergency;
}

Crowd crowd_of(std::int64_t vehicles, std::int64_t within_radius) {
    const core::KeyedRandom random({1}, {0});
    const double area_m2 =
        static_cast<double>(vehicles) / static_cast<double>(within_radius) * std::numbers::pi * 50.0 * 50.0;
    const double side_m = std::sqrt(area_m2);
    Crowd crowd;
    for (std::uint64_t vehicle = 0; vehicle < static_cast<std::uint64_t>(vehicles); ++vehicle) {
        const auto draw = [&](std::uint64_t which) {
            return random.uniform(core::Purpose::demand, vehicle, which);
        };
        crowd.x_m.push_back(static_cast<float>(side_m * draw(0)));
        crowd.y_m.push_back(static_cast<float>(side_m * draw(1)));
        crowd.vehicle_class.push_back(class_from(draw(2)));
    }
    return crowd;
}

void report(benchmark::State& state, const graph::ProximityGraph& graph) {
    const auto vehicles = static_cast<double>(graph.vehicle_count());
    state.counters["links_per_vehicle"] = 2.0 * static_cast<double>(graph.link_count()) / vehicles;
    state.counters["s_per_vehicle"] = benchmark::Counter(
        vehicles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void allowed_links(benchmark::State& state, graph::ProximityBuilder::Kernel kernel) {
    const Crowd crowd = crowd_of(state.range(0), state.range(1));
    graph::ProximityBuilder builder(kernel);
    graph::ProximityGraph graph;
    for ([[maybe_unused]] auto iteration : state) {
        builder.build(crowd.places(), {}, graph);
        benchmark::DoNotOptimize(graph.neighbour.data());
    }
    report(state, graph);
}

void all_pairs(benchmark::State& state, graph::ProximityBuilder::Kernel kernel) {
    const Crowd crowd = crowd_of(state.range(0), state.range(1));
    graph::ProximityBuilder builder(kernel);
    graph::ProximityGraph graph;
    for ([[maybe_unused]] auto iteration : state) {
        builder.build_all_pairs(crowd.places(), 50.0, graph);
        benchmark::DoNotOptimize(graph.neighbour.data());
    }
    report(state, graph);
}

using Kernel = graph::ProximityBuilder::Kernel;
BENCHMARK_CAPTURE(allowed_links, fastest, Kernel::fastest_here)
    ->ArgNames({"vehicles", "near"})
    ->ArgsProduct({{1000, 10000, 100000}, {8, 32}});
BENCHMARK_CAPTURE(allowed_links, scalar, Kernel::scalar)
    ->ArgNames({"vehicles", "near"})
    ->ArgsProduct({{1000, 10000, 100000}, {8, 32}});
BENCHMARK_CAPTURE(all_pairs, fastest, Kernel::fastest_here)
    ->ArgNames({"vehicles", "near"})
    ->ArgsProduct({{1000, 10000, 100000}, {8, 32}});

}  // namespace
