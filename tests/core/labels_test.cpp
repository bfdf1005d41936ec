#include "core/labels.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

namespace clearway::core {
namespace {

constexpr Spot picture{960.0, 540.0};

double distance(const Spot& one, const Spot& other) {
    return std::hypot(one.x - other.x, one.y - other.y);
}

std::vector<Spot> discs(const std::vector<Spot>& places) {
    return spread(places, std::vector<Mark>(places.size(), Mark::disc), picture);
}

TEST(Labels, WithEnoughRoomStayAtTheirPlaces) {
    const std::vector<Spot> places = {{100, 100}, {118, 100}, {100, 400}};
    EXPECT_EQ(discs(places), places);
}

TEST(Labels, OfPlacesNearEachOtherLieBesideEachOtherAndHideNoPlace) {
    std::vector<Spot> places = {{300, 300}, {303, 301}, {300, 300}, {310, 290}, {5, 5}, {7, 5}};
    for (int more = 0; more < 12; ++more)
        places.push_back({500.0 + more, 200.0 + 2 * more});
    const std::vector<Spot> spots = discs(places);
    for (std::size_t row = 0; row < spots.size(); ++row) {
        EXPECT_GE(spots[row].x, disc_radius);
        EXPECT_GE(spots[row].y, disc_radius);
        EXPECT_LT(distance(spots[row], places[row]), 100.0) << row;
        for (std::size_t other = 0; other < spots.size(); ++other) {
            if (other == row) continue;
            EXPECT_GE(distance(spots[row], spots[other]), 2 * disc_radius) << row << " and " << other;
            EXPECT_GE(distance(spots[row], places[other]), disc_radius + 2.5) << row << " hides " << other;
        }
    }
    EXPECT_EQ(discs(places), spots) << "every time the same";
}

TEST(Labels, KeepTheirSides) {
    const std::vector<Spot> places = {{300, 310}, {302, 300}, {500, 200}, {490, 203}, {495, 190}};
    const std::vector<Spot> spots = discs(places);
    EXPECT_GT(spots[0].y, spots[1].y + disc_radius) << "the southern one is the southern disc";
    EXPECT_GT(spots[2].x, spots[3].x + disc_radius);
    EXPECT_LT(spots[4].y, std::min(spots[2].y, spots[3].y) - disc_radius);
}

TEST(Labels, GiveWayToADotThatStays) {
    const std::vector<Spot> places = {{300, 300}, {305, 300}};
    const std::vector<Spot> spots = spread(places, {Mark::disc, Mark::dot}, picture);
    EXPECT_EQ(spots[1], places[1]);
    EXPECT_GE(distance(spots[0], spots[1]), disc_radius + dot_radius);
}

TEST(Labels, WithoutAnyRoomStayToo) {
    const std::vector<Spot> places = {{5, 5}, {7, 5}};
    EXPECT_EQ(spread(places, {Mark::disc, Mark::disc}, {10.0, 10.0}), places);
}

TEST(DrawnPart, is_that_of_the_signals_where_it_is_small) {
    const Extent all{0.0, 0.0, 3000.0, 2000.0};
    const Extent part = drawn_part(all, {1000.0, 900.0, 1600.0, 1200.0});  // and 120 m on each side
    EXPECT_DOUBLE_EQ(part.left, 880.0);
    EXPECT_DOUBLE_EQ(part.right, 1720.0);
    EXPECT_DOUBLE_EQ(part.bottom, 780.0);
    EXPECT_DOUBLE_EQ(part.top, 1320.0);
    EXPECT_DOUBLE_EQ(drawn_part(all, {100.0, 100.0, 2000.0, 1500.0}).right, 3000.0) << "a large part";
    EXPECT_DOUBLE_EQ(drawn_part(all, {}).right, 3000.0) << "no signal";
}

}  // namespace
}  // namespace clearway::core
