// Persons of SUMO's scenarios who walk and ride: kept as SUMO would move them, or named.
#include <map>
#include <sstream>

#include <gmock/gmock.h>

#include "scenario/prepare.hpp"
#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/sumo_trial.hpp"
#include "town.hpp"

namespace clearway::scenario_import {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Three by three signals with streets of 150 m, sidewalks and crossings: edges `A0A1` (north), `A1B1`
/// (east).
class SumoPersons : public ImportTest {
  protected:
    /// Its network, made by netgenerate; with walking areas but without crossings where `ways` says so.
    std::filesystem::path grid(const std::string& ways = "--crossings.guess") const {
        const std::filesystem::path file = folder() / "grid.net.xml";
        run_tool("netgenerate",
                 {"--grid", "--grid.number", "3", "--grid.length", "150", "--default-junction-type",
                  "traffic_light", "--sidewalks.guess", ways, "--output-file", file.string()});
        return file;
    }
    /// The network with the sidewalk of an edge closed, and no way from or to it on foot.
    static std::string without_sidewalk(const std::string& edge, const std::filesystem::path& network) {
        std::istringstream lines(core::read_file(network));
        std::string text;
        for (std::string line; std::getline(lines, line);) {
            const std::string open = "allow=\"pedestrian\"";
            if (line.find("id=\"" + edge + "_0\"") != std::string::npos)
                line.replace(line.find(open), open.size(), "allow=\"bicycle\"");
            const bool on_foot = line.find("_w") != std::string::npos && line.starts_with("    <connection");
            if (!on_foot || line.find("\"" + edge + "\"") == std::string::npos) text += line + "\n";
        }
        return text;
    }
    ImportRequest with(const std::string& demand, const std::string& additional = "") const {
        return request({grid(), write("town.rou.xml", "<routes>\n" + cars() + demand + "</routes>"),
                        write("town.add.xml", "<additional>" + additional + "</additional>")});
    }
    static std::string cars() {
        std::string text;
        for (int number = 0; number < 8; ++number)
            text += fmt::format("<vehicle id='{0}' depart='{1}'><route edges='A0A1 A1A2'/></vehicle>\n",
                                number, 100 + 5 * number);
        return text;
    }
    static std::string person(const std::string& id, const std::string& plan,
                              const std::string& attributes = "depart='105'") {
        return fmt::format("<person id='{}' {}>{}</person>\n", id, attributes, plan);
    }
    std::string persons() const { return core::read_file(out() / "town" / "persons.rou.xml"); }
    scenario::Prepared prepared(const scenario::Options& options = {}) const {
        const scenario::ScenarioConfig config = scenario::load((out() / "town").string(), options);
        const scenario::BuiltNetwork network = scenario::build_network(config, folder() / "built");
        return scenario::prepare(config, network, core::StudySeed{1}, core::Replication{0},
                                 folder() / "demand");
    }
    /// Whether SUMO walks a person to the end.
    bool sumo_walks(const std::string& plan, const std::string& attributes) const {
        const auto file = write("single.rou.xml", "<routes>" + person("p", plan, attributes) + "</routes>");
        core::Command sumo{
            "sumo",
            {"-n", (folder() / "grid.net.xml").string(), "-r", file.string(), "-a",
             (folder() / "town.add.xml").string(), "--xml-validation", "never", "--route-steps", "0"},
            {},
            folder() / "sumo.log"};
        return core::run(sumo).ok();
    }
};

constexpr const char* stop_at_b1 = "<busStop id='stop' lane='A1B1_1' startPos='50' endPos='70'/>";

TEST_F(SumoPersons, who_walk_are_kept_with_their_types_and_times_from_the_begin) {
    ImportRequest made = with(
        "<vType id='slow' vClass='pedestrian' maxSpeed='0.9'/><vType id='plain' maxSpeed='1.1'/>"
        "<vTypeDistribution id='mix'><vType id='half' vClass='pedestrian' "
        "probability='1'/></vTypeDistribution>" +
            person("edges", "<walk edges='A0A1 A1A2' arrivalPos='20' speed='1.5'/>",
                   "depart='0:01:45' type='slow' departPos='30'") +
            person("trip", "<personTrip from='A0A1' to='B1C1'/>", "depart='106' type='mix'") +
            person("stopper",
                   "<walk from='A0A1' busStop='stop'/><stop busStop='stop' until='150'/><walk to='B1B2'/>",
                   "depart='110' type='plain'") +
            person("plain", "<walk edges='A1A2'/>") + person("late", "<walk edges='A1A2'/>", "depart='9999'"),
        stop_at_b1);
    made.begin_s = 100.0;
    const Findings findings = run(made);
    EXPECT_EQ(findings.persons, 4U);
    EXPECT_THAT(to_text(findings), HasSubstr("persons          4 walk or ride"));
    EXPECT_THAT(findings.changes, AllOf(Contains(HasSubstr("of 5 persons the 4")),
                                        Contains(HasSubstr("type \"plain\" of persons gets the class"))));
    EXPECT_THAT(persons(), AllOf(HasSubstr("<vType id=\"slow\" vClass=\"pedestrian\" maxSpeed=\"0.9\"/>"),
                                 HasSubstr("id=\"edges\" type=\"slow\" depart=\"5.00\" departPos=\"30\""),
                                 HasSubstr("<walk edges=\"A0A1 A1A2\" arrivalPos=\"20\" speed=\"1.5\"/>"),
                                 HasSubstr("id=\"trip\" type=\"half\" depart=\"6.00\""),
                                 HasSubstr("<walk edges=\"A0A1 A1B1 B1C1\"/>"),
                                 HasSubstr("<walk busStop=\"stop\" edges=\"A0A1 A1B1\"/>"),
                                 HasSubstr("until=\"50.00\""), HasSubstr("<walk edges=\"A1B1 B1B2\"/>"),
                                 HasSubstr("id=\"plain\" type=\"DEFAULT_PEDTYPE\"")));
    EXPECT_EQ(scenario::load((out() / "town").string()).measured->persons.front(), "persons.rou.xml");
    EXPECT_THAT(
        core::read_file(prepared().route_files.at(1)),
        AllOf(HasSubstr("id=\"person.slow\""), HasSubstr("id=\"person.edges\" type=\"person.slow\"")));
}

TEST_F(SumoPersons, a_flow_is_one_person_per_departure) {
    const Findings findings =
        run(with("<personFlow id='counted' begin='100' end='130' number='3'><walk edges='A0A1'/></personFlow>"
                 "<personFlow id='hourly' begin='100' end='120' personsPerHour='720'><walk from='A0A1' "
                 "to='B1C1'/></personFlow>"));
    EXPECT_EQ(findings.persons, 3U + 4U);
    EXPECT_THAT(persons(), AllOf(HasSubstr("id=\"counted.2\" type=\"DEFAULT_PEDTYPE\" depart=\"20.00\""),
                                 HasSubstr("id=\"hourly.3\" type=\"DEFAULT_PEDTYPE\" depart=\"15.00\""),
                                 Not(HasSubstr("personFlow"))));
}

TEST_F(SumoPersons, who_cannot_be_kept_are_left_out_by_what_they_are) {
    const std::string walk = "<walk edges='A0A1'/>";
    const Findings findings = run(with(
        "<vType id='car' vClass='passenger'/>" + person("ride", walk + "<ride to='A1A2' lines='ANY'/>") +
        person("taxi", walk + "<ride to='A1A2' lines='taxi'/>") +
        person("trip", "<personTrip from='A0A1' to='A1A2' modes='public'/>") +
        person("triggered", walk, "depart='triggered'") + person("zones", "<walk fromTaz='a' toTaz='b'/>") +
        person("driver", walk, "depart='105' type='car'") +
        person("still", "<stop lane='A0A1_0' duration='9'/>") +
        person("endless", walk + "<stop lane='A0A1_0'/>") +
        "<personFlow id='flow' begin='100' end='130' number='3'><ride from='A0A1' to='A1A2' "
        "lines='x'/></personFlow><container id='box' depart='105'><tranship edges='A0A1'/></container>"
        "<containerFlow id='boxes' begin='0' end='9' number='1'><tranship edges='A0A1'/></containerFlow>"));
    EXPECT_EQ(findings.persons, 0U);
    EXPECT_FALSE(std::filesystem::exists(out() / "town" / "persons.rou.xml"));
    for (const char* const line :
         {"1 persons who take a taxi (taxi)", "1 persons who may ride (trip)",
          "4 persons whose vehicle does not come in that time (ride, flow.0, flow.1, ...)",
          "1 persons who wait for a vehicle (triggered)",
          "1 persons who walk between zones, junctions or coordinates (zones)",
          "1 persons of a class that does not walk (driver)", "1 persons who do not walk (still)",
          "1 persons who stop without a stated end (endless)",
          "1 <container>, which Clearway does not support (box)",
          "1 <containerFlow>, which Clearway does not support (boxes)"})
        EXPECT_THAT(findings.left_out, Contains(line));
}

/// A bus that would stand 10 s at each of its two stops, and forty people who want to get on at the first.
TEST_F(SumoPersons, who_ride_delay_their_bus_as_in_plain_sumo) {
    const std::string bus =
        "<vType id='bus' vClass='bus' sigma='0' speedDev='0' personCapacity='60' boardingDuration='2'/>"
        "<vehicle id='b' type='bus' line='7' depart='100'><route edges='A0A1 A1B1 B1B2'/><stop busStop='on' "
        "duration='10'/><stop busStop='stop' duration='10'/></vehicle>";
    std::string riders;
    for (int number = 0; number < 40; ++number)
        riders += person(fmt::format("r{}", number),
                         "<ride busStop='stop' lines='7'/><walk to='B1B2' arrivalPos='100'/>",
                         "depart='95' type='feet' departPos='60'");
    std::string text = riders;
    for (std::size_t at = text.find("<ride "); at != std::string::npos; at = text.find("<ride ", at + 1))
        text.insert(at + 6, "from='A0A1' ");
    const std::string stops =
        std::string(stop_at_b1) + "<busStop id='on' lane='A0A1_1' startPos='50' endPos='70'/>";
    const std::string demand = "<vType id='feet' vClass='pedestrian' speedDev='0'/>" + bus + text;
    const auto network = grid();
    const auto additional = write("plain.add.xml", "<additional>" + stops + "</additional>");
    const auto trip_of_bus = [&](std::vector<std::string> arguments) {
        const std::filesystem::path trips = folder() / "trips.xml";
        arguments.insert(arguments.end(),
                         {"--tripinfo-output", trips.string(), "--end", "900", "--no-warnings"});
        run_tool("sumo", arguments);
        std::map<std::string, std::string> found;
        detail::for_each_element(trips, [&](detail::Element&& trip) {
            if (trip.text("id") == "b") found["bus"] = trip.text("duration") + " " + trip.text("stopTime");
            for (const detail::Element& stage : trip.children)
                if (stage.name == "ride" && stage.text("vehicle") == "b") found["riders"] += "1";
        });
        return found;
    };
    const auto routes = write("plain.rou.xml", "<routes>" + demand + "</routes>");
    const auto plain = trip_of_bus({"--net-file", network.string(), "--route-files", routes.string(),
                                    "--additional-files", additional.string(), "--no-step-log"});
    ASSERT_EQ(plain.at("riders").size(), 40U);
    EXPECT_GT(std::stod(plain.at("bus").substr(plain.at("bus").find(' '))), 80.0)
        << "boarding takes 2 s each";

    ImportRequest made = request({network, routes, additional});
    made.begin_s = 0.0;
    const Findings findings = run(made);
    EXPECT_EQ(findings.persons, 40U);
    EXPECT_THAT(findings.left_out, IsEmpty());
    EXPECT_EQ(trip_of_bus(detail::sumo_arguments(prepared())), plain);
}

TEST_F(SumoPersons, vehicles_without_their_passengers_are_counted) {
    const Findings findings = run(with(
        "<vehicle id='b' line='7' depart='140'><route edges='A0A1 A1B1'/><stop busStop='stop' duration='10'/>"
        "</vehicle><vehicle id='c' line='8' depart='141'><route edges='A0A1 A1B1'/><stop busStop='stop' "
        "duration='10'/></vehicle>" +
            person("trip", "<personTrip from='A0A1' to='A1A2' modes='public'/>"),
        stop_at_b1));
    EXPECT_THAT(findings.changes, Contains(HasSubstr("2 vehicles may wait less at stops")));
}

TEST_F(SumoPersons, rides_that_do_not_join_are_refused) {
    const auto fault = [&](const std::string& ride) {
        return refusal(with(person("p", "<walk edges='A0A1'/>" + ride), stop_at_b1));
    };
    EXPECT_THAT(fault("<ride from='A1B1' busStop='stop' lines='7'/>"),
                HasSubstr("rides from edge \"A1B1\" after it came to \"A0A1\""));
    EXPECT_THAT(fault("<ride busStop='none' lines='7'/>"), HasSubstr("there is no busStop \"none\""));
    EXPECT_THAT(fault("<ride lines='7'/>"), HasSubstr("has a ride without a \"to\""));
    EXPECT_THAT(fault("<ride to='nowhere' lines='7'/>"), HasSubstr("no edge \"nowhere\""));
}

struct Plan {
    const char* plan;
    const char* fault;  ///< Empty for plans that can be walked.
    const char* attributes = "depart='105'";
};

TEST_F(SumoPersons, what_sumo_cannot_walk_is_refused_together_or_left_out) {
    const std::vector<Plan> plans = {
        {"<walk edges='A0A1 nowhere'/>", "no edge \"nowhere\""},
        {"<walk from='A0A1' to='nowhere'/>", "no edge \"nowhere\""},
        {"<walk edges='A0A1 B1C1'/>", "nobody gets from edge \"A0A1\" to \"B1C1\" on foot"},
        {"<walk edges='A0A1 A1A2 A1B1'/>", "nobody gets from edge \"A1A2\" to \"A1B1\" on foot"},
        {"<walk edges='A0A1'/><walk edges='B1C1'/>", "walks on from edge \"B1C1\" after it came to \"A0A1\""},
        {"<walk edges='A0A1'/><stop lane='B1C1_0' duration='5'/>", "stops at edge \"B1C1\" after a walk"},
        {"<walk edges='A0A1'/><stop lane='A0A1_9' duration='5'/>", "no lane \"A0A1_9\""},
        {"<walk to='A1A2'/>", "without a \"from\""},
        {"<walk edges='A0A1' busStop='none'/>", "no busStop \"none\""},
        {"<walk edges='A0A1' busStop='stop'/>", "its stop is on \"A1B1\""},
        {"<walk edges='A0A1' arrivalPos='soon'/>", "arrivalPos is \"soon\""},
        {"<walk edges='A0A1' speed='0'/>", "speed is \"0\""},
        {"<walk edges='A0A1'/>", "departPos is \"max\"", "depart='105' departPos='max'"},
        {"<walk edges='A0A1 A1B1' busStop='stop'/><stop busStop='stop' duration='5'/><walk to='C1C2'/>", ""},
        {"<walk edges='A0A1 A1A0' arrivalPos='max'/>", ""},
        {"<stop edge='A0A1' duration='5'/><walk edges='A1A2 B2A2'/>", ""}};
    std::string demand = "<vehicle id='car' depart='100'><route edges='A0A1 B1C1'/></vehicle>\n";
    for (std::size_t row = 0; row < plans.size(); ++row)
        demand += person(fmt::format("p{}", row), plans[row].plan, plans[row].attributes);
    ImportRequest made = with(demand, stop_at_b1);
    const std::string message = refusal(made);
    EXPECT_THAT(message, AllOf(HasSubstr("\"car\""), HasSubstr("town.rou.xml:11: person \"p0\""),
                               HasSubstr("--leave-out-bad-vehicles")));
    for (const Plan& each : plans) {
        EXPECT_THAT(message, HasSubstr(each.fault));
        EXPECT_EQ(sumo_walks(each.plan, each.attributes), *each.fault == '\0') << each.plan;
    }
    made.bad_vehicles = BadVehicles::leave_out;
    const Findings findings = run(made);
    EXPECT_EQ(findings.persons, 3U);
    EXPECT_THAT(findings.left_out,
                Contains(AllOf(HasSubstr("13 persons who cannot walk as planned"), HasSubstr("nowhere"))));
    EXPECT_THAT(persons(), AllOf(HasSubstr("\"p13\""), HasSubstr("\"p14\""), HasSubstr("\"p15\"")));
}

TEST_F(SumoPersons, edges_closed_to_pedestrians_and_walks_without_a_way_are_bad) {
    const std::string demand = cars() + person("closed", "<walk edges='A0A1 A1A2'/>") +
                               person("barred", "<walk edges='A0A1 A1B1 B1C1'/>") +
                               person("cut", "<walk from='A0A1' to='B1C1'/>") +
                               person("free", "<walk edges='B1C1'/>");
    ImportRequest made = request({write("closed.net.xml", without_sidewalk("A1A2", grid("--walkingareas"))),
                                  write("town.rou.xml", "<routes>" + demand + "</routes>")});
    EXPECT_THAT(refusal(made),
                AllOf(HasSubstr("edge \"A1A2\" is closed to pedestrians"),
                      HasSubstr("nobody gets from edge \"A1B1\" to \"B1C1\""), Not(HasSubstr("cut"))));
    made.bad_vehicles = BadVehicles::leave_out;
    const Findings findings = run(made);
    EXPECT_EQ(findings.persons, 1U);
    EXPECT_THAT(findings.left_out, Contains("1 persons without a walking route between their ends (cut)"));
}

TEST_F(SumoPersons, ids_may_be_those_of_vehicles_but_not_of_each_other) {
    const std::string walk = "<walk edges='A0A1 A1A2'/>";
    EXPECT_THAT(refusal(with(person("twin", walk) + person("twin", walk))),
                AllOf(HasSubstr("town.rou.xml:11: \"twin\""), HasSubstr("occurs twice"),
                      HasSubstr("town.rou.xml:10")));
    run(with("<vehicle id='person.0' depart='100'><route edges='A0A1'/></vehicle>" + person("0", walk) +
             person("pedestrian.0", walk)));
    scenario::Options options;
    options.set("pedestrians_per_hour", "10");
    const scenario::Prepared made = prepared(options);
    ASSERT_EQ(made.route_files.size(), 3U);
    EXPECT_THAT(core::read_file(made.route_files[1]), AllOf(HasSubstr("<person id=\"person.person.0\""),
                                                            HasSubstr("<person id=\"person.pedestrian.0\"")));
    EXPECT_THAT(core::read_file(made.route_files[2]), HasSubstr("<person id=\"pedestrian.0\""));
}

TEST_F(SumoPersons, unknown_types_and_routes_are_refused_and_known_routes_walked) {
    const std::string message = refusal(
        with(person("a", "<walk edges='A0A1'/>", "depart='105' type='nosuch'") +
             person("b", "<walk route='nosuch'/>") + person("c", "<walk edges='A0A1'/>", "depart='soon'")));
    EXPECT_THAT(message, AllOf(HasSubstr("type \"nosuch\""), HasSubstr("route \"nosuch\""),
                               HasSubstr("depart is \"soon\"")));
    run(with("<route id='way' edges='A0A1 A1B1'/>" + person("a", "<walk route='way'/>")));
    EXPECT_THAT(persons(), HasSubstr("<walk edges=\"A0A1 A1B1\"/>"));
}

TEST_F(SumoPersons, plans_end_with_the_last_walk_of_a_run) {
    const Findings findings = run(with(
        person("worker", "<walk edges='A0A1'/><stop edge='A0A1' duration='8:00:00'/><walk edges='A0A1'/>") +
        person("sleeper", "<stop edge='A0A1' until='7:00:00'/><walk edges='A0A1'/>")));
    EXPECT_EQ(findings.persons, 1U);
    EXPECT_THAT(findings.left_out, Contains("1 persons who depart after the end of a run (sleeper)"));
    EXPECT_THAT(findings.changes, Contains(HasSubstr("the plans of 2 persons end with")));
    EXPECT_THAT(persons(), AllOf(HasSubstr("worker"), Not(HasSubstr("<stop"))));
}

TEST_F(SumoPersons, alone_they_are_no_traffic) {
    const Findings findings =
        run(request({grid(), write("town.rou.xml",
                                   "<routes>" + person("walker", "<walk edges='A0A1'/>") + "</routes>")}));
    EXPECT_THAT(findings.changes, Contains(HasSubstr("no road vehicles: the demand is synthetic")));
    EXPECT_THAT(findings.left_out, Contains(HasSubstr("1 persons, because no vehicle is left (walker)")));
    EXPECT_FALSE(scenario::load((out() / "town").string()).measured);
}

}  // namespace
}  // namespace clearway::scenario_import
