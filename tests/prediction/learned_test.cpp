#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "prediction/comparison/published_nets.hpp"
#include "prediction/darkness.hpp"
#include "prediction/nets.hpp"
#include "prediction/shipped_models.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::prediction {
namespace {

using testing::after_outage;
using ::testing::HasSubstr;
using testing::kernel_net;
using testing::link;
using testing::random_net;

constexpr const char* platoon = R"(
    10 m per cell, limit 20 m/s, speed 20 m/s
    ..e..h.....h..................................
    ....a........a................................
)";

TEST(GraphSageCorrected, RestoresLinksByDeadReckonedDistance) {
    const support::TemporaryFolder folder;
    write_weights(folder.path() / "kernel.weights", kernel_net());
    support::Scene scene(platoon);
    const auto predictor =
        make_graphsage_corrected({scene.network(), {}, (folder.path() / "kernel.weights").string(), {}});
    traffic::BelievedGraph belief;
    predictor->predict(after_outage(scene, 5.0, {"a1"}), belief);
    EXPECT_GT(link(scene, belief, "a1", "e1").value_or(0.0F), 0.9F);
    EXPECT_GT(link(scene, belief, "a1", "h1").value_or(0.0F), 0.9F);
    EXPECT_FALSE(link(scene, belief, "a1", "h2").has_value()) << "70 m apart";
    EXPECT_NEAR(belief.find(scene.key("a1"))->state.x_m, 145.0F, 1e-3F);
}

TEST(GraphSageCorrected, ScoresNoPairBeyondTheReachOfItsKernel) {
    const support::TemporaryFolder folder;
    write_weights(folder.path() / "kernel.weights", kernel_net());
    // a1 was last seen 390 m behind e1 and is now there by dead reckoning; h1 was near a1, which then left it
    // by 400 m: the kernel cannot tell 400 m from 0.
    support::Scene scene(R"(
        10 m per cell, limit 40 m/s, speed 40 m/s
        h.................................................
        a......................................e..........
    )");
    scene.set_speed("h1", core::MetresPerSecond(0.0));
    scene.set_speed("e1", core::MetresPerSecond(0.0));
    const auto predictor =
        make_graphsage_corrected({scene.network(), {}, (folder.path() / "kernel.weights").string(), {}});
    traffic::BelievedGraph belief;
    predictor->predict(after_outage(scene, 10.0, {"a1"}), belief);
    EXPECT_TRUE(link(scene, belief, "a1", "e1").has_value());
    EXPECT_FALSE(link(scene, belief, "a1", "h1").has_value());
    EXPECT_EQ(predictor->scores().probability.size(), 2u);
}

TEST(GraphSageAsPublished, TakesTwoOrFiveInputsAsTheFileSays) {
    const support::TemporaryFolder folder;
    support::Scene scene(platoon);
    const traffic::Observation observation = after_outage(scene, 5.0, {"a1"});
    for (const FeatureSchema& schema : {as_published_position_schema(), as_published_attributes_schema()}) {
        const auto file = folder.path() / (schema.name + ".weights");
        write_weights(file, random_net(schema, 10, 5));
        const auto predictor = make_graphsage_as_published({scene.network(), {}, file.string(), {}});
        traffic::BelievedGraph belief;
        predictor->predict(observation, belief);
        EXPECT_EQ(predictor->scores().probability.size(), predictor->scores().scene->candidates.size());
        EXPECT_NEAR(belief.find(scene.key("a1"))->state.x_m, 45.0F, 1e-3F)
            << "it stays where it was last seen";
    }
}

TEST(GraphSageAsPublished, SendsItsMessagesAlongTheListedPairs) {
    const support::TemporaryFolder folder;
    const auto file = folder.path() / "net.weights";
    const Weights weights = random_net(as_published_position_schema(), 10, 5, 0.1);
    write_weights(file, weights);
    support::Scene scene(platoon);
    const auto predictor = make_graphsage_as_published({scene.network(), {}, file.string(), {}});
    traffic::BelievedGraph belief;
    predictor->predict(after_outage(scene, 5.0, {"a1"}), belief);
    const Scene& found = *predictor->scores().scene;
    ASSERT_GT(found.candidates.size(), 2u);

    std::vector<std::uint32_t> sources;
    std::vector<std::uint32_t> targets;
    for (const RowPair pair : found.candidates.rows) {
        sources.push_back(pair.left);
        targets.push_back(pair.right);
    }
    MessageGraph graph;
    message_graph_from(sources, targets, found.tracks.size(), graph);
    std::vector<float> features;
    as_published_features(found.tracks, as_published_position_schema(), scene.network(), features);
    std::vector<float> logits;
    DissertationNet(Convolution::sage, weights, as_published_position_schema())
        .logits(features, graph, found.candidates.rows, logits);
    for (std::size_t at = 0; at < logits.size(); ++at) {
        EXPECT_EQ(predictor->scores().probability[at], probability_from_logit(logits[at]));
    }
}

