// What the program says about itself.
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

const std::vector<std::string> every_verb = {"run",    "study",    "report", "compare", "export",
                                             "verify", "replay",   "live",   "attach",  "equip",
                                             "links",  "scenario", "list",   "python",  "doctor"};

/// The verbs and their parts, as `study` and `study status`.
const std::vector<std::vector<std::string>> every_command = [] {
    std::vector<std::vector<std::string>> all = {
        {"study", "status"},     {"study", "submit"},        {"study", "merge"},     {"export", "figures"},
        {"export", "results"},   {"export", "trajectories"}, {"links", "dataset"},   {"links", "train"},
        {"links", "evaluate"},   {"scenario", "init"},       {"scenario", "import"}, {"scenario", "check"},
        {"scenario", "signals"}, {"python", "environment"}};
    for (const std::string& verb : every_verb)
        all.push_back({verb});
    return all;
}();

std::vector<std::string> with_help(std::vector<std::string> words) {
    words.emplace_back("--help");
    return words;
}

class HelpTest : public UserTest {};

/// Options of a help text, each with its description, which may go on over lines.
std::vector<std::string> options_in(const std::string& help) {
    std::vector<std::string> options;
    std::istringstream lines(help);
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        const bool begins = line.starts_with("  -");
        if (begins) options.push_back(line);
        if (!begins && inside && line.starts_with("    ")) options.back() += line;
        inside = begins || (inside && line.starts_with("    "));
    }
    return options;
}

