#include "links/place_errors.hpp"

#include <gtest/gtest.h>

namespace clearway::links {
namespace {

TEST(PlaceGrid, has_fine_bins_near_and_coarse_ones_far) {
    EXPECT_EQ(PlaceGrid::bin_of(0.0), 0U);
    EXPECT_EQ(PlaceGrid::bin_of(0.25), 2U);
    EXPECT_EQ(PlaceGrid::bin_of(199.999999999999), 1999U);
    EXPECT_EQ(PlaceGrid::bin_of(200.0), 2000U);
    EXPECT_EQ(PlaceGrid::bin_of(201.5), 2001U);
    EXPECT_EQ(PlaceGrid::bin_of(1999.9), PlaceGrid::size - 2);
    EXPECT_EQ(PlaceGrid::bin_of(2000.0), PlaceGrid::size - 1);
    EXPECT_EQ(PlaceGrid::bin_of(1e9), PlaceGrid::size - 1);
    for (std::uint32_t bin = 0; bin < PlaceGrid::size; ++bin) {
        EXPECT_EQ(PlaceGrid::bin_of(PlaceGrid::lower_edge_m(bin) + 0.05), bin);
        if (bin + 1 == PlaceGrid::size) break;
        EXPECT_GT(PlaceGrid::lower_edge_m(bin + 1), PlaceGrid::lower_edge_m(bin));
    }
    EXPECT_DOUBLE_EQ(PlaceGrid::lower_edge_m(PlaceGrid::size), 2000.0);
}

/// Four errors in [1.0, 1.1) and one in [50.0, 50.1): half of the five are reached after 2.5 of the four.
TEST(PlaceErrors, have_quantiles_that_are_linear_within_a_bin) {
    PlaceHistogram histogram;
    for (const double error_m : {1.02, 1.05, 1.08, 1.01, 50.05})
        histogram.add(error_m);
    const PlaceErrors errors = histogram.errors();
    EXPECT_EQ(errors.vehicles(), 5U);
    EXPECT_NEAR(quantile_m(errors, 0.5).value(), 1.0 + 0.1 * 2.5 / 4.0, 1e-12);
    EXPECT_NEAR(quantile_m(errors, 0.8).value(), 1.1, 1e-12);
    EXPECT_NEAR(quantile_m(errors, 0.95).value(), 50.0 + 0.1 * 0.75, 1e-12);
    EXPECT_FALSE(quantile_m({}, 0.5).has_value());
}

TEST(PlaceErrors, beyond_the_grid_count_as_its_end) {
    PlaceHistogram histogram;
    histogram.add(5000.0);
    EXPECT_DOUBLE_EQ(quantile_m(histogram.errors(), 0.5).value(), 2000.0);
}

TEST(PlaceErrors, of_runs_add_up) {
    PlaceHistogram one, other, both;
    for (const double error_m : {0.5, 3.0, 700.0}) {
        one.add(error_m);
        both.add(error_m);
    }
    for (const double error_m : {0.2, 3.0, 3000.0}) {
        other.add(error_m);
        both.add(error_m);
    }
    PlaceErrors sum = one.errors();
    sum.add(other.errors());
    EXPECT_EQ(sum, both.errors());
}

/// Lane 7: vehicles at 10, 40, 40 and 140 m. Lane 8: one at 50 m.
TEST(LaneOrder, finds_the_nearest_vehicle_ahead_within_100_m_on_the_same_lane) {
    constexpr core::LaneIndex lane{7};
    LaneOrder order;
    order.add(0, lane, 140.0F);
    order.add(1, lane, 40.0F);
    order.add(2, core::LaneIndex{8}, 50.0F);
    order.add(3, lane, 10.0F);
    order.add(4, lane, 40.0F);
    order.add(5, core::LaneIndex::none(), 20.0F);
    order.sort();
    EXPECT_EQ(order.next_ahead(lane, 10.0F), 1U) << "of two at one place the first row";
    EXPECT_EQ(order.next_ahead(lane, 40.0F), 0U) << "exactly 100 m; who stands beside is not ahead";
    EXPECT_EQ(order.next_ahead(lane, 39.9F), 1U);
    EXPECT_EQ(order.next_ahead(lane, 140.0F), core::no_row);
    EXPECT_EQ(order.next_ahead(core::LaneIndex{8}, 0.0F), 2U);
    EXPECT_EQ(order.next_ahead(core::LaneIndex{8}, 50.0F), core::no_row) << "not into the next lane";
    EXPECT_EQ(order.next_ahead(core::LaneIndex::none(), 0.0F), core::no_row);
    order.clear();
    order.add(6, lane, 111.0F);
    order.sort();
    EXPECT_EQ(order.next_ahead(lane, 10.0F), core::no_row) << "101 m";
}

}  // namespace
}  // namespace clearway::links
