#include "scenario_import/sumo/demand_reader.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "scenario_import/sumo/draw.hpp"
#include "scenario_import/sumo/input.hpp"
#include "scenario_import/sumo/person_plan.hpp"
#include "scenario_import/sumo/stop.hpp"
#include "scenario_import/sumo/vehicle_type.hpp"

namespace clearway::scenario_import::detail {

namespace {

constexpr const char* default_type = "DEFAULT_VEHTYPE";
constexpr const char* default_person_type = "DEFAULT_PEDTYPE";

/// Attributes that a vehicle keeps; id, type, depart and route are set anew.
constexpr std::array kept_attributes = {"departLane",  "departPos",   "departSpeed",  "departPosLat",
                                        "arrivalLane", "arrivalPos",  "arrivalSpeed", "arrivalPosLat",
                                        "departEdge",  "arrivalEdge", "speedFactor",  "line"};

bool is_traffic(const std::string& name) {
    return name == "vehicle" || name == "trip" || name == "flow";
}

bool is_person(const std::string& name) {
    return name == "person" || name == "personFlow";
}

bool is_container(const std::string& name) {
    return name == "container" || name == "containerFlow";
}

constexpr std::array ends_of_trips = {"from",  "to",           "via",        "fromTaz",
                                      "toTaz", "fromJunction", "toJunction", "viaJunctions"};

/// Departures by what others do.
bool is_waiting(const std::string& depart) {
    return depart == "triggered" || depart == "containerTriggered" || depart == "split";
}

/// Prefix for vehicle ids that collide with Clearway's own.
constexpr const char* imported_prefix = "imported.";

/// Whether an id is one that Clearway gives to an emergency vehicle: `emergency.3`.
bool is_own_id(std::string_view id) {
    constexpr std::string_view own = "emergency.";
    return id.starts_with(own) && id.size() > own.size() &&
           id.find_first_not_of("0123456789", own.size()) == std::string_view::npos;
}

/// Notes what a person would ride with.
void note_lines(const Element& person, std::set<std::string>& lines) {
    for (const Element& stage : person.children) {
        if (stage.name == "ride")
            for (const std::string& line : words(stage.text("lines")))
                lines.insert(line);
        else if (stage.name == "personTrip" && stage.text("modes").find("public") != std::string::npos)
            lines.insert("");
    }
}

/// Takes in what a speed sign keeps in a file of its own. SUMO 1.15 does not read that of a rerouter.
void read_own_file(Element& element, const std::filesystem::path& named_in) {
    if (element.name != "rerouter" && element.name != "variableSpeedSign") return;
    if (element.name == "variableSpeedSign" && !element.text("file").empty())
        for_each_element(named_in.parent_path() / element.text("file"),
                         [&](Element&& child) { element.children.push_back(std::move(child)); });
    element.remove("file");
}

/// Appends a route, as often as it says, to the vehicle's; its stops are delayed by `delay_s`.
void drive(const Element& route, double delay_s, RoadUser& vehicle) {
    const std::vector<std::string> edges = words(route.text("edges"));
    const double repeats = number(route.text("repeat")).value_or(0.0);
    const double cycle_s = time_s(route.text("cycleTime")).value_or(0.0);
    // More than a vehicle can pass in a run.
    constexpr std::size_t most_edges = 10'000;
    for (double row = 0.0; row <= repeats && vehicle.edges.size() < most_edges; ++row) {
        vehicle.edges.insert(vehicle.edges.end(), edges.begin(), edges.end());
        for (const Element& child : route.children) {
            if (child.name != "stop") continue;
            vehicle.element.children.push_back(child);
            if (const double by_s = delay_s + row * cycle_s; by_s != 0.0)
                delay_stop(vehicle.element.children.back(), by_s);
        }
        if (edges.empty()) return;
    }
}

}  // namespace

std::vector<Element> DemandReader::read(const std::filesystem::path& file) {
    std::vector<Element> others;
    std::map<std::filesystem::path, double> last_departs_s;
    std::set<std::filesystem::path> unsorted;
    for_each_input(file, [&](Element&& element, const std::filesystem::path& part) {
        if (is_traffic(element.name)) {
            double& last_depart_s = last_departs_s.try_emplace(part, -1.0).first->second;
            const double depart_s =
                time_s(element.text(element.name == "flow" ? "begin" : "depart")).value_or(last_depart_s);
            if (depart_s < last_depart_s) unsorted.insert(part);
            last_depart_s = std::max(last_depart_s, depart_s);
        }
        element.place = fmt::format("{}:{}", part.string(), element.line);
        if (take(element, part)) return;
        read_own_file(element, part);
        others.push_back(std::move(element));
    });
    demand_.unsorted.insert(demand_.unsorted.end(), unsorted.begin(), unsorted.end());
    return others;
}

std::vector<Element> DemandReader::routes_of_rerouters(const std::vector<Element>& elements) const {
    std::set<std::string> ids;
    for (const Element& rerouter : elements) {
        if (rerouter.name != "rerouter") continue;
        for (const Element& interval : rerouter.children)
            for (const Element& choice : interval.children)
                if (choice.name == "routeProbReroute") ids.insert(choice.text("id"));
    }
    std::vector<Element> distributions;
    for (const std::string& id : std::set(ids)) {
        if (!route_choices_.holds(id)) continue;
        distributions.push_back(route_choices_.element("routeDistribution", id));
        for (const std::string& member : route_choices_.members(id))
            ids.insert(member);
    }
    std::vector<Element> routes;
    for (const std::string& id : ids)
        if (const auto route = routes_.find(id); route != routes_.end()) routes.push_back(route->second);
    routes.insert(routes.end(), distributions.begin(), distributions.end());
    return routes;
}

std::vector<Element> DemandReader::with_named(std::vector<Element> elements) const {
    for (Element& element : elements) {
        std::vector<std::string> types;
        for (const std::string& id : words(element.text("vTypes"))) {
            if (type_choices_.holds(id))
                std::ranges::copy(type_choices_.members(id), std::back_inserter(types));
            else
                types.push_back(id);
        }
        if (!types.empty()) element.set("vTypes", fmt::format("{}", fmt::join(types, " ")));
    }
    const auto others = std::stable_partition(elements.begin(), elements.end(), [](const Element& element) {
        return is_place_of_stops(element.name);
    });
    const std::vector<Element> routes = routes_of_rerouters(elements);
    elements.insert(others, routes.begin(), routes.end());
    return elements;
}

bool DemandReader::take(Element& element, const std::filesystem::path& file) {
    if (is_traffic(element.name)) {
        pending_.push_back({std::move(element), file});
    } else if (is_person(element.name)) {
        pending_persons_.push_back({std::move(element), file});
    } else if (is_container(element.name)) {
        left_out_.add(fmt::format("<{}>, which Clearway does not support", element.name), element.text("id"));
    } else if (element.name == "vType") {
        take_type(element);
    } else if (element.name == "vTypeDistribution") {
        take_distribution(element, type_choices_);
    } else if (element.name == "route") {
        route_choices_.note_probability(element);
        routes_[element.text("id")] = element;
    } else if (element.name == "routeDistribution") {
        take_distribution(element, route_choices_);
    } else {
        return false;
    }
    return true;
}

void DemandReader::take_type(const Element& element) {
    const std::string& id = element.text("id");
    type_choices_.note_probability(element);
    if (const auto scale = number(element.text("scale"))) type_scales_[id] = *scale;
    Element type = element;
    for (const char* const drawn : {"probability", "imgFile", "osgFile", "scale"})
        type.remove(drawn);
    if (const std::string_view older = older_class(type.text("vClass")); !older.empty()) {
        newer_classes_[id] = type.text("vClass");
        type.set("vClass", std::string(older));
    }
    demand_.types[id] = std::move(type);
}

void DemandReader::take_distribution(const Element& element, Distributions& distributions) {
    for (const Element& member : distributions.add(element)) {
        if (member.name == "vType") take_type(member);
        if (member.name == "route" && member.has("edges")) routes_[member.text("id")] = member;
    }
}

Demand DemandReader::finish() {
    for (const Pending& pending : pending_)
        resolve(pending,
                [&](const std::string& id, const Departure& departure) { add(pending, id, departure); });
    for (const Pending& pending : pending_persons_)
        resolve_person(pending);
    if (!problems_.empty()) throw core::InputError(problems_);
    std::set<std::string> used;
    for (const RoadUser& vehicle : demand_.vehicles)
        used.insert(vehicle.type);
    std::erase_if(demand_.types, [&](const auto& type) { return !used.contains(type.first); });
    demand_.names_vehicles = !pending_.empty();
    if (renamed_ > 0)
        demand_.changes.push_back(
            fmt::format("{} with ids of Clearway's own emergency vehicles: prefix \"{}\"",
                        core::counted(renamed_, "vehicle"), imported_prefix));
    report_types();
    return std::move(demand_);
}

void DemandReader::report_types() {
    for (const auto& [id, newer] : newer_classes_) {
        if (!demand_.types.contains(id) && !demand_.person_types.contains(id)) continue;
        demand_.types_made_older.insert(id);
        demand_.changes.push_back(
            fmt::format("type \"{}\" of class {}, which SUMO 1.15 does not know, gets class {}", id, newer,
                        older_class(newer)));
    }
}

void DemandReader::resolve(const Pending& pending, const Take& take) {
    const Element& element = pending.element;
    if (element.name == "flow" || element.name == "personFlow") return resolve_flow(pending, take);
    const std::string& id = element.text("id");
    const std::string& word = element.text("depart");
    auto depart_s = time_s(word);
    if (is_waiting(word)) return left_out_.add("vehicles that wait for passengers or goods", id);
    if (word == "now") depart_s = times_.begin_s;
    if (!depart_s || *depart_s < 0.0 || *depart_s > latest_departure_s)
        return problem(fmt::format("{}:{}", pending.file.string(), element.line), id,
                       fmt::format("depart is \"{}\"", word),
                       fmt::format("a time in s from 0 to {:g}, or h:mm:ss", latest_departure_s));
    const std::size_t count = copies(id, scale_ * scale_of_type(element, id));
    for (std::size_t row = 0; row < count; ++row)
        take(row == 0 ? id : fmt::format("{}.{}", id, row), {row, *depart_s});
}

void DemandReader::resolve_flow(const Pending& pending, const Take& take) {
    const Element& flow = pending.element;
    const bool is_mixed = type_choices_.holds(flow.text("type"));
    const double scale = scale_ * (is_mixed ? 1.0 : scale_of_type(flow, {}));
    if (is_waiting(flow.text("begin")))
        return left_out_.add("flows that wait for passengers or goods", flow.text("id"));
    if (const auto fault = fault_of_flow(flow, times_))
        return problem(fmt::format("{}:{}", pending.file.string(), flow.line), flow.text("id"), *fault,
                       "a begin from 0 s and an end not before it, a whole number, a probability to 1");
    const auto found = departures(flow, times_, scale);
    if (!found)
        return problem(fmt::format("{}:{}", pending.file.string(), flow.line), flow.text("id"),
                       "is a flow without a rate", "number, period, perHour or probability");
    for (const Departure& departure : *found) {
        const std::string id = fmt::format("{}.{}", flow.text("id"), departure.number);
        const std::size_t count = is_mixed ? copies(id, scale_of_type(flow, id)) : 1;
        for (std::size_t row = 0; row < count; ++row)
            take(row == 0 ? id : fmt::format("{}.{}", id, row), departure);
    }
}

/// The type that an element names, or the one that is drawn for `id` if it names a distribution.
std::string DemandReader::type_of(const Element& source, const char* otherwise, const std::string& id) const {
    const std::string type = source.has("type") ? source.text("type") : otherwise;
    return type_choices_.holds(type) ? type_choices_.draw(type, id) : type;
}

void DemandReader::undefined_type(const std::string& type, const std::string& id, const std::string& place) {
    problem(place, id, fmt::format("has the type \"{}\", which is not defined", type),
            "a vType of the route and additional files");
}

double DemandReader::scale_of_type(const Element& source, const std::string& id) const {
    const auto scale = type_scales_.find(type_of(source, default_type, id));
    return scale == type_scales_.end() ? 1.0 : std::max(0.0, scale->second);
}

void DemandReader::resolve_person(const Pending& pending) {
    const Element& person = pending.element;
    const auto reason = unsupported_plan(person);
    if (reason) note_lines(person, demand_.lines_of_left_out);
    if (reason)
        return left_out_.add((person.name == "personFlow" ? "flows of " : "") + *reason, person.text("id"));
    resolve(pending, [&](const std::string& id, const Departure& departure) {
        add_person(pending, id, departure.at_s);
    });
}

void DemandReader::add(const Pending& pending, const std::string& id, const Departure& departure) {
    const Element& source = pending.element;
    RoadUser vehicle;
    vehicle.id = is_own_id(id) ? imported_prefix + id : id;
    renamed_ += is_own_id(id) ? 1U : 0U;
    vehicle.depart_s = departure.at_s;
    vehicle.later_s = departure.later_s;
    vehicle.place = fmt::format("{}:{}", pending.file.string(), source.line);
    if (!note_id(vehicle.id, vehicle.place, places_)) return;
    vehicle.element.name = "vehicle";
    for (const char* const name : kept_attributes)
        if (source.has(name)) vehicle.element.set(name, source.text(name));
    for (const Element& child : source.children) {
        if (child.name != "stop" && child.name != "param") continue;
        vehicle.element.children.push_back(child);
        if (vehicle.later_s != 0.0) delay_stop(vehicle.element.children.back(), vehicle.later_s);
    }
    if (set_type(source, vehicle) && set_way(source, vehicle)) demand_.vehicles.push_back(std::move(vehicle));
}

void DemandReader::add_person(const Pending& pending, const std::string& id, double depart_s) {
    const Element& source = pending.element;
    Person person;
    person.id = id;
    person.depart_s = depart_s;
    person.element = travelling_person(source);
    person.place = fmt::format("{}:{}", pending.file.string(), source.line);
    if (!note_id(id, person.place, person_places_) || !set_type(source, person)) return;
    for (Element& stage : person.element.children)
        if (stage.name == "walk" && !set_edges(stage, person)) return;
    demand_.persons.push_back(std::move(person));
}

bool DemandReader::note_id(const std::string& id, const std::string& place,
                           std::map<std::string, std::string>& places) {
    if (id.empty()) {
        problem(place, id, "has no id");
        return false;
    }
    const auto [earlier, is_new] = places.emplace(id, place);
    if (!is_new)
        problem(place, id, fmt::format("occurs twice, first at {}", earlier->second), "each id once");
    return is_new;
}

bool DemandReader::set_type(const Element& source, Person& person) {
    person.type = type_of(source, default_person_type, person.id);
    if (demand_.person_types.contains(person.type)) return true;
    const auto own = demand_.types.find(person.type);
    if (own == demand_.types.end() && person.type != default_person_type) {
        undefined_type(person.type, person.id, person.place);
        return false;
    }
    Element type;
    type.name = "vType";
    type.set("id", person.type);
    if (own != demand_.types.end()) type = own->second;
    if (!type.has("vClass")) {
        // SUMO takes such a type for a car type, warns, and lets people walk at 200 km/h.
        if (own != demand_.types.end()) demand_.types_made_pedestrian.insert(person.type);
        type.set("vClass", "pedestrian");
    }
    if (type.text("vClass") != "pedestrian") {
        left_out_.add("persons of a class that does not walk", person.id);
        return false;
    }
    demand_.person_types[person.type] = std::move(type);
    return true;
}

/// Replaces the id of a route by its edges.
bool DemandReader::set_edges(Element& walk, const Person& person) {
    if (!walk.has("route")) return true;
    const Element* const route = find_route(walk.text("route"), person.id, person.place);
    if (route == nullptr) return false;
    walk.remove("route");
    walk.set("edges", route->text("edges"));
    return true;
}

bool DemandReader::set_type(const Element& source, RoadUser& vehicle) {
    vehicle.type = type_of(source, default_type, vehicle.id);
    if (demand_.types.contains(vehicle.type)) return true;
    if (!vehicle.type.starts_with("DEFAULT_")) {
        undefined_type(vehicle.type, vehicle.id, vehicle.place);
        return false;
    }
    Element type;
    type.name = "vType";
    type.set("id", vehicle.type);
    if (vehicle.type == "DEFAULT_BIKETYPE") type.set("vClass", "bicycle");
    if (vehicle.type == "DEFAULT_TAXITYPE") type.set("vClass", "taxi");
    demand_.types[vehicle.type] = type;
    return true;
}

bool DemandReader::set_way(const Element& source, RoadUser& vehicle) {
    if (source.has("route")) {
        const Element* const route = find_route(source.text("route"), vehicle.id, vehicle.place);
        if (route == nullptr) return false;
        // SUMO counts the times of such a route's stops from the departure.
        drive(*route, vehicle.depart_s, vehicle);
    } else if (const std::optional<Element> route = inline_route(source, vehicle)) {
        drive(*route, vehicle.later_s, vehicle);
    } else {
        set_trip(source, vehicle);
        return true;
    }
    if (!vehicle.edges.empty()) return true;
    problem(vehicle.place, vehicle.id, "has a route without edges");
    return false;
}

/// The route inside a vehicle, or the one that duarouter last chose from the distribution inside it.
std::optional<Element> DemandReader::inline_route(const Element& source, const RoadUser& vehicle) {
    for (const Element& child : source.children) {
        if (child.name == "route") return child;
        if (child.name != "routeDistribution") continue;
        std::vector<std::string> ids;
        Distributions inside("routes");
        const std::vector<Element> routes = inside.add(child, &ids);
        const auto last = number(child.text("last"));
        const bool has_last = last && *last >= 0.0 && *last < static_cast<double>(ids.size());
        const std::string id =
            has_last ? ids[static_cast<std::size_t>(*last)] : inside.draw(child.text("id"), vehicle.id);
        const auto own =
            std::ranges::find_if(routes, [&](const Element& route) { return route.text("id") == id; });
        if (own != routes.end()) return *own;
        const Element* const named = find_route(id, vehicle.id, vehicle.place);
        return named == nullptr ? Element{} : *named;
    }
    return std::nullopt;
}

void DemandReader::set_trip(const Element& source, RoadUser& vehicle) {
    vehicle.is_trip = true;
    vehicle.trip.name = "trip";
    for (const char* const name : ends_of_trips)
        if (source.has(name)) vehicle.trip.set(name, source.text(name));
}

const Element* DemandReader::find_route(std::string id, const std::string& user, const std::string& place) {
    if (route_choices_.holds(id)) id = route_choices_.draw(id, user);
    const auto found = routes_.find(id);
    if (found != routes_.end()) return &found->second;
    problem(place, user, fmt::format("has the route \"{}\", which is not defined", id),
            "a route of the route and additional files");
    return nullptr;
}

void DemandReader::problem(const std::string& place, const std::string& id, std::string what,
                           std::string allowed) {
    if (!named_problems_.insert(fmt::format("{} {} {}", place, without_number(id), what)).second) return;
    problems_.push_back({fmt::format("{}: \"{}\"", place, id), std::move(what), std::move(allowed), ""});
}

std::string without_number(const std::string& id) {
    const std::size_t dot = id.find_last_not_of("0123456789");
    return dot != std::string::npos && id[dot] == '.' ? id.substr(0, dot) : id;
}

}  // namespace clearway::scenario_import::detail
