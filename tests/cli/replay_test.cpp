// Recordings, as a user meets them.
#include <cstdlib>
#include <sstream>
#include <tuple>

#include <nlohmann/json.hpp>

#include "recorded_run.hpp"

namespace clearway::cli {
namespace {

using testing::StartsWith;

using ReplayTest = RecordedRunTest;

TEST_F(ReplayTest, a_recorded_run_comes_out_again_and_another_predictor_can_be_asked) {
    ASSERT_EQ(run({"--record"}).code, 0);
    const Ended same = clearway({"replay", recording, "--json"});
    ASSERT_EQ(same.code, 0) << same.err;
    const auto exact = nlohmann::json::parse(same.out);
    for (const char* const what : {"observations", "beliefs", "leases"}) {
        const auto& agreement = exact.at("same_to_the_bit").at(what);
        EXPECT_EQ(agreement.at("same"), agreement.at("compared")) << what;
        EXPECT_GT(agreement.at("compared"), 20) << what;
    }
    EXPECT_EQ(exact.at("recorded").at("links"), exact.at("replayed").at("links"));
    EXPECT_GT(exact.at("replayed").at("leases"), 0);

    const Ended other = clearway({"replay", recording, "--predictor", "dead_reckoning"});
    EXPECT_EQ(other.code, 0) << other.err;
    EXPECT_THAT(other.out, AllOf(HasSubstr("does not react"), HasSubstr("dead_reckoning"),
                                 HasSubstr("dark links: recall"), HasSubstr("first difference at ")));
}

TEST_F(ReplayTest, recording_changes_no_result_and_adds_what_a_complete_folder_lacks) {
    ASSERT_EQ(run().code, 0);
    const std::string before = read("out/runs/line/mine/00000/run.json");
    EXPECT_FALSE(std::filesystem::exists(folder() / recording));
    ASSERT_EQ(run({"--record"}).code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder() / recording));
    EXPECT_EQ(read("out/runs/line/mine/00000/run.json"), before);
    const std::string bytes = read(recording);
    ASSERT_EQ(run({"--record"}).code, 0);
    EXPECT_EQ(read(recording), bytes);
}

TEST_F(ReplayTest, a_run_or_two_side_by_side_become_one_page) {
    ASSERT_EQ(run({"--record"}).code, 0);
    const Ended one = clearway({"replay", run_of_mine, "--view"});
    ASSERT_EQ(one.code, 0) << one.err;
    EXPECT_EQ(one.out, "line-mine-0.html\n");
    EXPECT_THAT(one.err, HasSubstr("written: line-mine-0.html, 0."));
    EXPECT_THAT(read("line-mine-0.html"), testing::HasSubstr("script-src 'sha256-"));
    const Ended two =
        clearway({"replay", "out/line/baseline/0", run_of_mine, "--view", "--out", "both.html"});
    ASSERT_EQ(two.code, 0) << two.err;
    EXPECT_THAT(read("both.html"), testing::HasSubstr("line/baseline/0 and line/mine/0"));
    EXPECT_THAT(two.err, testing::Not(testing::HasSubstr("have different traffic")));
    EXPECT_GT(read("both.html").size(), read("line-mine-0.html").size());
    const Ended cut = clearway({"replay", run_of_mine, "--view", "--to", "30", "--out", "cut.html"});
    ASSERT_EQ(cut.code, 0) << cut.err;
    EXPECT_LT(read("cut.html").size(), read("line-mine-0.html").size());
}

TEST_F(ReplayTest, neither_a_page_nor_trajectories_take_the_place_of_something_else) {
    ASSERT_EQ(run({"--record"}).code, 0);
    const std::vector<std::string> others = {"out/manifest.json", recording, "out/report.html"};
    for (const std::string& file : others) {
        const std::string before = read(file);
        const Ended ended = clearway({"replay", run_of_mine, "--view", "--out", file});
        EXPECT_EQ(ended.code, 3) << file;
        EXPECT_THAT(ended.err,
                    HasSubstr(file + ": is there already (allowed: a new file, or a page of clearway "
                                     "replay --view). Choose another name, or remove it"));
        EXPECT_EQ(read(file), before) << file;
    }
    for (int time = 0; time < 2; ++time) {
        EXPECT_EQ(clearway({"replay", run_of_mine, "--view", "--out", "page.html"}).code, 0) << time;
        EXPECT_EQ(clearway({"export", "trajectories", run_of_mine, "--out", "ways"}).code, 0) << time;
    }
    std::filesystem::create_directory(folder() / "theirs");
    write("theirs/trajectories.csv", "years");
    const Ended ended = clearway({"export", "trajectories", run_of_mine, "--out", "theirs"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err,
                HasSubstr("--out: theirs holds something else (allowed: a new or empty folder, or one "
                          "of clearway export trajectories)"));
    EXPECT_EQ(read("theirs/trajectories.csv"), "years");
    EXPECT_FALSE(std::filesystem::exists(folder() / "theirs/sumo"));
}

TEST_F(ReplayTest, two_runs_with_other_traffic_go_side_by_side_with_a_word) {
    ASSERT_EQ(clearway({"run", "line", "--seeds", "2", "--no-solo", "--record", "--out", "out"}).code, 0);
    const Ended two =
        clearway({"replay", "out/line/baseline/0", "out/line/corridor/1", "--view", "--out", "both.html"});
    ASSERT_EQ(two.code, 0) << two.err;
    EXPECT_THAT(two.err,
                HasSubstr("line/baseline/0 (seed 1) and line/corridor/1 (seed 1) have different traffic"));
}

TEST_F(ReplayTest, times_that_are_none_are_refused) {
    ASSERT_EQ(run({"--record"}).code, 0);
    for (const char* const time : {"nan", "inf", "-1", "soon", "1e99"}) {
        for (const char* const option : {"--from", "--to"}) {
            const Ended ended = clearway({"replay", run_of_mine, "--view", option, time});
            EXPECT_EQ(ended.code, 2) << option << " " << time;
            EXPECT_THAT(ended.err, AllOf(HasSubstr(option), HasSubstr("allowed: 0 to 1000000000")));
        }
    }
    const Ended swapped = clearway({"replay", run_of_mine, "--view", "--from", "9", "--to", "8"});
    EXPECT_EQ(swapped.code, 3);
    EXPECT_THAT(swapped.err, HasSubstr("Swap them"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "line-mine-0.html"));
}

TEST_F(ReplayTest, bad_input_of_a_page_is_told) {
    ASSERT_EQ(run({"--record"}).code, 0);
    const Ended without = clearway({"replay", run_of_mine, run_of_mine});
    EXPECT_EQ(without.code, 3);
    EXPECT_THAT(without.err, testing::HasSubstr("two with --view"));
    EXPECT_EQ(clearway({"replay", run_of_mine, "--view", "--predictor", "none"}).code, 2);
    EXPECT_EQ(clearway({"replay", run_of_mine, "--view", "--csv", "links"}).code, 2);
    EXPECT_EQ(clearway({"replay", run_of_mine, "--out", "page.html"}).code, 2);
    const Ended window = clearway({"replay", run_of_mine, "--view", "--from", "9000"});
    EXPECT_EQ(window.code, 3);
    EXPECT_THAT(window.err, testing::HasSubstr("no recorded step lies in the window"));
    EXPECT_EQ(clearway({"replay", run_of_mine, "--view", "--out", "none/page.html"}).code, 4);
    const std::string whole = read(recording);
    core::write_atomically(folder() / recording, whole.substr(0, whole.size() / 2));
    const auto refused = [&](const std::string& of, const std::string& said) {
        const Ended ended = clearway({"replay", of, "--view", "--out", "page.html"});
        EXPECT_EQ(ended.code, 3) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(said));
        EXPECT_FALSE(std::filesystem::exists(folder() / "page.html"));
    };
    refused(run_of_mine, "cut short");
    std::string other = whole;
    const std::size_t format = other.find_first_of("0123456789");
    other.replace(format, 1, "9");
    core::write_atomically(folder() / recording, other);
    refused(run_of_mine, "format 9");
    ASSERT_EQ(clearway({"run", "city", "--seeds", "1", "--no-solo", "--record", "--run-time-limit", "0.001",
                        "--out", "failed"})
                  .code,
              1);
    refused("failed/city/corridor/0", "has no recording failed/recordings/city/corridor/00000.h5");
}

TEST_F(ReplayTest, a_report_shows_the_median_best_and_worst_trip_when_asked) {
    ASSERT_EQ(clearway({"run", "line", "--seeds", "3", "--out", "out", "--no-solo", "--policy",
                        "dissertation", "--name", "mine"})
                  .code,
              0);
    EXPECT_THAT(read("out/report.html"), testing::Not(testing::HasSubstr("id=\"replays\"")));
    const std::string before = read("out/runs.csv");
    const Ended made = clearway({"report", "out", "--replays"});
    ASSERT_EQ(made.code, 0) << made.err;
    const std::string report = read("out/report.html");
    EXPECT_LT(report.size(), 5'000'000U);
    for (const char* const part :
         {"id=\"replays\"", "script-src 'sha256-", "line: the median trip", "line: the best trip",
          "line: the worst trip", "\"condition\":\"baseline\"", "\"title\":\"Baseline\""})
        EXPECT_THAT(report, testing::HasSubstr(part));
    EXPECT_EQ(read("out/runs.csv"), before) << "the runs that were made again gave the same records";
    EXPECT_FALSE(std::filesystem::exists(folder() / "out/recordings")) << "they are not recorded for good";

    ASSERT_EQ(clearway({"report", "out"}).code, 0);
    EXPECT_EQ(read("out/report.html"), report) << "later reports keep them";
    const Ended unknown = clearway({"report", "out", "--condition", "Our"});
    EXPECT_EQ(unknown.code, 3);
    EXPECT_THAT(unknown.err, AllOf(HasSubstr("`Our` is unknown"), HasSubstr("Baseline; mine")));
    EXPECT_THAT(unknown.out, IsEmpty());
    const Ended baseline = clearway({"report", "out", "--condition", "baseline"});
    EXPECT_EQ(baseline.code, 3);
    EXPECT_THAT(baseline.err, HasSubstr("compared with nothing"));
    const std::string stored = read("out/replays.html");
    core::write_atomically(folder() / "out/replays.html", "<!-- clearway replays 0 -->\n" + stored);
    const Ended stale = clearway({"report", "out"});
    EXPECT_THAT(stale.err, testing::HasSubstr("no longer matches the results"));
    EXPECT_THAT(read("out/report.html"), testing::Not(testing::HasSubstr("id=\"replays\"")));
}

TEST_F(ReplayTest, a_report_shows_trips_of_the_condition_that_was_chosen_by_its_title) {
    write("study.toml",
          "name = \"two\"\nreplications = 2\nscenarios = [\"./line\"]\nconditions = [\"baseline\"]\n"
          "[[condition]]\nname = \"own\"\npolicy = [\"corridor\"]\n"
          "[factors]\ncondition.failure = [\"perfect\", \"B10\"]\n[titles]\nown = \"Ours\"\n"
          "B10 = \"outages\"\n");
    ASSERT_EQ(clearway({"study", "study.toml", "--out", "out"}).code, 0);
    for (const char* const title : {"Ours, outages", "Ours, perfect sensors"}) {
        const Ended made = clearway({"report", "out", "--replays", "--condition", title});
        ASSERT_EQ(made.code, 0) << made.err;
        const std::string report = read("out/report.html");
        EXPECT_THAT(report, AllOf(HasSubstr(std::string("\"title\":\"") + title + "\""),
                                  HasSubstr(std::string(" with ") + title + "\""),
                                  HasSubstr("Shown by your choice.")));
        ASSERT_EQ(clearway({"report", "out", "--condition", title}).code, 0);
        EXPECT_EQ(read("out/report.html"), report) << "later reports keep them";
        ASSERT_EQ(clearway({"report", "out"}).code, 0);
        EXPECT_THAT(read("out/report.html"), AllOf(HasSubstr(std::string(" with ") + title + "\""),
                                                   testing::Not(HasSubstr("by your choice"))));
        ASSERT_EQ(
            clearway({"export", "figures", "out", "--out", "figures", "--svg-only", "--condition", title})
                .code,
            0);
        EXPECT_THAT(read("figures/trip-line.csv"), HasSubstr(title));
    }
}

TEST_F(ReplayTest, tables_of_a_window_are_csv) {
    ASSERT_EQ(run({"--record"}).code, 0);
    for (const char* const table : {"snapshot", "signals", "events", "observation", "belief", "leases"}) {
        const Ended ended = clearway({"replay", recording, "--csv", table});
        EXPECT_EQ(ended.code, 0) << ended.err;
        EXPECT_THAT(ended.out, StartsWith("time_s,"));
    }
    const Ended window = clearway({"replay", recording, "--csv", "snapshot", "--from", "20", "--to", "21"});
    ASSERT_EQ(window.code, 0) << window.err;
    std::istringstream lines(window.out);
    std::string line;
    std::getline(lines, line);
    EXPECT_THAT(line, HasSubstr("speed_mps,lane,lane_position_m"));
    int count = 0;
    for (; std::getline(lines, line); ++count)
        EXPECT_THAT(std::stod(line), AllOf(testing::Ge(20.0), testing::Le(21.0)));
    EXPECT_GT(count, 2);
}

TEST_F(ReplayTest, the_failure_log_tells_who_was_dark_and_what_links_that_cost) {
    ASSERT_EQ(run({"--record"}).code, 0);
    const auto lines = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"replay", recording, "--csv", "failures"};
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 0) << ended.err;
        EXPECT_THAT(ended.out, StartsWith("time_s,what,vehicle,other_vehicle,cause\n"));
        return ended.out;
    };
    const std::string log = lines({});
    EXPECT_THAT(log, AllOf(HasSubstr(",dark,"), HasSubstr(",lost_link,"), Not(HasSubstr(",never_seen"))));
    EXPECT_THAT(lines({"--failure", "connected_share=0.2"}),
                AllOf(HasSubstr(",never_seen,human"), HasSubstr(",never_seen\n")));
    EXPECT_EQ(lines({"--failure", "perfect"}), "time_s,what,vehicle,other_vehicle,cause\n");
    EXPECT_GT(lines({"--failure", "B10,dark_share=0.8"}).size(), 2 * log.size());
    const Ended refused = clearway({"replay", recording, "--csv", "links", "--failure", "B20"});
    EXPECT_EQ(refused.code, 3);
    EXPECT_THAT(refused.err, HasSubstr("--csv failures"));
}

