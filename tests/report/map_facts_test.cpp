// The maps of a run folder, from its files.
#include "report/detail/map_facts.hpp"

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "report/configuration.hpp"
#include "report/frozen_study.hpp"
#include "report/read_facts.hpp"
#include "report/shared_sentences.hpp"
#include "report/verdict.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::report {
namespace {

using ::testing::HasSubstr;

class MapFacts : public testing::Test {
  protected:
    ScenarioFacts crossing() const { return read_facts(folder_.path() / "study").scenarios[0]; }

    const support::TemporaryFolder folder_;
    const tests::FrozenStudy study_{folder_.path() / "study"};
    const std::filesystem::path roads_ = folder_.path() / "study" / "scenarios" / "crossing" / "roads.json";
};

TEST_F(MapFacts, AreMeansOverThePassagesThatBothRunsHave) {
    const ScenarioFacts scenario = crossing();
    ASSERT_TRUE(scenario.map);
    EXPECT_EQ(scenario.map->condition, "helps");
    ASSERT_EQ(scenario.map->times.size(), 2u);
    const EdgeTimes& first = scenario.map->times[0];
    EXPECT_EQ(scenario.roads->edges[first.edge].id, "north_in");
    EXPECT_EQ(first.passages, 6u);
    // Half of 100 s and of 75 s, with luck of 0, 7, ... 35 s and half of it.
    EXPECT_DOUBLE_EQ(first.baseline_s, 0.5 * (100.0 + 17.5));
    EXPECT_DOUBLE_EQ(first.condition_s, 0.5 * (75.0 + 8.75));
    ASSERT_EQ(scenario.map->holds.size(), 1u);
    EXPECT_DOUBLE_EQ(scenario.map->holds[0].holds, 1.0);
    EXPECT_DOUBLE_EQ(scenario.map->holds[0].held_s, 20.0 + 7.5);
}

TEST_F(MapFacts, CountLocksWhereTheyHappened) {
    const results::Store store = results::Store::open(folder_.path() / "study");
    for (const char* const condition : {"baseline", "helps"}) {
        auto run = *store.read({"crossing", condition, 1});
        run.traffic = store.read_traffic(run.key);
        run.traffic.locks = {{"west_in", "J", 100.0, 80.0, 4, 1}, {"elsewhere", "K", 100.0, 80.0, 4, 0}};
        if (run.key.condition == "helps") run.traffic.locks.resize(1);
        std::filesystem::remove_all(folder_.path() / "study" / "runs" / "crossing" / condition / "00001");
        store.write(run, {});
    }
    const ScenarioFacts scenario = crossing();
    ASSERT_TRUE(scenario.map);
    ASSERT_EQ(scenario.map->locks.size(), 1U) << "what the map does not show is left out";
    EXPECT_EQ(scenario.roads->edges[scenario.map->locks[0].edge].id, "west_in");
    EXPECT_EQ(scenario.map->locks[0].condition, 1U);
    EXPECT_EQ(scenario.map->locks[0].baseline, 1U);
}

TEST_F(MapFacts, TellTripsThatPassSignalsFromOthers) {
    const ScenarioFacts before = crossing();
    EXPECT_EQ(before.map->signal_trips.others.trips, 0U);
    EXPECT_EQ(before.map->signal_trips.passing.trips, 6U);
    const ConditionFacts& helps = before.conditions[before.place_of(before.map->condition)];
    EXPECT_EQ(signal_trips_words(before, helps, Script::plain), "") << "all pass one";
    const results::Store store = results::Store::open(folder_.path() / "study");
    for (const char* const condition : {"baseline", "helps"}) {
        auto run = *store.read({"crossing", condition, 1});
        run.traffic = store.read_traffic(run.key);
        run.traffic.edge_times.resize(1);  // ends at the signal, which it does not pass
        std::filesystem::remove_all(folder_.path() / "study" / "runs" / "crossing" / condition / "00001");
        store.write(run, {});
    }
    const ScenarioFacts after = crossing();
    EXPECT_EQ(after.map->signal_trips.others.trips, 1U);
    EXPECT_EQ(after.map->signal_trips.passing.trips, 5U);
    EXPECT_THAT(
        signal_trips_words(after, after.conditions[after.place_of(after.map->condition)], Script::plain),
        testing::MatchesRegex(
            "5 of 6 trips pass a signal and change by -[0-9.]+ .-[0-9.]+, -[0-9.]+. s .mean of 5 "
            "pairs with such., the others by -[0-9.]+ s"));
    EXPECT_EQ(signal_trips_words(after, after.conditions[0], Script::plain), "") << "the map is not about it";
}

TEST_F(MapFacts, TellWhichVehiclesTookAnotherWay) {
    EXPECT_TRUE(crossing().map->changed_ways.empty());
    const results::Store store = results::Store::open(folder_.path() / "study");
    auto run = *store.read({"crossing", "helps", 1});
    run.traffic = store.read_traffic(run.key);
    for (metrics::EdgeTimeRow& row : run.traffic.edge_times) {
        if (row.edge == "north_in") row.edge = "west_in";
    }
    std::filesystem::remove_all(folder_.path() / "study" / "runs" / "crossing" / "helps" / "00001");
    store.write(run, {});
    const ScenarioFacts scenario = crossing();
    ASSERT_EQ(scenario.map->changed_ways.size(), 1U);
    const ChangedWay& change = scenario.map->changed_ways[0];
    EXPECT_EQ(change.vehicle, "emergency<0>");
    EXPECT_EQ(change.replication, 1U);
    EXPECT_EQ(scenario.roads->edges[change.baseline.front()].id, "north_in");
    EXPECT_EQ(scenario.roads->edges[change.condition.front()].id, "west_in");
    EXPECT_EQ(scenario.map->trips, 6U);
}

TEST_F(MapFacts, TellWhichEdgesWereConsideredUnderTheCondition) {
    EXPECT_TRUE(crossing().map->considered.empty());
    const results::Store store = results::Store::open(folder_.path() / "study");
    for (const char* const condition : {"baseline", "helps"}) {
        auto run = *store.read({"crossing", condition, 1});
        run.traffic = store.read_traffic(run.key);
        run.traffic.considered = {{"emergency<0>", "off the map", 1}, {"emergency<0>", "west_in", 4}};
        std::filesystem::remove_all(folder_.path() / "study" / "runs" / "crossing" / condition / "00001");
        store.write(run, {});
    }
    const ScenarioFacts scenario = crossing();
    ASSERT_EQ(scenario.map->considered.size(), 1U);
    const ConsideredEdge& edge = scenario.map->considered[0];
    EXPECT_EQ(edge.vehicle, "emergency<0>");
    EXPECT_EQ(edge.replication, 1U);
    EXPECT_EQ(scenario.roads->edges[edge.edge].id, "west_in");
    EXPECT_EQ(edge.decisions, 4U);
}

TEST_F(MapFacts, ReachStartsAtTheStations) {
    const ScenarioFacts scenario = crossing();
    ASSERT_TRUE(scenario.map && scenario.map->reach);
    EXPECT_THAT(scenario.map->reach->starts, ::testing::ElementsAre(0u));
    EXPECT_FALSE(scenario.map->reach->edges[1].baseline_s);  // nothing leads to west_in
    EXPECT_DOUBLE_EQ(*scenario.map->reach->edges[2].condition_s, 75.0 + 8.75);
}

TEST_F(MapFacts, AndTheTripInTheMiddleOfThoseThatPassSignalsAreShown) {
    const results::Store store = results::Store::open(folder_.path() / "study");
    const auto end_s = [&](const char* condition, std::uint32_t replication) {
        double last_s = 0.0;
        for (const metrics::JourneyRow& row :
             store.read_traffic({"crossing", condition, replication}).journeys)
            if (row.vehicle == "emergency<0>" && row.signal.empty()) last_s = row.time_s;
        return last_s;
    };
    std::vector<double> gains_s;
    for (std::uint32_t replication = 0; replication < 3; ++replication)
        gains_s.push_back(end_s("baseline", replication) - end_s("helps", replication));
    std::ranges::sort(gains_s);
    ASSERT_LT(gains_s[0], gains_s[1]);
    ASSERT_LT(gains_s[1], gains_s[2]);
    const ScenarioFacts scenario = crossing();
    ASSERT_GT(scenario.journeys.size(), 1u);
    EXPECT_EQ(scenario.journeys[0].vehicle, "emergency<0>") << "the other one passes no signal";
    EXPECT_DOUBLE_EQ(scenario.journeys[0].places.back().time_s - scenario.journeys[1].places.back().time_s,
                     gains_s[1]);
}

TEST_F(MapFacts, AndTheTripThatIsShownGainsWhereTheHeadlineSpeaksOfAGain) {
    const results::Store store = results::Store::open(folder_.path() / "study");
    constexpr std::array gains_s = {15.0, 60.0, 70.0};  // the mean of all is 33 s, to which 15 s is nearest
    for (std::uint32_t replication = 0; replication < gains_s.size(); ++replication) {
        auto run = *store.read({"crossing", "helps", replication});
        run.traffic = store.read_traffic({"crossing", "baseline", replication});
        for (metrics::JourneyRow& row : run.traffic.journeys)
            if (row.time_s > 100.0) row.time_s -= gains_s[replication];
        std::filesystem::remove_all(folder_.path() / "study" / "runs" / "crossing" / "helps" /
                                    fmt::format("{:05}", replication));
        store.write(run, {});
    }
    const ScenarioFacts scenario = crossing();
    ASSERT_GT(scenario.journeys.size(), 1u);
    EXPECT_DOUBLE_EQ(scenario.journeys[0].places.back().time_s - scenario.journeys[1].places.back().time_s,
                     60.0);
    const std::vector<TripGain>& gains = scenario.conditions[1].trip_changes.gains;
    EXPECT_EQ(gains.size(), 11u) << "all that arrived in both";
    EXPECT_EQ(std::ranges::count_if(gains, [](const TripGain& one) { return one.replication == 4; }), 1);
}

TEST_F(MapFacts, AndTheTripThatIsShownIsOfTheConditionOfTheHeadline) {
    EXPECT_EQ(crossing().journeys.at(1).condition, "helps");
    std::ofstream(folder_.path() / "study" / "controls.json") << R"({"helps": "hardly"})";
    const ScenarioFacts scenario = crossing();  // no headline is about a control, however much it gains
    EXPECT_EQ(scenario.journeys.at(1).condition, scenario.conditions[scenario.place_of("hardly")].label());
}

TEST_F(MapFacts, StandBesideTheTripsThatChangedAndTheWorstOnes) {
    const std::vector<ConditionFacts> conditions = crossing().conditions;
    EXPECT_EQ(conditions[0].trip_changes.trips, 0u) << "compared with nothing";
    EXPECT_EQ(conditions[1].trip_changes.trips, 11u) << "of 12, the baseline lost one";
    EXPECT_EQ(conditions[1].trip_changes.faster, 11u);
    EXPECT_NEAR(conditions[1].trip_changes.mean_faster_s, 32.9, 0.1);
    EXPECT_EQ(trip_changes_words(conditions[1], Script::plain),
              "11 of 11 trips over 5 s faster (33 s in the mean), 0 over 5 s slower");
    ASSERT_TRUE(conditions[0].worst_trip);
    EXPECT_EQ(conditions[0].worst_trip->vehicle, "emergency<1>") << "one that did not arrive is the worst";
    EXPECT_EQ(conditions[0].worst_trip->end, "on the road at the end at 195 s");
}

std::string assumptions_of(const std::string& configuration, ScenarioFacts scenario) {
    add_configuration(configuration, scenario);
    return scenario.assumptions;
}

TEST(Assumptions, say_where_traffic_comes_from_and_what_red_means) {
    ScenarioFacts scenario;
    scenario.conditions.resize(1);
    scenario.roads.emplace().signals.resize(1);
    const std::string drawn =
        "[demand]\nhuman = 1076\nautomated = 579\ndensity = 0.7\n[time]\nwindow_s = 900\n";
    EXPECT_EQ(assumptions_of(drawn, scenario),
              "Simulated: random trips of 1,159 vehicles in 15 min; density 0.7; automated share 0.35; "
              "EVs of the baseline stop at red (where yours may pass it: --set privilege.pass_red=1).");
    EXPECT_THAT(assumptions_of(drawn + "[[flow]]\nfrom = 'a'\n", scenario), HasSubstr("drawn flows of"));
    const std::string emergency =
        "[demand]\nhuman = 9\nemergency = 6\n[trips]\nemergency_minimum_length_m = 800\n";
    EXPECT_THAT(assumptions_of(emergency, scenario),
                HasSubstr("; EVs drive between random places, on routes of at least 800 m; "));
    const std::string hospital = emergency + "[[emergency_site]]\nkind = 'hospital'\n";
    EXPECT_THAT(
        assumptions_of(hospital, scenario),
        HasSubstr("; EVs drive half from hospitals (no ambulance station is known) to random places and "
                  "half from random places to hospitals, on"));
    EXPECT_THAT(assumptions_of(hospital + "[[emergency_site]]\nkind = 'ambulance_station'\n", scenario),
                HasSubstr("half from ambulance stations to random places"));
    EXPECT_THAT(assumptions_of(emergency + "[[emergency_site]]\nkind = 'fire_station'\n", scenario),
                HasSubstr("from random places to fire stations (no hospital is known)"));
    EXPECT_THAT(assumptions_of(hospital + "[kinds.emergency]\nambulance = 0\npolice_car = 1\n", scenario),
                testing::Not(HasSubstr("ambulance")))
        << "none is drawn";
    EXPECT_THAT(assumptions_of("[network]\nmap_date = '2012-05-03 (newest object)'\n" + drawn, scenario),
                HasSubstr("; map data of 2012-05-03 (newest object); "));
    EXPECT_THAT(assumptions_of(drawn + "[privilege]\npass_red = 1\n", scenario),
                HasSubstr("EVs of the baseline may pass red"));
    scenario.conditions[0].condition.settings = {{"privilege.pass_red", "1"}};
    EXPECT_THAT(assumptions_of(drawn, scenario), HasSubstr("may pass red"));
    EXPECT_THAT(assumptions_of("[network]\nattribution = 'Map data (c) OpenStreetMap'\n" + drawn, scenario),
                HasSubstr("signal programs made up for the map, which has none, unless yours were entered"));
    scenario.roads->edges.resize(2);
    for (const auto& [edge, length_m, limit_kmh] : {std::tuple{0, 900.0, 50.0}, {1, 100.0, 30.0}}) {
        scenario.roads->edges[edge].length_m = length_m;
        scenario.roads->edges[edge].limit_mps = limit_kmh / 3.6;
    }
    EXPECT_THAT(assumptions_of(drawn, scenario),
                HasSubstr("in 15 min; roads of 30 to 50 km/h, mostly 50; density 0.7"));
    scenario.roads->edges.resize(1);
    EXPECT_THAT(assumptions_of(drawn, scenario), HasSubstr("; roads of 50 km/h; density"));
    scenario.roads->edges.clear();
    scenario.roads->signals.clear();
    EXPECT_EQ(assumptions_of("[demand]\nemergency = 2\n[measured]\nautomated_share = 0.35\n", scenario),
              "Simulated: the trips of the scenario's files; automated share 0.35; EVs drive between random "
              "places.");
    EXPECT_EQ(assumptions_of("name = 'old'\n", scenario), "");
}

TEST_F(MapFacts, AreMissingWhereTheFolderHasNoRoads) {
    std::filesystem::remove(roads_);
    EXPECT_FALSE(crossing().map);
}

TEST_F(MapFacts, OfADamagedFileAreRefusedWithItsName) {
    for (const char* const text :
         {"{", R"({"edges": []})", R"({"edges": [{"id": "a", "to": [7], "signal": false,
             "length_m": 1, "limit_mps": 1, "shape_m": []}], "signals": [], "stations": []})"}) {
        std::ofstream(roads_) << text;
        try {
            crossing();
            FAIL() << text;
        } catch (const core::InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("roads.json"));
        }
    }
}

}  // namespace
}  // namespace clearway::report
