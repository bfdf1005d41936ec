// pull_over: vehicles make room on the shoulder of a road of one lane each way.
#include "policy/pull_over.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "policy/straight_road.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::testing {
namespace {

/// One lane and a shoulder each way, 1 km; eastward is the first edge.
roads::Network rural_road(const support::TemporaryFolder& folder) {
    const auto edge = [](const char* id, const char* from, const char* to, int y, int right_y) {
        const bool east = id[0] == 'e';
        const std::string x0 = east ? "0" : "1000";
        const std::string x1 = east ? "1000" : "0";
        const auto lane = [&](int number, int at, const char* more) {
            return "<lane id=\"" + std::string(id) + "_" + std::to_string(number) + "\" index=\"" +
                   std::to_string(number) + "\" speed=\"27.78\" length=\"1000\" width=\"3\" shape=\"" + x0 +
                   "," + std::to_string(at) + " " + x1 + "," + std::to_string(at) + "\"" + more + "/>";
        };
        return "<edge id=\"" + std::string(id) + "\" from=\"" + from + "\" to=\"" + to +
               "\" priority=\"1\">" + lane(0, right_y, " disallow=\"all\"") + lane(1, y, "") + "</edge>";
    };
    const std::filesystem::path file = folder.path() / "rural.net.xml";
    std::ofstream(file)
        << "<net version=\"1.9\"><location netOffset=\"0,0\" convBoundary=\"0,0,1000,10\" "
           "origBoundary=\"0,0,1000,10\" projParameter=\"!\"/>"
        << edge("east", "w", "e", -2, -5) << edge("west", "e", "w", 2, 5)
        << "<junction id=\"w\" type=\"dead_end\" x=\"0\" y=\"0\" incLanes=\"\" intLanes=\"\" "
           "shape=\"0,0\"/><junction id=\"e\" type=\"dead_end\" x=\"1000\" y=\"0\" incLanes=\"\" "
           "intLanes=\"\" shape=\"0,0\"/></net>";
    return roads::Network::read(file);
}

class RuralRoad {
  public:
    RuralRoad() : network_(rural_road(folder_)) { belief_.roster = &roster_; }

    core::VehicleKey add(const char* id, traffic::VehicleClass vehicle_class, const char* edge,
                         float position_m, float speed_mps) {
        const core::EdgeIndex on = network_.find_edge(edge).value();
        traffic::VehicleInfo info;
        info.key = core::vehicle_key(id);
        info.id = id;
        info.vehicle_class = vehicle_class;
        info.route = roster_.add_route({on});
        roster_.add(info);
        traffic::BelievedVehicle vehicle;
        vehicle.key = info.key;
        vehicle.vehicle_class = vehicle_class;
        vehicle.state.lane = network_.lane_of(on, 1);
        vehicle.state.lane_position_m = position_m;
        vehicle.state.speed_mps = speed_mps;
        const roads::Point place = network_.point_at(vehicle.state.lane, core::Metres(position_m));
        vehicle.state.x_m = place.x_m;
        vehicle.state.y_m = place.y_m;
        vehicle.state.heading_rad =
            static_cast<float>(network_.heading_at(vehicle.state.lane, core::Metres(position_m)));
        belief_.vehicles.push_back(vehicle);
        std::ranges::sort(belief_.vehicles, {}, &traffic::BelievedVehicle::key);
        belief_.first_link.assign(belief_.vehicles.size() + 1, 0);
        return info.key;
    }
    std::set<core::VehicleKey> pulled_over(policy::PullOverConfig config = {}) {
        policy::PullOver policy({network_}, config);
        std::vector<traffic::Lease> leases;
        policy.act(belief_, leases);
        std::set<core::VehicleKey> keys;
        for (const traffic::Lease& lease : leases) {
            EXPECT_TRUE(std::holds_alternative<traffic::PullAside>(lease.action));
            keys.insert(std::get<core::VehicleKey>(lease.target));
        }
        return keys;
    }

  private:
    support::TemporaryFolder folder_;
    roads::Network network_;
    traffic::Roster roster_;
    traffic::BelievedGraph belief_;
};

TEST(PullOver, asks_slower_vehicles_ahead_and_leaves_the_others) {
    RuralRoad road;
    road.add("e", traffic::VehicleClass::emergency, "east", 100.0F, 27.0F);
    const auto slow = road.add("slow", traffic::VehicleClass::automated, "east", 250.0F, 19.0F);
    road.add("fast", traffic::VehicleClass::automated, "east", 300.0F, 27.7F);
    road.add("behind", traffic::VehicleClass::automated, "east", 50.0F, 19.0F);
    road.add("far", traffic::VehicleClass::automated, "east", 600.0F, 19.0F);
    road.add("oncoming", traffic::VehicleClass::automated, "west", 700.0F, 19.0F);
    EXPECT_EQ(road.pulled_over(), std::set{slow}) << "everybody in the way is asked: no need to overtake";
}

TEST(PullOver, frees_the_oncoming_lane_where_somebody_will_not_make_room) {
    RuralRoad road;
    road.add("e", traffic::VehicleClass::emergency, "east", 100.0F, 27.0F);
    road.add("human", traffic::VehicleClass::human, "east", 250.0F, 19.0F);
    const auto oncoming = road.add("oncoming", traffic::VehicleClass::automated, "west", 500.0F, 25.0F);
    road.add("passed", traffic::VehicleClass::automated, "west", 950.0F, 25.0F);
    EXPECT_EQ(road.pulled_over(), std::set{oncoming});
    policy::PullOverConfig config;
    config.oncoming_m = 0.0;
    EXPECT_TRUE(road.pulled_over(config).empty());
    config.ask_humans = 1;
    EXPECT_EQ(road.pulled_over(config).size(), 1U) << "now the human driver is asked instead";
}

TEST(PullOver, asks_nobody_where_there_is_no_shoulder) {
    StraightRoad road(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        ......e.....a...................................................
    )");
    road.stop({"a1"});
    policy::PullOver policy({road.scene.network()});
    EXPECT_TRUE(road.act(policy).empty());
}

}  // namespace
}  // namespace clearway::testing
