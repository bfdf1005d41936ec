// What the event logs of a study's signals say, and the audit that reads them.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

using testing::Gt;
using testing::StartsWith;

class SignalAuditTest : public UserTest {
  protected:
    /// Runs `corridor` and its baseline.
    void make(const std::string& scenario, const std::string& out,
              const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {"run",    scenario, "--policy", "corridor", "--no-solo",
                                          "--name", "mine",   "--out",    out};
        if (std::ranges::find(more, "--seeds") == more.end()) words.insert(words.end(), {"--seeds", "2"});
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = clearway(words);
        ASSERT_EQ(ended.code, 0) << ended.err;
    }
    nlohmann::json audit(const std::string& out) const {
        return nlohmann::json::parse(clearway({"verify", "--signals", out, "--json"}).out);
    }
};

TEST_F(SignalAuditTest, of_transitions_that_keep_the_programs_clearance_finds_nothing) {
    make("intersection", "out");
    const Ended ended = clearway({"verify", "--signals", "out"});
    EXPECT_EQ(ended.code, 0) << ended.out << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("2 runs audited, 2 without requests to signals"));
    EXPECT_THAT(ended.out, HasSubstr(" 0 too short"));
    const auto found = audit("out");
    EXPECT_THAT(found["yellows"].get<int>(), Gt(0));
    EXPECT_THAT(found["red_clearances"].get<int>(), Gt(0));
    EXPECT_THAT(found["greens"].get<int>(), Gt(0));
}

TEST_F(SignalAuditTest, of_fixed_times_finds_the_yellow_of_3_s_where_the_program_has_5_s) {
    make("intersection", "out", {"--set", "actuation.clearance=fixed"});
    const Ended ended = clearway({"verify", "--signals", "out"});
    EXPECT_EQ(ended.code, 1);
    EXPECT_THAT(ended.out, HasSubstr("yellow lasted 3.00 s, its own program 5.00 s"));
    EXPECT_THAT(ended.out, HasSubstr("out/intersection/mine/0: "));
    EXPECT_THAT(audit("out")["findings"].size(), Gt(0U));
}

TEST_F(SignalAuditTest, of_a_city_whose_signals_vehicles_actuate_finds_nothing) {
    make("city", "out", {"--seeds", "1"});
    const auto found = audit("out");
    EXPECT_THAT(found["yellows"].get<int>(), Gt(0));
    EXPECT_THAT(found["red_clearances"].get<int>(), Gt(0));
    EXPECT_TRUE(found["findings"].empty()) << found["findings"];
}

