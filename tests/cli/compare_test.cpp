// `clearway compare`: conditions and folders pair by pair, and rows for pages.
#include <algorithm>
#include <future>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "user.hpp"

namespace clearway::cli {
namespace {

class CompareTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
    }
};

TEST_F(CompareTest, pairs_conditions_and_folders_and_is_a_gate) {
    ASSERT_EQ(clearway(two_conditions("one", 5)).code, 0);
    ASSERT_EQ(clearway(two_conditions("two", 5)).code, 0);
    const Ended within = clearway({"compare", "one"});
    EXPECT_EQ(within.code, 0) << within.err;
    EXPECT_THAT(within.out,
                AllOf(HasSubstr("line: EV travel time"), HasSubstr("\nGraph made by             5 "),
                      HasSubstr("\n  simulation\n  attributes\n"), HasSubstr("p Holm")));
    const Ended same =
        clearway({"compare", "one", "two", "--tolerance", "0", "--tolerance", "collisions=2", "--json"});
    EXPECT_EQ(same.code, 0) << same.err;
    const auto tables = nlohmann::json::parse(same.out);
    ASSERT_EQ(tables.at("comparisons").size(), 2U);
    EXPECT_TRUE(tables.at("differing_settings").empty());
    EXPECT_EQ(tables["comparisons"][0]["metrics"]["emergency_restricted_travel_time_s"]["difference"], 0.0);
    const Ended short_of =
        clearway({"compare", "one", "--metric", "simulated_s", "--tolerance", "collisions=0"});
    EXPECT_EQ(short_of.code, 6);
    EXPECT_THAT(short_of.err, HasSubstr("line/graph_simulation: collisions: its interval reaches to"));
    const Ended chosen = clearway({"compare", "one", "--metric", "collisions", "--tolerance", "0", "--json"});
    EXPECT_EQ(chosen.code, 6) << "the chosen metric is the one that is gated";
    EXPECT_EQ(nlohmann::json::parse(chosen.out)["short_of_tolerance"][0]["metric"], "collisions");
    const Ended unclear =
        clearway({"compare", "one", "--metric", "collisions", "--metric", "teleports", "--tolerance", "0"});
    EXPECT_EQ(unclear.code, 3);
    EXPECT_THAT(unclear.err, HasSubstr("--tolerance collisions=0"));
    std::filesystem::remove_all(folder() / "two/runs/line/graph_simulation/00003");
    const Ended lacks = clearway({"compare", "one", "two", "--tolerance", "100000"});
    EXPECT_EQ(lacks.code, 6) << "a run that is not there cannot pass";
    EXPECT_THAT(lacks.err,
                HasSubstr("graph_simulation: runs: 1 of 5 runs failed or are missing in the second"));
    std::vector<std::string> other = two_conditions("three", 5);
    other.insert(other.end(), {"--seed", "7"});
    ASSERT_EQ(clearway(other).code, 0);
    const Ended refused = clearway({"compare", "one", "three"});
    EXPECT_EQ(refused.code, 3);
    EXPECT_THAT(refused.err, HasSubstr("another seed"));
}

