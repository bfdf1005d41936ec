#include "analysis/traffic.hpp"

#include <gmock/gmock.h>

namespace clearway::analysis {
namespace {

using results::RunRecord;
using traffic::VehicleClass;

RunRecord run_with(double main_s, double side_s, std::vector<double> halted) {
    RunRecord run;
    run.traffic.approaches = {{"main", VehicleClass::human, 10, 5.0, main_s, 600.0},
                              {"main", VehicleClass::automated, 5, 1.0, 2.0, 30.0},
                              {"side", VehicleClass::human, 4, 3.0, side_s, 9.0}};
    for (std::size_t row = 0; row < halted.size(); ++row)
        run.traffic.recovery.push_back({-5.0 + 5.0 * static_cast<double>(row), 2, halted[row]});
    return run;
}

class Traffic : public testing::Test {
  protected:
    void SetUp() override {
        for (int replication = 0; replication < 4; ++replication) {
            baseline_.push_back(run_with(100.0 + replication, 40.0, {1.0, 1.0, 1.0, 1.0}));
            const double more = 3.0 + 0.1 * replication;
            condition_.push_back(run_with(90.0 + replication, 60.0 + replication, {1.0, more, more, 1.0}));
        }
    }
    static detail::Runs pointers(const std::vector<RunRecord>& runs) {
        detail::Runs result;
        for (const RunRecord& run : runs)
            result.push_back(&run);
        return result;
    }
    std::vector<ApproachCost> costs() const {
        return approach_costs(pointers(condition_), pointers(baseline_), 0.95);
    }

    std::vector<RunRecord> condition_, baseline_;
};

TEST_F(Traffic, CostsAreByApproachAndClassWithTheGreatestFirst) {
    const auto found = costs();
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].edge, "side");
    EXPECT_DOUBLE_EQ(found[0].difference->mean, 21.5);
    EXPECT_TRUE(found[0].difference->interval->low > 0.0);
    EXPECT_DOUBLE_EQ(*found[0].per_vehicle_s, 21.5 / 4.0);
    EXPECT_EQ(found[1].edge, "main");
    EXPECT_DOUBLE_EQ(found[1].difference->mean, -10.0);
    EXPECT_DOUBLE_EQ(found[1].human->mean, -10.0);
    EXPECT_DOUBLE_EQ(found[1].automated->mean, 0.0);
    EXPECT_DOUBLE_EQ(*found[1].baseline_s, 103.5);
    EXPECT_DOUBLE_EQ(*found[1].vehicles, 15.0);
}

TEST_F(Traffic, AnApproachThatNobodyEnteredCountsNothing) {
    for (RunRecord& run : baseline_)
        run.traffic.approaches.pop_back();
    const auto found = costs();
    EXPECT_EQ(found[0].edge, "side");
    EXPECT_DOUBLE_EQ(found[0].difference->mean, 61.5);
    EXPECT_FALSE(found[0].per_vehicle_s);
}

TEST_F(Traffic, RecoveryIsOverOnceIntervalsStayBelowOneMoreVehicleForAWhile) {
    for (auto* const runs : {&condition_, &baseline_}) {  // twice as many, enough for intervals
        const std::vector<RunRecord> again = *runs;
        runs->insert(runs->end(), again.begin(), again.end());
    }
    const auto recovered_by = [&] {
        return recovery_after(pointers(condition_), pointers(baseline_), 0.95)->recovered_by_s;
    };
    const auto recovery = recovery_after(pointers(condition_), pointers(baseline_), 0.95);
    ASSERT_TRUE(recovery);
    ASSERT_EQ(recovery->points.size(), 4U);
    EXPECT_DOUBLE_EQ(recovery->points[1].difference->mean, 2.15);
    EXPECT_FALSE(recovered_by()) << "back at 10 s, but not seen for long enough";
    for (auto* const runs : {&condition_, &baseline_}) {
        for (RunRecord& run : *runs) {
            for (double offset_s = 15.0; offset_s <= 60.0; offset_s += 5.0)
                run.traffic.recovery.push_back({offset_s, 2, 1.0});
        }
    }
    EXPECT_EQ(recovered_by(), 10.0);
    for (RunRecord& run : condition_)
        run.traffic.recovery.back().halted_vehicles = 5.0 + run.traffic.recovery[1].halted_vehicles;
    EXPECT_EQ(recovered_by(), 10.0) << "what comes later is another EV";
    for (RunRecord& run : condition_)
        run.traffic.recovery[6].halted_vehicles = 5.0 + run.traffic.recovery[1].halted_vehicles;
    EXPECT_EQ(recovered_by(), std::nullopt);
}

TEST_F(Traffic, RecoveryIsNotClaimedOverFewerPairsThanAnIntervalNeeds) {
    for (auto* const runs : {&condition_, &baseline_}) {
        for (RunRecord& run : *runs) {
            run.traffic.recovery.clear();
            for (double offset_s = 0.0; offset_s <= 60.0; offset_s += 5.0)
                run.traffic.recovery.push_back({offset_s, 2, 1.0});
        }
    }
    const auto recovery = recovery_after(pointers(condition_), pointers(baseline_), 0.95);
    EXPECT_EQ(recovery->recovered_by_s, std::nullopt);
    EXPECT_EQ(recovery->pairs_to_tell, std::nullopt);
}

TEST_F(Traffic, RecoveryIsToldByMorePairsAndNeverByFewer) {
    // From the passage on, `mean` more vehicles stand, with as much more and less in turn.
    const auto recovery_of = [](int pairs, double mean, double deviation) {
        std::vector<RunRecord> with, without;
        for (int pair = 0; pair < pairs; ++pair) {
            const std::vector<double> halted(9, 4.0 + mean + (pair % 2 == 0 ? deviation : -deviation));
            with.push_back(run_with(1.0, 1.0, halted));
            without.push_back(run_with(1.0, 1.0, std::vector<double>(9, 4.0)));
        }
        return *recovery_after(pointers(with), pointers(without), 0.95);
    };
    const Recovery few = recovery_of(8, 0.25, 1.5);
    EXPECT_EQ(few.recovered_by_s, std::nullopt) << "0 lies within the interval, but 1 does, too";
    EXPECT_FALSE(few.stays_longer);
    ASSERT_TRUE(few.pairs_to_tell);
    const int enough = static_cast<int>(*few.pairs_to_tell + *few.pairs_to_tell % 2);  // as many more as less
    EXPECT_EQ(recovery_of(enough, 0.25, 1.5).recovered_by_s, 0.0);
    EXPECT_GT(*few.pairs_to_tell, 16U);  // t of 16 pairs: 2.13 * 1.5 / 4 > 0.75
    const Recovery none = recovery_of(8, 2.0, 1.5);
    EXPECT_FALSE(none.stays_longer) << "1 lies within the interval";
    EXPECT_EQ(none.pairs_to_tell, std::nullopt) << "the mean is above it";
    EXPECT_TRUE(recovery_of(40, 2.0, 1.5).stays_longer);
}

TEST_F(Traffic, OfRunsThatWereNotWatchedSaysNothing) {
    for (RunRecord& run : condition_)
        run.traffic = {};
    EXPECT_TRUE(costs().empty());
    EXPECT_FALSE(recovery_after(pointers(condition_), pointers(baseline_), 0.95));
    EXPECT_TRUE(approach_costs({nullptr}, {nullptr}, 0.95).empty());
}

}  // namespace
}  // namespace clearway::analysis
