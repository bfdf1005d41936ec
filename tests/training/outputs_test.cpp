#include "training/outputs.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "prediction/weights.hpp"
#include "support/temporary_folder.hpp"
#include "training/comparison/as_published.hpp"
#include "training/loss_curve.hpp"

namespace clearway::training {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Losses, csv_counts_epochs_from_zero_and_leaves_cells_empty) {
    EXPECT_EQ(losses_csv({{0.5, 0.25}, {nan, 0.125}}, "test"),
              "epoch,train_loss_nat,test_loss_nat\n0,0.5,0.25\n1,,0.125\n");
}

TEST(LossCurve, draws_both_losses_with_axes_and_legend) {
    const std::string svg = loss_curve_svg({{1.0, 2.0}, {0.5, 1.0}, {0.25, 0.5}}, "Test Loss");
    EXPECT_THAT(svg, testing::StartsWith("<svg"));
    EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
    for (const char* text : {">Epoch<", ">Loss (nat)<", ">Train Loss<", ">Test Loss<"})
        EXPECT_THAT(svg, HasSubstr(text));
    // The plot spans 70 to 620 and 20 to 350; the axis ends at 2.1.
    EXPECT_THAT(svg, HasSubstr("M70.0 192.9L345.0 271.4L620.0 310.7"));
    EXPECT_THAT(svg, HasSubstr("M70.0 35.7L345.0 192.9L620.0 271.4"));
}

TEST(LossCurve, leaves_a_gap_where_a_loss_is_not_finite) {
    const std::string svg = loss_curve_svg({{1.0, 1.0}, {nan, 1.0}, {1.0, 1.0}, {1.0, nan}}, "a<b");
    EXPECT_THAT(svg, testing::Not(HasSubstr("nan")));
    EXPECT_THAT(svg, HasSubstr("a&lt;b"));
    EXPECT_THAT(loss_curve_svg({}, "Test Loss"), testing::EndsWith("</svg>\n"));
}

AsPublishedResult small_result() {
    const samples::PairDataset dataset{
        2, {0, 0, 1, 0, 2, 1}, {0, 1, 2, 0, 1}, {1, 2, 0, 2, 0}, {1, 1, 0, 1, 0}};
    TrainingConfig config;
    config.epochs = 4;
    return train_as_published(dataset, PairChoice::candidates, config);
}

Identity identity() {
    return identity_of(PairChoice::candidates, TrainingConfig{}, "abc");
}

TEST(Outputs, predictions_list_every_pair_in_its_part) {
    const AsPublishedResult result = small_result();
    const std::string csv = predictions_csv(result);
    EXPECT_THAT(csv, testing::StartsWith("pair,source,target,label,split,logit,probability\n0,0,1,1,train,"));
    EXPECT_THAT(csv, HasSubstr("\n3,0,2,1,train,"));
    EXPECT_THAT(csv, HasSubstr("\n4,1,0,0,test,"));
    EXPECT_EQ(std::ranges::count(csv, '\n'), 6);
}

TEST(Outputs, the_summary_has_null_where_a_figure_is_undefined) {
    const AsPublishedResult result = small_result();
    const auto summary = summary_of(result, identity(), "data");
    EXPECT_EQ(summary["mode"], "graphsage_as_published");
    EXPECT_EQ(summary["outcome"], "finished");
    EXPECT_EQ(summary["pairs"], "candidates");
    EXPECT_EQ(summary["pair_count"], 5);
    EXPECT_EQ(summary["train_pair_count"], 4);
    EXPECT_EQ(summary["final_test_loss_nat"], result.losses.back().held_out);
    EXPECT_TRUE(summary["test"]["auc"].is_null());
    EXPECT_EQ(summary["test"]["pairs"], 1);
    EXPECT_EQ(summary["configuration"]["learning_rate"], 0.01);
}

TEST(Outputs, the_folder_holds_a_model_that_inference_takes) {
    const support::TemporaryFolder folder;
    const AsPublishedResult result = small_result();
    write_outputs(folder.path(), result, summary_of(result, identity(), "data"));
    for (const char* name :
         {"losses.csv", "train_test_curve.svg", "summary.json", "predictions.csv", "GraphSAGENet.pth"}) {
        EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
    }
    const prediction::Weights weights =
        prediction::read_weights(folder.path() / "graphsage_as_published.weights");
    const prediction::DissertationNet net(Convolution::sage, weights, as_published_schema(2));
    EXPECT_EQ(net.dimensions(), (prediction::NetDimensions{2, 10, 5}));
    EXPECT_THAT(weights.notes,
                ElementsAre("trained by clearway links train graphsage_as_published, seed 1, data abc"));
}

TEST(Outputs, files_of_one_content_are_named) {
    EXPECT_NO_THROW(require_distinct({"a.samples", "b.samples"}, {"1", "2"}));
    try {
        require_distinct({"d/a.samples", "d/b.samples", "d/c.samples"}, {"1", "2", "1"});
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("d/c.samples: holds the same as a.samples"));
    }
}

TEST(Outputs, too_few_pairs_are_told_with_their_file) {
    const samples::PairDataset one{2, {0, 0, 1, 0}, {0}, {1}, {1}};
    try {
        train_as_published(one, PairChoice::true_only, {}, {}, "data");
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("data/target_y.csv: 1 true pair (allowed: 5 or more)"));
    }
}

