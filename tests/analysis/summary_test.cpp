#include "analysis/summary.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "results/synthetic.hpp"

namespace clearway::analysis {
namespace {

using experiment::TrafficModel;
using metrics::VehicleOutcome;
using results::RunRecord;
using traffic::VehicleClass;

/// One scenario; baseline, two policies, solo; EVs `e1` and `e2` with known times.
class SmallStudy : public testing::Test {
  protected:
    SmallStudy() {
        results_.manifest = results::synthetic::manifest(4);
        results_.manifest.scenarios.resize(1);
        experiment::ConditionSpec solo;
        solo.name = "solo";
        solo.traffic_model = TrafficModel::free_flow;
        experiment::ConditionSpec other = results_.manifest.conditions[1];
        other.name = "other";
        results_.manifest.conditions.push_back(other);
        results_.manifest.conditions.push_back(solo);
    }
    RunRecord& add(const std::string& condition, std::uint32_t replication, double first_s, double second_s) {
        RunRecord run;
        run.key = {"alpha", condition, replication};
        run.vehicles = {results::synthetic::vehicle("e1", VehicleClass::emergency, first_s),
                        results::synthetic::vehicle("e2", VehicleClass::emergency, second_s),
                        results::synthetic::vehicle("h1", VehicleClass::human, 90.0)};
        run.metrics.emergency_travel_time_s = 0.5 * (first_s + second_s);
        run.metrics.emergency_restricted_travel_time_s = run.metrics.emergency_travel_time_s;
        run.metrics.vehicle_count = run.metrics.arrived = 3;
        run.metrics.collisions = replication;
        results_.runs.push_back(run);
        return results_.runs.back();
    }
    void add_all() {
        const double delays_s[] = {40.0, 60.0, 50.0, 70.0};
        for (std::uint32_t replication = 0; replication < 4; ++replication) {
            const double delay_s = delays_s[replication];
            add("baseline", replication, 60.0 + delay_s, 80.0 + delay_s);
            add("treated", replication, 60.0 + 0.5 * delay_s, 80.0 + 0.5 * delay_s);
            add("solo", replication, 60.0, 80.0);
        }
    }
    ScenarioSummary scenario() const { return summarise(results_).scenarios.at(0); }

    /// The slower EV of these runs teleports; they had 600 s.
    void lose_the_second(const std::string& condition, std::uint32_t replications) {
        for (RunRecord& run : results_.runs) {
            if (run.key.condition != condition || run.key.replication >= replications) continue;
            run.vehicles[1].outcome = VehicleOutcome::teleported;
            const double first_s = *run.vehicles[0].travel_time_s;
            run.metrics.emergency_travel_time_s = first_s;
            run.metrics.emergency_restricted_travel_time_s = 0.5 * (first_s + 600.0);
            run.metrics.arrived = 2;
        }
    }

