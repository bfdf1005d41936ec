#include "report/equipment.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "report/equipment_samples.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using analysis::Estimate;
using analysis::Interval;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Equipment, HasARowForEachCandidateAndRankInEightyColumns) {
    const std::string text = equipment_text(two_of_twelve());
    EXPECT_THAT(text, HasSubstr("31.0 [27.0, 35.0]  shown"));
    EXPECT_THAT(text, HasSubstr("1.0 [-1.0, 3.0]  not shown      5"));
    EXPECT_THAT(text, HasSubstr("30.0 [26.0, 34.0]  shown"));
    EXPECT_THAT(text, HasSubstr("12.0 [-1.0, 25.0]  not shown"));
    EXPECT_THAT(text, testing::ContainsRegex(
                          "\n +2  42\\.0 \\[38\\.0, 46\\.0\\]  shown +84  1\\.0 \\[0\\.6, 1\\.4\\]"))
        << "of both, with the cost to the others";
    EXPECT_EQ(count_of(text, "42.0 [38.0, 46.0]"), 2U) << "in the row of both and in the answer";
    EXPECT_LT(text.find("31.0 ["), text.find("1.0 [-1.0, 3.0]")) << "the greatest gain first";
    for (const std::string& line : lines_of(text))
        EXPECT_LE(line.size(), 80U) << line;
}

TEST(Equipment, HasNamesInFullBelowTheirRowsWhereALineHasNoRoom) {
    const std::string text = equipment_text(two_of_twelve());
    EXPECT_THAT(text, HasSubstr("\n      Gate <Road> / High Street\n"));
    EXPECT_THAT(text, HasSubstr("\n      south of the old town's gate\n"));
    EquipmentFacts wide = two_of_twelve();
    for (EquippedSignal& signal : wide.ranked)
        signal.gain = signal.so_far = signal.others = about(1000.0, 123456.0);
    for (const std::string& line : lines_of(equipment_text(wide)))
        EXPECT_LE(line.size(), 80U) << line;
    EXPECT_THAT(equipment_text(wide), Not(HasSubstr("Others lose, s"))) << "no room for it";
}

TEST(Equipment, TellsCandidatesApartFromRanksByAHash) {
    EXPECT_THAT(equipment_text(two_of_twelve()), testing::ContainsRegex("\n +1 +#4 +30\\.0 \\["));
}

TEST(Equipment, SaysThatTheOthersSaveTimeWhereThatIsShown) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(equipment_text(facts), AllOf(HasSubstr("Others lose, s"), Not(HasSubstr("Others save"))));
    EXPECT_THAT(flat_text(facts), HasSubstr("the others lose 1.0 [0.6, 1.4] s each (shown)"));
    facts.ranked.back().others = about(-3.0, 1.0);
    EXPECT_THAT(flat_text(facts), HasSubstr("the others save 3.0 [2.0, 4.0] s each (shown)"));
    facts.ranked.back().others = about(-3.0, 4.0);
    EXPECT_THAT(flat_text(facts), HasSubstr("the others save 3.0 [-1.0, 7.0] s each (not shown)"));
    EXPECT_THAT(equipment_text(facts),
                AllOf(HasSubstr("Others save, s"), Not(HasSubstr("Others lose")),
                      HasSubstr("  3.0 [-1.0, 7.0]"), HasSubstr("  -0.5 [-0.7, -0.3]")));
    EXPECT_DOUBLE_EQ(nlohmann::json::parse(equipment_json(facts))
                         .at("ranked")
                         .at(1)
                         .at("others_time_loss_s")
                         .at("mean")
                         .get<double>(),
                     -3.0);
}