class OutputFolderTest : public testing::Test {
  protected:
    static Identity identity(double learning_rate = 0.01) {
        return {{"mode", "corrected"},
                {"data_hash", "abc"},
                {"configuration", {{"epochs", 3}, {"learning_rate", learning_rate}}}};
    }
    void write_summary(const Identity& of, const char* outcome) const {
        Identity summary = of;
        summary["outcome"] = outcome;
        folder_.write("summary.json", summary.dump());
    }
    std::string refusal(const Identity& of) const {
        try {
            const OutputFolder folder(folder_.path(), of);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "accepted";
    }

    support::TemporaryFolder folder_;
};

TEST_F(OutputFolderTest, takes_the_same_training_again_and_refuses_another) {
    EXPECT_EQ(refusal(identity()), "accepted");
    write_summary(identity(), "finished");
    EXPECT_EQ(refusal(identity()), "accepted");
    EXPECT_THAT(refusal(identity(0.5)),
                testing::AllOf(HasSubstr("summary.json: was made with learning_rate = 0.01"),
                               HasSubstr("learning_rate = 0.5, as this training has"), HasSubstr("--out")));
    Identity other_data = identity();
    other_data["data_hash"] = "def";
    EXPECT_THAT(refusal(other_data), HasSubstr("data_hash = \"abc\""));
    const Identity other_mode = {{"mode", "logistic"}, {"data_hash", "abc"}, {"configuration", {}}};
    EXPECT_THAT(refusal(other_mode), HasSubstr("mode = \"corrected\""));
}

TEST_F(OutputFolderTest, refuses_a_folder_whose_training_cannot_be_told) {
    folder_.write("summary.json", "{");
    EXPECT_THAT(refusal(identity()), HasSubstr("summary.json"));
    folder_.write("summary.json", "[1]");
    EXPECT_THAT(refusal(identity()), HasSubstr("mode = null"));
}

TEST_F(OutputFolderTest, refuses_a_folder_of_somebody_else_and_leaves_it) {
    folder_.write("metrics.csv", "mine");
    folder_.write("mine.2147483647.clearway-part", "half");
    EXPECT_THAT(refusal(identity()),
                HasSubstr("holds something else (allowed: a new or empty folder, or one of "
                          "clearway links train)"));
    EXPECT_EQ(core::read_file(folder_.path() / "metrics.csv"), "mine");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(OutputFolderTest, takes_a_folder_again_in_which_it_was_killed) {
    EXPECT_EQ(refusal(identity()), "accepted");
    folder_.write("losses.csv", "without a summary");
    EXPECT_EQ(refusal(identity()), "accepted");
}

TEST_F(OutputFolderTest, refuses_the_checkpoint_of_another_training) {
    Identity graphsage = identity();
    graphsage["mode"] = "graphsage";
    folder_.write("checkpoint.json", graphsage.dump());
    EXPECT_EQ(refusal(graphsage), "accepted");
    EXPECT_THAT(refusal(identity()), HasSubstr("checkpoint.json: was made with mode = \"graphsage\""));
}

TEST_F(OutputFolderTest, keeps_what_an_interruption_would_lose) {
    EXPECT_TRUE(OutputFolder(folder_.path(), identity()).keeps_earlier(Outcome::interrupted, 0));
    EXPECT_FALSE(OutputFolder(folder_.path(), identity()).keeps_earlier(Outcome::interrupted, 2));
    write_summary(identity(), "interrupted");
    EXPECT_FALSE(OutputFolder(folder_.path(), identity()).keeps_earlier(Outcome::interrupted, 2));
    write_summary(identity(), "finished");
    EXPECT_TRUE(OutputFolder(folder_.path(), identity()).keeps_earlier(Outcome::interrupted, 2));
    EXPECT_FALSE(OutputFolder(folder_.path(), identity()).keeps_earlier(Outcome::finished, 3));
}

TEST(Outputs, without_good_parameters_there_is_no_model) {
    const support::TemporaryFolder folder;
    AsPublishedResult result = small_result();
    result.state.clear();
    result.outcome = Outcome::diverged;
    write_outputs(folder.path(), result, summary_of(result, identity(), "data"));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "losses.csv"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "GraphSAGENet.pth"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "graphsage_as_published.weights"));
}

TEST(Outputs, metrics_of_groups_have_a_column_for_every_figure) {
    GroupQuality group{"merge", "B10", {}, metrics::LinkQuality{}};
    group.model.pairs = 7;
    group.model.ap = 0.5;
    group.reference->auc = 0.75;
    GroupQuality of_fields = group;
    of_fields.failure = "B10,dark_share=0.5";
    of_fields.reference = std::nullopt;
    EXPECT_EQ(metrics_csv({group, of_fields}, "gcn", "dead_reckoning"),
              "scenario,failure,predictor,pairs,true_links,auc,ap,f1,log_loss_nat,ece,threshold\n"
              "merge,B10,gcn,7,0,,0.5,,,,0.5\n"
              "merge,B10,dead_reckoning,0,0,0.75,,,,,0.5\n"
              "merge,\"B10,dark_share=0.5\",gcn,7,0,,0.5,,,,0.5\n");
}

}  // namespace
}  // namespace clearway::training
