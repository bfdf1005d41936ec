// The simple opponents of link prediction.
#include <cmath>
#include <numbers>
#include <utility>

#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/random.hpp"
#include "prediction/comparison/common_neighbours.hpp"
#include "prediction/comparison/logistic.hpp"
#include "prediction/comparison/pair_features.hpp"
#include "prediction/darkness.hpp"
#include "prediction/disc_probability.hpp"
#include "prediction/planar.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::prediction {
namespace {

using testing::after_outage;
using testing::link;
using testing::side_by_side;

traffic::BelievedGraph belief_of(Predictor& predictor, const traffic::Observation& observation) {
    traffic::BelievedGraph belief;
    predictor.predict(observation, belief);
    return belief;
}

/// Of one deviation along every axis.
RelativePosition round_position(double offset_m, double sigma_m) {
    const auto variance = static_cast<float>(sigma_m * sigma_m);
    return {static_cast<float>(0.6 * offset_m), static_cast<float>(-0.8 * offset_m), variance, 0.0F,
            variance};
}

TEST(ProbabilityInDisc, IsTheNonCentralChiSquareDistributionWhereAllAxesAreAlike) {
    for (const double sigma : {0.5, 2.0, 7.0, 20.0, 60.0, 400.0}) {
        for (const double offset : {0.5, 20.0, 44.0, 49.0, 50.0, 51.0, 57.0, 80.0, 150.0}) {
            const double centre = std::pow(offset / sigma, 2);
            if (centre > 1e5) continue;  // Boost's series gives up.
            const boost::math::non_central_chi_squared distribution(2.0, centre);
            EXPECT_NEAR(probability_in_disc(50.0F, round_position(offset, sigma)),
                        boost::math::cdf(distribution, std::pow(50.0 / sigma, 2)), 2e-4)
                << "offset " << offset << ", sigma " << sigma;
        }
    }
}

TEST(ProbabilityInDisc, IsTheMassInTheDiscForAnyCovariance) {
    for (const double angle : {0.0, 0.4, 1.3, 2.5}) {
        for (const auto& [along, across] : {std::pair(30.0, 2.0), {12.0, 12.0}, {80.0, 25.0}, {4.0, 0.5}}) {
            for (const auto& [x, y] : {std::pair(0.0, 0.0), {45.0, 10.0}, {-52.0, 0.0}, {30.0, -60.0}}) {
                const double c = std::cos(angle);
                const double s = std::sin(angle);
                const double a2 = along * along;
                const double b2 = across * across;
                const RelativePosition position{
                    static_cast<float>(x), static_cast<float>(y), static_cast<float>(c * c * a2 + s * s * b2),
                    static_cast<float>(c * s * (a2 - b2)), static_cast<float>(s * s * a2 + c * c * b2)};
                // The oracle: a fine sum over the normal's own frame.
                double mass = 0.0;
                constexpr int cells = 600;
                for (int i = 0; i < cells; ++i) {
                    for (int j = 0; j < cells; ++j) {
                        const double u = -6.0 + 12.0 * (i + 0.5) / cells;
                        const double v = -6.0 + 12.0 * (j + 0.5) / cells;
                        const double px = x + c * along * u - s * across * v;
                        const double py = y + s * along * u + c * across * v;
                        if (px * px + py * py < 2500.0) mass += std::exp(-0.5 * (u * u + v * v));
                    }
                }
                mass *= std::pow(12.0 / cells, 2) / (2.0 * std::numbers::pi);
                EXPECT_NEAR(probability_in_disc(50.0F, position), mass, 4e-3)  // Half a cell at the edge.
                    << angle << " " << along << " " << across << " " << x << " " << y;
            }
        }
    }
}

TEST(ProbabilityInDisc, IsRayleighsFormulaAtTheCentreAndAStepWithoutError) {
    EXPECT_NEAR(probability_in_disc(50.0F, round_position(0.0, 25.0)), 1.0 - std::exp(-2.0), 1e-5);
    EXPECT_EQ(probability_in_disc(50.0F, round_position(49.9, 0.0)), 1.0F);
    EXPECT_EQ(probability_in_disc(50.0F, round_position(50.1, 0.0)), 0.0F);
    EXPECT_EQ(probability_in_disc(50.0F, round_position(500.0, 10.0)), 0.0F);
    EXPECT_EQ(probability_in_disc(50.0F, round_position(1.0, 0.01)), 1.0F);
}

TEST(HeadingReckoning, LeavesTheRoadWhereTheRouteWouldTurn) {
    support::Scene scene(side_by_side);
    traffic::Observation observation = after_outage(scene, 5.0, {"a1"});
    observation.vehicles[scene.row("a1")].state.heading_rad = 0.5F;  // As in a bend.
    const auto heading = make_predictor("dead_reckoning_heading", {scene.network(), {}, "", {}});
    const auto belief = belief_of(*heading, observation);
    const traffic::MotionState& state = belief.find(scene.key("a1"))->state;
    EXPECT_NEAR(state.x_m, 35.0F + 100.0F * std::cos(0.5F), 1e-3F);
    EXPECT_NEAR(state.y_m, 100.0F * std::sin(0.5F), 1e-3F);
    EXPECT_EQ(state.lane_position_m, 135.0F) << "the place on the map is that of dead reckoning";
    EXPECT_FLOAT_EQ(belief.find(scene.key("a1"))->sigma_m, 12.5F);
}

TEST(PlanarPredictors, KeepVehiclesPastTheirRouteOnlyWhereExitsAreKnown) {
    for (const char* const name : {"dead_reckoning_heading", "kalman", "logistic"}) {
        for (const bool exits_known : {true, false}) {
            support::Scene scene(side_by_side);  // a1 is 255 m before the end of the road.
            traffic::Observation observation = after_outage(scene, 14.0, {"a1"});
            observation.exits_known = exits_known;
            const auto predictor = make_predictor(name, {scene.network(), {}, "", {}});
            EXPECT_EQ(belief_of(*predictor, observation).find(scene.key("a1")) != nullptr, exits_known)
                << name;
        }
    }
}

/// One vehicle that reports `state` with `sigma_m` at `measured_s`, seen at `time_s`.
traffic::Observation report_of(const support::Scene& scene, const traffic::MotionState& state, double time_s,
                               double measured_s, float sigma_m = 0.0F) {
    traffic::Observation observation = support::perfect_observation(scene);
    observation.time = core::Seconds(time_s);
    observation.vehicles.resize(1);
    traffic::ObservedVehicle& vehicle = observation.vehicles[0];
    vehicle.state = state;
    vehicle.age_s = static_cast<float>(time_s - measured_s);
    vehicle.position_sigma_m = sigma_m;
    vehicle.freshness = vehicle.age_s == 0.0F ? traffic::Freshness::fresh : traffic::Freshness::stale;
    return observation;
}

traffic::MotionState driving(float x_m, float speed_mps) {
    traffic::MotionState state;
    state.x_m = x_m;
    state.speed_mps = speed_mps;
    return state;
}

TEST(Kalman, SpreadsAsItsNoisesSay) {
    const support::Scene scene("10 m per cell\n..e....");
    const auto kalman = make_kalman({scene.network(), {}, "", {}},
                                    {.along_psd = 0.6, .across_psd = 0.1, .speed_sigma_mps = 0.5});
    belief_of(*kalman, report_of(scene, driving(0.0F, 10.0F), 100.0, 100.0));
    const auto later = belief_of(*kalman, report_of(scene, driving(0.0F, 10.0F), 110.0, 100.0));
    EXPECT_NEAR(later.vehicles[0].state.x_m, 100.0F, 1e-3F);
    // Var = (10 s x 0.5 m/s)^2 + 0.6 m2/s3 x (10 s)^3 / 3.
    EXPECT_NEAR(later.vehicles[0].sigma_m, std::sqrt(25.0 + 200.0), 1e-3);
}

TEST(Kalman, SpreadsMoreAlongTheHeadingThanAcross) {
    support::Scene scene(side_by_side);
    // Both stand, 48 m apart; the darkness of 10 s moves a1 along the road, towards e1 or away, hardly
    // across.
    for (const bool along : {true, false}) {
        traffic::Observation observation = after_outage(scene, 0.0, {"a1"});
        for (traffic::ObservedVehicle& vehicle : observation.vehicles) {
            vehicle.state = driving(0.0F, 0.0F);
            if (vehicle.key == scene.key("e1")) (along ? vehicle.state.x_m : vehicle.state.y_m) = 48.0F;
        }
        observation.vehicles[scene.row("a1")].age_s = 10.0F;
        const auto kalman = make_kalman({scene.network(), {}, "", {}},
                                        {.along_psd = 1.0, .across_psd = 1e-4, .speed_sigma_mps = 1e-3});
        belief_of(*kalman, observation);
        ASSERT_EQ(kalman->scores().probability.size(), 1u);
        // Along: Phi(2 m / 18.3 m) less the far side. Across: h(48) = 14 m, so 2 Phi(14 / 18.3) - 1.
        EXPECT_NEAR(kalman->scores().probability[0], along ? 0.5436 : 0.556, 0.01) << along;
    }
}

TEST(Kalman, MatchesTheGainWorkedOutByHand) {
    const support::Scene scene("10 m per cell\n..e....");
    const auto kalman = make_kalman({scene.network(), {}, "", {}},
                                    {.along_psd = 3.0, .across_psd = 1.0, .speed_sigma_mps = 1.0});
    // From P = diag(1, 1) one second on: [1 + 1 + 1, 1 + 1.5; 2.5, 1 + 3] = [3, 2.5; 2.5, 4].
    // S = P + I = [4, 2.5; 2.5, 5], |S| = 13.75. K = P S^-1 = [8.75, 2.5; 2.5, 9.75] / 13.75.
    // Innovation (12 - 10, 11 - 10) = (2, 1): x = 10 + 20 / 13.75, v = 10 + 14.75 / 13.75.
    belief_of(*kalman, report_of(scene, driving(0.0F, 10.0F), 100.0, 100.0, 1.0F));
    const auto now = belief_of(*kalman, report_of(scene, driving(12.0F, 11.0F), 101.0, 101.0, 1.0F));
    EXPECT_NEAR(now.vehicles[0].state.x_m, 10.0 + 20.0 / 13.75, 1e-4);
    EXPECT_NEAR(now.vehicles[0].state.speed_mps, 10.0 + 14.75 / 13.75, 1e-4);
    EXPECT_NEAR(now.vehicles[0].sigma_m, std::sqrt(8.75 / 13.75), 1e-4) << "K R, R = I";
}

TEST(Kalman, KeepsASaneVarianceAfterAnySilence) {
    const support::Scene scene("10 m per cell\n..e....");
    for (const double silence_s : {5.0, 29.0, 31.0, 100.0, 400.0, 1000.0}) {
        for (const char* const name : {"kalman", "route_rule"}) {
            const auto predictor = make_predictor(name, {scene.network(), {}, "", {}});
            belief_of(*predictor, report_of(scene, driving(0.0F, 13.7F), 100.0, 100.0, 3.0F));
            const double then_s = 100.0 + silence_s;
            const auto now =
                belief_of(*predictor, report_of(scene, driving(40.0F, 1.3F), then_s, then_s, 3.0F));
            EXPECT_GT(now.vehicles[0].sigma_m, 2.0F) << name << ", " << silence_s;
            EXPECT_LE(now.vehicles[0].sigma_m, 3.0F) << name << ", " << silence_s;
        }
    }
}

TEST(Kalman, KeepsASaneVarianceOverManyReports) {
    const support::Scene scene("10 m per cell\n..e....");
    for (const char* const name : {"kalman", "route_rule"}) {
        const auto predictor = make_predictor(name, {scene.network(), {}, "", {}});
        for (int second = 0; second < 2000; ++second) {
            traffic::MotionState state =
                driving(static_cast<float>(second % 7), static_cast<float>(second % 14));
            state.heading_rad = 0.7F * static_cast<float>(second % 9);
            const auto now = belief_of(*predictor, report_of(scene, state, second, second, 1.0F));
            if (second < 10) continue;
            ASSERT_GT(now.vehicles[0].sigma_m, 0.3F) << name << ", " << second;
            ASSERT_LT(now.vehicles[0].sigma_m, 1.0F) << name << ", " << second;
        }
    }
}

TEST(Kalman, TakesEachReportOnceAndStartsAnewWithAnOlderOne) {
    const support::Scene scene("10 m per cell\n..e....");
    const auto kalman = make_predictor("kalman", {scene.network(), {}, "", {}});
    belief_of(*kalman, report_of(scene, driving(0.0F, 10.0F), 100.0, 100.0, 3.0F));
    const auto once = belief_of(*kalman, report_of(scene, driving(12.0F, 11.0F), 101.0, 101.0, 3.0F));
    const auto twice = belief_of(*kalman, report_of(scene, driving(12.0F, 11.0F), 101.0, 101.0, 3.0F));
    EXPECT_EQ(once.vehicles[0].state.x_m, twice.vehicles[0].state.x_m);
    EXPECT_EQ(once.vehicles[0].sigma_m, twice.vehicles[0].sigma_m);
    const auto again = belief_of(*kalman, report_of(scene, driving(5.0F, 2.0F), 50.0, 50.0, 3.0F));
    EXPECT_EQ(again.vehicles[0].state.x_m, 5.0F);
    EXPECT_EQ(again.vehicles[0].sigma_m, 3.0F);
}

TEST(Kalman, KeepsToExactReportsInAnyDirection) {
    const support::Scene scene("10 m per cell\n..e....");
    for (const float heading : {0.0F, 0.3F, 0.8F, 2.0F, -2.7F}) {
        const auto kalman = make_predictor("kalman", {scene.network(), {}, "", {}});
        traffic::MotionState state;
        state.heading_rad = heading;
        for (int second = 0; second < 120; ++second) {
            state.speed_mps = 10.0F + static_cast<float>(second % 7);
            state.x_m = 5000.0F + 11.0F * static_cast<float>(second) * std::cos(heading);
            state.y_m = 3000.0F + 11.0F * static_cast<float>(second) * std::sin(heading);
            const auto belief = belief_of(*kalman, report_of(scene, state, second, second));
            ASSERT_EQ(belief.vehicles[0].state.x_m, state.x_m);
            ASSERT_NEAR(belief.vehicles[0].state.speed_mps, state.speed_mps, 4.0) << heading << " " << second;
            ASSERT_LT(belief.vehicles[0].sigma_m, 0.2F);
        }
        const auto later = belief_of(*kalman, report_of(scene, state, 124.0, 119.0));
        EXPECT_NEAR(
            std::hypot(later.vehicles[0].state.x_m - state.x_m, later.vehicles[0].state.y_m - state.y_m),
            5.0 * state.speed_mps, 20.0);
    }
}

TEST(Kalman, IsNearerToTheTruthThanNoisyReports) {
    const support::Scene scene("10 m per cell\n..e....");
    const auto kalman = make_predictor("kalman", {scene.network(), {}, "", {}});
    const core::KeyedRandom random({3}, {0});
    double raw = 0.0;
    double filtered = 0.0;
    for (int second = 0; second < 500; ++second) {
        const double true_m = 10.0 * second;
        const double seen_m = true_m + 3.0 * random.normal(core::Purpose::position_noise, 1, second);
        const auto belief = belief_of(
            *kalman, report_of(scene, driving(static_cast<float>(seen_m), 10.0F), second, second, 3.0F));
        raw += std::pow(seen_m - true_m, 2);
        filtered += std::pow(belief.vehicles[0].state.x_m - true_m, 2);
    }
    EXPECT_LT(filtered, 0.7 * raw);
}

TEST(CommonNeighbours, GivesOddsByTheNumberOfSharedNeighbours) {
    // All stand. a1 and h1 share h2, h3 and e1; a1 and h4, 60 m apart, share h3 alone.
    support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 0 m/s
        ..hhh...h......................................h
        ..ae............................................
    )");
    const traffic::Observation observation = after_outage(scene, 5.0, {"a1", "h5"});
    const auto predictor =
        make_common_neighbours({scene.network(), {}, "", {}}, {.intercept = -1.0, .slope = 0.5});
    belief_of(*predictor, observation);
    const CandidateScores scores = predictor->scores();
    const auto score = [&](const char* one, const char* other) {
        const std::uint32_t left = std::min(scene.row(one), scene.row(other));
        const std::uint32_t right = std::max(scene.row(one), scene.row(other));
        const auto& rows = scores.scene->candidates.rows;
        const auto found = std::ranges::find(rows, RowPair{left, right});
        EXPECT_NE(found, rows.end());
        return scores.probability[static_cast<std::size_t>(found - rows.begin())];
    };
    EXPECT_NEAR(score("a1", "h1"), 1.0 / (1.0 + std::exp(1.0 - 0.5 * 3.0)), 1e-6);
    EXPECT_NEAR(score("a1", "h4"), 1.0 / (1.0 + std::exp(1.0 - 0.5 * 1.0)), 1e-6);
}

