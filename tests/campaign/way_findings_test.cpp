#include "campaign/detail/way_findings.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "campaign/detail/lock_findings.hpp"
#include "scenario/network.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::campaign::detail {
namespace {

using testing::HasSubstr;

/// From `gate` to `goal` on `main` or a little farther on `up` and `down`; `far` can be reached by `main`
/// alone.
class WayFindings : public testing::Test {
  protected:
    std::vector<Finding> findings(const std::string& incidents, const std::string& more = "") const {
        const Roads way = roads(incidents);
        return way_findings(way.config, way.built.network,
                            emergency_trips_in("id,type,kind,depart_s,depart_lane,depart_speed,edges\n"
                                               "one,t,ambulance,60.00,best,max,gate main goal\n"
                                               "two,t,ambulance,60.00,best,max,gate far\n" +
                                               more));
    }

    /// Of the incidents, judged by one run and the trips of more seeds.
    Finding cut_off(const std::string& incidents, const std::vector<EmergencyTrip>& run,
                    const std::vector<EmergencyTrip>& more) const {
        const Roads way = roads(incidents);
        return way_findings(way.config, way.built.network, run, more)[1];
    }

    Finding passing(const std::string& incident, const std::vector<EmergencyTrip>& trips) const {
        const Roads way = roads("[[incident]]\n" + incident);
        return passing_finding(way.config, way.built.network, trips, 2);
    }

    std::map<std::string, std::string> queueing(const std::string& incident,
                                                const std::vector<EmergencyTrip>& trips) const {
        const Roads way = roads("[[incident]]\n" + incident);
        return queueing_trips(way.config, way.built.network, trips);
    }

    /// 400 vehicles, some of them in locks.
    Finding locks(std::uint64_t locked, std::uint64_t emergency, const std::string& time = "") const {
        const Roads way = roads(time);
        results::RunRecord record;
        record.provenance.study_seed = 3;
        record.metrics.vehicle_count = 400;
        record.metrics.simulated_s = 900.0;
        record.metrics.locked_vehicles = locked;
        record.metrics.locked_emergency_vehicles = emergency;
        record.metrics.longest_lock_s = 90.0;
        const std::vector<metrics::LockRow> rows = {
            {"gate", "a", 0.0, 90.0, 1, 0}, {"main", "b", 0.0, 70.0, 1, 0}, {"main", "b", 200.0, 70.0, 1, 0}};
        record.metrics.locks = locked == 0 ? 0 : rows.size();
        return locks_finding(record, rows, {way.config, way.built.network, {}}, "--density 0.80");
    }

  private:
    struct Roads {
        scenario::ScenarioConfig config;
        scenario::BuiltNetwork built;
    };
    Roads roads(const std::string& incidents) const {
        folder_.write("way.nod.xml",
                      "<nodes><node id=\"s\" x=\"-200\" y=\"0\"/><node id=\"a\" x=\"0\" y=\"0\"/>"
                      "<node id=\"b\" x=\"400\" y=\"0\"/><node id=\"c\" x=\"800\" y=\"0\"/>"
                      "<node id=\"d\" x=\"200\" y=\"60\"/><node id=\"e\" x=\"400\" y=\"-300\"/></nodes>");
        folder_.write("way.edg.xml",
                      "<edges><edge id=\"gate\" from=\"s\" to=\"a\" speed=\"20\"/>"
                      "<edge id=\"main\" from=\"a\" to=\"b\" speed=\"20\"/>"
                      "<edge id=\"up\" from=\"a\" to=\"d\" speed=\"20\"/>"
                      "<edge id=\"down\" from=\"d\" to=\"b\" speed=\"20\"/>"
                      "<edge id=\"goal\" from=\"b\" to=\"c\" speed=\"20\"/>"
                      "<edge id=\"wide\" from=\"c\" to=\"d\" numLanes=\"2\"/>"
                      "<edge id=\"far\" from=\"a\" to=\"e\" speed=\"20\"/></edges>");
        const auto file =
            folder_.write("scenario.toml",
                          "name = \"way\"\nversion = \"test\"\n[network]\nnodes = \"way.nod.xml\"\n"
                          "edges = \"way.edg.xml\"\n[time]\nhorizon_s = 900.0\n" +
                              incidents);
        scenario::ScenarioConfig config = scenario::load(file.string());
        scenario::BuiltNetwork built = scenario::build_network(config, folder_.path() / "net");
        return {std::move(config), std::move(built)};
    }

