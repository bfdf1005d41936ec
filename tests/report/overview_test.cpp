#include "report/overview.hpp"

#include <gmock/gmock.h>

#include "report/controls.hpp"
#include "report/locks.hpp"
#include "report/overview_fixture.hpp"
#include "report/shared_sentences.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using tests::around;
using tests::Overview;

TEST_F(Overview, SaysInOneSentenceWhatIsGainedWhatItCostsAndThatNobodyCollided) {
    EXPECT_EQ(headline(),
              "corridor saves ambulances 26 s a trip (26 %); other drivers lose 4.6 s each; no collision in "
              "20 runs.");
}

TEST_F(Overview, NamesTheLongestTripsAndTheLocks) {
    EXPECT_EQ(worst_trips(scenario_, corridor(), Script::plain), "");
    EXPECT_EQ(locks_sentence(scenario_, corridor()), "");
    corridor().worst_trip = WorstTrip{"emergency3", 12, 640.2};
    scenario_.conditions[0].worst_trip =
        WorstTrip{"emergency0", 4, 1537.0, "teleported out of a jam at 1600 s"};
    tests::metric(scenario_.conditions[0], "locks").values = {0.0, 2.0};
    tests::metric(scenario_.conditions[0], "longest_lock_s").values = {0.0, 300.0};
    tests::set_total(scenario_.conditions[0], "locked_vehicles", 30);
    tests::set_total(scenario_.conditions[0], "locked_emergency_vehicles", 1);
    EXPECT_EQ(
        worst_trips(scenario_, corridor(), Script::plain),
        "Longest trip, corridor: emergency3 in replication 12, 640 s; baseline: emergency0 in replication 4, "
        "1537 s, did not arrive: teleported out of a jam at 1600 s.");
    EXPECT_EQ(
        locks_sentence(scenario_, corridor()),
        "Vehicles locked each other. baseline: 2 locks in 1 of 20 runs, the longest 300 s; 30 vehicles stood "
        "in them, 1 of them EV. Fewer locks: " +
            lock_remedy(Blockers::respected) + ".");
    EXPECT_THAT(verdict(scenario_, corridor(), Script::plain).text(),
                HasSubstr(" Locks: none (baseline: 2 locks in 1 of 20 runs"));
    scenario_.blockers = Blockers::ignored;
    EXPECT_THAT(locks_sentence(scenario_, corridor()),
                AllOf(HasSubstr("Fewer locks: less traffic: 0.8 times the present --density"),
                      Not(HasSubstr("--ignore-junction-blocker"))));
}

TEST_F(Overview, SaysNothingOfLocksWithoutARun) {
    tests::metric(scenario_.conditions[0], "locks").values = {2.0};
    const auto text = [&] { return verdict(scenario_, corridor(), Script::plain).text(); };
    EXPECT_THAT(text(), HasSubstr(" Locks: none (baseline: 2 locks"));
    corridor().complete_runs = 0;
    EXPECT_THAT(text(), Not(HasSubstr("Locks")));
}

TEST_F(Overview, CallsOthersHardlyFasterWhereTheIntervalAllButReachesZero) {
    tests::difference(corridor(), Measure::other_time_loss) = around(-0.40, 0.38);
    EXPECT_THAT(headline(), HasSubstr("; other drivers are hardly faster (-0.4 s each);"));
    EXPECT_EQ(others().tone, Tile::Tone::neutral);
    tests::difference(corridor(), Measure::other_time_loss) = around(-0.40, 0.30);
    EXPECT_THAT(headline(), HasSubstr("; other drivers save 0.4 s each;"));
    EXPECT_EQ(others().tone, Tile::Tone::better);
}

TEST_F(Overview, SaysThatFewTripsCarryAGain) {
    scenario_.roads.emplace().signals.emplace_back();
    SignalTrips& trips = scenario_.map.emplace().signal_trips;
    scenario_.map->condition = "corridor";
    trips.passing = {9, {-60.0, -70.0}};
    trips.others = {51, {0.1, 0.2}};
    const auto told = HasSubstr(", most of it in the 9 of 60 trips that pass a signal;");
    EXPECT_THAT(headline(), told);
    trips.others.means_s = {-20.0, -30.0};
    EXPECT_THAT(headline(), Not(HasSubstr("most of it"))) << "the others gain more in all";
    trips.others = {27, {0.1, 0.2}};
    EXPECT_THAT(headline(), Not(HasSubstr("most of it"))) << "9 of 36 are not few";
    trips.others = {51, {0.1, 0.2}};
    scenario_.map->condition = "baseline";
    EXPECT_THAT(headline(), Not(HasSubstr("most of it"))) << "the map is not about it";
}

