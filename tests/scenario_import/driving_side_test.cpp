// On which side traffic drives in a map: by its tags, else by the country.
#include "scenario_import/osm/driving_side.hpp"

#include <gmock/gmock.h>

namespace clearway::scenario_import::detail {
namespace {

using testing::HasSubstr;

struct Town {
    const char* name;
    double latitude_deg, longitude_deg;
};

// Towns near borders between the sides, and islands.
constexpr Town left_towns[] = {
    {"Dover", 51.127, 1.313},
    {"Brighton", 50.82, -0.14},
    {"Londonderry", 55.0, -7.31},
    {"Saint Helier", 49.187, -2.107},
    {"Valletta", 35.9, 14.51},
    {"Limassol", 34.68, 33.04},
    {"Peshawar", 34.01, 71.58},
    {"Quetta", 30.2, 67.01},
    {"Parachinar", 33.9, 70.1},
    {"Gwadar", 25.12, 62.33},
    {"Gilgit", 35.92, 74.31},
    {"Leh", 34.15, 77.58},
    {"Kathmandu", 27.7, 85.32},
    {"Thimphu", 27.47, 89.64},
    {"Imphal", 24.82, 93.94},
    {"Aizawl", 23.73, 92.72},
    {"Chittagong", 22.34, 91.83},
    {"Port Blair", 11.67, 92.735},
    {"Mae Sot", 16.715, 98.57},
    {"Chiang Mai", 18.79, 98.98},
    {"Aranyaprathet", 13.69, 102.5},
    {"Mukdahan", 16.54, 104.72},
    {"Nong Khai", 17.88, 102.74},
    {"Trat", 12.24, 102.51},
    {"Singapore", 1.35, 103.82},
    {"Kota Kinabalu", 5.98, 116.07},
    {"Manado", 1.49, 124.84},
    {"Dili", -8.56, 125.57},
    {"Hong Kong", 22.32, 114.17},
    {"Sheung Shui", 22.5, 114.128},
    {"Macau", 22.197, 113.545},
    {"Tsushima", 34.2, 129.29},
    {"Fukuoka", 33.59, 130.4},
    {"Nemuro", 43.33, 145.58},
    {"Naha", 26.21, 127.68},
    {"Suva", -18.14, 178.44},
    {"Taveuni", -16.85, -179.97},
    {"Apia", -13.83, -171.77},
    {"Kisoro", -1.285, 29.69},
    {"Kabale", -1.25, 29.98},
    {"Arua", 3.02, 30.91},
    {"Kitwe", -12.81, 28.21},
    {"Ndola", -12.97, 28.64},
    {"Solwezi", -12.17, 26.39},
    {"Oshakati", -17.79, 15.7},
    {"Rundu", -17.92, 19.77},
    {"Kigoma", -4.88, 29.63},
    {"Maputo", -25.97, 32.57},
    {"Inhambane", -23.87, 35.38},
    {"Lokichoggio", 4.2, 34.35},
    {"Mandera", 3.93, 41.86},
    {"Nassau", 25.05, -77.35},
    {"Matthew Town", 20.95, -73.67},
    {"Providenciales", 21.78, -72.27},
    {"Charlotte Amalie", 18.34, -64.93},
    {"Road Town", 18.43, -64.62},
    {"Basseterre", 17.3, -62.72},
    {"Castries", 14.01, -60.99},
    {"Port of Spain", 10.65, -61.51},
    {"Lethem", 3.38, -59.8},
    {"Georgetown", 6.8, -58.16},
    {"Paramaribo", 5.85, -55.2},
    {"Stanley", -51.7, -57.85},
};
constexpr Town right_towns[] = {
    {"Dieppe", 49.92, 1.08},
    {"Calais", 50.95, 1.86},
    {"Cherbourg", 49.64, -1.62},
    {"Dunkirk", 51.03, 2.38},
    {"Tripoli", 32.89, 13.19},
    {"Antalya", 36.89, 30.7},
    {"Jalalabad", 34.43, 70.45},
    {"Khost", 33.34, 69.92},
    {"Kandahar", 31.62, 65.71},
    {"Qalat", 32.1, 66.9},
    {"Zahedan", 29.5, 60.86},
    {"Saravan", 27.37, 62.33},
    {"Chabahar", 25.3, 60.64},
    {"Faizabad", 37.12, 70.58},
    {"Lhasa", 29.65, 91.12},
    {"Nyingchi", 29.65, 94.36},
    {"Sittwe", 20.14, 92.9},
    {"Myitkyina", 25.38, 97.4},
    {"Mawlamyine", 16.49, 97.63},
    {"Dawei", 14.08, 98.2},
    {"Myeik", 12.44, 98.6},
    {"Vientiane", 17.97, 102.63},
    {"Savannakhet", 16.56, 104.76},
    {"Poipet", 13.66, 102.56},
    {"Koh Kong", 11.61, 102.98},
    {"Samraong", 14.18, 103.52},
    {"General Santos", 6.11, 125.17},
    {"Taipei", 25.04, 121.56},
    {"Shekou", 22.48, 113.91},
    {"Shenzhen", 22.543, 114.06},
    {"Zhuhai", 22.27, 113.57},
    {"Busan", 35.18, 129.08},
    {"Pohang", 36.02, 129.36},
    {"Seogwipo", 33.25, 126.56},
    {"Vladivostok", 43.12, 131.89},
    {"Yuzhno-Kurilsk", 44.03, 145.85},
    {"Noumea", -22.27, 166.45},
    {"Port Vila", -17.73, 168.32},
    {"Pago Pago", -14.28, -170.7},
    {"Kigali", -1.95, 30.06},
    {"Bujumbura", -3.38, 29.36},
    {"Goma", -1.68, 29.23},
    {"Bunia", 1.56, 30.25},
    {"Yei", 4.09, 30.68},
    {"Juba", 4.85, 31.6},
    {"Lubumbashi", -11.66, 27.48},
    {"Likasi", -10.98, 26.73},
    {"Ondjiva", -17.07, 15.73},
    {"Kismayo", -0.36, 42.54},
    {"Dobley", 0.41, 41.01},
    {"Moroni", -11.7, 43.26},
    {"Saint-Denis", -20.88, 55.45},
    {"Camaguey", 21.38, -77.92},
    {"Havana", 23.13, -82.36},
    {"Guantanamo", 20.14, -75.21},
    {"Miami", 25.77, -80.19},
    {"Key West", 24.56, -81.78},
    {"San Juan", 18.44, -66.1},
    {"Marigot", 18.07, -63.08},
    {"Pointe-a-Pitre", 16.24, -61.53},
    {"Fort-de-France", 14.6, -61.07},
    {"Guiria", 10.57, -62.3},
    {"Boa Vista", 2.82, -60.67},
    {"Saint-Laurent-du-Maroni", 5.5, -54.03},
    {"Cayenne", 4.92, -52.31},
};

TEST(DrivingSide, towns_near_borders_are_told_right) {
    for (const Town& town : left_towns)
        EXPECT_NE(left_driving_land({town.longitude_deg, town.latitude_deg}), "") << town.name;
    for (const Town& town : right_towns)
        EXPECT_EQ(left_driving_land({town.longitude_deg, town.latitude_deg}), "") << town.name;
}

MapContents map_at(double longitude_deg, double latitude_deg) {
    MapContents map;
    map.roads = 40;
    map.centre = {longitude_deg, latitude_deg};
    return map;
}

TEST(DrivingSide, single_roads_do_not_turn_a_country_round) {
    MapContents map = map_at(-73.99, 40.74);
    map.sides_of_roads = {3, 0};
    const DrivingSideChoice choice = choose_driving_side(DrivingSide::by_country, map);
    EXPECT_EQ(choice.side, DrivingSide::right);
    EXPECT_THAT(choice.reason, HasSubstr("though 3 of 40 roads are tagged otherwise"));
    MapContents london = map_at(-0.12, 51.51);
    london.sides_of_roads = {0, 1};
    EXPECT_EQ(choose_driving_side(DrivingSide::by_country, london).side, DrivingSide::left);
}

TEST(DrivingSide, most_roads_or_a_boundary_decide) {
    MapContents map = map_at(-73.99, 40.74);
    map.sides_of_roads = {21, 0};
    const DrivingSideChoice by_roads = choose_driving_side(DrivingSide::by_country, map);
    EXPECT_EQ(by_roads.side, DrivingSide::left);
    EXPECT_THAT(by_roads.reason, HasSubstr("21 of 40 roads"));
    map.sides_of_lands = {0, 1};
    EXPECT_EQ(choose_driving_side(DrivingSide::by_country, map).side, DrivingSide::right);
    map.sides_of_lands = {1, 1};
    EXPECT_EQ(choose_driving_side(DrivingSide::by_country, map).side, DrivingSide::left)
        << "lands that disagree do not decide";
    EXPECT_EQ(choose_driving_side(DrivingSide::right, map).side, DrivingSide::right);
}

TEST(DrivingSide, what_was_decided_is_always_explained) {
    EXPECT_THAT(choose_driving_side(DrivingSide::by_country, map_at(77.59, 12.97)).reason,
                HasSubstr("as in India"));
    EXPECT_THAT(choose_driving_side(DrivingSide::by_country, map_at(13.4, 52.5)).reason,
                HasSubstr("as in most countries; --driving-side left"));
    EXPECT_THAT(choose_driving_side(DrivingSide::left, map_at(13.4, 52.5)).reason,
                HasSubstr("--driving-side"));
}

}  // namespace
}  // namespace clearway::scenario_import::detail
