// What plain SUMO 1.15 does with the same files: how many vehicles, on which ways.
#include <algorithm>
#include <map>
#include <sstream>

#include <gmock/gmock.h>

#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/sumo_trial.hpp"
#include "sumo_line.hpp"

namespace clearway::scenario_import {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// What plain SUMO inserts, and what the import makes of the same route file.
class PlainCounts : public SumoScenario {
  protected:
    std::string plain(const std::string& network, const std::string& routes,
                      std::vector<std::string> more = {}) {
        const std::filesystem::path file = write("plain.rou.xml", "<routes>" + routes + "</routes>");
        const std::filesystem::path out = folder() / "plain.xml";
        std::vector<std::string> arguments = {
            "--net-file",    network,         "--route-files",     file.string(),
            "--no-step-log", "--no-warnings", "--vehroute-output", out.string(),
            "--end",         "7200",          "--junction-taz"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        run_tool("sumo", arguments);
        return ways(out);
    }
    /// `id: edges` of each vehicle, by id.
    static std::string ways(const std::filesystem::path& output) {
        std::map<std::string, std::string> edges;
        detail::for_each_element(output, [&](detail::Element&& vehicle) {
            for (const detail::Element& child : vehicle.children) {
                if (child.name == "route") edges[vehicle.text("id")] = child.text("edges");
                if (child.name == "routeDistribution")
                    edges[vehicle.text("id")] = child.children.back().text("edges");
            }
        });
        std::string text;
        for (const auto& [id, way] : edges)
            text += fmt::format("{}: {}\n", id, way);
        return text;
    }
    /// The same of a run of the imported scenario.
    std::string imported(const std::string& name = "town") {
        const scenario::Prepared made = prepared(name);
        std::vector<std::string> arguments = detail::sumo_arguments(made);
        const std::filesystem::path out = folder() / "imported.xml";
        arguments.insert(arguments.end(),
                         {"--vehroute-output", out.string(), "--end", "7200", "--no-warnings"});
        run_tool("sumo", arguments);
        return ways(out);
    }
};

/// The counts are those of SUMO 1.15.
TEST_F(PlainCounts, every_form_of_a_flow_gives_as_many_vehicles_as_plain_sumo) {
    // By begin, because plain SUMO drops those that are not.
    const std::vector<std::pair<const char*, int>> forms = {
        {"begin='0' end='100' number='20'", 20},       {"end='100' number='20'", 20},
        {"begin='0' end='100' period='5'", 20},        {"begin='0' period='5' number='7'", 7},
        {"begin='0' end='101' period='5'", 21},        {"begin='0' end='100' vehsPerHour='360'", 10},
        {"begin='0' end='100' perHour='360'", 10},     {"begin='0' vehsPerHour='360' number='4'", 4},
        {"begin='0' end='100' probability='1'", 100},  {"begin='0' probability='1' number='7'", 7},
        {"begin='0' period='exp(0.2)' number='7'", 7}, {"begin='0' end='100' period='0:00:05'", 20},
        {"begin='0' end='10' period='0.3'", 34},       {"begin='0' end='100' number='0'", 0},
        {"begin='0.5' end='10.5' period='2.5'", 4},    {"begin='0:00:10' end='0:01:00' period='5'", 10},
        {"begin='30' end='30' number='20'", 20},       {"begin='30' end='30' vehsPerHour='360'", 0}};
    std::string routes;
    for (std::size_t row = 0; row < forms.size(); ++row)
        routes += fmt::format("<flow id='f{}' from='first' to='second' departLane='best' {}/>\n", row,
                              forms[row].first);
    ImportRequest made = line_with(routes);
    run(made);
    std::map<std::string, int> counted;
    detail::for_each_element(out() / "town" / "traffic.rou.xml", [&](detail::Element&& vehicle) {
        if (vehicle.name == "vehicle") ++counted[vehicle.text("id").substr(0, vehicle.text("id").find('.'))];
    });
    std::map<std::string, int> by_sumo;
    std::istringstream lines(plain((folder() / "line.net.xml").string(), routes));
    for (std::string line; std::getline(lines, line);)
        ++by_sumo[line.substr(0, line.find('.'))];
    for (std::size_t row = 0; row < forms.size(); ++row) {
        EXPECT_EQ(counted[fmt::format("f{}", row)], forms[row].second) << forms[row].first;
        EXPECT_EQ(by_sumo[fmt::format("f{}", row)], forms[row].second) << forms[row].first;
    }
}

TEST_F(PlainCounts, flows_that_sumo_refuses_or_lets_wait_are_named) {
    const std::string fault =
        refusal(line_with("<flow id='back' from='first' to='second' begin='50' end='30' number='20'/>"
                          "<flow id='half' from='first' to='second' end='30' number='2.5'/>"
                          "<flow id='sure' from='first' to='second' end='30' probability='1.5'/>"
                          "<flow id='early' from='first' to='second' begin='-10' end='30' period='5'/>"
                          "<trip id='past' from='first' to='second' depart='-5'/>"));
    for (const char* const says : {"ends at 30 s, before its begin at 50 s", "number \"2.5\"",
                                   "probability \"1.5\"", "begins at -10 s", "depart is \"-5\""})
        EXPECT_THAT(fault, HasSubstr(says));
    const Findings findings =
        run(line_with("<flow id='rides' from='first' to='second' begin='triggered' number='3'/>" + cars(9)));
    EXPECT_THAT(findings.left_out, Contains(HasSubstr("1 flows that wait for passengers or goods (rides)")));
    EXPECT_EQ(findings.vehicles.at("car"), 9);
}

TEST_F(PlainCounts, trips_that_sumo_completes_take_its_ways) {
    const std::string stops =
        "<busStop id='bs' lane='second_0' startPos='50' endPos='80'/><parkingArea id='pa' lane='second_0' "
        "startPos='150' endPos='200' roadsideCapacity='9'/><taz id='z' edges='first'/>";
    const std::string trips =
        "<trip id='a' depart='1' from='first'><stop lane='second_0' endPos='100' duration='5'/></trip>"
        "<trip id='b' depart='11' from='first'><stop busStop='bs' duration='5'/></trip>"
        "<trip id='c' depart='21' from='first'><stop parkingArea='pa' duration='5'/></trip>"
        "<flow id='d' begin='31' end='41' number='2' from='first'><stop busStop='bs' duration='5'/></flow>"
        "<trip id='e' depart='51' from='first'/><trip id='f' depart='61' from='first' via='second'/>"
        "<trip id='g' depart='71' to='second'/>"
        "<trip id='h' depart='81'><stop lane='second_0' endPos='100' duration='5'/></trip>"
        "<trip id='i' depart='91'><stop lane='first_0' endPos='100' duration='5'/>"
        "<stop lane='second_0' endPos='100' duration='5'/></trip>"
        "<trip id='j' depart='101' via='first second'/>"
        "<trip id='k' depart='111' to='second'><stop lane='first_0' endPos='100' duration='5'/></trip>"
        "<trip id='l' depart='121' fromTaz='z'><stop lane='second_0' endPos='100' duration='5'/></trip>"
        "<trip id='m' depart='131' fromJunction='a' toJunction='c'/>";
    const auto network = line_network();
    const auto additional = write("stops.add.xml", "<additional>" + stops + "</additional>");
    run(request({network, write("line.rou.xml", "<routes>" + trips + "</routes>"), additional}));
    const std::string expected = plain(network.string(), trips, {"--additional-files", additional.string()});
    EXPECT_EQ(std::ranges::count(expected, '\n'), 14);
    EXPECT_EQ(imported(), expected);
}

/// A road A, B, C with a way round B over D1 and D2.
class Closures : public PlainCounts {
  protected:
    void SetUp() override {
        PlainCounts::SetUp();
        const auto nodes =
            write("round.nod.xml",
                  "<nodes><node id='a' x='0' y='0'/><node id='b' x='300' y='0'/><node id='c' x='600' "
                  "y='0'/><node id='d' x='900' y='0'/><node id='e' x='450' y='200'/></nodes>");
        const auto edges = write(
            "round.edg.xml",
            "<edges><edge id='A' from='a' to='b' numLanes='2' speed='15'/><edge id='B' from='b' to='c' "
            "numLanes='2' speed='15'/><edge id='C' from='c' to='d' numLanes='2' speed='15'/><edge id='D1' "
            "from='b' to='e' speed='15'/><edge id='D2' from='e' to='c' speed='15'/></edges>");
        run_tool("netconvert", {"--node-files", nodes.string(), "--edge-files", edges.string(),
                                "--output-file", network().string()});
    }
    std::filesystem::path network() const { return folder() / "round.net.xml"; }
    /// Imports and compares the ways of all vehicles with plain SUMO.
    void expect_same_ways(const std::string& routes, const std::string& additional) {
        const auto file = write("r.add.xml", "<additional>" + additional + "</additional>");
        std::filesystem::remove_all(out() / "town");
        ImportRequest made =
            request({network(), write("r.rou.xml", "<routes>" + routes + "</routes>"), file});
        made.automated_share = 0.0;
        EXPECT_EQ(run(made).trial_failure, "");
        const std::string expected = plain(network().string(), routes, {"--additional-files", file.string()});
        EXPECT_EQ(imported(), expected) << additional;
    }
    static std::string rerouter(const std::string& what) {
        return "<rerouter id='r' edges='A'><interval begin='0' end='3600'>" + what + "</interval></rerouter>";
    }
};

TEST_F(Closures, send_trips_round_as_in_plain_sumo) {
    expect_same_ways("<flow id='t' begin='0' end='300' number='60' from='A' to='C'/>",
                     rerouter("<closingReroute id='B' allow='emergency authority'/>"));
}

TEST_F(Closures, take_the_routes_that_rerouters_name) {
    expect_same_ways(
        "<vehicle id='v' depart='0'><route edges='A B C'/></vehicle>",
        "<route id='alt' edges='A D1 D2 C'/>" + rerouter("<routeProbReroute id='alt' probability='1'/>"));
}

/// Plain SUMO wants what a rerouter names before it, so these are in its additional file.
TEST_F(Closures, carry_along_whatever_a_rerouter_names) {
    const std::string trips = "<flow id='t' begin='0' end='300' number='20' from='A' to='C'/>";
    const std::string alternative = "<route id='alt' edges='A D1 D2 C'/>";
    write("part.add.xml", "<additional><step time='0' speed='3'/></additional>");
    expect_same_ways(trips, alternative + "<routeDistribution id='ways' routes='alt' probabilities='1'/>" +
                                rerouter("<routeProbReroute id='ways' probability='1'/>"));
    expect_same_ways(trips, "<variableSpeedSign id='v' lanes='B_0 B_1' file='part.add.xml'/>");
    expect_same_ways(trips, rerouter("<destProbReroute id='D2' probability='1'/>"));
    expect_same_ways(
        "<vehicle id='v' depart='0'><route edges='A B C'/></vehicle>",
        rerouter("<viaProbReroute id='D1' probability='1'/><destProbReroute id='D2' probability='1'/>"));
    expect_same_ways(
        "<flow id='t' begin='0' end='300' number='20' from='A' to='C'><stop parkingArea='one' "
        "duration='400'/></flow>",
        "<parkingArea id='one' lane='C_0' startPos='20' endPos='60' roadsideCapacity='2'/>"
        "<parkingArea id='two' lane='D2_0' startPos='20' endPos='60' roadsideCapacity='30'/>"
        "<rerouter id='r' edges='A'><interval begin='0' end='3600'><parkingAreaReroute id='one' "
        "visible='true'/><parkingAreaReroute id='two' visible='true'/></interval></rerouter>");
    expect_same_ways(
        "<flow id='f' begin='0' end='100' number='5' type='a' from='A' to='C'/><flow id='g' "
        "begin='100' end='200' number='5' type='b' from='A' to='C'/>",
        "<vType id='a'/><vType id='b'/><vTypeDistribution id='mix' vTypes='a' probabilities='1'/>" +
            alternative +
            "<rerouter id='r' edges='A' vTypes='mix'><interval begin='0' end='3600'>"
            "<routeProbReroute id='alt' probability='1'/></interval></rerouter>");
}

TEST_F(Closures, find_routes_and_types_in_any_file) {
    const auto types = write("t.add.xml", "<additional><vType id='a'/><vType id='b'/></additional>");
    const auto mix = write("m.add.xml",
                           "<additional><vTypeDistribution id='mix' vTypes='a b' probabilities='0 1'/>"
                           "<routeDistribution id='ways' routes='AB AD' probabilities='0 1'/>" +
                               rerouter("<routeProbReroute id='ways' probability='1'/>") + "</additional>");
    const auto routes = write("r.rou.xml",
                              "<routes><route id='AB' edges='A B C'/><route id='AD' edges='A D1 D2 C'/><flow "
                              "id='t' begin='0' end='100' number='9' type='mix' route='ways'/></routes>");
    run(request({network(), mix, routes, types}));
    EXPECT_THAT(core::read_file(out() / "town" / "traffic.rou.xml"),
                AllOf(HasSubstr("type=\"b\""), Not(HasSubstr("type=\"a\"")), HasSubstr("A D1 D2 C")));
    EXPECT_THAT(imported(), AllOf(HasSubstr("t.8: A D1 D2 C"), Not(HasSubstr("B"))));
}

TEST_F(Closures, that_name_what_there_is_not_are_refused_with_file_and_line) {
    const auto routes = write("r.rou.xml", "<routes><trip id='t' depart='0' from='A' to='C'/></routes>");
    const auto fault_of = [&](const std::string& element) {
        return refusal(
            request({network(), routes, write("r.add.xml", "<additional>\n" + element + "</additional>")}));
    };
    for (const std::string& element : {rerouter("<destProbReroute id='nowhere' probability='1'/>"),
                                       rerouter("<routeProbReroute id='nowhere' probability='1'/>"),
                                       "<busStop id='s' lane='A_9' startPos='1' endPos='20'/>" +
                                           rerouter("<viaProbReroute id='D1' probability='1'/>")})
        EXPECT_THAT(fault_of(element), HasSubstr("r.add.xml:2: SUMO does not load"));
}

TEST_F(Closures, of_a_vehicle_with_a_route_end_a_trial_run_and_that_is_told) {
    const auto file =
        write("r.add.xml",
              "<additional>" + rerouter("<closingReroute id='B' allow='emergency'/>") + "</additional>");
    const auto routes = write("r.rou.xml",
                              "<routes><vehicle id='ok' depart='0'><route edges='D1 D2 C'/></vehicle>"
                              "<vehicle id='v' depart='20'><route edges='A B C'/></vehicle></routes>");
    const Findings findings = run(request({network(), routes, file}));
    EXPECT_THAT(findings.trial_failure, HasSubstr("'v' has no valid route"));
    EXPECT_THAT(findings.trial_failure, HasSubstr("r.rou.xml:1: "));
    EXPECT_THAT(to_text(findings), HasSubstr("SUMO fails in a trial run of the scenario"));
}

TEST_F(PlainCounts, a_flow_before_earlier_trips_is_told_as_unsorted) {
    const Findings findings = run(line_with(
        "<flow id='f' begin='300' end='400' number='2' from='first' to='second'/><trip id='t' depart='5' "
        "from='first' to='second'/>"));
    EXPECT_THAT(findings.changes, Contains(HasSubstr("is sorted by departure; SUMO would have dropped")));
}

TEST_F(PlainCounts, trips_without_a_way_count_as_bad_vehicles) {
    std::string trips = "<trip id='good' depart='0' from='first' to='second'/>";
    for (int number = 0; number < 19; ++number)
        trips += fmt::format("<trip id='t{}' depart='{}' from='second' to='first'/>", number, number + 1);
    const Findings findings = run(line_with(trips));
    EXPECT_DOUBLE_EQ(findings.bad_vehicles_share, 0.95);
    EXPECT_THAT(to_text(findings), HasSubstr("95 % of the vehicles cannot drive their route"));
}

TEST_F(PlainCounts, vehicles_that_arrive_late_are_no_failure) {
    const Findings findings =
        run(line_with("<vehicle id='slow' depart='0'><route edges='first second'/><stop lane='first_0' "
                      "duration='700'/></vehicle>"));
    EXPECT_THAT(findings.changes,
                Contains(HasSubstr("because nobody arrives within 600 s of the last departure")));
    EXPECT_EQ(findings.trial_failure, "");
}

/// As plain SUMO reads it.
TEST_F(PlainCounts, text_in_utf_16_is_read) {
    const auto wide = [&](const std::string& name, const std::string& text) {
        std::string bytes = "\xff\xfe";
        for (const char letter : text)
            bytes += {letter, '\0'};
        return write(name, bytes);
    };
    EXPECT_THAT(refusal(request({wide("wide.osm", town_map())}, "map")), HasSubstr("is a map in UTF-16"));
    const std::string trips = "<flow id='f' from='first' to='second' begin='0' end='60' number='20'/>";
    const auto routes = wide("wide.rou.xml", "<routes>" + trips + "</routes>");
    const std::string network = core::read_file(line_network());
    const Findings findings =
        run(request({wide("wide.net.xml", network.substr(network.find("<net "))), routes}));
    EXPECT_EQ(findings.vehicles.at("car"), 20);
    EXPECT_EQ(imported(), plain((folder() / "line.net.xml").string(), trips));
}

/// A grid of two signals a side, without demand.
TEST_F(PlainCounts, what_belongs_to_the_network_stays_without_demand) {
    const auto network = folder() / "grid.net.xml";
    run_tool("netgenerate", {"--grid", "--grid.number", "3", "--grid.length", "200",
                             "--default-junction-type", "traffic_light", "--output-file", network.string()});
    std::string programs;
    detail::for_each_element(network, [&](detail::Element&& element) {
        if (element.name != "tlLogic" || element.text("id") != "B1") return;
        for (const char* const id : {"day", "night"}) {
            element.set("programID", id);
            programs += element.xml();
        }
    });
    const auto file = write(
        "town.add.xml",
        "<additional>" + programs +
            "<WAUT id='w' refTime='0' startProg='day'><wautSwitch time='100' to='night'/></WAUT>"
            "<wautJunction wautID='w' junctionID='B1'/><variableSpeedSign id='sign' lanes='B0B1_0'><step "
            "time='0' speed='4'/></variableSpeedSign><rerouter id='works' edges='A1B1'><interval begin='0' "
            "end='7200'><closingReroute id='B1C1' allow='authority'/></interval></rerouter>"
            "<inductionLoop id='loop' lane='B0B1_0' pos='5' freq='60' file='x.xml'/></additional>");
    const Findings findings = run(request({network, file}));
    EXPECT_EQ(findings.left_out,
              std::vector<std::string>{"1 <inductionLoop>, which does not affect the traffic (loop)"});
    const scenario::ScenarioConfig config = scenario::load((out() / "town").string());
    ASSERT_EQ(config.network.additional, std::vector<std::string>{"additional.add.xml"});
    EXPECT_EQ(scenario::load((out() / "town").string()).network.additional, config.network.additional);
    EXPECT_THAT(
        core::read_file(out() / "town" / "additional.add.xml"),
        AllOf(HasSubstr("programID=\"night\""), HasSubstr("<wautSwitch time=\"100\""),
              HasSubstr("<wautJunction"), HasSubstr("<variableSpeedSign"), HasSubstr("closingReroute")));
    const std::string ways = imported();
    EXPECT_THAT(ways, HasSubstr("human.1: "));
    EXPECT_THAT(ways, Not(HasSubstr("A1B1 B1C1"))) << "closed";
    EXPECT_THAT(traffic(), HasSubstr("reroute=\"true\""));
}

TEST_F(PlainCounts, signal_programs_stay_without_demand) {
    run_tool("netgenerate",
             {"--grid", "--grid.number", "3", "--grid.length", "200", "--default-junction-type",
              "traffic_light", "--output-file", (folder() / "grid.net.xml").string()});
    const auto file = write("tls.add.xml",
                            "<additional><tlLogic id='B1' type='static' programID='mine' offset='7'>"
                            "<phase duration='41' state='GGGGGGGGGGGGGGGGGGGG'/></tlLogic>"
                            "<tlLogic id='nowhere' type='static' programID='mine' offset='0'>"
                            "<phase duration='41' state='G'/></tlLogic></additional>");
    const Findings findings = run(request({folder() / "grid.net.xml", file}));
    int programs = 0;
    detail::for_each_element(out() / "town" / "network.net.xml", [&](detail::Element&& element) {
        if (element.name != "tlLogic" || element.text("id") != "B1") return;
        ++programs;
        EXPECT_EQ(element.text("offset"), "7");
        EXPECT_EQ(element.children.at(0).text("duration"), "41");
    });
    EXPECT_EQ(programs, 1);
    EXPECT_THAT(findings.changes, Contains(HasSubstr("replace those of the network at 1 signal")));
    EXPECT_THAT(findings.left_out, Contains(HasSubstr("signals that the network does not have (nowhere)")));
}

}  // namespace
}  // namespace clearway::scenario_import
