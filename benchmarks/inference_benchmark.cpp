// What prediction costs per report. Three lanes with a vehicle every 12 m (jammed) or 40 m (dense: about as
// many candidates a vehicle as the dense merge, intersection and city have), TABLE I's city mix of classes
// (47 human, 26 automated, 7 emergency), 30 % of them dark for up to 20 s. `vehicles` counts them; times are
// per call, `per_vehicle` per vehicle and call.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "core/random.hpp"
#include "prediction/comparison/dissertation_net.hpp"
#include "prediction/comparison/features.hpp"
#include "prediction/nets.hpp"
#include "prediction/predictor.hpp"

namespace {

using namespace clearway;

constexpr double jammed_m = 12.0;  ///< Between two vehicles of a lane.
constexpr double dense_m = 40.0;
constexpr std::uint32_t lanes = 3;

double draw(std::uint64_t subject, std::uint64_t counter) {
    return core::KeyedRandom({1}, {0}).uniform(core::Purpose::demand, subject, counter);
}

std::string road_text(double length_m) {
    std::string text = fmt::format(
        R"(<net version="1.9"><location netOffset="0,0" convBoundary="0,0,{0},10" origBoundary="0,0,{0},10" projParameter="!"/>)",
        length_m);
    text += R"(<edge id="road" from="A" to="B" priority="1">)";
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        text +=
            fmt::format(R"(<lane id="road_{0}" index="{0}" speed="14" length="{1}" shape="0,{2} {1},{2}"/>)",
                        lane, length_m, 3.2 * lane);
    }
    return text +
           R"(</edge><junction id="A" type="dead_end" x="0" y="0" incLanes="" intLanes="" shape="0,0"/>)" +
           R"(<junction id="B" type="dead_end" x="1" y="0" incLanes="" intLanes="" shape="0,0"/></net>)";
}

/// The road with its vehicles as an observation.
class Traffic {
  public:
    enum class Darkness { nobody, some, everybody };

    Traffic(std::int64_t vehicles, Darkness darkness, double spacing_m = jammed_m)
        : spacing_m_(spacing_m), network_(make_network(vehicles, spacing_m)) {
        const core::RouteIndex route = roster_.add_route({*network_.find_edge("road")});
        std::vector<core::VehicleKey> keys;
        for (std::int64_t number = 0; number < vehicles; ++number) {
            traffic::VehicleInfo info;
            info.id = std::to_string(number);
            info.key = core::vehicle_key(info.id);
            info.route = route;
            roster_.add(info);
            observation_.vehicles.push_back(vehicle(info.key, static_cast<std::uint64_t>(number), darkness));
        }
        std::ranges::sort(observation_.vehicles, {}, &traffic::ObservedVehicle::key);
        observation_.roster = &roster_;
        observation_.is_report = true;
    }

    const roads::Network& network() const { return network_; }
    const traffic::Observation& observation() const { return observation_; }
    /// The next report round: who is dark stays so for up to 20 s, then reports once.
    void pass_second() {
        observation_.time += core::Seconds(1.0);
        for (traffic::ObservedVehicle& vehicle : observation_.vehicles) {
            if (vehicle.freshness == traffic::Freshness::fresh) continue;
            vehicle.age_s = vehicle.age_s < 20.0F ? vehicle.age_s + 1.0F : 1.0F;
        }
    }

  private:
    static roads::Network make_network(std::int64_t vehicles, double spacing_m) {
        const auto file = std::filesystem::temp_directory_path() / "clearway-inference-benchmark.net.xml";
        std::ofstream(file) << road_text(static_cast<double>(vehicles) * spacing_m / lanes + 1000.0);
        roads::Network network = roads::Network::read(file);
        std::filesystem::remove(file);
        return network;
    }

    traffic::ObservedVehicle vehicle(core::VehicleKey key, std::uint64_t number, Darkness darkness) const {
        traffic::ObservedVehicle result;
        result.key = key;
        const double kind = draw(number, 0);
        result.vehicle_class = kind < 47.0 / 80.0   ? traffic::VehicleClass::human
                               : kind < 73.0 / 80.0 ? traffic::VehicleClass::automated
                                                    : traffic::VehicleClass::emergency;
        const double position_m = static_cast<double>(number / lanes) * spacing_m_;
        result.state.lane =
            network_.lane_of(*network_.find_edge("road"), static_cast<std::uint32_t>(number % lanes));
        result.state.lane_position_m = static_cast<float>(position_m);
        result.state.x_m = static_cast<float>(position_m);
        result.state.y_m = static_cast<float>(3.2 * static_cast<double>(number % lanes));
        result.state.speed_mps = static_cast<float>(14.0 * draw(number, 1));
        if (darkness == Darkness::everybody || (darkness == Darkness::some && draw(number, 2) < 0.3)) {
            result.freshness = traffic::Freshness::stale;
            result.age_s = static_cast<float>(1.0 + 19.0 * draw(number, 3));
        }
        return result;
    }

    double spacing_m_;
    roads::Network network_;
    traffic::Roster roster_;
    traffic::Observation observation_;
};

