// Drives clearway-train as a user would.
#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "core/process.hpp"
#include "prediction/model_file.hpp"
#include "prediction/predictor.hpp"
#include "samples/graph_sample.hpp"
#include "support/temporary_folder.hpp"
#include "synthetic_samples.hpp"

namespace clearway::training {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Ended {
    core::Exit exit;
    std::string output;  ///< Both streams.
};

class TrainProgramTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_.write("edge_list.csv", "0,0,1,1,2,2,3,4\n1,2,2,3,3,4,4,0\n");
        folder_.write("vehicle_features.csv", "0,0\n0.5,0.25\n1,0\n1.5,0.25\n2,1\n");
        folder_.write("target_y.csv", "1,0,1,1,0,1,0,1\n");
    }

    Ended train(std::vector<std::string> arguments) const {
        const std::filesystem::path log = folder_.path() / "output.txt";
        const core::Exit exit = core::run(
            {std::filesystem::path(CLEARWAY_BINARY_DIR) / "bin" / "clearway-train", arguments, {}, log});
        return {exit, core::read_file(log)};
    }
    std::string data() const { return folder_.path(); }
    std::string out() const { return folder_.path() / "out"; }

    support::TemporaryFolder folder_;
};

TEST_F(TrainProgramTest, prints_three_lines_an_epoch_as_published) {
    const Ended ended = train({"graphsage_as_published", "--data", data(), "--out", out()});
    EXPECT_EQ(ended.exit.code, 0) << ended.output;
    EXPECT_THAT(ended.output, testing::ContainsRegex("epoch: 0\n=======\nloss: [0-9.]+ [0-9.]+\nepoch: 1\n"));
    EXPECT_THAT(ended.output, HasSubstr("epoch: 99\n=======\nloss: "));
    EXPECT_THAT(ended.output, testing::Not(HasSubstr("epoch: 100")));
}

TEST_F(TrainProgramTest, quiet_prints_the_closing_figures_only) {
    const Ended ended = train({"graphsage_as_published", "--data", data(), "--out", out(), "--quiet"});
    EXPECT_THAT(ended.output, AllOf(testing::Not(HasSubstr("epoch:")), HasSubstr("test: 1 pairs")));
}

TEST_F(TrainProgramTest, json_is_all_that_is_printed) {
    const Ended ended = train({"graphsage_as_published", "--data", data(), "--out", out(), "--json",
                               "--epochs", "7", "--seed", "3"});
    const auto summary = nlohmann::json::parse(ended.output);
    EXPECT_EQ(summary["epochs_run"], 7);
    EXPECT_EQ(summary["configuration"]["seed"], 3);
    EXPECT_EQ(summary, nlohmann::json::parse(core::read_file(folder_.path() / "out" / "summary.json")));
}

TEST_F(TrainProgramTest, python_computes_the_same_logits_from_the_pth) {
    ASSERT_EQ(train({"graphsage_as_published", "--data", data(), "--out", out(), "--quiet"}).exit.code, 0);
    const std::filesystem::path log = folder_.path() / "python.txt";
    const core::Exit exit =
        core::run({"/usr/bin/python3",
                   {std::string(CLEARWAY_SOURCE_DIR) + "/tests/training/check_pth.py", data(), out()},
                   {},
                   log});
    if (exit.code == 77 || exit.code == 127)
        GTEST_SKIP() << "Python with torch (package python3-torch) is not installed";
    EXPECT_TRUE(exit.ok()) << core::read_file(log);
}

TEST_F(TrainProgramTest, same_seed_same_files) {
    for (const char* name : {"a", "b"}) {
        ASSERT_EQ(
            train({"graphsage_as_published", "--data", data(), "--out", folder_.path() / name, "--quiet"})
                .exit.code,
            0);
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "a")) {
        const auto name = entry.path().filename();
        EXPECT_EQ(core::read_file(entry.path()), core::read_file(folder_.path() / "b" / name)) << name;
    }
}

TEST_F(TrainProgramTest, the_summary_says_what_rounded_the_numbers) {
    const Ended ended = train({"graphsage_as_published", "--data", data(), "--out", out(), "--json"});
    const auto arithmetic = nlohmann::json::parse(ended.output).at("arithmetic");
    EXPECT_THAT(arithmetic.at("torch").get<std::string>(), testing::MatchesRegex("[0-9]+[.][0-9]+.*"));
    EXPECT_THAT(arithmetic.at("torch_kernels").get<std::string>(),
                AllOf(testing::Ne(""), testing::Ne("unknown")));
    EXPECT_THAT(arithmetic.at("blas").get<std::string>(), HasSubstr("blas"));
}

