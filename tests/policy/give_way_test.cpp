#include "policy/give_way.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "roads/crossing_network.hpp"
#include "support/crossing_scene.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::testing {
namespace {

/// A junction where south yields to west, with an emergency vehicle from the south.
class Yielding : public ::testing::Test {
  protected:
    static roads::Network network(const std::string& from = {}, const std::string& to = {}) {
        std::string text = roads::crossing_without_signal();
        if (!from.empty()) text.replace(text.find(from), from.size(), to);
        const support::TemporaryFolder folder;
        return roads::Network::read(folder.write("yield.net.xml", text));
    }
    /// Ids of those who are asked to stop when the emergency vehicle is `emergency_m` into its edge.
    static std::set<std::string> asked(policy::GiveWay& policy, const roads::Network& network,
                                       double emergency_m = 30.0, double at_s = 100.0,
                                       std::vector<SceneVehicle> others = {}) {
        CrossingScene scene(at_s, network);
        scene.add({"e", traffic::VehicleClass::emergency, {"south", "north"}, 0, emergency_m, 8.0});
        const std::vector<SceneVehicle> usual = {
            {"near", traffic::VehicleClass::automated, {"west", "east"}, 0, 60.0, 8.0},
            {"far", traffic::VehicleClass::automated, {"west", "east"}, 0, 20.0, 8.0},
            {"human", traffic::VehicleClass::human, {"west", "east"}, 0, 70.0, 8.0},
            {"behind", traffic::VehicleClass::automated, {"east", "back"}, 0, 150.0, 8.0},
        };
        others.insert(others.end(), usual.begin(), usual.end());
        std::map<core::VehicleKey, std::string> ids;
        for (const SceneVehicle& other : others)
            ids[scene.add(other)] = other.id;
        std::vector<traffic::Lease> leases;
        policy.act(scene.belief(), leases);
        std::set<std::string> found;
        for (const traffic::Lease& lease : leases) {
            EXPECT_TRUE(std::holds_alternative<traffic::StopAtLine>(lease.action));
            found.insert(ids.at(std::get<core::VehicleKey>(lease.target)));
        }
        return found;
    }
    static policy::GiveWayConfig config() {
        policy::GiveWayConfig config;
        config.near_m = 50.0;
        config.fastest_road_mps = 20.0;
        return config;
    }
};

TEST_F(Yielding, automated_vehicles_with_right_of_way_stop_when_an_emergency_vehicle_comes) {
    const roads::Network here = network();
    policy::GiveWay policy({here}, config());
    EXPECT_EQ(asked(policy, here), std::set<std::string>{"near"});
    policy::GiveWay early({here}, config());
    EXPECT_TRUE(asked(early, here, 1.0).empty()) << "6.1 s before the arrival";
}

TEST_F(Yielding, human_drivers_are_asked_where_that_is_set) {
    const roads::Network here = network();
    policy::GiveWayConfig with_humans = config();
    with_humans.ask_humans = 1;
    policy::GiveWay policy({here}, with_humans);
    EXPECT_EQ(asked(policy, here), (std::set<std::string>{"human", "near"}));
}

TEST_F(Yielding, nobody_stops_longer_than_the_longest_time_for_one_emergency_vehicle) {
    const roads::Network here = network();
    policy::GiveWay policy({here}, config());
    EXPECT_FALSE(asked(policy, here, 30.0, 100.0).empty());
    EXPECT_FALSE(asked(policy, here, 30.0, 130.0).empty());
    EXPECT_TRUE(asked(policy, here, 30.0, 130.5).empty());
}

TEST_F(Yielding, nobody_is_held_ahead_of_another_emergency_vehicle) {
    const roads::Network here = network();
    policy::GiveWay policy({here}, config());
    EXPECT_TRUE(asked(policy, here, 30.0, 100.0,
                      {{"e2", traffic::VehicleClass::emergency, {"west", "east"}, 0, 5.0, 8.0}})
                    .empty());
}

TEST_F(Yielding, nobody_is_held_longer_by_emergency_vehicles_in_a_row) {
    const roads::Network here = network();
    policy::GiveWay policy({here}, config());
    for (const double at_s : {100.0, 115.0, 130.0}) {
        const std::string id = "e" + std::to_string(at_s);  // each one another vehicle
        EXPECT_EQ(asked(policy, here, 1.0, at_s,
                        {{id, traffic::VehicleClass::emergency, {"south", "north"}, 0, 40.0, 8.0}}),
                  std::set<std::string>{"near"});
    }
    EXPECT_TRUE(asked(policy, here, 1.0, 130.5,
                      {{"last", traffic::VehicleClass::emergency, {"south", "north"}, 0, 40.0, 8.0}})
                    .empty());
}

/// A street of two pieces before the junction, the last one 20 m long.
std::string in_pieces(const std::string& first_piece) {
    std::string text = roads::crossing_without_signal();
    const auto put = [&](const std::string& before, const std::string& what) {
        text.insert(text.find(before), what);
    };
    put(R"(<edge id="west")", R"(<edge id="first" from="V" to="W"><lane id="first_0" index="0" )" +
                                  first_piece + R"( length="80.00" shape="0.00,-4.80 80.00,-4.80"/></edge>)");
    put(R"(<connection from="south" to="east")",
        R"(<connection from="first" to="west" fromLane="0" toLane="0" dir="s" state="M"/>)");
    const std::string length = R"(speed="20.00" length="100.00" shape="0.00,-4.80)";
    return text.replace(text.find(length), length.size(),
                        R"(speed="20.00" length="20.00" shape="80.00,-4.80)");
}

