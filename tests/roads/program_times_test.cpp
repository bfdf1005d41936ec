#include "roads/program_times.hpp"

#include <gmock/gmock.h>

namespace clearway::roads {
namespace {

using ::testing::ElementsAre;
using ::testing::Optional;

/// Three links, of which the first two conflict, and a crossing that conflicts with both.
Signal signal_with(std::vector<Phase> program) {
    Signal signal;
    signal.id = "J";
    signal.links.resize(4);
    signal.crossings = {false, false, false, true};
    signal.foes = {{false, true, false, true},
                   {true, false, false, true},
                   {false, false, false, false},
                   {true, true, false, false}};
    signal.program = std::move(program);
    return signal;
}

TEST(ProgramTimes, AreWhatThePlayedProgramShows) {
    const ProgramTimes times = program_times(signal_with({{30.0, "GrGr"},
                                                          {4.0, "yrGr"},
                                                          {2.0, "rrGr"},
                                                          {6.0, "rGGr"},
                                                          {3.0, "ryGr"},
                                                          {20.0, "rrGG"},
                                                          {8.0, "rrGr"}}));
    EXPECT_THAT(times.yellow_s, ElementsAre(Optional(4.0), Optional(3.0), std::nullopt, std::nullopt));
    EXPECT_THAT(times.red_s, ElementsAre(Optional(2.0), Optional(0.0), std::nullopt, Optional(8.0)))
        << "across the end of the cycle too";
    EXPECT_THAT(times.green_s, ElementsAre(Optional(5.0), Optional(5.0), std::nullopt, Optional(4.0)))
        << "link 2 never ends its green";
}

TEST(ProgramTimes, DoNotCallAPhaseForOthersClearance) {
    const ProgramTimes times = program_times(signal_with(
        {{30.0, "Grrr"}, {3.0, "yrrr"}, {20.0, "rrGr"}, {3.0, "rryr"}, {30.0, "rGrr"}, {3.0, "ryrr"}}));
    EXPECT_THAT(times.red_s[0], Optional(0.0)) << "link 2 opens at once, and link 1 23 s later";
}

TEST(ProgramTimes, GiveNoClearanceWhereALinkOpensDuringYellow) {
    const ProgramTimes foe = program_times(signal_with(
        {{30.0, "Grrr"}, {3.0, "ygrr"}, {20.0, "rGrr"}, {3.0, "ryrr"}, {2.0, "rrrr"}, {9.0, "rrGr"}}));
    EXPECT_THAT(foe.red_s[0], Optional(0.0)) << "link 1 goes before link 0 is red; link 2 opens 25 s later";
    const ProgramTimes other = program_times(
        signal_with({{30.0, "Grrr"}, {3.0, "yrGr"}, {5.0, "rrGr"}, {3.0, "rryr"}, {9.0, "rGrr"}}));
    EXPECT_THAT(other.red_s[0], Optional(0.0)) << "link 2 already goes; link 1 waits 8 s for it";
}

TEST(ProgramTimes, OweTheProgramsOwnMinimumButNeverMoreThanItShowsItself) {
    Phase actuated{3.0, "Grrr"};
    actuated.least_s = 8.0;
    Phase side{40.0, "rGrr"};
    side.least_s = 8.0;
    const ProgramTimes times = program_times(signal_with({actuated, {4.0, "yrrr"}, side, {4.0, "ryrr"}}));
    EXPECT_THAT(times.green_s[0], Optional(3.0));
    EXPECT_THAT(times.green_s[1], Optional(8.0));
}

TEST(ProgramTimes, OfPhasesSideBySideAreTheirs) {
    Phase main{30.0, "GrGr", 10.0, 4.0, 1.5};
    Phase side{20.0, "rGrr", 6.0, 3.0, 2.0};
    const ProgramTimes times = program_times(signal_with({main, side}));
    EXPECT_THAT(times.yellow_s, ElementsAre(Optional(4.0), Optional(3.0), Optional(4.0), std::nullopt));
    EXPECT_THAT(times.red_s, ElementsAre(Optional(1.5), Optional(2.0), Optional(1.5), std::nullopt));
    EXPECT_THAT(times.green_s, ElementsAre(Optional(10.0), Optional(6.0), Optional(10.0), std::nullopt));
}

}  // namespace
}  // namespace clearway::roads