TEST_F(HelpTest, names_every_verb_and_the_exit_codes) {
    const Ended help = clearway({"--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.err, IsEmpty());
    for (const std::string& verb : every_verb) {
        EXPECT_THAT(help.out, HasSubstr("  " + verb + " "));
    }
    EXPECT_THAT(help.out, AllOf(HasSubstr("3 bad input"), HasSubstr("130")));
}

TEST_F(HelpTest, of_every_verb_shows_an_example_and_a_default_for_each_option_with_a_value) {
    const std::regex flag("^  -[-a-z,]+(  |$)");
    for (const std::vector<std::string>& command : every_command) {
        const std::string verb = core::shell_text(command);
        if (verb == "links train" && !has_trainer()) continue;
        const Ended help = clearway(with_help(command));
        EXPECT_EQ(help.code, 0) << verb;
        EXPECT_THAT(help.out, testing::ContainsRegex("Examples?:")) << verb;
        if (verb == "links train") continue;  // the trainer prints its own help
        EXPECT_THAT(help.out, HasSubstr("clearway " + verb)) << verb;
        for (const std::string& option : options_in(help.out)) {
            if (std::regex_search(option, flag)) continue;
            EXPECT_TRUE(option.find('[') != std::string::npos ||
                        option.find("(required)") != std::string::npos)
                << verb << " does not tell the default of:\n"
                << option;
        }
    }
}

TEST_F(HelpTest, of_every_verb_and_the_list_fit_80_columns) {
    std::vector<std::vector<std::string>> calls = {{"--help"}, {"list"}};
    for (const std::vector<std::string>& command : every_command)
        if (command.back() != "train" || has_trainer()) calls.push_back(with_help(command));
    for (const std::vector<std::string>& call : calls) {
        std::istringstream lines(clearway(call).out);
        std::size_t count = 0;
        for (std::string line; std::getline(lines, line); ++count) {
            const std::size_t begin = line.find_first_not_of(' ');
            const bool is_one_word =
                line.find(' ', begin == std::string::npos ? 0 : begin) == std::string::npos;
            EXPECT_TRUE(line.size() <= 80U || is_one_word) << call.front() << ": " << line;
        }
        EXPECT_GT(count, 3U) << call.front();
    }
}

TEST_F(HelpTest, continues_a_long_example_so_that_it_can_be_copied) {
    const std::string run = clearway({"run", "--help"}).out;
    EXPECT_THAT(run, HasSubstr("  clearway run intersection --dense"));
    EXPECT_THAT(clearway({"--help"}).out, HasSubstr("\nUsage: clearway"));
    EXPECT_THAT(run, testing::ContainsRegex(" \\\\\n      [-a-z]"));
}

TEST_F(HelpTest, tells_units_where_an_option_has_one) {
    const std::string run = clearway({"run", "--help"}).out;
    for (const std::string& option : options_in(run)) {
        for (const char* const timed : {"--warm-up", "--horizon", "--step-length"}) {
            if (option.find(timed) == std::string::npos) continue;
            EXPECT_THAT(option, HasSubstr(" s ["));
        }
        if (option.find("--road-limit") == std::string::npos) continue;
        EXPECT_THAT(option, HasSubstr("km/h"));
    }
    EXPECT_THAT(run, AllOf(HasSubstr("--step-length"), HasSubstr("--road-limit")));
    EXPECT_THAT(clearway({"links", "dataset", "--help"}).out, testing::ContainsRegex("--interval SECONDS"));
}

TEST_F(HelpTest, version_is_told_with_the_build_as_the_worker_does) {
    const Ended version = clearway({"--version"});
    EXPECT_EQ(version.code, 0);
    EXPECT_THAT(version.out, testing::MatchesRegex("clearway [0-9.]+\nbuild [0-9a-f]+\n"));
}

TEST_F(HelpTest, a_usage_line_marks_what_can_be_repeated_or_left_out) {
    EXPECT_THAT(clearway({"list", "--help"}).out, HasSubstr("Usage: clearway list [OPTIONS] [what...]\n"));
    EXPECT_THAT(clearway({"replay", "--help"}).out, HasSubstr("replay [OPTIONS] run...\n"));
    EXPECT_THAT(clearway({"verify", "--help"}).out, HasSubstr("verify [OPTIONS] run\n"));
}

TEST_F(HelpTest, the_word_help_is_the_option) {
    EXPECT_EQ(clearway({"help"}).out, clearway({"--help"}).out);
    EXPECT_EQ(clearway({"help", "study", "status"}).out, clearway({"study", "status", "--help"}).out);
    EXPECT_THAT(clearway({"help", "studdy"}).err, HasSubstr("Did you mean 'study'?"));
}

TEST_F(HelpTest, the_version_is_told_wherever_it_is_asked_for) {
    const Ended version = clearway({"--version"});
    EXPECT_THAT(version.out, HasSubstr("build "));
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"-V"}, {"version"}, {"run", "--version"}, {"run", "merge", "--version"}}) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 0) << ended.err;
        EXPECT_EQ(ended.out, version.out) << core::shell_text(words);
    }
}

TEST_F(HelpTest, options_of_other_programs_and_places_name_the_way_here) {
    EXPECT_THAT(clearway({"run", "merge", "-q"}).err, HasSubstr("2>/dev/null hides"));
    EXPECT_THAT(clearway({"study", "--seeds", "3", "x.toml"}).err, HasSubstr("replications = 30"));
    EXPECT_THAT(clearway({"run", "merge", "--replications", "3"}).err, HasSubstr("Did you mean '--seeds'?"));
    EXPECT_THAT(clearway({"scenario", "check", "merge", "--seeds", "3"}).err, Not(HasSubstr("'--seed'")));
    EXPECT_THAT(clearway({"list", "settings", "lead_s"}).err,
                HasSubstr("Did you mean 'preempt_signals.lead_s'?"));
    EXPECT_EQ(clearway({"list", "settings", "preempt_signals.lead_s"}).out,
              clearway({"list", "settings", "preempt_signals"}).out);
}

