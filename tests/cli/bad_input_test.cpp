// What is wrong in the user's files, and what the machine refuses.

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

class BadInputTest : public UserTest {
  protected:
    /// Runs the line scenario with one piece of it replaced.
    Ended run_changed(const std::string& replaced, const std::string& replacement) const {
        write_line_scenario(replaced, replacement);
        return clearway({"run", "line", "--seeds", "1", "--out", "out"});
    }
};

TEST_F(BadInputTest, a_name_of_a_shipped_scenario_and_of_a_folder_here_is_refused_with_both_places) {
    ASSERT_EQ(clearway({"scenario", "init", "merge"}).code, 0);
    const Ended ended = clearway({"run", "merge", "--seeds", "1"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("merge: is a shipped scenario and stands in this folder too"),
                                 HasSubstr("./merge for the one here"), HasSubstr("scenarios/merge for")));
    EXPECT_EQ(clearway({"scenario", "check", "./merge"}).code, 0);
    std::filesystem::remove_all(folder() / "merge");
}

TEST_F(BadInputTest, a_scenario_gets_no_name_that_run_would_refuse) {
    for (const char* const name : {"Zürich2", "my crossing", ".hidden"}) {
        const Ended ended = clearway({"scenario", "init", name});
        EXPECT_EQ(ended.code, 3) << name;
        EXPECT_THAT(ended.err, HasSubstr("1 to 100 letters, digits"));
        EXPECT_FALSE(std::filesystem::exists(folder() / name));
    }
    ASSERT_EQ(clearway({"scenario", "init", "mine"}).code, 0);
    std::filesystem::rename(folder() / "mine", folder() / "Zürich2");
    std::string text = read("Zürich2/scenario.toml");
    const std::size_t at = text.find("\"mine\"");
    write("Zürich2/scenario.toml", text.replace(at, 6, "\"Zürich2\""));
    const Ended ended = clearway({"run", "./Zürich2", "--seeds", "1"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_EQ(ended.err.find("cannot be the name"), ended.err.rfind("cannot be the name")) << ended.err;
}

TEST_F(BadInputTest, a_study_file_with_words_of_the_command_line_is_told_its_own) {
    write("my.toml",
          "name = \"mine\"\nseeds = 3\nscenarios = [\"merge\"]\nconditions = [\"baseline\"]\n"
          "[factors]\nlead_s = [4, 8]\npreempt_signals.led_s = [4, 8]\n");
    const std::string said = clearway({"study", "my.toml"}).err;
    EXPECT_THAT(said, AllOf(HasSubstr("Did you mean 'replications'?"),
                            HasSubstr("Did you mean 'preempt_signals.lead_s'?")));
    EXPECT_EQ(said.find("led_s: is unknown"), said.rfind("led_s: is unknown")) << "two values, one error";
}

TEST_F(BadInputTest, a_map_is_sent_to_the_import_and_a_misspelt_folder_to_its_neighbour) {
    write_line_scenario();
    core::write_atomically(folder() / "city.osm.gz", "packed");
    const Ended map = clearway({"run", "./city.osm.gz"});
    EXPECT_EQ(map.code, 3);
    EXPECT_THAT(map.err, HasSubstr("`clearway scenario import ./city.osm.gz --name NAME` makes one"));
    EXPECT_THAT(clearway({"run", "./linne"}).err, HasSubstr("Did you mean './line'?"));
}

TEST_F(BadInputTest, a_link_that_leads_to_itself_disturbs_only_who_names_it) {
    write_line_scenario();
    write("my.toml", "replications = 1\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n");
    for (const char* const name : {"loop", "submt"})
        std::filesystem::create_symlink(name, folder() / name);
    EXPECT_THAT(clearway({"run", "linne"}).err, HasSubstr("Did you mean 'line'?"));
    const Ended submitted = clearway({"study", "submit", "my.toml", "--out", "out"});
    EXPECT_EQ(submitted.code, 0) << submitted.err;
    EXPECT_THAT(clearway({"study", "submt"}).err, HasSubstr("Did you mean 'study submit'?"));
    for (const std::vector<std::string>& words : {std::vector<std::string>{"run", "loop"},
                                                  {"run", "line", "--out", "loop"},
                                                  {"report", "loop"},
                                                  {"verify", "loop", "--all"},
                                                  {"verify", "loop/line/baseline/0"},
                                                  {"compare", "loop", "loop"},
                                                  {"replay", "loop"},
                                                  {"study", "status", "loop"},
                                                  {"study", "merge", "loop", "--out", "new"},
                                                  {"study", "my.toml", "--out", "loop"},
                                                  {"scenario", "init", "loop"},
                                                  {"scenario", "import", "loop", "--name", "x"},
                                                  {"links", "evaluate", "loop"},
                                                  {"attach", "localhost:1", "--out", "loop"}}) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3) << words[0] << ' ' << words[1] << ended.err;
        EXPECT_THAT(ended.err,
                    AllOf(HasSubstr("clearway: loop"), HasSubstr(": Too many levels of symbolic links. "),
                          Not(HasSubstr("filesystem error"))));
    }
}