TEST_F(CompareTest, adjusts_by_more_runs_of_the_baseline) {
    write("s.toml",
          "name = \"s\"\nreplications = 5\nscenarios = [\"line\"]\n"
          "conditions = [\"baseline\", \"solo\"]\n[overrides]\ndensity = 4.0\n"
          "[[condition]]\nname = \"room\"\npolicy = [\"clear_lane\"]\n"
          "[[condition]]\nname = \"idle\"\npolicy = [\"line_of_sight\"]\n");
    ASSERT_EQ(clearway({"study", "s.toml"}).code, 0);
    const Ended more = clearway({"study", "s.toml", "--baselines", "9", "--reuse", "runs/s"});
    ASSERT_EQ(more.code, 0) << more.err;
    const Ended shown = clearway({"compare", "runs/s", "--baselines", "runs/s-baselines"});
    EXPECT_EQ(shown.code, 0) << shown.err;
    EXPECT_THAT(shown.out, AllOf(HasSubstr("line: room: "), HasSubstr("adjusted by 9 runs of the"),
                                 HasSubstr("line: idle: not adjusted: ")));
    const auto tables = nlohmann::json::parse(
        clearway({"compare", "runs/s", "--baselines", "runs/s-baselines", "--json"}).out);
    ASSERT_EQ(tables.at("adjusted").size(), 2U);
    EXPECT_TRUE(tables["adjusted"][1]["difference"].is_null());
    EXPECT_EQ(tables["adjusted"][0]["condition"], "room");
    EXPECT_EQ(tables["adjusted"][0]["baselines"], 9);
    EXPECT_FALSE(nlohmann::json::parse(clearway({"compare", "runs/s", "--json"}).out).contains("adjusted"));
    const Ended both = clearway({"compare", "runs/s", "runs/s", "--baselines", "runs/s-baselines"});
    EXPECT_EQ(both.code, 3);
    EXPECT_THAT(both.err, HasSubstr("and there is runs/s"));
    EXPECT_THAT(clearway({"compare", "runs/s", "--against", "room", "--baselines", "runs/s-baselines"}).err,
                HasSubstr("and there is room"));
}

TEST_F(CompareTest, compares_with_a_condition_that_is_named) {
    ASSERT_EQ(clearway(two_conditions("one", 5)).code, 0);
    const auto tables =
        nlohmann::json::parse(clearway({"compare", "one", "--against", "graph_simulation", "--json"}).out);
    const auto usual = nlohmann::json::parse(clearway({"compare", "one", "--json"}).out);
    ASSERT_EQ(tables.at("comparisons").size(), 1U);
    const auto& pair = tables["comparisons"][0];
    EXPECT_EQ(pair["condition"], "baseline");
    EXPECT_EQ(pair["compared_with"], "graph_simulation");
    const char* const metric = "emergency_travel_time_s";
    EXPECT_DOUBLE_EQ(pair["metrics"][metric]["difference"].get<double>(),
                     -usual["comparisons"][0]["metrics"][metric]["difference"].get<double>());
    EXPECT_THAT(clearway({"compare", "one", "--against", "graph_simulation"}).out,
                HasSubstr("diff.: minus Graph made by simulation attributes, paired"));
    EXPECT_EQ(clearway({"compare", "one", "--against", "Graph made by simulation attributes"}).out,
              clearway({"compare", "one", "--against", "graph_simulation"}).out)
        << "by the title that tables show";
    const Ended unknown = clearway({"compare", "one", "--against", "graph_simulatoin"});
    EXPECT_EQ(unknown.code, 3);
    EXPECT_THAT(unknown.err, HasSubstr("Did you mean 'graph_simulation'?"));
    EXPECT_THAT(clearway({"compare", "one", "--against", "Graph made by simulation attribute"}).err,
                HasSubstr("Did you mean 'Graph made by simulation attributes'?"));
    EXPECT_EQ(clearway({"compare", "one", "one", "--against", "baseline"}).code, 3);
    const Ended rows = clearway({"compare", "one", "--against", "baseline", "--publish", "results/x.csv"});
    EXPECT_EQ(rows.code, 3);
    EXPECT_THAT(rows.err, HasSubstr("--publish: writes differences from baselines"));
}