TEST(Equipment, TellsWhatTripsGainThatPassAChosenSignal) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("pass a chosen signal")));
    facts.split = {60, 45, about(56.0, 6.0), about(0.4, 1.0)};
    EXPECT_THAT(
        flat_text(facts),
        HasSubstr(
            "Of 60 trips on the fresh seeds, which only measure, 45 (75 %) pass a chosen signal and gain "
            "56.0 [50.0, 62.0] s each (shown); the other trips gain 0.4 [-0.6, "
            "1.4] s each (not shown)."));
    const auto json = nlohmann::json::parse(equipment_json(facts));
    EXPECT_EQ(json.at("fresh_trips_passing"), 45);
    EXPECT_DOUBLE_EQ(json.at("gain_of_passing_s").at("low").get<double>(), 50.0);
    std::ostringstream page;
    write_equipment_page(facts, page);
    EXPECT_THAT(page.str(), HasSubstr("<li>Of 60 trips on the fresh seeds, which only measure, 45 (75 %)"));
    facts.split.passing = 60;
    EXPECT_THAT(flat_text(facts),
                HasSubstr("60 (100 %) pass a chosen signal and gain 56.0 [50.0, 62.0] s each "
                          "(shown)."));
    facts.split.passing = 0;
    EXPECT_THAT(flat_text(facts), HasSubstr("No fresh trip passes a chosen signal."));
}

TEST(Equipment, HasCollisionsAndTeleportsBesideTheCost) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("Events of a run")));
    facts.events = {{"Collisions", about(1.0, 0.5), about(1.5, 0.5), about(0.5, 0.6)},
                    {"Teleports", about(0.0, 0.0), about(0.0, 0.0), about(0.0, 0.3)}};
    facts.unsound = {.runs = 30, .collisions = 10, .vehicles = 1000};
    EXPECT_THAT(equipment_text(facts),
                testing::ContainsRegex("\nCollisions +1\\.0 +1\\.5 +0\\.5 \\[-0\\.1, 1\\.1\\]\nTeleports "));
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("nothing of safety")));
    EXPECT_EQ(nlohmann::json::parse(equipment_json(facts)).at("events").at(0).at("more").at("mean"), 0.5);
    facts.unsound.collisions = 11;
    EXPECT_THAT(flat_text(facts), HasSubstr("So many collisions are made by the model of drivers: they say "
                                            "nothing of safety."));
    std::ostringstream page;
    write_equipment_page(facts, page);
    EXPECT_THAT(page.str(), AllOf(HasSubstr("Events of a run"), HasSubstr("nothing of safety")));
}

TEST(Equipment, SaysWhatWorksWhereNoSignalIsEquipped) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("all the same")));
    facts.other_parts = {"clear_lane", "give_way"};
    facts.outlook = "By programs alone, it helps.";
    const std::string sentence =
        "clear_lane and give_way of corridor work also where no signal is equipped. For signals alone in "
        "today's traffic: --policy preempt_signals --av-share 0.";
    EXPECT_EQ(count_of(flat_text(facts), sentence), 1U);
    std::ostringstream page;
    write_equipment_page(facts, page);
    const std::size_t place = page.str().find("<p class=\"note\">clear_lane and give_way of corridor work");
    EXPECT_LT(place, page.str().find("By programs alone")) << "the first of the notes";
    EXPECT_THAT(page.str(), HasSubstr("--policy preempt_signals --av-share 0."));
}

TEST(Equipment, SaysOfWhichKindTheIntervalsOfTheCurveAre) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(
        flat_text(facts),
        HasSubstr("Row 2: the signals of ranks 1 and 2 together, and so on; last row: all 12 signals. "
                  "Gains over no signal equipped, with intervals of 95 % each; those above are "
                  "wider, to hold together. %: of the gain of all."));
    facts.ranked.pop_back();
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("those above are wider"))) << "one rank is one interval";
}

TEST(Equipment, HasAnIntervalAtEachStepOfTheCurve) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(equipment_text(facts),
                testing::ContainsRegex("\n +1  30\\.0 \\[26\\.0, 34\\.0\\]  shown +60 "));
    const std::string with = equipment_curve(facts);
    EXPECT_THAT(with, HasSubstr("with intervals of 95 % each"));
    facts.ranked[0].so_far->interval.reset();
    EXPECT_LT(equipment_curve(facts).size(), with.size()) << "the mark of its interval";
}

