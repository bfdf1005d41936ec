#include "scenario/incident.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "roads/closure.hpp"
#include "scenario/prepare.hpp"
#include "scratch.hpp"

namespace clearway::scenario {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A stub that leads to `main` (three lanes, 400 m) and to a way round it; nobody drives on `path`.
class IncidentTest : public ScratchTest {
  protected:
    void SetUp() override {
        ScratchTest::SetUp();
        write("line.nod.xml",
              "<nodes><node id=\"z\" x=\"-400\" y=\"0\"/><node id=\"s\" x=\"-200\" y=\"0\"/>"
              "<node id=\"a\" x=\"0\" y=\"0\"/><node id=\"b\" x=\"400\" y=\"0\"/>"
              "<node id=\"c\" x=\"800\" y=\"0\"/><node id=\"d\" x=\"400\" y=\"300\"/></nodes>");
        write("line.edg.xml",
              "<edges><edge id=\"stub\" from=\"z\" to=\"s\" speed=\"20\"/>"
              "<edge id=\"gate\" from=\"s\" to=\"a\" speed=\"20\"/>"
              "<edge id=\"main\" from=\"a\" to=\"b\" numLanes=\"3\" speed=\"20\">"
              "<lane index=\"0\" allow=\"pedestrian\"/></edge>"
              "<edge id=\"on\" from=\"b\" to=\"c\" speed=\"20\"/>"
              "<edge id=\"path\" from=\"b\" to=\"d\" speed=\"20\" allow=\"pedestrian\"/>"
              "<edge id=\"up\" from=\"a\" to=\"d\" speed=\"20\"/>"
              "<edge id=\"down\" from=\"d\" to=\"c\" speed=\"20\"/></edges>");
    }