TEST_F(CompareTest, compares_with_the_same_at_another_level_of_a_factor) {
    write("my.toml",
          "name = \"mine\"\nreplications = 5\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n"
          "[[condition]]\nname = \"own\"\npolicy = [\"corridor\"]\n[factors]\n"
          "condition.policy = [\"corridor\", \"geocast\"]\ncondition.failure = [\"perfect\", \"B10\"]\n"
          "[titles]\ncorridor = \"Ours\"\ngeocast = \"Today\"\n");
    ASSERT_EQ(clearway({"study", "my.toml"}).code, 0);
    const auto tables = nlohmann::json::parse(
        clearway({"compare", "runs/mine", "--against", "policy=geocast", "--json"}).out);
    ASSERT_EQ(tables.at("comparisons").size(), 2U);
    for (const auto& pair : tables["comparisons"]) {
        const std::string condition = pair["condition"];
        const std::size_t policy = condition.find("corridor");
        ASSERT_NE(policy, std::string::npos) << condition;
        EXPECT_EQ(pair["compared_with"],
                  condition.substr(0, policy) + "geocast" + condition.substr(policy + 8));
        EXPECT_EQ(pair["title"],
                  condition.find("B10") == std::string::npos ? "Ours, perfect sensors" : "Ours, B10");
    }
    EXPECT_EQ(tables.at("conditions").size(), 5U) << "titles of all, also of the baseline";
    EXPECT_THAT(
        clearway({"compare", "runs/mine", "--against", "policy=geocast"}).out,
        AllOf(HasSubstr("\nOurs, B10           "), HasSubstr("\nOurs, perfect             5 "),
              HasSubstr("\n  sensors\n"), HasSubstr("diff.: minus its counterpart with policy Today, paired"),
              Not(HasSubstr("geocast"))));
    const Ended figures = clearway({"export", "figures", "runs/mine", "--out", "figures", "--svg-only",
                                    "--against", "condition.policy=geocast"});
    ASSERT_EQ(figures.code, 0) << figures.err;
    EXPECT_THAT(
        read("figures/factors-emergency-grid.tex"),
        AllOf(HasSubstr("difference to its counterpart with policy Today, s"),
              HasSubstr("\\label{tab:factors-emergency-grid-against-its-counterpart-with-policy-today}")));
    EXPECT_THAT(
        read("figures/differences-line.svg"),
        AllOf(HasSubstr("difference to policy Today (left: better), s"), Not(HasSubstr("the baseline"))));
    const auto refused = [&](const char* against, const char* said) {
        const Ended ended = clearway({"compare", "runs/mine", "--against", against});
        EXPECT_EQ(ended.code, 3);
        EXPECT_THAT(ended.err, HasSubstr(said));
    };
    refused("polcy=geocast", "Did you mean 'policy'?");
    refused("policy=geocats", "--against: level of condition.policy: `geocats` is unknown");
    refused("condition.polcy=geocast", "Did you mean 'condition.policy'?");
    refused("nobody", "or a factor and its level, as condition.failure=perfect");
}

TEST_F(CompareTest, compares_with_the_best_other_condition_under_the_same_failure) {
    write("my.toml",
          "name = \"mine\"\nreplications = 5\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n"
          "[[condition]]\nname = \"own\"\npolicy = [\"corridor\"]\n[factors]\n"
          "condition.policy = [\"corridor\", \"geocast\", \"clear_lane\"]\n"
          "condition.failure = [\"perfect\", \"B10\"]\n");
    ASSERT_EQ(clearway({"study", "my.toml"}).code, 0);
    std::map<std::string, double> sums;  // of equally many runs
    const auto rows =
        nlohmann::json::parse(clearway({"export", "results", "runs/mine", "runs", "--json"}).out);
    for (const auto& row : rows)
        sums[row["condition"]] += row["emergency_restricted_travel_time_s"].get<double>();
    const auto usual = nlohmann::json::parse(clearway({"compare", "runs/mine", "--json"}).out);
    for (const auto& pair : usual["comparisons"])
        if (pair["objections"] != "") sums.erase(pair["condition"].get<std::string>());
    const auto best =
        nlohmann::json::parse(clearway({"compare", "runs/mine", "--against", "best", "--json"}).out);
    ASSERT_EQ(best.at("comparisons").size(), 6U);
    const auto failure_of = [](const std::string& name) { return name.substr(0, name.find("+policy")); };
    for (const auto& pair : best["comparisons"]) {
        const std::string with = pair["compared_with"];
        EXPECT_NE(with, pair["condition"]);
        EXPECT_EQ(failure_of(with), failure_of(pair["condition"]));
        ASSERT_TRUE(sums.contains(with)) << "it loses no emergency vehicle";
        for (const auto& [other, sum] : sums) {
            if (other == pair["condition"] || failure_of(other) != failure_of(with)) continue;
            EXPECT_LE(sums[with], sum + 1e-9) << other;
        }
    }
    const std::string text = clearway({"compare", "runs/mine", "--against", "best"}).out;
    EXPECT_THAT(text,
                testing::ContainsRegex("line: corridor, B10 is [a-z ]+ (geocast|clear_lane), B10, the best"));
    EXPECT_THAT(text, HasSubstr("which favours it"));
    EXPECT_THAT(clearway({"compare", "runs/mine", "--against", "best", "--metric", "others_time_loss_s"}).out,
                testing::ContainsRegex("in others_time_loss_s,[a-z_, 0-9B\\s]+is level with "
                                       "[a-z_, 0-9B]+the\\s+best other one by "
                                       "EV\\s+travel\\s+time:\\s+0.0"));
}

