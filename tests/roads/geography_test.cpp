#include "roads/geography.hpp"

#include <gtest/gtest.h>

namespace clearway::roads {
namespace {

Location utm(int zone, const char* hemisphere = "") {
    Location location;
    location.projection =
        "+proj=utm +zone=" + std::to_string(zone) + hemisphere + " +ellps=WGS84 +datum=WGS84";
    return location;
}

TEST(Geography, knows_published_places_in_utm) {
    // The CN Tower, as "Universal Transverse Mercator coordinate system" of Wikipedia gives it: 17T, to 1 m.
    const auto toronto = Geography::of(utm(17));
    ASSERT_TRUE(toronto);
    const Point tower = toronto->point({-79.0 - 23.0 / 60 - 13.7 / 3600, 43.0 + 38.0 / 60 + 33.24 / 3600});
    EXPECT_NEAR(tower.x_m, 630084.0, 1.5);
    EXPECT_NEAR(tower.y_m, 4833438.0, 1.5);
    // On the central meridian, and at the equator of the southern half.
    const Point equator = Geography::of(utm(32, " +south"))->point({9.0, 0.0});
    EXPECT_NEAR(equator.x_m, 500000.0, 0.1);
    EXPECT_NEAR(equator.y_m, 10000000.0, 1.0);
}

TEST(Geography, there_and_back_is_the_same_place) {
    Location location = utm(33);
    location.offset_x_m = -385000.0;
    location.offset_y_m = -5817000.0;
    const auto geography = Geography::of(location);
    for (double longitude = 12.0; longitude <= 18.0; longitude += 1.5) {
        for (double latitude = -75.0; latitude <= 80.0; latitude += 15.5) {
            const Point point = geography->point({longitude, latitude});
            const Coordinates back = geography->coordinates(point.x_m, point.y_m);
            EXPECT_NEAR(back.longitude_deg, longitude,
                        3e-5);  // Points are floats: 0.5 m far from the origin.
            EXPECT_NEAR(back.latitude_deg, latitude, 1e-5);
        }
    }
}

TEST(Geography, is_not_there_without_a_projection_that_it_knows) {
    for (const char* const projection :
         {"!", "-", "", "+proj=lcc +lat_1=30", "+proj=utm +zone=32 +ellps=bessel"}) {
        Location location;
        location.projection = projection;
        EXPECT_FALSE(Geography::of(location)) << projection;
    }
}

}  // namespace
}  // namespace clearway::roads