TEST_F(BadInputTest, a_working_folder_that_was_removed_is_told) {
    for (const char* const words :
         {"run merge --seeds 1", "scenario init mine", "links dataset merge --out x"}) {
        const core::Exit exit = core::run(
            {"/bin/sh",
             {"-c",
              fmt::format("cd \"$1\" && mkdir gone && cd gone && rmdir ../gone && exec \"$0\" {}", words),
              CLEARWAY_BINARY_DIR "/bin/clearway", folder().string()},
             {},
             folder() / "said.txt"});
        EXPECT_EQ(exit.code, 4) << words;
        EXPECT_THAT(read("said.txt"),
                    HasSubstr("The working folder was removed: change to a folder that exists"));
    }
}

TEST_F(BadInputTest, words_at_the_wrong_place_are_sent_to_the_right_one) {
    write_line_scenario();
    const auto told = [&](const std::vector<std::string>& words, const std::string& text) {
        EXPECT_THAT(clearway(words).err, HasSubstr(text));
    };
    told({"run", "line", "corridor"}, "Values follow their option: did you mean '--policy corridor'?");
    told({"run", "line", "--policy", "corridor,clear_lane"}, "Separate several with spaces");
    told({"run", "line", "--predictor", "twin,graphsage"}, "a study file compares several");
    told({"run", "line", "--policy", "mine.Green"}, "A class in Python is FILE.py:CLASS");
    told({"run", "line", "--policy", "baseline"},
         "--policy: `baseline` is a condition and no policy. Say --condition baseline; a baseline is always");
    std::filesystem::create_directory(folder() / "empty");
    told({"list", "metrics"}, "Did you mean 'columns'?");
    told({"scenario", "signals", "intersection", "--out", "nowhere/x.csv"}, "Make its folder first");
    write("word.toml", "scenarios = [line]\n");
    told({"study", "word.toml"}, "texts stand in quotes");
    told({"study", "empty"}, "empty: is a folder (allowed: a study file (.toml)). Name a file in it");
    write("mine.toml", "");
    told({"report", "mine.toml"}, "clearway study mine.toml runs a study file");
}

TEST_F(BadInputTest, an_unknown_scenario_names_the_nearest) {
    const Ended ended = clearway({"run", "mergee"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("mergee"), HasSubstr("Did you mean 'merge'?")));
    EXPECT_THAT(ended.out, IsEmpty());
}

TEST_F(BadInputTest, an_unknown_key_is_named_with_file_line_and_nearest_key) {
    const Ended ended = run_changed("warm_up_s", "warmup_s");
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("line/scenario.toml:10:"), HasSubstr("warmup_s"), HasSubstr("warm_up_s")));
}

TEST_F(BadInputTest, a_negative_count_is_named_with_file_line_and_range) {
    const Ended ended = run_changed("human = 5", "human = -5");
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("line/scenario.toml:15:"), HasSubstr("-5"), HasSubstr("0 to")));
}

TEST_F(BadInputTest, an_unknown_edge_is_named_with_file_and_line) {
    const Ended ended = run_changed("to = \"second\"", "to = \"secnd\"");
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("line/scenario.toml:21:"), HasSubstr("secnd"), HasSubstr("second")));
}

TEST_F(BadInputTest, an_unreachable_destination_is_named_with_file_and_line) {
    const Ended ended = run_changed("to = \"second\"", "to = \"side\"");
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("line/scenario.toml:"), HasSubstr("side")));
}