TEST(Equipment, LeavesOutAColumnThatSaysNothing) {
    EquipmentFacts facts = two_of_twelve();
    const auto has_share = [&] {
        std::ostringstream page;
        write_equipment_page(facts, page);
        EXPECT_EQ(equipment_text(facts).find("of the gain of all") != std::string::npos,
                  page.str().find(">%</th>") != std::string::npos);
        for (const std::string& line : lines_of(equipment_text(facts)))
            if (line.starts_with("Signals ")) return line.find(" % ") != std::string::npos;
        return false;
    };
    EXPECT_TRUE(has_share());
    facts.all_gain = about(50.0, 51.0);
    EXPECT_FALSE(has_share());
}

TEST(Equipment, HasPairsThatWereTriedTogether) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("Gain a signal")));
    facts.pairs = {{{1, 4}, about(2.0, 3.0), true, false},
                   {{4, 9}, about(21.0, 4.0), false, true, about(42.0, 5.0)}};
    const std::string text = flat_text(facts);
    EXPECT_THAT(text,
                AllOf(HasSubstr("21.0 [17.0, 25.0]  shown"),
                      HasSubstr("Chosen as a pair: #4 and #9, which bring 42.0 [37.0, 47.0] s (shown)."),
                      Not(HasSubstr("Not shown:"))));
    EXPECT_LT(text.find("21.0 [17"), text.find("2.0 [-1.0, 5.0]")) << "the greatest gain first";
    EXPECT_THAT(text, Not(HasSubstr("added nothing")));
    EquipmentFacts one_of_both = facts;
    one_of_both.ranked[1].gain = Estimate{10, 0.0, 0.0, Interval{0.0, 0.0}};
    EXPECT_THAT(flat_text(one_of_both), HasSubstr("#9 added nothing to those before in the fresh seeds."));
    EquipmentFacts later = facts;
    later.ranked.insert(later.ranked.begin(),
                        {2, "first", "", about(9.0, 1.0), about(9.0, 1.0), about(0.0, 1.0), about(9.0, 1.0)});
    later.pairs[1].both_gain = about(2.4, 2.5);
    EXPECT_THAT(flat_text(later),
                AllOf(HasSubstr("#4 and #9, which add 2.4 [-0.1, 4.9] s to #2 (not shown)."),
                      HasSubstr("Equip first: 1) #2 first, 2) #4 Gate")));
    EXPECT_EQ(
        pairs_csv(facts),
        "number,with,gain_a_signal_s,gain_a_signal_low_s,gain_a_signal_high_s,shown,pairs,left_race,chosen\n"
        "4,9,21,17,25,true,10,false,true\n1,4,2,-1,5,false,10,true,false\n");
    EXPECT_EQ(nlohmann::json::parse(equipment_json(facts)).at("pairs").at(0).at("with"), 9);
    std::ostringstream page;
    write_equipment_page(facts, page);
    EXPECT_THAT(page.str(), HasSubstr("Gain a signal, s"));
}

TEST(Equipment, EndsWithTheAnswer) {
    const std::string text = flat_text(two_of_twelve());
    const std::string answer =
        text.substr(text.find("Equip first: 1) #4 Gate <Road> / High Street, 2) #9 south of"));
    EXPECT_THAT(answer, HasSubstr("42.0 [38.0, 46.0]"));
    EXPECT_THAT(text,
                HasSubstr("Not shown: what #9 adds to those before, though their sum is. More --seeds"));
    EXPECT_EQ(count_of(text, "More --seeds"), 1U);
    EXPECT_THAT(equipment_text(two_of_twelve()),
                testing::EndsWith(":\nclearway run town --set 'actuation.equipped=#4,#9'\n"));
    EXPECT_THAT(text, HasSubstr("Stopped at 2 of 5"));
    EXPECT_THAT(equipment_text(two_of_twelve()), testing::ContainsRegex("\n +12  50\\.0 \\["));
    EXPECT_LE(answer.size(), 8U * 80U) << "eight lines at the end of a terminal";
}