TEST_F(HelpTest, a_word_that_should_be_a_number_is_told_from_a_number_out_of_range) {
    EXPECT_THAT(clearway({"run", "merge", "--seeds", "x"}).err,
                HasSubstr("--seeds: x is no whole number (allowed: 1 to 100000)"));
    EXPECT_THAT(clearway({"run", "merge", "--predictor", "gcn", "--predictor", "gat"}).err,
                HasSubstr("--predictor: is given 2 times (allowed: once)"));
    EXPECT_THAT(
        clearway({"run", "merge", "--predictor", "gcn", "gat"}).err,
        HasSubstr("gat is a second predictor, and a condition has one. A study file compares several"));
    EXPECT_THAT(clearway({"run", "merge", "B10"}).err, HasSubstr("did you mean '--failure B10'?"));
    EXPECT_THAT(clearway({"run", "merge", "--failure", "B10", "B40"}).err,
                HasSubstr("B40 is a second failure"));
    for (const char* const seed : {"9223372036854775808", "18446744073709551616", "99999999999999999999"})
        EXPECT_THAT(clearway({"run", "merge", "--seed", seed}).err,
                    HasSubstr(std::string(seed) + " is out of range"));
    EXPECT_THAT(clearway({"run", "merge", "--seeds", "0100001"}).err, HasSubstr("100001 is out of range"));
    EXPECT_THAT(clearway({"run", "merge", "--seeds", "0x10"}).err, HasSubstr("0x10 is"));
    EXPECT_THAT(clearway({"run", "merge", "--seeds", "0"}).err,
                HasSubstr("--seeds: 0 is out of range (allowed: 1 to 100000)"));
}

TEST_F(HelpTest, an_unknown_verb_names_the_nearest) {
    const Ended ended = clearway({"compaer"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("Did you mean 'compare'?"));
    EXPECT_THAT(ended.out, IsEmpty());
}

TEST_F(HelpTest, a_part_of_a_verb_is_found_without_the_verb_and_with_another) {
    EXPECT_THAT(clearway({"status", "out"}).err,
                HasSubstr("`status` is not a verb. Did you mean 'study status'?"));
    EXPECT_THAT(clearway({"links", "figurs"}).err,
                HasSubstr("`links figurs` is not a verb. Did you mean 'export figures'?"));
    EXPECT_THAT(clearway({"scenario", "zzz"}).err, HasSubstr("verbs are init, import, check, signals"));
}

TEST_F(HelpTest, a_word_that_is_nearly_a_part_and_no_file_names_the_part) {
    const Ended ended = clearway({"study", "statuss", "runs/mine"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("`study statuss` is not a verb, and statuss is not a file. Did you mean "
                                     "'study status'?"));
    EXPECT_THAT(clearway({"python", "environmnt"}).err, HasSubstr("Did you mean 'python environment'?"));
    write("statuss", "seeed = 4");
    EXPECT_THAT(clearway({"study", "statuss"}).err, HasSubstr("statuss:1:")) << "a file of this name is read";
}

TEST_F(HelpTest, reproduce_names_the_study_file_of_the_dissertation) {
    const Ended ended = clearway({"reproduce"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("Did you mean 'study studies/dissertation.toml'?"));
}

TEST_F(HelpTest, flags_that_json_excludes_are_named_with_it) {
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"list", "settings", "--json", "--markdown"},
                                               {"list", "settings", "--json", "--reasons"},
                                               {"export", "results", "out", "--json", "--list"},
                                               {"replay", "out/a/b/0", "--json", "--csv", "belief"},
                                               {"replay", "out/a/b/0", "--json", "--view"}}) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 2) << core::shell_text(words);
        EXPECT_THAT(ended.err, HasSubstr("--json excludes --")) << core::shell_text(words);
        EXPECT_THAT(ended.out, IsEmpty());
    }
}

TEST_F(HelpTest, a_study_asks_for_its_file_and_its_parts_for_their_own) {
    EXPECT_THAT(clearway({"study"}).err, HasSubstr("clearway study: file is required"));
    EXPECT_THAT(clearway({"study", "status"}).err, HasSubstr("clearway study status: folder is required"));
}

TEST_F(HelpTest, no_verb_lists_them) {
    const Ended ended = clearway({});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("study"), HasSubstr("doctor")));
}

TEST_F(HelpTest, an_unknown_option_names_the_nearest) {
    const Ended ended = clearway({"run", "merge", "--densty", "2"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("--densty"), HasSubstr("Did you mean '--density'?")));
}