    results::Results results_;
};

/// Six pairs in which `treated` takes 40 % of what the baseline lost, and nine runs of the baseline.
class AdjustedStudy : public SmallStudy {
  protected:
    AdjustedStudy() {
        results_.manifest.replications = 6;
        baselines_.manifest = results_.manifest;
        baselines_.manifest.replications = 9;
        std::erase_if(baselines_.manifest.conditions, [](const auto& one) { return one.name != "baseline"; });
        const double lost_s[] = {40.0, 60.0, 50.0, 70.0, 45.0, 80.0, 90.0, 20.0, 55.0};
        for (std::uint32_t replication = 0; replication < 9; ++replication) {
            const double loss_s = lost_s[replication];
            RunRecord& run = add("baseline", replication, 60.0 + loss_s, 80.0 + loss_s);
            run.metrics.emergency_time_loss_s = loss_s;
            baselines_.runs.push_back(run);
            if (replication >= 6)
                results_.runs.pop_back();
            else
                add("treated", replication, 60.0 + 0.4 * loss_s, 80.0 + 0.4 * loss_s);
        }
    }
    std::vector<AdjustedDifference> adjusted() const {
        Summary summary = summarise(results_);
        adjust_by(baselines_, summary);
        return summary.adjusted;
    }
    std::string refusal() const {
        try {
            adjusted();
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "none";
    }

    results::Results baselines_;
};

TEST_F(AdjustedStudy, HasTheMeanOfMoreBaselines) {
    const std::vector<AdjustedDifference> found = adjusted();
    ASSERT_EQ(found.size(), 2U);
    EXPECT_FALSE(found[1].difference) << "`" << found[1].condition << "` has no runs";
    ASSERT_TRUE(found[0].difference);
    EXPECT_EQ(found[0].scenario, "alpha");
    EXPECT_EQ(found[0].condition, "treated");
    EXPECT_NEAR(found[0].difference->mean, -0.6 * 510.0 / 9.0, 1e-9);
    EXPECT_EQ(found[0].difference->n, 6U);
    EXPECT_EQ(found[0].baselines, 9U);
    const Estimate plain = *scenario().find("treated")->metric(primary_metric).comparison->difference;
    EXPECT_EQ(found[0].worth,
              required_replications(plain.deviation, found[0].difference->interval->half_width()));
}

TEST_F(AdjustedStudy, HasNothingWhereABaselineHasNoLossOrMostAreMissing) {
    const std::vector<RunRecord> runs = results_.runs;
    for (std::size_t row = 1; row < runs.size(); row += 2)
        results_.runs[row].metrics = runs[row - 1].metrics;
    EXPECT_FALSE(adjusted().front().difference) << "the condition does nothing";
    results_.runs = runs;
    EXPECT_TRUE(adjusted().front().difference);
    results_.runs[4].metrics.emergency_time_loss_s.reset();
    EXPECT_FALSE(adjusted().front().difference) << "a pair without it";
    results_.runs = runs;
    baselines_.runs[8].metrics.emergency_time_loss_s.reset();
    EXPECT_FALSE(adjusted().front().difference) << "a baseline without it";
    baselines_.runs.resize(5);
    EXPECT_FALSE(adjusted().front().difference) << "fewer than pairs";
}

TEST_F(AdjustedStudy, NamesTheBuildsOfBaselinesThatAnotherProgramMade) {
    Summary summary = summarise(results_);
    adjust_by(baselines_, summary);
    EXPECT_FALSE(summary.builds);
    baselines_.manifest.clearway_build = "another";
    adjust_by(baselines_, summary);
    ASSERT_TRUE(summary.builds);
    EXPECT_EQ(summary.builds->second, "another");
}

TEST_F(AdjustedStudy, RefusesBaselinesOfAnotherStudy) {
    EXPECT_EQ(refusal(), "none");
    const results::Manifest manifest = baselines_.manifest;
    const auto refused_with = [&](const auto& change) {
        baselines_.manifest = manifest;
        change(baselines_.manifest);
        return refusal();
    };
    EXPECT_THAT(refused_with([](auto& one) { one.study_seed += 1; }), testing::HasSubstr("another seed"));
    EXPECT_THAT(refused_with([](auto& one) { one.scenarios[0].configuration_hash = std::string(32, 'b'); }),
                testing::HasSubstr("scenario alpha"));
    EXPECT_THAT(refused_with([](auto& one) { one.conditions[0].settings["loop.policy_period_s"] = "0.5"; }),
                testing::HasSubstr("condition baseline"));
    EXPECT_THAT(refused_with([](auto& one) { one.replications = 5; }),
                testing::HasSubstr("fewer replications"));
}

TEST_F(SmallStudy, GivesTheDifferenceWithoutThePairsThatLocked) {
    add_all();
    EXPECT_FALSE(scenario().find("treated")->metric(primary_metric).comparison->unlocked);
    for (RunRecord& run : results_.runs) {
        const bool locked = (run.key.condition == "baseline" && run.key.replication == 1) ||
                            (run.key.condition == "treated" && run.key.replication == 3);
        run.metrics.locks = locked ? 2 : 0;
    }
    const ScenarioSummary summary = scenario();
    const Comparison& comparison = *summary.find("treated")->metric(primary_metric).comparison;
    EXPECT_EQ(comparison.locked_pairs, 2U);
    EXPECT_EQ(comparison.held_up_pairs, 0U);
    EXPECT_DOUBLE_EQ(comparison.difference->mean, -27.5);
    EXPECT_DOUBLE_EQ(comparison.unlocked->mean, -22.5);  // Of 40 and 50 s, half.
    EXPECT_EQ(summary.find("baseline")->locked_runs(), 1U);
    EXPECT_EQ(summary.find("baseline")->total("locks"), 2.0);
    for (RunRecord& run : results_.runs)
        run.metrics.locks = run.metrics.locks / 2;
    EXPECT_EQ(scenario().find("treated")->metric(primary_metric).comparison->locked_pairs, 2U);
    for (RunRecord& run : results_.runs)
        run.metrics.locked_emergency_vehicles = run.key.condition == "treated" ? run.metrics.locks : 0;
    EXPECT_EQ(scenario().find("treated")->metric(primary_metric).comparison->held_up_pairs, 1U);
}

TEST_F(SmallStudy, DoesNotLetSurvivorsSpeakForLostEmergencyVehicles) {
    add_all();
    lose_the_second("treated", 3);
    const ScenarioSummary summary = scenario();
    const ConditionSummary& treated = *summary.find("treated");
    EXPECT_LT(treated.metric("emergency_travel_time_s").comparison->difference->mean, 0.0);
    EXPECT_GT(treated.metric(primary_metric).comparison->difference->mean, 0.0);
    EXPECT_EQ(treated.metric(primary_metric).comparison->complete_pairs, 4U);
    EXPECT_TRUE(treated.objections.on_emergency());
    EXPECT_EQ(emergency_objections(treated.objections),
              "lost 3 of 8 emergency vehicles (3 teleported; baseline 0)");
    EXPECT_EQ(emergency_objection_word(treated.objections), "lost EVs");
    EXPECT_FALSE(treated.objections.on_others()) << "they are counted apart";
}

TEST_F(SmallStudy, ClosesNoGapByLosingEmergencyVehicles) {
    add_all();
    lose_the_second("treated", 3);
    const ScenarioSummary summary = scenario();
    const ConditionSummary& treated = *summary.find("treated");
    double with_s = 0.0;
    double without_s = 0.0;
    for (std::size_t run = 0; run < 4; ++run) {
        with_s += *treated.metric(primary_metric).values[run];
        without_s += *summary.find("baseline")->metric(primary_metric).values[run];
    }
    EXPECT_DOUBLE_EQ(treated.gap_closed->mean, (without_s - with_s) / (without_s - 4.0 * 70.0));
    EXPECT_LT(treated.gap_closed->mean, 0.0);
    EXPECT_EQ(treated.gap_closed->n, 4U);
}

/// Two that were taken off the road are not made good by two of the baseline that ran out of time.
TEST(Objections, WeighVehiclesThatWereTakenOffTheRoadApart) {
    Objections objections;
    objections.emergency = {.arrived = 8, .teleported = 2};
    objections.baseline_emergency = {.arrived = 8, .running_at_end = 2};
    EXPECT_TRUE(objections.loses_emergency());
    EXPECT_EQ(emergency_objections(objections),
              "lost 2 of 10 emergency vehicles (2 teleported; baseline 2 still on the road at the end)");
    std::swap(objections.emergency, objections.baseline_emergency);
    EXPECT_FALSE(objections.loses_emergency());
    objections.emergency = {.running_at_end = 1};
    objections.baseline_emergency = {.arrived = 1};
    EXPECT_EQ(emergency_objections(objections),
              "lost 1 of 1 emergency vehicle (1 still on the road at the end; baseline 0)");
}

TEST_F(SmallStudy, ObjectsOnlyToMoreLossesThanTheBaselineHas) {
    add_all();
    lose_the_second("treated", 2);
    lose_the_second("baseline", 2);
    EXPECT_FALSE(scenario().find("treated")->objections.on_emergency());
    EXPECT_EQ(emergency_objections(scenario().find("treated")->objections), "");
    lose_the_second("baseline", 3);
    EXPECT_FALSE(scenario().find("treated")->objections.on_emergency()) << "fewer is no objection";
}

TEST_F(SmallStudy, ObjectsToConditionsWithoutSafetyChecks) {
    results_.manifest.conditions[1].safety_checks = traffic::SafetyChecks::off;
    add_all();
    const Objections objections = scenario().find("treated")->objections;
    EXPECT_TRUE(objections.on_emergency());
    EXPECT_TRUE(objections.on_others());
    EXPECT_EQ(emergency_objections(objections), "ran without safety checks");
}

TEST_F(SmallStudy, ObjectsToCollisionsAndLossesOfOthersBeyondTheirInterval) {
    add_all();
    for (RunRecord& run : results_.runs) {
        if (run.key.condition != "treated") continue;
        run.metrics.emergency_collisions = 6 + run.key.replication % 2;
        run.metrics.vehicle_count = 23;
        run.metrics.not_inserted = 20;
    }
    const Objections objections = scenario().find("treated")->objections;
    ASSERT_TRUE(objections.collisions);
    EXPECT_DOUBLE_EQ(objections.collisions->mean, 6.5);
    EXPECT_EQ(emergency_objection_word(objections), "hit EVs");
    EXPECT_TRUE(objections.not_inserted);
    EXPECT_FALSE(objections.teleported);
    EXPECT_THAT(other_objections(objections),
                testing::StartsWith("more other vehicles not inserted (+20.0 per run ["));
    for (RunRecord& run : results_.runs)
        run.metrics.emergency_collisions = run.key.condition == "treated" && run.key.replication == 0 ? 1 : 0;
    EXPECT_FALSE(scenario().find("treated")->objections.collisions) << "one may be chance";
}

TEST_F(SmallStudy, AddsLeasesUpByPartAndAction) {
    add_all();
    for (RunRecord& run : results_.runs) {
        if (run.key.condition == "treated")
            run.leases = {
                {"p", traffic::LeaseKind::change_lane, 2, 0, 1, 1, {{traffic::Refusal::outranked, 1}}},
                {"p", traffic::LeaseKind::hold_green, 1, 0, 1, 1, {}}};
    }
    const ScenarioSummary summary = scenario();
    const std::vector<metrics::LeaseRow>& leases = summary.find("treated")->leases;
    ASSERT_EQ(leases.size(), 2U);
    EXPECT_EQ(leases.front().issued, 8U);
    EXPECT_EQ(leases.front().refused.at(traffic::Refusal::outranked), 4U);
    EXPECT_TRUE(summary.find("baseline")->leases.empty());
}

TEST_F(SmallStudy, TellsPartsThatNeverActFromThoseThatMoveTheEmergencyVehicleAlone) {
    results_.manifest.conditions[1].policies = {"vacate_lane", "pull_aside", "geocast"};
    add_all();
    for (RunRecord& run : results_.runs) {
        if (run.key.condition != "treated") continue;
        run.leases = {
            {"vacate_lane", traffic::LeaseKind::own_change_lane, 3, 0, 2, 1, {}},
            {"vacate_lane", traffic::LeaseKind::change_lane, 5, 0, run.key.replication == 0 ? 1U : 0U, 4, {}},
            {"pull_aside", traffic::LeaseKind::pull_aside, 2, 0, 0, 2, {}},
            {"geocast", traffic::LeaseKind::own_change_lane, 2, 0, 1, 1, {}},
            {"geocast", traffic::LeaseKind::pull_aside, 2, 0, 1, 1, {}}};
    }
    const std::vector<IdlePart> parts = scenario().find("treated")->idle_parts;
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].policy, "vacate_lane");
    EXPECT_EQ(parts[0].idle_runs, 0U);
    EXPECT_EQ(parts[0].own_runs, 3U);
    EXPECT_EQ(parts[1].policy, "pull_aside");
    EXPECT_EQ(parts[1].idle_runs, 4U);
    EXPECT_EQ(parts[1].own_runs, 0U);
}

TEST_F(SmallStudy, NamesTheFirstConditionWithTheSameTracesInAllRuns) {
    add_all();
    for (std::uint32_t replication = 0; replication < 4; ++replication)
        add("other", replication, 80.0, 100.0);
    EXPECT_EQ(scenario().find("other")->same_as, "") << "no traces are known";
    for (RunRecord& run : results_.runs)
        run.provenance.trace_hash = fmt::format("{}{}", run.key.condition == "baseline", run.key.replication);
    EXPECT_EQ(scenario().find("treated")->same_as, "");
    EXPECT_EQ(scenario().find("other")->same_as, "treated");
    EXPECT_EQ(scenario().find("solo")->same_as, "treated");
    EXPECT_EQ(scenario().find("baseline")->same_as, "");
    results_.runs.back().provenance.trace_hash = "another";  // the last run of `other`
    EXPECT_EQ(scenario().find("other")->same_as, "");
    results_.runs.pop_back();
    EXPECT_EQ(scenario().find("other")->same_as, "") << "a run is missing";
}

TEST_F(SmallStudy, ComparesWithTheBaselineByReplication) {
    add_all();
    const ScenarioSummary summary = scenario();
    const ConditionSummary* treated = summary.find("treated");
    ASSERT_NE(treated, nullptr);
    EXPECT_EQ(treated->baseline, "baseline");
    const MetricSummary& travel = treated->metric("emergency_travel_time_s");
    EXPECT_DOUBLE_EQ(travel.estimate->mean, 97.5);  // 70 + half of the mean delay of 55
    ASSERT_TRUE(travel.comparison);
    EXPECT_EQ(travel.comparison->complete_pairs, 4U);
    EXPECT_EQ(travel.comparison->incomplete_pairs, 0U);
    EXPECT_DOUBLE_EQ(travel.comparison->difference->mean, -27.5);
    EXPECT_DOUBLE_EQ(travel.comparison->relative->mean, -27.5 / 125.0);
    EXPECT_TRUE(travel.comparison->bootstrap);
    EXPECT_FALSE(treated->metric("collisions").comparison->bootstrap);
    EXPECT_FALSE(summary.find("baseline")->metric("collisions").comparison);
    EXPECT_FALSE(summary.find("solo")->metric("collisions").comparison);
}

TEST_F(SmallStudy, FindsTheGapClosed) {
    add_all();
    const ScenarioSummary summary = scenario();
    EXPECT_DOUBLE_EQ(summary.find("treated")->gap_closed->mean, 0.5);
    EXPECT_EQ(summary.find("treated")->gap_closed->n, 4U);
    EXPECT_FALSE(summary.find("baseline")->gap_closed);
    EXPECT_FALSE(summary.find("other")->gap_closed);
}

TEST_F(SmallStudy, PairsOnlyVehiclesThatArrivedInBothAndCountsTheOthers) {
    add_all();
    // In the baseline of replication 0 the slower EV does not arrive: its mean alone would look better.
    RunRecord& run = results_.runs.front();
    run.vehicles[1].outcome = VehicleOutcome::running_at_end;
    run.metrics.emergency_travel_time_s = 100.0;
    const ScenarioSummary summary = scenario();
    const Comparison& comparison = *summary.find("treated")->metric("emergency_travel_time_s").comparison;
    EXPECT_EQ(comparison.complete_pairs, 4U);
    EXPECT_EQ(comparison.vehicles_left_out, 1U);
    EXPECT_DOUBLE_EQ(comparison.difference->mean, -27.5);  // e1 alone in replication 0: 80 - 100.
    EXPECT_EQ(summary.find("baseline")->emergency.running_at_end, 1U);
    EXPECT_EQ(summary.find("baseline")->emergency.arrived, 7U);
}

TEST_F(SmallStudy, CountsPairsThatAFailureOrAStrandedVehicleBreaks) {
    add_all();
    std::erase_if(results_.runs, [](const RunRecord& run) {
        return run.key.condition == "treated" && run.key.replication == 1;
    });
    results_.errors.push_back(results::synthetic::error({"alpha", "treated", 1}));
    for (RunRecord& run : results_.runs) {
        if (run.key.condition != "treated" || run.key.replication != 2) continue;
        run.vehicles[0].outcome = VehicleOutcome::teleported;
        run.vehicles[1].outcome = VehicleOutcome::not_inserted;
        run.metrics.emergency_travel_time_s.reset();
        run.metrics.emergency_restricted_travel_time_s = 600.0;
    }
    const ScenarioSummary summary = scenario();
    const ConditionSummary& treated = *summary.find("treated");
    const Comparison& comparison = *treated.metric("emergency_travel_time_s").comparison;
    EXPECT_EQ(comparison.complete_pairs, 2U);
    EXPECT_EQ(comparison.incomplete_pairs, 2U);
    EXPECT_EQ(treated.failed_runs, 1U);
    EXPECT_EQ(treated.missing_runs, 0U);
    EXPECT_EQ(treated.complete_runs, 3U);
    EXPECT_EQ(treated.metric("emergency_travel_time_s").estimate->n, 2U);
    EXPECT_EQ(treated.metric("collisions").comparison->complete_pairs, 3U);
    EXPECT_EQ(treated.gap_closed->n, 3U) << "lost vehicles count with the horizon";
    EXPECT_EQ(treated.emergency.teleported, 1U);
}

TEST_F(SmallStudy, AdjustsOverTheConditionsOfAScenario) {
    add_all();
    for (std::uint32_t replication = 0; replication < 4; ++replication)
        add("other", replication, 90.0 + replication, 100.0 + 3.0 * replication);
    const ScenarioSummary summary = scenario();
    const Comparison& treated = *summary.find("treated")->metric("emergency_travel_time_s").comparison;
    const Comparison& other = *summary.find("other")->metric("emergency_travel_time_s").comparison;
    const auto expected = holm(std::vector{*treated.t_p, *other.t_p});
    EXPECT_DOUBLE_EQ(*treated.holm_p, expected[0]);
    EXPECT_DOUBLE_EQ(*other.holm_p, expected[1]);
    EXPECT_GT(*treated.holm_p, *treated.t_p);
}

TEST_F(SmallStudy, AdjustsOverTheApproachesOfAllConditions) {
    add_all();
    for (std::uint32_t replication = 0; replication < 4; ++replication)
        add("other", replication, 90.0, 100.0);
    for (RunRecord& run : results_.runs) {
        const double own = (run.key.condition == "other" ? 3.0 : 1.0) * run.key.replication;
        const double more = run.key.condition == "baseline" ? 0.0 : 20.0 + own;
        run.traffic.approaches = {{"main", VehicleClass::human, 10, 5.0, 100.0 + more, 600.0},
                                  {"side", VehicleClass::human, 10, 5.0, 100.0 - 0.5 * more + own, 600.0}};
    }
    const ScenarioSummary summary = scenario();
    std::vector<ApproachCost> all = summary.find("treated")->approaches;
    const std::vector<ApproachCost>& others = summary.find("other")->approaches;
    all.insert(all.end(), others.begin(), others.end());
    ASSERT_EQ(all.size(), 4U);
    std::vector<double> p_values;
    for (const ApproachCost& cost : all)
        p_values.push_back(*cost.t_p);
    const std::vector<double> expected = holm(p_values);
    for (std::size_t at = 0; at < all.size(); ++at)
        EXPECT_DOUBLE_EQ(*all[at].holm_p, expected[at]);
}

TEST_F(SmallStudy, IsAllMissingBeforeAnythingRan) {
    const ScenarioSummary summary = scenario();
    EXPECT_EQ(summary.conditions.size(), 4U);
    EXPECT_EQ(summary.find("treated")->missing_runs, 4U);
    EXPECT_FALSE(summary.find("treated")->metric("collisions").estimate);
    EXPECT_EQ(summary.find("treated")->metric("collisions").comparison->incomplete_pairs, 4U);
    EXPECT_EQ(summary.find("nobody"), nullptr);
    const std::vector<Unpaired> unpaired = summarise(results_).unpaired;
    ASSERT_EQ(unpaired.size(), 4U);
    EXPECT_EQ(unpaired[1].condition, "treated");
    EXPECT_EQ(unpaired[1].why, "4 of 4 runs failed or are missing");
}

TEST_F(SmallStudy, GivesTheTailOfAllEmergencyVehiclesWithThoseThatDidNotArriveLast) {
    results_.manifest.replications = 10;
    add_all();
    for (std::uint32_t replication = 4; replication < 9; ++replication)
        add("solo", replication, 60.0, 80.0);
    EXPECT_EQ(scenario().find("solo")->travel_time.median->mean, 60.0);
    EXPECT_FALSE(scenario().find("solo")->travel_time.percentile_95) << "of 18 trips it would be the slowest";
    add("solo", 9, 60.0, 80.0);
    EXPECT_EQ(scenario().find("solo")->travel_time.percentile_95->mean, 80.0);
    for (RunRecord& run : results_.runs) {
        if (run.key.condition == "solo" && run.key.replication <= 1)
            run.vehicles[1].outcome = VehicleOutcome::running_at_end;
    }
    EXPECT_FALSE(scenario().find("solo")->travel_time.percentile_95);
}

TEST_F(SmallStudy, GivesCountsIntervalsThatDoNotReachBelowZero) {
    add_all();
    const ScenarioSummary summary = scenario();
    const MetricSummary& collisions = summary.find("treated")->metric("collisions");
    EXPECT_EQ(collisions.metric.kind, MetricKind::count);
    EXPECT_GE(collisions.estimate->interval->low, 0.0);
    EXPECT_FALSE(collisions.comparison->t_p);
    EXPECT_EQ(summary.find("treated")->metric("links_f1").metric.kind, MetricKind::quantity);
}

TEST_F(SmallStudy, PairsTheSameUnitsOfTwoStudies) {
    add_all();
    results::Results second = results_;
    for (RunRecord& run : second.runs) {
        for (metrics::VehicleRow& vehicle : run.vehicles)
            vehicle.travel_time_s = *vehicle.travel_time_s + 2.0;
    }
    std::erase_if(second.runs, [](const RunRecord& run) { return run.key.replication == 3; });
    std::erase_if(second.manifest.conditions, [](const auto& one) { return one.name == "other"; });
    const Summary both = compare_studies(results_, second);
    std::vector<std::string> unpaired;
    for (const Unpaired& lost : both.unpaired)
        unpaired.push_back(lost.condition + ": " + lost.why);
    EXPECT_THAT(unpaired, testing::Contains("other: is only in the first folder"));
    EXPECT_THAT(unpaired,
                testing::Contains("baseline: 1 of 4 runs failed or are missing in the second folder"));
    const ScenarioSummary& summary = both.scenarios.at(0);
    EXPECT_EQ(summary.conditions.size(), 3U);
    const Comparison& comparison = *summary.find("baseline")->metric("emergency_travel_time_s").comparison;
    EXPECT_EQ(comparison.complete_pairs, 3U);
    EXPECT_EQ(comparison.incomplete_pairs, 1U);
    EXPECT_DOUBLE_EQ(comparison.difference->mean, 2.0);
}

TEST_F(SmallStudy, NamesSettingsInWhichConditionsOfOneNameDiffer) {
    add_all();
    EXPECT_THAT(compare_studies(results_, results_).differing, testing::IsEmpty());
    results::Results second = results_;
    for (experiment::ConditionSpec& condition : second.manifest.conditions) {
        if (condition.name != "treated") continue;
        condition.settings["loop.link_radius_m"] = "80";
        condition.failure = "B20";
    }
    const auto differing = compare_studies(results_, second).differing;
    ASSERT_EQ(differing.size(), 2U);
    EXPECT_EQ(differing[0].condition, "treated");
    EXPECT_EQ(differing[0].setting, "failure");
    EXPECT_EQ(differing[0].second, "B20");
    EXPECT_EQ(differing[1], (ConditionDifference{"treated", "loop.link_radius_m", std::nullopt, "80"}));
}

TEST_F(SmallStudy, RefusesToPairWhatWasNotMadeFromTheSame) {
    add_all();
    results::Results second = results_;
    second.manifest.study_seed = 7;
    EXPECT_THROW(compare_studies(results_, second), core::InputError);
    second = results_;
    second.manifest.scenarios[0].configuration_hash = "another";
    EXPECT_THROW(compare_studies(results_, second), core::InputError);
    second = results_;
    second.manifest.scenarios[0].name = "elsewhere";
    EXPECT_THROW(compare_studies(results_, second), core::InputError);
}

}  // namespace
}  // namespace clearway::analysis