TEST(Equipment, MarksEachRankThatIsNotShown) {
    EquipmentFacts facts = two_of_twelve();
    facts.ranked.push_back(
        {2, "first", "", about(9.0, 1.0), about(51.0, 1.0), about(0.0, 1.0), about(9.0, 1.0)});
    EXPECT_THAT(flat_text(facts), HasSubstr(" High Street, 2) #9 south of the old town... (not shown), "
                                            "3) #2 first."));
}

TEST(Equipment, SaysWhatItsFreshRunsAreWorthAndHowFewTripsDecided) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(flat_text(facts),
                AllOf(Not(HasSubstr("locked each other")),
                      HasSubstr("Few of the 8 trips that decided pass them (#4: 4, #9: 2)")));
    facts.unsound = {30, 4, 2, 1};
    EXPECT_THAT(
        flat_text(facts),
        HasSubstr(
            "On the fresh seeds vehicles locked each other in 4 of 30 runs, 2 held up by it, and 1 EV did "
            "not arrive: such runs say little of signals. Less traffic: --density 0.8, or less."));
    EXPECT_THAT(equipment_text(facts),
                testing::EndsWith(" run town --density 0.8 --set 'actuation.equipped=#4,#9'\n"));
    facts.density = 1.5;
    facts.study.insert(facts.study.end(), {"--density", "1.5"});
    EXPECT_THAT(equipment_text(facts), HasSubstr("\nclearway run town --density 1.2 --set"));
    EXPECT_EQ(nlohmann::json::parse(equipment_json(facts)).at("fresh_runs_with_locks"), 4);
    facts.unsound = {30, 4, 0, 0};
    EXPECT_THAT(flat_text(facts), AllOf(HasSubstr("locked each other in 4 of 30 runs, none held up by it."),
                                        Not(HasSubstr("say little of signals"))));
    facts.met.trips = 80;
    EXPECT_THAT(flat_text(facts), AllOf(Not(HasSubstr("Few of the")), HasSubstr("Equip first: 1)")));
    facts.unsound.held_up = 16;
    EXPECT_THAT(flat_text(facts),
                AllOf(HasSubstr("No order is shown: locks hold up most fresh runs."),
                      HasSubstr("Chosen, in no order: #4 Gate <Road> / High Street; #9 south of"),
                      Not(HasSubstr("Equip first"))));
}

TEST(Equipment, SaysWhichRanksChangedNothingAndWhosePrograms) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(flat_text(facts), AllOf(Not(HasSubstr("changed no trip")), HasSubstr(" 2) #9")));
    facts.ranked[1].gain = Estimate{10, 0.0, 0.0, Interval{0.0, 0.0}};
    facts.assumptions = "Simulated: random trips of 7 vehicles.";
    EXPECT_THAT(flat_text(facts),
                AllOf(HasSubstr("#9 changed no trip of the fresh seeds: its place is chance."),
                      HasSubstr("Simulated: random trips of 7 vehicles."), Not(HasSubstr(" 2) ")),
                      Not(HasSubstr("Not shown: what #9 adds"))));
    EXPECT_EQ(programs_words("from net.net.xml"), "");
}

EquipmentFacts on_a_large_map(EquipmentFacts facts) {
    facts.less_red = 10;
    return facts;
}

