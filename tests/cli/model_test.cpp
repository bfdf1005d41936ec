// A net of one's own, from the command line: of `clearway links train` and of Python, in every verb that
// takes one.
#include <filesystem>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "user.hpp"

namespace clearway::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ModelTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
        const core::Exit exit =
            core::run({"/usr/bin/python3",
                       {CLEARWAY_SOURCE_DIR "/tests/prediction/write_pth.py", folder().string()},
                       {},
                       folder() / "python.txt"});
        ASSERT_TRUE(exit.ok()) << read("python.txt");
        write("my.toml",
              "name = \"mine\"\nreplications = 1\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n" +
                  condition("rule", "route_rule") + condition("published", "graphsage_as_published"));
    }
    static std::string condition(const std::string& name, const std::string& predictor) {
        return "[[condition]]\nname = \"" + name +
               "\"\nfailure = \"B10\"\npolicy = [\"dissertation\"]\npredictor = \"" + predictor + "\"\n";
    }
    /// Words of a run that draws on a net.
    static std::vector<std::string> run(const std::string& predictor, const std::string& model,
                                        const std::string& out) {
        return {"run",          "line",      "--seeds", "1",           "--policy",
                "dissertation", "--failure", "B10",     "--predictor", predictor,
                "--model",      model,       "--out",   out,           "--record"};
    }
    void expect_refused(std::vector<std::string> words, const std::string& message) const {
        words.insert(words.end(), {"--out", "out"});
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(message));
        EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    }
    nlohmann::json model_of(const std::string& run_folder, const std::string& name) const {
        const auto manifest = nlohmann::json::parse(read(run_folder + "/manifest.json"));
        for (const auto& one : manifest.at("conditions")) {
            if (one.at("name") == name) return one.contains("model") ? one.at("model") : nlohmann::json();
        }
        ADD_FAILURE() << "no condition " << name;
        return {};
    }
};

TEST_F(ModelTest, a_net_drives_run_replay_and_links_from_either_file) {
    if (!has_trainer()) GTEST_SKIP() << "clearway-train is not built, or libtorch is not installed";
    ASSERT_EQ(clearway({"links", "dataset", "line", "--out", "data"}).code, 0);
    const Ended trained = clearway({"links", "train", "graphsage_as_published", "--data", "data", "--out",
                                    "m", "--epochs", "30", "--quiet"});
    ASSERT_EQ(trained.code, 0) << trained.err;
    for (const auto& [file, out] : {std::pair("m/GraphSAGENet.pth", "by_pth"),
                                    std::pair("m/graphsage_as_published.weights", "by_weights")}) {
        const Ended ended = clearway(run("graphsage_as_published", file, out));
        ASSERT_EQ(ended.code, 0) << ended.err;
    }
    // The files hold the same numbers, so both runs are the same to the bit.
    const auto figures = [&](const std::string& out) {
        const std::string runs = read(out + "/runs.csv");
        const std::size_t line = runs.find("\nline,dissertation");
        EXPECT_NE(line, std::string::npos) << runs;
        const std::size_t comma = runs.find(",0,ok", line);
        return runs.substr(comma, runs.find('\n', comma) - comma);
    };
    EXPECT_EQ(figures("by_pth"), figures("by_weights"));
    std::string recording;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder() / "by_pth" / "recordings")) {
        if (entry.path().extension() == ".h5") recording = entry.path().string();
    }
    const Ended same = clearway({"replay", recording, "--json"});
    ASSERT_EQ(same.code, 0) << same.err;
    const auto beliefs = nlohmann::json::parse(same.out).at("same_to_the_bit").at("beliefs");
    EXPECT_EQ(beliefs.at("same"), beliefs.at("compared"));
    const Ended other = clearway({"replay", recording, "--predictor", "gat", "--model", "gat.pth"});
    EXPECT_EQ(other.code, 0) << other.err;
    const Ended links =
        clearway({"links", "evaluate", "line", "--failure", "B10", "--seeds", "1", "--predictor",
                  "graphsage_as_published", "gcn", "--model", "graphsage_as_published=m/GraphSAGENet.pth",
                  "--model", "gcn=gcn.pth", "--out", "links"});
    EXPECT_EQ(links.code, 0) << links.err;
}

