#include <gmock/gmock.h>

#include "sensing/sensor.hpp"
#include "sensing/traffic_fixture.hpp"

namespace clearway::sensing {

using namespace failures;

namespace {

using testing::Crowd;
using testing::draws;
using testing::find;

constexpr int last_second = 60;

/// Runs a failure over a crowd and calls `check(observation, true graph, log)` at every second.
template <class Check>
void run(const FailureConfig& config, const Check& check) {
    const graph::LinkRules rules{.radius_m = 50.0, .automated_automated = graph::LinkRules::Pairs::included};
    const auto sensor = make_sensor(config, draws(), {testing::small_scene().network(), rules});
    Crowd crowd(100);
    graph::ProximityBuilder builder;
    graph::ProximityGraph true_graph;
    builder.build({crowd.snapshot.x_m, crowd.snapshot.y_m, crowd.snapshot.vehicle_class}, rules, true_graph);
    traffic::Observation observation;
    FailureLog log;
    for (int second = 0; second < last_second; ++second) {
        crowd.at(second);
        sensor->observe(crowd.snapshot, crowd.roster, observation);
        sensor->log_failures(crowd.snapshot, true_graph, log);
        check(crowd.snapshot, true_graph, observation, log);
    }
}

TEST(FailureLog, IsEmptyWhereNothingFails) {
    for (const char* name : {"perfect", "D3"}) {
        run(failure_from(name), [](const auto&, const auto&, const auto&, const FailureLog& log) {
            EXPECT_TRUE(log.dark.empty() && log.never_seen.empty() && log.lost_links.empty());
        });
    }
}

TEST(FailureLog, ListsWhoIsDarkAndWhoWasNeverSeen) {
    std::size_t dark = 0;
    std::size_t unseen = 0;
    run(failure_from("B10"), [&](const truth::Snapshot& snapshot, const auto&,
                                 const traffic::Observation& observation, const FailureLog& log) {
        EXPECT_EQ(log.time, snapshot.time);
        for (const core::VehicleKey key : snapshot.key) {
            const traffic::ObservedVehicle* const seen = find(observation, key);
            const bool is_dark = seen != nullptr && seen->freshness == traffic::Freshness::stale;
            EXPECT_EQ(std::ranges::binary_search(log.dark, key), is_dark);
            EXPECT_EQ(std::ranges::binary_search(log.never_seen, key), seen == nullptr);
        }
        dark += log.dark.size();
        unseen += log.never_seen.size();
    });
    EXPECT_GT(dark, 500u);
    EXPECT_GT(unseen, 50u);
}

TEST(FailureLog, ListsTheLostLinksWithTheirCause) {
    std::size_t causes[2] = {0, 0};
    run(failure_from("B10"), [&](const truth::Snapshot& snapshot, const graph::ProximityGraph& true_graph,
                                 const auto&, const FailureLog& log) {
        std::size_t expected = 0;
        for (core::VehicleIndex left = 0; left < snapshot.size(); ++left) {
            for (const core::VehicleIndex right : true_graph.neighbours_of(left)) {
                const auto missing = [&](core::VehicleIndex row) {
                    return std::ranges::binary_search(log.dark, snapshot.key[row]) ||
                           std::ranges::binary_search(log.never_seen, snapshot.key[row]);
                };
                if (right > left && (missing(left) || missing(right))) ++expected;
            }
        }
        EXPECT_EQ(log.lost_links.size(), expected);
        for (const FailureLog::LostLink& link : log.lost_links) {
            const bool unseen = std::ranges::binary_search(log.never_seen, link.left) ||
                                std::ranges::binary_search(log.never_seen, link.right);
            EXPECT_EQ(link.cause == FailureLog::Cause::never_seen, unseen);
            ++causes[static_cast<std::size_t>(link.cause)];
        }
    });
    EXPECT_GT(causes[0], 100u);
    EXPECT_GT(causes[1], 10u);
}

TEST(DetectedLinks, AreHalfOfTheDarkTrueLinksAndNotLost) {
    std::size_t detected = 0;
    std::size_t dark_links = 0;
    run(failure_from("C.range"), [&](const truth::Snapshot& snapshot, const auto&,
                                     const traffic::Observation& observation, const FailureLog& log) {
        detected += observation.detected_links.size();
        for (const FailureLog::LostLink& link : log.lost_links) {
            if (link.cause == FailureLog::Cause::dark) ++dark_links;
        }
        for (const traffic::DetectedLink& link : observation.detected_links) {
            // The crowd stands in a line, 30 m apart: only direct neighbours are linked.
            EXPECT_EQ(std::max(*snapshot.row_of(link.from), *snapshot.row_of(link.to)) -
                          std::min(*snapshot.row_of(link.from), *snapshot.row_of(link.to)),
                      1u);
            EXPECT_NEAR(link.range_m, 30.0F, 6.0F);
            EXPECT_EQ(link.range_sigma_m, 1.0F);
            EXPECT_TRUE(find(observation, link.from)->freshness == traffic::Freshness::stale ||
                        find(observation, link.to)->freshness == traffic::Freshness::stale);
            EXPECT_THAT(log.lost_links, ::testing::Each(::testing::ResultOf(
                                            [&](const FailureLog::LostLink& lost) {
                                                return std::minmax(lost.left, lost.right) ==
                                                       std::minmax(link.from, link.to);
                                            },
                                            false)));
        }
    });
    dark_links += detected;
    EXPECT_GT(dark_links, 1000u);
    EXPECT_NEAR(static_cast<double>(detected) / static_cast<double>(dark_links), 0.5, 0.04);
}

}  // namespace
}  // namespace clearway::sensing
