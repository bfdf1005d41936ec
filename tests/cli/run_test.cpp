// Runs with SUMO, from the command line to the files.
#include <algorithm>
#include <sstream>

#include <nlohmann/json.hpp>
#include <sqlite3.h>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

class RunTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
    }
    /// Names of those that a run with these words has, without solo.
    std::vector<std::string> conditions(const std::vector<std::string>& words,
                                        const std::string& folder) const {
        std::vector<std::string> all = {"run", "line", "--seeds", "1", "--no-solo", "--out", folder};
        all.insert(all.end(), words.begin(), words.end());
        const Ended ended = clearway(all);
        EXPECT_EQ(ended.code, 0) << ended.err;
        std::vector<std::string> names;
        const auto manifest = nlohmann::json::parse(read(folder + "/manifest.json"));
        for (const auto& one : manifest.at("conditions"))
            names.push_back(one.at("name"));
        return names;
    }
};

TEST_F(RunTest, what_is_set_stands_in_manifest_record_and_report) {
    const Ended ended =
        clearway({"run", "line", "--seeds", "1", "--no-solo", "--out", "out", "--policy", "corridor", "--set",
                  "clear_lane.horizon_m=300", "--set", "actuation.hold_cap_s=30.0"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const std::string name = "corridor_hold_cap_s_30_horizon_m_300";
    const nlohmann::json set = {{"actuation.hold_cap_s", "30"}, {"clear_lane.horizon_m", "300"}};
    const auto manifest = nlohmann::json::parse(read("out/manifest.json"));
    EXPECT_EQ(manifest.at("conditions").back().at("name"), name);
    EXPECT_EQ(manifest.at("conditions").back().at("settings"), set);
    EXPECT_FALSE(manifest.at("conditions").front().contains("settings"));
    const auto run = nlohmann::json::parse(read("out/runs/line/" + name + "/00000/run.json"));
    EXPECT_EQ(run.at("condition_spec").at("settings"), set);
    EXPECT_THAT(read("out/report.html"), HasSubstr("actuation.hold_cap_s=30 clear_lane.horizon_m=300"));
}

TEST_F(RunTest, settings_change_the_usual_condition_or_the_one_that_is_named) {
    using testing::ElementsAre;
    EXPECT_THAT(conditions({"--set", "preempt_signals.lead_s=12"}, "usual"),
                ElementsAre("baseline", "corridor_lead_s_12"));
    EXPECT_THAT(conditions({"--condition", "graph_simulation", "--set", "dissertation.ahead_m=80"}, "named"),
                ElementsAre("baseline", "graph_simulation", "dissertation_ahead_m_80"));
    EXPECT_THAT(conditions({"--policy", "none"}, "none"), ElementsAre("baseline"));
    EXPECT_THAT(conditions({"--policy", "none", "--set", "siren.compliance=1"}, "sirens"),
                ElementsAre("baseline_compliance_1", "no_policy_compliance_1"));
}

TEST_F(RunTest, several_policies_are_told_to_be_one_condition_and_a_dense_plan_its_variant) {
    const auto planned = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"run", "intersection", "--seeds", "1", "--dry-run", "--no-solo"});
        return clearway(words);
    };
    const Ended two = planned({"--policy", "clear_lane", "preempt_signals", "--dense"});
    EXPECT_THAT(two.err, HasSubstr("clearway: one condition of 2 policies: clear_lane, preempt_signals; to "
                                   "compare them: a study file with a [[condition]] for each"));
    EXPECT_THAT(two.out, AllOf(HasSubstr("intersection, dense "), Not(HasSubstr("traffic model"))));
    const Ended one = planned({"--policy", "clear_lane", "--traffic-model", "sublane"});
    EXPECT_THAT(one.err, Not(HasSubstr("one condition of")));
    EXPECT_THAT(one.out, AllOf(HasSubstr("  traffic model"), Not(HasSubstr(", dense"))));
}

TEST_F(RunTest, a_condition_of_ones_own_cannot_take_the_name_of_a_built_in_one) {
    for (const std::string name : {"baseline", "solo", "graph_simulation"}) {
        const Ended ended =
            clearway({"run", "line", "--seeds", "1", "--policy", "corridor", "--name", name, "--out", "out"});
        EXPECT_EQ(ended.code, 3);
        EXPECT_THAT(ended.err, HasSubstr("`" + name + "` is a built-in condition"));
    }
}