/// `time_s,vehicle,x_m,y_m` of each line, by the columns' names; reals as the floats that they name.
std::vector<std::tuple<double, std::string, float, float>> positions(
    const std::string& csv, const std::vector<std::size_t>& columns) {
    std::vector<std::tuple<double, std::string, float, float>> found;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');)
            cells.push_back(cell);
        if (cells.front() == "time_s") continue;
        found.emplace_back(std::stod(cells.at(columns[0])), cells.at(columns[1]),
                           std::stof(cells.at(columns[2])), std::stof(cells.at(columns[3])));
    }
    return found;
}

TEST_F(ReplayTest, a_recording_is_read_by_python) {
    if (std::system("/usr/bin/python3 -c 'import h5py' 2> /dev/null") != 0)
        GTEST_SKIP() << "python3-h5py is not installed";
    ASSERT_EQ(run({"--record"}).code, 0);
    const std::string out = (folder() / "positions.csv").string();
    ASSERT_EQ(std::system(("/usr/bin/python3 " CLEARWAY_SOURCE_DIR "/tests/trace/read_with_h5py.py " +
                           (folder() / recording).string() + " > " + out)
                              .c_str()),
              0);
    const auto expected = positions(clearway({"replay", recording, "--csv", "snapshot"}).out, {0, 1, 4, 5});
    ASSERT_GT(expected.size(), 100U);
    EXPECT_EQ(positions(read("positions.csv"), {0, 1, 2, 3}), expected);
}

