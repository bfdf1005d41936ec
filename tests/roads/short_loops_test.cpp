#include "roads/short_loops.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/crossing_scene.hpp"

namespace clearway::testing {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(ShortLoops, are_found_where_short_blocks_close_and_leave_out_the_ends_of_chains) {
    const auto on_loop = roads::on_short_loops(short_square(), 110.0);
    ASSERT_THAT(on_loop, SizeIs(5));
    for (const char* const corner : {"A0", "A1", "B0", "B1"})
        EXPECT_TRUE(on_loop[short_square().find_signal(corner).value().value]) << corner;
    EXPECT_FALSE(on_loop[short_square().find_signal("T").value().value]) << "joined to B0 alone";
}

TEST(ShortLoops, need_blocks_shorter_than_the_bound) {
    EXPECT_THAT(roads::on_short_loops(short_square(), 80.0), IsEmpty())
        << "110 m between the centres, and more than 80 m of street";
}

TEST(ShortLoops, pass_through_streets_that_are_cut_where_nothing_leaves_them) {
    const auto on_loop = roads::on_short_loops(cut_squares(), 110.0);
    ASSERT_THAT(on_loop, SizeIs(8));
    for (const char* const corner : {"sw", "se", "ne", "nw"}) {
        const auto is_on_loop = [&](const std::string& square) {
            return on_loop[cut_squares().find_signal(square + corner).value().value];
        };
        EXPECT_TRUE(is_on_loop("a")) << corner << ": cars may only turn round where the street is cut";
        EXPECT_FALSE(is_on_loop("b")) << corner << ": a side street leaves where the street is cut";
    }
}

TEST(ShortLoops, count_all_pieces_of_a_street) {
    EXPECT_THAT(roads::on_short_loops(cut_squares(), 80.0), IsEmpty())
        << "each of the two pieces is shorter than that, both together are not";
}

TEST(ShortLoops, are_none_where_two_signals_are_joined_in_both_directions) {
    EXPECT_THAT(roads::on_short_loops(two_crossings(), 1000.0), IsEmpty());
}

}  // namespace
}  // namespace clearway::testing