TEST(PairFeatures, AreWhatTheirNamesSay) {
    support::Scene scene(side_by_side);
    scene.set_speed("e1", core::MetresPerSecond(12.0));
    const auto predictor = make_predictor("logistic", {scene.network(), {}, "", {}});
    belief_of(*predictor, after_outage(scene, 2.0, {"a1"}));
    const Scene& found = *predictor->scores().scene;
    ASSERT_EQ(found.candidates.size(), 1u);
    const PairFeatures features = pair_features(found, 0, 50.0F);
    // e1 at 49 m, a1 last seen at 35 m and now reckoned at 75 m, one lane apart.
    const float now_m = std::hypot(26.0F, 3.2F);
    EXPECT_NEAR(features[0], (50.0F - now_m) / 10.0F, 1e-4F);
    EXPECT_NEAR(features[1], (50.0F - std::hypot(14.0F, 3.2F)) / 10.0F, 1e-4F);
    EXPECT_NEAR(features[2], 0.2F, 1e-6F);
    EXPECT_NEAR(features[3], 0.0F, 1e-6F);
    EXPECT_NEAR(features[4], (50.0F - now_m) / 6.0F, 1e-4F);
    EXPECT_NEAR(features[5], features[0] * std::exp(-0.2F), 1e-5F);
    EXPECT_NEAR(features[6], -0.8F * 26.0F / now_m, 1e-4F) << "a1 is ahead and 8 m/s faster: they part";
    EXPECT_NEAR(features[7], std::log(6.0F), 1e-5F);
}