TEST_F(ReplayTest, bad_input_of_replay_is_told) {
    ASSERT_EQ(run({"--record"}).code, 0);
    const Ended none = clearway({"replay", "none.h5"});
    EXPECT_EQ(none.code, 3);
    EXPECT_THAT(none.err, HasSubstr("none.h5"));
    const Ended name = clearway({"replay", recording, "--predictor", "dead_reckonin"});
    EXPECT_EQ(name.code, 3);
    EXPECT_THAT(name.err, HasSubstr("Did you mean 'dead_reckoning'?"));
    const Ended window = clearway({"replay", recording, "--csv", "belief", "--from", "9000"});
    EXPECT_EQ(window.code, 3);
    EXPECT_THAT(window.err, HasSubstr("allowed: "));
    EXPECT_EQ(clearway({"replay", recording, "--csv", "belief", "--from", "9", "--to", "8"}).code, 3);
    EXPECT_EQ(clearway({"replay", recording, "--from", "9"}).code, 3);
    EXPECT_EQ(clearway({"replay", recording, "--csv", "belifs"}).code, 2);
    EXPECT_EQ(clearway({"replay", recording, "--csv", "belief", "--predictor", "none"}).code, 2);
    std::filesystem::copy_file(folder() / recording, folder() / "moved.h5");
    const Ended moved = clearway({"replay", "moved.h5"});
    EXPECT_EQ(moved.code, 3);
    EXPECT_THAT(moved.err, HasSubstr("--network"));
    EXPECT_EQ(
        clearway({"replay", "moved.h5", "--network", "out/scenarios/line/network/network.net.xml"}).code, 0);
    const std::string network = "out/scenarios/line/network/network.net.xml";
    core::write_atomically(folder() / network, read(network) + "\n");
    const Ended other = clearway({"replay", recording});
    EXPECT_EQ(other.code, 3);
    EXPECT_THAT(other.err, HasSubstr("is not the network"));
    std::filesystem::resize_file(folder() / recording, 300);
    const Ended cut = clearway({"replay", recording, "--network", network});
    EXPECT_EQ(cut.code, 3);
    EXPECT_THAT(cut.err, AllOf(HasSubstr("00000.h5"), HasSubstr("cut short")));
}