TEST_F(Overview, ClaimsNothingThatTheIntervalDoesNotShow) {
    tests::compare(corridor(), around(-2.0, 3.0), around(0.4, 1.0));
    EXPECT_EQ(
        headline(),
        "No effect of corridor on ambulances is shown (-2.0 s a trip); no effect on other drivers is shown "
        "(+0.4 s each); no collision in 20 runs.");
    EXPECT_EQ(emergency().tone, Tile::Tone::neutral);
    EXPECT_THAT(emergency().meaning, StartsWith("no effect shown"));
}

TEST_F(Overview, CallsAShownDifferenceThatIsTooSmallNoDifference) {
    tests::compare(corridor(), around(-0.5, 0.2), around(0.4, 1.0));
    corridor().least_relevant_s = 1.0;
    EXPECT_THAT(headline(),
                StartsWith("corridor makes no relevant difference to ambulances (-0.5 s a trip)"));
    EXPECT_EQ(emergency().tone, Tile::Tone::neutral);
    EXPECT_THAT(badge().words, HasSubstr("below what counts"));
}

TEST_F(Overview, NeverPraisesAConditionThatLosesEmergencyVehicles) {
    lose_vehicles();
    EXPECT_THAT(headline(),
                StartsWith("corridor lost 3 of 20 emergency vehicles (3 teleported; baseline 0);"));
    EXPECT_THAT(headline(), Not(HasSubstr("saves")));
    EXPECT_EQ(emergency().tone, Tile::Tone::worse);
    EXPECT_THAT(emergency().meaning, HasSubstr("no gain can be claimed"));
}

TEST_F(Overview, LeadsWithTheLostVehiclesAndNotWithTheHorizonThatTheyCountWith) {
    tests::compare(corridor(), around(96.2, 330.0), around(6.1, 20.0));
    tests::difference(corridor(), Measure::emergency_travel_time) = around(-10.3, 20.0);
    tests::comparison(corridor(), primary).median = -4.7;
    auto& arrived = tests::comparison(corridor(), Measure::emergency_travel_time);
    arrived.incomplete_pairs = 0;
    arrived.vehicles_left_out = 1;
    scenario_.horizon_s = 3600.0;
    EXPECT_EQ(survivors_words(corridor(), Script::plain), "");
    EXPECT_EQ(emergency().figure, "+96 s, +96 %");
    corridor().objections.emergency = {.arrived = 29, .teleported = 1};
    corridor().objections.baseline_emergency = {.arrived = 30};
    EXPECT_EQ(emergency().figure, "1 of 30 lost");
    const std::string survivors =
        "EVs that arrived in both: -10.3 s [-30.3, 9.7], all but 1; median of the pairs -4.7 s";
    EXPECT_THAT(
        emergency().meaning,
        AllOf(StartsWith("lost 1 of 30 emergency vehicles"), HasSubstr(survivors),
              EndsWith("mean of all +96 s, +96 %, where one that did not arrive counts with 3600 s")));
    EXPECT_EQ(verdict(scenario_, corridor(), Script::plain).facts.front(),
              survivors + "; one that did not arrive counts with 3600 s.");
    EXPECT_THAT(badge().words, Not(HasSubstr("tell the mean")));
    // Lost by the baseline alone: a gain that is no saved time.
    std::swap(corridor().objections.emergency, corridor().objections.baseline_emergency);
    EXPECT_THAT(emergency().meaning, HasSubstr(survivors));
}

TEST_F(Overview, SaysThatSafetyChecksWereOff) {
    corridor().condition.safety_checks = traffic::SafetyChecks::off;
    corridor().objections.unchecked = true;
    EXPECT_THAT(headline(), HasSubstr("ran without safety checks"));
    EXPECT_THAT(headline(), Not(HasSubstr("saves")));
    EXPECT_EQ(safety().tone, Tile::Tone::worse);
}