TEST(Equipment, NamesNoBestWhereTheFirstRankIsChance) {
    EquipmentFacts facts = two_of_twelve();
    facts.ranked[0].gain = facts.ranked[0].so_far = Estimate{10, 0.0, 0.0, Interval{0.0, 0.0}};
    facts.ranked[1].gain = facts.ranked[1].so_far = about(3.0, 6.0);
    EXPECT_THAT(
        flat_text(facts),
        AllOf(HasSubstr("No gain is shown: 10 pairs cannot tell which to equip first, and the first choice "
                        "changed no trip."),
              HasSubstr("Chosen, in no order: #4 Gate"), HasSubstr("#4 changed no trip"),
              HasSubstr("Not shown: what any of them adds to those before.")));
    facts.ranked[1].gain = facts.ranked[0].gain;
    EXPECT_THAT(flat_text(facts), HasSubstr("actuation.equipped=#4,#9")) << "all, where none is better";
    facts.ranked.pop_back();
    EXPECT_THAT(flat_text(facts), HasSubstr(" Chosen: #4 Gate"));
}

TEST(Equipment, NamesNoOrderWhereNothingIsShown) {
    EquipmentFacts facts = on_a_large_map(two_of_twelve());
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("seeds would show")));
    facts.ranked[0].gain = facts.ranked[0].so_far = about(2.0, 3.0);
    facts.ranked[1].gain = about(1.0, 4.0);
    facts.ranked[1].so_far = about(3.0, 6.0);
    facts.ranked[1].so_far->deviation = 9.0;
    EXPECT_THAT(flat_text(facts),
                AllOf(HasSubstr("No gain is shown: 10 pairs cannot tell which to equip first."),
                      HasSubstr("Chosen, in no order: #4 Gate <Road> / High"),
                      HasSubstr("Not shown: what any of them adds to those before. "),
                      Not(HasSubstr("More --seeds")), Not(HasSubstr("Equip first")), Not(HasSubstr("1) ")),
                      testing::ContainsRegex("Step +Signal"), Not(HasSubstr("bring 80 %")),
                      HasSubstr("About 73 seeds would likely (80 %) show the gain of all")));
    facts.ranked[1].so_far->mean = 0.1;
    EXPECT_THAT(flat_text(facts), HasSubstr("It would take more than 1000 seeds to show so small a gain"));
    facts.replications = 30;
    EXPECT_THAT(flat_text(facts), HasSubstr("clearway run town --seeds 30 --set"))
        << "as many as were asked for";
    facts.ranked[1].so_far = about(0.0, 0.0);
    facts.ranked[1].so_far->deviation = 0.0;
    EXPECT_THAT(flat_text(facts), HasSubstr("In these runs no trip of an EV was changed"));
    facts.ranked[1].so_far = about(-1.0, 6.0);
    EXPECT_THAT(flat_text(facts), HasSubstr("Their mean is no gain."));
}

/// What two bring together is shown, what the first brings is not.
EquipmentFacts sum_without_order() {
    EquipmentFacts facts = two_of_twelve();
    facts.ranked[0].gain = facts.ranked[0].so_far = about(6.0, 8.0);
    facts.ranked[0].gain->deviation = 10.0;
    facts.ranked[1].gain = about(2.0, 3.0);
    facts.ranked[1].so_far = about(8.0, 7.0);
    return facts;
}

TEST(Equipment, NamesNoOrderWhereOnlyTheSumIsShown) {
    EquipmentFacts facts = on_a_large_map(sum_without_order());
    facts.more_seeds = {"clearway", "equip", "town"};
    // t(n - 1) at 1 - 0.05 / 2 ranks and 80 % times 10 s / sqrt(n): 5.99 s for 29 pairs, 6.10 s for 28.
    const std::string headline =
        "No order is shown: together the 2 chosen bring 8.0 [1.0, 15.0] s a trip; which of them first, 10 "
        "pairs cannot tell (about 29 would likely).";
    EXPECT_THAT(flat_text(facts),
                AllOf(HasSubstr(headline), Not(HasSubstr("Equip first")),
                      HasSubstr("Gains count from no signal equipped. With these signals, the others lose"),
                      HasSubstr("More seeds would likely tell: clearway equip town --seeds 29 To study"),
                      HasSubstr("Not shown: what any of them adds to those before, though their sum is.")));
    const auto json = nlohmann::json::parse(equipment_json(facts));
    EXPECT_EQ(json.at("headline"), headline);
    EXPECT_FALSE(json.at("order_shown").get<bool>());
    EXPECT_TRUE(json.at("rank_with_80_percent").is_null());
    EXPECT_TRUE(nlohmann::json::parse(equipment_json(two_of_twelve())).at("order_shown").get<bool>());
    std::ostringstream page;
    write_equipment_page(facts, page);
    EXPECT_THAT(page.str(), AllOf(HasSubstr("<p class=\"headline\">No order is shown"),
                                  HasSubstr("<code>clearway equip town --seeds 29</code>"),
                                  Not(HasSubstr("Equip first"))));
    EquipmentFacts drawn = facts;
    drawn.roads = three_roads();
    EXPECT_THAT(equipment_map(drawn), HasSubstr(">No order is shown: together"));
    EXPECT_THAT(equipment_curve(drawn),
                AllOf(HasSubstr(">No order is shown: together"), Not(HasSubstr("the first signals"))));
    EXPECT_THAT(equipment_curve(two_of_twelve()), HasSubstr("the first signals"));
}