void note_cost(benchmark::State& state, std::size_t candidates) {
    const auto vehicles = static_cast<double>(state.range(0));
    state.counters["per_vehicle"] = benchmark::Counter(
        vehicles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["candidates_per_vehicle"] = static_cast<double>(candidates) / vehicles;
}

void predict(benchmark::State& state, const std::string& name, Traffic::Darkness darkness,
             double spacing_m = jammed_m) {
    const Traffic traffic(state.range(0), darkness, spacing_m);
    const auto predictor = prediction::make_predictor(name, {traffic.network(), {}, "", {}});
    traffic::BelievedGraph belief;
    for (auto _ : state) {
        predictor->predict(traffic.observation(), belief);
        benchmark::DoNotOptimize(belief.links.data());
    }
    note_cost(state, predictor->scores().scene->candidates.size());
}

/// Of a predictor that drives vehicles from one report to the next: time passes between the calls.
void follow(benchmark::State& state, const std::string& name) {
    Traffic traffic(state.range(0), Traffic::Darkness::some, dense_m);
    const auto predictor = prediction::make_predictor(name, {traffic.network(), {}, "", {}});
    traffic::BelievedGraph belief;
    for (auto _ : state) {
        traffic.pass_second();
        predictor->predict(traffic.observation(), belief);
        benchmark::DoNotOptimize(belief.links.data());
    }
    note_cost(state, predictor->scores().scene->candidates.size());
}

/// The net alone: embeddings of all vehicles along observed links and the scores of all candidates.
void net_alone(benchmark::State& state, std::uint32_t inputs, std::uint32_t hidden, std::uint32_t output,
               prediction::Kernel kernel) {
    const Traffic traffic(state.range(0), Traffic::Darkness::some);
    const graph::LinkRules rules;
    prediction::Scene scene;
    prediction::SceneBuilder(traffic.network(), rules).build(traffic.observation(), scene);
    prediction::MessageGraph messages;
    prediction::ObservedMessages().build(scene, rules, messages);
    const prediction::FeatureSchema schema{"benchmark", 1, inputs};
    prediction::DissertationNet net(prediction::Convolution::sage,
                                    prediction::testing::random_net(schema, hidden, output), schema, kernel);
    std::vector<float> features(scene.tracks.size() * inputs);
    for (std::size_t at = 0; at < features.size(); ++at) {
        features[at] = static_cast<float>(draw(at, 4));
    }
    std::vector<float> logits;
    for (auto _ : state) {
        net.logits(features, messages, scene.candidates.rows, logits);
        benchmark::DoNotOptimize(logits.data());
    }
    note_cost(state, scene.candidates.size());
}

using prediction::Kernel;
using Darkness = Traffic::Darkness;

BENCHMARK_CAPTURE(net_alone, published_5_10_5_avx2, 5, 10, 5, Kernel::avx2)->Arg(1000)->Arg(10000);
BENCHMARK_CAPTURE(net_alone, published_5_10_5_scalar, 5, 10, 5, Kernel::scalar)->Arg(1000);
BENCHMARK_CAPTURE(net_alone, larger_12_32_16_avx2, 12, 32, 16, Kernel::avx2)->Arg(1000);
BENCHMARK_CAPTURE(net_alone, larger_12_32_16_scalar, 12, 32, 16, Kernel::scalar)->Arg(1000);
BENCHMARK_CAPTURE(predict, none_all_seen, "none", Darkness::nobody)->Arg(1000)->Arg(10000);
BENCHMARK_CAPTURE(predict, dead_reckoning_all_seen, "dead_reckoning", Darkness::nobody)->Arg(1000);
BENCHMARK_CAPTURE(predict, dead_reckoning_30_dark, "dead_reckoning", Darkness::some)->Arg(1000)->Arg(10000);
BENCHMARK_CAPTURE(predict, dead_reckoning_all_dark, "dead_reckoning", Darkness::everybody)->Arg(1000);
BENCHMARK_CAPTURE(predict, corrected_30_dark, "graphsage_corrected", Darkness::some)->Arg(1000)->Arg(10000);
BENCHMARK_CAPTURE(predict, corrected_all_dark, "graphsage_corrected", Darkness::everybody)->Arg(1000);
BENCHMARK_CAPTURE(predict, route_rule_dense_30_dark, "route_rule", Darkness::some, dense_m)
    ->Arg(1000)
    ->Arg(10000);
BENCHMARK_CAPTURE(follow, car_following_dense_30_dark, "car_following")->Arg(1000)->Arg(10000);
BENCHMARK_CAPTURE(follow, route_rule_dense_30_dark_moving, "route_rule")->Arg(1000);
BENCHMARK_CAPTURE(follow, graphsage_dense_30_dark_moving, "graphsage")->Arg(1000);
BENCHMARK_CAPTURE(predict, graphsage_all_seen, "graphsage", Darkness::nobody, dense_m)->Arg(1000)->Arg(10000);
BENCHMARK_CAPTURE(predict, graphsage_dense_30_dark, "graphsage", Darkness::some, dense_m)
    ->Arg(1000)
    ->Arg(10000);
BENCHMARK_CAPTURE(predict, graphsage_jammed_30_dark, "graphsage", Darkness::some)->Arg(1000)->Arg(10000);
BENCHMARK_CAPTURE(predict, gradient_boosting_dense_30_dark, "gradient_boosting", Darkness::some, dense_m)
    ->Arg(1000)
    ->Arg(10000);
BENCHMARK_CAPTURE(predict, graphsage_all_dark, "graphsage", Darkness::everybody, dense_m)->Arg(1000);

}  // namespace