TEST_F(HelpTest, a_word_too_many_is_refused) {
    const Ended ended = clearway({"report", "one", "two"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("two"));
}

TEST_F(HelpTest, a_missing_argument_is_named) {
    const Ended ended = clearway({"run"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("scenario"), HasSubstr("`clearway run --help`")));
}

TEST_F(HelpTest, negative_and_fractional_counts_are_refused) {
    for (const char* const seeds : {"-3", "0", "2.5", "100001", "many"}) {
        const Ended ended = clearway({"run", "merge", "--seeds", seeds});
        EXPECT_EQ(ended.code, 2) << seeds;
        EXPECT_THAT(ended.err, AllOf(HasSubstr("--seeds"), HasSubstr(seeds)));
    }
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs"));
}

TEST_F(HelpTest, numbers_that_are_not_finite_are_refused) {
    const std::vector<std::vector<std::string>> calls = {
        {"links", "dataset", "merge", "--out", "data", "--samples", "--interval"},
        {"run", "merge", "--out", "out", "--run-time-limit"},
        {"report", "out", "--least-difference"}};
    for (const std::vector<std::string>& call : calls) {
        for (const char* const number : {"nan", "inf", "-inf"}) {
            std::vector<std::string> words = call;
            words.emplace_back(number);
            const Ended ended = clearway(words);
            EXPECT_EQ(ended.code, 2) << call.back();
            EXPECT_THAT(ended.err, AllOf(HasSubstr(call.back()), HasSubstr(number), HasSubstr("allowed: 0")));
        }
    }
    EXPECT_FALSE(std::filesystem::exists(folder() / "data"));
}

TEST_F(HelpTest, list_shows_what_can_be_named) {
    const Ended list = clearway({"list"});
    EXPECT_EQ(list.code, 0) << list.err;
    for (const char* const name :
         {"merge", "intersection", "city", "bologna", "baseline", "graph_graphsage", "solo", "perfect", "B10",
          "dead_reckoning", "graphsage_corrected", "listing_5_5", "dissertation"}) {
        EXPECT_THAT(list.out, HasSubstr(std::string("  ") + name + " "));
    }
    EXPECT_THAT(list.err, IsEmpty());
}

TEST_F(HelpTest, list_as_json_has_units_in_the_names_of_parameters) {
    const auto list = nlohmann::json::parse(clearway({"list", "--json"}).out);
    for (const char* const key : {"scenarios", "conditions", "failures", "predictors", "policies"}) {
        EXPECT_FALSE(list.at(key).empty()) << key;
    }
    for (const auto& failure : list["failures"]) {
        if (failure["name"] != "B10") continue;
        EXPECT_EQ(failure["parameters"]["mean_outage_s"], 10.0);
    }
}

TEST_F(HelpTest, reference_pages_are_those_that_are_committed) {
    for (const std::string page : {"settings", "columns", "scenario-keys"}) {
        const std::filesystem::path file =
            std::filesystem::path(CLEARWAY_SOURCE_DIR) / "docs" / "reference" / (page + ".md");
        EXPECT_EQ(core::read_file(file), clearway({"list", page, "--markdown"}).out)
            << "renew it: clearway list " << page << " --markdown > docs/reference/" << page << ".md";
        EXPECT_THAT(clearway({"list", page}).out, HasSubstr("emergency"));
        EXPECT_FALSE(nlohmann::json::parse(clearway({"list", page, "--json"}).out).empty());
    }
}

TEST_F(HelpTest, settings_are_a_line_each_and_have_reasons_where_they_are_asked_for) {
    const auto count = [](const std::string& text) { return std::ranges::count(text, '\n'); };
    const std::string lines = clearway({"list", "settings", "failure"}).out;
    EXPECT_THAT(lines,
                AllOf(HasSubstr("failure.loss_rate"), HasSubstr("--reasons"), Not(HasSubstr("Why: "))));
    EXPECT_LE(count(lines), 60);
    const std::string reasons = clearway({"list", "settings", "failure", "--reasons"}).out;
    EXPECT_THAT(reasons, AllOf(HasSubstr("failure.loss_rate"), HasSubstr("Why: ")));
    EXPECT_THAT(clearway({"list", "settings", "corridor"}).out,
                AllOf(HasSubstr("clearway list settings clear_lane"), Not(HasSubstr("lead_s"))));
    EXPECT_EQ(clearway({"list", "columns", "--reasons"}).code, 3);
}

TEST_F(HelpTest, a_list_that_is_unknown_is_told_the_nearest) {
    const Ended ended = clearway({"list", "colums"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("settings, columns, scenario-keys"), HasSubstr("Did you mean 'columns'?")));
    EXPECT_EQ(clearway({"list", "--markdown"}).code, 3);
    EXPECT_EQ(clearway({"list", "columns", "more"}).code, 3);
}

TEST_F(HelpTest, full_standard_output_exits_with_4) {
    const Ended ended = clearway({"list"}, {.output = "/dev/full"});
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.err, HasSubstr("clearway: "));
}