/// The card's command, on the recorded data set. The shipped net was trained with the reference BLAS.
TEST_F(TrainProgramTest, the_shipped_net_as_published_is_trained_again_to_the_bit) {
    const std::filesystem::path source = CLEARWAY_SOURCE_DIR;
    const std::filesystem::path reference = "/usr/lib/x86_64-linux-gnu/blas";
    if (!std::filesystem::exists(reference / "libblas.so.3"))
        GTEST_SKIP() << "the reference BLAS (package libblas3) is not installed";
    const std::filesystem::path log = folder_.path() / "output.txt";
    const core::Exit exit = core::run({std::filesystem::path(CLEARWAY_BINARY_DIR) / "bin" / "clearway-train",
                                       {"graphsage_as_published", "--data",
                                        source / "tests" / "training" / "city-0", "--out", out(), "--quiet"},
                                       {{"LD_LIBRARY_PATH", reference}},
                                       log});
    ASSERT_TRUE(exit.ok()) << core::read_file(log);
    const auto summary = nlohmann::json::parse(core::read_file(folder_.path() / "out" / "summary.json"));
    const auto& arithmetic = summary.at("arithmetic");
    ASSERT_EQ(std::filesystem::path(arithmetic["blas"].get<std::string>()).parent_path(), reference);
    EXPECT_TRUE(arithmetic["blas_kernels"].is_null());
    if (arithmetic["torch_kernels"] != "AVX2" || !arithmetic["torch"].get<std::string>().starts_with("1.13"))
        GTEST_SKIP() << "trained with libtorch 1.13 on a processor with AVX2; here: " << arithmetic;
    EXPECT_EQ(core::read_file(folder_.path() / "out" / "graphsage_as_published.weights"),
              core::read_file(source / "src" / "prediction" / "models" / "graphsage_as_published.weights"));
}

TEST_F(TrainProgramTest, bad_data_exit_with_3_and_name_file_and_line) {
    folder_.write("vehicle_features.csv", "0,0\n0.5,nan\n1\n1.5,0.25\n2,1\n");
    const Ended ended = train({"graphsage_as_published", "--data", data(), "--out", out()});
    EXPECT_EQ(ended.exit.code, 3);
    EXPECT_THAT(ended.output, AllOf(HasSubstr("vehicle_features.csv:2: value 2: `nan`"),
                                    HasSubstr("vehicle_features.csv:3: 1 values")));
}

TEST_F(TrainProgramTest, a_missing_folder_exits_with_3) {
    const Ended ended = train({"graphsage_as_published", "--data", data() + "/none", "--out", out()});
    EXPECT_EQ(ended.exit.code, 3);
    EXPECT_THAT(ended.output, HasSubstr("clearway links dataset"));
}

TEST_F(TrainProgramTest, an_unwritable_out_folder_exits_with_4_before_training) {
    const Ended ended =
        train({"graphsage_as_published", "--data", data(), "--out", data() + "/target_y.csv/out"});
    EXPECT_EQ(ended.exit.code, 4);
    EXPECT_THAT(ended.output, AllOf(HasSubstr("target_y.csv/out"), testing::Not(HasSubstr("epoch"))));
}

TEST_F(TrainProgramTest, a_full_disk_exits_with_4) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
    const Ended ended = train({"graphsage_as_published", "--data", data(), "--out", "/dev/full/out"});
    EXPECT_EQ(ended.exit.code, 4);
}

TEST_F(TrainProgramTest, without_a_word_it_lists_the_nets_and_trains_none) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{}, std::vector<std::string>{"--data", data(), "--out", out()}}) {
        const Ended ended = train(words);
        EXPECT_EQ(ended.exit.code, 2);
        EXPECT_THAT(ended.output, AllOf(HasSubstr("recommended"), HasSubstr("graphsage_as_published")));
        EXPECT_LT(ended.output.find("  graphsage "), ended.output.find("  graphsage_as_published "));
        EXPECT_FALSE(std::filesystem::exists(out()));
    }
}

