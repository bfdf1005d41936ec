#include "analysis/equipment.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <random>
#include <set>

#include <gmock/gmock.h>

namespace clearway::analysis {
namespace {

using testing::ElementsAre;

/// Seconds that sets of signals take away from 100 s, written by hand. Replications differ by `spread` around
/// the mean: -spread, 0, +spread, and so on.
class Crossroads {
  public:
    Crossroads(std::size_t signals, std::map<std::set<std::size_t>, double> gains, double spread = 0.0)
        : signals_(signals), gains_(std::move(gains)), spread_(spread) {
        gains_[{}] = 0.0;
    }

    EquipPlan plan(std::size_t budget, Search search = Search::lazy, std::size_t replications = 3) {
        return equip_greedily(
            {signals_, budget, replications, search, usual_level, pairs_},
            [this](const std::vector<SignalSet>& sets, std::size_t wanted) { return measure(sets, wanted); });
    }
    void try_pair(std::size_t first, std::size_t second) { pairs_.push_back({first, second}); }
    /// Sets that were asked for, call by call, without the one chosen before, which comes first.
    const std::vector<std::vector<SignalSet>>& calls() const { return calls_; }
    const std::vector<std::size_t>& looks() const { return looks_; }

  private:
    std::vector<Values> measure(const std::vector<SignalSet>& sets, std::size_t replications) {
        calls_.emplace_back(sets.begin() + 1, sets.end());
        looks_.push_back(replications);
        std::vector<Values> values;
        for (const SignalSet& set : sets) {
            Values& times = values.emplace_back();
            const double time_s = 100.0 - gains_.at({set.begin(), set.end()});
            for (std::size_t at = 0; at < replications; ++at)
                times.emplace_back(time_s +
                                   (set.empty() ? 0.0 : spread_ * (static_cast<double>(at % 3) - 1.0)));
        }
        return values;
    }