TEST_F(HelpTest, doctor_finds_this_machine_fit) {
    const Ended ended = clearway({"doctor", "--json"});
    EXPECT_EQ(ended.code, 0) << ended.out;
    for (const auto& check : nlohmann::json::parse(ended.out)) {
        EXPECT_TRUE(check["passed"] || !check["required"]) << check;
    }
}

/// A `clearway` without its trainer beside it, as where nobody has trained yet.
TEST_F(HelpTest, without_the_trainer_train_says_what_to_do_and_doctor_finds_all_else_fit) {
    for (const char* const program : {"clearway", "clearway-run"})
        std::filesystem::copy(std::filesystem::path(CLEARWAY_BINARY_DIR) / "bin" / program, folder());
    const core::Exit trained =
        core::run({folder() / "clearway", {"links", "train", "graphsage"}, {}, folder() / "train.txt"});
    EXPECT_EQ(trained.code, 4);
    const core::Exit helped =
        core::run({folder() / "clearway", {"links", "train", "--help"}, {}, folder() / "help.txt"});
    EXPECT_EQ(helped.code, 0);
    EXPECT_THAT(read("help.txt"), AllOf(HasSubstr("Usage: clearway links train NET"), HasSubstr("graphsage"),
                                        HasSubstr("is not built"), HasSubstr("Example:")));
    EXPECT_THAT(read("train.txt"),
                AllOf(HasSubstr("clearway-train is not built"), HasSubstr("./clearway links train")));
    const core::Exit fit = core::run({folder() / "clearway", {"doctor"}, {}, folder() / "doctor.txt"});
    EXPECT_EQ(fit.code, 0);
    EXPECT_THAT(read("doctor.txt"), AllOf(testing::ContainsRegex("missing +clearway-train"),
                                          HasSubstr("./clearway links train")));
}

TEST_F(HelpTest, doctor_tells_a_missing_sumo) {
    const Ended ended = clearway({"doctor"}, {.environment = {{"PATH", folder().string()}}});
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.out, AllOf(testing::ContainsRegex("MISSING +sumo +missing"),
                                 HasSubstr("Install the packages sumo")));
}

TEST_F(HelpTest, doctor_tells_another_version_of_sumo) {
    write_program("sumo", "Eclipse SUMO sumo Version 1.20.0");
    const Ended ended =
        clearway({"doctor"}, {.environment = {{"PATH", folder().string() + ":" + std::getenv("PATH")}}});
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.out, AllOf(testing::ContainsRegex("UNFIT +sumo +.*1.20.0"), HasSubstr("SUMO 1.15")));
}

TEST_F(HelpTest, doctor_tells_a_missing_sumo_home) {
    const Ended ended = clearway({"doctor"}, {.environment = {{"SUMO_HOME", "/nowhere"}}});
    EXPECT_EQ(ended.code, 4);
    EXPECT_THAT(ended.out, testing::ContainsRegex("UNFIT +SUMO_HOME +/nowhere"));
}

}  // namespace
}  // namespace clearway::cli