TEST_F(BadInputTest, a_missing_network_file_is_named) {
    const Ended ended = run_changed("line.nod.xml", "none.nod.xml");
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("none.nod.xml"));
}

TEST_F(BadInputTest, counts_of_unknown_edges_and_damaged_counts_are_named) {
    write("line/counts.csv", "edge,vehicles_per_hour\nfirst,300\nthird,200\n");
    const Ended unknown = run_changed("human = 5", "counts = \"counts.csv\"\nhuman = 5");
    EXPECT_EQ(unknown.code, 3);
    EXPECT_THAT(unknown.err, AllOf(HasSubstr("counts.csv"), HasSubstr("third")));
    write("line/counts.csv", "edge,vehicles_per_hour\nfirst,some\n");
    const Ended damaged = run_changed("human = 5", "counts = \"counts.csv\"\nhuman = 5");
    EXPECT_EQ(damaged.code, 3);
    EXPECT_THAT(damaged.err, HasSubstr("counts.csv:2:"));
    EXPECT_EQ(run_changed("human = 5", "counts = \"none.csv\"\nhuman = 5").code, 3);
}

TEST_F(BadInputTest, a_missing_study_file_is_named) {
    const Ended ended = clearway({"study", "none.toml"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("none.toml"));
}

TEST_F(BadInputTest, all_problems_of_a_study_file_are_told_at_once) {
    write_line_scenario();
    write("my.toml",
          "replications = 3\nscenarios = [\"./line\"]\nconditions = [\"baselin\"]\nseeed = 4\n"
          "[[condition]]\nname = \"mine\"\nfailur = \"B10\"\n");
    const Ended ended = clearway({"study", "my.toml"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("'baseline'"), HasSubstr("my.toml:4:"), HasSubstr("seeed"),
                                 HasSubstr("my.toml:7:"), HasSubstr("failur")));
}

TEST_F(BadInputTest, settings_and_models_are_checked_before_anything_runs) {
    write_line_scenario();
    const auto refused = [&](std::vector<std::string> words, const std::string& message) {
        words.insert(words.begin(), {"run", "line", "--out", "out", "--policy", "corridor"});
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(message));
        EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    };
    refused({"--set", "preempt_signals.leed_s=12"}, "Did you mean 'lead_s'?");
    refused({"--set", "preempt_signals.lead_s=99"},
            "99 is out of range (allowed: 0 to 60 s). Give another number, or leave it out for");
    refused({"--set", "preempt_signals.lead_s"}, "`preempt_signals.lead_s` is not an assignment");
    refused({"--set", "clear_lane.lease_s=0.5"}, "shorter than two policy periods");
    refused({"--set", "failure.loss_rate=0.1"}, "--set failure.report_interval_s=1");
    refused({"--set", "green_wave.before_s=9"}, "green_wave, which the condition does not have");
    refused({"--policy", "rescue_lane"}, "rescue_lane needs vehicles with a place within their lane");
    const Ended empty = clearway({"run", "line", "--out", "out", "--model", ""});
    EXPECT_EQ(empty.code, 2);
    EXPECT_THAT(empty.err, HasSubstr("clearway run: --model: is empty"));
    refused({"--model", "none.weights"}, "none.weights is not a file");
    write("net.weights", "no weights");
    refused({"--predictor", "graphsage", "--model", "net.weights"},
            "condition corridor_graphsage_net: model: ");
    refused({"--model", "net.weights"}, "none is not learned and takes no model");
    EXPECT_EQ(clearway({"list", "settings", "corridr"}).code, 3);
    EXPECT_THAT(clearway({"list", "setings"}).err, HasSubstr("cannot be listed alone"));
}

