#include "roads/link_green.hpp"

#include <gtest/gtest.h>

namespace clearway::roads {
namespace {

Signal running(std::vector<Phase> program) {
    Signal signal;
    signal.program = std::move(program);
    return signal;
}

TEST(LinkGreen, of_two_phases_is_the_square_of_red_over_two_cycles) {
    const LinkGreen green = link_green(running({{41.0, "Gr"}, {4.0, "yr"}, {41.0, "rG"}, {4.0, "ry"}}), 0);
    EXPECT_DOUBLE_EQ(green.share, 41.0 / 90.0);
    EXPECT_DOUBLE_EQ(green.wait_s, 49.0 * 49.0 / 180.0);
}

TEST(LinkGreen, joins_the_red_around_the_end_of_the_cycle) {
    const Signal signal = running({{10.0, "r"}, {20.0, "g"}, {30.0, "r"}});
    EXPECT_DOUBLE_EQ(link_green(signal, 0).wait_s, 40.0 * 40.0 / 120.0);
}

TEST(LinkGreen, adds_the_squares_of_reds_that_a_green_parts) {
    const Signal signal = running({{10.0, "G"}, {20.0, "r"}, {5.0, "G"}, {25.0, "r"}});
    EXPECT_DOUBLE_EQ(link_green(signal, 0).wait_s, (20.0 * 20.0 + 25.0 * 25.0) / 120.0);
    EXPECT_DOUBLE_EQ(link_green(signal, 0).share, 0.25);
}

TEST(LinkGreen, makes_nobody_wait_where_it_never_ends_and_says_nothing_where_it_never_comes) {
    const Signal signal = running({{30.0, "Gs"}, {30.0, "gs"}});
    EXPECT_DOUBLE_EQ(link_green(signal, 0).wait_s, 0.0);
    EXPECT_DOUBLE_EQ(link_green(signal, 0).share, 1.0);
    EXPECT_DOUBLE_EQ(link_green(signal, 1).wait_s, 0.0);
    EXPECT_DOUBLE_EQ(link_green(signal, 1).share, 0.0);
}

TEST(LinkGreen, of_phases_side_by_side_takes_the_cycle_of_one_ring) {
    Signal signal = running({{30.0, "Grrr", 0.0, 4.0, 1.0},
                             {20.0, "rGrr", 0.0, 3.0, 2.0},
                             {30.0, "rrGr", 0.0, 4.0, 1.0},
                             {20.0, "rrrG", 0.0, 3.0, 2.0}});
    signal.controller = "NEMA";
    EXPECT_DOUBLE_EQ(link_green(signal, 0).share, 0.5);
    EXPECT_DOUBLE_EQ(link_green(signal, 0).wait_s, 30.0 * 30.0 / 120.0);
}

}  // namespace
}  // namespace clearway::roads