TEST_F(CompareTest, tells_titles_where_nothing_is_compared) {
    ASSERT_EQ(
        clearway({"run", "line", "--seeds", "2", "--no-solo", "--condition", "baseline", "--out", "single"})
            .code,
        0);
    const auto said = nlohmann::json::parse(clearway({"compare", "single", "--json"}).out);
    EXPECT_TRUE(said.at("comparisons").empty());
    EXPECT_EQ(said.at("conditions").at(0).at("title"), "Baseline");
    EXPECT_EQ(clearway({"compare", "single", "--json", "--tolerance", "1"}).code, 3)
        << "a gate that compares nothing does not pass";
}

TEST_F(CompareTest, two_that_publish_at_once_lose_no_row) {
    ASSERT_EQ(clearway(two_conditions("one", 2)).code, 0);
    const auto publish = [&](const char* metric) {
        return clearway({"compare", "one", "--publish", "rows.csv", "--tree", "abc1234", "--behaviour",
                         "0123456789ab", "--metric", metric})
            .code;
    };
    ASSERT_EQ(publish("simulated_s") + publish("emergency_restricted_travel_time_s"), 0);
    const auto both = std::ranges::count(read("rows.csv"), '\n');
    for (int round = 0; round < 6; ++round) {
        std::filesystem::remove(folder() / "rows.csv");
        auto other = std::async(std::launch::async, publish, "simulated_s");
        EXPECT_EQ(publish("emergency_restricted_travel_time_s"), 0);
        EXPECT_EQ(other.get(), 0);
        EXPECT_EQ(std::ranges::count(read("rows.csv"), '\n'), both);
    }
}

