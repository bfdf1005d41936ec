// Labels of all edges, without bounds or an order of search, are the oracle.
#include "roads/fastest_routes.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <string>

#include <gtest/gtest.h>

#include "berlin_network.hpp"
#include "core/process.hpp"
#include "support/allocation_count.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::roads {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

double lane_s(const Lane& lane) {
    return static_cast<double>(lane.length_m) / lane.speed_limit_mps;
}

struct Step {
    core::EdgeIndex from, to;
};

/// When the end of step.to is reached by a car that leaves step.from at `left_s`.
double arrival_s(const Network& network, const Step& step, double left_s) {
    double edge_s = never;
    double best_s = never;
    const Edge& to = network.edge(step.to);
    for (const Lane& lane : network.lanes().subspan(to.first_lane, to.lane_count))
        if (lane.allows_cars) edge_s = std::min(edge_s, lane_s(lane));
    const Edge& from = network.edge(step.from);
    for (std::uint32_t row = from.first_lane; row < from.first_lane + from.lane_count; ++row) {
        for (const Connection& way : network.connections_from(core::LaneIndex{row})) {
            if (!way.allows_cars || network.lane(way.to).edge != step.to) continue;
            double then_s = left_s + edge_s;
            for (core::LaneIndex inner = way.via; inner.exists();
                 inner = network.connections_from(inner).front().via)
                then_s += lane_s(network.lane(inner));
            best_s = std::min(best_s, then_s);
        }
    }
    return best_s;
}

std::vector<double> all_arrivals_s(const Network& network, core::EdgeIndex from) {
    std::vector<double> arrivals_s(network.edges().size(), never);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.emplace(arrivals_s[from.value] = 0.0, from.value);
    while (!queue.empty()) {
        const auto [now_s, row] = queue.top();
        queue.pop();
        if (now_s > arrivals_s[row]) continue;
        for (const core::EdgeIndex next : network.successors(core::EdgeIndex{row})) {
            const double then_s = arrival_s(network, {core::EdgeIndex{row}, next}, now_s);
            if (then_s < arrivals_s[next.value]) queue.emplace(arrivals_s[next.value] = then_s, next.value);
        }
    }
    return arrivals_s;
}

/// Of the edges before each from which it is reached in the least time, the one with the lowest index.
std::vector<core::EdgeIndex> oracle(const Network& network, core::EdgeIndex from, core::EdgeIndex to) {
    const std::vector<double> arrivals_s = all_arrivals_s(network, from);
    std::vector<core::EdgeIndex> way{to};
    while (way.back() != from) {
        std::uint32_t before = 0;
        while (arrivals_s[before] == never || arrivals_s[before] >= arrivals_s[way.back().value] ||
               arrival_s(network, {core::EdgeIndex{before}, way.back()}, arrivals_s[before]) !=
                   arrivals_s[way.back().value])
            ++before;
        way.push_back(core::EdgeIndex{before});
    }
    std::ranges::reverse(way);
    return way;
}

std::vector<Step> ends_of(const Network& network, std::uint32_t count) {
    const std::vector<core::EdgeIndex> edges = largest_car_component(network);
    std::vector<Step> ends;
    for (std::uint32_t i = 0; i < count; ++i)
        ends.push_back({edges[(i * 7901U) % edges.size()], edges[(i * 4513U + 17U) % edges.size()]});
    return ends;
}

void expect_routes_of_oracle(const Network& network, std::uint32_t count) {
    FastestRoutes routes(network);
    for (const Step& trip : ends_of(network, count))
        EXPECT_EQ(routes.between(trip.from, trip.to), oracle(network, trip.from, trip.to))
            << network.edge(trip.from).id << " to " << network.edge(trip.to).id;
}

TEST(FastestRoutes, AreThoseOfAllLabelsOnRealStreets) {
    expect_routes_of_oracle(berlin(), 150);
}

TEST(FastestRoutes, TakeTheLowestEdgeOfEquallyFastWays) {
    const support::TemporaryFolder folder;
    const std::string file = folder.path() / "grid.net.xml";
    const core::Exit exit = core::run({.program = "netgenerate",
                                       .arguments = {"--grid", "--grid.number", "9", "-L", "2", "-o", file},
                                       .output = folder.path() / "log"});
    ASSERT_TRUE(exit.ok()) << core::tail(folder.path() / "log", 20);
    expect_routes_of_oracle(Network::read(file), 300);
}

TEST(FastestRoutes, AllocateTheRouteAlone) {
    const Network network = berlin();
    FastestRoutes routes(network);
    const std::vector<Step> trips = ends_of(network, 20);
    const auto allocations = [&] {
        const std::size_t before = support::allocation_count();
        for (const Step& trip : trips)
            routes.between(trip.from, trip.to);
        return support::allocation_count() - before;
    };
    allocations();
    constexpr std::size_t of_a_growing_route = 10;
    EXPECT_LE(allocations(), trips.size() * of_a_growing_route);
}

}  // namespace
}  // namespace clearway::roads
