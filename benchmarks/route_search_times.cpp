// What a search of a way costs where times change while one drives: `route_search_times NETWORK`. Prints the
// median and the 99th percentile of 1,000 searches, ms, after one to each destination that pays for its
// backward tree; then what a decision adds for a policy in Python (believed times of all edges) and for an
// environment that offers 8 ways.
// benchmarks/route_search.py makes grids and runs it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

#include "core/random.hpp"
#include "policy/detail/believed_ways.hpp"
#include "policy/navigate.hpp"
#include "roads/route_search.hpp"

namespace {

using namespace clearway;
using Clock = std::chrono::steady_clock;

constexpr int searches = 1000;
constexpr std::uint64_t destinations = 10;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

/// Times of all edges, where a vehicle stands on every tenth one; median of 100 decisions.
double edge_times_ms(const roads::Network& network, const std::vector<core::EdgeIndex>& edges) {
    policy::detail::BelievedWays ways({network}, policy::NavigateConfig{});
    traffic::BelievedGraph belief;
    for (std::size_t at = 0; at < edges.size(); at += 10) {
        traffic::BelievedVehicle vehicle;
        vehicle.state.lane = network.lane_of(edges[at], 0);
        belief.vehicles.push_back(vehicle);
    }
    std::vector<double> decisions_ms, times_s(network.edges().size());
    for (int decision = 0; decision < 100; ++decision) {
        belief.time = core::Seconds(0.5 * decision);
        const auto start = Clock::now();
        ways.see(belief);
        for (std::uint32_t row = 0; row < times_s.size(); ++row)
            times_s[row] = ways.now_s(core::EdgeIndex{row});
        decisions_ms.push_back(ms_since(start));
    }
    return median(decisions_ms);
}

void measure(const char* file) {
    const roads::Network network = roads::Network::read(file);
    const std::vector<core::EdgeIndex> edges = roads::largest_car_component(network);
    roads::RouteSearch search(network, roads::Driver::emergency);
    const core::KeyedRandom random({1}, {0});
    const auto draw = [&](std::uint64_t number, std::uint64_t which) {
        return edges[static_cast<std::size_t>(random.uniform(core::Purpose::demand, number, which) *
                                              static_cast<double>(edges.size()))];
    };
    // Up to a minute was lost on each edge, as traffic was seen; it fades on the way.
    const auto edge_s = [&](core::EdgeIndex edge, double entered_s) {
        const double seen_s = 60.0 * random.uniform(core::Purpose::demand, edge.value, 2);
        return search.free_s(edge) + seen_s * std::exp(-entered_s / 120.0);
    };
    std::vector<core::EdgeIndex> way;
    double tree_ms = 0.0;
    for (std::uint64_t to = 0; to < destinations; ++to) {
        const auto start = Clock::now();
        search.search({draw(0, 0), draw(to, 1)}, edge_s, way);
        tree_ms = std::max(tree_ms, ms_since(start));
    }
    std::vector<double> times_ms;
    for (std::uint64_t number = 0; number < searches; ++number) {
        const auto start = Clock::now();
        search.search({draw(number, 0), draw(number % destinations, 1)}, edge_s, way);
        times_ms.push_back(ms_since(start));
    }
    std::ranges::sort(times_ms);
    std::printf(
        "edges %zu, first search to a destination at most %.2f ms, then median %.3f ms, 99th percentile %.3f "
        "ms\n",
        edges.size(), tree_ms, times_ms[searches / 2], times_ms[searches * 99 / 100]);
    std::vector<double> choices_ms;
    for (std::uint64_t number = 0; number < 100; ++number) {
        const auto start = Clock::now();
        search.ways({draw(number, 0), draw(number % destinations, 1)}, edge_s, 8);
        choices_ms.push_back(ms_since(start));
    }
    std::printf("times of all %zu edges, internal ones included, median %.2f ms; 8 ways, median %.2f ms\n",
                network.edges().size(), edge_times_ms(network, edges), median(choices_ms));
}

}  // namespace

int main(int count, char** words) {
    try {
        if (count != 2) {
            std::fputs("usage: route_search_times NETWORK\n", stderr);
            return 2;
        }
        measure(words[1]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