TEST(Equipment, SaysWhereTheRestOfAGainAboveAllRedComesFrom) {
    EquipmentFacts facts = two_of_twelve();
    facts.red_s = 6.4;
    const std::string sentence = "Red alone costs 6 s of a trip: the rest of the gain is queues, or chance.";
    EXPECT_THAT(flat_text(facts), HasSubstr(sentence));
    facts.red_s = 42.5;
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("Red alone")));
}

TEST(Equipment, SaysWhatASmallMapCannotDecide) {
    EquipmentFacts facts = sum_without_order();
    facts.more_seeds = {"clearway", "equip", "town"};
    EXPECT_THAT(
        flat_text(facts),
        AllOf(HasSubstr("More seeds would narrow the ranges, but find no order on this map: 2 are nearly "
                        "all of its 3 signals that EVs pass. What helps:"),
              Not(HasSubstr("would likely")), Not(HasSubstr("--seeds 29"))))
        << "one advice";
    facts.met = {60, 9, 25};
    EXPECT_THAT(flat_text(facts), HasSubstr("and only 9 of 60 EV trips pass one. What helps:"));
    facts.candidates.push_back(facts.candidates.front());
    facts.met = {8, 5, 15};
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("More seeds are hardly")))
        << "two of four, most trips pass one";
    facts.candidates.pop_back();
    facts.less_red = 1;
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("More seeds are hardly"))) << "EVs pass four here too";
    EXPECT_THAT(flat_text(two_of_twelve()), Not(HasSubstr("More seeds are hardly"))) << "it has decided";
}

TEST(Equipment, SaysWhyASignalWithMoreGainAloneWasNotChosen) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("Not chosen")));
    facts.candidates[0].gain = about(20.0, 3.0);
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("Not chosen"))) << "never tried beside another";
    facts.candidates[0].later = {1, about(0.4, 1.0)};
    EXPECT_THAT(flat_text(facts),
                HasSubstr("Not chosen: #1, which gains 20.0 s alone, adds 0.4 [-0.6, 1.4] s beside #4."));
    facts.candidates[0].gain = about(11.0, 3.0);
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("Not chosen"))) << "less than each that was chosen";
}

TEST(Equipment, ExplainsFewerSeedsOnlyWhereARowHasThem) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(flat_text(facts), HasSubstr("One with fewer seeds was shown to gain less than another."));
    facts.candidates[0].left_race = false;
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("One with fewer seeds")));
}