    std::size_t signals_;
    std::map<std::set<std::size_t>, double> gains_;
    double spread_;
    std::vector<std::array<std::size_t, 2>> pairs_;
    std::vector<std::vector<SignalSet>> calls_;
    std::vector<std::size_t> looks_;
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
}

TEST(Equipment, IsSearchedLazilyOnlyWhereItsLastGainCouldStillBeTheGreatest) {
    Crossroads roads(4, {{{0}, 9.0}, {{1}, 8.0}, {{2}, 5.0}, {{3}, 1.0}, {{0, 1}, 15.0}});
    EXPECT_THAT(chosen(roads.plan(2)), ElementsAre(0, 1));
    ASSERT_EQ(roads.calls().size(), 2U);
    EXPECT_EQ(roads.calls()[0].size(), 4U) << "at first every signal by itself";
    EXPECT_THAT(roads.calls()[1], ElementsAre(SignalSet{0, 1})) << "6 s are more than 5 s and 1 s alone";
}

TEST(Equipment, IsTriedAgainInTheLazySearchUntilNoOlderGainIsGreater) {
    // 1 falls from 8 s to 1 s beside 0, so 2 with 5 s alone has to be tried; its 4 s beat 3 with 3 s.
    Crossroads roads(4, {{{0}, 9.0}, {{1}, 8.0}, {{2}, 5.0}, {{3}, 3.0}, {{0, 1}, 10.0}, {{0, 2}, 13.0}});
    EXPECT_THAT(chosen(roads.plan(2)), ElementsAre(0, 2));
    EXPECT_EQ(roads.calls().size(), 3U);
    const EquipPlan plan = roads.plan(2);
    EXPECT_EQ(plan.candidates[1].later.ranks, 1U) << "beside 0";
    EXPECT_DOUBLE_EQ(plan.candidates[1].later.gain->mean, 1.0);
    EXPECT_EQ(plan.candidates[3].later.ranks, 0U) << "3 s were too few to try";
}

TEST(Equipment, IsFoundByTheThoroughSearchAloneWhereASignalPaysOnlyWithAnother) {
    const std::map<std::set<std::size_t>, double> gains = {
        {{0}, 9.0}, {{1}, 5.0}, {{2}, 0.0}, {{0, 1}, 13.0}, {{0, 2}, 20.0}};
    EXPECT_THAT(chosen(Crossroads(3, gains).plan(2, Search::lazy)), ElementsAre(0, 1));
    EXPECT_THAT(chosen(Crossroads(3, gains).plan(2, Search::thorough)), ElementsAre(0, 2));
}

TEST(Equipment, IsFoundInPairsWhereASignalPaysOnlyWithItsNeighbour) {
    Crossroads roads(3,
                     {{{0}, 3.0}, {{1}, 0.0}, {{2}, -1.0}, {{1, 2}, 12.0}, {{0, 1}, 3.0}, {{0, 1, 2}, 14.0}});
    roads.try_pair(1, 2);
    const EquipPlan plan = roads.plan(3);
    EXPECT_THAT(chosen(plan), ElementsAre(1, 2, 0)) << "6 s a signal are more than 3 s";
    EXPECT_EQ(plan.steps[0].partner, 2U);
    EXPECT_EQ(plan.steps[1].partner, 1U);
    EXPECT_EQ(plan.steps[2].partner, std::nullopt);
    EXPECT_DOUBLE_EQ(plan.steps[0].gain->mean, 6.0);
    EXPECT_DOUBLE_EQ(plan.steps[2].gain->mean, 2.0) << "over both";
    ASSERT_EQ(plan.pairs.size(), 1U);
    EXPECT_DOUBLE_EQ(plan.pairs[0].gain->mean, 6.0);
    EXPECT_EQ(plan.candidates.size(), 3U);
}

TEST(Equipment, IsNotTriedInPairsThatDoNotFitTheBudget) {
    Crossroads roads(3, {{{0}, 3.0}, {{1}, 0.0}, {{2}, -1.0}, {{1, 2}, 12.0}, {{0, 1}, 2.0}, {{0, 2}, 2.0}});
    roads.try_pair(1, 2);
    EXPECT_THAT(chosen(roads.plan(1)), ElementsAre(0));
    EXPECT_TRUE(roads.plan(1).pairs.empty());
    EXPECT_THAT(chosen(roads.plan(2)), ElementsAre(1, 2));
}

TEST(Equipment, OfAPairWithAChosenSignalIsTriedAlone) {
    Crossroads roads(2, {{{0}, 9.0}, {{1}, 1.0}, {{0, 1}, 11.0}});
    roads.try_pair(0, 1);
    const EquipPlan plan = roads.plan(2);
    EXPECT_THAT(chosen(plan), ElementsAre(0, 1));
    EXPECT_EQ(plan.steps[0].partner, std::nullopt) << "9 s are more than 5.5 s";
    EXPECT_DOUBLE_EQ(plan.steps[1].gain->mean, 2.0);
}

TEST(Equipment, OfEqualGainGoesToTheFirst) {
    Crossroads roads(3, {{{0}, 4.0}, {{1}, 6.0}, {{2}, 6.0}, {{1, 2}, 10.0}, {{0, 1}, 10.0}});
    EXPECT_THAT(chosen(roads.plan(1)), ElementsAre(1));
    EXPECT_THAT(chosen(roads.plan(2, Search::thorough)), ElementsAre(1, 0));
}

TEST(Equipment, IsLikelyBestEvenWhereNothingIsShown) {
    // Gains of -1, 2 and 5 s: mean 2 s; t(2) at 1 - 0.05 / 2 a candidate is 6.205, the deviation 3 s.
    Crossroads roads(2, {{{0}, 2.0}, {{1}, 1.0}, {{0, 1}, 2.5}}, 3.0);
    const EquipPlan plan = roads.plan(2);
    EXPECT_THAT(chosen(plan), ElementsAre(0, 1));
    ASSERT_EQ(plan.candidates.size(), 2U);
    EXPECT_NEAR(plan.candidates[0].gain->interval->low, 2.0 - 6.205 * 3.0 / 1.7321, 0.01);
    EXPECT_DOUBLE_EQ(plan.candidates[1].gain->mean, 1.0);
}

TEST(Equipment, StopsBeforeASignalThatHurtsOrGainsNothing) {
    Crossroads hurts(2, {{{0}, 5.0}, {{1}, -1.0}, {{0, 1}, 3.0}});
    const EquipPlan plan = hurts.plan(2);
    EXPECT_THAT(chosen(plan), ElementsAre(0));
    EXPECT_EQ(plan.end, EquipEnd::no_gain);
    EXPECT_DOUBLE_EQ(plan.next->gain->mean, -2.0);
    Crossroads idle(1, {{{0}, 0.0}});
    EXPECT_EQ(idle.plan(1).end, EquipEnd::no_gain);
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
    const auto measure = [](const std::vector<SignalSet>&, std::size_t) -> std::vector<Values> {
        return {{50.0, 100.0, 190.0}, {std::nullopt, 90.0, 180.0}};
    };
    const EquipPlan plan = equip_greedily({1, 1, 3, Search::lazy}, measure);
    ASSERT_EQ(plan.steps.size(), 1U);
    EXPECT_EQ(plan.steps[0].gain->n, 2U);
    EXPECT_DOUBLE_EQ(plan.steps[0].gain->mean, 10.0);
}

TEST(Equipment, WithoutAPairOfRunsIsNotChosen) {
    const auto measure = [](const std::vector<SignalSet>& sets, std::size_t) {
        return std::vector<Values>(sets.size(), Values{std::nullopt, std::nullopt});
    };
    const EquipPlan plan = equip_greedily({2, 2, 2, Search::lazy}, measure);
    EXPECT_EQ(plan.end, EquipEnd::no_gain);
    EXPECT_FALSE(plan.next->gain);
}

TEST(Equipment, IsRacedInLooksThatDouble) {
    EXPECT_THAT(equip_looks(3), ElementsAre(3));
    EXPECT_THAT(equip_looks(5), ElementsAre(5));
    EXPECT_THAT(equip_looks(10), ElementsAre(5, 10));
    EXPECT_THAT(equip_looks(30), ElementsAre(5, 10, 20, 30));
}

TEST(Equipment, LeavesTheRaceWhereAnotherIsShownToGainMore) {
    Crossroads roads(3, {{{0}, 9.0}, {{1}, 8.0}, {{2}, 8.5}}, 0.0);
    const EquipPlan plan = roads.plan(1, Search::lazy, 10);
    EXPECT_THAT(roads.looks(), ElementsAre(5, 10));
    EXPECT_THAT(roads.calls()[1], ElementsAre(SignalSet{0})) << "the differences do not vary at all";
    EXPECT_TRUE(plan.candidates[1].left_race);
    EXPECT_EQ(plan.candidates[1].gain->n, 5U);
    EXPECT_FALSE(plan.candidates[0].left_race);
    EXPECT_EQ(plan.candidates[0].gain->n, 10U);
}

/// Times of candidates with these gains and independent normal noise, the same for every call.
MeasureSets noisy(std::vector<double> gains, double deviation, unsigned seed) {
    auto times = std::make_shared<std::vector<Values>>();
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, deviation);
    for (const double gain : gains) {
        Values& values = times->emplace_back();
        for (int at = 0; at < 20; ++at)
            values.emplace_back(100.0 - gain + noise(random));
    }
    return [times](const std::vector<SignalSet>& sets, std::size_t replications) {
        std::vector<Values> found;
        for (const SignalSet& set : sets) {
            Values values = set.empty() ? Values(20, 100.0) : times->at(set.back());
            values.resize(replications);
            found.push_back(values);
        }
        return found;
    };
}

TEST(Equipment, ThatIsBestStaysInTheRaceAsOftenAsPromised) {
    constexpr unsigned trials = 2000;
    unsigned lost = 0;
    unsigned left = 0;
    for (unsigned trial = 0; trial < trials; ++trial) {
        // The best is hardly better than seven others, and much better than the last.
        const EquipPlan plan =
            equip_greedily({9, 1, 20, Search::lazy}, noisy({4.01, 4, 4, 4, 4, 4, 4, 4, -16}, 3.0, trial));
        lost += plan.candidates[0].left_race ? 1U : 0U;
        left += plan.candidates[8].left_race ? 1U : 0U;
    }
    EXPECT_LE(lost, trials * 5 / 100);
    EXPECT_GE(left, trials * 95 / 100) << "or the race saves nothing";
}

TEST(Equipment, OfSignalsThatChangeNothingIsShownAsSeldomAsPromised) {
    constexpr unsigned trials = 2000;
    unsigned shown = 0;
    for (unsigned trial = 0; trial < trials; ++trial) {
        const EquipPlan plan =
            equip_greedily({8, 1, 5, Search::lazy}, noisy(std::vector<double>(8, 0.0), 3.0, trial));
        shown += std::ranges::any_of(plan.candidates, [](const EquipCandidate& candidate) {
            return candidate.gain->interval->low > 0.0;
        });
    }
    // One side of intervals that hold together at 95 %: 2.5 %, and three standard errors of 2,000 trials.
    EXPECT_LE(shown, trials * 36 / 1000);
    EXPECT_GE(shown, trials * 10 / 1000) << "wider than promised";
}

TEST(GainSplit, TellsTripsThatPassFromTheOthers) {
    // Those that pass gain 10 and 4 s, then 20 s; the others -1 and 0 s. c is missing after, e before.
    const std::vector<TripTimes> before = {
        {{"a", 100.0}, {"b", 80.0}, {"c", 10.0}, {"d", 50.0}}, {{"a", 90.0}, {"d", 60.0}}, {}};
    const std::vector<TripTimes> after = {
        {{"a", 90.0}, {"b", 76.0}, {"d", 51.0}}, {{"a", 70.0}, {"d", 60.0}, {"e", 5.0}}, {{"a", 1.0}}};
    const GainSplit split = split_gain(before, after, {{"a", "b", "c"}, {"a"}, {"a"}});
    EXPECT_EQ(split.trips, 5U);
    EXPECT_EQ(split.passing, 3U);
    EXPECT_DOUBLE_EQ(split.passing_gain->mean, 34.0 / 3.0) << "a trip, not a replication";
    EXPECT_DOUBLE_EQ(split.other_gain->mean, -0.5);
    EXPECT_EQ(split.passing_gain->n, 2U) << "the third replication has no pair";
    // The replications deviate by -+(34 / 3 * 2 - 14) / 1.5; t(1) is 12.706.
    EXPECT_NEAR(split.passing_gain->interval->half_width(), 12.706 * (68.0 / 3.0 - 14.0) / 1.5, 0.01);
}

TEST(GainSplit, HasNoGainOfTripsThatAreNotThere) {
    const GainSplit split = split_gain({{{"a", 9.0}}}, {{{"a", 8.0}}}, {{"a"}});
    EXPECT_DOUBLE_EQ(split.passing_gain->mean, 1.0);
    EXPECT_FALSE(split.other_gain);
}

}  // namespace
}  // namespace clearway::analysis