/// One word for each: no learned predictor is trained by an option.
TEST_F(TrainProgramTest, every_learned_predictor_is_a_net_that_can_be_named) {
    const Ended list = train({"--help"});
    EXPECT_EQ(list.exit.code, 0);
    for (const std::string& predictor : prediction::predictors().names(traffic::Trait::learned)) {
        EXPECT_THAT(list.output, HasSubstr("  " + predictor + " "));
        const Ended ended = train({predictor, "--help"});
        EXPECT_EQ(ended.exit.code, 0);
        EXPECT_THAT(ended.output, AllOf(HasSubstr("clearway links train " + predictor), HasSubstr("--data")));
    }
    EXPECT_THAT(train({"--version"}).output, testing::StartsWith("clearway-train "));
}

TEST_F(TrainProgramTest, wrong_usage_exits_with_2) {
    EXPECT_EQ(train({"graphsage_as_published", "--data", data()}).exit.code, 2);
    EXPECT_EQ(train({"graphsage_as_published", "--data", data(), "--out", out(), "--epochs", "-1"}).exit.code,
              2);
    EXPECT_EQ(
        train({"graphsage_as_published", "--data", data(), "--out", out(), "--pairs", "some"}).exit.code, 2);
    EXPECT_EQ(
        train({"graphsage_as_published", "--data", data(), "--out", out(), "--patience", "3"}).exit.code, 2);
    EXPECT_EQ(train({"graphsage_as_published", "--data", data(), "--out", out(), "--unknown"}).exit.code, 2);
}

TEST_F(TrainProgramTest, an_unknown_word_names_the_program_and_the_nearest) {
    EXPECT_THAT(train({"graphsag", "--data", data(), "--out", out()}).output,
                HasSubstr("clearway links train: graphsag is not known here. Did you mean 'graphsage'?"));
    EXPECT_THAT(
        train({"graphsage", "--data", data(), "--out", out(), "--epoch", "3"}).output,
        HasSubstr("clearway links train graphsage: --epoch is not known here. Did you mean '--epochs'?"));
    EXPECT_THAT(
        train({"gradient_boosting", "--data", data(), "--out", out(), "--tree", "3"}).output,
        HasSubstr(
            "clearway links train gradient_boosting: --tree is not known here. Did you mean '--trees'?"));
    EXPECT_THAT(train({"graphsage_as_published", "--data", data()}).output,
                HasSubstr("clearway links train graphsage_as_published: --out is required"));
}

