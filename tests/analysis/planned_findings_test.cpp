// What a plan's comparisons show. Expected p-values: Student's density, integrated numerically elsewhere.
#include "analysis/planned_findings.hpp"

#include <vector>

#include <gmock/gmock.h>

#include "results/synthetic.hpp"

namespace clearway::analysis {
namespace {

using results::Claim;

class Planned : public testing::Test {
  protected:
    Planned() {
        results_.manifest = results::synthetic::manifest(6);
        results_.manifest.scenarios.resize(1);
        experiment::ConditionSpec other = results_.manifest.conditions[1];
        other.name = "other";
        experiment::ConditionSpec solo;
        solo.name = "solo";
        solo.traffic_model = experiment::TrafficModel::free_flow;
        results_.manifest.conditions.push_back(other);
        results_.manifest.conditions.push_back(solo);
        results_.manifest.plan.emplace();
        results_.manifest.plan->margin_share = 0.0;
    }

    void add(const std::string& condition, const std::vector<double>& seconds) {
        for (std::uint32_t replication = 0; replication < seconds.size(); ++replication) {
            results::RunRecord run =
                results::synthetic::record({"alpha", condition, replication}, seconds[replication]);
            for (const experiment::ConditionSpec& known : results_.manifest.conditions) {
                if (known.name == condition) run.condition = known;
            }
            results_.runs.push_back(run);
        }
    }
    void plan(const std::string& condition, const std::string& against, Claim claim = Claim::difference) {
        results_.manifest.plan->comparisons.push_back(
            {condition + " against " + against, "", condition, against, claim});
    }
    std::vector<PlannedFinding> findings() const { return planned_findings(summarise(results_)); }

    results::Results results_;
};

TEST_F(Planned, IsNothingWithoutAPlan) {
    results_.manifest.plan.reset();
    add("baseline", {100, 110, 120, 130, 140, 150});
    EXPECT_TRUE(findings().empty());
}

TEST_F(Planned, ShowsDifferencesAfterHolm) {
    add("baseline", {100, 110, 120, 130, 140, 150});
    add("treated", {92, 101, 113, 119, 133, 141});  // -8 -9 -7 -11 -7 -9
    add("other", {100, 108, 121, 129, 141, 149});   // 0 -2 1 -1 1 -1
    plan("treated", "baseline");
    plan("other", "baseline");
    const auto found = findings();
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].pairs, 6u);
    EXPECT_NEAR(found[0].difference->mean, -8.5, 1e-12);
    EXPECT_NEAR(found[0].difference->interval->low, -10.0916, 0.0001);
    EXPECT_NEAR(*found[0].p, 3.7e-5, 5e-6);
    EXPECT_DOUBLE_EQ(*found[0].holm_p, 2.0 * *found[0].p);
    EXPECT_EQ(found[0].shown, Shown::better);
    EXPECT_NEAR(*found[1].p, 0.5302, 0.0005);
    EXPECT_EQ(found[1].shown, Shown::not_shown);
    EXPECT_DOUBLE_EQ(*found[1].holm_p, *found[1].p);
}

TEST_F(Planned, SaysWhenItIsTheOtherWayRound) {
    add("baseline", {100, 110, 120, 130, 140, 150});
    add("treated", {92, 101, 113, 119, 133, 141});
    plan("baseline", "treated");
    EXPECT_EQ(findings()[0].shown, Shown::worse);
}

TEST_F(Planned, ShowsEquivalenceOnlyWithinTheMargin) {
    add("baseline", {100, 110, 120, 130, 140, 150});
    add("other", {100, 108, 121, 129, 141, 149});  // mean -1/3, interval [-1.60, 0.94]
    plan("other", "baseline", Claim::equivalence);
    results_.manifest.plan->margin_s = 2.0;
    EXPECT_EQ(findings()[0].shown, Shown::equivalent);
    results_.manifest.plan->margin_s = 1.5;
    EXPECT_EQ(findings()[0].shown, Shown::not_shown) << "the interval reaches beyond";
    results_.manifest.plan->margin_s = 0.3;
    EXPECT_EQ(findings()[0].shown, Shown::not_shown);
    EXPECT_GT(*findings()[0].p, 0.5) << "even the mean lies outside";
}

TEST_F(Planned, ShowsNoEquivalenceWithoutAMargin) {
    add("baseline", {100, 110, 120, 130, 140, 150});
    add("other", {100, 108, 121, 129, 141, 149});
    plan("other", "baseline", Claim::equivalence);
    results_.manifest.plan->margin_s = 0.0;
    EXPECT_FALSE(findings()[0].p);
    EXPECT_EQ(findings()[0].shown, Shown::not_shown);
}

TEST_F(Planned, TakesTheMarginFromTheDelayWhereThatIsMore) {
    add("baseline", {100, 110, 120, 130, 140, 150});  // mean 125
    add("other", {100, 108, 121, 129, 141, 149});
    add("solo", {60, 60, 60, 60, 60, 60});
    plan("other", "baseline", Claim::equivalence);
    results_.manifest.plan->margin_share = 0.05;
    EXPECT_NEAR(findings()[0].margin_s, 0.05 * 65.0, 1e-9);
    results_.manifest.plan->margin_s = 4.0;
    EXPECT_DOUBLE_EQ(findings()[0].margin_s, 4.0);
}

TEST_F(Planned, ClaimsNothingWhilePairsAreMissing) {
    add("baseline", {100, 110, 120, 130, 140, 150});
    add("treated", {92, 101, 113, 119, 133});
    plan("treated", "baseline");
    EXPECT_EQ(findings()[0].pairs, 5u);
    EXPECT_EQ(findings()[0].shown, Shown::incomplete);
}

TEST_F(Planned, ClaimsNoBenefitOfAConditionThatLosesMoreEmergencyVehicles) {
    add("baseline", {100, 110, 120, 130, 140, 150});
    add("treated", {92, 101, 113, 119, 133, 141});
    for (results::RunRecord& run : results_.runs) {
        if (run.key.condition == "treated" && run.key.replication == 0)
            run.vehicles[0].outcome = metrics::VehicleOutcome::teleported;
    }
    plan("treated", "baseline");
    EXPECT_EQ(findings()[0].shown, Shown::ruled_out);
}

TEST_F(Planned, ComparesInEveryScenarioOrInOne) {
    results_.manifest = results::synthetic::manifest(6);
    results_.manifest.plan.emplace();
    plan("treated", "baseline");
    EXPECT_EQ(findings().size(), 2u);
    results_.manifest.plan->comparisons[0].scenario = "beta";
    ASSERT_EQ(findings().size(), 1u);
    EXPECT_EQ(findings()[0].scenario, "beta");
}

TEST(EquivalenceP, IsThatOfTheTwoOneSidedTests) {
    // t = (2 - 1/3) / (1.21106 / sqrt(6)) = 3.3710 with 5 degrees of freedom.
    const std::vector<double> with = {100, 108, 121, 129, 141, 149};
    const std::vector<double> without = {100, 110, 120, 130, 140, 150};
    EXPECT_NEAR(*paired_equivalence_p(with, without, 2.0), 0.0099, 0.0005);
    EXPECT_EQ(paired_equivalence_p(without, without, 1.0), 0.0) << "no variation, inside";
    EXPECT_FALSE(paired_equivalence_p(std::vector{1.0}, std::vector{1.0}, 1.0));
}

}  // namespace
}  // namespace clearway::analysis
