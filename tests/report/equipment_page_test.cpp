#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "report/detail/equipment_order.hpp"
#include "report/detail/equipment_sheets.hpp"
#include "report/equipment.hpp"
#include "report/equipment_samples.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(EquipmentPage, IsWholeInJsonWithNullForWhatIsMissing) {
    EquipmentFacts facts = two_of_twelve();
    facts.ranked[1].gain->interval.reset();
    facts.alone_s.reset();
    const auto json = nlohmann::json::parse(equipment_json(facts));
    EXPECT_EQ(json.at("ranked").at(0).at("signal"), "north<&>");
    EXPECT_DOUBLE_EQ(json.at("ranked").at(0).at("gain_chosen_by_s").at("mean").get<double>(), 31.0);
    EXPECT_DOUBLE_EQ(json.at("ranked").at(1).at("share_of_all").get<double>(), 0.84);
    EXPECT_TRUE(json.at("ranked").at(1).at("gain_s").at("low").is_null());
    EXPECT_FALSE(json.at("ranked").at(1).at("shown").get<bool>());
    EXPECT_TRUE(json.at("alone_s").is_null());
    EXPECT_EQ(json.at("end"), "no_gain");
    EXPECT_EQ(json.at("command"), "clearway equip town <&>");
    EXPECT_EQ(json.at("rank_with_80_percent"), 2);
    ASSERT_EQ(json.at("candidates").size(), 3U);
    EXPECT_EQ(json.at("candidates").at(0).at("number"), 4);
    EXPECT_EQ(json.at("candidates").at(0).at("rank"), 1);
    EXPECT_TRUE(json.at("candidates").at(2).at("left_race").get<bool>());
    EXPECT_TRUE(json.at("candidates").at(2).at("rank").is_null());
}

TEST(EquipmentPage, IsACurveFromNoneToAllAsCsv) {
    const std::vector<std::string> rows = lines_of(equipment_csv(two_of_twelve()));
    ASSERT_EQ(rows.size(), 5U);
    EXPECT_EQ(
        rows[0],
        "equipped,number,signal,streets,gain_s,gain_low_s,gain_high_s,shown,gain_so_far_s,gain_so_far_low_s,"
        "gain_so_far_high_s,share_of_all,others_time_loss_s,others_time_loss_low_s,"
        "others_time_loss_high_s,gain_chosen_by_s,gain_chosen_by_low_s,gain_chosen_by_high_s");
    EXPECT_EQ(rows[1], "0,,,,,,,,0,,,0,0,,,,,");
    EXPECT_EQ(rows[2],
              "1,4,north<&>,Gate <Road> / High Street,30,26,34,true,30,26,34,0.6,0.5,0.3,0.7,31,27,35");
    EXPECT_EQ(rows[4], "12,,,,,,,,50,45,55,1,2,1,3,,,");
    EquipmentFacts few = two_of_twelve();
    few.ranked[0].gain->n = 4;
    EXPECT_THAT(lines_of(equipment_csv(few))[2], HasSubstr("High Street,30,,,false,"))
        << "no interval from fewer than five pairs";
}

TEST(EquipmentPage, HasItsCandidatesAsCsv) {
    const std::vector<std::string> rows = lines_of(candidates_csv(two_of_twelve()));
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(
        rows[0],
        "number,signal,streets,share_of_trips,gain_s,gain_low_s,gain_high_s,shown,pairs,left_race,rank");
    EXPECT_EQ(rows[1], "4,north<&>,Gate <Road> / High Street,0.45,31,27,35,true,10,false,1");
    EXPECT_EQ(rows[3], "1,west,,0.1,1,-1,3,false,5,true,");
}

TEST(EquipmentPage, IsDrawnAsACurveWithTheGainOfAll) {
    EquipmentFacts facts = two_of_twelve();
    facts.title = "A <town>";
    const std::string svg = equipment_curve(facts);
    EXPECT_THAT(svg, AllOf(HasSubstr("<svg"), HasSubstr("A &lt;town&gt;"), HasSubstr("all of 12 signals"),
                           HasSubstr("signals equipped")));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    facts.ranked.clear();
    facts.all_gain.reset();
    EXPECT_THAT(equipment_curve(facts), Not(HasSubstr("nan")));
}