TEST_F(TrainProgramTest, numbers_that_are_not_finite_are_wrong_usage) {
    const std::vector<std::vector<std::string>> calls = {{"graphsage_as_published", "--learning-rate"},
                                                         {"graphsage_corrected", "--validation-share"},
                                                         {"logistic", "--ridge"},
                                                         {"graphsage", "--easy-share"},
                                                         {"gradient_boosting", "--learning-rate"}};
    for (std::vector<std::string> call : calls) {
        const std::string option = call.back();
        call.insert(call.end(), {"nan", "--data", data(), "--out", out()});
        const Ended ended = train(call);
        EXPECT_EQ(ended.exit.code, 2) << option;
        EXPECT_THAT(ended.output, AllOf(HasSubstr(option), HasSubstr("nan is out of range (allowed: ")));
    }
    EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(TrainProgramTest, a_folder_holds_one_training) {
    ASSERT_EQ(train({"graphsage_as_published", "--data", data(), "--out", out(), "--quiet", "--epochs", "3"})
                  .exit.code,
              0);
    const std::string model = core::read_file(out() + "/GraphSAGENet.pth");
    const std::string stray = folder_.write("out/checkpoint.json.2147483647.clearway-part", "{");
    const Ended other =
        train({"graphsage_as_published", "--data", data(), "--out", out(), "--quiet", "--epochs", "4"});
    EXPECT_EQ(other.exit.code, 3);
    EXPECT_THAT(other.output, AllOf(HasSubstr("out/summary.json: was made with epochs = 3"),
                                    HasSubstr("epochs = 4, as this training has"), HasSubstr("--out")));
    EXPECT_EQ(core::read_file(out() + "/GraphSAGENet.pth"), model);
    EXPECT_FALSE(std::filesystem::exists(stray)) << "what a killed writer left";
    EXPECT_EQ(train({"graphsage_as_published", "--data", data(), "--out", out(), "--quiet", "--epochs", "3"})
                  .exit.code,
              0);
}

TEST_F(TrainProgramTest, divergence_exits_with_1_says_so_and_keeps_a_model) {
    const Ended ended = train(
        {"graphsage_as_published", "--data", data(), "--out", out(), "--quiet", "--learning-rate", "1e20"});
    EXPECT_EQ(ended.exit.code, 1);
    EXPECT_THAT(ended.output, HasSubstr("training diverged after 1 good epoch:"));
    EXPECT_TRUE(std::filesystem::exists(out() + "/GraphSAGENet.pth"));
    EXPECT_THAT(core::read_file(out() + "/summary.json"), HasSubstr("\"outcome\": \"diverged\""));
}

TEST_F(TrainProgramTest, corrected_training_reads_sample_files) {
    for (const auto& file : synthetic_files(4, 5)) {
        samples::GraphSampleWriter writer(file.origin);
        for (const auto& sample : file.samples)
            writer.add(sample);
        writer.write(folder_.path() / ("line_B10_" + std::to_string(file.origin.replication) + ".samples"));
    }
    const Ended ended =
        train({"graphsage_corrected", "--data", data(), "--out", out(), "--epochs", "3", "--json"});
    EXPECT_EQ(ended.exit.code, 0) << ended.output;
    const auto summary = nlohmann::json::parse(ended.output);
    EXPECT_EQ(summary["mode"], "graphsage_corrected");
    EXPECT_EQ(summary["seeds"]["test"].size(), 1U);
    EXPECT_EQ(summary["test"][0]["scenario"], "all");
    EXPECT_EQ(summary["test"][1]["failure"], "B10");
    for (const char* name :
         {"graphsage_corrected.weights", "GraphSAGENet.pth", "metrics.csv", "losses.csv"}) {
        EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out" / name)) << name;
    }
}

TEST_F(TrainProgramTest, both_files_of_a_training_are_models_of_its_predictor) {
    for (const auto& file : synthetic_files(4, 5)) {
        samples::GraphSampleWriter writer(file.origin);
        for (const auto& sample : file.samples)
            writer.add(sample);
        writer.write(folder_.path() / ("line_B10_" + std::to_string(file.origin.replication) + ".samples"));
    }
    const auto expect_models = [&](std::vector<std::string> words, const std::string& predictor,
                                   const std::string& pth) {
        const std::string folder = (folder_.path() / predictor).string();
        words.insert(words.end(), {"--data", data(), "--out", folder, "--epochs", "2", "--json"});
        const Ended ended = train(words);
        ASSERT_EQ(ended.exit.code, 0) << ended.output;
        const prediction::Weights text =
            prediction::read_model(predictor, folder + "/" + predictor + ".weights");
        const prediction::Weights state = prediction::read_model(predictor, folder + "/" + pth);
        EXPECT_EQ(state.architecture, text.architecture);
        EXPECT_EQ(state.features, text.features);
        EXPECT_EQ(state.dimensions, text.dimensions);
        ASSERT_EQ(state.tensors.size(), text.tensors.size());
        for (std::size_t at = 0; at < text.tensors.size(); ++at) {
            EXPECT_EQ(state.tensors[at].name, text.tensors[at].name);
            EXPECT_EQ(state.tensors[at].values, text.tensors[at].values) << text.tensors[at].name;
        }
        EXPECT_NO_THROW(prediction::check_model(predictor, folder + "/" + pth));
    };
    expect_models({"graphsage_as_published"}, "graphsage_as_published", "GraphSAGENet.pth");
    expect_models({"graphsage_corrected"}, "graphsage_corrected", "GraphSAGENet.pth");
    expect_models({"gcn"}, "gcn", "gcn.pth");
    expect_models({"gat"}, "gat", "gat.pth");
    const Ended other =
        train({"gat", "--data", data(), "--out", (folder_.path() / "gcn").string(), "--epochs", "2"});
    EXPECT_EQ(other.exit.code, 3);
    EXPECT_THAT(other.output, HasSubstr("was made with mode = \"gcn\""));
}

TEST_F(TrainProgramTest, corrected_training_without_samples_exits_with_3) {
    const Ended ended = train({"graphsage_corrected", "--data", data(), "--out", out()});
    EXPECT_EQ(ended.exit.code, 3);
    EXPECT_THAT(ended.output, HasSubstr("holds no file of graph samples"));
}

TEST_F(TrainProgramTest, help_names_units_defaults_and_an_example) {
    const Ended ended = train({"graphsage_as_published", "--help"});
    EXPECT_EQ(ended.exit.code, 0);
    EXPECT_THAT(ended.output,
                AllOf(HasSubstr("--learning-rate"), HasSubstr("[0.01]"), HasSubstr("[100]"), HasSubstr("nat"),
                      HasSubstr("clearway links train graphsage_as_published")));
}

}  // namespace
}  // namespace clearway::training