TEST_F(CompareTest, publishes_rows_and_loses_none) {
    ASSERT_EQ(clearway(two_conditions((folder() / "one").string(), 5)).code, 0);
    const std::vector<std::string> words = {"compare",     "one",
                                            "--publish",   "rows.csv",
                                            "--metric",    "emergency_restricted_travel_time_s",
                                            "--behaviour", "0123456789ab"};
    const auto publish = [&](const std::vector<std::string>& more, const std::string& file = "rows.csv") {
        std::vector<std::string> all = words;
        all[3] = file;
        all.insert(all.end(), more.begin(), more.end());
        return clearway(all);
    };
    const Ended ended = publish({"--tree", "abc1234"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("rows.csv: 6 rows"));
    const std::string rows = read("rows.csv");
    EXPECT_THAT(
        rows,
        AllOf(testing::StartsWith("study,tree,date,seed,pairs,command,scenario,condition,measure,unit,"),
              HasSubstr(",1,5,clearway run line --seeds 5 --no-solo --condition graph_simulation,line,"
                        "graph_simulation,emergency_restricted_travel_time_s:percent,%,"),
              HasSubstr(",0 of "), HasSubstr(",product,0123456789ab\n")));
    EXPECT_THAT(rows, Not(HasSubstr(folder().string())));

    EXPECT_EQ(publish({"--tree", "abc1234", "--metric", "collisions"}).code, 0);
    EXPECT_EQ(std::ranges::count(read("rows.csv"), '\n'), 1 + 6 + 3)
        << "no percent of a baseline without any";
    const std::string kept = read("rows.csv");

    EXPECT_EQ(publish({"--tree", "abc1234", "--metric", "collisions", "--metric", "collisions"}).code, 0);
    EXPECT_EQ(read("rows.csv"), kept);

    write("other.csv", "a,b\n1,2\n");
    const Ended other = publish({"--tree", "abc1234"}, "other.csv");
    EXPECT_EQ(other.code, 3);
    EXPECT_THAT(other.err, HasSubstr("other.csv: has another header"));
    EXPECT_EQ(read("other.csv"), "a,b\n1,2\n");
    EXPECT_EQ(publish({"--tree", "abc1234"}, "gone/rows.csv").code, 4);
    const Ended two = clearway({"compare", "one", "one", "--publish", "rows.csv"});
    EXPECT_EQ(two.code, 3);
    EXPECT_THAT(two.err, HasSubstr("--publish: writes the rows of one run folder"));
    EXPECT_THAT(clearway({"compare", "one", "--publish", "rows.csv", "--behaviour", "12"}).err,
                HasSubstr("is not 12 to 12 digits"));
    EXPECT_THAT(publish({"--tree", "main"}).err, HasSubstr("`main` is not 7 to 40 digits"));
    EXPECT_EQ(clearway({"compare", "one", "--tree", "abc1234"}).code, 2) << "it needs --publish";

    ASSERT_TRUE(std::filesystem::remove(folder() / "one/runs/line/graph_simulation/00001/run.json"));
    const Ended partial = publish({"--tree", "abc1234"});
    EXPECT_EQ(partial.code, 3);
    EXPECT_THAT(partial.err, HasSubstr("line/graph_simulation: 1 of 5 runs failed or are missing"));
    EXPECT_EQ(read("rows.csv"), kept);

    ASSERT_EQ(clearway(two_conditions("single", 1)).code, 0);
    const Ended single = clearway({"compare", "single", "--publish", "rows.csv"});
    EXPECT_EQ(single.code, 3);
    EXPECT_THAT(single.err, HasSubstr("single: has one replication"));
    EXPECT_EQ(read("rows.csv"), kept);
}

TEST_F(CompareTest, published_rows_carry_the_fingerprint_of_the_golden_runs) {
    ASSERT_EQ(clearway(two_conditions("one", 2)).code, 0);
    std::filesystem::create_directories(folder() / "tree/tests/loop");
    write("tree/tests/loop/golden.txt",
          "a f0000000000000000000000000000001 0000000000000000000000000000000f\n"
          "b 0f000000000f000000000000000000ff 00000000000000000000000000000000\n");
    const Environment elsewhere{.environment = {{"CLEARWAY_HOME", (folder() / "tree").string()}}};
    const std::vector<std::string> words = {"compare",  "one",      "--publish",
                                            "rows.csv", "--metric", "collisions"};
    const Ended nameless = clearway(words, elsewhere);
    EXPECT_EQ(nameless.code, 3) << "git does not know this tree";
    EXPECT_THAT(nameless.err, HasSubstr("--tree: git does not name the commit"));
    std::vector<std::string> named = words;
    named.insert(named.end(), {"--tree", "abc1234"});
    ASSERT_EQ(clearway(named, elsewhere).code, 0);
    EXPECT_THAT(read("rows.csv"), HasSubstr(",product,ff000000000f\n")) << "exclusive or of all hashes";
}

TEST_F(CompareTest, publishes_a_baseline_alone) {
    ASSERT_EQ(
        clearway({"run", "line", "--seeds", "2", "--no-solo", "--condition", "baseline", "--out", "out"})
            .code,
        0);
    EXPECT_EQ(clearway({"compare", "out"}).code, 3);
    const Ended ended = clearway({"compare", "out", "--publish", "rows.csv", "--tree", "abc1234",
                                  "--behaviour", "0123456789ab", "--metric", "others_time_loss_s"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(read("rows.csv"), HasSubstr(",line,baseline,others_time_loss_s,s,"));
}

}  // namespace
}  // namespace clearway::cli
