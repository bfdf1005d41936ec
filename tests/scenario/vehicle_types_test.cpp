#include "scenario/vehicle_types.hpp"

#include <gmock/gmock.h>

#include "scratch.hpp"

namespace clearway::scenario {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class VehicleTypes : public ScratchTest {
  protected:
    /// The element of one type.
    static std::string element(const std::string& xml, const std::string& id) {
        const std::size_t start = xml.find("<vType id=\"" + id + "\"");
        if (start == std::string::npos) return "";
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
    options.idm = IdmPreset::treiber;
    const std::string treiber = element(vehicle_types_xml(load("merge", options)), "human_car");
    EXPECT_THAT(treiber, HasSubstr("accel=\"1.4\" decel=\"2\""));
    EXPECT_THAT(treiber, HasSubstr("tau=\"1.5\""));
    options.idm = IdmPreset::sumo;
    const std::string sumo = element(vehicle_types_xml(load("merge", options)), "human_car");
    EXPECT_THAT(sumo, HasSubstr("accel=\"2.6\" decel=\"4.5\""));
    EXPECT_THAT(sumo, HasSubstr("tau=\"1\""));
}

TEST_F(VehicleTypes, a_truck_gains_no_acceleration_from_a_preset) {
    Options options;
    options.idm = IdmPreset::treiber;
    EXPECT_THAT(element(vehicle_types_xml(load("merge", options)), "human_truck"),
                HasSubstr("accel=\"1.3\""));
}

TEST_F(VehicleTypes, unrestricted_types_exist_for_measured_demand_only) {
    EXPECT_THAT(vehicle_types_xml(load("merge")), Not(HasSubstr("unrestricted")));
    EXPECT_THAT(element(vehicle_types_xml(load("bologna")), "automated_car_unrestricted"),
                HasSubstr("vClass=\"ignoring\""));
}

}  // namespace
}  // namespace clearway::scenario
