// Which signals to equip first, as a user asks for it.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <set>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "crossings.hpp"

namespace clearway::cli {
namespace {

/// Two crossings in a row, A and B, each with a signal; one emergency vehicle from west to east. It turns off
/// at A where `to` is a street there.
class EquipTest : public CrossingsTest {
  protected:
    Ended equip(std::vector<std::string> more, const std::string& folder = "out") const {
        std::vector<std::string> words = {"equip",   "./crossings", "--budget", "2",
                                          "--seeds", "5",           "--out",    folder};
        words.insert(words.end(), more.begin(), more.end());
        return clearway(words);
    }
    static double mean(const nlohmann::json& object, const std::string& name) {
        return object.at(name).at("mean").get<double>();
    }
};

/// Names below `folder/out` that begin so.
std::set<std::string> folders(const std::filesystem::path& out, const std::string& beginning) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(out)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(beginning)) names.insert(name);
    }
    return names;
}

/// Of a command behind `clearway`, without the marks of the shell.
std::vector<std::string> words_of_last_line(std::string text) {
    text = text.substr(text.rfind('\n', text.size() - 2) + 1);
    std::erase(text, '\'');
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
        words.push_back(word);
    words.erase(words.begin());
    return words;
}

TEST_F(EquipTest, ranks_signals_and_continues_in_its_folder_without_new_runs) {
    const Ended ended = equip({"--policy", "preempt_signals", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto json = nlohmann::json::parse(ended.out);
    EXPECT_EQ(json.at("signals"), 2);
    EXPECT_EQ(json.at("not_passed"), 0);
    EXPECT_EQ(json.at("fresh_seed"), 2);
    EXPECT_DOUBLE_EQ(mean(json, "none_equipped_s"), mean(json, "baseline_s"))
        << "a policy for signals does nothing where none is equipped";
    EXPECT_LT(mean(json, "all_equipped_s"), mean(json, "none_equipped_s"));
    EXPECT_EQ(json.at("candidates").size(), 2U);
    ASSERT_FALSE(json.at("ranked").empty());
    EXPECT_EQ(json.at("fresh_trips"), 5);
    EXPECT_EQ(json.at("fresh_trips_passing"), 5);
    EXPECT_DOUBLE_EQ(mean(json, "gain_of_passing_s"), mean(json.at("ranked").back(), "gain_so_far_s"))
        << "all pass";
    EXPECT_TRUE(json.at("gain_of_not_passing_s").is_null());
    EXPECT_EQ(json.at("events").at(0).at("event"), "Collisions");
    EXPECT_EQ(json.at("events").at(0).at("more").at("pairs"), 5);
    const auto& first_rank = json.at("ranked").front();
    EXPECT_DOUBLE_EQ(mean(first_rank, "gain_so_far_s"), mean(first_rank, "gain_s"));
    ASSERT_TRUE(first_rank.at("gain_so_far_s").at("low").is_number());
    if (json.at("ranked").size() == 2) {
        EXPECT_LE(first_rank.at("gain_s").at("low").get<double>(),
                  first_rank.at("gain_so_far_s").at("low").get<double>())
            << "of ranks together, of the curve each";
    }
    double so_far_s = 0.0;
    for (const auto& row : json.at("ranked")) {
        so_far_s += mean(row, "gain_s");
        EXPECT_NEAR(mean(row, "gain_so_far_s"), so_far_s, 1e-9);
        EXPECT_GT(mean(row, "gain_chosen_by_s"), 0.0);
    }
    if (json.at("ranked").size() == 2) {
        EXPECT_DOUBLE_EQ(mean(json.at("ranked").back(), "gain_so_far_s"),
                         mean(json.at("all"), "gain_so_far_s"));
    }
    EXPECT_THAT(read("out/equip.json"), ended.out);
    EXPECT_THAT(read("out/equip.csv"), HasSubstr("equipped,number,signal"));
    EXPECT_THAT(read("out/candidates.csv"), HasSubstr("number,signal,streets,share_of_trips,gain_s"));
    EXPECT_THAT(read("out/pairs.csv"), HasSubstr("\n1,2,")) << "A and B follow each other";
    EXPECT_THAT(read("out/curve.svg"), HasSubstr("<svg"));
    EXPECT_THAT(read("out/map.svg"), HasSubstr("Two crossings: which signals to equip first"));
    EXPECT_EQ(clearway({"export", "figures", "out", "--out", "figures", "--svg-only"}).err,
              "clearway: written to figures: 2 figures as SVG\n");
    EXPECT_EQ(read("figures/map.svg"), read("out/map.svg"));
    EXPECT_EQ(clearway({"export", "figures", "out", "--out", "figures", "--svg-only"}).code, 0);
    std::filesystem::create_directory(folder() / "theirs");
    write("theirs/map.svg", "mine");
    EXPECT_EQ(clearway({"export", "figures", "out", "--out", "theirs", "--svg-only"}).code, 3);
    EXPECT_EQ(read("theirs/map.svg"), "mine");
    EXPECT_THAT(read("out/report.html"), HasSubstr("<section id=\"equipment\">"));
    const std::string none = "out/round-01/runs/crossings/preempt_signals_none_equipped/00000/run.json";
    const auto made = std::filesystem::last_write_time(folder() / none);
    const Ended again = equip({"--policy", "preempt_signals"});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(std::filesystem::last_write_time(folder() / none), made);
    auto same = nlohmann::json::parse(read("out/equip.json"));
    same.at("command") = json.at("command");  // that of this time has no --json
    EXPECT_EQ(same, json);
    EXPECT_THAT(again.out, AllOf(HasSubstr("Two crossings"), HasSubstr("Equip first: ")));
    EXPECT_EQ(clearway({"report", "out"}).out, again.out);
    const Ended study = clearway(words_of_last_line(again.out));
    EXPECT_EQ(study.code, 0) << study.err;
    EXPECT_THAT(study.out, HasSubstr("chosen"));
    const Ended round = clearway({"report", "out/round-01"});
    EXPECT_EQ(round.code, 3);
    EXPECT_THAT(round.err, HasSubstr("its runs are no study. The answer: clearway report out\n"));
    const std::string fresh = *folders(folder() / "out", "fresh-").begin();
    EXPECT_THAT(
        clearway({"report", "out/" + fresh}).out,
        AllOf(HasSubstr("preempt_signals: none equipped"), HasSubstr("preempt_signals: all equipped"),
              testing::ContainsRegex("preempt_signals: #[12] equipped"), Not(HasSubstr("_equipped"))));
}

TEST_F(EquipTest, shows_one_progress_and_takes_over_fresh_runs_where_the_budget_grows) {
    const Ended one = clearway({"equip", "./crossings", "--budget", "1", "--seeds", "5", "--out", "out"});
    ASSERT_EQ(one.code, 0) << one.err;
    EXPECT_THAT(one.err,
                AllOf(HasSubstr("runs: 40/40"), Not(HasSubstr("15/15")), Not(HasSubstr("runs into"))));
    const std::set<std::string> first = folders(folder() / "out", "fresh-");
    ASSERT_EQ(first.size(), 1U);
    const std::string baseline = "/runs/crossings/baseline/00003/run.json";
    const Ended two = equip({});
    ASSERT_EQ(two.code, 0) << two.err;
    for (const std::string& fresh : folders(folder() / "out", "fresh-"))
        EXPECT_TRUE(std::filesystem::equivalent(folder() / "out" / (*first.begin() + baseline),
                                                folder() / "out" / (fresh + baseline)))
            << "linked, not made again";
}

TEST_F(EquipTest, says_before_it_runs_how_many_runs_it_makes) {
    const Ended dry = equip({"--dry-run", "--json"});
    ASSERT_EQ(dry.code, 0) << dry.err;
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
    const auto json = nlohmann::json::parse(dry.out);
    EXPECT_EQ(json.at("candidates"), 2);
    EXPECT_DOUBLE_EQ(json.at("share_of_trips_with_signals").get<double>(), 1.0);
    EXPECT_DOUBLE_EQ(json.at("signals_per_trip").get<double>(), 2.0);
    // None, each alone and both together on 5 seeds, once more at the second place; then baseline, none, all,
    // alone and two ranks.
    EXPECT_EQ(json.at("runs"), 20 + 5 + 30);
    EXPECT_EQ(json.at("most_runs"), 55);
    EXPECT_EQ(json.at("held_runs"), 0);
    EXPECT_GT(json.at("estimated_time_s").get<double>(), 0.0);
    EXPECT_FALSE(json.at("estimate_measured").get<bool>());
    const auto made = nlohmann::json::parse(equip({"--json"}).out);
    EXPECT_LE(made.at("runs"), json.at("most_runs"));
    if (made.at("ranked").size() == 2) {
        EXPECT_EQ(made.at("runs"), json.at("runs"));
    }
    const auto again = nlohmann::json::parse(equip({"--dry-run", "--json"}).out);
    EXPECT_EQ(again.at("held_runs"), made.at("runs"));
    const Ended text = equip({"--dry-run"});
    EXPECT_THAT(text.out,
                testing::ContainsRegex(
                    "^100 % of the EVs' [0-9]+ trips that decide pass at least one\\ssignal; a\\strip"));
    EXPECT_THAT(text.out, testing::ContainsRegex("average\\.\nBy programs and trips alone, preemption"));
    EXPECT_THAT(text.out,
                testing::ContainsRegex(
                    "55 runs likely, 55 at most, of --seeds 5, into out, which\\sholds\\s[0-9]+\\sof\\s"));
    EXPECT_THAT(
        text.out,
        testing::ContainsRegex(
            "Little\\sto\\srank\\son\\sthis\\smap:\\s2\\sare\\snearly\\sall\\sof\\sits\\s2\\ssignals"));
    EXPECT_THAT(text.out, testing::ContainsRegex("for the rest with .*from runs of\\sthese scenarios"));
    std::istringstream lines(text.out);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 80U) << line;
}

TEST_F(EquipTest, refuses_a_folder_that_cannot_be_written_before_it_plans) {
    for (const char* const word : {"--json", "--dry-run"}) {
        const Ended ended = clearway({"equip", "./crossings", "--budget", "1", "--out", "/proc/x", word});
        EXPECT_EQ(ended.code, 4) << ended.out;
        EXPECT_THAT(ended.err, HasSubstr("/proc/x: cannot write"));
    }
}

TEST_F(EquipTest, says_before_it_runs_what_a_quarter_of_an_hour_would_do) {
    clearway({"scenario", "check", "./crossings"});
    const auto plan = [&](double run_s, const std::string& candidates = "2", const std::string& seeds = "8") {
        auto costs = nlohmann::json::parse(read("runs/run-costs.json"));
        costs.front().front() = run_s;
        write("runs/run-costs.json", costs.dump());
        std::string text = clearway({"equip", "./crossings", "--budget", "2", "--seeds", seeds, "--dry-run",
                                     "--jobs", "1", "--out", "runs/equip", "--candidates", candidates})
                               .out;
        std::ranges::replace(text, '\n', ' ');
        return text;
    };
    // None, each alone and both together on 5 seeds.
    EXPECT_THAT(plan(1.0),
                AllOf(HasSubstr("Nothing can be told before about 0:20 (m:s)."), HasSubstr("runs likely"),
                      HasSubstr("(m:s)"), Not(HasSubstr("15 minutes")), Not(HasSubstr("smallest plan"))));
    // None and each alone on 5 seeds; then baseline, none, all, alone and one rank.
    EXPECT_THAT(
        plan(900.0 / 40.0),
        HasSubstr(
            "A first look, within 15 minutes: --seeds 5 --budget 1. So few seeds show large gains alone."));
    EXPECT_THAT(
        plan(23.0),
        HasSubstr("The smallest plan with intervals, of 2 candidates, takes about 15:20 "
                  "(m:s): --seeds 5 --budget 1. So few seeds show large gains alone. Fewer --candidates "
                  "take less."));
    EXPECT_THAT(plan(400.0, "1"),
                AllOf(HasSubstr("intervals, of 1 candidate, takes about"), HasSubstr("(h:m:s): --seeds 5"),
                      Not(HasSubstr("Fewer --candidates"))));
    // With fewer seeds than an interval needs
    EXPECT_THAT(
        plan(400.0, "2", "3"),
        HasSubstr("The smallest plan with intervals, of 2 candidates, "
                  "takes about 4:26:40 (h:m:s): --seeds 5 --budget 1. So few seeds show large gains alone."));
}

TEST_F(EquipTest, chooses_its_seeds_by_the_time_that_is_given) {
    const auto planned = [&](const std::string& time) {
        return clearway({"equip", "./crossings", "--budget", "1", "--dry-run", "--within", time});
    };
    const Ended short_time = planned("1s");
    EXPECT_THAT(short_time.err, AllOf(HasSubstr("the least, 5 seeds, takes about"), HasSubstr("is made"),
                                      Not(HasSubstr("allow"))));
    EXPECT_THAT(short_time.err, AllOf(HasSubstr("all the same; fewer --candidates take less"),
                                      Not(HasSubstr("smaller --budget"))));
    EXPECT_THAT(short_time.out, AllOf(Not(HasSubstr("A first look")), Not(HasSubstr("smallest plan"))));
    const Ended long_time = planned("5min");
    EXPECT_EQ(long_time.code, 0);
    EXPECT_THAT(long_time.err, Not(HasSubstr("the least")));
    EXPECT_THAT(long_time.err, testing::ContainsRegex("--seeds [0-9]{2,}\n"));
    EXPECT_NE(clearway({"equip", "./crossings", "--budget", "1", "--within", "5min", "--seeds", "5"}).code,
              0);
    for (const double given_s : {20.0, 30.0, 120.0}) {
        const auto json =
            nlohmann::json::parse(clearway({"equip", "./crossings", "--budget", "2", "--dry-run", "--jobs",
                                            "1", "--within", fmt::format("{}s", given_s), "--json"})
                                      .out);
        EXPECT_LE(json.at("estimated_time_s").get<double>(), given_s) << "of the seeds that it chose";
        EXPECT_GT(json.at("estimated_time_s").get<double>(), 0.5 * given_s);
    }
}

TEST_F(EquipTest, names_the_seeds_that_it_chose_in_place_of_the_time) {
    const Ended ended = clearway({"equip", "./crossings", "--budget", "1", "--within", "1s", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto json = nlohmann::json::parse(ended.out);
    ASSERT_EQ(json.at("replications"), 5);
    const std::string command = "clearway equip ./crossings --budget 1 --json --seeds 5";
    EXPECT_EQ(json.at("command"), command);
    const std::string out = "runs/" + *folders(folder() / "runs", "equip-").begin();
    EXPECT_THAT(read(out + "/report.html"), AllOf(HasSubstr(command), Not(HasSubstr("--within"))));
    const std::string hint = out + " holds the same search with 5 seeds: --seeds 5 continues it\n";
    const auto planned = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"equip", "./crossings", "--budget", "1", "--dry-run", "--json"};
        words.insert(words.end(), more.begin(), more.end());
        return clearway(words);
    };
    const Ended other = planned({"--within=30s"});
    EXPECT_THAT(other.err, HasSubstr(hint));
    EXPECT_GT(nlohmann::json::parse(other.out).at("replications"), 5);
    EXPECT_THAT(planned({"--seeds", "5"}).err, Not(HasSubstr("holds the same"))) << "it is this one";
    EXPECT_THAT(planned({"--seeds", "6"}).err, HasSubstr(hint));
    EXPECT_THAT(planned({"--seeds", "6", "--seed", "9"}).err, Not(HasSubstr("holds the same")));
    EXPECT_THAT(planned({"--seeds", "6", "--policy", "preempt_signals"}).err,
                Not(HasSubstr("holds the same")));
}

/// A search of many runs, interrupted once the second look and more runs than before have begun.
class InterruptedEquipTest : public EquipTest {
  protected:
    Ended interrupted(const std::vector<std::string>& amount = {"--seeds", "100"}) const {
        const std::size_t before = runs_of_later_looks();
        std::vector<std::string> words = {"equip", "./crossings", "--budget", "1", "--out", "out"};
        words.insert(words.end(), amount.begin(), amount.end());
        const core::Child child = start(words);
        const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (runs_of_later_looks() == before && std::chrono::steady_clock::now() < patience)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        ::kill(child.pid, SIGINT);
        return finish(child);
    }

  private:
    std::size_t runs_of_later_looks() const {
        const std::filesystem::path out = folder() / "out";
        std::size_t count = 0;
        if (!std::filesystem::exists(out)) return count;
        for (const std::string& round : folders(out, "round-")) {
            if (round == "round-01" || !std::filesystem::exists(out / round / "runs")) continue;
            for (const auto& scenario : std::filesystem::directory_iterator(out / round / "runs"))
                for (const auto& condition : std::filesystem::directory_iterator(scenario))
                    count += folders(condition, "0").size();
        }
        return count;
    }
};

TEST_F(InterruptedEquipTest, prints_what_the_last_look_knew) {
    const Ended ended = interrupted();
    EXPECT_EQ(ended.code, 130);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("no ranking yet; the last complete look, "), HasSubstr("  #1"),
                                 HasSubstr("  #2"), HasSubstr("To continue:")));
    const Ended report = clearway({"report", "out"});
    EXPECT_EQ(report.code, 0) << report.err;
    EXPECT_THAT(report.out, AllOf(HasSubstr("no ranking yet"), HasSubstr("  #1")));
    EXPECT_EQ(clearway({"report", "out", "--json"}).code, 3) << "there is no answer";
    EXPECT_THAT(clearway({"export", "figures", "out", "--out", "figures"}).err,
                HasSubstr("a search by clearway equip that has no answer yet"));
}