TEST_F(ReplayTest, settings_that_only_a_run_uses_are_refused) {
    ASSERT_EQ(run({"--record"}).code, 0);
    for (const char* const setting : {"actuation.hold_cap_s=30", "siren.audible_m=50"}) {
        const Ended ended = clearway({"replay", recording, "--set", setting});
        EXPECT_EQ(ended.code, 3) << setting;
        const std::string name = std::string(setting).substr(0, std::string(setting).find('='));
        EXPECT_THAT(ended.err, AllOf(HasSubstr("--set " + name + ": changes nothing in a replay"),
                                     HasSubstr("settings of loop, failure"), HasSubstr("clearway run")));
    }
    EXPECT_EQ(clearway({"replay", recording, "--set", "dissertation.lease_s=3"}).code, 0);
    const Ended sensors =
        clearway({"replay", recording, "--csv", "failures", "--set", "dissertation.lease_s=3"});
    EXPECT_EQ(sensors.code, 3);
    EXPECT_THAT(sensors.err, AllOf(HasSubstr("changes nothing in the failure log"),
                                   HasSubstr("allowed: settings of failure)")));
}

TEST_F(ReplayTest, a_run_has_one_name_for_every_verb) {
    ASSERT_EQ(run({"--record"}).code, 0);
    const Ended replayed = clearway({"replay", run_of_mine});
    EXPECT_EQ(replayed.code, 0) << replayed.err;
    EXPECT_THAT(replayed.out, StartsWith(run_of_mine + ": "));
    const Ended verified = clearway({"verify", run_of_mine});
    EXPECT_EQ(verified.code, 0) << verified.err;
    EXPECT_THAT(verified.out, testing::ContainsRegex("same +" + run_of_mine + "  "));
    const Ended written = clearway({"export", "trajectories", run_of_mine, "--out", "ways"});
    EXPECT_EQ(written.code, 0) << written.err;
    EXPECT_THAT(written.out, StartsWith(run_of_mine + ": "));
    ASSERT_EQ(clearway({"verify", "out/line/Ours, by title/0"}).code, 3);
    write("out/titles.json", R"({"mine":"Ours, by title"})");
    const Ended titled = clearway({"export", "trajectories", "out/line/Ours, by title/0", "--out", "titled"});
    EXPECT_EQ(titled.code, 0) << titled.err;
    EXPECT_EQ(titled.out.substr(0, titled.out.find(':')), run_of_mine);
    EXPECT_EQ(clearway({"replay", "out/line/Ours, by title/0"}).code, 0);
    EXPECT_EQ(clearway({"replay", "out/line/Ours, by title/0", "--view"}).code, 0);
    EXPECT_EQ(clearway({"verify", "out/line/Ours, by title/0"}).code, 0);
    for (const std::string verb : {"replay", "verify", "export trajectories"}) {
        const auto of = [&](const char* run) {
            return verb.starts_with("export") ? std::vector<std::string>{"export", "trajectories", run}
                                              : std::vector<std::string>{verb, run};
        };
        const Ended unknown = clearway(of("out/lin/mime/3"));
        EXPECT_EQ(unknown.code, 3) << verb;
        EXPECT_THAT(unknown.err, AllOf(HasSubstr("Did you mean 'line'?"), HasSubstr("Did you mean 'mine'?"),
                                       HasSubstr("`3` is not in this study (allowed: 0 to 0)")))
            << verb;
        const Ended nowhere = clearway(of("line/mine/0"));
        EXPECT_EQ(nowhere.code, 3) << verb;
        EXPECT_THAT(nowhere.err, HasSubstr("FOLDER/SCENARIO/CONDITION/N")) << verb;
    }
}

