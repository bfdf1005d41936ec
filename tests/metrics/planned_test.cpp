#include <gmock/gmock.h>

#include "core/error.hpp"
#include "metrics/recorder.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::metrics {
namespace {

using traffic::VehicleClass;
using traffic::VehicleKind;

constexpr auto types = R"(<additional>
    <vType id="av_van" vClass="delivery">
        <param key="clearway.class" value="automated"/>
        <param key="clearway.kind" value="van"/>
    </vType>
    <vType id="plain"/>
</additional>)";

TEST(ReadPlanned, TakesClassAndKindFromTheTypeAndEmergencyVehiclesLast) {
    const support::TemporaryFolder folder;
    const std::vector<std::filesystem::path> files = {folder.write("types.xml", types),
                                                      folder.write("routes.xml", R"(<routes>
    <vehicle id="one" type="av_van" depart="1.50"><route edges="a b"/><param key="clearway.class" value="human"/></vehicle>
    <vehicle id="two" type="plain" depart="2"><route edges="a b"/></vehicle>
</routes>)")};
    traffic::EmergencyDeparture departure;
    departure.id = "e1";
    departure.kind = VehicleKind::fire_engine;
    departure.depart = core::Seconds(60.0);
    const auto planned = read_planned(files, std::vector{departure});
    ASSERT_EQ(planned.size(), 3U);
    EXPECT_EQ(planned[0].vehicle_class, VehicleClass::automated);
    EXPECT_EQ(planned[0].kind, VehicleKind::van);
    EXPECT_DOUBLE_EQ(planned[0].depart_s, 1.5);
    EXPECT_EQ(planned[1].vehicle_class, VehicleClass::human);
    EXPECT_EQ(planned[1].kind, VehicleKind::other);
    EXPECT_EQ(planned[2].vehicle_class, VehicleClass::emergency);
    EXPECT_EQ(planned[2].kind, VehicleKind::fire_engine);
}

TEST(ReadPlanned, RefusesFlowsAndDeparturesThatAreNoTimesNamingTheLine) {
    const support::TemporaryFolder folder;
    for (const char* element : {"<flow id='f' begin='0' end='9'/>", "<vehicle id='v' depart='triggered'/>"}) {
        const std::vector files = {folder.write("r.xml", std::string("<routes>\n") + element + "</routes>")};
        try {
            read_planned(files, {});
            FAIL() << element;
        } catch (const core::InputError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("r.xml:2"));
        }
    }
    EXPECT_THROW(read_planned(std::vector{folder.path() / "none.xml"}, {}), core::InputError);
}

TEST(PlannedIn, ListsTheVehiclesOfATripinfoWithTheClassOfTheRosterAndTheTimeTheyWantedToDepart) {
    const support::TemporaryFolder folder;
    const auto file = folder.write("tripinfo.xml", R"(<tripinfos>
    <tripinfo id="one" depart="61.50" departDelay="1.50"/>
    <tripinfo id="two" depart="-1" departDelay="30"/>
    <personinfo id="walker" depart="0"/>
</tripinfos>)");
    traffic::Roster roster;
    traffic::VehicleInfo info;
    info.id = "one";
    info.key = core::vehicle_key(info.id);
    info.vehicle_class = VehicleClass::emergency;
    info.kind = VehicleKind::fire_engine;
    roster.add(info);
    const auto planned = planned_in(file, roster);
    ASSERT_EQ(planned.size(), 2U);
    EXPECT_EQ(planned[0].id, "one");
    EXPECT_EQ(planned[0].vehicle_class, VehicleClass::emergency);
    EXPECT_EQ(planned[0].kind, VehicleKind::fire_engine);
    EXPECT_DOUBLE_EQ(planned[0].depart_s, 60.0);
    EXPECT_EQ(planned[1].vehicle_class, VehicleClass::human) << "it never entered";
    EXPECT_EQ(planned[1].depart_s, 0.0);
    EXPECT_THROW(planned_in(folder.path() / "none.xml", roster), core::SimulatorError);
}

}  // namespace
}  // namespace clearway::metrics
