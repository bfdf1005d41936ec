#include "scenario/call.hpp"

#include <set>

#include <gmock/gmock.h>

#include "scenario/called_scenario.hpp"
#include "scenario/fleet.hpp"
#include "scenario/prepare.hpp"
#include "scratch.hpp"

namespace clearway::scenario {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class CallTest : public ScratchTest {
  protected:
    void SetUp() override {
        ScratchTest::SetUp();
        write_called_roads(
            [&](const std::string& name, const std::string& text) { return write(name, text); });
    }
    Prepared prepared(const std::string& rest, const std::string& head = called_head,
                      std::uint32_t replication = 0) const {
        const ScenarioConfig config = load(write("scenario.toml", head + rest).string());
        return prepare(config, build_network(config, folder() / "net"), core::StudySeed{1},
                       core::Replication{replication}, folder() / "demand");
    }
    std::vector<std::string> wrong(const std::string& rest, const std::string& head = called_head) const {
        std::vector<std::string> lines;
        for (const core::Problem& problem : problems_of([&] { prepared(rest, head); })) {
            EXPECT_FALSE(problem.allowed.empty()) << problem.what;
            EXPECT_THAT(problem.where, HasSubstr("scenario.toml:"));
            const std::size_t name = problem.where.find(": ");
            lines.push_back(problem.where.substr(name == std::string::npos ? 0 : name + 2) + " " +
                            problem.what);
        }
        return lines;
    }
};

TEST_F(CallTest, vehicles_are_planned_from_the_stations_that_are_nearest_by_free_flow) {
    const Prepared planned = prepared(
        "[[call]]\nedge = \"place\"\nposition_m = 200.0\nat_s = 100.0\nunits = 2\nturnout_s = 30.0\n");
    ASSERT_THAT(planned.emergency, SizeIs(2));
    EXPECT_EQ(planned.emergency[0].id, "emergency.call.0.0");
    EXPECT_EQ(planned.emergency[0].depart.value, 130.0);
    EXPECT_EQ(planned.emergency[0].arrival->value, 200.0);
    EXPECT_TRUE(planned.emergency[0].is_called);
    EXPECT_THAT(planned.emergency[0].edges, ElementsAre("west", "straight", "place"));
    // West had one unit.
    EXPECT_THAT(planned.emergency[1].edges, ElementsAre("east", "detour", "back", "place"));
    EXPECT_EQ(planned.calls.stations.size(), 2U);
}

TEST_F(CallTest, every_key_is_read_and_written_back) {
    const std::string text =
        "[[call]]\nedge = \"place\"\nposition_m = 30.0\nat_s = 20.0\nspread_s = 40.0\nunits = 3\n"
        "kind = \"ambulance\"\nturnout_s = 5.0\n";
    prepared(text);
    const ScenarioConfig config = load((folder() / "scenario.toml").string());
    store(config, folder() / "stored");
    const ScenarioConfig again = load((folder() / "stored").string());
    EXPECT_EQ(configuration_hash(again), configuration_hash(config));
    EXPECT_EQ(again.calls.at(0).units, 3);
    EXPECT_EQ(again.calls.at(0).spread_s, 40.0);
    EXPECT_EQ(again.emergency_sites.at(1).units, 2);
    EXPECT_FALSE(again.emergency_sites.at(0).units.has_value());
}

TEST_F(CallTest, come_in_later_by_the_seed) {
    const std::string text =
        "[[call]]\nedge = \"place\"\nat_s = 100.0\nspread_s = 60.0\nturnout_s = 5.0\n"
        "[[call]]\nedge = \"place\"\nat_s = 130.0\nturnout_s = 5.0\n";
    std::set<double> times;
    bool is_second = false, is_first = false;
    for (std::uint32_t replication = 0; replication < 20; ++replication) {
        const Calls calls = prepared(text, called_head, replication).calls;
        ASSERT_THAT(calls.calls, SizeIs(2));
        EXPECT_LE(calls.calls[0].at.value, calls.calls[1].at.value);
        const bool is_before = calls.calls[0].id == "emergency.call.0";
        const double at_s = calls.calls[is_before ? 0 : 1].at.value;
        EXPECT_TRUE(at_s >= 100.0 && at_s < 160.0) << at_s;
        EXPECT_EQ(calls.calls[is_before ? 1 : 0].at.value, 130.0);
        EXPECT_EQ(prepared(text, called_head, replication).calls.calls[0].at.value, calls.calls[0].at.value);
        times.insert(at_s);
        (is_before ? is_first : is_second) = true;
    }
    EXPECT_THAT(times, SizeIs(20));
    EXPECT_TRUE(is_first && is_second);
    EXPECT_THAT(
        wrong("[[call]]\nedge = \"place\"\nat_s = 500.0\nspread_s = 40.0\n"),
        ElementsAre("call[0].at_s 500, spread_s, 40, and turnout_s, 60, are not before the end of the run"));
    // An incident that begins while the vehicle may leave.
    EXPECT_THAT(wrong("[[incident]]\nedge = \"straight\"\nfrom_s = 140.0\n" + text), SizeIs(1));
}

TEST_F(CallTest, events_of_a_scenario_come_later_together_by_the_seed) {
    std::string head = called_head;
    head.replace(head.find("[time]\n"), 7, "[time]\nevents_spread_s = 50.0\n");
    const std::string events =
        "[[incident]]\nedge = \"detour\"\nfrom_s = 300.0\nto_s = 400.0\n"
        "[[emergency_trip]]\nfrom = \"west\"\nto = \"place\"\ndepart_s = 100.0\n"
        "[[call]]\nedge = \"place\"\nat_s = 150.0\nturnout_s = 5.0\n";
    std::set<double> delays;
    for (std::uint32_t replication = 0; replication < 10; ++replication) {
        const Prepared planned = prepared(events, head, replication);
        ASSERT_THAT(planned.emergency, SizeIs(2));
        const double delay_s = planned.emergency[0].depart.value - 100.0;
        EXPECT_TRUE(delay_s >= 0.0 && delay_s < 50.0) << delay_s;
        EXPECT_NEAR(planned.emergency[1].depart.value, 155.0 + delay_s, 1e-9);
        EXPECT_NEAR(planned.calls.calls.at(0).at.value, 150.0 + delay_s, 1e-9);
        EXPECT_NEAR(planned.incidents.at(0).closed.from.value, 300.0 + delay_s, 1e-9);
        EXPECT_NEAR(planned.incidents.at(0).closed.to.value, 400.0 + delay_s, 1e-9);
        delays.insert(delay_s);
    }
    EXPECT_THAT(delays, SizeIs(10));

    EXPECT_THAT(
        wrong("[[call]]\nedge = \"place\"\nat_s = 500.0\n", head),
        ElementsAre("call[0].at_s 500, time.events_spread_s, 50, and turnout_s, 60, are not before the "
                    "end of the run"));
    EXPECT_THAT(wrong("[[incident]]\nedge = \"detour\"\nfrom_s = 550.0\n", head),
                Contains("incident[0].from_s 550 is not before the end of the run"));
    EXPECT_THAT(wrong("[[emergency_trip]]\nfrom = \"west\"\nto = \"place\"\ndepart_s = 560.0\n", head),
                Contains("emergency_trip[0].depart_s 560 is after the horizon"));
}

TEST_F(CallTest, without_one_sites_and_configuration_are_as_they_were) {
    EXPECT_EQ(to_toml(load("city")).find("[[call]]"), std::string::npos);
    EmergencySite site;
    EXPECT_EQ(site.ready(), 0) << "a hospital";
    site.kind = SiteKind::fire_station;
    EXPECT_EQ(site.ready(), 1);
}

TEST_F(CallTest, a_call_to_an_incident_ends_before_it_when_it_is_known) {
    const Prepared planned = prepared(
        "[[incident]]\nedge = \"place\"\nposition_m = 300.0\nfrom_s = 50.0\nknown_after_s = 20.0\n"
        "[[call]]\nincident = 0\n");
    ASSERT_THAT(planned.calls.calls, SizeIs(1));
    EXPECT_EQ(planned.calls.calls[0].at.value, 70.0);
    EXPECT_EQ(planned.calls.calls[0].position_m, 290.0F);
    EXPECT_TRUE(planned.calls.calls[0].before_incident);
}

TEST_F(CallTest, contradicting_and_missing_keys_are_all_reported) {
    EXPECT_THAT(wrong("[[call]]\nat_s = 100.0\n"
                      "[[call]]\nedge = \"place\"\nincident = 0\nat_s = 100.0\n"
                      "[[call]]\nlongitude = 1.0\nat_s = 100.0\n"
                      "[[call]]\nedge = \"place\"\n"
                      "[[call]]\nedge = \"place\"\nat_s = 5.0\n"
                      "[[call]]\nedge = \"place\"\nat_s = 590.0\n"
                      "[[call]]\nedge = \"place\"\nat_s = 100.0\nkind = \"ambulanse\"\n"),
                AllOf(SizeIs(9),
                      ElementsAre("call[0] has no place", "call[1] has more than one place",
                                  "call[1].incident there is no incident 0",
                                  "call[2] has but one of longitude and latitude",
                                  "call[3].at_s is not given", "call[4].at_s 5 is before the warm-up ends",
                                  "call[5].at_s 590 and turnout_s, 60, are not before the end of the run",
                                  "call[6].kind no site sends out \"ambulanse\"",
                                  "call[3] 6 units of kind ambulance are called, and 3 wait at all sites")));
}

TEST_F(CallTest, a_time_that_is_given_and_wrong_is_not_missing_too) {
    EXPECT_THAT(wrong("[[call]]\nedge = \"place\"\nat_s = -5.0\n"),
                ElementsAre("call[0].at_s -5 is out of range"));
}

TEST_F(CallTest, what_follows_from_a_wrong_number_is_not_told_too) {
    EXPECT_THAT(wrong("[[call]]\nedge = \"place\"\nat_s = 590.0\nturnout_s = -5.0\n"),
                ElementsAre("call[0].turnout_s -5 is out of range"));
    const std::string call = "[[call]]\nincident = 0\n";
    EXPECT_THAT(wrong("[[incident]]\nedge = \"place\"\nfrom_s = 50.0\nknown_after_s = -5.0\n" + call),
                ElementsAre("incident[0].known_after_s -5 is out of range"));
    EXPECT_THAT(wrong("[[incident]]\nedge = \"place\"\nfrom_s = -5.0\nknown_after_s = 5.0\n" + call),
                ElementsAre("incident[0].from_s -5 is out of range"));
    EXPECT_THAT(wrong("[[incident]]\nedge = \"place\"\nfrom_s = \"x\"\nknown_after_s = 5.0\n" + call),
                ElementsAre("incident[0].from_s is text, \"x\""));
    EXPECT_THAT(wrong("[[call]]\nincident = -1\n"), ElementsAre("call[0].incident -1 is negative"));
    EXPECT_THAT(wrong("[[call]]\nincident = 3\n"), ElementsAre("call[0].incident there is no incident 3"));
    EXPECT_THAT(wrong("[[call]]\nedge = 3\nat_s = 100.0\n"), ElementsAre("call[0].edge is a number, 3"));
    const std::string engines = "[[call]]\nedge = \"place\"\nat_s = 100.0\nkind = \"fire_engine\"\nunits = ";
    EXPECT_THAT(wrong(engines + "\"two\"\n"), ElementsAre("call[0].units is text, \"two\""));
    EXPECT_THAT(wrong("[[emergency_site]]\nkind = \"fire_station\"\nedge = \"place\"\nunits = 3.5\n" +
                      engines + "3\n"),
                ElementsAre("emergency_site[2].units is a number, 3.5"));
    EXPECT_THAT(wrong("[[call]]\nedge = \"place\"\nat_s = 100.0\nunits = 9\nkind = 5\n"),
                ElementsAre("call[0].kind is a number, 5"));
    std::string head = called_head;
    head.replace(head.find("horizon_s = 600.0"), 17, "horizon_s = -600.0");
    EXPECT_THAT(wrong("[[call]]\nedge = \"place\"\nat_s = 100000.0\n", head),
                ElementsAre("time.horizon_s -600 is out of range"));
}

TEST_F(CallTest, to_an_incident_must_come_before_it_is_over) {
    const std::string incident = "[[incident]]\nedge = \"place\"\nfrom_s = 50.0\nto_s = 200.0\n";
    EXPECT_THAT(wrong(incident + "[[call]]\nincident = 0\nat_s = 200.0\n"),
                ElementsAre("call[0].at_s 200 is not before incident[0] is over"));
    EXPECT_THAT(prepared(incident + "[[call]]\nincident = 0\nat_s = 199.0\n").emergency, SizeIs(1));
}

TEST_F(CallTest, says_that_the_override_removed_its_incident) {
    const std::string text =
        std::string(called_head) + "[[incident]]\nedge = \"place\"\n[[call]]\nincident = 0\nat_s = 100.0\n";
    const std::string file = write("scenario.toml", text).string();
    const auto problems = problems_of([&] { load(file, Options().set("incident", "none")); });
    ASSERT_THAT(problems, SizeIs(1));
    EXPECT_THAT(problems[0].cure, HasSubstr("the override incident removes those of the file"));
}

TEST_F(CallTest, places_that_cannot_be_reached_are_refused) {
    EXPECT_THAT(wrong("[[call]]\nedge = \"plaec\"\nat_s = 100.0\n"),
                ElementsAre("call[0].edge the network has no edge \"plaec\""));
    EXPECT_THAT(wrong("[[call]]\nedge = \"island\"\nat_s = 100.0\n"),
                ElementsAre("call[0] no station of its kind leads to edge \"island\""));
    EXPECT_THAT(wrong("[[call]]\nedge = \"place\"\nposition_m = 900.0\nat_s = 100.0\n"),
                ElementsAre("call[0].position_m 900 is beyond the end of edge \"place\""));
    EXPECT_THAT(wrong("[[incident]]\nedge = \"place\"\nposition_m = 100.0\n"
                      "[[call]]\nedge = \"place\"\nposition_m = 200.0\nat_s = 100.0\n"),
                ElementsAre("call[0].position_m 200 lies behind incident[0] on edge \"place\""));
}

TEST_F(CallTest, a_call_without_a_station_of_its_kind_is_refused) {
    EXPECT_THAT(wrong("[[call]]\nedge = \"place\"\nat_s = 100.0\nkind = \"fire_engine\"\n"),
                ElementsAre("call[0] 1 unit of kind fire_engine is called, and 0 wait at all sites"));
    EXPECT_THAT(wrong("[[emergency_site]]\nkind = \"fire_station\"\nedge = \"nowhere\"\n"
                      "[[call]]\nedge = \"place\"\nat_s = 100.0\n"),
                ElementsAre("emergency_site[2].edge the network has no edge \"nowhere\""));
}

TEST_F(CallTest, the_only_way_out_of_a_station_that_is_called_must_stay_open) {
    const std::string closed = "[[incident]]\nedge = \"straight\"\n";
    EXPECT_THAT(wrong(closed + "[[call]]\nedge = \"place\"\nat_s = 100.0\n"),
                ElementsAre("incident[0] closes edge \"straight\", the only way out of emergency_site[0] at "
                            "\"west\""));
    EXPECT_THAT(prepared(closed + "to_s = 90.0\n[[call]]\nedge = \"place\"\nat_s = 100.0\n").emergency,
                SizeIs(1));
}

TEST(Fleet, SendsEachUnitOnce) {
    Fleet fleet({{core::EdgeIndex{3}, traffic::VehicleKind::ambulance, 1}});
    const PlacedCall call;
    PlacedCall fire;
    fire.kind = traffic::VehicleKind::fire_engine;
    EXPECT_TRUE(fleet.can_answer(0, call));
    EXPECT_FALSE(fleet.can_answer(0, fire));
    fleet.send_from(0);
    EXPECT_FALSE(fleet.can_answer(0, call));
    EXPECT_EQ(cheapest({}), nullptr);
}

}  // namespace
}  // namespace clearway::scenario
