#include "analysis/equipment.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>

namespace clearway::analysis {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Seconds that sets of signals take away from 100 s, written by hand. Three replications, which differ by
/// `spread` around the mean: -spread, 0, +spread.
class Crossroads {
  public:
    Crossroads(std::size_t signals, std::map<std::set<std::size_t>, double> gains, double spread = 0.0)
        : signals_(signals), gains_(std::move(gains)), spread_(spread) {}

    EquipPlan plan(std::size_t budget, Search search = Search::lazy) {
        return equip_greedily({100.0, 100.0, 100.0}, {signals_, budget, search},
                              [this](const std::vector<SignalSet>& sets) { return measure(sets); });
    }
    /// Sets that were asked for, call by call.
    const std::vector<std::vector<SignalSet>>& calls() const { return calls_; }

  private:
    std::vector<Values> measure(const std::vector<SignalSet>& sets) {
        calls_.push_back(sets);
        std::vector<Values> values;
        for (const SignalSet& set : sets) {
            const double time_s = 100.0 - gains_.at({set.begin(), set.end()});
            values.push_back({time_s - spread_, time_s, time_s + spread_});
        }
        return values;
    }

    std::size_t signals_;
    std::map<std::set<std::size_t>, double> gains_;
    double spread_;
    std::vector<std::vector<SignalSet>> calls_;
};

std::vector<std::size_t> chosen(const EquipPlan& plan) {
    std::vector<std::size_t> numbers;
    for (const EquipStep& step : plan.steps)
        numbers.push_back(step.candidate);
    return numbers;
}

TEST(Equipment, IsChosenByTheGainOverTheSignalsChosenBefore) {
    // 1 is best alone, but once 1 is there 0 adds less than 2: both lie on the same street.
    Crossroads roads(3, {{{0}, 8.0}, {{1}, 9.0}, {{2}, 5.0}, {{0, 1}, 10.0}, {{1, 2}, 14.0}});
    const EquipPlan plan = roads.plan(2, Search::thorough);
    EXPECT_THAT(chosen(plan), ElementsAre(1, 2));
    EXPECT_EQ(plan.end, EquipEnd::budget);
    EXPECT_DOUBLE_EQ(plan.steps[0].gain->mean, 9.0);
    EXPECT_DOUBLE_EQ(plan.steps[1].gain->mean, 5.0);
    EXPECT_DOUBLE_EQ(plan.steps[1].so_far->mean, 14.0);
    EXPECT_EQ(plan.measured, 5U);
}

TEST(Equipment, IsSearchedLazilyOnlyWhereItsLastGainCouldStillBeTheGreatest) {
    Crossroads roads(4, {{{0}, 9.0}, {{1}, 8.0}, {{2}, 5.0}, {{3}, 1.0}, {{0, 1}, 15.0}});
    const EquipPlan plan = roads.plan(2);
    EXPECT_THAT(chosen(plan), ElementsAre(0, 1));
    ASSERT_EQ(roads.calls().size(), 2U);
    EXPECT_EQ(roads.calls()[0].size(), 4U) << "at first every signal by itself";
    EXPECT_THAT(roads.calls()[1], ElementsAre(SignalSet{0, 1})) << "6 s are more than 5 s and 1 s alone";
    EXPECT_EQ(plan.measured, 5U);
}

TEST(Equipment, IsTriedAgainInTheLazySearchUntilNoOlderGainIsGreater) {
    // 1 falls from 8 s to 1 s beside 0, so 2 with 5 s alone has to be tried; its 4 s beat 3 with 3 s.
    Crossroads roads(4, {{{0}, 9.0}, {{1}, 8.0}, {{2}, 5.0}, {{3}, 3.0}, {{0, 1}, 10.0}, {{0, 2}, 13.0}});
    EXPECT_THAT(chosen(roads.plan(2)), ElementsAre(0, 2));
    EXPECT_EQ(roads.calls().size(), 3U);
}

TEST(Equipment, IsFoundByTheThoroughSearchAloneWhereASignalPaysOnlyWithAnother) {
    const std::map<std::set<std::size_t>, double> gains = {
        {{0}, 9.0}, {{1}, 5.0}, {{2}, 0.0}, {{0, 1}, 13.0}, {{0, 2}, 20.0}};
    EXPECT_THAT(chosen(Crossroads(3, gains).plan(2, Search::lazy)), ElementsAre(0, 1));
    EXPECT_THAT(chosen(Crossroads(3, gains).plan(2, Search::thorough)), ElementsAre(0, 2));
}

TEST(Equipment, OfEqualGainGoesToTheFirst) {
    Crossroads roads(3, {{{0}, 4.0}, {{1}, 6.0}, {{2}, 6.0}, {{1, 2}, 10.0}, {{0, 1}, 10.0}});
    EXPECT_THAT(chosen(roads.plan(1)), ElementsAre(1));
    EXPECT_THAT(chosen(roads.plan(2, Search::thorough)), ElementsAre(1, 0));
}

TEST(Equipment, IsNotChosenAtAllWhereTheFirstShowsNoEffect) {
    // Gains of -1, 2 and 5 s: mean 2 s, interval 2 -+ 4.303 x 3 / sqrt(3) = [-5.5, 9.5].
    Crossroads roads(2, {{{0}, 2.0}, {{1}, 1.0}}, 3.0);
    const EquipPlan plan = roads.plan(2);
    EXPECT_THAT(plan.steps, IsEmpty());
    EXPECT_EQ(plan.end, EquipEnd::no_effect);
    ASSERT_TRUE(plan.next && plan.next->gain && plan.next->gain->interval);
    EXPECT_EQ(plan.next->candidate, 0U);
    EXPECT_NEAR(plan.next->gain->interval->low, 2.0 - 4.3027 * 3.0 / 1.7321, 0.01);
}

TEST(Equipment, IsChosenWhereTheSameGainIsCertain) {
    Crossroads roads(2, {{{0}, 2.0}, {{1}, 1.0}}, 0.0);
    EXPECT_THAT(chosen(roads.plan(1)), ElementsAre(0));
}

TEST(Equipment, StopsBeforeASignalThatHurtsOrGainsNothing) {
    Crossroads hurts(2, {{{0}, 5.0}, {{1}, -1.0}, {{0, 1}, 3.0}});
    const EquipPlan plan = hurts.plan(2);
    EXPECT_THAT(chosen(plan), ElementsAre(0));
    EXPECT_EQ(plan.end, EquipEnd::no_effect);
    EXPECT_DOUBLE_EQ(plan.next->gain->mean, -2.0);
    EXPECT_DOUBLE_EQ(plan.next->so_far->mean, 3.0);
    Crossroads idle(1, {{{0}, 0.0}});
    EXPECT_EQ(idle.plan(1).end, EquipEnd::no_effect);
}

TEST(Equipment, EndsWithTheLastSignalOfASmallNetwork) {
    Crossroads roads(2, {{{0}, 5.0}, {{1}, 3.0}, {{0, 1}, 8.0}});
    const EquipPlan plan = roads.plan(7);
    EXPECT_THAT(chosen(plan), ElementsAre(0, 1));
    EXPECT_EQ(plan.end, EquipEnd::exhausted);
    EXPECT_FALSE(plan.next);
    Crossroads none(0, {});
    EXPECT_EQ(none.plan(1).end, EquipEnd::exhausted);
}

TEST(Equipment, IsJudgedByTheReplicationsThatBothSetsHave) {
    const auto measure = [](const std::vector<SignalSet>& sets) {
        return std::vector<Values>(sets.size(), Values{std::nullopt, 90.0, 180.0});
    };
    const EquipPlan plan = equip_greedily({50.0, 100.0, 190.0}, {1, 1, Search::lazy}, measure);
    ASSERT_EQ(plan.steps.size(), 1U);
    EXPECT_EQ(plan.steps[0].gain->n, 2U);
    EXPECT_DOUBLE_EQ(plan.steps[0].gain->mean, 10.0);
}

TEST(Equipment, WithoutAPairOfRunsHasNoEffect) {
    const auto measure = [](const std::vector<SignalSet>& sets) {
        return std::vector<Values>(sets.size(), Values{std::nullopt, std::nullopt});
    };
    const EquipPlan plan = equip_greedily({50.0, 100.0}, {2, 2, Search::lazy}, measure);
    EXPECT_EQ(plan.end, EquipEnd::no_effect);
    EXPECT_FALSE(plan.next->gain);
}

}  // namespace
}  // namespace clearway::analysis