TEST_F(RunTest, writes_a_run_folder_and_prints_tables_on_standard_output_alone) {
    const Ended ended = clearway({"run", "line", "--seeds", "2", "--out", "out", "--policy", "dissertation",
                                  "--failure", "B10", "--predictor", "dead_reckoning"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, AllOf(HasSubstr("EV travel time"), HasSubstr("dissertation_B10_dead_reckoning")));
    EXPECT_THAT(ended.out, AllOf(Not(HasSubstr("elapsed")), Not(HasSubstr("written:"))));
    EXPECT_THAT(ended.err, AllOf(HasSubstr("8/8"), HasSubstr("report.html")));
    for (const char* const file : {"manifest.json", "command.txt", "runs.csv", "vehicles.csv",
                                   "results.sqlite", "report.html", "scenarios/line/scenario.toml",
                                   "scenarios/line/network.svg", "scenarios/line/network/network.net.xml"}) {
        EXPECT_TRUE(std::filesystem::exists(folder() / "out" / file)) << file;
    }
    EXPECT_THAT(read("out/command.txt"), HasSubstr("clearway run line --seeds 2"));
    EXPECT_THAT(read("out/runs.csv"), AllOf(HasSubstr("line,baseline,0,ok"), HasSubstr("line,solo,1,ok")));
}

TEST_F(RunTest, what_fails_has_the_same_condition_beside_it_while_nothing_fails) {
    using testing::ElementsAre;
    const std::vector<std::string> failing = {
        "--policy",    "dissertation",   "--failure", "B10",
        "--predictor", "dead_reckoning", "--set",     "dead_reckoning.link_threshold=0.4"};
    EXPECT_THAT(
        conditions(failing, "beside"),
        ElementsAre("baseline", "dissertation", testing::StartsWith("dissertation_B10_dead_reckoning")));
    EXPECT_THAT(read("beside/controls.json"),
                HasSubstr("\"dissertation\": \"dissertation_B10_dead_reckoning"));
    std::vector<std::string> named = failing;
    named.insert(named.end(), {"--name", "mine"});
    EXPECT_THAT(conditions(named, "named"), ElementsAre("baseline", "mine_perfect", "mine"));
    named.emplace_back("--no-perfect");
    EXPECT_THAT(conditions(named, "alone"), ElementsAre("baseline", "mine"));
    EXPECT_THAT(conditions({"--policy", "none", "--failure", "B10"}, "inert"),
                ElementsAre("baseline", "no_policy_B10"));
}

TEST_F(RunTest, json_is_all_of_standard_output_and_carries_units) {
    std::vector<std::string> words = two_conditions("out", 2);
    words.emplace_back("--json");
    const Ended ended = clearway(words);
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto tables = nlohmann::json::parse(ended.out);
    const auto& conditions = tables.at("scenarios").at(0).at("conditions");
    ASSERT_EQ(conditions.size(), 2U);
    const double travel_time_s = conditions[0].at("measures").at("emergency_travel_time_s").at("mean");
    EXPECT_GT(travel_time_s, 600.0 / 40.0);
    EXPECT_LT(travel_time_s, 200.0);
}

TEST_F(RunTest, one_and_two_jobs_give_the_same_bytes) {
    ASSERT_EQ(clearway(two_conditions("one", 4, 1)).code, 0);
    ASSERT_EQ(clearway(two_conditions("two", 4, 2)).code, 0);
    EXPECT_EQ(read("one/runs.csv"), read("two/runs.csv"));
    EXPECT_EQ(read("one/vehicles.csv"), read("two/vehicles.csv"));
    EXPECT_THAT(read("one/runs.csv"), HasSubstr("line,graph_simulation,3,ok"));
}

TEST_F(RunTest, results_prints_every_table_it_lists) {
    ASSERT_EQ(clearway(two_conditions("out", 2)).code, 0);
    const Ended list = clearway({"export", "results", "out", "--list"});
    EXPECT_EQ(list.code, 0);
    EXPECT_THAT(list.out, AllOf(HasSubstr("runs\n"), HasSubstr("vehicles\n"), HasSubstr("errors\n")));
    std::istringstream names(list.out);
    for (std::string name; std::getline(names, name);) {
        const Ended csv = clearway({"export", "results", "out", name, "--csv"});
        EXPECT_EQ(csv.code, 0) << name << csv.err;
        EXPECT_THAT(csv.out, HasSubstr("\n")) << name;
        EXPECT_TRUE(
            nlohmann::json::parse(clearway({"export", "results", "out", name, "--json"}).out).is_array())
            << name;
    }
    EXPECT_THAT(clearway({"export", "results", "out"}).out, HasSubstr("line,baseline,0,"));
    const Ended unknown = clearway({"export", "results", "out", "vehicle"});
    EXPECT_EQ(unknown.code, 3);
    EXPECT_THAT(unknown.err, AllOf(HasSubstr("`vehicle`"), HasSubstr("vehicles")));
}

TEST_F(RunTest, a_folder_in_place_of_the_database_is_named) {
    ASSERT_EQ(clearway(two_conditions("out", 1)).code, 0);
    std::filesystem::remove(folder() / "out/results.sqlite");
    std::filesystem::create_directory(folder() / "out/results.sqlite");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"report", "out"}, {"export", "results", "out"}}) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3) << words[0];
        EXPECT_THAT(ended.err, AllOf(HasSubstr("out/results.sqlite: is a folder"), HasSubstr("Remove it")));
    }
}