TEST_F(Overview, GivesTheOthersATileOfTheirOwnColour) {
    EXPECT_EQ(emergency().tone, Tile::Tone::better);
    EXPECT_EQ(others().tone, Tile::Tone::worse);
    EXPECT_EQ(others().figure, "+4.6 s");
    EXPECT_THAT(others().meaning, HasSubstr("lose more time each; 95 % interval 3.6 to 5.6 s"));
}

TEST_F(Overview, doubts_effects_of_locked_pairs_few_pairs_and_many_comparisons) {
    EXPECT_THAT(headline(), Not(HasSubstr("doubtful")));
    analysis::Comparison& others = tests::comparison(corridor(), Measure::other_time_loss);
    others.holm_p = 0.072;
    EXPECT_THAT(headline(),
                HasSubstr("other drivers lose 4.6 s each (doubtful: p 0.072 after Holm's correction)"));
    others.locked_pairs = others.complete_pairs = 20;
    EXPECT_THAT(headline(), HasSubstr("(doubtful: p 0.072"))
        << "locks of a few vehicles, as the check tolerates";
    others.held_up_pairs = 20;
    EXPECT_THAT(
        headline(),
        HasSubstr("(doubtful: locks held up an EV or one vehicle in a hundred in 20 of 20 pairs; p 0.072"));
    others.difference->n = 5;
    EXPECT_THAT(headline(), HasSubstr("20 of 20 pairs; 5 pairs are few; p 0.072"));
    EXPECT_EQ(this->others().tone, Tile::Tone::neutral);
    EXPECT_THAT(this->others().meaning, HasSubstr("; doubtful: locks held up"));
    EXPECT_THAT(headline(), StartsWith("corridor saves")) << "that of EVs stands";
    EXPECT_THAT(verdict(scenario_, corridor(), Script::plain).facts,
                testing::Contains(HasSubstr("in a hundred in 20 of 20 pairs; 5")));
    others.held_up_pairs = 4;
    others.holm_p = 0.04;
    EXPECT_THAT(headline(), HasSubstr("(doubtful: 5 pairs are few)"));
}

TEST_F(Overview, TellsADoubtOnce) {
    EXPECT_EQ(badge_of(scenario_, corridor(), Script::plain).runs, Badge::Runs::enough);
    for (const Measure measure : {primary, Measure::other_time_loss}) {
        analysis::Comparison& comparison = tests::comparison(corridor(), measure);
        comparison.holm_p = 0.01;
        comparison.complete_pairs = 20;
        comparison.held_up_pairs = 11;
    }
    const std::string words = headline();
    EXPECT_THAT(words, HasSubstr("doubtful: locks held up"));
    EXPECT_EQ(words.find("doubtful"), words.rfind("doubtful"));
    const Badge badge = badge_of(scenario_, corridor(), Script::plain);
    EXPECT_EQ(badge.runs, Badge::Runs::too_few);
    EXPECT_EQ(badge.words,
              "Doubtful: 20 pairs of runs show the direction, but locks hold up traffic in 11 of them");
    tests::comparison(corridor(), primary).held_up_pairs = 10;
    EXPECT_EQ(badge_of(scenario_, corridor(), Script::plain).runs, Badge::Runs::enough) << "not most";
}

TEST_F(Overview, CountsCollisionsAgainstTheBaseline) {
    tests::set_total(corridor(), "collisions", 7);
    tests::set_total(corridor(), "emergency_collisions", 2);
    tests::set_total(scenario_.conditions[0], "collisions", 5);
    EXPECT_THAT(headline(),
                HasSubstr("no difference in collisions is shown (7 in 20 runs; baseline 5 in 20)"));
    EXPECT_EQ(safety().figure, "7 collisions");
    EXPECT_EQ(safety().tone, Tile::Tone::neutral);  // no difference is shown
    EXPECT_THAT(safety().meaning, HasSubstr("2 with an EV, baseline 0"));
    tests::set_total(scenario_.conditions[0], "vehicle_count", 500);
    EXPECT_THAT(safety().meaning, Not(HasSubstr("say nothing about safety")));
    scenario_.step_length_s = 0.25;
    EXPECT_THAT(safety().meaning, HasSubstr("a claim about safety needs --step-length 0.1"));
    scenario_.step_length_s = 0.1;
    EXPECT_THAT(safety().meaning, Not(HasSubstr("--step-length")));
    tests::set_total(scenario_.conditions[0], "vehicle_count", 499);
    EXPECT_THAT(safety().meaning, HasSubstr("so many in the baseline that they say nothing about safety"));
    EXPECT_THAT(headline(), Not(HasSubstr("collision"))) << "the tile alone tells them";
    tests::difference(corridor(), Measure::collisions) = around(0.4, 0.2);
    EXPECT_EQ(safety().tone, Tile::Tone::worse);
    EXPECT_THAT(headline(), HasSubstr("more collisions than the baseline"));
}