TEST_F(ReplayTest, an_edited_table_is_noticed_and_made_anew) {
    ASSERT_EQ(run().code, 0);
    const std::vector<std::vector<std::string>> verbs = {{"report", "out"},
                                                         {"verify", "out/line/mine/0"},
                                                         {"compare", "out"},
                                                         {"export", "results", "out", "runs"}};
    for (const std::vector<std::string>& words : verbs) {
        for (const std::string table : {"runs.csv", "vehicles.csv", "results.sqlite"}) {
            const std::string file = "out/" + table;
            const std::string whole = read(file);
            damage(file, table.ends_with("csv") ? "mine,0," : "arrived", "another");
            const Ended ended = clearway(words);
            EXPECT_EQ(ended.code, 0) << ended.err;
            EXPECT_THAT(ended.err, AllOf(HasSubstr("out: " + table + " differs from the records of the runs"),
                                         HasSubstr("the tables are made anew")))
                << words.front();
            EXPECT_EQ(read(file), whole) << words.front();
        }
        EXPECT_THAT(clearway(words).err, Not(HasSubstr("made anew")));
    }
}

TEST_F(ReplayTest, a_scenario_that_was_edited_after_its_runs_is_noticed) {
    ASSERT_EQ(run().code, 0);
    EXPECT_THAT(clearway({"report", "out"}).err, Not(HasSubstr("was changed")));
    damage("out/scenarios/line/network/network.net.xml", "speed=\"", "speed=\"1");
    const Ended report = clearway({"report", "out"});
    EXPECT_EQ(report.code, 0) << "its runs are as they were";
    EXPECT_THAT(report.err,
                AllOf(HasSubstr("warning: out/scenarios/line/network/network.net.xml: was changed"),
                      HasSubstr("remove out/scenarios/line")));
}

}  // namespace
}  // namespace clearway::cli
