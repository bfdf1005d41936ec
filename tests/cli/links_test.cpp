// Judging predictors, from the command line to the files.
#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

class LinksTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario("human = 5\nautomated = 3", "human = 20\nautomated = 20");
    }
    static std::vector<std::string> evaluate(std::vector<std::string> more) {
        std::vector<std::string> words = {"links", "evaluate", "line", "--seeds", "2", "--validation-seeds",
                                          "1",     "--out",    "out"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    /// The one file of finished work below `out` that ends so.
    std::vector<std::filesystem::path> files(const std::string& ending) const {
        std::vector<std::filesystem::path> found;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder() / "out")) {
            if (entry.path().string().ends_with(ending)) found.push_back(entry.path());
        }
        std::ranges::sort(found);
        return found;
    }
};

TEST_F(LinksTest, judges_predictors_and_does_no_run_twice) {
    const std::vector<std::string> words =
        evaluate({"--failure", "B10", "perfect", "--predictor", "last_seen", "dead_reckoning", "--json"});
    const Ended ended = clearway(words);
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("3/3"));
    const auto judged = nlohmann::json::parse(ended.out);
    ASSERT_EQ(judged.at("results").size(), 8U);  // predictors x failures x exits
    for (const auto& result : judged.at("results")) {
        EXPECT_GT(result.at("all_true_links").get<int>(), 0);
        if (result.at("failure") == "perfect") {
            EXPECT_EQ(result.at("pairs"), 0);
            EXPECT_TRUE(result.at("ap").is_null());
            EXPECT_DOUBLE_EQ(result.at("end_to_end_f1"), 1.0);
        } else {
            for (const char* const measure :
                 {"ap", "auc", "f1", "log_loss", "ece", "policy_recall", "brier", "ap_failed", "f1_failed",
                  "candidate_recall", "candidate_recall_seen", "dark_believed"})
                EXPECT_TRUE(result.at(measure).is_number()) << measure;
            EXPECT_TRUE(result.at("ap_low_95").is_null()) << "of two runs";
            EXPECT_GT(result.at("end_to_end_recall"), 0.5);
        }
    }
    std::vector<std::string> published = words;
    published.insert(published.end(),
                     {"--publish", "rows.csv", "--tree", "abc1234", "--behaviour", "0123456789ab"});
    ASSERT_EQ(clearway(published).code, 0);
    EXPECT_THAT(read("rows.csv"),
                AllOf(HasSubstr("links evaluate line"), HasSubstr(",\"line, B10\",last_seen,ap,,"),
                      HasSubstr(",\"line, perfect, exits unknown\",dead_reckoning,end_to_end_f1,,1.000,")));
    EXPECT_EQ(judged.at("against"), "dead_reckoning");
    EXPECT_EQ(judged.at("gains").size(), 4U);
    EXPECT_EQ(read("out/evaluation.json"), ended.out);
    EXPECT_THAT(read("out/evaluation.csv"), HasSubstr("line,B10,known,last_seen,"));
    EXPECT_EQ(files(".links").size(), 6U);

    const auto before = std::filesystem::last_write_time(files(".links").front());
    const Ended again = clearway(words);
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_THAT(again.err, Not(HasSubstr("3/3")));
    EXPECT_EQ(std::filesystem::last_write_time(files(".links").front()), before);
    EXPECT_EQ(nlohmann::json::parse(again.out), judged);
}

TEST_F(LinksTest, of_a_folder_of_somebody_else_are_not_judged) {
    std::filesystem::create_directory(folder() / "out");
    for (const char* const file : {"out/evaluation.csv", "out/evaluation.json"})
        write(file, "mine");
    const Ended ended = clearway(evaluate({"--failure", "B10", "--predictor", "last_seen"}));
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err,
                HasSubstr("--out: out holds something else (allowed: a new or empty folder, or one of "
                          "clearway links evaluate)"));
    EXPECT_EQ(read("out/evaluation.csv"), "mine");
    EXPECT_EQ(read("out/evaluation.json"), "mine");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder() / "out"), {}), 2);
}

