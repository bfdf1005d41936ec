#include "core/progress.hpp"

#include <gmock/gmock.h>

#include "core/terminal.hpp"

namespace clearway::core {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(ClockText, ShowsHoursOnlyWhenThereAreAny) {
    EXPECT_EQ(clock_text(0.0), "0:00");
    EXPECT_EQ(clock_text(7.4), "0:07");
    EXPECT_EQ(clock_text(59.6), "1:00");
    EXPECT_EQ(clock_text(754.0), "12:34");
    EXPECT_EQ(clock_text(3723.0), "1:02:03");
    EXPECT_EQ(clock_text(-5.0), "0:00");
}

TEST(ProgressBar, ShowsCountsFailuresAndTimes) {
    EXPECT_EQ(Progress::render_bar("merge", {15, 60, 2, 65.0}),
              "merge [=======>                      ] 15/60, 2 failed, 1:05 elapsed, 3:15 left");
    EXPECT_THAT(Progress::render_bar("x", {0, 60, 0, 1.0}), EndsWith("0/60, 0:01 elapsed"));
    EXPECT_THAT(Progress::render_bar("x", {60, 60, 0, 9.0}),
                StartsWith("x [==============================] 60/60, 0:09 elapsed"));
    EXPECT_THAT(Progress::render_bar("x", {}), HasSubstr("0/0"));
}

TEST(ProgressLine, FitsTheTerminalAndGivesUpTheBarFirst) {
    Progress progress("runs", 1200, Progress::Style::bar);
    const std::string note = "EV travel time -12.3 s [-15.9, -8.6] in city/graph_graphsage_dead_reckoning";
    for (const std::size_t columns : {200, 120, 80, 40, 20}) {
        progress.update(700, 3, note);
        const std::string line = progress.line(columns);
        EXPECT_LE(line.size(), columns) << line;
        EXPECT_THAT(line, StartsWith("runs "));
    }
    EXPECT_THAT(progress.line(200), StartsWith("runs [="));
    EXPECT_THAT(progress.line(200), EndsWith(note));
    EXPECT_THAT(progress.line(80), HasSubstr("700/1200, 3 failed"));
    EXPECT_THAT(progress.line(80), HasSubstr("EV travel"));
}

TEST(ProgressLine, CountsTowardsTheTotalThatIsExpectedNow) {
    Progress progress("runs", 0, Progress::Style::lines);
    progress.expect(120);
    progress.update(30, 0);
    EXPECT_THAT(progress.line(0), StartsWith("runs: 30/120, "));
    progress.expect(90);
    EXPECT_THAT(progress.line(0), StartsWith("runs: 30/90, "));
}

TEST(ProgressLine, KeepsTheNumbersOfItsNoteOnATerminalOf80Columns) {
    Progress progress("runs", 300, Progress::Style::bar);
    const std::string numbers = "EV travel time -28.5 s [-33.2, -23.7], n 20";
    progress.update(120, 2, numbers + ": intersection_70_dense corridor+lead_s=12");
    EXPECT_THAT(progress.line(80), AllOf(StartsWith("runs 120/300, 2 failed"), HasSubstr(numbers)));
    EXPECT_LE(progress.line(80).size(), 80U);
}

TEST(ProgressBar, FollowsTheWorkWhereItIsGiven) {
    // Half of the runs took 60 s, and are a tenth of the work: the rest takes 540 s.
    EXPECT_EQ(Progress::render_bar("x", {30, 60, 0, 60.0, 0, 0.1}),
              "x [===>                          ] 30/60, 1:00 elapsed, 9:00 left");
    // 20 of 40 were there before, and half of the others' work is done: three quarters.
    EXPECT_THAT(Progress::render_bar("x", {25, 40, 0, 9.0, 20, 0.5}, 8), StartsWith("x [======> ] 25/40"));
}

TEST(ProgressBar, LetsTheTimeLeftPassWhileNothingEnds) {
    const auto after = [](double resting_s) {
        return Progress::render_bar(
            "x", {.done = 10, .total = 20, .elapsed_s = 100.0 + resting_s, .resting_s = resting_s});
    };
    EXPECT_THAT(after(0.0), EndsWith("1:40 left"));
    EXPECT_THAT(after(5.0), EndsWith("1:35 left"));
    EXPECT_THAT(after(100.0), EndsWith("2:44 left"))
        << "an eleventh, if it ended now, would have taken longer";
}

TEST(Terminal, CutsBetweenCharactersOfUtf8) {
    EXPECT_EQ(cut_to_columns("Zürich", 6), "Zürich");
    EXPECT_EQ(cut_to_columns("Zürich", 2), "Zü");
    EXPECT_EQ(cut_to_columns("Zürich", 1), "Z");
    EXPECT_EQ(cut_to_columns("", 5), "");
}

}  // namespace
}  // namespace clearway::core
