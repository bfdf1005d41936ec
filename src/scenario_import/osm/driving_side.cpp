#include "scenario_import/osm/driving_side.hpp"

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/csv.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// An area in degrees, and its country if traffic drives on the left there; empty if on the right.
struct Box {
    double west, south, east, north;
    std::string land;
};

/// The rows of driving_sides.csv, which becomes part of the program.
const std::vector<Box>& boxes() {
    static const std::vector<Box> all = [] {
        std::vector<Box> rows;
        core::CsvReader reader(driving_sides);
        bool is_past_header = false;
        while (reader.next()) {
            const auto& cells = reader.cells();
            if (cells.front().starts_with('#') || !std::exchange(is_past_header, true)) continue;
            assert(cells.size() == 5);
            Box& box = rows.emplace_back();
            std::size_t at = 0;
            for (double* const edge : {&box.west, &box.south, &box.east, &box.north})
                core::read_cell(cells[at++], *edge);
            box.land = cells[at];
        }
        return rows;
    }();
    return all;
}

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
    for (const Box& box : boxes()) {
        if (place.longitude_deg < box.west || place.longitude_deg > box.east) continue;
        if (place.latitude_deg < box.south || place.latitude_deg > box.north) continue;
        return box.land;
    }
    return "";
}

}  // namespace clearway::scenario_import::detail
