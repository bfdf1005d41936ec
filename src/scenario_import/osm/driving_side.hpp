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

/// `asked` decides unless it is by_country; then the boundaries of the map that say so, when they agree; then
/// the roads, when most of all roads say so, for single ones lie crosswise in interchanges; then the country.
DrivingSideChoice choose_driving_side(DrivingSide asked, const MapContents& map);

/// The land at a place where traffic drives on the left, empty where it drives on the right. By boxes of
/// about a tenth of a degree, so a place within some 10 km of a border may be told wrong.
std::string left_driving_land(roads::Coordinates place);

}  // namespace clearway::scenario_import::detail