TEST_F(BadInputTest, names_of_one_kind_can_be_listed_alone) {
    const Ended policies = clearway({"list", "policies"});
    ASSERT_EQ(policies.code, 0) << policies.err;
    EXPECT_THAT(policies.out, AllOf(HasSubstr("preempt_signals"), Not(HasSubstr("Predictors"))));
    EXPECT_EQ(clearway({"list", "policy"}).out, policies.out);
    EXPECT_THAT(clearway({"list", "predictor"}).out, HasSubstr("Predictors"));
    EXPECT_THAT(clearway({"list", "scenarios", "--json"}).out, HasSubstr("\"scenarios\""));
    EXPECT_THAT(clearway({"list", "scenarios"}).out, HasSubstr("roads of 140 km/h"));
    EXPECT_THAT(clearway({"run", "intersection", "--road-limit", "70", "--seeds", "1", "--dry-run"}).out,
                HasSubstr("\nintersection: roads of 70 km/h\n"));
    EXPECT_EQ(clearway({"list", "policies", "corridor"}).code, 3);
    EXPECT_EQ(clearway({"list", "policies", "--markdown"}).code, 3);
    EXPECT_THAT(clearway({"list", "polices"}).err, HasSubstr("Did you mean 'policies'?"));
}

TEST_F(BadInputTest, a_name_without_a_condition_and_options_for_several_are_refused) {
    write_line_scenario();
    const auto refused = [&](std::vector<std::string> words, const std::string& message) {
        words.insert(words.begin(), {"run", "line", "--out", "out"});
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(message));
        EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    };
    refused({"--name", "mine"}, "--name: `mine` names no condition, because none of your own is described");
    refused({"--condition", "corridor", "--name", "mine"}, "Describe a condition, or leave --name out");
    refused({"--policy", "none", "--name", "mine"}, "--name: `mine` names no condition");
    refused({"--condition", "graph_simulation", "solo", "--failure", "B10"},
            "--condition: names graph_simulation, solo, and the options change one condition");
    refused({"--condition", "graph_simulatoin"}, "Did you mean 'graph_simulation'?");
}

