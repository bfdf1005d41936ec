// A network that package sumo-tools installs; plain Dijkstra is the oracle.
#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include <gtest/gtest.h>

#include "berlin_network.hpp"
#include "core/random.hpp"
#include "roads/fastest_routes.hpp"
#include "roads/route_search.hpp"
#include "support/allocation_count.hpp"

namespace clearway::roads {
namespace {

/// Delay of an edge that fades after its entry, as that of an edge on which traffic was seen.
struct Fading {
    const RouteSearch& search;
    double operator()(core::EdgeIndex edge, double entered_s) const {
        const double seen_s = static_cast<double>((edge.value * 7919U) % 60U);
        return search.free_s(edge) + seen_s * std::exp(-entered_s / 120.0);
    }
};

/// Without bounds or reuse, over all edges: the shortest times by label setting.
template <class EdgeTime>
double dijkstra_s(const Network& network, const RouteSearch& search, core::EdgeIndex from, core::EdgeIndex to,
                  const EdgeTime& edge_s) {
    std::vector<double> leaves_s(network.edges().size(), no_way_s);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.emplace(leaves_s[from.value] = 0.0, from.value);
    while (!queue.empty()) {
        const auto [now_s, row] = queue.top();
        queue.pop();
        if (now_s > leaves_s[row]) continue;
        for (const core::EdgeIndex next : network.successors(core::EdgeIndex{row})) {
            const std::vector pair{core::EdgeIndex{row}, next};
            const double then_s = search.time_of(pair, now_s, edge_s);
            if (then_s >= leaves_s[next.value]) continue;
            queue.emplace(leaves_s[next.value] = then_s, next.value);
        }
    }
    return leaves_s[to.value];
}

std::vector<Trip> pairs_of(const Network& network, int count) {
    const std::vector<core::EdgeIndex> edges = largest_car_component(network);
    std::vector<Trip> pairs;
    for (std::uint32_t i = 0; static_cast<int>(pairs.size()) < count; ++i)
        pairs.push_back({edges[(i * 7901U) % edges.size()], edges[(i * 4513U + 17U) % edges.size()]});
    return pairs;
}

TEST(RealRouteSearch, FindsTheFastestRouteOfDijkstra) {
    const Network network = berlin();
    RouteSearch search(network, Driver::car);
    const auto free = [&](core::EdgeIndex edge, double) { return search.free_s(edge); };
    std::vector<core::EdgeIndex> way;
    for (const Trip& pair : pairs_of(network, 100)) {
        const double found_s = search.search(pair, free, way);
        const auto oracle = FastestRoutes(network).between(pair.from, pair.to);
        ASSERT_TRUE(oracle && way.front() == pair.from && way.back() == pair.to);
        EXPECT_NEAR(found_s, search.time_of(*oracle, 0.0, free), 1e-6);
        EXPECT_NEAR(found_s, search.time_of(way, 0.0, free), 1e-6);
    }
}

TEST(RealRouteSearch, IsExactWhereTimesChangeOnTheWay) {
    const Network network = berlin();
    RouteSearch search(network, Driver::car);
    const Fading fading{search};
    std::vector<core::EdgeIndex> way;
    int changed = 0;
    for (const Trip& pair : pairs_of(network, 100)) {
        const double found_s = search.search(pair, fading, way);
        EXPECT_NEAR(found_s, dijkstra_s(network, search, pair.from, pair.to, fading), 1e-6);
        changed += FastestRoutes(network).between(pair.from, pair.to) != way ? 1 : 0;
    }
    EXPECT_GT(changed, 20) << "or the delays would not matter";
}

TEST(RealRouteSearch, AllocatesNothingAfterTheFirstSearch) {
    const Network network = berlin();
    RouteSearch search(network, Driver::car);
    const Fading fading{search};
    const std::vector<Trip> pairs = pairs_of(network, 20);
    const core::EdgeIndex to = pairs.front().to;
    std::vector<core::EdgeIndex> way;
    way.reserve(network.edges().size());
    for (const Trip& pair : pairs)
        search.search({pair.from, to}, fading, way);
    const std::size_t before = support::allocation_count();
    for (const Trip& pair : pairs)
        search.search({pair.from, to}, fading, way);
    EXPECT_EQ(support::allocation_count(), before);
}

TEST(RealRouteSearch, WaysAreDifferentAndTheFirstIsTheFastest) {
    const Network network = berlin();
    RouteSearch search(network, Driver::car);
    const auto free = [&](core::EdgeIndex edge, double) { return search.free_s(edge); };
    std::size_t found = 0;
    for (const Trip& pair : pairs_of(network, 20)) {
        auto ways = search.ways(pair, free, 8);
        ASSERT_FALSE(ways.empty());
        found += ways.size();
        for (const auto& way : ways)
            EXPECT_GE(search.time_of(way, 0.0, free) + 1e-9, search.time_of(ways.front(), 0.0, free));
        std::ranges::sort(ways);
        EXPECT_EQ(std::ranges::adjacent_find(ways), ways.end());
    }
    EXPECT_GT(found, 60U);
}

}  // namespace
}  // namespace clearway::roads
