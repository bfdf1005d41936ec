// Networks that package sumo-tools installs, and SUMO's own router as an oracle.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "berlin_network.hpp"
#include "core/files.hpp"
#include "core/process.hpp"
#include "core/random.hpp"
#include "roads/fastest_routes.hpp"
#include "roads/map_matching.hpp"
#include "roads/network.hpp"
#include "roads/route.hpp"
#include "roads/way_ahead.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::roads {
namespace {

bool open_to_cars(const Network& network, const Edge& edge) {
    const auto lanes = network.lanes().subspan(edge.first_lane, edge.lane_count);
    return !edge.internal && std::ranges::any_of(lanes, &Lane::allows_cars);
}

TEST(RealNetwork, BerlinAdlershofIsAsMeasured) {
    const Network network = berlin();
    std::size_t car_edges = 0;
    double length_m = 0.0;
    for (const Edge& edge : network.edges()) {
        if (!open_to_cars(network, edge)) continue;
        ++car_edges;
        length_m += edge.length_m;
    }
    EXPECT_EQ(car_edges, 740u);
    EXPECT_NEAR(length_m, 37'700.0, 50.0);
    EXPECT_EQ(network.signals().size(), 15u);
    EXPECT_EQ(largest_car_component(network).size(), 696u);
    EXPECT_DOUBLE_EQ(network.location().offset_y_m, -5809246.45);
}

TEST(RealNetwork, EverySignalLinkOfBolognaHasItsWayAndItsFoes) {
    const Network network = Network::read(
        sumo_folder() / "tools/sumolib/scenario/scenarios/RealWorld/joined/joined_buslanes.net.xml");
    ASSERT_EQ(network.signals().size(), 13u);
    for (const Signal& signal : network.signals()) {
        std::size_t foes = 0;
        for (std::size_t link = 0; link < signal.links.size(); ++link) {
            EXPECT_FALSE(signal.foes[link][link]) << signal.id;
            for (std::size_t other = 0; other < signal.links.size(); ++other) {
                EXPECT_EQ(signal.foes[link][other], signal.foes[other][link]) << signal.id;
                foes += signal.foes[link][other] ? 1U : 0U;
            }
        }
        EXPECT_GT(foes, 0u) << signal.id;
        // No program gives unconditional green (G) to two ways that cross.
        for (const Phase& phase : signal.program) {
            for (std::size_t link = 0; link < signal.links.size(); ++link) {
                for (std::size_t other = 0; other < link; ++other) {
                    const bool both_free = phase.state[link] == 'G' && phase.state[other] == 'G';
                    EXPECT_FALSE(both_free && signal.foes[link][other])
                        << signal.id << " " << phase.state << " " << other << " " << link;
                }
            }
        }
    }
}

double edge_time_s(const Network& network, core::EdgeIndex index) {
    const Edge& edge = network.edge(index);
    float limit_mps = 0.0F;
    for (const Lane& lane : network.lanes().subspan(edge.first_lane, edge.lane_count)) {
        if (lane.allows_cars) limit_mps = std::max(limit_mps, lane.speed_limit_mps);
    }
    return edge.length_m / limit_mps;
}

double way_time_s(const Network& network, core::EdgeIndex from, core::EdgeIndex to) {
    double best_s = std::numeric_limits<double>::infinity();
    for (std::uint32_t number = 0; number < network.edge(from).lane_count; ++number) {
        for (const Connection& connection : network.connections_from(network.lane_of(from, number))) {
            if (network.lane(connection.to).edge != to || !connection.allows_cars) continue;
            double time_s = 0.0;
            for (core::LaneIndex lane = connection.via; lane.exists();
                 lane = network.connections_from(lane)[0].via) {
                time_s += network.lane(lane).length_m / network.lane(lane).speed_limit_mps;
            }
            best_s = std::min(best_s, time_s);
        }
    }
    return best_s;
}

double time_of(const Network& network, Route route) {
    double time_s = 0.0;
    for (std::size_t place = 0; place < route.size(); ++place) {
        if (place > 0) time_s += edge_time_s(network, route[place]);
        if (place > 0) time_s += way_time_s(network, route[place - 1], route[place]);
    }
    return time_s;
}

/// The routes in a file of duarouter, in its order.
std::vector<std::vector<core::EdgeIndex>> routes_in(const Network& network, const std::string& text) {
    std::vector<std::vector<core::EdgeIndex>> routes;
    const std::string mark = "edges=\"";
    for (std::size_t place = text.find(mark); place != std::string::npos; place = text.find(mark, place)) {
        place += mark.size();
        const std::size_t end = text.find('"', place);
        std::vector<core::EdgeIndex>& route = routes.emplace_back();
        while (place < end) {
            const std::size_t stop = std::min(text.find(' ', place), end);
            route.push_back(*network.find_edge(text.substr(place, stop - place)));
            place = stop + 1;
        }
    }
    return routes;
}

TEST(RealNetwork, NoRouteOfSumosRouterIsFasterThanOurs) {
    const Network network = berlin();
    const std::vector<core::EdgeIndex> edges = largest_car_component(network);
    const core::KeyedRandom random({1}, {0});
    constexpr std::uint64_t trips = 200;
    const auto end = [&](std::uint64_t trip, std::uint64_t which) {
        return edges[random.below(edges.size(), core::Purpose::demand, trip, which)];
    };
    std::string text = "<routes><vType id=\"t\" maxSpeed=\"100\" speedFactor=\"1\" speedDev=\"0\"/>\n";
    for (std::uint64_t trip = 0; trip < trips; ++trip) {
        text += fmt::format("<trip id=\"{}\" type=\"t\" depart=\"{}\" from=\"{}\" to=\"{}\"/>\n", trip, trip,
                            network.edge(end(trip, 0)).id, network.edge(end(trip, 1)).id);
    }
    const support::TemporaryFolder folder;
    const auto trip_file = folder.write("trips.xml", text + "</routes>\n");
    const auto route_file = folder.path() / "routes.xml";
    const core::Exit exit =
        core::run({.program = "duarouter",
                   .arguments = {"-n", (sumo_folder() / "tools/game/DRT/osm.net.xml").string(), "-r",
                                 trip_file.string(), "-o", route_file.string(), "--xml-validation", "never",
                                 "--weights.minor-penalty", "0"},
                   .environment = {{"SUMO_HOME", sumo_folder().string()}},
                   .output = folder.path() / "log"});
    ASSERT_TRUE(exit.ok()) << core::tail(folder.path() / "log", 20);
    const auto theirs = routes_in(network, core::read_file(route_file));
    ASSERT_EQ(theirs.size(), trips);
    std::size_t same = 0;
    for (std::uint64_t trip = 0; trip < trips; ++trip) {
        const auto ours = FastestRoutes(network).between(end(trip, 0), end(trip, 1));
        ASSERT_TRUE(ours.has_value()) << trip;
        const double ours_s = time_of(network, *ours);
        const double theirs_s = time_of(network, theirs[trip]);
        EXPECT_LE(ours_s, theirs_s + 1e-3) << trip;
        EXPECT_GE(ours_s, theirs_s * 0.97 - 1.0) << trip;
        same += *ours == theirs[trip] ? 1U : 0U;
    }
    EXPECT_GT(same, trips * 8 / 10);
    RecordProperty("same", static_cast<int>(same));
}

TEST(RealNetwork, AWayThatIsWalkedOnceTellsWhatAWalkToEachPlaceTells) {
    const Network network = berlin();
    const std::vector<core::EdgeIndex> edges = largest_car_component(network);
    const core::KeyedRandom random(core::StudySeed{1}, core::Replication{0});
    std::size_t found = 0;
    std::size_t inside = 0;
    for (std::uint64_t trip = 0; trip < 30; ++trip) {
        const auto draw = [&](std::uint64_t which) {
            return random.uniform(core::Purpose::emergency, trip, which);
        };
        const auto end = [&](std::uint64_t which) {
            return edges[random.below(edges.size(), core::Purpose::demand, trip, which)];
        };
        auto route = *FastestRoutes(network).between(end(0), end(1));
        // A route may pass a junction twice.
        const auto back = FastestRoutes(network).between(route.back(), route.front());
        if (trip % 3 == 0 && back) route.insert(route.end(), back->begin() + 1, back->end());
        const double start_m = draw(0) * 0.5 * route_length(network, route).value;
        const auto state =
            advance(network, route, {.lane = network.lane_of(route.front(), 0)}, core::Metres(start_m)).state;
        const core::Metres horizon(trip % 2 == 0 ? 300.0 : 1000.0);
        const WayAhead way(network, route, state, horizon);
        for (std::uint32_t row = 0; row < network.lanes().size(); ++row) {
            traffic::MotionState other;
            other.lane = core::LaneIndex{row};
            other.lane_position_m = network.lane(other.lane).length_m * static_cast<float>(draw(row + 1));
            const auto alone = distance_ahead(network, route, state, other, horizon);
            EXPECT_EQ(way.distance_to(other), alone) << network.lane(other.lane).id;
            if (!alone) continue;
            ++found;
            if (network.edge(network.lane(other.lane).edge).internal) ++inside;
        }
        EXPECT_FALSE(way.distance_to({}).has_value());
    }
    EXPECT_GT(found, 1000U);
    EXPECT_GT(inside, 100U);
}

/// Shares of sightings that are matched to a wrong edge and to a wrong lane.
struct WrongShares {
    double edge = 0.0;
    double lane = 0.0;
};

enum class RouteKnown { no, yes };

/// Places every 23 m along 100 routes by car, each seen with errors of `sigma_m` along each axis and of 5
/// degrees in its direction.
WrongShares wrong_shares(const Network& network, double sigma_m, RouteKnown route_known) {
    const core::KeyedRandom random(core::StudySeed{1}, core::Replication{0});
    constexpr double heading_sigma_rad = 5.0 * std::numbers::pi / 180.0;
    const std::vector<core::EdgeIndex> edges = largest_car_component(network);
    MapMatcher matcher(network);
    double count = 0.0;
    WrongShares wrong;
    for (std::uint64_t trip = 0; trip < 100; ++trip) {
        const auto draw = [&](std::uint64_t end) {
            return edges[random.below(edges.size(), core::Purpose::demand, trip, end)];
        };
        const auto route = FastestRoutes(network).between(draw(0), draw(1));
        if (!route) continue;
        traffic::MotionState state{.lane = network.lane_of(route->front(), 0)};
        for (std::uint64_t number = 0;; ++number) {
            const Advanced on = advance(network, *route, state, core::Metres(23.0));
            if (on.past_end.value > 0.0) break;
            state = on.state;
            const auto error = [&](std::uint64_t axis) {
                return random.normal(core::Purpose::position_noise, trip, 3 * number + axis);
            };
            const Sighting sighting{{static_cast<float>(state.x_m + sigma_m * error(0)),
                                     static_cast<float>(state.y_m + sigma_m * error(1))},
                                    state.heading_rad + heading_sigma_rad * error(2),
                                    sigma_m,
                                    heading_sigma_rad};
            const auto place =
                matcher.match(sighting, route_known == RouteKnown::yes ? Route(*route) : Route());
            const bool lane_right = place && place->lane == state.lane;
            const bool edge_right = place && network.lane(place->lane).edge == network.lane(state.lane).edge;
            count += 1.0;
            wrong.edge += edge_right ? 0.0 : 1.0;
            wrong.lane += lane_right ? 0.0 : 1.0;
        }
    }
    return {wrong.edge / count, wrong.lane / count};
}

// results/map_matching.csv states these figures.
TEST(RealNetwork, MapMatchingInTheCityErrsAsStated) {
    const Network network = berlin();
    const auto expect = [&](double sigma_m, RouteKnown route_known, double edge, double lane) {
        const WrongShares wrong = wrong_shares(network, sigma_m, route_known);
        EXPECT_NEAR(wrong.edge, edge, 0.005) << sigma_m;
        EXPECT_NEAR(wrong.lane, lane, 0.005) << sigma_m;
    };
    expect(3.0, RouteKnown::yes, 0.084, 0.186);
    expect(5.0, RouteKnown::yes, 0.130, 0.249);
    expect(3.0, RouteKnown::no, 0.111, 0.213);
    expect(5.0, RouteKnown::no, 0.164, 0.281);
}

}  // namespace
}  // namespace clearway::roads
