#include "scenario_import/sumo/stop.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace clearway::scenario_import::detail {

namespace {

constexpr std::array kinds = {"busStop",         "trainStop",   "containerStop",
                              "chargingStation", "parkingArea", "overheadWireSegment"};

/// `first` of `first_0`.
std::string edge_of_lane(const std::string& lane) {
    return lane.substr(0, lane.rfind('_'));
}

bool waits(const Element& stop) {
    constexpr std::array flags = {"triggered", "containerTriggered"};
    constexpr std::array whom = {"expected", "expectedContainers", "join", "split"};
    return std::ranges::any_of(
               flags, [&](const char* name) { return stop.has(name) && !is_false(stop.text(name)); }) ||
           std::ranges::any_of(whom, [&](const char* name) { return !stop.text(name).empty(); });
}

}  // namespace

bool is_place_of_stops(const std::string& name) {
    return std::ranges::find(kinds, name) != kinds.end();
}

void end_waiting(Element& vehicle, LeftOut& left_out) {
    std::erase_if(vehicle.children, [&](Element& stop) {
        if (stop.name != "stop" || !waits(stop)) return false;
        const bool ends = stop.has("duration") || stop.has("until");
        left_out.add(ends ? "waits for passengers, goods or vehicles at stops, which now last their duration"
                          : "stops that wait for passengers, goods or vehicles and have no duration",
                     vehicle.text("id"));
        for (const char* const name : {"triggered", "containerTriggered", "expected", "expectedContainers",
                                       "permitted", "join", "split"})
            stop.remove(name);
        return !ends;
    });
}

StopEdges::StopEdges(const std::vector<Element>& additional) {
    for (const Element& element : additional)
        if (is_place_of_stops(element.name))
            edges_[{element.name, element.text("id")}] = edge_of_lane(element.text("lane"));
}

std::string StopEdges::edge_of(const Element& stop) const {
    if (stop.has("lane")) return edge_of_lane(stop.text("lane"));
    if (stop.has("edge")) return stop.text("edge");
    for (const char* const kind : kinds) {
        const auto found = edges_.find({kind, stop.text(kind)});
        if (found != edges_.end()) return found->second;
    }
    return {};
}

std::optional<std::string> StopEdges::unknown_place(const Element& stop) const {
    for (const char* const kind : kinds)
        if (!stop.text(kind).empty() && !edges_.contains({kind, stop.text(kind)}))
            return fmt::format("{} \"{}\"", kind, stop.text(kind));
    return std::nullopt;
}

}  // namespace clearway::scenario_import::detail