TEST_F(RunTest, results_of_a_folder_that_cannot_be_written_are_those_that_are_there) {
    ASSERT_EQ(clearway(two_conditions("out", 1)).code, 0);
    const std::string errors = clearway({"export", "results", "out", "errors"}).out;
    const std::string runs = read("out/runs.csv");
    std::filesystem::remove(folder() / "out/runs.csv");
    // Rights do not hold back the user of the tests, who may be root.
    const Environment cannot_write = {.before = "trap '' XFSZ && ulimit -f 1"};
    const Ended kept = clearway({"export", "results", "out", "errors"}, cannot_write);
    EXPECT_EQ(kept.code, 0) << kept.err;
    EXPECT_EQ(kept.out, errors);
    EXPECT_THAT(kept.err, AllOf(HasSubstr("warning: "), HasSubstr("cannot write"),
                                HasSubstr("out/results.sqlite as it is")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out/runs.csv"));
    std::filesystem::rename(folder() / "out/results.sqlite", folder() / "aside");
    EXPECT_EQ(clearway({"export", "results", "out", "errors"}, cannot_write).code, 4)
        << "there is nothing to print";
    std::filesystem::rename(folder() / "aside", folder() / "out/results.sqlite");
    const Ended again = clearway({"export", "results", "out", "errors"});
    EXPECT_EQ(again.code, 0);
    EXPECT_THAT(again.err, IsEmpty());
    EXPECT_EQ(read("out/runs.csv"), runs) << "a deleted table is written again";
}

TEST_F(RunTest, without_out_the_same_command_finds_its_folder_again) {
    const std::vector<std::string> words = {"run", "line", "--seeds", "1", "--condition", "baseline"};
    ASSERT_EQ(clearway(words).code, 0);
    const Ended again = clearway(words);
    EXPECT_EQ(again.code, 0) << again.err;
    const auto first = std::filesystem::directory_iterator(folder() / "runs");
    EXPECT_EQ(std::distance(first, std::filesystem::directory_iterator()), 1);
    std::vector<std::string> other = words;
    other.insert(other.end(), {"--seed", "7"});
    ASSERT_EQ(clearway(other).code, 0);
    const auto second = std::filesystem::directory_iterator(folder() / "runs");
    EXPECT_EQ(std::distance(second, std::filesystem::directory_iterator()), 2);
}

TEST_F(RunTest, a_run_that_is_made_anew_replaces_its_rows) {
    ASSERT_EQ(clearway(two_conditions("out", 2)).code, 0);
    const std::string runs = read("out/runs.csv");
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((folder() / "out/results.sqlite").c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database,
                           "UPDATE runs SET emergency_travel_time_s = 7654.5 WHERE condition = 'baseline'",
                           nullptr, nullptr, nullptr),
              SQLITE_OK);
    sqlite3_close(database);
    const std::vector<std::string> shown = {"export", "results", "out", "runs"};
    EXPECT_THAT(clearway(shown).out, Not(HasSubstr(",7654.5,"))) << "an edited database is not believed";
    std::filesystem::remove_all(folder() / "out/runs/line/baseline");
    write("out/runs.csv", "of earlier runs");
    ASSERT_EQ(clearway(two_conditions("out", 2)).code, 0);
    EXPECT_THAT(clearway(shown).out, AllOf(HasSubstr("line,baseline,1,"), Not(HasSubstr(",7654.5,"))));
    EXPECT_EQ(read("out/runs.csv"), runs);
}

TEST_F(RunTest, without_a_condition_it_compares_corridor_with_the_baseline) {
    const Ended ended = clearway({"run", "line", "--seeds", "1", "--out", "out"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const std::string runs = read("out/runs.csv");
    for (const char* const condition : {"baseline", "corridor", "solo"})
        EXPECT_THAT(runs, HasSubstr(std::string("line,") + condition + ",0,ok"));
    EXPECT_EQ(std::count(runs.begin(), runs.end(), '\n'), 4);
}

TEST_F(RunTest, the_dissertations_tables_belong_to_its_study) {
    const Ended run = clearway({"run", "merge", "--seeds", "1", "--no-solo", "--condition",
                                "graph_simulation", "--out", "out", "--tables"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, AllOf(Not(HasSubstr("TABLE")), Not(HasSubstr("published"))));
    EXPECT_THAT(read("out/report.html"), Not(HasSubstr("class=\"published\"")));
    std::string study =
        core::read_file(std::filesystem::path(CLEARWAY_SOURCE_DIR) / "studies/dissertation.toml");
    const std::string all_seeds = "replications = 20";
    write("dissertation.toml", study.replace(study.find(all_seeds), all_seeds.size(), "replications = 1"));
    const Ended reproduced = clearway({"study", "dissertation.toml", "--out", "all"});
    ASSERT_EQ(reproduced.code, 0) << reproduced.err;
    EXPECT_THAT(reproduced.out,
                AllOf(HasSubstr("TABLE II. PERFORMANCE ON MERGE\n"), HasSubstr("(here: merge_dense)"),
                      HasSubstr("TABLE IV."), HasSubstr("published")));
    for (const char* const net :
         {"GraphSAGE, corrected inputs", "GraphSAGE, improved", "GraphSAGE, as published"}) {
        EXPECT_THAT(reproduced.out, HasSubstr(std::string("\n") + net + ": ")) << "its verdict";
        EXPECT_THAT(read("all/report.html"), HasSubstr(net));
    }
    std::istringstream lines(reproduced.out);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 100U) << line;
}

TEST_F(RunTest, the_verdict_comes_last_and_long_tables_where_they_are_asked_for) {
    const Ended brief = clearway(two_conditions("out", 2));
    ASSERT_EQ(brief.code, 0) << brief.err;
    const std::size_t verdict = brief.out.find("Graph made by simulation attributes: ");
    ASSERT_NE(verdict, std::string::npos);
    EXPECT_GT(verdict, brief.out.find("EV travel time, all, s\n"));
    EXPECT_LE(std::ranges::count(brief.out.substr(verdict), '\n'), 8);
    EXPECT_THAT(brief.out,
                AllOf(HasSubstr("--tables"), Not(HasSubstr("Collisions")), Not(HasSubstr("Actions:"))));
    const Ended all = clearway({"report", "out", "--tables"});
    EXPECT_THAT(all.out, AllOf(HasSubstr("Collisions"), HasSubstr("95th pc."), HasSubstr("Actions:")));
    for (const std::string& text : {brief.out, all.out, clearway({"compare", "out"}).out}) {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);)
            EXPECT_LE(line.size(), 80U) << line;
    }
}

TEST_F(RunTest, on_a_terminal_of_80_columns_no_progress_line_wraps_or_meets_a_result) {
    std::vector<std::string> words = two_conditions("a_folder_with_a_rather_long_name", 12);
    const Ended ended = on_terminal(words, 80);
    ASSERT_EQ(ended.code, 0) << ended.out;
    std::string text = ended.out;
    for (std::size_t at = 0; (at = text.find("\x1b[K", at)) != std::string::npos;)
        text.erase(at, 3);
    ASSERT_THAT(text, AllOf(HasSubstr("\rruns ["), HasSubstr("24/24")));
    std::size_t bars = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        // A terminal's line ends in \r\n; a \r before that goes back to its beginning.
        std::istringstream drawings(line);
        for (std::string drawing; std::getline(drawings, drawing, '\r');) {
            if (!drawing.starts_with("runs ")) {
                EXPECT_THAT(drawing, Not(HasSubstr("runs ["))) << "something stands before a progress line";
                continue;
            }
            ++bars;
            EXPECT_LT(drawing.size(), 80U) << drawing;
            EXPECT_THAT(drawing, Not(HasSubstr("clearway:"))) << "a result stands in a progress line";
        }
    }
    EXPECT_GE(bars, 1U);
    EXPECT_THAT(text, HasSubstr(", n 12\r")) << "the last line has all pairs";
    EXPECT_LT(text.rfind("\rruns "), text.find("line: 12 replications"));
}