TEST(LearnedPredictors, RefuseAModelForOtherFeaturesNamingBoth) {
    const support::TemporaryFolder folder;
    const auto file = folder.path() / "net.weights";
    write_weights(file, random_net(as_published_position_schema(), 10, 5));
    const support::Scene scene(platoon);
    try {
        make_graphsage_corrected({scene.network(), {}, file.string(), {}});
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("as_published_position version 1"),
                                        HasSubstr("corrected version 2"), HasSubstr(file.string())));
    }
    write_weights(file, random_net({"corrected", 1, 5}, 10, 5));
    EXPECT_THROW(make_graphsage_corrected({scene.network(), {}, file.string(), {}}), core::InputError);
    EXPECT_THROW(make_graphsage_as_published({scene.network(), {}, file.string(), {}}), core::InputError);
}

TEST(LearnedPredictors, RefuseDamagedNumbersWhenTheyOverflow) {
    const support::TemporaryFolder folder;
    const std::string file = (folder.path() / "damaged.weights").string();
    Weights damaged = shipped_model("graphsage");
    for (Tensor& tensor : damaged.tensors)
        std::ranges::fill(tensor.values, 1e38F);
    write_weights(file, damaged);
    support::Scene scene(platoon);
    const auto predictor = make_predictor("graphsage", {scene.network(), {}, file, {}});
    traffic::BelievedGraph belief;
    try {
        predictor->predict(after_outage(scene, 5.0, {"a1"}), belief);
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr(file), HasSubstr("damaged")));
    }
}

std::size_t radius_problems(const std::string& name, const std::string& file, double radius_m) {
    std::vector<core::Problem> problems;
    check_link_radius(name, file, radius_m, "radius", problems);
    return problems.size();
}

TEST(LearnedPredictors, SayForWhichLinkRadiiTheyWereTrained) {
    const support::Scene scene(platoon);
    for (const std::string& name : predictors().names(traffic::Trait::learned)) {
        const bool has_range = name == "graphsage" || name == "gradient_boosting";
        const std::string range = has_range ? "25 to 300 m" : "50 m";
        for (const double radius_m : {24.0, 25.0, 50.0, 120.0, 300.0, 301.0}) {
            const bool fits = radius_m == 50.0 || (has_range && radius_m > 24.0 && radius_m < 301.0);
            EXPECT_EQ(radius_problems(name, "", radius_m) == 0, fits) << name << radius_m;
            try {
                make_predictor(name, {scene.network(), {.radius_m = radius_m}, "", {}});
                EXPECT_TRUE(fits) << name << radius_m;
            } catch (const core::InputError& error) {
                EXPECT_FALSE(fits) << name << radius_m;
                EXPECT_THAT(error.what(), AllOf(HasSubstr("allowed: " + range), HasSubstr("car_following")));
            }
        }
    }
    EXPECT_EQ(radius_problems("kalman", "", 1000.0), 0U);
}

TEST(LearnedPredictors, OfOnesOwnAreHeldToTheRadiiOfTheirData) {
    const support::TemporaryFolder folder;
    const std::string file = (folder.path() / "own.weights").string();
    Weights own = shipped_model("logistic");
    own.link_radius = {80.0, 80.0};
    write_weights(file, own);
    EXPECT_EQ(read_weights(file).link_radius, own.link_radius);
    EXPECT_EQ(radius_problems("logistic", file, 80.0), 0U);
    EXPECT_EQ(radius_problems("logistic", file, 50.0), 1U);
    EXPECT_THROW(parse_weights("clearway-weights 1\nlink_radius 80 20\nend\n", "bad"), core::InputError);
}

TEST(LearnedPredictors, RefuseTensorsThatNoLayerReads) {
    const support::TemporaryFolder folder;
    const std::string file = (folder.path() / "more.weights").string();
    for (const std::string& name : shipped_model_names()) {
        Weights more = shipped_model(name);
        more.tensors.push_back({"layer3.more", {1}, {0.0F}});
        write_weights(file, more);
        try {
            check_model(name, file);
            ADD_FAILURE() << name;
        } catch (const core::InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("tensors")) << name;
        }
    }
}

TEST(ShippedModels, AreReadableAndFitTheirPredictor) {
    const support::Scene scene(platoon);
    for (const std::string& name : shipped_model_names()) {
        EXPECT_NO_THROW(make_predictor(name, {scene.network(), {}, "", {}})) << name;
    }
    EXPECT_THROW(shipped_model("last_seen"), core::InputError);
}

TEST(ShippedModels, WereLeftByTheTrainingsThatAreShippedWithThem) {
    const std::filesystem::path trainings = CLEARWAY_SOURCE_DIR "/models";
    for (const auto& [name, training] : {std::pair("graphsage", "training/graphsage"),
                                         {"graphsage_corrected", "training/corrected"},
                                         {"graphsage_as_published", "training/as_published"},
                                         {"gradient_boosting", "comparison/gradient_boosting"},
                                         {"gcn", "comparison/gcn"},
                                         {"gat", "comparison/gat"}}) {
        const std::vector<std::string> notes = shipped_model(name).notes;
        ASSERT_FALSE(notes.empty()) << name;
        const std::size_t at = notes.front().find("data ");
        ASSERT_NE(at, std::string::npos) << name;
        EXPECT_THAT(core::read_file(trainings / training / "summary.json"),
                    HasSubstr(notes.front().substr(at + 5)))
            << name;
    }
}

}  // namespace
}  // namespace clearway::prediction