TEST_F(Overview, tells_those_apart_that_met_an_incident) {
    corridor().met_incident = {34, 6, around(-48.0, 12.0)};
    const Tile tile = incident_tile(scenario_, corridor(), Script::plain);
    EXPECT_EQ(tile.tone, Tile::Tone::better);
    EXPECT_EQ(tile.figure, "-48 s");
    EXPECT_EQ(tile.meaning,
              "faster trips; 95 % interval -60 to -36 s; they are 34 of 60 EVs in baseline; 6 of "
              "them meet it with this condition");
    corridor().condition.policies = {"navigate"};
    EXPECT_THAT(incident_tile(scenario_, corridor(), Script::plain).meaning,
                HasSubstr("studies/accident.toml"));
}

TEST_F(Overview, says_of_what_fails_where_a_title_does_not) {
    corridor().condition.failure = "Q50,B10";
    EXPECT_THAT(headline(), HasSubstr("corridor (with failure Q50,B10) "));
    corridor().title = "corridor_Q50_B10";
    EXPECT_THAT(headline(), Not(HasSubstr("with failure")));
}

TEST_F(Overview, says_before_all_else_whom_an_incident_cut_off) {
    tests::set_total(corridor(), "emergency_cut_off", 3);
    EXPECT_THAT(headline(), StartsWith("3 EVs cut off by an incident. "));
    scenario_.roads.emplace().incidents = {{"e1", 80.0, 980.0, 60.0, 0.0, true}};
    tests::set_total(scenario_.conditions[0], "emergency_met_incident", 0);
    tests::set_total(corridor(), "emergency_met_incident", 3);
    EXPECT_THAT(headline(),
                AllOf(StartsWith("3 EVs cut off by an incident. "), Not(HasSubstr("met the block"))));
}

TEST_F(Overview, says_how_many_did_not_arrive_where_the_baseline_lost_as_many) {
    corridor().objections.emergency =
        corridor().objections.baseline_emergency = {.arrived = 17, .teleported = 4};
    EXPECT_THAT(headline(),
                HasSubstr("; lost 4 of 21 emergency vehicles (4 teleported; baseline 4 teleported); other"));
}

TEST_F(Overview, says_before_all_else_that_no_one_met_the_incident) {
    tests::compare(corridor(), around(-7.1, 9.0), around(0.4, 1.0));
    scenario_.roads.emplace().incidents = {{"e1", 80.0, 980.0, 60.0, 0.0, true}};
    EXPECT_THAT(headline(), StartsWith("No effect")) << "an older folder, which does not count them";
    tests::set_total(scenario_.conditions[0], "emergency_met_incident", 0);
    const std::string unmet =
        "No EV met the block (0 of 60 in the baseline): these runs say nothing about it.";
    EXPECT_THAT(headline(), StartsWith(unmet + " No effect of corridor"));
    EXPECT_THAT(badge().words, AllOf(StartsWith(unmet), Not(HasSubstr("tell the mean"))));
    const Tile tile = incident_tile(scenario_, corridor(), Script::plain);
    EXPECT_EQ(tile.figure, "0");
    EXPECT_EQ(tile.meaning, unmet);
    scenario_.roads->calls = {{"e1", 90.0, 1}};
    EXPECT_THAT(headline(), StartsWith("No effect")) << "they are called to it";
    scenario_.roads->calls.clear();
    scenario_.roads->incidents[0].is_closed = false;
    EXPECT_THAT(headline(), StartsWith("No effect")) << "they may pass";
    scenario_.roads->incidents[0].is_closed = true;
    tests::set_total(scenario_.conditions[0], "emergency_met_incident", 1);
    EXPECT_THAT(headline(), StartsWith("No effect"));
}

