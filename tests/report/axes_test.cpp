#include "report/detail/axes.hpp"

#include <gmock/gmock.h>

namespace clearway::report::detail {
namespace {

using ::testing::DoubleEq;
using ::testing::Pointwise;

Range range(double low, double high) {
    Range result;
    result.include(low);
    result.include(high);
    return result;
}

TEST(NiceTicks, are_multiples_of_one_two_or_five) {
    EXPECT_THAT(nice_ticks(range(0, 100), 5).values,
                Pointwise(DoubleEq(), {0.0, 20.0, 40.0, 60.0, 80.0, 100.0}));
    EXPECT_THAT(nice_ticks(range(-17, 42), 5).values, Pointwise(DoubleEq(), {0.0, 20.0, 40.0}));
    EXPECT_THAT(nice_ticks(range(3, 7.4), 5).values, Pointwise(DoubleEq(), {3.0, 4.0, 5.0, 6.0, 7.0}));
}

TEST(DecadeTicks, ArePowersOfTenAndAtMostSeven) {
    EXPECT_THAT(decade_ticks(range(-1, 2)).values, Pointwise(DoubleEq(), {0.1, 1.0, 10.0, 100.0}));
    EXPECT_THAT(decade_ticks(range(-4, 5)).values, Pointwise(DoubleEq(), {1e-4, 1e-2, 1.0, 1e2, 1e4}));
}

TEST(LogarithmicAxis, GivesDecadesOneWidthAndKeepsZeroAtItsLowEnd) {
    const Axis axis{range(-2, 2), "", 100.0, 0.0, Scale::logarithmic};
    EXPECT_DOUBLE_EQ(axis.place(1.0), 50.0);
    EXPECT_DOUBLE_EQ(axis.place(10.0), 25.0);
    EXPECT_DOUBLE_EQ(axis.place(1e-9), 100.0);
    EXPECT_DOUBLE_EQ(axis.place(0.0), 100.0);
}

TEST(NiceTicks, have_decimals_that_tell_neighbours_apart) {
    EXPECT_EQ(nice_ticks(range(0, 1), 5).decimals, 1);
    EXPECT_EQ(nice_ticks(range(0, 0.12), 5).decimals, 2);
    EXPECT_EQ(nice_ticks(range(0, 5000), 5).decimals, 0);
}

TEST(Range, of_equal_values_can_be_drawn) {
    const Range padded_range = padded(range(70, 70), 0.05);
    EXPECT_LT(padded_range.low, 70.0);
    EXPECT_GT(padded_range.high, 70.0);
    EXPECT_FALSE(nice_ticks(padded_range, 5).values.empty());
}

TEST(Range, ignores_what_is_not_finite) {
    Range result;
    result.include(std::numeric_limits<double>::quiet_NaN());
    EXPECT_TRUE(result.empty());
}

TEST(Plot, escapes_its_texts) {
    Plot plot("<b>", 100.0, {range(0, 1), "<i>", 10, 90}, {range(0, 1), "", 80, 10});
    plot.grid_x();
    plot.text(1, 1, "<script>", Plot::Anchor::start, "label");
    const std::string svg = plot.finish();
    EXPECT_THAT(svg, ::testing::HasSubstr("&lt;script&gt;"));
    EXPECT_THAT(svg,
                ::testing::Not(::testing::AnyOf(::testing::HasSubstr("<script"), ::testing::HasSubstr("<i>"),
                                                ::testing::HasSubstr("<b>"))));
}

}  // namespace
}  // namespace clearway::report::detail
