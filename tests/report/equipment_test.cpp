#include "report/equipment.hpp"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace clearway::report {
namespace {

using analysis::Estimate;
using analysis::Interval;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Estimate about(double mean, double half_width) {
    return {10, mean, 1.0, Interval{mean - half_width, mean + half_width}};
}

/// Twelve signals, ten of which EVs pass. The first two bring 30 and 42 of 50 s.
EquipmentFacts two_of_twelve() {
    EquipmentFacts facts;
    facts.scenario = "town";
    facts.title = "A town";
    facts.condition = "corridor";
    facts.seed = 7;
    facts.replications = 10;
    facts.budget = 5;
    facts.signals = 12;
    facts.not_passed = 2;
    facts.all_gain = about(50.0, 5.0);
    facts.all_others = about(2.0, 1.0);
    facts.baseline_s = about(151.0, 9.0);
    facts.none_s = about(150.0, 9.0);
    facts.all_s = about(100.0, 8.0);
    facts.alone_s = about(95.0, 7.0);
    facts.ranked = {{4, "north<&>", about(30.0, 4.0), about(30.0, 4.0), about(0.5, 0.2)},
                    {9, "south", about(12.0, 3.0), about(42.0, 4.0), about(1.0, 0.4)}};
    facts.end = analysis::EquipEnd::no_effect;
    facts.next = EquippedSignal{1, "west", about(1.0, 2.0), about(43.0, 4.0), about(1.0, 0.4)};
    return facts;
}

TEST(Equipment, HasARowForEachRankAndSaysWhatItFound) {
    const std::string text = equipment_text(two_of_twelve());
    EXPECT_THAT(text, HasSubstr("30.0 [26.0, 34.0]   30.0 [26.0, 34.0]    60"));
    EXPECT_THAT(text, HasSubstr("12.0 [9.0, 15.0]   42.0 [38.0, 46.0]    84"));
    EXPECT_THAT(text, HasSubstr("2 of 12 signals bring 80 % of the gain of all."));
    EXPECT_THAT(text, HasSubstr("signal 1 (west), shows no effect: 1.00 s [-1.00, 3.00]"));
    EXPECT_THAT(text, HasSubstr("Left out: 2 of 12 signals, which no EV passes"));
    EXPECT_THAT(text, HasSubstr("baseline 151.0 [142.0, 160.0]"));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 100U) << line;
}

TEST(Equipment, SaysThatTheBudgetIsMoreThanThereAreSignals) {
    EquipmentFacts facts = two_of_twelve();
    facts.budget = 12;
    EXPECT_THAT(equipment_text(facts), Not(HasSubstr("The budget is")));
    facts.budget = 13;
    EXPECT_THAT(equipment_text(facts),
                HasSubstr("The budget is 13, and the scenario has only 12 signals.\n"));
}

TEST(Equipment, HasNoShareOfAGainThatIsNotShown) {
    EquipmentFacts facts = two_of_twelve();
    facts.all_gain = about(50.0, 51.0);
    EXPECT_FALSE(share_of_all(facts, facts.ranked[0]));
    EXPECT_FALSE(rank_with_share(facts, 0.1));
    EXPECT_THAT(equipment_text(facts), HasSubstr("The gain of all signals is not shown to be above 0."));
}

TEST(Equipment, SaysWhenTheShareIsNotReached) {
    EquipmentFacts facts = two_of_twelve();
    facts.ranked.pop_back();
    EXPECT_EQ(rank_with_share(facts, 0.6), 1U);
    EXPECT_FALSE(rank_with_share(facts, 0.8));
    EXPECT_THAT(equipment_text(facts), HasSubstr("These do not bring 80 % of the gain of all."));
}

TEST(Equipment, IsAJsonObjectWithNullForWhatIsMissing) {
    EquipmentFacts facts = two_of_twelve();
    facts.ranked[1].gain->interval.reset();
    facts.alone_s.reset();
    const auto json = nlohmann::json::parse(equipment_json(facts));
    EXPECT_EQ(json.at("ranked").at(0).at("signal"), "north<&>");
    EXPECT_DOUBLE_EQ(json.at("ranked").at(1).at("share_of_all").get<double>(), 0.84);
    EXPECT_TRUE(json.at("ranked").at(1).at("gain_s").at("low").is_null());
    EXPECT_TRUE(json.at("alone_s").is_null());
    EXPECT_EQ(json.at("end"), "no_effect");
    EXPECT_EQ(json.at("next").at("number"), 1);
    EXPECT_EQ(json.at("rank_with_80_percent"), 2);
}

TEST(Equipment, IsACurveFromNoneToAllAsCsv) {
    std::istringstream lines(equipment_csv(two_of_twelve()));
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line);)
        rows.push_back(line);
    ASSERT_EQ(rows.size(), 5U);
    EXPECT_EQ(rows[1], "0,,,,,,0,,,0,0,,");
    EXPECT_EQ(rows[2], "1,4,north<&>,30,26,34,30,26,34,0.6,0.5,0.3,0.7");
    EXPECT_EQ(rows[4], "12,,,,,,50,45,55,1,2,1,3");
    for (const std::string& row : rows)
        EXPECT_EQ(std::ranges::count(row, ','), 12) << row;
}

TEST(Equipment, IsDrawnAsACurveWithTheGainOfAll) {
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

}  // namespace
}  // namespace clearway::report