    std::string file(const std::string& rest) const {
        return write("scenario.toml", std::string(line_head) +
                                          "[time]\nwarm_up_s = 10.0\nwindow_s = 60.0\nhorizon_s = 500.0\n" +
                                          rest)
            .string();
    }
    std::vector<PlacedIncident> placed(const std::string& rest, const Options& options = {}) const {
        const ScenarioConfig config = load(file(rest), options);
        return place_incidents(config, build_network(config, folder() / "net").network);
    }
    /// Where and what, without the path of the file.
    std::vector<std::string> wrong(const std::string& rest, const Options& options = {}) const {
        std::vector<std::string> lines;
        for (const core::Problem& problem : problems_of([&] { placed(rest, options); })) {
            EXPECT_FALSE(problem.allowed.empty()) << problem.what;
            const std::size_t at = problem.where.find("scenario.toml");
            lines.push_back(problem.where.substr(at == std::string::npos ? 0 : at + 14) + " " + problem.what);
        }
        return lines;
    }
};

TEST_F(IncidentTest, closes_the_lanes_for_cars_in_the_middle_until_the_end_by_default) {
    const auto incidents = placed("[[incident]]\nedge = \"main\"\n");
    ASSERT_THAT(incidents, SizeIs(1));
    EXPECT_THAT(incidents[0].closed.lanes, ElementsAre(1U, 2U));
    EXPECT_NEAR(incidents[0].closed.position_m, 200.0, 15.0);  // junctions take a little of the 400 m
    EXPECT_EQ(incidents[0].closed.from.value, 0.0);
    EXPECT_EQ(incidents[0].closed.to.value, 500.0);
    EXPECT_FALSE(incidents[0].closed.known_after);
    EXPECT_EQ(incidents[0].reroute_share, 0.0);
}

TEST_F(IncidentTest, every_key_is_read_and_written_back) {
    const std::string text =
        "[[incident]]\nedge = \"main\"\nlanes = \"2 1\"\nposition_m = 30.0\nfrom_s = 20.0\nto_s = 90.0\n"
        "known_after_s = 60.0\nspeed_past_kmh = 36.0\nemergency_passes = 1\nreroute_share = 0.4\n";
    const auto incidents = placed(text);
    ASSERT_THAT(incidents, SizeIs(1));
    EXPECT_THAT(incidents[0].closed.lanes, ElementsAre(1U, 2U));
    EXPECT_EQ(incidents[0].closed.position_m, 30.0F);
    EXPECT_EQ(incidents[0].closed.to.value, 90.0);
    EXPECT_EQ(incidents[0].closed.known_after->value, 60.0);
    EXPECT_FLOAT_EQ(incidents[0].closed.speed_past_mps, 10.0F);
    EXPECT_TRUE(incidents[0].closed.emergency_passes);
    EXPECT_EQ(incidents[0].reroute_share, 0.4);
    const ScenarioConfig config = load(file(text));
    store(config, folder() / "stored");
    EXPECT_EQ(configuration_hash(load((folder() / "stored").string())), configuration_hash(config));
}

TEST_F(IncidentTest, without_one_the_configuration_says_nothing_of_them) {
    EXPECT_EQ(to_toml(load(file(""))).find("incident"), std::string::npos);
    EXPECT_NE(configuration_hash(load(file(""))),
              configuration_hash(load(file("[[incident]]\nedge = \"on\"\n"))));
}

TEST_F(IncidentTest, an_override_replaces_those_of_the_file) {
    Options options;
    options.set("incident", "edge=on,from_s=20;edge=main,lanes=1 2,to_s=90");
    const auto incidents = placed("[[incident]]\nedge = \"stub\"\n", options);
    ASSERT_THAT(incidents, SizeIs(2));
    EXPECT_EQ(incidents[0].closed.from.value, 20.0);
    EXPECT_THAT(incidents[1].closed.lanes, ElementsAre(1U, 2U));
    options.set("incident", "none");
    EXPECT_THAT(placed("[[incident]]\nedge = \"stub\"\n", options), IsEmpty());
    options.set("incident", "edge=on,form_s=20");
    EXPECT_THAT(wrong("", options), ElementsAre("--incident form_s is unknown"));
    options.set("incident", "");
    EXPECT_THAT(wrong("[[incident]]\nedge = \"stub\"\n", options), ElementsAre("--incident is empty"));
    options.set("incident", "edge=nowhere");
    EXPECT_THAT(wrong("[[incident]]\nedge = \"stub\"\n", options),
                ElementsAre("--incident.edge the network has no edge \"nowhere\""));
}

TEST_F(IncidentTest, values_that_cannot_be_are_all_reported_with_their_place) {
    const auto found = wrong(
        "[[incident]]\nedge = \"main\"\nfrom_s = -1.0\nto_s = nan\nknown_after_s = -5.0\nreroute_share = "
        "1.5\n"
        "position_m = -2.0\nspeed_past_kmh = 500.0\nemergency_passes = 2\n");
    EXPECT_THAT(found, ElementsAre("16:1: incident[0].position_m -2 is out of range",
                                   "12:1: incident[0].from_s -1 is out of range",
                                   "13:1: incident[0].to_s nan is out of range",
                                   "14:1: incident[0].known_after_s -5 is out of range",
                                   "17:1: incident[0].speed_past_kmh 500 is out of range",
                                   "18:1: incident[0].emergency_passes 2 is out of range",
                                   "15:1: incident[0].reroute_share 1.5 is out of range"));
}

TEST_F(IncidentTest, what_follows_from_a_wrong_time_is_not_told_too) {
    EXPECT_THAT(wrong("[[incident]]\nedge = \"main\"\nfrom_s = -1.0\nto_s = 0.0\n"),
                ElementsAre("12:1: incident[0].from_s -1 is out of range"));
    EXPECT_THAT(wrong("[[incident]]\nedge = \"main\"\nfrom_s = 600.0\nto_s = -1.0\n"),
                ElementsAre("13:1: incident[0].to_s -1 is out of range",
                            "12:1: incident[0].from_s 600 is not before the end of the run"));
    Options options;
    options.set("incident", "edge=main,from_s=-1,to_s=0");
    EXPECT_THAT(wrong("", options), ElementsAre("--incident from_s -1 is out of range"));
}

TEST_F(IncidentTest, an_edge_that_is_no_text_is_told_once) {
    EXPECT_THAT(wrong("[[incident]]\nedge = 5\n"), ElementsAre("11:1: incident[0].edge is a number, 5"));
    EXPECT_THAT(wrong("[[incident]]\nedge = \"\"\n"), ElementsAre("11:1: incident[0].edge has no place"));
    EXPECT_THAT(wrong("[[emergency_site]]\nedge = 3\n"),
                ElementsAre("11:1: emergency_site[0].edge is a number, 3"));
}

TEST_F(IncidentTest, a_row_of_the_override_that_was_refused_is_told_once) {
    Options options;
    options.set("incident", "longitude=nan,latitude=52.43,from_s=10");
    EXPECT_THAT(wrong("", options), ElementsAre("--incident longitude nan is out of range"));
    options.set("incident", "longitude=200,latitude=95");
    EXPECT_THAT(wrong("", options), ElementsAre("--incident latitude 95 is out of range",
                                                "--incident longitude 200 is out of range"));
    options.set("incident", "edge=main,from_s=10,lanes=1;2");
    EXPECT_THAT(wrong("", options), SizeIs(1));
    options.set("incident", "from_s=10");
    EXPECT_THAT(wrong("", options), ElementsAre("--incident has no place"));
    EXPECT_THAT(wrong("[[incident]]\nfrom_s = -1\n"), SizeIs(2)) << "of a file, the place is missing, too";
}

TEST_F(IncidentTest, what_has_no_effect_is_refused) {
    EXPECT_THAT(wrong("[[incident]]\nedge = \"main\"\nlanes = \"2 1 2\"\n"),
                ElementsAre("12:1: incident[0].lanes names lane 2 twice"));
    const std::string known = "[[incident]]\nedge = \"on\"\nfrom_s = 20.0\nto_s = 90.0\nknown_after_s = ";
    EXPECT_THAT(wrong(known + "70.0\n"),
                ElementsAre("14:1: incident[0].known_after_s 70 is not before it is over"));
    EXPECT_THAT(placed(known + "69.0\n"), SizeIs(1));
}

TEST_F(IncidentTest, keys_that_contradict_each_other_are_refused) {
    const auto found = wrong(
        "[[incident]]\nfrom_s = 20.0\n[[incident]]\nedge = \"on\"\nlongitude = 1.0\nlatitude = 1.0\n"
        "[[incident]]\nlongitude = 1.0\n[[incident]]\nedge = \"on\"\nfrom_s = 90.0\nto_s = 90.0\n"
        "[[incident]]\nedge = \"on\"\nfrom_s = 500.0\n[[incident]]\nedge = \"on\"\nlanes = \"0 -1 x\"\n");
    EXPECT_THAT(found, ElementsAre("10:1: incident[0] has no place",
                                   "12:1: incident[1] has an edge, and coordinates besides",
                                   "16:1: incident[2] has but one of longitude and latitude",
                                   "21:1: incident[3].to_s 90 is not after from_s, 90",
                                   "24:1: incident[4].from_s 500 is not before the end of the run",
                                   "27:1: incident[5].lanes \"-1\" is no number of a lane",
                                   "27:1: incident[5].lanes \"x\" is no number of a lane"));
}

TEST_F(IncidentTest, places_that_the_network_does_not_have_are_refused) {
    const auto found = wrong(
        "[[incident]]\nedge = \"mian\"\n[[incident]]\nlongitude = 13.0\nlatitude = 52.0\n"
        "[[incident]]\nedge = \"path\"\n[[incident]]\nedge = \"main\"\nlanes = \"1 3\"\n"
        "[[incident]]\nedge = \"main\"\nlanes = \"0\"\n[[incident]]\nedge = \"on\"\nposition_m = 401.0\n");
    EXPECT_THAT(found,
                ElementsAre("11:1: incident[0].edge the network has no edge \"mian\"",
                            "13:1: incident[1].longitude the network has no projection that Clearway knows",
                            "16:1: incident[2].edge no emergency vehicle may use edge \"path\"",
                            "19:1: incident[3].lanes edge \"main\" has no lane 3",
                            "22:1: incident[4].lanes neither cars nor EVs may use lane 0 of edge \"main\"",
                            AllOf(HasSubstr("25:1: incident[5].position_m"),
                                  HasSubstr("401 is beyond the end of edge \"on\""))));
    const auto problems = problems_of([&] { placed("[[incident]]\nedge = \"mian\"\n"); });
    EXPECT_THAT(problems[0].cure, HasSubstr("'main'"));
    // Coordinates are no cure here.
    EXPECT_EQ(problems_of([&] { placed("[[incident]]\nedge = \"nowhere\"\n"); })[0].cure, "");
    EXPECT_THAT(problems_of([&] {
                    const ScenarioConfig city = load("city", Options().set("incident", "edge=nowhere"));
                    place_incidents(city, build_network(city, folder() / "city").network);
                })[0]
                    .cure,
                HasSubstr("longitude and latitude"));
}

TEST_F(IncidentTest, a_limit_at_which_nobody_moves_is_refused) {
    EXPECT_THAT(wrong("[[incident]]\nedge = \"on\"\nspeed_past_kmh = 0.5\n"),
                ElementsAre("12:1: incident[0].speed_past_kmh 0.5 km/h is a standstill"));
    const std::string lane = "[[incident]]\nedge = \"main\"\nspeed_past_kmh = 1\n";
    EXPECT_THAT(placed(lane + "lanes = \"1\"\n"), SizeIs(1));
    EXPECT_THAT(wrong(lane), ElementsAre("12:1: incident[0].speed_past_kmh 1 km/h, but no lane stays open"));
    EXPECT_THAT(placed(lane + "emergency_passes = 1\n"), SizeIs(1));
}

TEST_F(IncidentTest, two_on_one_lane_at_a_time_are_refused) {
    const std::string first = "[[incident]]\nedge = \"main\"\nlanes = \"1\"\nfrom_s = 20.0\nto_s = 90.0\n";
    EXPECT_THAT(wrong(first + "[[incident]]\nedge = \"main\"\nfrom_s = 89.0\n"),
                ElementsAre("15:1: incident[1] blocks lane 1 of edge \"main\" while incident[0] does, too"));
    EXPECT_THAT(placed(first + "[[incident]]\nedge = \"main\"\nfrom_s = 90.0\n"), SizeIs(2));
    EXPECT_THAT(placed(first + "[[incident]]\nedge = \"main\"\nlanes = \"2\"\n"), SizeIs(2));
}

TEST_F(IncidentTest, the_only_way_out_of_a_start_must_stay_open) {
    const std::string trip = "[[emergency_trip]]\nfrom = \"stub\"\nto = \"on\"\ndepart_s = 100.0\n";
    const std::string gate = "[[incident]]\nedge = \"gate\"\n";
    EXPECT_THAT(wrong(trip + gate), ElementsAre("14:1: incident[0] closes edge \"gate\", the only way out of "
                                                "emergency_trip[0] at \"stub\""));
    EXPECT_THAT(
        wrong("[demand]\nemergency = 1\n[[emergency_site]]\nkind = \"fire_station\"\nedge = \"gate\"\n" +
              gate),
        SizeIs(1));
    const std::string half = "share = 0.5\nfrom = \"stub\"\nto = \"on\"\n";
    EXPECT_THAT(wrong("[demand]\nemergency = 1\n[[flow]]\n" + half + "[[flow]]\n" + half + gate), SizeIs(1));
    // Over before the EV comes, open to EVs, or with a way round it.
    EXPECT_THAT(placed(trip + gate + "to_s = 90.0\n"), SizeIs(1));
    EXPECT_THAT(placed(trip + gate + "emergency_passes = 1\n"), SizeIs(1));
    EXPECT_THAT(placed(trip + "[[incident]]\nedge = \"main\"\n"), SizeIs(1));
}

TEST_F(IncidentTest, incidents_that_close_the_only_way_out_together_are_refused) {
    const std::string trip = "[[emergency_trip]]\nfrom = \"gate\"\nto = \"on\"\ndepart_s = 100.0\n";
    const std::string up = "[[incident]]\nedge = \"up\"\nto_s = 300.0\n";
    const std::string main = "[[incident]]\nedge = \"main\"\nlanes = ";
    const std::string from = "from_s = 50.0\n";
    EXPECT_THAT(
        wrong(trip + up + main + "\"1\"\n" + from + main + "\"2\"\n" + from),
        ElementsAre("14:1: incident[0] closes edges \"main\", \"up\", with incident[1], incident[2], the "
                    "only way out of emergency_trip[0] at \"gate\""));
    // A lane stays open, one is over before the other begins, or EVs pass.
    EXPECT_THAT(placed(trip + up + main + "\"1\"\n" + from), SizeIs(2));
    EXPECT_THAT(placed(trip + up + main + "\"1 2\"\nfrom_s = 300.0\n"), SizeIs(2));
    EXPECT_THAT(placed(trip + up + main + "\"1 2\"\nemergency_passes = 1\n"), SizeIs(2));
}

TEST_F(IncidentTest, coordinates_find_the_nearest_road_for_cars) {
    Options options;
    options.set("incident", "longitude=13.53,latitude=52.431");
    const ScenarioConfig config = load("city", options);
    const BuiltNetwork built = build_network(config, folder() / "net");
    const auto incidents = place_incidents(config, built.network);
    ASSERT_THAT(incidents, SizeIs(1));
    EXPECT_FALSE(incidents[0].closed.lanes.empty());
    // The same edge by its name; there at the place of the coordinates rather than in the middle.
    options.set("incident", "edge=" + built.network.edge(incidents[0].closed.edge).id +
                                fmt::format(",position_m={}", incidents[0].closed.position_m));
    const auto again = place_incidents(load("city", options), built.network);
    EXPECT_EQ(again[0].closed.edge, incidents[0].closed.edge);
    EXPECT_EQ(again[0].closed.lanes, incidents[0].closed.lanes);

    options.set("incident", "longitude=52.43,latitude=13.5");
    const auto problems = problems_of([&] { place_incidents(load("city", options), built.network); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].what, HasSubstr("no road open to cars"));
    EXPECT_THAT(problems[0].allowed, HasSubstr("longitude 13."));
}

TEST_F(IncidentTest, closes_to_emergency_unless_a_lane_stays_open_or_they_may_pass) {
    const ScenarioConfig config = load(file(""));
    const BuiltNetwork built = build_network(config, folder() / "net");
    traffic::Incident incident;
    incident.edge = *built.network.find_edge("main");
    incident.lanes = {1};
    EXPECT_FALSE(roads::closes_to_emergency(built.network, incident));
    incident.lanes = {1, 2};
    EXPECT_TRUE(roads::closes_to_emergency(built.network, incident));
    EXPECT_TRUE(roads::known(built.network, incident).closed_to_emergency);
    incident.emergency_passes = true;
    EXPECT_FALSE(roads::closes_to_emergency(built.network, incident));
}

TEST_F(IncidentTest, is_prepared_with_the_demand_which_stays_the_same) {
    const std::string demand = "[demand]\nhuman = 3\n[[flow]]\nfrom = \"stub\"\nto = \"on\"\n";
    const auto prepared = [&](const std::string& rest) {
        const ScenarioConfig config = load(file(rest));
        return prepare(config, build_network(config, folder() / "net"), core::StudySeed{1},
                       core::Replication{0}, folder() / "demand");
    };
    const Prepared with = prepared(demand + "[[incident]]\nedge = \"main\"\n");
    EXPECT_THAT(with.incidents, SizeIs(1));
    EXPECT_EQ(with.demand_hash, prepared(demand).demand_hash);
}

}  // namespace
}  // namespace clearway::scenario
