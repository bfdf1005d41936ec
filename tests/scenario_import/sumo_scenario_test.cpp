// Scenarios of SUMO in: configuration, routes, flows, types, additional files.
#include <csignal>

#include <gmock/gmock.h>
#include <zlib.h>

#include "roads/network.hpp"
#include "sumo_line.hpp"

namespace clearway::scenario_import {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;

TEST_F(SumoScenario, a_share_of_the_cars_is_automated_by_their_ids) {
    run(line_with("<vType id='slow' maxSpeed='10' sigma='0.7'/>" + cars(60) +
                  "<vehicle id='mine' type='slow' depart='30'><route edges='first second'/></vehicle>"));
    const scenario::Prepared first = prepared();
    EXPECT_EQ(first.human + first.automated, 61);
    EXPECT_GT(first.automated, 10);
    EXPECT_LT(first.automated, 35);
    EXPECT_EQ(first.emergency.size(), 6U);
    EXPECT_THAT(types(), AllOf(HasSubstr("id=\"human.slow\""), HasSubstr("id=\"automated.slow\""),
                               HasSubstr("sigma=\"0.7\""), HasSubstr("maxSpeed=\"10.00\"")));
    const std::string before = traffic();
    prepared();
    EXPECT_EQ(traffic(), before);
}

TEST_F(SumoScenario, flows_trips_distributions_and_references_become_vehicles) {
    const Findings findings =
        run(line_with("<vTypeDistribution id='mix'><vType id='a' vClass='passenger' probability='0.5'/>"
                      "<vType id='b' vClass='truck' probability='0.5'/></vTypeDistribution><route id='way' "
                      "edges='first second'/>"
                      "<flow id='regular' type='mix' route='way' begin='0' end='100' number='10'/>"
                      "<flow id='hourly' from='first' to='second' begin='0' end='100' vehsPerHour='360'/>"
                      "<flow id='chance' route='way' begin='0' end='100' probability='0.2'/>"
                      "<trip id='trip' depart='0:00:30' from='first' to='second'/>"));
    const int count = findings.vehicles.at("car") + findings.vehicles.at("truck");
    EXPECT_GE(count, 10 + 10 + 1 + 8);
    EXPECT_LE(count, 10 + 10 + 1 + 35);
    EXPECT_GT(findings.vehicles.at("truck"), 0);
    const std::string routes = core::read_file(out() / "town" / "traffic.rou.xml");
    EXPECT_THAT(routes, AllOf(HasSubstr("id=\"regular.9\""), HasSubstr("id=\"hourly.9\""),
                              HasSubstr("depart=\"30.00\"")));
    EXPECT_THAT(routes, Not(HasSubstr("<flow")));
}

TEST_F(SumoScenario, an_unsorted_file_is_sorted_and_that_is_said) {
    const Findings findings = run(line_with(car("late", 50) + car("early", 10) + cars(20)));
    EXPECT_THAT(findings.changes, Contains(HasSubstr("line.rou.xml is sorted by departure")));
    const std::string routes = core::read_file(out() / "town" / "traffic.rou.xml");
    EXPECT_LT(routes.find("id=\"early\""), routes.find("id=\"late\""));
}

TEST_F(SumoScenario, a_network_of_netconvert_1_22_is_imported) {
    std::string text = core::read_file(line_network());
    const std::string second = "<lane id=\":b_1_1\" index=\"1\"";
    ASSERT_NE(text.find(second), std::string::npos) << text;
    text.replace(text.find(second), second.size(), "<lane id=\":b_1_1\" index=\"0\"");
    const auto network = write("new.net.xml", text);
    const Findings findings =
        run(request({network, write("line.rou.xml", "<routes>" + cars(20) + "</routes>")}));
    EXPECT_EQ(findings.vehicles.at("car"), 20);
}

TEST_F(SumoScenario, gaps_and_unknown_edges_are_refused_with_vehicle_and_edges) {
    const std::string gap = refusal(line_with(cars(3) + car("jumper", 5, "first side")));
    EXPECT_THAT(gap, AllOf(HasSubstr("line.rou.xml:1: \"jumper\""), HasSubstr("gap"), HasSubstr("\"side\""),
                           HasSubstr("--leave-out-bad-vehicles")));
    EXPECT_THAT(refusal(line_with(car("lost", 5, "first nowhere"))), HasSubstr("no edge \"nowhere\""));
    ImportRequest lenient = line_with(cars(3) + car("jumper", 5, "first side"));
    lenient.bad_vehicles = BadVehicles::leave_out;
    const Findings findings = run(lenient);
    EXPECT_EQ(findings.vehicles.at("car"), 3);
    EXPECT_THAT(findings.left_out, Contains(HasSubstr("jumper")));
}

TEST_F(SumoScenario, an_id_that_occurs_twice_is_refused_with_both_places) {
    EXPECT_THAT(
        refusal(line_with(car("twin", 1) + "\n" + car("twin", 2))),
        AllOf(HasSubstr("line.rou.xml:2: \"twin\""), HasSubstr("occurs twice"), HasSubstr("line.rou.xml:1")));
}

TEST_F(SumoScenario, unknown_types_routes_and_departures_are_refused_together) {
    const std::string message =
        refusal(line_with("<vehicle id='a' type='nosuch' depart='1'><route edges='first'/></vehicle>"
                          "<vehicle id='b' route='nosuch' depart='1'/><vehicle id='c' depart='soon'><route "
                          "edges='first'/></vehicle>"));
    EXPECT_THAT(message, AllOf(HasSubstr("type \"nosuch\""), HasSubstr("route \"nosuch\""),
                               HasSubstr("depart is \"soon\"")));
}

TEST_F(SumoScenario, a_configuration_with_relative_lists_packed_files_and_what_cannot_be_used) {
    std::filesystem::create_directories(folder() / "sub dir");
    std::filesystem::copy_file(line_network(), folder() / "sub dir" / "net.xml");
    gzFile packed = gzopen((folder() / "sub dir" / "b.rou.xml.gz").c_str(), "wb");
    const std::string late = "<routes>" + car("late", 40) + "</routes>";
    gzwrite(packed, late.data(), static_cast<unsigned>(late.size()));
    gzclose(packed);
    write("sub dir/a.rou.xml", "<routes>" + cars(20) + "<person id='walker' depart='1'/></routes>");
    write("sub dir/more.add.xml",
          "<additional><busStop id='stop' lane='first_0' startPos='100' endPos='120'/>"
          "<inductionLoop id='loop' lane='first_0' pos='50' freq='60' file='x.xml'/><poly id='park' "
          "shape='0,0 1,1'/>"
          "</additional>");
    const auto configuration = write(
        "sub dir/run.sumocfg",
        "<configuration><input><net-file value='net.xml'/><route-files value='a.rou.xml, b.rou.xml.gz'/>"
        "<additional-files value='more.add.xml'/></input><time><begin value='0'/><end value='50'/></time>"
        "<processing><max-depart-delay value='2'/></processing></configuration>");
    unsetenv("SUMO_HOME");
    const Findings findings = run(request({configuration}));
    setenv("SUMO_HOME", "/usr/share/sumo", 0);
    EXPECT_EQ(findings.vehicles.at("car"), 21);
    EXPECT_THAT(findings.left_out,
                AllOf(Contains("1 persons who do not walk (walker)"), Contains(HasSubstr("<inductionLoop>")),
                      Contains(HasSubstr("<poly>")), Contains(HasSubstr("max-depart-delay = 2"))));
    EXPECT_THAT(core::read_file(out() / "town" / "additional.add.xml"),
                AllOf(HasSubstr("busStop"), Not(HasSubstr("inductionLoop"))));
}

TEST_F(SumoScenario, a_missing_file_is_named_with_the_nearest_there_is) {
    const auto network = line_network();
    write("line_cars.add.xml", "<routes/>");
    const auto configuration = write("run.sumocfg",
                                     "<configuration><net-file value='line.net.xml'/>"
                                     "<route-files value='line_cars.rou.xml'/></configuration>");
    EXPECT_THAT(refusal(request({configuration})), AllOf(HasSubstr("no file"), HasSubstr("line_cars.rou.xml"),
                                                         HasSubstr("There is line_cars.add.xml")));
}

TEST_F(SumoScenario, in_place_of_a_missing_network_no_route_file_is_proposed) {
    line_network();
    write("town.rou.xml", "<routes/>");
    const auto missing = [&](const std::string& name) {
        return refusal(
            request({write("run.sumocfg", "<configuration><net-file value='" + name +
                                              "'/><route-files value='town.rou.xml'/></configuration>")}));
    };
    EXPECT_THAT(missing("town.net.xml"), Not(HasSubstr("town.rou.xml")));
    EXPECT_THAT(missing("lime.net.xml"), HasSubstr("There is line.net.xml"));
}

TEST_F(SumoScenario, rails_of_several_tracks_on_which_trains_come_from_both_sides_are_parted) {
    const auto nodes = write("rail.nod.xml",
                             "<nodes><node id='a' x='0' y='0'/><node id='b' x='500' y='0'/>"
                             "<node id='c' x='1000' y='0'/><node id='n' x='500' y='500'/>"
                             "<node id='s' x='500' y='-500'/></nodes>");
    std::string edges = "<edges>";
    for (const char* const ends : {"ab", "ba", "bc", "cb"})
        edges += fmt::format(
            "<edge id='{0}' from='{1}' to='{2}' numLanes='2' spreadType='center' allow='rail' "
            "speed='20'/>",
            ends, ends[0], ends[1]);
    for (const char* const ends : {"nb", "bs", "sb", "bn"})
        edges += fmt::format("<edge id='{0}' from='{1}' to='{2}' numLanes='1' speed='14'/>", ends, ends[0],
                             ends[1]);
    const auto plain = write("rail.edg.xml", edges + "</edges>");
    const std::string network = (folder() / "rail.net.xml").string();
    run_tool("netconvert", {"--node-files", nodes.string(), "--edge-files", plain.string(), "-o", network});
    const std::string train =
        "<vType id='train' vClass='rail'/><vehicle id='t' type='train' depart='0'>"
        "<route edges='ab bc'/></vehicle>";
    const auto routes = write("rail.rou.xml", "<routes>" + train + car("a", 0.0, "nb bs") + "</routes>");
    // What SUMO does with the network as it is.
    core::Command sumo{
        "sumo", {"-n", network, "-r", routes.string(), "--xml-validation", "never"}, {}, "/dev/null"};
    ASSERT_EQ(core::run(sumo).signal, SIGABRT);

    const Findings findings = run(request({network, routes}));
    EXPECT_THAT(findings.changes, Contains(HasSubstr("4 multi-lane edges with traffic in both directions")));
    sumo.arguments[1] = (out() / "town" / "network.net.xml").string();
    EXPECT_TRUE(core::run(sumo).ok());
}

TEST_F(SumoScenario, newer_class_lists_are_repaired_and_emergency_vehicles_admitted) {
    std::string text = core::read_file(line_network());
    for (const auto& [lane, list] : {std::pair{"\"second_0\"", "allow=\"passenger subway\""},
                                     std::pair{"\"first_0\"", "disallow=\"drone tram\""}}) {
        const std::size_t at = text.find(std::string("<lane id=") + lane);
        ASSERT_NE(at, std::string::npos);
        text.insert(at + 5, std::string(" ") + list);
    }
    const auto network = write("newer.net.xml", text);
    const Findings findings =
        run(request({network, write("line.rou.xml", "<routes>" + cars(20) + "</routes>")}));
    EXPECT_THAT(findings.changes, AllOf(Contains(HasSubstr("2 lists of vehicle classes")),
                                        Contains(HasSubstr("1 lanes or connections"))));
    EXPECT_THAT(core::read_file(out() / "town" / "network.net.xml"),
                AllOf(HasSubstr("allow=\"passenger emergency\""), Not(HasSubstr("subway"))));
}

TEST_F(SumoScenario, a_begin_in_the_day_shifts_departures_and_stops) {
    ImportRequest made = line_with(
        "<vehicle id='bus' depart='25210'><route edges='first second'/><stop lane='first_0' endPos='200' "
        "until='25290'/></vehicle><vehicle id='car' depart='25220'><route edges='first second'/></vehicle>");
    made.begin_s = 25200.0;
    run(made);
    EXPECT_THAT(core::read_file(out() / "town" / "traffic.rou.xml"),
                AllOf(HasSubstr("depart=\"10.00\""), HasSubstr("until=\"90.00\"")));
}

/// Scenarios outside the tree.
std::filesystem::path shared_scenarios() {
    const char* const set = std::getenv("CLEARWAY_SHARED_SCENARIOS");
    return set != nullptr ? std::filesystem::path(set)
                          : std::filesystem::path(CLEARWAY_SOURCE_DIR) / "../shared/scenarios";
}

/// Its last five minutes, because both simulations of all twenty take minutes on a busy machine.
TEST_F(SumoScenario, a_shared_scenario_imports_where_it_is) {
    if (!std::filesystem::is_directory(shared_scenarios()))
        GTEST_SKIP() << shared_scenarios() << " is not there; CLEARWAY_SHARED_SCENARIOS names another folder";
    ImportRequest made = request({shared_scenarios() / "hamburg_tavf" / "run_simulation.sumocfg"}, "hamburg");
    made.begin_s = 900.0;
    const Findings hamburg = run(made);
    EXPECT_EQ(hamburg.signals, 43U);
    EXPECT_EQ(hamburg.vehicles.at("bus"), 18) << "14 at 900 s, two at 1,080 s, two at 1,125 s";
}

TEST_F(SumoScenario, a_shared_map_imports_where_it_is) {
    if (!std::filesystem::is_directory(shared_scenarios()))
        GTEST_SKIP() << shared_scenarios() << " is not there; CLEARWAY_SHARED_SCENARIOS names another folder";
    EXPECT_EQ(run(request({shared_scenarios() / "osm_monaco_osrm" / "monaco.osm.pbf"}, "monaco")).left_hand,
              false);
}

}  // namespace
}  // namespace clearway::scenario_import
