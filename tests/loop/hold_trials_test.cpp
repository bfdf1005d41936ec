// Other times of a hold, tried in copies of a run.

#include <gtest/gtest.h>

#include "loop/study_folder.hpp"

namespace clearway {
namespace {

using experiment::ConditionSpec;

ConditionSpec condition(const std::string& name, const std::string& policy, core::Settings settings) {
    ConditionSpec spec;
    spec.name = name;
    spec.policies = {policy};
    spec.settings = std::move(settings);
    return spec;
}

metrics::RunMetrics metrics_of(const test::StudyFolder& folder, const std::string& name) {
    const auto record = folder.store().read({"intersection", name, 0});
    EXPECT_TRUE(record.has_value()) << name << ": " << core::tail(folder.log(), 20);
    return record.value_or(results::RunRecord{}).metrics;
}

const core::Settings tried = {{"loop.holds_tried", "4"}};
const scenario::Options dense = scenario::Options().set("variant", "dense");

TEST(HoldTrials, DoNotChangeTheRunAndGiveTheRegretOfItsRule) {
    const test::StudyFolder folder(
        "intersection", dense,
        {condition("plain", "check_in_out", {}), condition("tried", "check_in_out", tried)});
    ASSERT_TRUE(folder.run(folder.unit(0)).ok()) << core::tail(folder.log(), 20);
    const auto trace = [&](const char* name) {
        return folder.store().read({"intersection", name, 0}).value().provenance.trace_hash;
    };
    EXPECT_EQ(trace("plain"), trace("tried"));
    EXPECT_EQ(metrics_of(folder, "plain").hold_decisions, 0U);
    EXPECT_FALSE(metrics_of(folder, "plain").hold_regret_s.has_value());
    const metrics::RunMetrics found = metrics_of(folder, "tried");
    EXPECT_EQ(found.hold_decisions, found.emergency_count) << "each passes the signal once";
    EXPECT_EQ(found.holds_tried, 4 * found.hold_decisions);
    EXPECT_GE(found.hold_regret_s.value(), 0.0);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "work" / "unit-0-standard"));
}

TEST(HoldTrials, WhoTakesTheBestIsNoLaterThanARuleThatNeverAsksAndWhoWeighsOthersSparesThem) {
    // Asks too late to matter.
    core::Settings late = {{"check_in_out.check_in_m", "1"}, {"loop.holds_tried", "4"}};
    const ConditionSpec rule = condition("rule", "check_in_out", late);
    late["loop.best_hold_taken"] = "1";
    const ConditionSpec best = condition("best", "check_in_out", late);
    late["loop.others_price"] = "10";
    const ConditionSpec sparing = condition("sparing", "check_in_out", late);
    const test::StudyFolder folder("intersection", dense, {rule, best, sparing});
    ASSERT_TRUE(folder.run(folder.unit(0)).ok()) << core::tail(folder.log(), 20);
    const auto time_s = [&](const char* name) {
        return metrics_of(folder, name).emergency_restricted_travel_time_s.value();
    };
    ASSERT_GT(metrics_of(folder, "rule").hold_regret_s.value(), 5.0) << "nothing to gain, nothing shown";
    EXPECT_LT(time_s("best"), time_s("rule") - 5.0);
    EXPECT_LT(metrics_of(folder, "best").hold_regret_s.value(), 1.0);
    EXPECT_GT(time_s("sparing"), time_s("best"));
    EXPECT_LT(metrics_of(folder, "sparing").others_time_loss_s.value(),
              metrics_of(folder, "best").others_time_loss_s.value());
}

TEST(HoldTrials, OfAnEvAreAtLeastSoFarApart) {
    const auto on_grid = [&](const core::Settings& settings) {
        const test::StudyFolder grid("grid_signals_v2", {}, {condition("one", "check_in_out", settings)});
        EXPECT_TRUE(grid.run(grid.unit(0)).ok()) << core::tail(grid.log(), 20);
        return grid.store().read({"grid_signals_v2", "one", 0}).value().metrics;
    };
    core::Settings few = {{"loop.holds_tried", "2"}};
    const metrics::RunMetrics every = on_grid(few);
    few["loop.holds_every_s"] = "3600";
    const metrics::RunMetrics once = on_grid(few);
    EXPECT_EQ(once.hold_decisions, once.emergency_count);
    EXPECT_GT(every.hold_decisions, once.hold_decisions);
}

TEST(HoldTrials, AreNotMadeAtSignalsThatAreNotEquipped) {
    core::Settings none = tried;
    none["actuation.equipped"] = "none";
    const test::StudyFolder folder("intersection", dense, {condition("none", "check_in_out", none)});
    ASSERT_TRUE(folder.run(folder.unit(0)).ok()) << core::tail(folder.log(), 20);
    EXPECT_EQ(metrics_of(folder, "none").hold_decisions, 0U);
}

TEST(HoldTrials, OfWhoKnowsTheFutureNeedNoChannel) {
    core::Settings best = tried;
    best["loop.best_hold_taken"] = "1";
    ConditionSpec heard = condition("heard", "check_in_out", best);
    ConditionSpec lost = condition("lost", "check_in_out", best);
    lost.failure = "perfect,signal_request_propagation=sharp,signal_request_loss_rate=1";
    const test::StudyFolder folder("intersection", dense, {heard, lost});
    ASSERT_TRUE(folder.run(folder.unit(0)).ok()) << core::tail(folder.log(), 20);
    EXPECT_NEAR(metrics_of(folder, "lost").emergency_restricted_travel_time_s.value(),
                metrics_of(folder, "heard").emergency_restricted_travel_time_s.value(), 5.0);
}

}  // namespace
}  // namespace clearway
