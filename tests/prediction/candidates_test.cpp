#include "prediction/candidates.hpp"

#include <set>

#include <gmock/gmock.h>

#include "prediction/darkness.hpp"

namespace clearway::prediction {
namespace {

using testing::after_outage;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// Pairs by name, `a1-h1`, the lower name first.
std::set<std::string> names(const support::Scene& scene, const Scene& found, const PairList& pairs) {
    std::set<std::string> result;
    for (const RowPair pair : pairs.rows) {
        EXPECT_LT(pair.left, pair.right);
        const std::string left = scene.id(found.tracks.key[pair.left]);
        const std::string right = scene.id(found.tracks.key[pair.right]);
        result.insert(std::min(left, right) + "-" + std::max(left, right));
    }
    EXPECT_EQ(result.size(), pairs.size());
    EXPECT_TRUE(std::ranges::is_sorted(pairs.rows));
    return result;
}

Scene built(const support::Scene& scene, const traffic::Observation& observation) {
    SceneBuilder builder(scene.network(), {});
    Scene result;
    builder.build(observation, result);
    return result;
}

// h1 and a1 are 40 m apart, a1 and e1 60 m, h1 and h2 130 m and of one class.
constexpr const char* row_of_four = R"(
    10 m per cell, limit 20 m/s, speed 0 m/s
    h...a.....e..h..................................
)";

TEST(SceneBuilder, KnowsTheMeasuredLinksAndNoCandidatesWhereAllReported) {
    const support::Scene scene(row_of_four);
    const Scene found = built(scene, support::perfect_observation(scene));
    EXPECT_THAT(names(scene, found, found.known), UnorderedElementsAre("a1-h1", "e1-h2"));
    EXPECT_THAT(found.candidates.rows, IsEmpty());
    EXPECT_TRUE(found.tracks.all_known && found.tracks.all_current);
}

TEST(SceneBuilder, MakesCandidatesOfAllowedPairsWithADarkEndWithin120Metres) {
    support::Scene scene(row_of_four);
    const Scene found = built(scene, after_outage(scene, 3.0, {"a1"}));
    // a1-h2 lie 90 m apart, a1-e1 60 m, a1-h1 40 m; e1-h2 are both known; h1-e1 too, but 100 m apart.
    EXPECT_THAT(names(scene, found, found.candidates), UnorderedElementsAre("a1-h1", "a1-e1", "a1-h2"));
    EXPECT_THAT(names(scene, found, found.known), UnorderedElementsAre("e1-h2"));
    support::Scene human(row_of_four);
    const Scene both = built(human, after_outage(human, 3.0, {"h1", "h2"}));
    EXPECT_THAT(names(human, both, both.candidates), UnorderedElementsAre("a1-h1", "e1-h1", "a1-h2", "e1-h2"))
        << "130 m is too far, and humans are not linked with each other";
}

TEST(SceneBuilder, TakesPairsThatAreNearByEitherPosition) {
    // e1 stands still and is known; a1 drives at 20 m/s and is dark for 10 s.
    constexpr const char* drawing = R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        a....................e........................
    )";
    support::Scene approaching(drawing);
    approaching.set_speed("e1", core::MetresPerSecond(0.0));
    Scene found = built(approaching, after_outage(approaching, 10.0, {"a1"}));
    ASSERT_THAT(names(approaching, found, found.candidates), UnorderedElementsAre("a1-e1"));
    EXPECT_NEAR(found.candidates.last_seen_m[0], 210.0F, 1e-3F);
    EXPECT_NEAR(found.candidates.dead_reckoned_m[0], 10.0F, 1e-3F);

    support::Scene leaving(R"(
        10 m per cell, limit 20 m/s, speed 20 m/s
        ...e.a........................................
    )");
    leaving.set_speed("e1", core::MetresPerSecond(0.0));
    found = built(leaving, after_outage(leaving, 10.0, {"a1"}));
    ASSERT_THAT(names(leaving, found, found.candidates), UnorderedElementsAre("a1-e1"));
    EXPECT_NEAR(found.candidates.last_seen_m[0], 20.0F, 1e-3F);
    EXPECT_NEAR(found.candidates.dead_reckoned_m[0], 220.0F, 1e-3F);
}

TEST(SceneBuilder, ReachesByTwinsWhereItIsAsked) {
    // a1 was seen standing; its twin has driven on to e1, 300 m ahead, and waits behind it.
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 0 m/s
        .a.............................e..............
    )");
    const traffic::Observation observation = after_outage(scene, 40.0, {"a1"});
    EXPECT_THAT(built(scene, observation).candidates.rows, IsEmpty());
    SceneBuilder builder(scene.network(), {}, CandidateReach::twins);
    Scene found;
    builder.build(observation, found);
    EXPECT_THAT(names(scene, found, found.candidates), ElementsAre("a1-e1"));
    ASSERT_NE(found.twins, nullptr);
    const auto a1 = static_cast<std::uint32_t>(scene.row("a1"));
    const TwinTraffic::Surroundings around = found.twins->surroundings(observation, a1);
    ASSERT_TRUE(around.leader.exists);
    EXPECT_EQ(found.tracks.key[around.leader.row], scene.key("e1"));
    EXPECT_NEAR(around.leader.gap_m, 2.5F, 0.7F);
    EXPECT_NEAR(found.twins->driven_m(a1), 300.0F - 5.0F - around.leader.gap_m, 0.1F);

    SceneBuilder only_drives(scene.network(), {}, CandidateReach::reported);
    only_drives.build(observation, found);
    EXPECT_THAT(found.candidates.rows, IsEmpty());
    EXPECT_NE(found.twins, nullptr);
}