TEST_F(Overview, names_the_roads_that_are_blocked) {
    EXPECT_EQ(incidents_sentence(scenario_, Script::plain), "");
    scenario_.streets = {{"e1", "Long Street"}};
    scenario_.roads.emplace().incidents = {{"e1", 80.0, 980.0, 60.0, 90.0}, {"e2", 5.0, 15.5, {}, 0.0}};
    EXPECT_EQ(
        incidents_sentence(scenario_, Script::plain),
        "Blocked: Long Street (e1) from 80 to 980 s, in each run up to 90 s later, known 60 s after; e2 "
        "from 5 to 16 s, known when a vehicle sees it.");
    scenario_.roads->incidents.resize(5);
    EXPECT_THAT(incidents_sentence(scenario_, Script::plain), HasSubstr("; and 2 more."));
}

TEST_F(Overview, NamesFailedAndMissingRuns) {
    corridor().failed = {{3, "killed"}};
    corridor().missing_runs = 1;
    EXPECT_THAT(headline(), HasSubstr("2 of 22 runs failed or missing."));
}

TEST_F(Overview, SaysWhetherThereAreEnoughRuns) {
    EXPECT_EQ(badge().words, "Enough runs: 20 pairs of runs show the direction");
    tests::difference(corridor(), primary)->n = 8;
    EXPECT_EQ(badge().runs, Badge::Runs::too_few);
    EXPECT_EQ(badge().words,
              "Few runs: 8 pairs of runs show the direction; below 10 means and intervals are unreliable");
    tests::compare(corridor(), around(-2.0, 3.0), around(0.4, 1.0));
    tests::difference(corridor(), primary)->deviation = 6.4;
    corridor().precision = Precision{{}, 6.4, 160};
    EXPECT_EQ(badge().runs, Badge::Runs::too_few);
    EXPECT_EQ(
        badge().words,
        "Not enough runs: 20 pairs of runs. If the difference is really the 2.0 s seen, about 83 pairs show "
        "it in four studies of five. To tell the mean to within 1.0 s takes about 160.");
    tests::difference(corridor(), primary)->mean = -0.9;
    EXPECT_EQ(badge().words,
              "Not enough runs: 20 pairs of runs. To tell the mean to within 1.0 s takes about 160.");
    corridor().precision->needed = 20;
    EXPECT_EQ(badge().words, "Enough runs: 20 pairs of runs tell the mean to within 1.0 s");
    tests::compare(corridor(), around(-2.0, 3.0, 3), around(0.4, 1.0, 3));
    EXPECT_EQ(badge().words, "Not enough runs: 3 pairs of runs, at least 5 for any verdict");
    EXPECT_THAT(headline(), StartsWith("No verdict on corridor yet: 3 of at least 5 runs"));
}

TEST_F(Overview, FeaturesTheLargestShownGainAndSaysThatItWasChosen) {
    ConditionFacts lucky = tests::condition("lucky", "lucky", 60.0);
    tests::compare(lucky, around(-40.0, 50.0), around(0.0, 1.0));  // larger, but not shown
    ConditionFacts small = tests::condition("small", "small", 90.0);
    tests::compare(small, around(-10.0, 4.0), around(0.0, 1.0));
    scenario_.conditions.push_back(lucky);
    scenario_.conditions.push_back(small);
    EXPECT_EQ(featured_condition(study_, scenario_), &scenario_.conditions[1]);
    EXPECT_EQ(among_conditions(study_, scenario_),
              "2 of 3 conditions are shown to help; this one has the largest mean gain, which usually "
              "overstates its true "
              "gain a little.");
    tests::comparison(scenario_.conditions.back(), primary).holm_p = 0.2;
    EXPECT_THAT(among_conditions(study_, scenario_),
                StartsWith("2 of 3 conditions are shown to help, 1 with Holm's "
                           "correction for so many comparisons; this one"));
    lose_vehicles();
    EXPECT_EQ(featured_condition(study_, scenario_), &scenario_.conditions[3]);
}

TEST_F(Overview, LetsTheSimplestOfEqualGainsSpeak) {
    ConditionFacts larger = tests::condition("larger", "corridor and more", 73.9);
    larger.condition.policies = {"corridor", "more"};
    const double gain_s = corridor().difference(Measure::emergency_restricted_time)->mean;
    corridor().least_relevant_s = larger.least_relevant_s = 1.0;
    tests::compare(larger, around(gain_s - 0.1, 4.0), around(4.6, 1.0));
    scenario_.conditions.push_back(larger);
    EXPECT_EQ(featured_condition(study_, scenario_), &corridor());
    EXPECT_THAT(among_conditions(study_, scenario_), HasSubstr("this one is the simplest of those"));
    tests::compare(scenario_.conditions.back(), around(gain_s - 1.1, 4.0), around(4.6, 1.0));
    EXPECT_EQ(featured_condition(study_, scenario_), &scenario_.conditions.back());
    EXPECT_THAT(among_conditions(study_, scenario_), HasSubstr("largest mean gain"));
}

