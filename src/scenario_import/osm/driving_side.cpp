#include "scenario_import/osm/driving_side.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace clearway::scenario_import::detail {

namespace {

/// An area in degrees, and its country if traffic drives on the left there; empty if on the right.
struct Box {
    double west, south, east, north;
    const char* land;
};

// The first box that contains a place decides, so neighbours that drive on the right and small countries come
// first.
constexpr std::array boxes = {
    // Europe
    Box{-1.0, 49.0, 1.45, 50.3, ""},
    Box{1.45, 49.0, 3.0, 51.05, ""},
    Box{-8.2, 54.0, -5.4, 55.4, "Northern Ireland"},
    Box{-11.0, 51.3, -5.9, 55.5, "Ireland"},
    Box{-2.8, 49.1, -1.9, 49.8, "the Channel Islands"},
    Box{-8.8, 49.8, 1.9, 61.0, "Great Britain"},
    Box{14.1, 35.7, 14.7, 36.2, "Malta"},
    Box{32.2, 34.5, 34.7, 35.8, "Cyprus"},
    // Iran and Afghanistan before Pakistan
    Box{60.8, 26.6, 62.75, 28.6, ""},
    Box{60.8, 25.0, 61.6, 26.6, ""},
    Box{60.8, 29.4, 65.0, 36.0, ""},
    Box{65.0, 29.9, 66.3, 36.0, ""},
    Box{66.3, 33.2, 69.3, 37.5, ""},
    Box{66.3, 31.5, 68.0, 33.2, ""},
    Box{68.0, 32.0, 69.1, 33.2, ""},
    Box{69.3, 34.05, 70.95, 37.5, ""},
    Box{69.3, 33.15, 70.15, 33.8, ""},
    Box{70.95, 34.6, 71.25, 36.0, ""},
    Box{70.95, 36.6, 73.0, 37.6, ""},
    // Myanmar and China before India and Thailand
    Box{92.6, 15.0, 97.3, 22.0, ""},
    Box{93.5, 22.0, 97.3, 24.0, ""},
    Box{94.75, 24.0, 95.4, 25.6, ""},
    Box{95.4, 24.0, 97.5, 26.6, ""},
    Box{97.0, 26.6, 97.5, 28.0, ""},
    Box{97.3, 14.6, 98.15, 17.3, ""},
    Box{97.3, 10.6, 98.75, 14.6, ""},
    Box{98.75, 11.2, 99.1, 13.6, ""},
    Box{60.8, 23.5, 78.0, 37.1, "Pakistan and north-west India"},
    Box{78.0, 27.9, 79.2, 32.6, "India"},
    Box{79.2, 30.4, 92.0, 37.0, ""},
    Box{84.8, 28.6, 92.0, 30.4, ""},
    Box{92.0, 29.5, 99.0, 37.0, ""},
    Box{68.0, 5.8, 97.4, 30.5, "India, Nepal, Bhutan, Bangladesh or Sri Lanka"},
    Box{72.5, -0.8, 73.8, 7.2, "the Maldives"},
    // Cambodia before Thailand
    Box{102.93, 10.5, 103.5, 12.0, ""},
    Box{102.55, 12.5, 103.0, 13.5, ""},
    Box{102.53, 13.5, 103.0, 14.0, ""},
    Box{97.3, 5.5, 103.0, 14.6, "Thailand"},
    Box{97.3, 14.6, 100.8, 20.5, "Thailand"},
    Box{100.8, 14.4, 104.0, 17.8, "Thailand"},
    Box{102.68, 17.8, 103.9, 17.92, "Thailand"},
    Box{102.9, 14.35, 105.6, 15.7, "Thailand"},
    Box{104.0, 15.7, 104.74, 17.6, "Thailand"},
    Box{104.0, 17.1, 104.8, 17.6, "Thailand"},
    // South-East Asia
    Box{99.6, 0.8, 104.5, 7.0, "Malaysia or Singapore"},
    Box{95.0, -11.0, 119.5, 7.5, "Indonesia, Malaysia or Brunei"},
    Box{118.5, -11.0, 141.0, 2.5, "Indonesia or East Timor"},
    Box{124.9, 2.5, 127.5, 4.8, "Indonesia or East Timor"},
    // East Asia without Shenzhen, Zhuhai, Korea and Russia
    Box{113.8, 22.13, 113.96, 22.4, "Hong Kong"},
    Box{113.96, 22.13, 114.5, 22.505, "Hong Kong"},
    Box{113.527, 22.175, 113.6, 22.217, "Macau"},
    Box{113.545, 22.1, 113.6, 22.175, "Macau"},
    Box{124.0, 33.05, 127.2, 43.0, ""},
    Box{127.2, 34.0, 128.95, 43.0, ""},
    Box{128.95, 34.78, 131.0, 41.0, ""},
    Box{128.5, 41.0, 139.2, 46.0, ""},
    Box{145.65, 43.6, 150.0, 46.0, ""},
    Box{128.5, 32.5, 146.2, 45.7, "Japan"},
    Box{122.8, 24.0, 132.0, 33.0, "Japan"},
    Box{139.0, 24.0, 143.0, 32.5, "Japan"},
    // Oceania
    Box{112.0, -44.0, 154.0, -10.0, "Australia"},
    Box{167.8, -29.2, 168.1, -28.9, "Australia"},
    Box{140.8, -12.0, 160.0, -1.0, "Papua New Guinea"},
    Box{155.0, -12.5, 170.5, -5.0, "the Solomon Islands"},
    Box{166.0, -48.0, 179.9, -34.0, "New Zealand"},
    Box{-177.2, -44.6, -175.8, -43.5, "New Zealand"},
    Box{176.8, -19.5, 180.0, -12.0, "Fiji"},
    Box{-180.0, -19.5, -178.2, -12.0, "Fiji"},
    Box{-172.9, -14.1, -171.3, -13.4, "Samoa"},
    Box{-176.3, -22.4, -173.6, -15.5, "Tonga"},
    Box{-170.0, -19.2, -169.7, -18.9, "the Cook Islands or Niue"},
    Box{-160.0, -22.0, -157.2, -8.9, "the Cook Islands or Niue"},
    Box{166.8, -0.6, 167.0, -0.45, "Kiribati, Nauru or Tuvalu"},
    Box{172.8, -2.7, 176.9, 3.4, "Kiribati, Nauru or Tuvalu"},
    Box{176.0, -10.8, 179.9, -5.6, "Kiribati, Nauru or Tuvalu"},
    // Africa: Rwanda, Burundi, Congo and South Sudan before their neighbours
    Box{28.8, -4.5, 30.55, -1.45, ""},
    Box{30.15, -1.45, 30.5, -1.08, ""},
    Box{29.4, 1.0, 30.7, 4.2, ""},
    Box{30.7, 2.5, 30.87, 3.7, ""},
    Box{30.7, 3.72, 31.6, 4.2, ""},
    Box{29.0, -8.3, 30.2, -6.0, ""},
    Box{11.5, -35.0, 18.4, -17.4, "southern Africa"},
    Box{18.4, -35.0, 33.0, -17.91, "southern Africa"},
    Box{29.0, -22.5, 41.0, -10.4, "Mozambique, Malawi, Zambia or Zimbabwe"},
    Box{33.0, -27.0, 36.0, -22.5, "Mozambique, Malawi, Zambia or Zimbabwe"},
    Box{22.0, -18.1, 29.0, -13.0, "Zambia"},
    Box{24.05, -13.0, 27.55, -12.1, "Zambia"},
    Box{24.05, -12.1, 25.3, -11.3, "Zambia"},
    Box{27.55, -13.0, 28.4, -12.45, "Zambia"},
    Box{27.6, -12.45, 27.95, -12.33, "Zambia"},
    Box{28.4, -13.0, 29.0, -12.85, "Zambia"},
    Box{28.7, -12.2, 33.7, -8.55, "Zambia"},
    Box{29.3, -8.55, 33.7, -8.2, "Zambia"},
    Box{29.6, -1.5, 35.0, 4.2, "Uganda"},
    Box{29.6, -11.8, 40.6, -1.0, "Tanzania"},
    Box{33.9, -4.8, 40.98, 3.55, "Kenya"},
    Box{33.9, 3.55, 37.0, 4.7, "Kenya"},
    Box{40.98, -1.7, 41.6, -0.9, "Kenya"},
    Box{40.98, 3.3, 41.87, 4.0, "Kenya"},
    Box{57.2, -20.6, 63.6, -19.6, "Mauritius"},
    Box{55.1, -4.9, 56.1, -4.1, "the Seychelles"},
    // America and the Atlantic: Cuba before the Bahamas
    Box{-85.0, 20.5, -77.3, 23.3, ""},
    Box{-77.8, 19.7, -74.05, 21.7, ""},
    Box{-78.5, 17.6, -76.0, 18.7, "Jamaica"},
    Box{-79.5, 20.8, -72.6, 27.4, "the Bahamas"},
    Box{-72.6, 21.1, -71.0, 22.0, "the Turks and Caicos Islands"},
    Box{-81.5, 19.2, -79.6, 19.9, "the Cayman Islands"},
    Box{-65.1, 17.6, -64.5, 18.45, "the Virgin Islands"},
    Box{-64.85, 18.3, -64.2, 18.8, "the Virgin Islands"},
    Box{-63.2, 18.15, -62.9, 18.3, "Anguilla"},
    Box{-62.9, 17.05, -62.5, 17.45, "Saint Kitts and Nevis"},
    Box{-62.0, 16.95, -61.6, 17.75, "Antigua and Barbuda"},
    Box{-62.3, 16.65, -62.1, 16.85, "Montserrat"},
    Box{-61.5, 15.2, -61.2, 15.65, "Dominica"},
    Box{-61.1, 13.7, -60.85, 14.12, "Saint Lucia"},
    Box{-61.5, 12.5, -61.1, 13.4, "Saint Vincent or Grenada"},
    Box{-61.85, 11.95, -61.35, 12.55, "Saint Vincent or Grenada"},
    Box{-61.95, 9.9, -60.4, 11.4, "Trinidad and Tobago"},
    Box{-59.8, 13.0, -59.3, 13.4, "Barbados"},
    Box{-60.9, 5.3, -56.9, 8.5, "Guyana"},
    Box{-59.85, 1.2, -56.5, 5.3, "Guyana"},
    Box{-58.1, 4.6, -54.04, 6.1, "Suriname"},
    Box{-58.1, 1.8, -54.5, 4.6, "Suriname"},
    Box{-64.9, 32.2, -64.6, 32.5, "Bermuda"},
    Box{-61.5, -52.5, -57.6, -51.0, "the Falkland Islands"},
};

}  // namespace