TEST(SceneBuilder, ReachesFurtherForWiderLinks) {
    support::Scene scene(row_of_four);
    const traffic::Observation observation = after_outage(scene, 3.0, {"h1"});
    SceneBuilder builder(scene.network(), {.radius_m = 20.0});
    Scene found;
    builder.build(observation, found);
    EXPECT_THAT(names(scene, found, found.candidates), UnorderedElementsAre("a1-h1", "e1-h1"));
    support::Scene long_road(R"(
        10 m per cell, limit 20 m/s, speed 0 m/s
        h.................................a.......................
    )");
    const traffic::Observation far = after_outage(long_road, 3.0, {"h1"});
    SceneBuilder wide(long_road.network(), {.radius_m = 300.0});
    wide.build(far, found);
    EXPECT_THAT(names(long_road, found, found.candidates), ElementsAre("a1-h1"));
}

TEST(SceneBuilder, SetsDetectedPairsApartFromCandidates) {
    support::Scene scene(row_of_four);
    traffic::Observation observation = after_outage(scene, 3.0, {"a1"});
    observation.detected_links = {{scene.key("a1"), scene.key("h1"), -1.0F, 0.0F},
                                  {scene.key("h1"), scene.key("a1"), 41.0F, 1.0F},
                                  {scene.key("a1"), core::vehicle_key("never seen"), 5.0F, 1.0F}};
    const Scene found = built(scene, observation);
    EXPECT_THAT(names(scene, found, found.detected), UnorderedElementsAre("a1-h1"));
    EXPECT_THAT(found.detected_range_m, ElementsAre(41.0F));
    EXPECT_THAT(names(scene, found, found.candidates), UnorderedElementsAre("a1-e1", "a1-h2"));
}

TEST(SceneBuilder, PredictsWhatTheSensorIsNotSureOf) {
    const support::Scene scene(row_of_four);
    traffic::Observation noisy = support::perfect_observation(scene);
    for (traffic::ObservedVehicle& vehicle : noisy.vehicles) {
        vehicle.position_sigma_m = 3.0F;
    }
    EXPECT_EQ(built(scene, noisy).known.size(), 0u);
    EXPECT_EQ(built(scene, noisy).candidates.size(), 5u);  // All but human with human.
    traffic::Observation late = support::perfect_observation(scene);
    for (traffic::ObservedVehicle& vehicle : late.vehicles) {
        vehicle.age_s = 2.0F;
    }
    EXPECT_EQ(built(scene, late).candidates.size(), 5u);
}

TEST(SceneBuilder, AgreesWithEveryPairTriedOneByOne) {
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 15 m/s
        a.h.a.hh.a..e.h.a.a.hh.a..h.e.a.h........................
        .h.a.ha.e.h..a.h.h.a.a..h.a.hh.a.........................
    )");
    const Scene found = built(scene, after_outage(scene, 6.0, {"a1", "a3", "h2", "h5", "e1", "a7"}));
    const Tracks& tracks = found.tracks;
    const graph::LinkRules rules;
    std::size_t expected = 0;
    for (std::uint32_t left = 0; left < tracks.size(); ++left) {
        for (std::uint32_t right = left + 1; right < tracks.size(); ++right) {
            const float last_m = std::hypot(tracks.last_x_m[left] - tracks.last_x_m[right],
                                            tracks.last_y_m[left] - tracks.last_y_m[right]);
            const float now_m =
                std::hypot(tracks.x_m[left] - tracks.x_m[right], tracks.y_m[left] - tracks.y_m[right]);
            if (!rules.allows(tracks.vehicle_class[left], tracks.vehicle_class[right])) continue;
            if (tracks.known[left] != 0 && tracks.known[right] != 0) continue;
            if (std::min(last_m, now_m) < 120.0F) ++expected;
        }
    }
    EXPECT_GT(expected, 50u);
    EXPECT_EQ(found.candidates.size(), expected);
}

TEST(ObservedMessages, FollowKnownAndDetectedLinksBothWays) {
    support::Scene scene(row_of_four);
    traffic::Observation observation = after_outage(scene, 3.0, {"a1"});
    observation.detected_links = {{scene.key("a1"), scene.key("h1"), -1.0F, 0.0F}};
    const Scene found = built(scene, observation);
    MessageGraph graph;
    ObservedMessages().build(found, {}, graph);
    const auto sources = [&](const char* id) {
        std::set<std::string> result;
        for (std::uint32_t at = graph.first[scene.row(id)]; at < graph.first[scene.row(id) + 1]; ++at) {
            result.insert(scene.id(found.tracks.key[graph.source[at]]));
        }
        return result;
    };
    EXPECT_THAT(sources("a1"), ElementsAre("h1"));
    EXPECT_THAT(sources("h1"), ElementsAre("a1"));
    EXPECT_THAT(sources("e1"), ElementsAre("h2"));
    EXPECT_THAT(sources("h2"), ElementsAre("e1"));
}

}  // namespace
}  // namespace clearway::prediction
