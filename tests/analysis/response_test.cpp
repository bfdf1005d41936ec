#include "analysis/response.hpp"

#include <deque>

#include <gmock/gmock.h>

#include "analysis/met_incident.hpp"
#include "results/synthetic.hpp"

namespace clearway::analysis {
namespace {

using results::RunRecord;
using testing::ElementsAre;
using testing::Optional;

/// A run whose emergency vehicles took these times; those of 600 s did not arrive and had 600 s.
RunRecord run_with(std::uint32_t replication, const std::vector<double>& times_s) {
    RunRecord run;
    run.key = {"alpha", "treated", replication};
    double sum_s = 0.0;
    for (const double time_s : times_s) {
        run.vehicles.push_back(results::synthetic::vehicle("e" + std::to_string(run.vehicles.size()),
                                                           traffic::VehicleClass::emergency, time_s));
        if (time_s >= 600.0) {
            run.vehicles.back().outcome = metrics::VehicleOutcome::teleported;
            run.vehicles.back().travel_time_s = 7.0;  // of what it drove
        }
        sum_s += time_s;
    }
    run.metrics.emergency_restricted_travel_time_s = sum_s / static_cast<double>(times_s.size());
    run.vehicles.push_back(results::synthetic::vehicle("h", traffic::VehicleClass::human, 1.0));
    return run;
}

/// Runs and the pointers that analysis takes.
struct Study {
    std::deque<RunRecord> runs;
    std::vector<const RunRecord*> rows;
    void add(const std::vector<double>& times_s) {
        runs.push_back(run_with(static_cast<std::uint32_t>(runs.size()), times_s));
        rows.push_back(&runs.back());
    }
};

TEST(ResponseTimes, CountWhoDidNotArriveWithTheHorizon) {
    EXPECT_THAT(response_times_s(run_with(0, {50.0, 600.0, 70.0})),
                ElementsAre(50.0, testing::DoubleNear(600.0, 1e-9), 70.0));
    EXPECT_THAT(response_times_s(run_with(0, {600.0, 50.0, 600.0})),
                ElementsAre(testing::DoubleNear(600.0, 1e-9), 50.0, testing::DoubleNear(600.0, 1e-9)));
}

TEST(ResponseTime, IsNinetyPercentAndTheShareWithinTheThreshold) {
    Study study;
    study.add({10.0, 20.0, 30.0, 40.0, 50.0});
    study.add({60.0, 70.0, 80.0, 90.0, 600.0});
    const ResponseTime response = response_of(study.rows, {}, 70.0);
    EXPECT_EQ(response.trips, 10U);
    EXPECT_DOUBLE_EQ(response.percentile_90_s->mean, 90.0) << "nine of ten took no longer";
    EXPECT_DOUBLE_EQ(response.in_time->mean, 0.7) << "one at the threshold is in time, the lost one is not";
    EXPECT_EQ(response.in_time->deviation, 0.0) << "it has none";
    EXPECT_EQ(response.in_time->interval, std::nullopt) << "two replications give no interval";
    EXPECT_EQ(response.in_time_difference.has_value(), false);
}

TEST(ResponseTime, IsPairedByReplicationAndResamplesWholeReplications) {
    Study before;
    Study after;
    for (const double time_s : {80.0, 90.0, 100.0, 110.0, 120.0, 130.0}) {
        before.add({time_s, time_s + 5.0});
        after.add({time_s - 30.0, time_s - 25.0});
    }
    before.rows[5] = nullptr;
    const ResponseTime response = response_of(after.rows, before.rows, 95.0);
    EXPECT_EQ(response.in_time_difference->n, 5U);
    EXPECT_EQ(response.in_time->n, 6U);
    EXPECT_DOUBLE_EQ(response.percentile_90_difference_s->mean, -30.0);
    EXPECT_EQ(response.percentile_90_difference_s->interval, std::nullopt)
        << "the same in every resample: there is nothing to estimate an interval from";
    // In time before: 80, 85, 90 and 95 of ten; after: all ten.
    EXPECT_NEAR(response.in_time_difference->mean, 1.0 - 0.4, 1e-12);
    ASSERT_TRUE(response.in_time_difference->interval);
    EXPECT_TRUE(response.in_time_difference->interval->contains(0.6));
    EXPECT_LE(response.in_time_difference->interval->high, 1.0) << "it is a share";
}

TEST(ResponseTime, HasNoPercentileOfFewerThanTenTrips) {
    Study before;
    Study after;
    before.add({10.0, 20.0, 30.0, 40.0, 50.0});
    before.add({10.0, 20.0, 30.0, 40.0, 50.0});
    after.add({10.0, 20.0, 30.0, 40.0, 50.0});
    after.add({10.0, 20.0, 30.0, 40.0});
    const ResponseTime response = response_of(after.rows, before.rows, 35.0);
    EXPECT_EQ(response.percentile_90_s.has_value(), false);
    EXPECT_EQ(response.percentile_90_difference_s.has_value(), false);
    EXPECT_DOUBLE_EQ(response.in_time->mean, 6.0 / 9.0);
    EXPECT_EQ(response_of(before.rows, after.rows, 35.0).percentile_90_s->mean, 50.0);
}

TEST(ResponseTime, IsNothingWithoutTrips) {
    Study study;
    study.add({});
    const ResponseTime response = response_of(study.rows, {}, 100.0);
    EXPECT_EQ(response.trips, 0U);
    EXPECT_EQ(response.percentile_90_s.has_value(), false);
    EXPECT_EQ(usual_response_threshold_s(study.rows), std::nullopt);
}

TEST(MetIncident, compares_those_alone_that_met_it_in_the_baseline) {
    Study before;
    Study after;
    before.add({100.0, 200.0, 600.0});
    after.add({90.0, 150.0, 400.0});
    before.add({100.0, 200.0});  // nobody met it
    after.add({10.0, 20.0});
    before.add({100.0, 300.0});
    after.add({100.0, 290.0});
    before.runs[0].vehicles[1].incident_met_s = 70.0;
    before.runs[0].vehicles[2].incident_met_s = 80.0;
    before.runs[2].vehicles[1].incident_met_s = 90.0;
    after.runs[0].vehicles[0].incident_met_s = 75.0;  // not in the baseline
    after.runs[2].vehicles[1].incident_met_s = 90.0;
    const MetIncident met = met_incident(after.rows, before.rows);
    EXPECT_EQ(met.vehicles, 3U);
    EXPECT_EQ(met.still, 1U);
    EXPECT_EQ(met.difference_s->n, 2U);
    EXPECT_NEAR(met.difference_s->mean, (-125.0 - 10.0) / 2.0, 1e-9) << "the lost one counts with 600 s";
    after.rows[0] = nullptr;
    EXPECT_EQ(met_incident(after.rows, before.rows).vehicles, 1U);
    EXPECT_FALSE(met_incident({}, before.rows).difference_s);
}

TEST(ResponseThreshold, FollowsFromTheMeanRouteWhereEveryTripCountsOnce) {
    Study study;
    study.add({50.0, 600.0});
    study.runs[0].vehicles[0].route_length_m = 1000.0;
    study.runs[0].vehicles[1].route_length_m = 10.0;  // it did not arrive
    RunRecord again = study.runs[0];
    again.key.condition = "other";
    again.vehicles[1].outcome = metrics::VehicleOutcome::arrived;
    again.vehicles[1].route_length_m = 1520.0;
    study.rows.push_back(&again);
    EXPECT_THAT(usual_response_threshold_s(study.rows), Optional(125.0))
        << "1.26 km at 100 s/km, in steps of 5 s";
    again.vehicles[1].route_length_m = 1549.5;
    EXPECT_THAT(usual_response_threshold_s(study.rows), Optional(125.0)) << "127.475 s";
    again.vehicles[1].route_length_m = 1550.5;
    EXPECT_THAT(usual_response_threshold_s(study.rows), Optional(130.0)) << "127.525 s";
}

}  // namespace
}  // namespace clearway::analysis
