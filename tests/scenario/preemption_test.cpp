#include "scenario/preemption.hpp"

#include <algorithm>

#include <gmock/gmock.h>

#include "core/files.hpp"
#include "scenario/config.hpp"
#include "scratch.hpp"

namespace clearway::scenario {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr const char* header =
    "signal,enabled,delay_s,minimum_green_s,walk_s,pedestrian_clearance_s,minimum_duration_s,dwell_s,"
    "maximum_presence_s,exit_phase,lockout_s,priority\n";

const roads::Network& crossings() {
    static const roads::Network network =
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml");
    return network;
}

class PreemptionFile : public ScratchTest {
  protected:
    std::vector<traffic::Preemption> read(const std::string& text) const {
        const auto file = write("preemption.csv", text);
        std::vector<core::Problem> problems;
        const PreemptionRows rows = read_preemption_rows(file, problems);
        if (!problems.empty()) throw core::InputError(std::move(problems));
        return preemption_of(rows, file, crossings());
    }
    /// The only problem of a file with this header and these rows, as it is printed.
    std::string refusal(const std::string& rows, const std::string& head = header) const {
        const auto problems = problems_of([&] { read(head + rows); });
        EXPECT_EQ(problems.size(), 1U);
        return problems.empty() ? "" : core::format_problem(problems.front());
    }
};

TEST_F(PreemptionFile, gives_each_signal_what_its_row_says_and_nothing_to_the_others) {
    const auto signals = read(std::string(header) + "B,1,2.5,7,6,11,20,8,90,2,30,4\n");
    ASSERT_EQ(signals.size(), 2U);
    EXPECT_EQ(signals[0], traffic::Preemption{});
    const traffic::Preemption expected{1, 2.5, 7.0, 6.0, 11.0, 20.0, 8.0, 90.0, 2, 30.0, 4};
    EXPECT_EQ(signals[1], expected);
}

TEST_F(PreemptionFile, may_have_its_columns_in_any_order_empty_cells_and_line_ends_of_any_system) {
    const auto signals = read(
        "\xEF\xBB\xBF"
        "dwell_s,signal,enabled,delay_s,minimum_green_s,walk_s,pedestrian_clearance_s,"
        "minimum_duration_s,maximum_presence_s,exit_phase,lockout_s,priority\r\n"
        "12,A,,,,,,,,,,\r\n\r\n");
    EXPECT_EQ(signals[0], (traffic::Preemption{.dwell_s = 12.0}));
}

TEST_F(PreemptionFile, that_is_written_reads_back_the_same) {
    std::vector<traffic::Preemption> signals(2);
    signals[0] = {.enabled = 0, .delay_s = 0.1, .priority = 2};
    signals[1] = {.walk_s = 5.5, .exit_phase = 0};
    EXPECT_EQ(read(preemption_csv(crossings(), signals)), signals);
}

TEST_F(PreemptionFile, may_name_signals_by_their_numbers_but_each_once) {
    EXPECT_EQ(read(std::string(header) + "#2,,,,,,,12,,,,\n")[1], (traffic::Preemption{.dwell_s = 12.0}));
    EXPECT_THAT(refusal("#2,,,,,,,,,,,\nB,,,,,,,,,,,\n"), HasSubstr("is the signal of line"));
}

TEST_F(PreemptionFile, for_a_signal_that_does_not_exist_names_the_nearest) {
    const auto file = write("preemption.csv", std::string(header) + "A,,,,,,,,,,,\nBB,,,,,,,,,,,\n");
    const std::string text = refusal("A,,,,,,,,,,,\nBB,,,,,,,,,,,\n");
    EXPECT_THAT(text, AllOf(HasSubstr("preemption.csv:3: signal"), HasSubstr("no signal 'BB'"),
                            HasSubstr("Did you mean 'B'?")));
}

TEST_F(PreemptionFile, with_a_minimum_green_above_the_cycle_is_refused) {
    EXPECT_THAT(refusal("A,,,91,,,,,,,,\n"),
                AllOf(HasSubstr("preemption.csv:2: minimum_green_s"),
                      HasSubstr("91 is longer than the cycle"), HasSubstr("up to 90 s")));
}

TEST_F(PreemptionFile, with_a_dwell_of_zero_is_refused) {
    EXPECT_THAT(refusal("A,,,,,,,0,,,,\n"), AllOf(HasSubstr("preemption.csv:2: dwell_s"),
                                                  HasSubstr("\"0\" for signal 'A' is out of range"),
                                                  HasSubstr("1 to 255 s, or nothing")));
}

TEST_F(PreemptionFile, with_something_else_than_a_number_is_refused) {
    EXPECT_THAT(refusal("A,,soon,,,,,,,,,\n"),
                HasSubstr("preemption.csv:2: delay_s: \"soon\" for signal 'A' is no number"));
    EXPECT_THAT(refusal("A,,,,,,,,,1.5,,\n"),
                AllOf(HasSubstr("exit_phase: \"1.5\" for signal 'A' is no whole number"),
                      HasSubstr("a whole number from 0 to 255")));
    EXPECT_THAT(refusal("A,,nan,,,,,,,,,\n"), HasSubstr("delay_s: \"nan\" for signal 'A' is out of range"));
}

TEST_F(PreemptionFile, with_an_exit_phase_that_is_no_green_of_the_program_is_refused) {
    EXPECT_THAT(refusal("A,,,,,,,,,1,,\n"), AllOf(HasSubstr("1 is no green phase"), HasSubstr("0, 2")));
    EXPECT_THAT(refusal("A,,,,,,,,,4,,\n"), HasSubstr("4 is no phase of signal 'A'"));
}

TEST_F(PreemptionFile, with_two_rows_for_one_signal_is_refused) {
    EXPECT_THAT(refusal("A,,,,,,,,,,,\nA,,,,,,,,,,,\n"),
                AllOf(HasSubstr("preemption.csv:3: signal: \"A\" is in line 2 already"),
                      HasSubstr("Remove one of the rows")));
}

TEST_F(PreemptionFile, without_a_column_is_refused) {
    std::string shorter = header;
    shorter.erase(shorter.find("dwell_s,"), 8);
    EXPECT_THAT(refusal("", shorter), AllOf(HasSubstr("preemption.csv:1: dwell_s: is missing"),
                                            HasSubstr("its cells may be empty")));
}

TEST_F(PreemptionFile, with_a_column_that_is_not_known_names_the_nearest) {
    std::string longer = header;
    longer.insert(0, "dwel_s,");
    EXPECT_THAT(refusal("", longer), AllOf(HasSubstr("preemption.csv:1: dwel_s: is no column"),
                                           HasSubstr("Did you mean 'dwell_s'?")));
}

TEST_F(PreemptionFile, with_another_separator_is_refused_once) {
    std::string semicolons = header;
    std::ranges::replace(semicolons, ',', ';');
    EXPECT_THAT(refusal("A;1\n", semicolons),
                AllOf(HasSubstr("preemption.csv:1: is separated by ;, not by commas"),
                      HasSubstr("Save it with commas")));
    std::string tabs = header;
    std::ranges::replace(tabs, ',', '\t');
    EXPECT_THAT(refusal("A\t1\n", tabs), HasSubstr("is separated by tabs, not by commas"));
}

TEST_F(PreemptionFile, with_a_dwell_or_duration_above_the_longest_presence_is_refused) {
    EXPECT_THAT(
        refusal("A,,,,,,,90,60,,,\n"),
        AllOf(HasSubstr("preemption.csv:2: dwell_s: 90 for signal 'A' is above its maximum_presence_s"),
              HasSubstr("up to 60 s"), HasSubstr("raise maximum_presence_s")));
    EXPECT_THAT(refusal("A,,,,,,70,,60,,,\n"), HasSubstr("minimum_duration_s: 70 for signal 'A'"));
    EXPECT_EQ(read(std::string(header) + "A,,,,,,60,60,60,,,\nB,,,,,,90,90,0,,,\n")[1].dwell_s, 90.0)
        << "0: no limit";
}

TEST_F(PreemptionFile, with_several_mistakes_names_them_all) {
    EXPECT_EQ(
        problems_of([&] { read(std::string(header) + "A,2,,,,,,,,,,\nB,,-1,,,,,0,,,,\nA,,\n"); }).size(), 4U);
    EXPECT_THAT(refusal(""
                        "A,1\n"),
                HasSubstr("preemption.csv:2: has 2 cells (allowed: 12"));
}

TEST_F(PreemptionFile, that_is_empty_says_how_to_make_one) {
    EXPECT_THAT(refusal("", ""), HasSubstr("clearway scenario signals SCENARIO --out FILE"));
}

TEST_F(PreemptionFile, is_filled_with_what_programs_show) {
    const auto file = write("tls.add.xml", R"(<additional>
    <tlLogic id="A" type="actuated" programID="1" offset="0">
        <phase duration="40" minDur="8" maxDur="50" state="GGGgrrrrGGGgrrrr"/>
        <phase duration="4" state="yyyyrrrryyyyrrrr"/>
        <phase duration="40" minDur="8" maxDur="50" state="rrrrGGGgrrrrGGGg"/>
        <phase duration="4" state="rrrryyyyrrrryyyy"/>
    </tlLogic></additional>)");
    const auto known = preemption_in(
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml", {file}));
    EXPECT_EQ(known[0], (traffic::Preemption{.enabled = 1, .minimum_green_s = 8.0}));
    EXPECT_EQ(known[1], (traffic::Preemption{.enabled = 1}));
    const auto other = write("other.add.xml", R"(<additional>
    <tlLogic id="A" type="actuated" programID="1" offset="0">
        <phase duration="40" minDur="8" state="GGGgrrrrGGGgrrrr"/>
        <phase duration="40" minDur="6" state="rrrrGGGgrrrrGGGg"/>
    </tlLogic></additional>)");
    const auto differing = preemption_in(
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml", {other}));
    EXPECT_FALSE(differing[0].minimum_green_s) << "the controller has one for all phases";
    const auto walking =
        preemption_in(roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/footway.net.xml"));
    EXPECT_EQ(walking[0], (traffic::Preemption{.enabled = 1, .pedestrian_clearance_s = 5.0}));
}

TEST_F(PreemptionFile, of_a_scenario_is_checked_with_it_and_part_of_its_identity) {
    write("line.nod.xml", line_nodes);
    write("line.edg.xml", line_edges);
    const std::string toml = std::string(line_head) + "preemption = \"signals.csv\"\n[demand]\nhuman = 1\n";
    const auto file = write("scenario.toml", toml).string();
    EXPECT_THAT(core::format_problem(problems_of([&] { load(file); }).front()), HasSubstr("no file"));
    write("signals.csv", std::string(header) + "A,,,,,,,0,,,,\n");
    EXPECT_THAT(core::format_problem(problems_of([&] { load(file); }).front()),
                HasSubstr("signals.csv:2: dwell_s"));
    write("signals.csv", std::string(header) + "A,,,,,,,5,,,,\n");
    const std::string one = scenario_hash(load(file));
    write("signals.csv", std::string(header) + "A,,,,,,,6,,,,\n");
    EXPECT_NE(scenario_hash(load(file)), one);
    store(load(file), folder() / "copy");
    EXPECT_EQ(core::read_file(folder() / "copy" / "signals.csv"), core::read_file(folder() / "signals.csv"));
}

}  // namespace
}  // namespace clearway::scenario