TEST(Equipment, OpensWithHowManyTripsMeetSignals) {
    EquipmentFacts facts = two_of_twelve();
    const std::string sentence =
        "62 % of the EVs' 8 trips that decide pass at least one signal; a trip meets 1.9 on average.";
    const std::string text = flat_text(facts);
    EXPECT_LT(text.find(sentence), text.find("Gain alone"));
    std::ostringstream page;
    write_equipment_page(facts, page);
    EXPECT_LT(page.str().find("62 % of the EVs"), page.str().find("Equip first"));
    const auto json = nlohmann::json::parse(equipment_json(facts));
    EXPECT_DOUBLE_EQ(json.at("share_of_trips_with_signals").get<double>(), 0.625);
    EXPECT_DOUBLE_EQ(json.at("signals_per_trip").get<double>(), 1.875);
    facts.outlook = "By programs, it <helps>.";
    EXPECT_LT(flat_text(facts).find(facts.outlook), flat_text(facts).find("Gain alone"));
    std::ostringstream with_outlook;
    write_equipment_page(facts, with_outlook);
    EXPECT_THAT(with_outlook.str(), HasSubstr("<p class=\"note\">By programs, it &lt;helps&gt;.</p>"));
    facts.met = {};
    EXPECT_THAT(flat_text(facts), HasSubstr("No EV has a trip in these seeds."));
    EXPECT_TRUE(nlohmann::json::parse(equipment_json(facts)).at("signals_per_trip").is_null());
}

TEST(Equipment, SaysWhatIsEquippedToday) {
    EquipmentFacts facts = two_of_twelve();
    facts.equipped_today = {"east", "west"};
    facts.equipped_and_passed = 1;
    EXPECT_THAT(flat_text(facts), AllOf(HasSubstr("Equipped today: east, west; EVs pass 1 of them."),
                                        HasSubstr("less a trip than with those of today (shown)"),
                                        Not(HasSubstr("no signal equipped"))));
}

TEST(Equipment, SaysThatTheBudgetIsMoreThanThereAreSignals) {
    EquipmentFacts facts = two_of_twelve();
    facts.budget = 12;
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("The budget is")));
    facts.budget = 13;
    EXPECT_THAT(flat_text(facts), HasSubstr("The budget is 13, and the scenario has only 12 signals."));
}

TEST(Equipment, IsShownNowhereWhereNoCandidateGains) {
    EquipmentFacts facts = two_of_twelve();
    facts.ranked.clear();
    facts.all_gain = about(0.0, 0.0);
    for (EquipCandidateFacts& one : facts.candidates)
        one = {one.number, one.signal, one.streets, one.trips, about(0.0, 0.0), false, std::nullopt};
    const std::string text = flat_text(facts);
    EXPECT_THAT(text,
                HasSubstr("No signal to equip: in the mean of the runs none of the 3 candidates gains."));
    EXPECT_THAT(text, Not(HasSubstr("]  shown")));
    EXPECT_THAT(text, Not(HasSubstr("0.0]  shown")));
    const auto json = nlohmann::json::parse(equipment_json(facts));
    for (const auto& row : json.at("candidates"))
        EXPECT_FALSE(row.at("shown").get<bool>());
}

TEST(Equipment, HasNoShareOfAGainThatIsNotShown) {
    EquipmentFacts facts = two_of_twelve();
    facts.all_gain = about(50.0, 51.0);
    EXPECT_FALSE(share_of_all(facts, facts.ranked[0]));
    EXPECT_FALSE(rank_with_share(facts, 0.1));
    EXPECT_THAT(flat_text(facts), HasSubstr("The gain of all signals is not shown to be above 0."));
}

TEST(Equipment, IsNotShownByFewerPairsThanAnIntervalTakes) {
    Estimate four = about(30.0, 4.0);
    four.n = 4;
    EXPECT_FALSE(is_shown(four));
    four.n = 5;
    EXPECT_TRUE(is_shown(four));
    EXPECT_FALSE(is_shown(std::nullopt));
}

TEST(Equipment, SaysWhenTheShareIsNotReached) {
    EquipmentFacts facts = two_of_twelve();
    facts.ranked.pop_back();
    EXPECT_EQ(rank_with_share(facts, 0.6), 1U);
    EXPECT_FALSE(rank_with_share(facts, 0.8));
    EXPECT_THAT(flat_text(facts), HasSubstr("These do not bring 80 % of the gain of all."));
}

}  // namespace
}  // namespace clearway::report