TEST_F(InterruptedEquipTest, continues_with_the_seeds_that_a_time_allowed) {
    const Ended ended = interrupted({"--within", "2min"});
    EXPECT_EQ(ended.code, 130);
    EXPECT_THAT(ended.err,
                testing::ContainsRegex(
                    "To continue:\n  clearway equip ./crossings --budget 1 --out out --seeds [0-9]+\n"));
}

TEST_F(InterruptedEquipTest, keeps_an_answer_and_says_that_it_was_interrupted_where_nothing_can_be_written) {
    ASSERT_EQ(interrupted().code, 130);
    write("out/equip.txt", "an answer\n");
    write("out/equip.json", "{}\n");
    const Ended over_answer = interrupted();
    EXPECT_EQ(over_answer.code, 130);
    EXPECT_THAT(over_answer.err, HasSubstr("no ranking yet"));
    EXPECT_EQ(read("out/equip.txt"), "an answer\n") << "as equip.json has it";
    std::filesystem::remove(folder() / "out/equip.json");
    std::filesystem::remove(folder() / "out/equip.txt");
    std::filesystem::create_directory(folder() / "out/equip.txt");
    const Ended unwritable = interrupted();
    EXPECT_EQ(unwritable.code, 130) << unwritable.err;
    EXPECT_THAT(unwritable.err,
                AllOf(HasSubstr("no ranking yet"), HasSubstr("cannot write"), HasSubstr("To continue:")));
}

