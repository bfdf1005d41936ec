#include "scenario/vehicle_types.hpp"

#include <gmock/gmock.h>

#include "scratch.hpp"

namespace clearway::scenario {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class VehicleTypes : public ScratchTest {
  protected:
    /// The element of one type.
    static std::string element(const std::string& xml, const std::string& id) {
        const std::size_t name = xml.find(" id=\"" + id + "\"");
        if (name == std::string::npos) return "";
        const std::size_t start = xml.rfind("<vType", name);
        return xml.substr(start, xml.find("</vType>", start) - start);
    }
};

TEST_F(VehicleTypes, carry_class_kind_and_the_class_limit) {
    const std::string xml = vehicle_types_xml(load("merge"));
    const std::string human = element(xml, "human_car");
    EXPECT_THAT(human, HasSubstr("maxSpeed=\"33.33\""));
    EXPECT_THAT(human, HasSubstr("key=\"clearway.class\" value=\"human\""));
    EXPECT_THAT(human, HasSubstr("key=\"clearway.kind\" value=\"car\""));
    const std::string ambulance = element(xml, "emergency_ambulance");
    EXPECT_THAT(ambulance, HasSubstr("maxSpeed=\"38.89\""));
    EXPECT_THAT(ambulance, HasSubstr("vClass=\"emergency\""));
    EXPECT_THAT(ambulance, HasSubstr("speedFactor=\"1\" speedDev=\"0\""));
}

TEST_F(VehicleTypes, a_slow_kind_keeps_its_own_top_speed) {
    const std::string xml = vehicle_types_xml(load("merge"));
    EXPECT_THAT(element(xml, "emergency_fire_engine"), HasSubstr("maxSpeed=\"27.78\""));
    EXPECT_THAT(element(xml, "human_bus"), HasSubstr("maxSpeed=\"23.61\""));
}

TEST_F(VehicleTypes, presets_differ_in_headway_and_acceleration) {
    Options options;
    options.set("idm", "treiber");
    const std::string treiber = element(vehicle_types_xml(load("merge", options)), "human_car");
    EXPECT_THAT(treiber, HasSubstr("accel=\"1.4\" decel=\"2\""));
    EXPECT_THAT(treiber, HasSubstr("tau=\"1.5\""));
    options.set("idm", "sumo");
    const std::string sumo = element(vehicle_types_xml(load("merge", options)), "human_car");
    EXPECT_THAT(sumo, HasSubstr("accel=\"2.6\" decel=\"4.5\""));
    EXPECT_THAT(sumo, HasSubstr("tau=\"1\""));
}

TEST_F(VehicleTypes, feel_friction_and_headway_of_the_road_emergency_vehicles_too) {
    ScenarioConfig config = load("merge");
    config.road.friction = 0.5;
    config.road.headway_factor = 1.2;
    const std::string xml = vehicle_types_xml(config);
    for (const char* const id : {"human_car", "automated_van", "emergency_ambulance"}) {
        EXPECT_THAT(element(xml, id), HasSubstr("accel=\"1.3\" decel=\"2.25\" emergencyDecel=\"4.5\"")) << id;
        EXPECT_THAT(element(xml, id), HasSubstr("tau=\"1.2\"")) << id;
    }
}

TEST_F(VehicleTypes, of_an_imported_demand_feel_the_road_as_far_as_their_grip_is_known) {
    write("types.add.xml",
          "<additional><vType id=\"slow\" accel=\"2\"><carFollowing-Krauss tau=\"2\"/></vType>"
          "<vType id=\"tram\" accel=\"1\"/></additional>");
    ScenarioConfig config = load("bologna");
    config.folder = folder();
    config.measured->own_types = OwnTypes{"types.add.xml", CarFollowing::own};
    config.measured->types = {{"slow", "car", Access::own}, {"tram", "other", Access::own}};
    config.road.friction = 0.5;
    config.road.headway_factor = 1.5;
    const std::string xml = vehicle_types_xml(config);
    EXPECT_THAT(element(xml, "human.slow"),
                AllOf(HasSubstr("accel=\"1\""), HasSubstr("decel=\"2.25\""),
                      HasSubstr("emergencyDecel=\"4.5\""), HasSubstr("carFollowing-Krauss tau=\"3\"")));
    EXPECT_THAT(element(xml, "human.tram"), AllOf(HasSubstr("accel=\"1\""), Not(HasSubstr("decel"))));
    EXPECT_THAT(element(xml, "automated.slow"), HasSubstr("tau=\"1.5\""));
}

TEST_F(VehicleTypes, a_truck_gains_no_acceleration_from_a_preset) {
    Options options;
    options.set("idm", "treiber");
    EXPECT_THAT(element(vehicle_types_xml(load("merge", options)), "human_truck"),
                HasSubstr("accel=\"1.3\""));
}

TEST_F(VehicleTypes, unrestricted_types_exist_for_measured_demand_only) {
    EXPECT_THAT(vehicle_types_xml(load("merge")), Not(HasSubstr("unrestricted")));
    EXPECT_THAT(element(vehicle_types_xml(load("bologna")), "automated_car_unrestricted"),
                HasSubstr("vClass=\"ignoring\""));
}

TEST_F(VehicleTypes, follow_by_krauss_with_sumos_defaults_and_automated_ones_do_not_dawdle) {
    Options options;
    options.set("car_following", "krauss");
    const std::string xml = vehicle_types_xml(load("merge", options));
    for (const char* const id : {"human_car", "human_bus", "emergency_ambulance"})
        EXPECT_THAT(element(xml, id), HasSubstr("carFollowModel=\"Krauss\" tau=\"1\" sigma=\"0.5\"")) << id;
    EXPECT_THAT(element(xml, "automated_car"), HasSubstr("carFollowModel=\"Krauss\" tau=\"1\" sigma=\"0\""));
    EXPECT_THAT(element(xml, "human_car"), HasSubstr("accel=\"2.6\" decel=\"4.5\""));
    EXPECT_THAT(xml, Not(HasSubstr("IDM")));
    EXPECT_THAT(vehicle_types_xml(load("merge")), Not(HasSubstr("Krauss")));
}

TEST_F(VehicleTypes, of_an_imported_demand_keep_their_model_unless_they_follow_the_scenario) {
    write("types.add.xml", "<additional><vType id=\"slow\" carFollowModel=\"Wiedemann\"/></additional>");
    ScenarioConfig config = load("bologna");
    config.folder = folder();
    config.following.model = FollowingModel::krauss;
    config.measured->own_types = OwnTypes{"types.add.xml", CarFollowing::own};
    config.measured->types = {{"slow", "car", Access::own}};
    EXPECT_THAT(element(vehicle_types_xml(config), "human.slow"), HasSubstr("Wiedemann"));
    EXPECT_THAT(element(vehicle_types_xml(config), "automated.slow"), HasSubstr("Krauss"));
    config.measured->own_types->car_following = CarFollowing::idm;
    EXPECT_THAT(element(vehicle_types_xml(config), "human.slow"), HasSubstr("\"Krauss\""));
}

}  // namespace
}  // namespace clearway::scenario
