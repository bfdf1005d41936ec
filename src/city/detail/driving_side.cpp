#include "city/detail/driving_side.hpp"

#include <array>

namespace clearway::city::detail {

namespace {

enum class Side : std::uint8_t { left, right };

/// West, south, east, north in degrees.
struct Box {
    double west, south, east, north;
    Side side;
    const char* land;
};

// The first box that holds a place decides, so neighbours that drive on the right and small lands come first.
constexpr std::array boxes = {
    // Europe
    Box{-8.2, 54.0, -5.4, 55.4, Side::left, "Northern Ireland"},
    Box{-11.0, 51.3, -5.9, 55.5, Side::left, "Ireland"},
    Box{1.45, 49.0, 3.0, 51.05, Side::right, ""},
    Box{-2.8, 49.1, -1.9, 49.8, Side::left, "Channel Islands"},
    Box{-8.8, 49.8, 1.9, 61.0, Side::left, "Great Britain"},
    Box{14.1, 35.7, 14.7, 36.2, Side::left, "Malta"},
    Box{32.2, 34.5, 34.7, 35.8, Side::left, "Cyprus"},
    // South and South-East Asia
    Box{60.8, 29.4, 66.3, 36.0, Side::right, ""},
    Box{66.3, 33.2, 69.3, 37.5, Side::right, ""},
    Box{92.6, 9.9, 97.3, 22.0, Side::right, ""},
    Box{93.7, 22.0, 97.3, 24.0, Side::right, ""},
    Box{60.8, 23.5, 78.0, 37.1, Side::left, "Pakistan and north-west India"},
    Box{78.0, 27.9, 79.2, 32.6, Side::left, "India"},
    Box{79.2, 30.4, 92.0, 37.0, Side::right, ""},
    Box{84.8, 28.6, 92.0, 30.4, Side::right, ""},
    Box{68.0, 5.8, 97.4, 30.5, Side::left, "India, Nepal, Bhutan, Bangladesh or Sri Lanka"},
    Box{72.5, -0.8, 73.8, 7.2, Side::left, "Maldives"},
    Box{97.3, 5.5, 103.0, 14.6, Side::left, "Thailand"},
    Box{97.3, 14.6, 100.8, 20.5, Side::left, "Thailand"},
    Box{100.8, 14.4, 104.0, 17.8, Side::left, "Thailand"},
    Box{102.9, 13.6, 105.6, 15.7, Side::left, "Thailand"},
    Box{99.6, 0.8, 104.5, 7.0, Side::left, "Malaysia or Singapore"},
    Box{95.0, -11.0, 119.5, 7.5, Side::left, "Indonesia, Malaysia or Brunei"},
    Box{118.5, -11.0, 141.0, 2.5, Side::left, "Indonesia or East Timor"},
    Box{113.8, 22.13, 114.5, 22.53, Side::left, "Hong Kong"},
    Box{113.5, 22.1, 113.62, 22.22, Side::left, "Macau"},
    Box{128.5, 32.5, 146.2, 45.7, Side::left, "Japan"},
    Box{122.8, 24.0, 132.0, 33.0, Side::left, "Japan"},
    // Oceania
    Box{112.0, -44.0, 154.0, -10.0, Side::left, "Australia"},
    Box{140.8, -12.0, 160.0, -1.0, Side::left, "Papua New Guinea"},
    Box{155.0, -12.5, 170.5, -5.0, Side::left, "Solomon Islands"},
    Box{166.0, -48.0, 179.9, -34.0, Side::left, "New Zealand"},
    Box{176.8, -19.5, 180.0, -12.0, Side::left, "Fiji"},
    // Africa
    Box{29.0, -4.5, 30.8, -1.05, Side::right, ""},
    Box{11.7, -18.0, 21.0, -17.4, Side::right, ""},
    Box{11.5, -35.0, 33.0, -17.4, Side::left, "southern Africa"},
    Box{26.6, -22.5, 41.0, -10.4, Side::left, "Mozambique, Malawi, Zambia or Zimbabwe"},
    Box{22.0, -18.1, 29.0, -13.3, Side::left, "Zambia"},
    Box{28.9, -13.3, 33.7, -8.2, Side::left, "Zambia"},
    Box{29.6, -1.5, 35.0, 4.2, Side::left, "Uganda"},
    Box{29.6, -11.8, 40.6, -1.0, Side::left, "Tanzania"},
    Box{33.9, -4.8, 41.9, 4.7, Side::left, "Kenya"},
    Box{57.2, -20.6, 63.6, -19.6, Side::left, "Mauritius"},
    Box{55.1, -4.9, 56.1, -4.1, Side::left, "Seychelles"},
    // America and the Atlantic
    Box{-78.5, 17.6, -76.0, 18.7, Side::left, "Jamaica"},
    Box{-79.5, 20.8, -72.6, 27.4, Side::left, "Bahamas"},
    Box{-81.5, 19.2, -79.6, 19.9, Side::left, "Cayman Islands"},
    Box{-62.0, 9.9, -60.4, 11.4, Side::left, "Trinidad and Tobago"},
    Box{-59.8, 13.0, -59.3, 13.4, Side::left, "Barbados"},
    Box{-61.4, 1.0, -54.0, 8.6, Side::left, "Guyana or Suriname"},
    Box{-64.9, 32.2, -64.6, 32.5, Side::left, "Bermuda"},
};

}  // namespace

std::string left_driving_land(roads::Coordinates place) {
    for (const Box& box : boxes) {
        if (place.longitude_deg < box.west || place.longitude_deg > box.east) continue;
        if (place.latitude_deg < box.south || place.latitude_deg > box.north) continue;
        return box.side == Side::left ? box.land : "";
    }
    return "";
}

}  // namespace clearway::city::detail