/// With values of each run: what a pair of runs differs in varies with `noise`.
void set_runs(ConditionFacts& condition, double time_s, double loss_s, double noise) {
    analysis::Values times;
    analysis::Values losses;
    for (int run = 0; run < 20; ++run) {
        const double own = run % 2 == 0 ? noise : -noise;
        times.emplace_back(time_s + 3.0 * run + own);
        losses.emplace_back(loss_s + run + 0.1 * own);
    }
    tests::metric(condition, info(primary).field).values = times;
    tests::metric(condition, info(Measure::other_time_loss).field).values = losses;
    condition.least_relevant_s = 1.0;
}

TEST_F(Overview, LetsTheCheapestOfEqualGainsSpeak) {
    ConditionFacts costly = tests::condition("costly", "preempt signals", 73.5);
    tests::compare(costly, around(-26.5, 4.0), around(9.0, 1.0));
    scenario_.conditions.push_back(costly);
    const auto shown = [&](double gain_s, double cost_s, double noise) {
        set_runs(corridor(), 74.0, 4.6, 0.0);
        set_runs(scenario_.conditions[2], 74.0 - gain_s, 4.6 + cost_s, noise);
        return featured_condition(study_, scenario_);
    };
    const auto* const costly_one = &scenario_.conditions[2];
    EXPECT_EQ(shown(0.5, 4.4, 0.2), &corridor()) << "0.5 s does not count";
    EXPECT_EQ(shown(3.0, 4.4, 10.0), &corridor()) << "3.0 s is not shown";
    EXPECT_THAT(
        among_conditions(study_, scenario_),
        AllOf(HasSubstr("; the gain of preempt signals is as large (EV travel time against this one "),
              HasSubstr("and it costs other drivers +4.4 ["), Not(HasSubstr("this one has the"))));
    EXPECT_EQ(shown(3.0, 4.4, 0.2), costly_one) << "its gain is shown to be larger";
    EXPECT_EQ(shown(0.5, 0.0, 0.2), costly_one) << "its cost is not shown to be higher";
    EXPECT_EQ(shown(0.5, -4.4, 0.2), costly_one) << "it costs less";
    corridor().objections.unchecked = true;
    EXPECT_EQ(shown(0.5, 4.4, 0.2), costly_one);
}

TEST_F(Overview, LetsNoSimplerConditionSpeakThatCostsMore) {
    ConditionFacts larger = tests::condition("larger", "corridor and more", 73.9);
    larger.condition.policies = {"corridor", "more"};
    tests::compare(larger, around(-26.1, 4.0), around(4.6, 1.0));
    scenario_.conditions.push_back(larger);
    set_runs(corridor(), 74.0, 8.0, 0.0);
    set_runs(scenario_.conditions[2], 73.9, 4.6, 0.2);
    EXPECT_EQ(featured_condition(study_, scenario_), &scenario_.conditions[2]);
}

TEST_F(Overview, IsAboutTheConditionThatTheUserChose) {
    ConditionFacts own = tests::condition("own", "Ours", 95.0);
    tests::compare(own, around(-5.0, 4.0), around(0.0, 1.0));
    own.condition.failure = "B10";
    scenario_.conditions.push_back(own);
    scenario_.chosen = "own";
    EXPECT_EQ(featured_condition(study_, scenario_), &scenario_.conditions[2]);
    EXPECT_THAT(scenario_headline(scenario_, scenario_.conditions[2], Script::plain),
                EndsWith(" Shown by your choice."));
    EXPECT_THAT(headline(), Not(HasSubstr("your choice"))) << "the other one";
    EXPECT_EQ(among_conditions(study_, scenario_),
              "2 of 2 conditions are shown to help; corridor has the largest mean gain of those in which "
              "nothing fails.");
    scenario_.chosen = "baseline";
    EXPECT_EQ(featured_condition(study_, scenario_), &corridor()) << "it is compared with nothing";
}

