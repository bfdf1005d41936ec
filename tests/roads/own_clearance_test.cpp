#include "roads/own_clearance.hpp"

#include <gtest/gtest.h>

namespace clearway::testing {
namespace {

/// Two links that conflict; the second has no yellow of its own.
roads::Signal two_links() {
    roads::Signal signal;
    signal.links.resize(2);
    signal.crossings.assign(2, false);
    signal.foes = {{false, true}, {true, false}};
    signal.program = {{30.0, "Gr"}, {3.0, "yr"}, {1.0, "yr"}, {2.0, "rr"}, {36.0, "rG"}, {4.0, "rr"}};
    return signal;
}

TEST(OwnClearance, is_read_from_the_program_of_a_signal) {
    const auto own = roads::own_clearances(two_links());
    EXPECT_DOUBLE_EQ(own[0].yellow_s, 4.0) << "two phases of yellow";
    EXPECT_DOUBLE_EQ(own[0].red_s, 2.0);
    EXPECT_DOUBLE_EQ(own[1].yellow_s, 0.0);
    EXPECT_DOUBLE_EQ(own[1].red_s, 4.0) << "until the cycle begins again";
}

TEST(OwnClearance, of_several_greens_is_the_longest_yellow_and_the_shortest_red) {
    roads::Signal signal = two_links();
    signal.program = {{30.0, "Gr"}, {5.0, "yr"}, {3.0, "rr"}, {9.0, "rG"},
                      {9.0, "Gr"},  {3.0, "yr"}, {1.0, "rr"}, {9.0, "rG"}};
    const auto own = roads::own_clearances(signal);
    EXPECT_DOUBLE_EQ(own[0].yellow_s, 5.0);
    EXPECT_DOUBLE_EQ(own[0].red_s, 1.0);
}

TEST(OwnClearance, is_nothing_where_no_link_that_conflicts_gets_green_in_between) {
    roads::Signal signal = two_links();
    signal.program = {{30.0, "Gg"}, {3.0, "yg"}, {9.0, "rg"}};
    const auto own = roads::own_clearances(signal);
    EXPECT_DOUBLE_EQ(own[0].yellow_s, 3.0);
    EXPECT_DOUBLE_EQ(own[0].red_s, 0.0);
}

TEST(OwnClearance, is_no_phase_that_lets_others_go_however_long_the_foes_wait) {
    roads::Signal signal = two_links();
    signal.links.resize(3);
    signal.crossings.assign(3, false);
    signal.foes = {{false, true, false}, {true, false, true}, {false, true, false}};
    signal.program = {{30.0, "Grr"}, {3.0, "yrr"},  {1.0, "rrr"}, {25.0, "rrG"}, {3.0, "rry"},
                      {2.0, "rrr"},  {36.0, "rGr"}, {4.0, "ryr"}, {1.0, "rrr"}};
    const auto own = roads::own_clearances(signal);
    EXPECT_DOUBLE_EQ(own[0].red_s, 1.0) << "not 31 s";
    EXPECT_DOUBLE_EQ(own[2].red_s, 2.0);
    EXPECT_DOUBLE_EQ(own[1].red_s, 1.0);
}

TEST(OwnClearance, is_nothing_where_another_link_opens_during_the_yellow) {
    roads::Signal signal = two_links();
    signal.links.resize(3);
    signal.crossings.assign(3, false);
    signal.foes = {{false, true, false}, {true, false, true}, {false, true, false}};
    signal.program = {{30.0, "Grr"}, {3.0, "yrG"}, {5.0, "rrG"}, {3.0, "rry"}, {9.0, "rGr"}, {3.0, "ryr"}};
    EXPECT_DOUBLE_EQ(roads::own_clearances(signal)[0].red_s, 0.0);
}

TEST(OwnClearance, of_a_link_that_ends_early_is_not_the_time_in_which_others_still_go) {
    roads::Signal signal = two_links();
    signal.links.resize(3);
    signal.crossings.assign(3, false);
    signal.foes = {{false, true, false}, {true, false, true}, {false, true, false}};
    signal.program = {{30.0, "GrG"}, {3.0, "yrG"},  {10.0, "rrG"}, {3.0, "rry"},
                      {1.0, "rrr"},  {36.0, "rGr"}, {4.0, "ryr"},  {1.0, "rrr"}};
    const auto own = roads::own_clearances(signal);
    EXPECT_DOUBLE_EQ(own[0].red_s, 4.0) << "not 14 s";
    EXPECT_DOUBLE_EQ(own[2].red_s, 1.0);
}

TEST(OwnClearance, of_a_green_after_which_no_foe_opens_says_nothing) {
    roads::Signal signal = two_links();
    signal.program = {{30.0, "Gr"}, {3.0, "yr"}, {2.0, "rr"},  {36.0, "rG"},
                      {4.0, "ry"},  {1.0, "rr"}, {20.0, "Gr"}, {3.0, "yr"}};
    const auto own = roads::own_clearances(signal);
    EXPECT_DOUBLE_EQ(own[0].red_s, 2.0) << "the second green is followed by the first of the next cycle";
}

TEST(OwnClearance, of_a_controller_that_times_its_yellow_itself_is_what_its_phases_say) {
    roads::Signal signal = two_links();
    signal.program = {{.duration_s = 30.0, .state = "Gr", .least_s = 5.0, .yellow_s = 4.0, .red_s = 2.0},
                      {.duration_s = 36.0, .state = "rG", .least_s = 5.0, .yellow_s = 3.0, .red_s = 1.0}};
    const auto own = roads::own_clearances(signal);
    EXPECT_DOUBLE_EQ(own[0].yellow_s, 4.0);
    EXPECT_DOUBLE_EQ(own[0].red_s, 2.0);
    EXPECT_DOUBLE_EQ(own[1].yellow_s, 3.0);
    EXPECT_DOUBLE_EQ(own[1].red_s, 1.0);
}

}  // namespace
}  // namespace clearway::testing