TEST_F(EquipTest, prints_a_command_that_runs_whatever_the_order_of_the_words) {
    const auto study = [&](const std::vector<std::string>& words, const std::string& out) {
        std::vector<std::string> command = {"equip", "--budget", "1", "--seeds", "5", "--out", out};
        command.insert(command.end(), words.begin(), words.end());
        const Ended ended = clearway(command);
        EXPECT_EQ(ended.code, 0) << ended.err;
        std::vector<std::string> printed = words_of_last_line(ended.out);
        const std::string text = fmt::format("{}", fmt::join(printed, " "));
        printed.insert(printed.end(), {"--seeds", "2", "--out", out + "-study"});
        const Ended ran = clearway(printed);
        EXPECT_EQ(ran.code, 0) << text << ran.err;
        return text.substr(0, text.find(" --seed "));
    };
    EXPECT_EQ(study({"./crossings", "--policy", "corridor", "--name", "mine"}, "named"),
              "run ./crossings --policy corridor --name chosen");
    const std::string kept = "run ./crossings --policy corridor --set privilege.pass_red=0 --name chosen";
    EXPECT_EQ(study({"./crossings", "--policy", "corridor", "--set", "actuation.equipped=A",
                     "privilege.pass_red=0"},
                    "first"),
              kept);
    EXPECT_EQ(study({"--policy", "corridor", "--set=privilege.pass_red=0", "actuation.equipped=A", "--name=m",
                     "./crossings"},
                    "last"),
              kept);
}

