// Demand of SUMO's route and additional files: what plain SUMO would insert is what an import takes over.
#include "sumo_demand.hpp"

#include <gmock/gmock.h>

namespace clearway::scenario_import {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

TEST_F(SumoDemand, included_files_stand_where_they_are_included_from_their_own_folder) {
    write("parts/inner.rou.xml", "<routes>" + car("inner", 3) + "<include href='more/deep.xml'/></routes>");
    write("parts/more/deep.xml", "<routes>" + car("deep", 4) + "</routes>");
    run(line_with("<include href='parts/inner.rou.xml'/>" + cars(2)));
    EXPECT_THAT(traffic_file(), AllOf(HasSubstr("id=\"inner\""), HasSubstr("id=\"deep\"")));
    EXPECT_EQ(vehicles(), 4U);
}

TEST_F(SumoDemand, includes_in_a_circle_and_missing_ones_are_refused_with_their_place) {
    write("a.rou.xml", "<routes>\n<include href='line.rou.xml'/></routes>");
    EXPECT_THAT(refusal(line_with("<include href='a.rou.xml'/>" + cars(2))),
                AllOf(HasSubstr("a.rou.xml:2: include"), HasSubstr("line.rou.xml includes itself")));
    EXPECT_THAT(refusal(line_with("<include href='nosuch.xml'/>" + cars(2))),
                AllOf(HasSubstr("line.rou.xml:1: include"), HasSubstr("no file")));
}

TEST_F(SumoDemand, an_interval_gives_its_flows_begin_and_end) {
    run(line_with("<interval begin='100' end='200'><flow id='f' from='first' to='second' number='10'/>" +
                  car("one", 150) + "</interval>" + cars(1)));
    EXPECT_EQ(vehicles(), 12U);
    EXPECT_THAT(traffic_file(), AllOf(HasSubstr("id=\"f.9\" type=\"DEFAULT_VEHTYPE\" depart=\"190.00\"")));
}

TEST_F(SumoDemand, a_flow_without_bounds_takes_what_the_configuration_runs) {
    run(configured(
        flow("begin='0' end='1e12' vehsPerHour='3600'") +
            "<flow id='g' begin='0' end='100000000' probability='0.5'><route edges='first'/></flow>",
        "<end value='600'/>"));
    const std::size_t by_chance = vehicles() - 600;
    EXPECT_GT(by_chance, 200U);
    EXPECT_LT(by_chance, 400U);
    ImportRequest later = configured(flow("begin='0' end='1e12' period='0:00:10'"), "");
    later.begin_s = 1e7;
    later.folder = out() / "later";
    EXPECT_EQ(run(later).vehicles.at("car"), 120);
}

TEST_F(SumoDemand, the_end_of_a_window_is_outside) {
    run(configured(flow("begin='0' end='601' period='1'"), "<end value='600'/>"));
    EXPECT_EQ(vehicles(), 600U);
}

TEST_F(SumoDemand, a_route_distribution_in_a_vehicle_gives_the_last_route_or_one_by_id) {
    const auto alternatives = [](const std::string& id, const std::string& last) {
        return "<vehicle id='" + id + "' depart='5'><routeDistribution " + last +
               "><route edges='first' probability='0.5'/><route edges='first second' probability='0.5'/>"
               "</routeDistribution></vehicle>";
    };
    std::string routes = alternatives("chosen", "last='1'");
    for (int number = 0; number < 40; ++number)
        routes += alternatives(fmt::format("drawn{}", number), "");
    run(line_with(routes));
    EXPECT_EQ(vehicles(), 41U);
    const std::size_t at = traffic_file().find("id=\"chosen\"");
    EXPECT_EQ(traffic_file().find("<route edges=\"first second\"/>", at), traffic_file().find("<route", at));
    EXPECT_GT(count(traffic_file(), "<route edges=\"first\"/>"), 8U);
    EXPECT_GT(count(traffic_file(), "<route edges=\"first second\"/>"), 8U);
}

TEST_F(SumoDemand, times_of_stops_in_a_flow_and_in_a_named_route_go_with_the_departure) {
    const std::string stop = "<stop lane='first_0' endPos='100' until='60'/>";
    run(line_with(flow("begin='10' end='300' period='100'", stop) + "<route id='way' edges='first second'>" +
                  stop + "</route><vehicle id='bus' route='way' depart='500'/>"));
    EXPECT_THAT(traffic_file(), AllOf(HasSubstr("until=\"50.00\""), HasSubstr("until=\"150.00\""),
                                      HasSubstr("until=\"250.00\""), HasSubstr("until=\"550.00\"")));
}

TEST_F(SumoDemand, a_route_is_repeated_with_its_stops_a_cycle_later) {
    const auto nodes = write("ring.nod.xml", line_nodes());
    const auto edges = write(
        "ring.edg.xml", "<edges><edge id='there' from='a' to='b'/><edge id='back' from='b' to='a'/></edges>");
    run_tool("netconvert", {"--node-files", nodes.string(), "--edge-files", edges.string(), "--output-file",
                            (folder() / "ring.net.xml").string()});
    run(request({folder() / "ring.net.xml",
                 write("ring.rou.xml",
                       "<routes><vehicle id='round' depart='0'><route edges='there back' repeat='2' "
                       "cycleTime='200'><stop lane='there_0' until='60'/></route></vehicle></routes>")}));
    EXPECT_THAT(traffic_file(),
                AllOf(HasSubstr("edges=\"there back there back there back\""), HasSubstr("until=\"60.00\""),
                      HasSubstr("until=\"260.00\""), HasSubstr("until=\"460.00\"")));
}

TEST_F(SumoDemand, scales_of_the_configuration_and_of_types_multiply_vehicles_and_flows) {
    run(configured("<vType id='many' scale='3'/>" + car("one", 1) + car("two", 2) +
                       "<vehicle id='three' type='many' depart='3'><route edges='first'/></vehicle>" +
                       flow("type='many' begin='10' end='110' number='10'"),
                   "<scale value='2'/>"));
    EXPECT_EQ(vehicles(), 2U * 2U + 6U + 60U);
    EXPECT_THAT(traffic_file(),
                AllOf(HasSubstr("id=\"one.1\""), HasSubstr("id=\"three.5\""), HasSubstr("id=\"f.59\"")));
    EXPECT_THAT(types_file(), Not(HasSubstr("scale")));
    ImportRequest fewer = configured(cars(200), "<scale value='0.5'/>");
    fewer.folder = out() / "fewer";
    const int kept = run(fewer).vehicles.at("car");
    EXPECT_GT(kept, 70);
    EXPECT_LT(kept, 130);
}

TEST_F(SumoDemand, times_of_additional_files_count_from_the_begin_of_the_scenario) {
    run(configured(flow("begin='25200' end='25800' number='30'"),
                   "<begin value='7:00:00'/><end value='7:10:00'/>",
                   "<rerouter id='r' edges='first' vTypes='DEFAULT_VEHTYPE'><interval begin='0' "
                   "end='100'><closingReroute id='side'/></interval>"
                   "<interval begin='25000' end='25500'><closingReroute id='side'/></interval></rerouter>"
                   "<variableSpeedSign id='s' lanes='first_0'><step time='0' speed='1'/><step time='25000' "
                   "speed='5'/><step time='25300' speed='9'/></variableSpeedSign>"));
    const std::string text = additional_file();
    EXPECT_THAT(text, AllOf(HasSubstr("begin=\"0.00\" end=\"300.00\""),
                            HasSubstr("vTypes=\"human.DEFAULT_VEHTYPE automated.DEFAULT_VEHTYPE\""),
                            HasSubstr("time=\"100.00\""), HasSubstr("time=\"0.00\" speed=\"5\""),
                            Not(HasSubstr("25"))));
    EXPECT_EQ(count(text, "<interval"), 1U);
    EXPECT_EQ(count(text, "<step"), 2U);
}

TEST_F(SumoDemand, signal_programs_stand_at_the_begin_where_they_stood) {
    run_tool("netgenerate", {"--grid", "--grid.number", "3", "--default-junction-type", "traffic_light",
                             "--output-file", (folder() / "grid.net.xml").string()});
    const auto lights = [&](const std::string& configuration, int begin) {
        const auto states = folder() / fmt::format("states{}.xml", begin);
        const auto add = write(fmt::format("save{}.add.xml", begin),
                               "<additional><timedEvent type='SaveTLSStates' source='B1' dest='" +
                                   states.string() + "'/></additional>");
        run_tool("sumo", {"--net-file", configuration, "--additional-files", add.string(), "--begin",
                          std::to_string(begin), "--end", std::to_string(begin + 40), "--no-step-log"});
        std::string letters;
        const std::string text = core::read_file(states);
        for (std::size_t at = text.find(" state=\""); at != std::string::npos;
             at = text.find(" state=\"", at + 1))
            letters += text.substr(at + 8, text.find('"', at + 8) - at - 8) + "\n";
        return letters;
    };
    write("grid.rou.xml",
          "<routes><flow id='f' begin='25217' end='25800' number='9' from='A0A1' to='A1B1'/></routes>");
    run(request({write("run.sumocfg",
                       "<configuration><net-file value='grid.net.xml'/><route-files value='grid.rou.xml'/>"
                       "<begin value='25217'/></configuration>")}));
    const std::string before = lights((folder() / "grid.net.xml").string(), 25217);
    EXPECT_GT(before.size(), 100U);
    EXPECT_EQ(lights((out() / "town" / "network.net.xml").string(), 0), before);
}

TEST_F(SumoDemand, devices_that_write_files_are_taken_out_and_named) {
    const Findings findings = run(line_with(
        "<vType id='watched'><param key='has.ssm.device' value='true'/><param key='device.ssm.file' "
        "value='ssm.xml'/><param key='has.rerouting.device' value='true'/><param key='has.toc.device' "
        "value='true'/></vType><vehicle id='v' type='watched' depart='1'><param key='has.fcd.device' "
        "value='true'/><route edges='first second'/></vehicle>"));
    EXPECT_THAT(findings.left_out, AllOf(Contains(HasSubstr("output devices of types and vehicles (ssm of")),
                                         Contains(HasSubstr("ToC devices"))));
    EXPECT_THAT(types_file(), AllOf(Not(HasSubstr("ssm")), Not(HasSubstr("toc")), HasSubstr("rerouting")));
    EXPECT_THAT(traffic_file(), Not(HasSubstr("fcd")));
}

TEST_F(SumoDemand, vehicles_with_the_ids_of_emergency_vehicles_are_renamed) {
    const Findings findings = run(line_with(
        "<vType id='ambulance' vClass='emergency'/><vehicle id='emergency.0' type='ambulance' depart='1'>"
        "<route edges='first second'/></vehicle>" +
        cars(9)));
    EXPECT_THAT(traffic_file(), HasSubstr("id=\"imported.emergency.0\""));
    EXPECT_THAT(findings.changes,
                AllOf(Contains(HasSubstr("1 vehicle with ids of Clearway's own")),
                      Contains(HasSubstr("1 emergency vehicles of the scenario drive as ordinary traffic"))));
    EXPECT_EQ(prepared().human + prepared().automated, 10);
}

/// An ambulance, a fire engine that is known by its shape alone, and cars.
std::string with_own_emergency(const std::string& cars) {
    return "<vType id='ambulance' vClass='emergency'/><vType id='red' guiShape='firebrigade'/>"
           "<vehicle id='rescue' type='ambulance' depart='12.5'><route edges='first second'/></vehicle>"
           "<trip id='fire' type='red' depart='40' from='first' to='second'/>" +
           cars;
}

TEST_F(SumoDemand, own_emergency_vehicles_that_stay_traffic_are_named_first) {
    const Findings findings = run(line_with(with_own_emergency(cars(20))));
    EXPECT_THAT(findings.changes.front(),
                AllOf(HasSubstr("2 emergency vehicles of the scenario drive as ordinary"),
                      HasSubstr("--own-emergency measure")));
    EXPECT_EQ(prepared().emergency.size(), 6U);
}

TEST_F(SumoDemand, own_emergency_vehicles_are_measured_as_their_author_wrote_them) {
    ImportRequest request = line_with(with_own_emergency(cars(20)));
    request.own_emergency = OwnEmergency::measure;
    const Findings findings = run(request);
    EXPECT_THAT(findings.changes.front(),
                HasSubstr("2 emergency vehicles of the scenario are the ones that"));
    EXPECT_EQ(findings.vehicles.at("car"), 20);
    EXPECT_THAT(traffic_file(), AllOf(Not(HasSubstr("rescue")), Not(HasSubstr("fire"))));
    const scenario::Prepared demand = prepared();
    ASSERT_EQ(demand.emergency.size(), 2U);
    EXPECT_EQ(demand.emergency[0].depart.value, 12.5);
    EXPECT_EQ(demand.emergency[0].type, "emergency_ambulance");
    EXPECT_EQ(demand.emergency[0].edges, (std::vector<std::string>{"first", "second"}));
    EXPECT_EQ(demand.emergency[1].depart.value, 40.0);
    EXPECT_EQ(demand.emergency[1].type, "emergency_fire_engine");
}

TEST_F(SumoDemand, a_scenario_without_own_emergency_vehicles_cannot_measure_them) {
    ImportRequest request = line_with(cars(20));
    request.own_emergency = OwnEmergency::measure;
    EXPECT_THAT(refusal(request),
                AllOf(HasSubstr("has no emergency vehicle of its own"), HasSubstr("--own-emergency")));
    request = line_with(cars(20) +
                        "<vType id='ambulance' vClass='emergency'/><vehicle id='rescue' "
                        "type='ambulance' depart='5000'><route edges='first second'/></vehicle>");
    request.own_emergency = OwnEmergency::measure;
    EXPECT_THAT(refusal(request), AllOf(HasSubstr("the first departs at 5000 s"), HasSubstr("--begin 4700")));
    request = line_with(
        "<vType id='ambulance' vClass='emergency'/><vehicle id='rescue' type='ambulance' "
        "depart='12.5'><route edges='first second'/></vehicle>");
    request.own_emergency = OwnEmergency::measure;
    EXPECT_THAT(refusal(request), HasSubstr("no vehicle besides its emergency vehicles"));
}

TEST_F(SumoDemand, types_of_newer_classes_get_an_older_one) {
    const Findings findings = run(line_with(
        "<vType id='u' vClass='subway'/><vType id='unused' vClass='drone'/><vehicle id='v' type='u' "
        "depart='1'><route edges='first second'/></vehicle>" +
        cars(9)));
    EXPECT_THAT(types_file(), HasSubstr("vClass=\"rail_urban\""));
    EXPECT_THAT(findings.changes, Contains(HasSubstr("type \"u\" of class subway")));
    EXPECT_THAT(findings.changes, Not(Contains(HasSubstr("drone"))));
}

TEST_F(SumoDemand, vehicles_of_a_newer_class_on_lanes_of_that_class_are_left_out) {
    std::string text = core::read_file(line_network());
    text.insert(text.find("<lane id=\"side_0\"") + 5, " allow=\"subway\"");
    const Findings findings =
        run(request({write("rails.net.xml", text),
                     write("line.rou.xml",
                           "<routes><vType id='u' vClass='subway'/><vehicle id='v' type='u' "
                           "depart='1'><route edges='side'/></vehicle>" +
                               cars(9) + "</routes>")}));
    EXPECT_THAT(findings.left_out, Contains(HasSubstr("v: edge \"side\" is closed to its class")));
    EXPECT_EQ(vehicles(), 9U);
}

TEST_F(SumoDemand, fast_departures_stay_as_fast_as_their_drivers_may_be) {
    const auto nodes = write("fast.nod.xml", line_nodes());
    const auto edges = write("fast.edg.xml",
                             "<edges><edge id='first' from='a' to='b' numLanes='2' speed='50'/>"
                             "<edge id='second' from='b' to='c' numLanes='2' speed='50'/></edges>");
    run_tool("netconvert", {"--node-files", nodes.string(), "--edge-files", edges.string(), "--output-file",
                            (folder() / "fast.net.xml").string()});
    run(request(
        {folder() / "fast.net.xml",
         write("fast.rou.xml", "<routes><vType id='fast' maxSpeed='60' speedFactor='1.3' speedDev='0'/>" +
                                   flow("type='fast' begin='0' end='600' number='60' departSpeed='58'") +
                                   "</routes>")}));
    EXPECT_GT(prepared().automated, 5);
    EXPECT_THAT(types(), HasSubstr("maxSpeed=\"60.00\""));
    EXPECT_THAT(traffic(), AllOf(HasSubstr("departSpeed=\"58\""), HasSubstr("departSpeed=\"max\"")));
}

TEST_F(SumoDemand, trips_that_sumo_cannot_route_at_departure_are_named) {
    const Findings findings = run(
        line_with(cars(2) +
                  "<trip id='t' depart='3' from='first' to='second'/><trip id='u' depart='4' from='first' "
                  "via='second' to='second'/><trip id='v' depart='5' fromJunction='a' to='second'/>"));
    EXPECT_EQ(findings.routed_trips, 3U);
    EXPECT_EQ(findings.routed_at_departure, 1U);
    EXPECT_THAT(findings.changes,
                AllOf(Contains(HasSubstr("2 vehicles without a route take the fastest one at free flow")),
                      Contains(HasSubstr("1 vehicles without a route are routed by SUMO at departure"))));
    EXPECT_THAT(findings.demand, HasSubstr("routes of trips partly from duarouter"));
    EXPECT_THAT(
        run(request({line_network(), write("plain.rou.xml", "<routes>" + cars(2) + "</routes>")}, "plain"))
            .demand,
        testing::StartsWith("as the route files say, 60 s"));
}

TEST_F(SumoDemand, a_scenario_without_cars_has_emergency_vehicles_on_the_routes_of_others) {
    run(line_with("<vType id='t' vClass='truck'/>" + flow("type='t' begin='0' end='100' number='20'")));
    EXPECT_EQ(prepared().emergency.size(), 6U);
}

TEST_F(SumoDemand, a_scenario_without_any_route_for_emergency_vehicles_is_refused_with_the_reason) {
    std::string text = core::read_file(line_network());
    for (const std::string lane : {"second_0", "second_1"})
        text.insert(text.find("<lane id=\"" + lane + "\"") + 5, " allow=\"tram\"");
    EXPECT_THAT(refusal(request({write("rails.net.xml", text),
                                 write("line.rou.xml",
                                       "<routes><vType id='t' vClass='tram'/><vehicle id='v' type='t' "
                                       "depart='1'><route edges='second'/></vehicle></routes>")})),
                HasSubstr("no vehicle whose route emergency vehicles may drive"));
}

TEST_F(SumoDemand, the_way_of_a_trip_passes_its_stops) {
    const auto nodes = write("fork.nod.xml", line_nodes());
    const auto edges = write("fork.edg.xml",
                             "<edges><edge id='in' from='a' to='b'/><edge id='short' from='b' to='c'/>"
                             "<edge id='up' from='b' to='d'/><edge id='down' from='d' to='c'/></edges>");
    run_tool("netconvert", {"--node-files", nodes.string(), "--edge-files", edges.string(), "--output-file",
                            (folder() / "fork.net.xml").string(), "--no-turnarounds"});
    run(request({folder() / "fork.net.xml",
                 write("fork.rou.xml",
                       "<routes><trip id='bus' depart='0' from='in' to='down'><stop busStop='up' "
                       "duration='9'/></trip></routes>"),
                 write("fork.add.xml",
                       "<additional><busStop id='up' lane='up_0' startPos='5' endPos='50'/></additional>")}));
    EXPECT_THAT(traffic_file(), HasSubstr("edges=\"in up down\""));
}

TEST_F(SumoDemand, edges_closed_to_a_class_and_unknown_stops_are_faults_of_a_vehicle) {
    std::string text = core::read_file(line_network());
    for (const std::string lane : {"second_0", "second_1"})
        text.insert(text.find("<lane id=\"" + lane + "\"") + 5, " disallow=\"truck\"");
    const auto network = write("closed.net.xml", text);
    const auto with = [&](const std::string& routes) {
        return request({network, write("line.rou.xml", "<routes>" + cars(9) + routes + "</routes>")});
    };
    const std::string trucks =
        "<vType id='t' vClass='truck'/>" + flow("type='t' begin='0' end='100' number='20'");
    const std::string refused = refusal(with(trucks));
    EXPECT_THAT(refused, HasSubstr("\"f.0\": edge \"second\" is closed to its class, truck"));
    EXPECT_THAT(refused, Not(HasSubstr("f.1")));
    EXPECT_THAT(
        refusal(with("<vehicle id='v' depart='1'><route edges='first'/><stop busStop='x'/></vehicle>")),
        HasSubstr("\"v\": stops at busStop \"x\", which is not defined"));
    ImportRequest lenient = with(trucks);
    lenient.bad_vehicles = BadVehicles::leave_out;
    EXPECT_EQ(run(lenient).vehicles.count("truck"), 0U);
}

TEST_F(SumoDemand, members_of_a_distribution_count_as_their_types_say) {
    const Findings findings =
        run(line_with("<vType id='often' probability='9'/><vType id='seldom' vClass='truck' probability='1'/>"
                      "<vTypeDistribution id='listed' vTypes='often seldom'/>" +
                      flow("type='listed' begin='0' end='600' number='300'")));
    EXPECT_GT(findings.vehicles.at("truck"), 10);
    EXPECT_LT(findings.vehicles.at("truck"), 60);
}

TEST_F(SumoDemand, a_stop_that_waits_lasts_its_duration_or_is_left_out) {
    const Findings findings =
        run(line_with("<vehicle id='v' depart='1'><route edges='first second'/><stop lane='first_0' "
                      "triggered='true'/><stop lane='second_0' duration='7' triggered='true'/></vehicle>" +
                      cars(9)));
    EXPECT_THAT(findings.left_out, AllOf(Contains(HasSubstr("and have no duration (v)")),
                                         Contains(HasSubstr("which now last their duration (v)"))));
    EXPECT_THAT(traffic_file(), AllOf(Not(HasSubstr("triggered")), HasSubstr("duration=\"7\"")));
    EXPECT_EQ(count(traffic_file(), "<stop"), 1U);
}

TEST_F(SumoDemand, detectors_that_a_signal_program_names_are_kept_without_their_file) {
    run_tool("netgenerate",
             {"--grid", "--grid.number", "3", "--default-junction-type", "traffic_light",
              "--tls.default-type", "actuated", "--output-file", (folder() / "grid.net.xml").string()});
    const std::string network = core::read_file(folder() / "grid.net.xml");
    const std::size_t begin = network.find("<tlLogic id=\"B1\"");
    std::string program = network.substr(begin, network.find("</tlLogic>", begin) + 10 - begin);
    program.insert(program.find('>') + 1,
                   "<param key='A1B1_0' value='mine'/><param key='file' value='x.xml'/>");
    program.replace(program.find("programID=\"0\""), 13, "programID=\"own\"");
    const Findings findings = run(request(
        {folder() / "grid.net.xml",
         write("grid.rou.xml",
               "<routes><flow id='f' begin='0' end='600' number='30' from='A0A1' to='A1B1'/></routes>"),
         write("grid.add.xml",
               "<additional><inductionLoop id='mine' lane='A1B1_0' pos='50' freq='60' file='mine.xml'/>"
               "<inductionLoop id='other' lane='A1B1_0' pos='60' freq='60' file='other.xml'/>"
               "<calibrator id='c' edge='A0A1' pos='0'/>" +
                   program + "</additional>")}));
    EXPECT_THAT(additional_file(), AllOf(HasSubstr("id=\"mine\""), HasSubstr("file=\"NUL\""),
                                         Not(HasSubstr("other")), Not(HasSubstr("x.xml"))));
    EXPECT_THAT(findings.left_out, Contains(HasSubstr("<calibrator>, which affects the traffic")));
}

TEST_F(SumoDemand, trips_between_zones_get_their_way) {
    run(configured("<flow id='f' begin='0' end='100' number='9' fromTaz='west' toTaz='east'/>", "",
                   "<taz id='west' edges='first'/><taz id='east' edges='second'/>"));
    EXPECT_EQ(vehicles(), 9U);
    EXPECT_THAT(traffic_file(), HasSubstr("edges=\"first second\""));
}

TEST_F(SumoDemand, a_demand_of_which_nothing_can_be_used_is_no_synthetic_one) {
    EXPECT_THAT(refusal(line_with("<flow id='f' begin='0' end='100' number='9' toTaz='east'/>")),
                AllOf(HasSubstr("no vehicle of its demand can be used"), HasSubstr("duarouter"),
                      HasSubstr("9 vehicles without a route")));
}

TEST_F(SumoDemand, what_sumo_says_of_additional_files_names_the_files_of_the_user) {
    run_tool("netgenerate", {"--grid", "--grid.number", "3", "--default-junction-type", "traffic_light",
                             "--output-file", (folder() / "grid.net.xml").string()});
    const std::string message = refusal(request(
        {folder() / "grid.net.xml",
         write("grid.rou.xml",
               "<routes><flow id='f' begin='0' end='600' number='30' from='A0A1' to='A1B1'/></routes>"),
         write("line.add.xml",
               "<additional>\n<poi id='p' x='0' y='0'/>\n<tlLogic id='B1' type='static' programID='own'>\n"
               "<phase duration='9' state='G'/></tlLogic></additional>")}));
    EXPECT_THAT(message, Not(HasSubstr("clearway-import-")));
    EXPECT_THAT(message, HasSubstr("line.add.xml:3"));
}

TEST_F(SumoDemand, files_whose_root_sumo_does_not_look_at_are_taken_for_what_they_hold) {
    run(request(
        {line_network(), write("a.xml", "<flows>" + flow("begin='0' end='9' number='3'") + "</flows>"),
         write("b.xml", "<pois><poi id='p' x='0' y='0'/></pois>"), write("c.xml", "<tlLogics></tlLogics>")}));
    EXPECT_EQ(vehicles(), 3U);
}

}  // namespace
}  // namespace clearway::scenario_import
