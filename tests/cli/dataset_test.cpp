// Data sets and what trains on them, from the command line to the files.
#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>

#include "user.hpp"

namespace clearway::cli {
namespace {

class DatasetTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
    }
};

TEST_F(DatasetTest, writes_the_three_files_of_the_dissertation) {
    const Ended ended =
        clearway({"links", "dataset", "line", "--out", "data", "--pairs", "true-links", "--features", "2"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, testing::ContainsRegex("\ndata  "));
    std::istringstream target(read("data/target_y.csv"));
    std::string row;
    std::getline(target, row);
    EXPECT_THAT(row, AllOf(HasSubstr("1"), Not(HasSubstr("0"))));  // only true links
    std::istringstream features(read("data/vehicle_features.csv"));
    std::getline(features, row);
    EXPECT_EQ(std::count(row.begin(), row.end(), ','), 1);
    EXPECT_TRUE(std::filesystem::exists(folder() / "data" / "edge_list.csv"));
}

TEST_F(DatasetTest, records_the_features_of_pairs_as_csv) {
    const Ended ended = clearway(
        {"links", "dataset", "line", "--out", "data", "--samples", "--net", "logistic", "--failure", "A.5"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, testing::ContainsRegex("line-A.5-0000.pairs.csv +[0-9]"));
    EXPECT_THAT(read("data/line-A.5-0000.pairs.csv"), testing::HasSubstr("\nmargin,margin_seen,age_older,"));
}

TEST_F(DatasetTest, records_samples_of_each_failure_and_replication) {
    const Ended ended =
        clearway({"links", "dataset", "line", "--out", "data", "--samples", "--failure", "B10", "A.5",
                  "--seeds", "2", "--first-seed", "5", "--interval", "2", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(nlohmann::json::parse(ended.out).at("files").size(), 4U);
    for (const char* const file : {"line-B10-0005.samples", "line-A.5-0006.samples"}) {
        EXPECT_TRUE(std::filesystem::exists(folder() / "data" / file)) << file;
    }
    EXPECT_THAT(ended.err, HasSubstr("2/2"));
}

/// A library that meets a failure of the machine, and goes on without it, says so on the worker's streams.
TEST_F(DatasetTest, takes_nothing_else_that_a_worker_says_for_a_file) {
    const std::filesystem::path programs = std::filesystem::path(CLEARWAY_BINARY_DIR) / "bin";
    std::filesystem::copy(programs / "clearway", folder());
    const std::filesystem::path worker = write(
        "clearway-run",
        "#!/bin/sh\n[ \"$1\" = --serve ] && exit\n[ \"$1\" = --version ] || echo 'Warning: beside'\nexec " +
            (programs / "clearway-run").string() + " \"$@\"\n");
    std::filesystem::permissions(worker, std::filesystem::perms::owner_all);
    const core::Exit exit =
        core::run({folder() / "clearway",
                   {"links", "dataset", (folder() / "line").string(), "--out", (folder() / "data").string()},
                   {},
                   folder() / "said.txt"});
    EXPECT_EQ(exit.code, 0);
    EXPECT_THAT(read("said.txt"), AllOf(HasSubstr("vehicles"), Not(HasSubstr("beside"))));
}

TEST_F(DatasetTest, records_traffic_under_policies_beside_passive_traffic) {
    const std::vector<std::string> passive = {"links",      "dataset",   "line",      "--out",
                                              "data",       "--samples", "--failure", "report_interval_s=1",
                                              "--interval", "1"};
    std::vector<std::string> under = passive;
    under.insert(under.end(),
                 {"--policy", "clear_lane", "red_privilege", "--set", "red_privilege.near_m=90"});
    ASSERT_EQ(clearway(passive).code, 0);
    const Ended ended = clearway(under);
    ASSERT_EQ(ended.code, 0) << ended.err;
    const std::string name = "data/line-report_interval_s=1";
    const std::string told = read(name + "-under-clear_lane+red_privilege-0000.samples");
    EXPECT_THAT(told, HasSubstr("\"traffic\":\"under clear_lane+red_privilege, red_privilege.near_m=90\""));
    const std::string untold = read(name + "-0000.samples");
    EXPECT_THAT(untold, Not(HasSubstr("\"traffic\"")));
    EXPECT_NE(told.substr(told.find("}\n")), untold.substr(untold.find("}\n"))) << "the policy acted";
    EXPECT_THAT(read("data/origin/line/jobs/0000-under-clear_lane+red_privilege.json"),
                HasSubstr("red_privilege.near_m"));
    EXPECT_EQ(clearway(passive).code, 0) << "the same again";
    EXPECT_EQ(clearway(under).code, 0) << "the same again";
    under.back() = "red_privilege.near_m=80";
    EXPECT_THAT(clearway(under).err, HasSubstr("already exists, from another recording"));
    EXPECT_EQ(read(name + "-0000.samples"), untold);
}

TEST_F(DatasetTest, records_other_drivers) {
    const Ended ended = clearway({"links", "dataset", "line", "--out", "data", "--samples", "--failure",
                                  "A.5", "--car-following", "krauss", "--driver-spread", "0.2"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(read("data/line-A.5-0000.samples"), HasSubstr("\"traffic\":\"krauss, driver spread 0.2\""));
    EXPECT_THAT(read("data/origin/line/scenario.toml"),
                HasSubstr("[car_following]\nmodel = \"krauss\"\ndriver_spread = 0.2"));
}

TEST_F(DatasetTest, refuses_policies_and_settings_that_do_not_fit) {
    const auto refusal = [&](std::vector<std::string> words) {
        std::vector<std::string> all = {"links", "dataset", "line", "--out", "data", "--samples"};
        all.insert(all.end(), words.begin(), words.end());
        return clearway(all);
    };
    EXPECT_THAT(refusal({"--policy", "corridoor"}).err, HasSubstr("Did you mean 'corridor'?"));
    const Ended lossy = refusal({"--policy", "corridor", "--set", "failure.loss_rate=0.5"});
    EXPECT_EQ(lossy.code, 3);
    EXPECT_THAT(lossy.err, AllOf(HasSubstr("--set failure.loss_rate"), HasSubstr("--failure")));
    EXPECT_EQ(refusal({"--policy", "corridor", "--set", "loop.link_radius_m=80"}).code, 3);
    EXPECT_EQ(refusal({"--policy", "corridor", "--set", "green_wave.near_m=-1"}).code, 3);
    EXPECT_THAT(refusal({"--net", "graphsage", "--link-radius", "10"}).err,
                HasSubstr("--link-radius: 10 m with --net graphsage (allowed: 25 to 300 m"));
    EXPECT_EQ(refusal({"--set", "red_privilege.near_m=90"}).code, 2) << "settings of no policy";
    EXPECT_EQ(clearway({"links", "dataset", "line", "--out", "data", "--policy", "corridor"}).code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder() / "data"));
}

TEST_F(DatasetTest, overwrites_no_other_recording) {
    const std::vector<std::string> first = {"links",  "dataset",   "line",       "--out",
                                            "data",   "--samples", "--failure",  "B10",
                                            "--seed", "7",         "--interval", "5"};
    ASSERT_EQ(clearway(first).code, 0);
    const std::string samples = read("data/line-B10-0000.samples");
    const auto changed = [&](std::size_t at, const std::string& word) {
        std::vector<std::string> words = first;
        words[at] = word;
        return words;
    };
    const auto expect_refusal = [&](const std::vector<std::string>& words, const std::string& file) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3);
        EXPECT_THAT(ended.err, AllOf(HasSubstr(file), HasSubstr("--out")));
        EXPECT_EQ(read("data/line-B10-0000.samples"), samples);
    };
    expect_refusal(changed(9, "8"), "data/line-B10-0000.samples: already exists");
    std::vector<std::string> denser = changed(7, "A.5");
    denser.insert(denser.end(), {"--density", "2"});
    expect_refusal(denser, "data/origin/line/scenario.toml: another configuration of line");
    std::vector<std::string> of_graphsage = first;
    of_graphsage.insert(of_graphsage.end(), {"--net", "graphsage"});
    expect_refusal(of_graphsage, "data/line-B10-0000.samples: already exists");
    EXPECT_EQ(clearway(first).code, 0) << "the same again";
    EXPECT_EQ(clearway(changed(7, "A.5")).code, 0) << "another failure beside it";
    EXPECT_EQ(read("data/line-B10-0000.samples"), samples);
}

TEST_F(DatasetTest, records_into_no_folder_of_others) {
    write("theirs/origin/line/line.edg.xml", "mine");
    const Ended ended =
        clearway({"links", "dataset", "line", "--out", "theirs", "--samples", "--failure", "B10"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("--out: theirs holds something else"));
    EXPECT_EQ(read("theirs/origin/line/line.edg.xml"), "mine");
}

TEST_F(DatasetTest, train_takes_what_dataset_wrote) {
    if (!has_trainer()) GTEST_SKIP() << "clearway-train is not built, or libtorch is not installed";
    ASSERT_EQ(clearway({"links", "dataset", "line", "--out", "data"}).code, 0);
    const Ended ended = clearway({"links", "train", "graphsage_as_published", "--data", "data", "--out",
                                  "model", "--epochs", "3", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(nlohmann::json::parse(ended.out).at("epochs_run"), 3);
    EXPECT_TRUE(std::filesystem::exists(folder() / "model" / "GraphSAGENet.pth"));
}

TEST_F(DatasetTest, both_readings_of_the_list_have_one_name_in_dataset_and_train) {
    if (!has_trainer()) GTEST_SKIP() << "clearway-train is not built, or libtorch is not installed";
    for (const char* const pairs : {"candidates", "true-links"}) {
        ASSERT_EQ(clearway({"links", "dataset", "line", "--out", pairs, "--pairs", pairs}).code, 0);
        const Ended ended =
            clearway({"links", "train", "graphsage_as_published", "--data", "candidates", "--out",
                      std::string("model-") + pairs, "--pairs", pairs, "--epochs", "2", "--json"});
        ASSERT_EQ(ended.code, 0) << ended.err;
        EXPECT_EQ(nlohmann::json::parse(ended.out).at("pairs"), pairs);
    }
}

}  // namespace
}  // namespace clearway::cli