TEST(EquipmentPage, IsCountedInWholeSignalsBelowTheCurve) {
    EquipmentFacts facts = two_of_twelve();
    for (const std::size_t ranked : {2U, 1U, 0U}) {
        facts.ranked.resize(ranked);
        const std::string svg = equipment_curve(facts);
        for (const char* const half : {">0.5<", ">1.5<", ">0.2<", ">1.0<"})
            EXPECT_THAT(svg, Not(HasSubstr(half))) << ranked;
        EXPECT_THAT(svg, AllOf(HasSubstr(">0</text>"), HasSubstr(">1</text>"))) << ranked;
    }
}

TEST(EquipmentPage, IsMappedWithCandidatesAndChosenDrawnApart) {
    EquipmentFacts facts = two_of_twelve();
    EXPECT_THAT(equipment_map(facts), testing::IsEmpty()) << "no roads, no map";
    facts.roads = three_roads();
    const std::string svg = equipment_map(facts);
    EXPECT_EQ(count_of(svg, "<circle class=\"spare\""), 2U) << "west, and the legend";
    EXPECT_EQ(count_of(svg, ">#1</text>"), 2U) << "a signal has a hash, a rank has none";
    EXPECT_EQ(count_of(svg, ">1</text>"), 2U) << "rank 1, and its example in the legend";
    EXPECT_THAT(svg, HasSubstr("chosen, gain shown (rank 1 is #4)"));
    EXPECT_EQ(count_of(svg, "<circle class=\"tick\""), 2U) << "east, and the legend";
    EXPECT_EQ(count_of(svg, "<circle class=\"dot better\""), 2U) << "north, and the legend";
    EXPECT_THAT(svg,
                AllOf(HasSubstr("chosen, gain shown"), HasSubstr("other candidate"), HasSubstr("left out")));
    facts.roads->stations = {{"a", "fire_station", "New <post>"}};
    EXPECT_THAT(equipment_map(facts), AllOf(HasSubstr("New &lt;post&gt;"), HasSubstr(">fire station<")));
    facts.roads->stations.clear();
    facts.ranked[0].gain = about(30.0, 31.0);
    EXPECT_EQ(count_of(equipment_map(facts), "<circle class=\"station\""), 2U) << "north is not shown";
    for (std::size_t number = 20; number < 50; ++number)
        facts.candidates.push_back(
            {number, std::to_string(number), "", 0.1, about(1.0, 2.0), true, std::nullopt});
    EXPECT_EQ(count_of(equipment_map(facts), "<circle class=\"held\""), 2U) << "no room for so many numbers";
}

TEST(EquipmentPage, NumbersTheMapAsTheTablesWhereThereIsNoOrder) {
    EquipmentFacts facts = two_of_twelve();
    facts.roads = three_roads();
    const auto page_of = [&] {
        std::ostringstream page;
        write_equipment_page(facts, page);
        return page.str();
    };
    EXPECT_THAT(page_of(), HasSubstr("Discs show ranks: 1 is #4, 2 is #9."));
    for (analysis::MaybeEstimate* const gain : {&facts.ranked[0].gain, &facts.ranked[0].so_far})
        *gain = about(2.0, 3.0);
    facts.ranked[1].gain = facts.ranked[1].so_far = about(3.0, 6.0);
    EXPECT_THAT(page_of(), HasSubstr("Numbers are those of the tables."));
    EXPECT_THAT(equipment_map(facts), AllOf(HasSubstr(">#4</text>"), Not(HasSubstr(">1</text>"))));
}