TEST(Logistic, IsTheModelOfItsFile) {
    const support::TemporaryFolder folder;
    Weights weights;
    weights.architecture = logistic_architecture;
    weights.features = pair_feature_schema();
    weights.tensors = {{"weight", {1, 8}, {0.1F, -0.2F, 0.3F, 0.4F, 0.5F, -0.6F, 0.7F, -0.8F}},
                       {"bias", {1}, {0.25F}}};
    const auto file = folder.path() / "mine.weights";
    write_weights(file, weights);
    support::Scene scene(side_by_side);
    const traffic::Observation observation = after_outage(scene, 5.0, {"a1"});
    const auto predictor = make_predictor("logistic", {scene.network(), {}, file.string(), {}});
    belief_of(*predictor, observation);
    const CandidateScores scores = predictor->scores();
    ASSERT_EQ(scores.probability.size(), 1u);
    const PairFeatures features = pair_features(*scores.scene, 0, 50.0F);
    double logit = 0.25;
    for (std::size_t i = 0; i < pair_feature_count; ++i) {
        logit += static_cast<double>(weights.tensors[0].values[i]) * features[i];
    }
    EXPECT_NEAR(scores.probability[0], 1.0 / (1.0 + std::exp(-logit)), 1e-6);

    weights.features.version = 2;
    write_weights(file, weights);
    EXPECT_THROW(make_predictor("logistic", {scene.network(), {}, file.string(), {}}), core::InputError);
}

}  // namespace
}  // namespace clearway::prediction