    support::TemporaryFolder folder_;
};

TEST_F(WayFindings, say_how_many_pass_a_block_and_where_more_would) {
    const std::vector<EmergencyTrip> ways = {{"a", {"gate", "main", "goal"}},
                                             {"b", {"gate", "main", "goal"}},
                                             {"c", {"gate", "up", "down", "goal"}}};
    const Finding some = passing("edge = \"main\"\n", ways);
    EXPECT_EQ(some.text, "2 of 3 EV trips of 2 seeds pass a blocked road");
    EXPECT_EQ(some.grade, Grade::ok);
    const Finding none = passing("edge = \"far\"\n", ways);
    EXPECT_EQ(none.text, "0 of 3 EV trips of 2 seeds pass a blocked road");
    EXPECT_EQ(none.grade, Grade::note);
    EXPECT_EQ(none.advice,
              "most pass, near their middles, with a way round: edge main, 2 trips; edge down, 1 trip");
    const Finding called = passing("edge = \"goal\"\n", {{"a", {"gate", "far"}}});
    EXPECT_EQ(called.advice, "no road in the middle of an EV trip has a way round");
}

TEST_F(WayFindings, count_a_trip_only_while_the_block_lasts) {
    // 1000 m at 20 m/s: on the road for 50 s at free flow, for 320 s at the very most.
    const std::vector<EmergencyTrip> ways = {{"a", {"gate", "main", "goal"}, 100.0}};
    const std::string main = "edge = \"main\"\n";
    EXPECT_THAT(passing(main + "from_s = 340.0\n", ways).text, HasSubstr("1 of 1"));
    const Finding later = passing(main + "from_s = 440.0\n", ways);
    EXPECT_THAT(later.text, HasSubstr("0 of 1"));
    EXPECT_EQ(later.advice, "other times: no EV is on the road while an incident lasts");
    EXPECT_THAT(passing(main + "to_s = 90.0\n", ways).text, HasSubstr("0 of 1"));

    const std::vector<EmergencyTrip> far = {{"one", {"gate", "far"}, 100.0}};
    const std::string block = "[[incident]]\nedge = \"far\"\n";
    EXPECT_EQ(cut_off(block + "to_s = 110.0\n", {}, far).grade, Grade::falls_short);
    EXPECT_EQ(cut_off(block + "to_s = 90.0\n", {}, far).grade, Grade::ok);
    EXPECT_EQ(cut_off(block + "from_s = 600.0\n", {}, far).grade, Grade::ok);
}

TEST_F(WayFindings, say_that_those_who_are_called_to_a_closed_road_may_end_in_the_queue) {
    const std::vector<EmergencyTrip> called = {
        {"emergency.call.0.0 in replication 0", {"gate", "far"}, 100.0},
        {"emergency.call.1.0 in replication 0", {"gate", "main"}, 100.0}};
    const Finding found = passing("edge = \"far\"\nto_s = 250.0\n", called);
    EXPECT_EQ(found.text,
              "0 of 2 EV trips of 2 seeds pass a blocked road; 1 of them is called to edge far, closed until "
              "250 s: if a queue stands before it, they end there");
    EXPECT_EQ(found.grade, Grade::note);
    EXPECT_EQ(found.advice, queueing_cure);
    EXPECT_THAT(queueing("edge = \"far\"\n", called),
                testing::ElementsAre(
                    std::pair("emergency.call.0.0 in replication 0", "edge far, closed until 900 s")));
    EXPECT_THAT(queueing("edge = \"far\"\nto_s = 90.0\n", called), testing::IsEmpty());
    EXPECT_THAT(queueing("edge = \"far\"\nemergency_passes = 1\n", called), testing::IsEmpty());
}

TEST_F(WayFindings, say_whether_a_call_has_a_choice_of_stations) {
    const std::string station = "[[emergency_site]]\nkind = \"ambulance_station\"\nunits = 2\nedge = ";
    const std::string call = "[[call]]\nedge = \"goal\"\nat_s = 100.0\n";
    const Finding one = findings(station + "\"gate\"\n" + call)[1];
    EXPECT_EQ(one.text, "1 call, 1 station; no call has two stations of its kind to choose from");
    EXPECT_EQ(one.grade, Grade::note);
    EXPECT_THAT(one.advice, HasSubstr("loop.units_tried"));
    const Finding two = findings(station + "\"gate\"\n" + station + "\"main\"\n" + call)[1];
    EXPECT_EQ(two.text,
              "1 call, 2 stations; the nearest in a straight line is not the first at free flow for none of "
              "them");
    EXPECT_EQ(two.grade, Grade::ok);
}

TEST_F(WayFindings, count_those_who_can_choose) {
    const auto found = findings("");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].text,
              "1 of 2 EVs can choose: two ways or more within 20 % of the fastest at free flow");
}

