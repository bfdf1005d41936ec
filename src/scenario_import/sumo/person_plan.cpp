#include "scenario_import/sumo/person_plan.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace clearway::scenario_import::detail {

namespace {

constexpr std::array person_attributes = {"departPos", "speedFactor"};
constexpr std::array walk_attributes = {"edges",      "route",        "from",  "to",
                                        "arrivalPos", "departPosLat", "speed", "duration"};
constexpr std::array ride_attributes = {"from", "to", "lines", "arrivalPos", "intended"};
constexpr std::array stop_attributes = {"lane", "edge", "startPos", "endPos", "duration", "until", "actType"};
/// With any of these, a `<personTrip>` may become a ride.
constexpr std::array riding_attributes = {"modes", "vTypes", "lines"};
/// Ends of walks that are neither edges nor stops.
constexpr std::array vague_ends = {"fromTaz", "toTaz",      "fromJunction", "toJunction", "viaJunctions",
                                   "fromXY",  "fromLonLat", "toXY",         "toLonLat"};

template <class Names>
bool has_any(const Element& element, const Names& names) {
    return std::ranges::any_of(names, [&](const char* name) { return !element.text(name).empty(); });
}

template <class Names>
void keep(const Element& source, const Names& names, Element& target) {
    for (const char* const name : names)
        if (!source.text(name).empty()) target.set(name, source.text(name));
}

bool is_walk(const Element& stage) {
    return stage.name == "walk" || stage.name == "personTrip";
}

bool is_taxi(const std::string& line) {
    return line == "taxi" || line.starts_with("taxi:");
}

std::optional<std::string> reason_of_stage(const Element& stage) {
    if (stage.name == "ride")
        return std::ranges::any_of(words(stage.text("lines")), is_taxi)
                   ? std::optional<std::string>("persons who take a taxi")
                   : std::nullopt;
    if (stage.name == "personTrip" && has_any(stage, riding_attributes)) return "persons who may ride";
    if (stage.name == "stop")
        return has_any(stage, std::array{"duration", "until"})
                   ? std::nullopt
                   : std::optional<std::string>("persons who stop without a stated end");
    if (!is_walk(stage)) return fmt::format("persons with a <{}>", stage.name);
    if (has_any(stage, vague_ends)) return "persons who walk between zones, junctions or coordinates";
    return std::nullopt;
}

}  // namespace

const char* named_stop(const Element& stage) {
    for (const char* const kind : stop_kinds)
        if (!stage.text(kind).empty()) return kind;
    return nullptr;
}

std::optional<std::string> unsupported_plan(const Element& person) {
    if (has_any(person, riding_attributes)) return "persons who may ride";
    bool moves = false;
    for (const Element& stage : person.children) {
        if (stage.name == "param") continue;
        if (auto reason = reason_of_stage(stage)) return reason;
        moves |= is_walk(stage) || stage.name == "ride";
    }
    if (person.text("depart") == "triggered" || person.text("begin") == "triggered")
        return "persons who wait for a vehicle";
    return moves ? std::nullopt : std::optional<std::string>("persons who do not walk");
}

Element travelling_person(const Element& person) {
    Element walker;
    walker.name = "person";
    keep(person, person_attributes, walker);
    for (const Element& stage : person.children) {
        if (stage.name == "param") continue;  // For devices and outputs, which do not exist here.
        Element kept;
        kept.name = is_walk(stage) ? "walk" : stage.name;
        kept.line = stage.line;
        keep(stage, stop_kinds, kept);
        if (is_walk(stage))
            keep(stage, walk_attributes, kept);
        else if (stage.name == "ride")
            keep(stage, ride_attributes, kept);
        else
            keep(stage, stop_attributes, kept);
        walker.children.push_back(std::move(kept));
    }
    return walker;
}

}  // namespace clearway::scenario_import::detail