TEST(EquipmentPage, HasAPageWithAnswerMapTablesAndCommand) {
    EquipmentFacts facts = two_of_twelve();
    facts.roads = three_roads();
    facts.attribution = "OpenStreetMap contributors";
    EXPECT_THAT(equipment_map(facts),
                AllOf(HasSubstr("OpenStreetMap contributors</text>"), HasSubstr(">1</text>")));
    std::ostringstream page;
    write_equipment_page(facts, page);
    const std::string html = page.str();
    EXPECT_THAT(
        html,
        AllOf(HasSubstr("<section id=\"equipment\">"), HasSubstr("<section id=\"candidates\">"),
              HasSubstr("id=\"map\""), HasSubstr("id=\"curve\""),
              HasSubstr("clearway equip town &lt;&amp;&gt;"), HasSubstr("12.0 [\u22121.0, 25.0]"),
              HasSubstr("not shown"), HasSubstr("OpenStreetMap contributors"),
              testing::ContainsRegex(
                  "the others lose [^.]* s each \\(not shown\\)|the others lose .* s each \\(shown\\)")));
    EXPECT_THAT(html, Not(HasSubstr("north<&>")));
    EXPECT_THAT(html, HasSubstr("south of the old town&#39;s gate"));
    EXPECT_EQ(count_of(html, "<th scope=\"row\">"), 8U) << "3 candidates, 2 ranks, 1, 2 and all signals";
    EXPECT_THAT(html,
                AllOf(HasSubstr("<li>Not shown: what #9 adds to those before, though their sum is."),
                      HasSubstr("<code>clearway run town --set &#39;actuation.equipped=#4,#9&#39;</code>")));
    EquipmentFacts joined = facts;
    joined.candidates[0].signal = "cluster_" + std::string(90, '1');
    joined.candidates[1].streets = std::string(66, 'a');
    std::ostringstream cut;
    write_equipment_page(joined, cut);
    EXPECT_THAT(cut.str(),
                AllOf(HasSubstr("cluster_" + std::string(13, '1') + "..."), HasSubstr(std::string(66, 'a'))));
}

TEST(EquipmentPage, BeginsWithAnAnswerForThoseWhoDecide) {
    EquipmentFacts facts = two_of_twelve();
    facts.split = {60, 45, about(56.0, 4.0), about(0.4, 2.0)};
    facts.ranked.back().signal = "S";
    EXPECT_THAT(
        detail::council_lines(facts),
        testing::ElementsAre(
            "Equip first #4 Gate <Road> / High Street, then #9 S (its own gain is not shown).",
            "An ambulance that passes one of them (45 of 60 trips) arrives 56 s sooner (52 s to 60 s). In "
            "the "
            "mean of all trips, which take 150 s: 42 s sooner (38 s to 46 s).",
            "Everybody else, a trip: 1.0 s more delay (0.6 s to 1.4 s).",
            "10 simulations with them and 10 without, of the same traffic. The ranges cover chance "
            "among such "
            "simulations (95 %), not whether your traffic, signal programs and calls are like "
            "those simulated, which stand below.",
            "To know more: your signals' programs, your stations and your counts of traffic."));
    std::ostringstream page;
    write_equipment_page(facts, page);
    const std::string html = page.str();
    EXPECT_LT(html.find("<section id=\"council\">"), html.find("<section id=\"equipment\">"));
    EXPECT_THAT(html, HasSubstr("<li>Equip first #4 Gate &lt;Road&gt; / High Street, then #9"));
    EXPECT_EQ(nlohmann::json::parse(equipment_json(facts)).at("council").size(), 5U);
    facts.ranked.clear();
    std::ostringstream without;
    write_equipment_page(facts, without);
    EXPECT_THAT(without.str(), Not(HasSubstr("For the council")));
}