TEST_F(LinksTest, one_and_two_jobs_give_the_same_files) {
    const auto run = [&](const char* jobs, const char* out) {
        return clearway({"links", "evaluate", "line", "--seeds", "2", "--validation-seeds", "2", "--failure",
                         "B5", "--exits", "known", "--predictor", "dead_reckoning", "--jobs", jobs, "--out",
                         out});
    };
    ASSERT_EQ(run("1", "one").code, 0);
    ASSERT_EQ(run("2", "two").code, 0);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder() / "one" / "runs")) {
        if (entry.path().extension() != ".links") continue;
        const auto relative = std::filesystem::relative(entry.path(), folder() / "one");
        EXPECT_EQ(core::read_file(entry.path()), core::read_file(folder() / "two" / relative)) << relative;
    }
}

TEST_F(LinksTest, prints_tables_of_the_split_that_is_asked_for) {
    const Ended test = clearway(evaluate({"--failure", "B10", "--predictor", "last_seen"}));
    ASSERT_EQ(test.code, 0) << test.err;
    EXPECT_THAT(test.out, AllOf(HasSubstr("line: test seeds"), HasSubstr("replications 0 to 1"),
                                HasSubstr("Links, exits unknown"), HasSubstr("B10")));
    const Ended validation =
        clearway(evaluate({"--failure", "B10", "--predictor", "last_seen", "--split", "validation"}));
    EXPECT_THAT(validation.out, AllOf(HasSubstr("validation seeds"), HasSubstr("replications 1000 to 1000")));
}

TEST_F(LinksTest, names_the_damaged_file_of_a_run_and_goes_on_once_it_is_gone) {
    const std::vector<std::string> words = evaluate({"--failure", "B10", "--predictor", "none"});
    ASSERT_EQ(clearway(words).code, 0);
    const std::filesystem::path damaged = files(".links").front();
    std::string bytes = core::read_file(damaged);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
    core::write_atomically(damaged, bytes);
    const Ended refused = clearway(words);
    EXPECT_EQ(refused.code, 3);
    EXPECT_THAT(refused.err,
                AllOf(HasSubstr(damaged.filename().string()), HasSubstr("damaged"), HasSubstr("Remove it")));
    std::filesystem::remove(damaged);
    EXPECT_EQ(clearway(words).code, 0);
    std::filesystem::path times = damaged;
    times.replace_extension(".timing.json");
    core::write_atomically(times, "{");
    EXPECT_THAT(clearway(words).err, AllOf(HasSubstr(times.filename().string()), HasSubstr("Remove it")));
    std::filesystem::remove(times);
    EXPECT_EQ(clearway(words).code, 0) << "the run is made again";
}

TEST_F(LinksTest, settings_reach_the_predictor_and_make_runs_of_their_own) {
    const auto figure = [&](const char* name, const std::vector<std::string>& more) {
        std::vector<std::string> words = {"--failure",      "B10",   "--exits", "known", "--predictor",
                                          "dead_reckoning", "--json"};
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = clearway(evaluate(words));
        EXPECT_EQ(ended.code, 0) << ended.err;
        return nlohmann::json::parse(ended.out).at("results").at(0).at(name).get<double>();
    };
    EXPECT_GT(figure("end_to_end_recall", {"--set", "dead_reckoning.link_threshold=0.001"}),
              figure("end_to_end_recall", {}));
    EXPECT_EQ(files(".links").size(), 6U);
    EXPECT_NE(figure("log_loss", {"--set", "dead_reckoning.speed_change_mps=20"}), figure("log_loss", {}));
    EXPECT_EQ(files(".links").size(), 9U);
}

TEST_F(LinksTest, unknown_names_are_told_with_the_nearest_before_anything_runs) {
    const Ended ended = clearway(evaluate({"--failure", "B11", "--predictor", "last_sen", "none", "--against",
                                           "kalmann", "--set", "none.link_treshold=1"}));
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("`B11`"), HasSubstr("Did you mean 'last_seen'?"),
                                 HasSubstr("kalmann"), HasSubstr("Did you mean 'link_threshold'?")));
    EXPECT_THAT(ended.out, IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    EXPECT_EQ(clearway({"links", "evaluate", "lime"}).code, 3);
    EXPECT_EQ(clearway({"links", "evaluate", "--benchmark", "eval_v0"}).code, 3);
    EXPECT_EQ(clearway({"links", "evaluate", "bologna", "--benchmark", "eval_v1"}).code, 3);
}