TEST_F(ModelTest, a_study_gives_a_net_to_the_conditions_whose_predictor_it_is_of) {
    const Ended ended = clearway({"study", "my.toml", "--model", "good.pth"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(model_of("runs/mine", "published").at("file"), testing::EndsWith("/good.pth"));
    EXPECT_EQ(model_of("runs/mine", "published").at("hash").get<std::string>().size(), 32U);
    EXPECT_TRUE(model_of("runs/mine", "rule").is_null());
    EXPECT_TRUE(model_of("runs/mine", "baseline").is_null());
}

TEST_F(ModelTest, a_submission_passes_a_net_on_to_its_shards) {
    const Ended ended = clearway({"study", "submit", "my.toml", "--model", "good.pth", "--shards", "1",
                                  "--out", "sub", "--engine", "local", "--go"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const std::string net = std::filesystem::absolute(folder() / "good.pth").lexically_normal().string();
    EXPECT_THAT(read("sub/shard.sh"), HasSubstr("--model graphsage_as_published=" + net));
    EXPECT_EQ(model_of("sub/merged", "published").at("file"), net);
    EXPECT_TRUE(model_of("sub/merged", "rule").is_null());
    expect_refused({"study", "submit", "my.toml", "--model", "none.pth"}, "--model: none.pth is not a file");
}

TEST_F(ModelTest, a_study_refuses_a_net_that_no_condition_or_more_than_one_would_take) {
    const auto refused = [&](const std::vector<std::string>& models, const std::string& message) {
        std::vector<std::string> words = {"study", "my.toml"};
        for (const std::string& model : models)
            words.insert(words.end(), {"--model", model});
        expect_refused(words, message);
    };
    refused({"none.pth"}, "--model: none.pth is not a file");
    refused({"gcn.pth"}, "--model: predictor graphsage_as_published: gcn.pth: is not a state dict of");
    refused({"gcn=gcn.pth"}, "no condition has the predictor gcn (allowed: graphsage_as_published)");
    refused({"good.pth", "two_features.pth"}, "condition published has the model");
    const std::string file = read("my.toml");
    write("my.toml", file + condition("corrected", "graphsage_corrected"));
    refused({"good.pth"},
            "good.pth is a model of graphsage_as_published, graphsage_corrected (allowed: one "
            "predictor of the conditions). Say which: --model graphsage_as_published=good.pth");
    EXPECT_EQ(clearway({"study", "my.toml", "--model", "graphsage_corrected=good.pth", "--dry-run"}).code, 0);
    write("my.toml", file + "model = \"good.pth\"\n");
    refused({"two_features.pth"}, "condition published has the model");
    write("my.toml", "replications = 1\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n");
    refused({"good.pth"}, "no condition has a predictor that takes a model (none)");
}

TEST_F(ModelTest, unfit_files_are_refused_before_anything_runs) {
    for (const auto& [file, message] : {std::pair("text", "is no zip archive"),
                                        {"three_features", "takes 3 features of a vehicle"},
                                        {"attack", "posix.system, which no state dict needs"},
                                        {"not_a_number", "holds nan"},
                                        {"missing_key", "it lacks fc2.bias"},
                                        {"gcn", "is not a state dict of the dissertation's GraphSAGENet"}}) {
        const std::string pth = std::string(file) + ".pth";
        std::vector<std::string> words = run("graphsage_as_published", pth, "");
        words.erase(words.end() - 3, words.end());
        expect_refused(words, message);
        expect_refused({"links", "evaluate", "line", "--predictor", "graphsage_as_published", "--model",
                        "graphsage_as_published=" + pth},
                       message);
        expect_refused({"study", "my.toml", "--model", pth}, message);
        expect_refused({"attach", "localhost:1", "--predictor", "graphsage_as_published", "--model", pth},
                       message);
    }
    EXPECT_FALSE(std::filesystem::exists(folder() / "was_run"));
    write("cut.pth", read("good.pth").substr(0, 3000));
    std::vector<std::string> words = run("graphsage_as_published", "cut.pth", "");
    words.erase(words.end() - 3, words.end());
    expect_refused(words, "cut.pth: is cut off");
}

}  // namespace
}  // namespace clearway::cli
