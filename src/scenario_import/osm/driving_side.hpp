#pragma once

#include <string>

#include "roads/geography.hpp"
#include "scenario_import/import.hpp"
#include "scenario_import/osm/map_contents.hpp"

namespace clearway::scenario_import::detail {

/// On which side traffic drives, and why, in words.
struct DrivingSideChoice {
    DrivingSide side = DrivingSide::right;
    std::string reason;
};

/// In this order: `asked`, unless it is by_country; the tagged boundaries of the map, if they agree; the
/// tagged roads, if they are more than half of all roads, because single roads cross over in interchanges;
/// the country.
DrivingSideChoice choose_driving_side(DrivingSide asked, const MapContents& map);

/// The country at a place if traffic drives on the left there; empty if it drives on the right. Boxes are
/// accurate to about a tenth of a degree, so places within some 10 km of a border may be wrong.
std::string left_driving_land(roads::Coordinates place);

/// The text of driving_sides.csv.
extern const char* const driving_sides;

}  // namespace clearway::scenario_import::detail