DrivingSideChoice choose_driving_side(DrivingSide asked, const MapContents& map) {
    if (asked != DrivingSide::by_country) return {asked, "as --driving-side says"};
    const SideTags& lands = map.sides_of_lands;
    if ((lands.left > 0) != (lands.right > 0))
        return {lands.left > 0 ? DrivingSide::left : DrivingSide::right,
                "as a boundary of the map is tagged"};
    const SideTags& roads = map.sides_of_roads;
    const std::size_t most = std::max(roads.left, roads.right);
    if (2 * most > map.roads)
        return {roads.left > roads.right ? DrivingSide::left : DrivingSide::right,
                fmt::format("as {} of {} roads are tagged", most, map.roads)};
    const std::string land = left_driving_land(map.centre);
    const bool is_left = !land.empty();
    std::string reason = is_left ? "as in " + land : "as in most countries";
    if (const std::size_t others = is_left ? roads.right : roads.left; others > 0)
        reason += fmt::format(", though {} of {} roads are tagged otherwise", others, map.roads);
    return {is_left ? DrivingSide::left : DrivingSide::right,
            fmt::format("{}; --driving-side {} changes it", reason, is_left ? "right" : "left")};
}

std::string left_driving_land(roads::Coordinates place) {
    for (const Box& box : boxes) {
        if (place.longitude_deg < box.west || place.longitude_deg > box.east) continue;
        if (place.latitude_deg < box.south || place.latitude_deg > box.north) continue;
        return box.land;
    }
    return "";
}

}  // namespace clearway::scenario_import::detail
