#include "prediction/comparison/features.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "prediction/darkness.hpp"

namespace clearway::prediction {
namespace {

using ::testing::ElementsAre;

Tracks tracks_of(const support::Scene& scene, const traffic::Observation& observation) {
    Tracks tracks;
    dead_reckon(observation, scene.network(), tracks);
    return tracks;
}

constexpr const char* drawing = R"(
    10 m per cell, limit 20 m/s, speed 10 m/s
    ..e..............
    .....h.........a.
)";

TEST(PublishedFeatures, AreLastSeenPositionSpeedLaneAndClass) {
    support::Scene scene(drawing);
    const Tracks tracks = tracks_of(scene, testing::after_outage(scene, 2.0, {"e1"}));
    std::vector<float> features;
    as_published_features(tracks, as_published_attributes_schema(), scene.network(), features);
    ASSERT_EQ(features.size(), 15u);
    const auto row = [&](const char* id) { return std::span(features).subspan(5 * scene.row(id), 5); };
    EXPECT_THAT(row("e1"), ElementsAre(25.0F, 3.2F, 10.0F, 1.0F, 2.0F));
    EXPECT_THAT(row("h1"), ElementsAre(75.0F, 0.0F, 10.0F, 0.0F, 0.0F));
    EXPECT_EQ(row("a1")[4], 1.0F);
    as_published_features(tracks, as_published_position_schema(), scene.network(), features);
    ASSERT_EQ(features.size(), 6u);
    EXPECT_EQ(features[2 * scene.row("e1")], 25.0F);
}

TEST(CorrectedFeatures, MeasureDistanceInTheirProduct) {
    support::Scene scene(drawing);
    const Tracks tracks = tracks_of(scene, testing::after_outage(scene, 4.0, {"e1"}));
    std::vector<float> features;
    corrected_features(tracks, features);
    ASSERT_EQ(features.size(), 15u);
    const float* const dark = &features[5 * scene.row("e1")];
    const float* const seen = &features[5 * scene.row("h1")];
    float kernel = 0.0F;
    for (int at = 0; at < 4; ++at) {
        kernel += dark[at] * seen[at];
    }
    // e1 is at 25 + 40 m by dead reckoning, h1 at 55 + 40 m, one lane beside it.
    const double wave_number = 2.0 * std::numbers::pi / 400.0;
    EXPECT_NEAR(kernel, 9.0 * (std::cos(wave_number * 30.0) + std::cos(wave_number * 3.2)), 1e-4);
    EXPECT_FLOAT_EQ(dark[4] * seen[4], std::exp(-0.4F));
}

TEST(CorrectedFeatures, DependOnPlaceOnlyThroughDistance) {
    Tracks tracks;
    tracks.resize(2);
    const auto kernel = [&](float x_m, float y_m) {
        tracks.x_m = {x_m, x_m + 30.0F};
        tracks.y_m = {y_m, y_m - 20.0F};
        tracks.age_s = {1.0F, 2.0F};
        std::vector<float> features;
        corrected_features(tracks, features);
        float sum = 0.0F;
        for (std::size_t at = 0; at < 5; ++at) {
            sum += features[at] * features[5 + at];
        }
        return sum;
    };
    EXPECT_NEAR(kernel(0.0F, 0.0F), kernel(5321.0F, -987.0F), 1e-3);
    EXPECT_NEAR(kernel(0.0F, 0.0F), kernel(171.0F, 2040.0F), 1e-3);
}

TEST(FeatureSchemas, HaveDifferentNames) {
    const std::array schemas = {as_published_position_schema(), as_published_attributes_schema(),
                                corrected_schema()};
    for (const FeatureSchema& one : schemas) {
        for (const FeatureSchema& other : schemas) {
            EXPECT_EQ(one.name == other.name, one == other);
        }
    }
}

}  // namespace
}  // namespace clearway::prediction