TEST_F(WayFindings, say_where_a_run_locked_and_what_to_try) {
    EXPECT_EQ(locks(0, 0).grade, Grade::ok);
    EXPECT_THAT(locks(0, 0).text, HasSubstr("none in this run of seed 3, 900 s; other seeds may lock"));
    const Finding some = locks(4, 0);
    EXPECT_EQ(some.grade, Grade::note);
    EXPECT_EQ(some.text,
              "3 locks in this run of seed 3, the longest 90 s; 4 vehicles stood in them: 2 at edge main, "
              "junction b, 1 at edge gate, junction a");
    EXPECT_THAT(some.advice, HasSubstr("--ignore-junction-blocker 10"));
    const std::string on =
        "ignore_junction_blocker_s = 10.0\n";  // in the table [time] that the file ends with
    EXPECT_THAT(locks(4, 0, on).advice, HasSubstr("--density 0.80"));
    EXPECT_EQ(locks(5, 0).grade, Grade::falls_short) << "more than one vehicle in a hundred";
    EXPECT_EQ(locks(1, 1).grade, Grade::falls_short) << "an EV";
}

TEST(SiteFindings, name_the_road_of_coordinates) {
    scenario::ScenarioConfig config = scenario::load("city");
    scenario::EmergencySite& site = config.emergency_sites.emplace_back();
    site.kind = scenario::SiteKind::fire_station;
    site.name = "New post";
    site.longitude = 13.53;
    site.latitude = 52.431;
    const support::TemporaryFolder folder;
    const scenario::BuiltNetwork built = scenario::build_network(config, folder.path());
    const auto found = way_findings(config, built.network, {});
    const auto sites = std::ranges::find(found, "sites", &Finding::name);
    ASSERT_NE(sites, found.end());
    EXPECT_THAT(sites->text,
                testing::MatchesRegex("by coordinates: fire_station \"New post\" on .*\\(?edge [^ ]+\\)?, "
                                      "[0-9]+ m from the coordinates"));
    EXPECT_EQ(sites->grade, Grade::ok);
}