TEST_F(LinksTest, a_predictor_that_knows_the_truth_is_not_judged) {
    const Ended ended = clearway(evaluate({"--failure", "B10", "--predictor", "oracle", "last_seen"}));
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("--predictor oracle"), HasSubstr("knows the truth"),
                                 HasSubstr("Evaluate another predictor")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

TEST_F(LinksTest, values_out_of_range_and_words_that_are_no_assignment_are_refused) {
    const auto message = [&](const std::vector<std::string>& more) {
        const Ended ended = clearway(evaluate(more));
        EXPECT_EQ(ended.code, 3) << ended.err;
        return ended.err;
    };
    EXPECT_THAT(message({"--set", "link_threshold=2"}),
                AllOf(HasSubstr("2 is out of range"), HasSubstr("0 to 1")));
    EXPECT_THAT(message({"--set", "link_threshold=high"}), HasSubstr("`high` is not a number"));
    EXPECT_THAT(message({"--set", "link_threshold"}), HasSubstr("NAME=VALUE"));
    EXPECT_THAT(message({"--predictor", "none", "--set", "last_seen.link_threshold=0.5"}),
                HasSubstr("last_seen"));
    EXPECT_THAT(message({"--model", "good.pth"}), HasSubstr("PREDICTOR=FILE"));
    EXPECT_THAT(message({"--model", "graphsage_corrected=none.weights"}), HasSubstr("none.weights"));
    core::write_atomically(folder() / "text.weights", "no weights\n");
    EXPECT_THAT(message({"--model", "graphsage=text.weights"}), HasSubstr("text.weights:1"));
    EXPECT_THAT(message({"--model", "kalman=text.weights"}), HasSubstr("takes no model"));
    EXPECT_THAT(message({"--predictor", "kalman", "--set", "kalman.along_psd=-1"}),
                HasSubstr("-1 is out of range"));
    EXPECT_THAT(message({"--predictor", "kalman", "none", "--set", "along_psd=2"}),
                HasSubstr("--set none along_psd"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    EXPECT_EQ(clearway(evaluate({"--exits", "knwon"})).code, 2);
    EXPECT_EQ(clearway(evaluate({"--split", "train"})).code, 2);
    EXPECT_EQ(clearway({"links", "evaluate", "--benchmark", "eval_v1", "--density", "2"}).code, 2);
    EXPECT_EQ(clearway({"links", "evaluate", "--benchmark", "eval_v1", "--seeds", "2"}).code, 2);
    EXPECT_EQ(clearway({"links"}).code, 2);
    EXPECT_THAT(clearway({"links", "evaluate", "line", "--predicto", "none"}).err,
                AllOf(HasSubstr("clearway links evaluate"), HasSubstr("Did you mean '--predictor'?")));
}

TEST_F(LinksTest, radii_for_which_a_model_was_not_trained_are_refused_before_anything_runs) {
    const Ended ended =
        clearway(evaluate({"--link-radius", "20", "--predictor", "none", "gcn", "graphsage"}));
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("--link-radius with predictor gcn: links below 20 m (allowed: 50 m"),
                      HasSubstr("--link-radius with predictor graphsage"), HasSubstr("25 to 300 m"),
                      HasSubstr("car_following")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    core::write_atomically(folder() / "a.weights", "no weights\n");
    EXPECT_THAT(clearway(evaluate({"--predictor", "gcn", "--model", "gcn=a.weights", "gcn=b.weights"})).err,
                HasSubstr("a.weights and b.weights (allowed: one file)"));
    EXPECT_THAT(clearway(evaluate({"--predictor", "none", "--set", "gcn.link_threshold=1"})).err,
                HasSubstr("`gcn` is not among the predictors to evaluate"));
}

TEST_F(LinksTest, the_widest_radius_works_and_predictors_not_made_for_it_are_left_out_by_name) {
    const Ended ended = clearway(evaluate({"--link-radius", "1000", "--failure", "B10", "--json"}));
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("not trained for links below 1000 m: logistic, gradient_boosting"));
    EXPECT_THAT(ended.out, AllOf(HasSubstr("car_following"), Not(HasSubstr("graphsage"))));
}

TEST_F(LinksTest, seeds_must_suffice_and_not_overlap) {
    const auto message = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"links", "evaluate", "line", "--out", "out"};
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3) << ended.err;
        return ended.err;
    };
    EXPECT_THAT(message({"--seeds", "0"}), HasSubstr("no seeds to test on"));
    EXPECT_THAT(message({"--validation-seeds", "0"}), HasSubstr("no seeds to validate on"));
    EXPECT_THAT(message({"--seeds", "5", "--first-validation-seed", "4"}), HasSubstr("overlap"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

TEST_F(LinksTest, a_benchmark_states_variants_a_policy_and_comparisons) {
    const auto benchmark = [](const std::string& hash) {
        std::string text =
            "name = \"mine\"\nfailures = [\"B10\"]\nexits = [\"known\", \"unknown\"]\n"
            "predictors = [\"dead_reckoning\", \"none\"]\n"
            "comparisons = [[\"dead_reckoning\", \"none\"]]\n"
            "[seeds]\nstudy_seed = 3\ntest = { first = 0, count = 3 }\n"
            "validation = { first = 100, count = 1 }\n";
        for (const char* const more : {"", "label = \"line_corridor\"\npolicy = \"corridor\"\n"})
            text += fmt::format("[[scenario]]\nname = \"line\"\n{}configuration = \"{}\"\n", more, hash);
        return text;
    };
    const auto evaluated = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"links", "evaluate", "--benchmark", "mine.toml", "--out", "mine"};
        words.insert(words.end(), more.begin(), more.end());
        return clearway(words);
    };
    write("mine.toml", benchmark("?"));
    const Ended refused = evaluated({});
    EXPECT_EQ(refused.code, 3);
    const std::string before = "has the hash ";
    ASSERT_THAT(refused.err, HasSubstr(before));
    write("mine.toml", benchmark(refused.err.substr(refused.err.find(before) + before.size(), 32)));

    const Ended whole = evaluated({"--json"});
    ASSERT_EQ(whole.code, 0) << whole.err;
    const auto judged = nlohmann::json::parse(whole.out);
    EXPECT_TRUE(judged.at("confirmatory").get<bool>());
    ASSERT_EQ(judged.at("comparisons").size(), 2U) << "one pair, exits known and unknown";
    EXPECT_TRUE(judged.at("comparisons").at(0).at("ap_p_holm").is_number());
    std::map<std::string, int> links;
    for (const auto& result : judged.at("results")) {
        if (result.at("scenario").is_string() && result.at("exits") == "known" &&
            result.at("predictor") == "none")
            links[result.at("scenario")] = result.at("all_true_links");
    }
    ASSERT_EQ(links.size(), 2U);
    EXPECT_NE(links.at("line"), links.at("line_corridor")) << "the policy changes the traffic";

    EXPECT_THAT(evaluated({}).out, HasSubstr("(confirmatory)"));
    EXPECT_THAT(evaluated({"--exits", "known"}).out, HasSubstr("(exploratory: a part of the benchmark)"));
    EXPECT_THAT(evaluated({"line_corridor", "--exits", "known"}).out, HasSubstr("mine (a part of it)"));
    EXPECT_EQ(evaluated({"line_coridor"}).code, 3);
}

TEST_F(LinksTest, a_folder_that_cannot_be_made_is_the_environments_fault) {
    write("plain.txt", "");
    const Ended ended = clearway({"links", "evaluate", "line", "--out", "plain.txt/out"});
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.err, HasSubstr("plain.txt"));
}

}  // namespace
}  // namespace clearway::cli
