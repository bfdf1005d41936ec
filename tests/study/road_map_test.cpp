#include "study/detail/road_map.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "roads/crossing_network.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::study::detail {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

class RoadMap : public testing::Test {
  protected:
    json map(const scenario::ScenarioConfig& config = {}) const {
        return json::parse(road_map_json(network_, config));
    }
    static std::vector<std::string> ids(const json& rows) {
        std::vector<std::string> ids;
        for (const json& row : rows)
            ids.push_back(row.at("id"));
        return ids;
    }

    const support::TemporaryFolder folder_;
    const roads::Network network_ =
        roads::Network::read(folder_.write("crossing.net.xml", roads::crossing_network()));
};

TEST_F(RoadMap, ListsRoadsForVehiclesAndNoFootpath) {
    EXPECT_THAT(ids(map().at("edges")), ElementsAre("west", "east", "south", "north", "back"));
}

TEST_F(RoadMap, SaysWhereEachEdgeLeadsAndWhetherThroughASignal) {
    const json edges = map().at("edges");
    EXPECT_EQ(edges[0].at("to"), json({1}));     // west -> east
    EXPECT_EQ(edges[2].at("to"), json({1, 3}));  // south -> east, north
    EXPECT_EQ(edges[3].at("to"), json::array());
    EXPECT_EQ(edges[0].at("signal"), true);
    EXPECT_EQ(edges[1].at("signal"), false);
    EXPECT_EQ(edges[3].at("length_m"), 60.0);
    EXPECT_EQ(edges[3].at("limit_mps"), 5.0);
    EXPECT_EQ(edges[3].at("shape_m"), json({105.0, 0.0, 105.0, 20.0, 145.0, 20.0}));
}

TEST_F(RoadMap, PlacesSignalsAmongTheirStopLines) {
    const json signals = map().at("signals");
    ASSERT_EQ(ids(signals), std::vector<std::string>{"J"});
    // Stop lines: west_0 (100, -4.8), west_1 (100, -1.6), south_0 (105, -10) twice.
    EXPECT_EQ(signals[0].at("x_m"), 102.5);
    EXPECT_EQ(signals[0].at("y_m"), -6.6);
}

TEST_F(RoadMap, NamesStationsButNoHospitals) {
    scenario::ScenarioConfig config;
    config.emergency_sites = {{scenario::SiteKind::hospital, "east", {}, {}, "Hospital", {}},
                              {scenario::SiteKind::fire_station, "south", {}, {}, "Station \"3\"", {}}};
    EXPECT_EQ(map(config).at("stations"),
              json::parse(R"([{"edge": "south", "kind": "fire_station", "name": "Station \"3\""}])"));
}

TEST_F(RoadMap, HospitalsAreTheStationsWhereThereAreNoOthers) {
    scenario::ScenarioConfig config;
    config.emergency_sites = {{scenario::SiteKind::hospital, "east", {}, {}, "Hospital", {}}};
    EXPECT_EQ(map(config).at("stations"),
              json::parse(R"([{"edge": "east", "kind": "hospital", "name": "Hospital"}])"));
}

TEST_F(RoadMap, NamesRoadsThatAreBlocked) {
    scenario::ScenarioConfig config;
    config.time.horizon_s = 900.0;
    scenario::Incident& incident = config.incidents.emplace_back();
    incident.edge = "east";
    incident.from_s = 60.0;
    EXPECT_EQ(
        map(config).at("incidents"),
        json::parse(R"([{"edge": "east", "from_s": 60.0, "to_s": 900.0, "closed_to_emergency": true}])"));
    incident.emergency_passes = 1;
    EXPECT_FALSE(map(config).at("incidents").at(0).at("closed_to_emergency").get<bool>());
    EXPECT_TRUE(map().at("incidents").empty());
}

}  // namespace
}  // namespace clearway::study::detail