TEST(SiteFindings, note_a_site_far_from_its_road) {
    scenario::ScenarioConfig config = scenario::load("city");
    scenario::EmergencySite& site = config.emergency_sites.emplace_back();
    site.longitude = 13.53;
    const support::TemporaryFolder folder;
    const scenario::BuiltNetwork built = scenario::build_network(config, folder.path());
    const auto found_at = [&](double latitude) {
        site.latitude = latitude;
        const auto found = way_findings(config, built.network, {});
        return *std::ranges::find(found, "sites", &Finding::name);
    };
    bool noted = false;  // a road is near in most of the city: look for a place without one
    for (double latitude = 52.431; latitude < 52.437 && !noted; latitude += 0.0002)
        noted = found_at(latitude).grade == Grade::note;
    EXPECT_TRUE(noted);
}

TEST_F(WayFindings, name_those_whom_an_incident_cuts_off) {
    const auto round = findings("[[incident]]\nedge = \"main\"\nto_s = 200.0\n");
    ASSERT_EQ(round.size(), 3U);
    EXPECT_EQ(round[1].grade, Grade::ok);
    EXPECT_EQ(round[2].grade, Grade::ok);
    const auto off = findings("[[incident]]\nedge = \"far\"\n");
    EXPECT_EQ(off[1].grade, Grade::falls_short);
    EXPECT_EQ(off[1].text, "1 incident on edge far, all lanes: no way round then for two");
    // It lasts for 900 s, and SUMO waits for 300.
    EXPECT_EQ(off[2].grade, Grade::note);
    EXPECT_THAT(off[2].advice, HasSubstr("time_to_teleport_s = -1"));
    EXPECT_EQ(findings("[[incident]]\nedge = \"far\"\nemergency_passes = 1\n")[1].grade, Grade::ok);
}

TEST_F(WayFindings, say_that_incidents_close_a_road_only_together) {
    const std::string one = "[[incident]]\nedge = \"wide\"\nlanes = \"0\"\nto_s = 300.0\n";
    const std::string other = "[[incident]]\nedge = \"wide\"\nlanes = \"1\"\nfrom_s = ";
    const auto together = findings(one + other + "200.0\n");
    ASSERT_EQ(together.size(), 4U);
    EXPECT_EQ(together[2].grade, Grade::note);
    EXPECT_THAT(together[2].text, HasSubstr("incidents 0 and 1 close edge wide together; each alone leaves"));
    EXPECT_EQ(findings(one + other + "300.0\n").size(), 3U) << "one after the other";
    EXPECT_EQ(findings(one).size(), 3U) << "a lane stays open";
    EXPECT_EQ(findings("[[incident]]\nedge = \"wide\"\n").size(), 3U) << "one closes it alone";
}

TEST_F(WayFindings, look_for_whom_an_incident_cuts_off_in_more_seeds_than_are_run) {
    const std::string block = "[[incident]]\nedge = \"far\"\n";
    const std::vector<EmergencyTrip> run = {{"one", {"gate", "main", "goal"}}};
    std::vector<EmergencyTrip> more;
    for (int replication = 0; replication < 8; ++replication)
        more.push_back({fmt::format("one in replication {}", replication), {"gate", "far"}});
    EXPECT_EQ(cut_off(block, run, {}).grade, Grade::ok);
    const Finding found = cut_off(block, run, more);
    EXPECT_EQ(found.grade, Grade::falls_short);
    EXPECT_THAT(found.text, HasSubstr("for one in replication 0, one in replication 1, "));
    EXPECT_THAT(found.text, HasSubstr("one in replication 5 and 2 more"));
}

TEST_F(WayFindings, those_who_are_called_to_an_incident_are_not_cut_off) {
    const std::string called = "emergency.call.0.0,t,ambulance,60.00,best,max,gate far\n";
    EXPECT_EQ(findings("[[incident]]\nedge = \"far\"\n", called)[1].text,
              "1 incident on edge far, all lanes: no way round then for two");
    EXPECT_EQ(findings("[[incident]]\nedge = \"goal\"\n", called)[1].text,
              "1 incident on edge goal, all lanes: no way round then for one");
}

}  // namespace
}  // namespace clearway::campaign::detail