TEST_F(RunTest, a_dumb_terminal_gets_no_escape_codes) {
    const Ended ended = on_terminal(two_conditions("out", 2), 80, "dumb");
    ASSERT_EQ(ended.code, 0) << ended.out;
    EXPECT_THAT(ended.out, AllOf(HasSubstr("runs: 4/4"), Not(HasSubstr("\x1b"))));
}

TEST_F(RunTest, both_streams_in_one_pipe_keep_their_lines_whole_and_in_order) {
    ASSERT_EQ(clearway(two_conditions("out", 2)).code, 0);
    const Ended apart = clearway({"report", "out", "--tables"});
    ASSERT_THAT(apart.err, HasSubstr("written: "));
    const std::string line = "cd " + core::shell_text({folder().string()}) + " && " + CLEARWAY_BINARY_DIR +
                             "/bin/clearway report out --tables 2>&1 | cat > both.txt";
    ASSERT_TRUE(core::run({"/bin/sh", {"-c", line}, {}, {}}).ok());
    EXPECT_EQ(read("both.txt"), apart.out + apart.err);
}

TEST_F(RunTest, factors_are_columns_of_every_table) {
    write("my.toml",
          "name = \"mine\"\nreplications = 2\nscenarios = [\"./line\"]\n"
          "conditions = [\"baseline\", \"b10_no_repair\"]\n"
          "[factors]\nfailure.dark_share = [0.1, 0.6]\nscenario.demand.human = [3, 5]\n");
    const Ended ended = clearway({"study", "my.toml", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const std::string runs = read("runs/mine/runs.csv");
    EXPECT_THAT(runs, HasSubstr("outcome,cause,safety_checks,failure.dark_share,scenario.demand.human,"));
    EXPECT_THAT(runs, HasSubstr("line+human=3,baseline,0,ok,,on,,3,"));
    EXPECT_THAT(runs, HasSubstr("line+human=5,b10_no_repair+dark_share=0.6,1,ok,,on,0.6,5,"));
    const auto tables = nlohmann::json::parse(ended.out);
    const auto& of_json = tables.at("scenarios").at(1).at("conditions").at(2);
    EXPECT_EQ(of_json.at("factors"),
              (nlohmann::json{{"failure.dark_share", 0.6}, {"scenario.demand.human", 5}}));
    const auto rows =
        nlohmann::json::parse(clearway({"export", "results", "runs/mine", "runs", "--json"}).out);
    const auto row = [&](const std::string& condition) {
        return *std::ranges::find_if(rows, [&](const auto& one) { return one.at("condition") == condition; });
    };
    EXPECT_TRUE(row("baseline").at("failure.dark_share").is_null());
    EXPECT_EQ(row("b10_no_repair+dark_share=0.1").at("failure.dark_share"), 0.1);
    EXPECT_EQ(row("b10_no_repair+dark_share=0.1").at("scenario.demand.human"), 3);
    const std::string compared = clearway({"compare", "runs/mine"}).out;
    EXPECT_THAT(compared,
                testing::ContainsRegex("\nSame failures, no +2 .*\n  repair, dark\n  share 0\\.6\n"));
    const auto json = nlohmann::json::parse(clearway({"compare", "runs/mine", "--json"}).out);
    EXPECT_EQ(json.at("comparisons").at(0).at("factors").at("failure.dark_share"), 0.1);
}

TEST_F(RunTest, sublane_brings_a_baseline_of_its_own) {
    const Ended ended =
        clearway({"run", "line", "--seeds", "1", "--out", "out", "--no-solo", "--traffic-model", "sublane",
                  "--policy", "dissertation", "--name", "mine"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(read("out/runs.csv"),
                AllOf(HasSubstr("line,baseline_sublane,0,ok"), HasSubstr("line,mine,0,ok")));
}

TEST_F(RunTest, the_trace_of_a_small_run_is_as_recorded) {
    ASSERT_EQ(clearway(two_conditions("out", 1)).code, 0);
    const auto trace_of = [&](const std::string& condition) {
        const auto run = nlohmann::json::parse(read("out/runs/line/" + condition + "/00000/run.json"));
        return run.at("provenance").at("trace_hash").get<std::string>();
    };
    // Recorded with SUMO 1.15.0. A change means that every result changes: say so in the changelog.
    EXPECT_EQ(trace_of("baseline"), "baa39fe9f426d67f7c43339abee66cda");
    EXPECT_EQ(trace_of("graph_simulation"), "5066a8d7ed43b5248f36af76c560bfdf");
}

TEST_F(RunTest, few_seeds_are_told_before_they_run) {
    EXPECT_THAT(clearway(two_conditions("few", 4)).err,
                HasSubstr("8 runs into few; fewer than 5 seeds give no interval\n"));
    EXPECT_THAT(clearway(two_conditions("enough", 5)).err, HasSubstr("10 runs into enough\n"));
}

TEST_F(RunTest, report_prints_the_tables_of_a_run_folder_again) {
    const Ended ended = clearway(two_conditions("out", 2));
    ASSERT_EQ(ended.code, 0) << ended.err;
    std::filesystem::remove(folder() / "out" / "report.html");
    const Ended report = clearway({"report", "out"});
    EXPECT_EQ(report.code, 0) << report.err;
    EXPECT_EQ(report.out, ended.out);
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "report.html"));
}

TEST_F(RunTest, init_prints_a_command_that_works_as_it_stands) {
    // The name of a scenario that comes with Clearway: alone it would mean that one.
    const Ended made = clearway({"scenario", "init", "city", "--from", "line"});
    ASSERT_EQ(made.code, 0) << made.err;
    const std::size_t at = made.out.find("\n  clearway ");
    ASSERT_NE(at, std::string::npos) << made.out;
    const std::string command = made.out.substr(at + 3, made.out.find('\n', at + 1) - at - 3);
    EXPECT_EQ(command, "clearway run ./city");
    const std::string line = "cd " + core::shell_text({folder().string()}) +
                             " && PATH=" + CLEARWAY_BINARY_DIR + "/bin:$PATH && " + command +
                             " > said.txt 2> stderr.txt";
    ASSERT_TRUE(core::run({"/bin/sh", {"-c", line}, {}, {}}).ok()) << read("stderr.txt");
    EXPECT_THAT(read("said.txt"), HasSubstr("city: 10 replications"));
    EXPECT_THAT(read("stderr.txt"), HasSubstr("30/30"));
}

TEST_F(RunTest, a_dry_run_says_that_a_policy_sends_no_messages_which_could_be_lost) {
    const auto planned = [&](const char* policy) {
        return clearway({"run", "line", "--policy", policy, "--failure", "Q50", "--dry-run"}).out;
    };
    EXPECT_THAT(planned("check_in_out"), HasSubstr("check_in_out sends no messages, so those that"));
    EXPECT_THAT(planned("corridor"), Not(HasSubstr("sends no messages")));
}

TEST_F(RunTest, a_dry_run_says_that_its_time_leaves_out_copies_of_runs) {
    const auto planned = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"run", "line", "--dry-run"};
        words.insert(words.end(), more.begin(), more.end());
        return clearway(words).out;
    };
    EXPECT_THAT(planned({}), Not(HasSubstr("copies")));
    EXPECT_THAT(planned({"--set", "loop.ways_tried=2"}), HasSubstr("without the copies"));
}

TEST_F(RunTest, init_copies_a_scenario_that_runs) {
    ASSERT_EQ(clearway({"scenario", "init", "mine", "--from", "line"}).code, 0);
    const Ended ended =
        clearway({"run", "mine", "--seeds", "1", "--condition", "baseline", "--no-solo", "--out", "out"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(read("out/runs.csv"), HasSubstr("mine,baseline,0,ok"));
}

}  // namespace
}  // namespace clearway::cli