TEST_F(Yielding, who_is_on_the_last_piece_but_one_stops_at_its_end_if_it_may_stop_there) {
    const auto asked_on_the_first_piece = [](const std::string& text) {
        const support::TemporaryFolder folder;
        const roads::Network here = roads::Network::read(folder.write("pieces.net.xml", text));
        CrossingScene scene(100.0, here);
        scene.add({"e", traffic::VehicleClass::emergency, {"south", "north"}, 0, 30.0, 8.0});
        scene.add({"a", traffic::VehicleClass::automated, {"first", "west", "east"}, 0, 60.0, 8.0});
        policy::GiveWay policy({here}, config());
        std::vector<traffic::Lease> leases;
        policy.act(scene.belief(), leases);
        return leases.size();
    };
    EXPECT_EQ(asked_on_the_first_piece(in_pieces(R"(speed="20.00")")), 1U);
    EXPECT_EQ(asked_on_the_first_piece(in_pieces(R"(speed="27.78")")), 0U) << "too fast a road";
    std::string round = in_pieces(R"(speed="20.00")");
    round.insert(round.find("</net>"), R"(<roundabout nodes="V W" edges="first"/>)");
    EXPECT_EQ(asked_on_the_first_piece(round), 0U);
}

TEST_F(Yielding, nobody_is_asked_on_fast_roads_in_a_roundabout_or_where_the_other_one_yields) {
    const roads::Network here = network();
    policy::GiveWayConfig slower = config();
    slower.fastest_road_mps = 19.0;
    policy::GiveWay town({here}, slower);
    EXPECT_TRUE(asked(town, here).empty()) << "west is limited to 20 m/s";
    const roads::Network round = network("</net>", R"(<roundabout nodes="W J" edges="west"/></net>)");
    policy::GiveWay in_roundabout({round}, config());
    EXPECT_TRUE(asked(in_roundabout, round).empty());
    const roads::Network prior = network(R"(response="0011")", R"(response="0000")");
    policy::GiveWay with_priority({prior}, config());
    EXPECT_TRUE(asked(with_priority, prior).empty());
}

}  // namespace
}  // namespace clearway::testing