TEST_F(EquipTest, keeps_the_options_of_the_command_in_that_of_the_study) {
    const Ended ended = clearway({"equip", "./crossings", "--budget", "1", "--seeds", "12", "--jobs", "1",
                                  "--memory-limit", "9000", "--density", "0.5", "--out", "out"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(
        fmt::format("{}", fmt::join(words_of_last_line(ended.out), " ")),
        HasSubstr("run ./crossings --jobs 1 --memory-limit 9000 --density 0.5 --condition corridor --name "
                  "chosen --seed 3 --seeds 12 --set"));
    EXPECT_THAT(ended.err, Not(HasSubstr("say little of signals")));
}

TEST_F(EquipTest, warns_after_the_first_round_of_runs_that_say_little_with_a_command_for_less_traffic) {
    const std::vector<std::string> short_horizon = {"--horizon", "90", "--density", "0.5"};
    EXPECT_THAT(equip({"--dry-run"}).out, HasSubstr("--lock-trials 6"));
    const Ended ended = equip(short_horizon);
    const std::string calmer =
        "clearway equip ./crossings --budget 2 --seeds 5 --out out-density-0.4 --horizon 90 "
        "--density 0.4";
    EXPECT_THAT(ended.err,
                testing::ContainsRegex("In the first round [0-9]+ EVs? did not arrive: such runs"));
    EXPECT_THAT(ended.err, HasSubstr("\n  " + calmer + "\n"));
    EXPECT_LT(ended.err.find(calmer), ended.err.find("fresh seeds")) << "before the rest is run";
    std::vector<std::string> dry = short_horizon;
    dry.emplace_back("--dry-run");
    EXPECT_THAT(equip(dry).out, AllOf(HasSubstr("In the first round"), HasSubstr("--density 0.4"),
                                      Not(HasSubstr("--lock-trials"))));
}

TEST_F(EquipTest, tries_only_the_signals_that_cost_most_red_where_that_is_wanted) {
    const Ended ended = equip({"--candidates", "1", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto json = nlohmann::json::parse(ended.out);
    ASSERT_EQ(json.at("candidates").size(), 1U);
    EXPECT_EQ(json.at("candidates").at(0).at("signal"), "A") << "of equal ones the first";
    EXPECT_DOUBLE_EQ(json.at("candidates").at(0).at("share_of_trips").get<double>(), 1.0);
    EXPECT_EQ(json.at("less_red"), 1);
    // All EVs pass both; A has 49 s of red in 90 s, from now on B has 69 s in 110 s.
    std::string net = read("crossings/net.net.xml");
    const std::string cross_green = "<phase duration=\"41\" state=\"GGGgrrrrGGGgrrrr\"/>";
    const std::size_t place = net.find(cross_green, net.find("<tlLogic id=\"B\""));
    ASSERT_NE(place, std::string::npos);
    net.replace(place, cross_green.size(), "<phase duration=\"61\" state=\"GGGgrrrrGGGgrrrr\"/>");
    write("crossings/net.net.xml", net);
    const Ended longer = equip({"--candidates", "1", "--json"}, "longer");
    ASSERT_EQ(longer.code, 0) << longer.err;
    EXPECT_EQ(nlohmann::json::parse(longer.out).at("candidates").at(0).at("signal"), "B");
    EXPECT_THAT(nlohmann::json::parse(longer.out).at("outlook"), HasSubstr("By programs and trips alone"));
}

TEST_F(EquipTest, does_not_report_a_gain_where_every_request_is_lost) {
    const Ended lost =
        equip({"--policy", "preempt_signals", "--set", "failure.signal_request_propagation=sharp", "--set",
               "failure.signal_request_loss_rate=1", "--json"});
    ASSERT_EQ(lost.code, 0) << lost.err;
    const auto json = nlohmann::json::parse(lost.out);
    EXPECT_THAT(json.at("ranked"), IsEmpty());
    EXPECT_EQ(json.at("end"), "no_gain");
    ASSERT_EQ(json.at("candidates").size(), 2U);
    for (const auto& row : json.at("candidates")) {
        EXPECT_DOUBLE_EQ(mean(row, "gain_s"), 0.0);
        EXPECT_FALSE(row.at("shown").get<bool>());
    }
}

TEST_F(EquipTest, leaves_out_signals_that_no_emergency_vehicle_passes_or_that_are_switched_off) {
    write_scenario("A_north_a");
    const auto turned = nlohmann::json::parse(equip({"--json"}).out);
    EXPECT_EQ(turned.at("not_passed"), 1);
    EXPECT_EQ(turned.at("candidates").size(), 1U);
    EXPECT_LE(turned.at("ranked").size(), 1U);
    ASSERT_EQ(clearway({"scenario", "signals", "./crossings", "--out", "p.csv"}).code, 0);
    const std::string text = read("p.csv");
    write("crossings/p.csv", text.substr(0, text.find('\n') + 1) + "A,0,,,,,,,,,,\n");
    write_scenario("A_north_a", "preemption = \"p.csv\"\n");
    const Ended none = equip({"--json"}, "off");
    ASSERT_EQ(none.code, 0) << none.err;
    const auto json = nlohmann::json::parse(none.out);
    EXPECT_EQ(json.at("switched_off"), 1);
    EXPECT_TRUE(json.at("ranked").empty());
    EXPECT_EQ(json.at("end"), "exhausted");
}

TEST_F(EquipTest, may_take_a_run_for_that_of_a_set_without_the_signals_that_nobody_passes) {
    write_scenario("A_north_a");
    const auto time_with = [&](const std::string& equipped, const std::string& name) {
        const Ended ended =
            clearway({"run", "./crossings", "--policy", "corridor", "--set", "actuation.equipped=" + equipped,
                      "--name", name, "--seeds", "1", "--out", name});
        EXPECT_EQ(ended.code, 0) << ended.err;
        return nlohmann::json::parse(read(name + "/runs/crossings/" + name + "/00000/run.json"))
            .at("metrics");
    };
    EXPECT_EQ(time_with("A", "first"), time_with("A,B", "both")) << "they turn off before B";
    EXPECT_EQ(time_with("none", "without"), time_with("B", "second"));
    EXPECT_NE(time_with("none", "without2"), time_with("A", "first2"));
}

TEST_F(EquipTest, lets_every_condition_pass_red_where_that_is_set) {
    const Ended ended = clearway({"equip", "./crossings", "--budget", "1", "--seeds", "2", "--out", "out",
                                  "--set", "privilege.pass_red=1"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, AllOf(HasSubstr("EVs of the"), HasSubstr("may pass"),
                                 Not(HasSubstr("--set privilege.pass_red=1)"))));
    for (const std::string& part : folders(folder() / "out", "round-")) {
        const auto manifest = nlohmann::json::parse(read("out/" + part + "/manifest.json"));
        for (const auto& condition : manifest.at("conditions"))
            EXPECT_EQ(condition.at("settings").at("privilege.pass_red"), "1") << condition;
    }
}

TEST_F(EquipTest, starts_from_what_is_equipped_today) {
    const Ended ended = equip({"--set", "actuation.equipped=A", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto found = nlohmann::json::parse(ended.out);
    EXPECT_EQ(found.at("equipped_today"), nlohmann::json({"A"}));
    ASSERT_EQ(found.at("candidates").size(), 1U);
    EXPECT_EQ(found.at("candidates")[0].at("signal"), "B");
    EXPECT_THAT(read("out/report.html"), AllOf(HasSubstr("Equipped today: A; EVs pass 1 of them."),
                                               HasSubstr("Gains count from those equipped today.")));
    std::set<std::string> sets;
    const auto manifest = nlohmann::json::parse(read("out/round-01/manifest.json"));
    for (const auto& condition : manifest.at("conditions"))
        sets.insert(condition.value("settings", nlohmann::json::object()).value("actuation.equipped", ""));
    EXPECT_THAT(read("out/map.svg"), HasSubstr("equipped today"));
    EXPECT_EQ(clearway({"report", "out", "--json"}).out, ended.out);
    EXPECT_THAT(clearway({"report", "out"}).out,
                AllOf(HasSubstr("Two crossings"),
                      HasSubstr("clearway run ./crossings --condition corridor --name chosen --seed 3 --set"),
                      HasSubstr("actuation.equipped=A,#2")));
    EXPECT_THAT(sets, testing::UnorderedElementsAre("", "A", "A,B")) << "the first is the baseline";
}

TEST_F(EquipTest, refuses_what_has_no_answer_and_leaves_nothing_behind) {
    const auto refused = [&](const std::vector<std::string>& words, int code, const std::string& message) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, code) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(message));
        EXPECT_THAT(ended.out, IsEmpty());
        EXPECT_FALSE(std::filesystem::exists(folder() / "runs"));
    };
    refused({"equip", "./crossings"}, 2, "--budget");
    refused({"equip", "./crossings", "--budget", "0"}, 2, "--budget");
    refused({"equip", "./crossings", "--budget", "1.5"}, 2, "--budget");
    refused({"equip", "./crossings", "--budget", "-1"}, 2, "--budget");
    refused({"equip", "./crossings", "--budget", "1", "--seeds", "1"}, 2, "--seeds");
    refused({"equip", "./crossings", "--budget", "1", "--seeds", "1001"}, 2, "--seeds");
    refused({"equip", "./crossings", "--budget", "1", "--policy", "clear_lane"}, 3,
            "has no policy that requests green from signals");
    refused({"equip", "./crossings", "--budget", "1", "--condition", "baseline"}, 3,
            "has no policy that requests green from signals");
    for (const char* const all : {"actuation.equipped=all", "actuation.equipped=A,B"})
        refused({"equip", "./crossings", "--budget", "1", "--set", all}, 3,
                "says that every signal is equipped today");
    refused({"equip", "./crossings", "--budget", "1", "--set", "actuation.equipped=C"}, 3, "no signal 'C'");
    write_line_scenario();
    refused({"equip", "line", "--budget", "1"}, 3, "has no signals");
}

TEST_F(EquipTest, refuses_a_folder_of_another_question) {
    ASSERT_EQ(equip({}).code, 0);
    const std::string before = read("out/equip.json");
    const Ended other = equip({"--seed", "9"});
    EXPECT_EQ(other.code, 3);
    EXPECT_THAT(other.err, HasSubstr("holds another study"));
    EXPECT_EQ(read("out/equip.json"), before);
    const Ended planned = equip({"--seed", "9", "--dry-run"});
    EXPECT_EQ(planned.code, 3) << planned.out;
    EXPECT_EQ(planned.err, other.err);
    EXPECT_EQ(equip({"--dry-run"}).code, 0) << "the same question";
}

TEST_F(EquipTest, refuses_a_folder_with_anything_else_and_a_policy_that_nobody_knows) {
    const Ended scenario = equip({"--policy", "preempt_signals"}, "crossings");
    EXPECT_EQ(scenario.code, 3);
    EXPECT_THAT(scenario.err, HasSubstr("crossings holds something else"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "crossings/round-01"));
    const Ended unknown = equip({"--policy", "coridor"});
    EXPECT_EQ(unknown.code, 3);
    EXPECT_THAT(unknown.err, HasSubstr("Did you mean 'corridor'?"));
}

TEST_F(EquipTest, has_a_setting_of_its_own_that_names_the_nearest_signal) {
    const Ended ended =
        clearway({"run", "./crossings", "--policy", "corridor", "--set", "actuation.equipped=A,C", "--name",
                  "mine", "--seeds", "1", "--out", "run"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("actuation.equipped"), HasSubstr("no signal 'C'")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "run"));
}

}  // namespace
}  // namespace clearway::cli