TEST_F(Overview, IsAboutAConditionInWhichNothingFails) {
    ConditionFacts failing = tests::condition("failing", "corridor with failing sensors", 60.0);
    failing.condition.policies = corridor().condition.policies;
    failing.condition.failure = "B10";
    tests::compare(failing, around(-90.0, 4.0), around(4.6, 1.0));
    scenario_.conditions.push_back(failing);
    EXPECT_EQ(featured_condition(study_, scenario_), &corridor()) << "whatever gains more by chance";
    EXPECT_THAT(among_conditions(study_, scenario_),
                HasSubstr("the largest mean gain of those in which nothing fails"));
    tests::metric(corridor(), info(primary).field).values = {50.0, 60.0, 70.0, 61.0, 59.0};
    tests::metric(scenario_.conditions.back(), info(primary).field).values = {44.0, 55.0, 64.0, 55.0, 54.0};
    EXPECT_THAT(
        failing_note(scenario_, corridor(), Script::plain),
        HasSubstr("against the same while nothing fails, s: corridor with failing sensors: -5.6 [-6.3"));
    EXPECT_THAT(
        failing_sentence(scenario_, scenario_.conditions.back(), Script::plain),
        StartsWith("What failing costs: EV travel time against the same while nothing fails, s: -5.6"));
    corridor().control_of = "failing";
    EXPECT_EQ(featured_condition(study_, scenario_), &scenario_.conditions.back()) << "what was asked for";
}

TEST_F(Overview, SaysOnceUnderWhichFailuresNoRequestIsLost) {
    EXPECT_EQ(kept_requests_sentence(scenario_), "");
    corridor().condition.policies = {"corridor"};
    for (const char* const failure : {"B10", "Q50", "B10", "D3"}) {
        scenario_.conditions.push_back(corridor());
        scenario_.conditions.back().condition.failure = failure;
    }
    EXPECT_EQ(kept_requests_sentence(scenario_),
              "No request of an EV to vehicles or signals is lost under B10; D3 (Q50 loses half).");
}

TEST_F(Overview, SaysWhichPoliciesSendNoMessagesThatCouldBeLost) {
    corridor().condition.policies = {"check_in_out"};
    EXPECT_EQ(unsent_messages_sentence(scenario_), "");
    corridor().condition.failure = "Q50";
    scenario_.conditions.push_back(corridor());
    EXPECT_EQ(unsent_messages_sentence(scenario_),
              "Q50: check_in_out sends no messages, so those that this failure loses stand for nothing.")
        << "once";
    EXPECT_THAT(verdict(scenario_, corridor(), Script::plain).text(),
                HasSubstr("check_in_out sends no messages, so those that this failure loses"));
}

TEST_F(Overview, DoubtsAClaimThatHoldsAlone) {
    analysis::Comparison comparison = tests::comparison(corridor(), primary);
    comparison.holm_p = 0.2;
    EXPECT_THAT(doubts_of(Effect::worse, comparison, Script::plain),
                HasSubstr("p 0.200 after Holm's correction"));
    EXPECT_EQ(doubts_of(Effect::none_shown, comparison, Script::plain), "") << "claims nothing";
    comparison.holm_p = 0.01;
    EXPECT_EQ(doubts_of(Effect::worse, comparison, Script::plain), "");
}

TEST_F(Overview, SaysThatRunsAreTooFewForManyComparisons) {
    tests::comparison(corridor(), primary).holm_p = 0.2;
    const Badge badge = badge_of(scenario_, corridor(), Script::plain);
    EXPECT_EQ(badge.runs, Badge::Runs::too_few);
    EXPECT_THAT(
        badge.words,
        ContainsRegex("show the direction of one comparison alone, not after Holm's correction; "
                      "(about|more than) [0-9]+ pairs would \\(80 % power\\) if the difference is as seen"));
    study_.scenarios = {scenario_};
    EXPECT_THAT(report::headline(study_),
                HasSubstr("emergency vehicles faster under 1 of 1 condition (none with "
                          "Holm's correction)"));
}

TEST_F(Overview, OfABaselineAloneIsEmpty) {
    scenario_.conditions.pop_back();
    EXPECT_EQ(featured_condition(study_, scenario_), nullptr);
    EXPECT_EQ(among_conditions(study_, scenario_), "");
}

}  // namespace
}  // namespace clearway::report
