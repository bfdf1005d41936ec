// Options of SUMO's configuration: what an import takes over, and what it names as left out.
#include <gmock/gmock.h>

#include "sumo_demand.hpp"

namespace clearway::scenario_import {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

using SumoConfiguration = SumoDemand;

TEST_F(SumoConfiguration, a_configuration_may_hold_its_values_as_text) {
    line_network();
    write("line.rou.xml", "<routes>" + cars(9) + "</routes>");
    run(request({write("run.sumocfg",
                       "<configuration>\n<net-file> line.net.xml </net-file><route-files>line.rou.xml"
                       "</route-files>\n<end>10</end></configuration>")}));
    EXPECT_EQ(vehicles(), 5U);
}

TEST_F(SumoConfiguration, options_of_actuated_signals_and_rerouting_reach_every_run) {
    run(configured(cars(9),
                   "<tls.actuated.jam-threshold value='30'/><device.rerouting.adaptation-steps "
                   "value='18'/><weights.random-factor value='1.5'/>"));
    EXPECT_THAT(scenario::load((out() / "town").string()).measured->options,
                testing::ElementsAre("tls.actuated.jam-threshold=30", "device.rerouting.adaptation-steps=18",
                                     "weights.random-factor=1.5"));
    EXPECT_THAT(prepared().options, testing::SizeIs(3));
}

TEST_F(SumoConfiguration, all_options_that_shape_traffic_are_named) {
    const Findings findings =
        run(configured(cars(9),
                       "<max-depart-delay value='5'/><time-to-teleport value='60'/><lateral-resolution "
                       "value='1'/><step-length value='0.5'/><time-to-teleport.highways value='0'/><mesosim "
                       "value='off'/><delay value='9'/>"
                       "<tripinfo-output value='x'/>"));
    EXPECT_THAT(findings.left_out,
                Contains("2 options of the configuration that are not taken over (max-depart-delay = 5, "
                         "time-to-teleport.highways = 0)"));
    EXPECT_THAT(findings.changes, Contains(AllOf(HasSubstr("share lanes (lateral-resolution 1 m)"),
                                                 HasSubstr("--traffic-model sublane"))));
    const scenario::ScenarioConfig config = scenario::load((out() / "town").string());
    EXPECT_EQ(config.time.time_to_teleport_s, 60.0);
    EXPECT_EQ(config.time.step_length_s, 0.25);
    EXPECT_EQ(config.time.ignore_junction_blocker_s, scenario::usual_ignore_junction_blocker_s);
    EXPECT_THAT(findings.changes,
                Contains(AllOf(HasSubstr("steps of 0.25 s instead of 0.5 s; mean time loss"),
                               HasSubstr(" s at 0.5 s, "), HasSubstr(" s at 0.25 s; --step-length 0.5"))));
}

TEST_F(SumoConfiguration, fine_steps_and_no_teleports_are_taken_over) {
    const Findings findings = run(configured(cars(9),
                                             "<step-length value='0.1'/><time-to-teleport value='-1'/>"
                                             "<ignore-junction-blocker value='3'/>"));
    const scenario::ScenarioConfig config = scenario::load((out() / "town").string());
    EXPECT_EQ(config.time.step_length_s, 0.1);
    EXPECT_EQ(config.time.time_to_teleport_s, -1.0);
    EXPECT_EQ(config.time.ignore_junction_blocker_s, 3.0);
    EXPECT_THAT(findings.changes, Not(Contains(HasSubstr("steps of"))));
}

TEST_F(SumoConfiguration, booleans_of_a_configuration_are_read_as_sumo_reads_them) {
    const std::string bad = cars(3) + car("jumper", 5, "first side");
    for (const char* const no : {"off", "no", "False", "0", "f"})
        EXPECT_THAT(refusal(configured(bad, fmt::format("<ignore-route-errors value='{}'/>", no))),
                    HasSubstr("jumper"));
    run(configured(bad, "<ignore-route-errors value='On'/>"));
    EXPECT_EQ(vehicles(), 3U);
}

TEST_F(SumoConfiguration, a_second_network_and_an_end_before_the_begin_are_refused) {
    EXPECT_THAT(refusal(configured(cars(2), "<net-file value='line.net.xml'/>")),
                HasSubstr("is a second network"));
    EXPECT_THAT(refusal(configured(cars(2), "<begin value='600'/><end value='300'/>")),
                HasSubstr("ends at 300 s"));
}

}  // namespace
}  // namespace clearway::scenario_import