TEST_F(BadInputTest, a_benchmark_that_is_given_as_a_scenario_is_named_with_its_option) {
    const Ended ended = clearway({"links", "evaluate", "eval_v1", "--out", "out"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("eval_v1: is a benchmark and not a scenario (allowed: names, folders or "
                                     "files of scenarios). Say --benchmark eval_v1"));
}

TEST_F(BadInputTest, an_empty_scenario_names_its_folder) {
    write("empty/scenario.toml", "");
    const Ended ended = clearway({"run", "./empty", "--out", "out"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("scenario in ./empty: name: is missing or empty"));
}

TEST_F(BadInputTest, weights_of_kinds_that_are_refused_are_not_called_0_too) {
    write_line_scenario();
    for (const char* const kinds : {"car=1e308,truck=1e308", "car=nan", "car=inf"}) {
        const Ended ended = clearway({"run", "line", "--kinds", kinds, "--out", "out"});
        EXPECT_EQ(ended.code, 3) << kinds;
        EXPECT_THAT(ended.err, AllOf(HasSubstr("--kinds car: "), HasSubstr("is out of range"),
                                     Not(HasSubstr("all weights are 0"))));
    }
    EXPECT_THAT(clearway({"run", "line", "--kinds", "car=0", "--out", "out"}).err,
                HasSubstr("--kinds: all weights are 0"));
}

TEST_F(BadInputTest, kinds_given_twice_are_refused) {
    write_line_scenario();
    const Ended ended = clearway({"run", "line", "--kinds", "car=8,truck=2,car=3", "--out", "out"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("--kinds car: is given twice"));
    EXPECT_THAT(clearway({"run", "line", "--emergency-kinds", "ambulance=1,ambulance=2", "--out", "out"}).err,
                HasSubstr("--emergency-kinds ambulance: is given twice"));
}

TEST_F(BadInputTest, fields_of_a_failure_are_checked_before_anything_runs) {
    write_line_scenario();
    const Ended ended = clearway({"run", "line", "--out", "out", "--failure",
                                  "B10,dark_share=1.5,onbord_range_m=50", "--policy", "dissertation"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("condition dissertation_B10_dark_share_1.5_onbord_range_m_50: "
                                           "failure `B10,dark_share=1.5,onbord_range_m=50`"),
                                 HasSubstr("Did you mean 'onboard_range_m'?")));
    const Ended data =
        clearway({"links", "dataset", "line", "--out", "data", "--samples", "--failure", "loss_rate=2"});
    EXPECT_EQ(data.code, 3);
    EXPECT_THAT(data.err, AllOf(HasSubstr("--failure `loss_rate=2`"), HasSubstr("2 is out of range")));
}

TEST_F(BadInputTest, seeds_below_0_settings_twice_and_names_of_paths_are_refused) {
    EXPECT_EQ(clearway({"run", "line", "--seed", "-1", "--out", "out"}).code, 2);
    const Ended twice = clearway({"run", "line", "--out", "out", "--set", "clear_lane.horizon_m=100", "--set",
                                  "clear_lane.horizon_m=200"});
    EXPECT_EQ(twice.code, 3);
    EXPECT_THAT(twice.err, HasSubstr("--set clear_lane.horizon_m: is given twice"));
    write_line_scenario();
    write("named.toml", "name = \"../z\"\nscenarios = [\"line\"]\nconditions = [\"baseline\"]\n");
    const Ended outside = clearway({"study", "named.toml", "--dry-run"});
    EXPECT_EQ(outside.code, 3);
    EXPECT_THAT(outside.err, HasSubstr("\"../z\" cannot be the name of a folder"));
}

TEST_F(BadInputTest, a_dry_run_checks_the_roads_too) {
    write_line_scenario();
    write("my.toml",
          "name = \"mine\"\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n"
          "[[condition]]\nname = \"aside\"\npolicy = [\"pull_over\"]\n");
    const Ended ended = clearway({"study", "my.toml", "--dry-run"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("condition aside, scenario line: pull_over needs a shoulder"));
    EXPECT_EQ(ended.out, "");
}

TEST_F(BadInputTest, a_dry_run_refuses_the_incidents_that_a_run_refuses) {
    write_line_scenario();
    write("my.toml", "name = \"mine\"\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n");
    const std::string wrong = "the network has no edge \"nowhere\"";
    std::vector<std::string> words = {"run",   "./line", "--seeds",    "1",
                                      "--out", "out",    "--incident", "edge=nowhere,from_s=5"};
    const Ended real = clearway(words);
    EXPECT_EQ(real.code, 3);
    EXPECT_THAT(real.err, HasSubstr(wrong));
    words.emplace_back("--dry-run");
    const Ended dry = clearway(words);
    EXPECT_EQ(dry.code, 3) << dry.out;
    EXPECT_EQ(dry.err, real.err);
    write("line/scenario.toml", read("line/scenario.toml") + "\n[[incident]]\nedge = \"nowhere\"\n");
    const Ended study = clearway({"study", "my.toml", "--dry-run"});
    EXPECT_EQ(study.code, 3);
    EXPECT_THAT(study.err, HasSubstr(wrong));
}

TEST_F(BadInputTest, a_dry_run_refuses_a_site_beside_the_roads) {
    ASSERT_EQ(clearway({"scenario", "init", "town", "--from", "city"}).code, 0);
    write("town/scenario.toml",
          read("town/scenario.toml") + "\n[[emergency_site]]\nkind = \"hospital\"\nedge = \"nowhere\"\n");
    std::vector<std::string> words = {"run", "./town", "--seeds", "1", "--out", "out"};
    const Ended real = clearway(words);
    EXPECT_EQ(real.code, 3);
    EXPECT_THAT(real.err, AllOf(HasSubstr("emergency_site["), HasSubstr("nowhere")));
    words.emplace_back("--dry-run");
    const Ended dry = clearway(words);
    EXPECT_EQ(dry.code, 3) << dry.out;
    EXPECT_EQ(dry.err, real.err);
}

TEST_F(BadInputTest, a_dry_run_refuses_counts_that_a_run_refuses) {
    for (const char* const row : {"third,200", "first,some"}) {
        write("line/counts.csv", std::string("edge,vehicles_per_hour\n") + row + "\n");
        const Ended real = run_changed("human = 5", "counts = \"counts.csv\"\nhuman = 5");
        EXPECT_EQ(real.code, 3) << real.err;
        const Ended dry = clearway({"run", "line", "--seeds", "1", "--out", "out", "--dry-run"});
        EXPECT_EQ(dry.code, 3) << dry.out;
        EXPECT_EQ(dry.err, real.err);
        EXPECT_EQ(dry.out, "");
    }
}

TEST_F(BadInputTest, a_dry_run_refuses_what_a_run_refuses) {
    write_line_scenario();
    write("my.toml", "name = \"mine\"\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n");
    write("rounds.toml",
          read("my.toml") + "[precision]\nmetric = \"emergency_travel_time_s\"\nhalf_width = 1.0\n");
    write("theirs", "a file");
    const std::vector<std::pair<std::vector<std::string>, int>> refused = {
        {{"run", "./line", "--pedestrians", "100"}, 3},
        {{"run", "./line", "--out", "/proc/x"}, 4},
        {{"run", "./line", "--out", "theirs/out"}, 4},
        {{"study", "my.toml", "--out", "/proc/x"}, 4},
        {{"study", "rounds.toml", "--shard", "1/2", "--out", "out"}, 3},
    };
    for (const auto& [words, code] : refused) {
        const Ended real = clearway(words);
        EXPECT_EQ(real.code, code) << real.err;
        std::vector<std::string> planned = words;
        planned.emplace_back("--dry-run");
        const Ended dry = clearway(planned);
        EXPECT_EQ(dry.code, code) << dry.out;
        EXPECT_EQ(dry.err, real.err);
        EXPECT_EQ(dry.out, "");
    }
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

TEST_F(BadInputTest, what_is_no_scenario_or_no_study_is_named_as_what_it_is) {
    write_line_scenario();
    write("x/parts.toml", "name = \"mine\"\nscenarios = [\"../line\"]\nconditions = [\"baseline\"]\n");
    write("town.osm.gz", "");
    const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
        {{"study", "line/scenario.toml"},
         "is a scenario (allowed: a study file (.toml)). `clearway run line`"},
        {{"study", "./line"}, "`clearway run ./line` runs it"},
        {{"study", "intersection"}, "intersection: is a scenario"},
        {{"study", "./x/party.toml"},
         "there is no such file (allowed: a study file (.toml)). Did you mean "
         "'./x/parts.toml'?"},
        {{"study", ""}, "the study: is an empty text"},
        {{"run", ""}, "the scenario: is an empty text"},
        {{"run", "x/parts.toml"}, "is a study file, not a scenario"},
        {{"scenario", "check", "twn.osm.gz"}, "twn.osm.gz: there is no such file"},
        {{"scenario", "check", "twn.osm.gz"}, "Did you mean 'town.osm.gz'?"},
        {{"scenario", "check", "no/map.osm"}, "`clearway scenario import FILE --name NAME` makes one"},
        {{"run", "./lin"}, "./lin: there is no such folder"},
        {{"run", "./lin"}, "Did you mean './line'?"},
        {{"scenario", "import", "twn.osm.gz", "--name", "twn"}, "Did you mean 'town.osm.gz'?"},
        {{"report", "xx"}, "Did you mean 'x'?"},
        {{"equip", "line/scenari.toml", "--budget", "1"}, "Did you mean 'line/scenario.toml'?"},
    };
    for (const auto& [words, said] : refused) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(said));
        EXPECT_LT(ended.err.size(), 400U) << ended.err;
    }
}

constexpr const char* planned_study =
    "name = \"mine\"\nseed = 77\nreplications = 2\nscenarios = [\"./line\"]\n"
    "conditions = [\"baseline\", \"corridor\", \"solo\"]\n[plan]\n[[plan.comparison]]\n"
    "name = \"it helps\"\ncondition = \"corridor\"\nagainst = \"baseline\"\n";

TEST_F(BadInputTest, a_planned_study_names_run_folders_that_it_cannot_read) {
    write_line_scenario();
    write("my.toml", planned_study);
    write("runs/old/manifest.json", "{\"format\": 3}");
    const Ended ended = clearway({"study", "my.toml", "--dry-run"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, AllOf(HasSubstr("clearway: warning: it is unknown whether seed 77 was run here: "),
                                 HasSubstr("runs/old/manifest.json: format: is 3")));
}

TEST_F(BadInputTest, a_planned_study_is_refused_after_a_look_at_its_seed_with_other_settings) {
    write_line_scenario();
    write("my.toml", planned_study);
    ASSERT_EQ(clearway({"study", "my.toml", "--out", "runs/first"}).code, 0);
    EXPECT_EQ(clearway({"study", "my.toml", "--dry-run"}).code, 0) << "the same study again";
    write("my.toml", planned_study + std::string("[overrides]\ndensity = 2\n"));
    for (const char* const out : {"runs/first", "runs/second"}) {
        for (std::vector<std::string> words : {std::vector<std::string>{"study"}, {"study", "submit"}}) {
            words.insert(words.end(), {"my.toml", "--out", out});
            const Ended ended = clearway(words);
            EXPECT_EQ(ended.code, 3) << words[1] << ' ' << out;
            EXPECT_THAT(ended.err, AllOf(HasSubstr("77 was used before, by"),
                                         HasSubstr("runs/first: different scenarios"),
                                         HasSubstr("take a seed that was never run")));
        }
    }
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs/second"));
}

TEST_F(BadInputTest, a_data_set_says_once_whether_exits_are_known) {
    write_line_scenario();
    const Ended ended = clearway({"links", "dataset", "line", "--out", "data", "--samples", "--failure",
                                  "B10,exits=unknown", "--exits", "known"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("--failure `B10,exits=unknown`"), HasSubstr("--exits unknown")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "data"));
}

TEST_F(BadInputTest, unknown_failure_predictor_and_policy_are_told_before_anything_runs) {
    write_line_scenario();
    const Ended ended = clearway({"run", "line", "--out", "out", "--failure", "B11", "--predictor",
                                  "dead_reckonin", "--policy", "disertation"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("`B11`"), HasSubstr("Did you mean 'dead_reckoning'?"),
                                 HasSubstr("Did you mean 'dissertation'?")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

TEST_F(BadInputTest, a_policy_part_that_is_there_twice_is_refused) {
    write_line_scenario();
    const Ended ended =
        clearway({"run", "line", "--out", "out", "--policy", "clear_lane", "corridor", "clear_lane"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("`clear_lane` is given twice"));
    const Ended part = clearway({"run", "line", "--out", "out", "--policy", "corridor", "preempt_signals"});
    EXPECT_EQ(part.code, 3);
    EXPECT_THAT(part.err, HasSubstr("`preempt_signals` is a part of `corridor` already"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

TEST_F(BadInputTest, an_unknown_condition_names_the_nearest) {
    const Ended ended = clearway({"run", "merge", "--condition", "graph_simulations"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("graph_simulation"));
}

TEST_F(BadInputTest, scenario_options_out_of_range_are_named_as_typed) {
    const Ended ended = clearway({"run", "merge", "--step-length", "2", "--av-share", "1.5"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("--step-length"), HasSubstr("--av-share"), HasSubstr("0 to 1")));
}

TEST_F(BadInputTest, report_of_a_folder_without_runs_is_refused) {
    const Ended ended = clearway({"report", "."});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("manifest.json"));
}

TEST_F(BadInputTest, compare_and_results_refuse_what_is_no_run_folder) {
    EXPECT_EQ(clearway({"compare", "."}).code, 3);
    const Ended ended = clearway({"export", "results", "."});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("manifest.json"));
    EXPECT_THAT(ended.out, IsEmpty());
}

TEST_F(BadInputTest, compare_names_unknown_metrics_and_tolerances_that_are_none) {
    const Ended metric = clearway({"compare", ".", "--metric", "emergency_travel_times_s"});
    EXPECT_EQ(metric.code, 3);
    EXPECT_THAT(metric.err, HasSubstr("Did you mean 'emergency_travel_time_s'?"));
    EXPECT_EQ(clearway({"compare", ".", "--tolerance", "colisions=1"}).code, 3);
    for (const std::string none : {"little", "-1", "nan", "collisions=", "collisions=1s"}) {
        const Ended ended = clearway({"compare", ".", "--tolerance=" + none});
        EXPECT_EQ(ended.code, 3) << none;
        EXPECT_THAT(ended.err, HasSubstr("--tolerance")) << none;
    }
    EXPECT_EQ(clearway({"report", ".", "--least-difference", "-1"}).code, 2);
    EXPECT_EQ(clearway({"export", "results", ".", "--csv", "--json"}).code, 2);
}

TEST_F(BadInputTest, init_refuses_a_folder_that_is_in_use) {
    write("mine/notes.txt", "keep me");
    const Ended ended = clearway({"scenario", "init", "mine"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_EQ(read("mine/notes.txt"), "keep me");
}

TEST_F(BadInputTest, a_run_folder_below_a_file_cannot_be_written) {
    write_line_scenario();
    write("plain.txt", "");
    const Ended ended = clearway({"run", "line", "--seeds", "1", "--out", "plain.txt/out"});
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.err, HasSubstr("plain.txt"));
}

TEST_F(BadInputTest, a_full_disk_exits_with_4_and_leaves_no_half_file) {
    write_line_scenario();
    // Files of at most 512 bytes: every longer write fails as on a full disk.
    const Ended ended =
        clearway({"run", "line", "--seeds", "1", "--out", "out"}, {.before = "trap '' XFSZ && ulimit -f 1"});
    EXPECT_EQ(ended.code, 4) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("out"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out" / "manifest.json"));
}

TEST_F(BadInputTest, a_small_stack_is_raised_or_refused) {
    EXPECT_EQ(clearway({"list"}, {.before = "ulimit -S -s 64"}).code, 0);
    const Ended ended = clearway({"list"}, {.before = "ulimit -s 512"});
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.err, HasSubstr("the stack is limited to 512 KiB (allowed: 1024 or more). Raise"));
}

TEST_F(BadInputTest, a_missing_netconvert_exits_with_4) {
    write_line_scenario();
    const Ended ended =
        clearway({"run", "line", "--seeds", "1", "--out", "out"},
                 {.environment = {{"PATH", folder().string()}, {"SUMO_HOME", folder().string()}}});
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.err, HasSubstr("netconvert does not start. Install the package sumo"));
    const Ended limited =
        clearway({"run", "line", "--seeds", "1", "--out", "out"},
                 {.environment = {{"PATH", folder().string()}, {"SUMO_HOME", folder().string()}},
                  .before = "ulimit -v 1000000000000"});
    EXPECT_EQ(limited.code, 4);
    EXPECT_THAT(limited.err,
                HasSubstr("netconvert does not start. Its memory is limited to 1000000000000 KiB"));
}

TEST_F(BadInputTest, a_netconvert_that_is_killed_is_not_blamed_on_the_network) {
    write_line_scenario();
    const std::filesystem::path killed = write("killed/netconvert", "#!/bin/sh\nkill -9 $$\n");
    std::filesystem::permissions(killed, std::filesystem::perms::owner_all);
    const Ended ended =
        clearway({"run", "line", "--seeds", "1", "--out", "out"},
                 {.environment = {{"PATH", killed.parent_path().string() + ":/usr/bin:/bin"}}});
    EXPECT_EQ(ended.code, 4) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("The machine failed: give the same command again"));
}

TEST_F(BadInputTest, a_published_data_set_is_one_snapshot) {
    const Ended ended = clearway({"links", "dataset", "merge", "--out", "data", "--seeds", "3"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("--seeds"), HasSubstr("--samples")));
    EXPECT_EQ(clearway({"links", "dataset", "merge", "--out", "data", "--samples", "--features", "2"}).code,
              2);
    EXPECT_EQ(clearway({"links", "dataset", "merge", "--out", "data", "--samples", "--failure", "B11"}).code,
              3);
    EXPECT_FALSE(std::filesystem::exists(folder() / "data"));
}

TEST_F(BadInputTest, a_scenario_whose_name_leads_out_of_the_folder_is_refused_by_every_verb) {
    write_line_scenario("name = \"line\"", "name = \"../../../OUTSIDE\"");
    write("my.toml", "scenarios = [\"./line\"]\nconditions = [\"baseline\"]\n");
    const std::vector<std::vector<std::string>> commands = {
        {"run", "line", "--seeds", "1", "--no-solo"},
        {"study", "my.toml"},
        {"links", "dataset", "line", "--samples"},
        {"links", "evaluate", "line", "--predictor", "last_seen"},
        {"equip", "line", "--budget", "1"}};
    for (std::vector<std::string> words : commands) {
        const std::string named = words[0] + " " + words[1];
        words.insert(words.end(), {"--out", "a/b/c/out"});
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3) << named;
        EXPECT_THAT(ended.err, AllOf(HasSubstr("line/scenario.toml:1:1: name"),
                                     HasSubstr("\"../../../OUTSIDE\" cannot be the name of a folder"),
                                     HasSubstr("allowed: 1 to 100 letters")))
            << named;
        EXPECT_FALSE(std::filesystem::exists(folder() / "a" / "OUTSIDE")) << named;
    }
}

}  // namespace
}  // namespace clearway::cli