TEST(EquipmentPage, TellsACouncilNoMoreThanTheRunsShow) {
    EquipmentFacts facts = two_of_twelve();
    for (EquippedSignal& signal : facts.ranked)
        signal.gain = signal.so_far = about(3.0, 6.0);
    facts.ranked.back().others = about(-0.2, 0.5);
    facts.ranked.back().signal = "S";
    facts.split = {60, 8, about(109.0, 35.0), about(0.4, 2.0)};
    EXPECT_THAT(
        detail::findings_of(facts).front(),
        HasSubstr("EVs that pass a chosen signal gain 109.0 [74.0, 144.0] s each, 8 of 60 trips; over "
                  "all trips no gain is shown"));
    EXPECT_THAT(detail::findings_of(facts), testing::Contains(HasSubstr("The other trips gain 0.4 ")));
    std::vector<std::string> lines = detail::council_lines(facts);
    EXPECT_THAT(
        lines[0],
        HasSubstr(
            "The best guess: #4 Gate <Road> / High Street; #9 S. They help those who pass them; few do."));
    EXPECT_THAT(lines[1], HasSubstr("3.0 s sooner (from 3.0 s later to 9.0 s sooner: it may be chance)"));
    EXPECT_THAT(lines[2],
                HasSubstr("0.2 s less delay (from 0.7 s less delay to 0.3 s more delay: it may be"));
    facts.split.passing_gain = about(9.0, 35.0);
    EXPECT_THAT(detail::council_lines(facts)[0], HasSubstr("No recommendation: that ambulances gain is not"));
    facts.ranked.back().so_far = about(9.0, 6.0);
    EXPECT_THAT(detail::council_lines(facts)[0],
                testing::EndsWith("Which of them first, the simulations do not tell."));
    facts.ranked.front().so_far = about(8.0, 6.0);
    EXPECT_THAT(detail::council_lines(facts)[0],
                testing::EndsWith("the simulations do not tell. As far as is shown, #4 is enough."))
        << "what #9 adds is not shown";
    facts.ranked.back().so_far = about(9.0, 8.9);
    EXPECT_THAT(detail::council_lines(facts)[1],
                HasSubstr("sooner (0.1 s to 18 s: it may be next to nothing)"));
    facts.unsound = {10, 8, 6, 0, 0, 0};
    lines = detail::council_lines(facts);
    EXPECT_THAT(lines[0], HasSubstr("No recommendation: traffic blocked itself in most simulations."));
    EXPECT_THAT(lines[3], HasSubstr("A doubt: vehicles locked each other in 8 of 10 runs"));
    for (analysis::MaybeEstimate* const gain : {&facts.split.passing_gain, &facts.ranked.back().so_far})
        (*gain)->n = 3;
    EXPECT_THAT(detail::council_lines(facts)[1], HasSubstr("sooner, from too few simulations for a range"));
}

TEST(EquipmentPage, ExplainsTheWordsOfItsPageOnce) {
    std::ostringstream page;
    write_equipment_page(two_of_twelve(), page);
    for (const char* const words : {"Seed 7 decides: its runs choose", "Seed 8 estimates: fresh runs",
                                    "Restricted mean travel time: mean time", "Alone: of a signal"})
        EXPECT_EQ(count_of(page.str(), words), 1U) << words;
}

TEST(EquipmentPage, HasRoomForLongNamesAboveTheIntervalsOfCandidates) {
    EquipmentFacts facts = two_of_twelve();
    const auto page_of = [&] {
        std::ostringstream page;
        write_equipment_page(facts, page);
        return page.str();
    };
    facts.candidates[0].streets = std::string(36, 'a');
    EXPECT_EQ(count_of(page_of(), "text-anchor=\"end\">#1 " + std::string(36, 'a') + "<"), 1U);
    facts.candidates[0].streets = std::string(68, 'a');
    EXPECT_EQ(count_of(page_of(), "text-anchor=\"start\">#1 " + std::string(68, 'a') + "<"), 1U);
}

TEST(EquipmentPage, marks_coarse_steps_on_the_console_and_the_page) {
    EquipmentFacts facts = two_of_twelve();
    facts.step_length_s = 0.25;
    EXPECT_THAT(flat_text(facts), Not(HasSubstr("steps of")));
    facts.step_length_s = 1.0;
    const std::string words = "steps of 1 s: use them only to compare";
    EXPECT_THAT(flat_text(facts), HasSubstr(words));
    std::ostringstream page;
    write_equipment_page(facts, page);
    EXPECT_THAT(page.str(), HasSubstr("<p class=\"note\">(!) " + words));
}

}  // namespace
}  // namespace clearway::report