TEST_F(SignalAuditTest, of_actuated_and_nema_controllers_finds_nothing) {
    write("crossings/net.net.xml",
          core::read_file(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml"));
    std::string routes = "<routes>\n<vType id=\"private\"/>\n";
    for (int number = 0; number < 200; ++number)
        routes +=
            fmt::format(R"(<vehicle id="v{}" type="private" depart="{}"><route edges="{}"/></vehicle>)"
                        "\n",
                        number, number * 2, number % 2 == 0 ? "west_A A_B B_east" : "north_a_A A_south_a");
    write("crossings/rou.xml", routes + "</routes>\n");
    write("crossings/tls.add.xml", R"(<additional>
    <tlLogic id="A" type="actuated" programID="own" offset="0">
        <phase duration="30" minDur="7" maxDur="40" state="GGGgrrrrGGGgrrrr"/>
        <phase duration="4" state="yyyyrrrryyyyrrrr"/><phase duration="2" state="rrrrrrrrrrrrrrrr"/>
        <phase duration="30" minDur="7" maxDur="40" state="rrrrGGGgrrrrGGGg"/>
        <phase duration="4" state="rrrryyyyrrrryyyy"/><phase duration="2" state="rrrrrrrrrrrrrrrr"/>
    </tlLogic>
    <tlLogic id="B" type="NEMA" programID="own" offset="0">
        <param key="ring1" value="0,2,0,4"/><param key="ring2" value="0,6,0,8"/>
        <param key="barrierPhases" value="4,8"/><param key="barrier2Phases" value="2,6"/>
        <param key="coordinate-mode" value="false"/><param key="total-cycle-length" value="90"/>
        <param key="minRecall" value="2,6"/>
        <phase duration="40" minDur="6" maxDur="40" vehext="2" yellow="4" red="2" name="2"
            state="rrrrrrrrrrrrGGGg"/>
        <phase duration="20" minDur="6" maxDur="20" vehext="2" yellow="4" red="2" name="4"
            state="GGGgrrrrrrrrrrrr"/>
        <phase duration="40" minDur="6" maxDur="40" vehext="2" yellow="4" red="2" name="6"
            state="rrrrGGGgrrrrrrrr"/>
        <phase duration="20" minDur="6" maxDur="20" vehext="2" yellow="4" red="2" name="8"
            state="rrrrrrrrGGGgrrrr"/>
    </tlLogic>
</additional>)");
    write("crossings/scenario.toml", R"(name = "crossings"
version = "v1"
title = "Two crossings"
[network]
file = "net.net.xml"
restrict = "none"
[time]
warm_up_s = 40.0
window_s = 240.0
horizon_s = 900.0
[demand]
emergency = 4
[measured]
routes = ["rou.xml"]
additional = ["tls.add.xml"]
automated_share = 0.35
emergency_minimum_length_m = 500.0
[[measured.type]]
id = "private"
kind = "car"
)");
    make("./crossings", "out");
    const Ended ended = clearway({"verify", "--signals", "out"});
    EXPECT_EQ(ended.code, 0) << ended.out << ended.err;
    const Ended events = clearway({"export", "results", "out", "signal_events"});
    for (const char* const signal : {",A,107,", ",B,107,", ",A,8,", ",B,8,"})
        EXPECT_THAT(events.out, HasSubstr(signal));
}

TEST_F(SignalAuditTest, refuses_what_is_no_run_folder_and_a_damaged_log) {
    const Ended nowhere = clearway({"verify", "--signals", "nowhere"});
    EXPECT_EQ(nowhere.code, 3);
    EXPECT_THAT(nowhere.err,
                HasSubstr("nowhere is not a run folder (allowed: a folder written with --out, or"));
    EXPECT_EQ(clearway({"verify", "--signals", "out", "--out", "again"}).code, 2) << "nothing is repeated";
    make("intersection", "out", {"--seeds", "1"});
    const std::string log = "out/runs/intersection/mine/00000/signal_events.csv";
    write(log, read(log) + "yesterday,J,1,1,0,,Phase Begin Green\n");
    const Ended ended = clearway({"verify", "--signals", "out"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("signal_events.csv:"), HasSubstr("\"yesterday\" is not a number"),
                                 HasSubstr("makes it again")));
}

TEST_F(SignalAuditTest, of_runs_that_show_nothing_to_audit_says_so) {
    make("rural", "rural", {"--seeds", "1", "--density", "0.1"});
    const Ended rural = clearway({"verify", "--signals", "rural"});
    EXPECT_EQ(rural.code, 5) << rural.out;
    EXPECT_THAT(rural.out, HasSubstr("0 yellows, 0 red clearances and 0 greens checked"));
    EXPECT_THAT(rural.err, HasSubstr("no signal showed a complete colour"));
    make("intersection", "out", {"--seeds", "1"});
    const Ended baseline = clearway({"verify", "--signals", "out/intersection/baseline/0", "--json"});
    EXPECT_EQ(baseline.code, 5);
    EXPECT_EQ(nlohmann::json::parse(baseline.out)["audited"], 0);
    EXPECT_THAT(baseline.err, HasSubstr("none of its complete runs requests green"));
    EXPECT_EQ(clearway({"verify", "--signals", "out/intersection/mine/0"}).code, 0);
}

TEST_F(SignalAuditTest, and_the_tables_of_a_study_are_made_from_its_logs) {
    make("intersection", "out", {"--seeds", "1"});
    const Ended events = clearway({"export", "results", "out", "--table", "signal_events"});
    EXPECT_EQ(events.code, 0) << events.err;
    EXPECT_THAT(events.out, StartsWith("scenario,condition,replication,time_s,signal,event,parameter,links,"
                                       "vehicle,name\nintersection,mine,0,"));
    for (const char* const words :
         {",102,", ",105,", ",107,", ",82,", ",104,", ",111,", ",150,", ",8,", ",10,"})
        EXPECT_THAT(events.out, HasSubstr(words));
    EXPECT_THAT(clearway({"export", "results", "out", "signals"}).out,
                StartsWith("scenario,condition,replication,signal,calls,granted,useless_holds,"));
    EXPECT_THAT(clearway({"export", "results", "out", "--list"}).out,
                AllOf(HasSubstr("signal_events\n"), HasSubstr("signals\n")));
}

TEST_F(SignalAuditTest, and_response_times_are_judged_by_a_threshold) {
    make("intersection", "out", {"--seeds", "1"});
    const auto share = [&](const char* threshold) {
        const Ended report = clearway({"report", "out", "--json", "--response-threshold", threshold});
        return nlohmann::json::parse(
            report.out)["scenarios"][0]["conditions"][1]["response_in_time_1"]["mean"];
    };
    EXPECT_EQ(share("1000"), 1.0);
    EXPECT_EQ(share("1"), 0.0);
    EXPECT_THAT(clearway({"report", "out", "--response-threshold", "77"}).out,
                HasSubstr("EV trips within 77 s (100 s"));
    EXPECT_THAT(clearway({"compare", "out", "--response-threshold", "77"}).out,
                HasSubstr("trips within 77 s, %"));
    for (const char* const wrong : {"0", "-5", "soon", "1e9"}) {
        const Ended ended = clearway({"report", "out", "--response-threshold", wrong});
        EXPECT_EQ(ended.code, 2) << wrong;
        EXPECT_THAT(ended.err, HasSubstr("--response-threshold")) << wrong;
    }
}

}  // namespace
}  // namespace clearway::cli
