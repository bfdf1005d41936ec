#include "city/detail/demand_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "city/detail/person_plan.hpp"
#include "core/ids.hpp"
#include "core/random.hpp"

namespace clearway::city::detail {

namespace {

constexpr const char* default_type = "DEFAULT_VEHTYPE";
constexpr const char* default_person_type = "DEFAULT_PEDTYPE";

/// What a vehicle keeps of its attributes; id, type, depart and route are set anew.
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

/// Uniform in [0, 1) from an id and a counter, the same wherever it is drawn.
double uniform(const std::string& id, std::uint64_t counter) {
    const core::KeyedRandom random(core::StudySeed{}, core::Replication{});
    return random.uniform(core::Purpose::demand, core::vehicle_key(id).value, counter);
}

}  // namespace

void LeftOut::add(const std::string& what, const std::string& example) {
    constexpr std::size_t most_examples = 3;
    Count& count = counts_[what];
    ++count.number;
    if (!example.empty() && count.examples.size() < most_examples) count.examples.push_back(example);
}

std::vector<std::string> LeftOut::lines() const {
    std::vector<std::string> lines;
    for (const auto& [what, count] : counts_) {
        std::string line = fmt::format("{} {}", count.number, what);
        if (!count.examples.empty())
            line += fmt::format(" ({}{})", fmt::join(count.examples, ", "),
                                count.number > count.examples.size() ? ", ..." : "");
        lines.push_back(std::move(line));
    }
    return lines;
}

std::vector<Element> DemandReader::read(const std::filesystem::path& file) {
    std::vector<Element> others;
    double last_depart_s = -1.0;
    bool sorted = true;
    for_each_element(file, [&](Element&& element) {
        if (element.name == "vehicle" || element.name == "trip") {
            const double depart_s = time_s(element.text("depart")).value_or(last_depart_s);
            sorted &= depart_s >= last_depart_s;
            last_depart_s = std::max(last_depart_s, depart_s);
        }
        if (!take(element, file)) others.push_back(std::move(element));
    });
    if (!sorted) demand_.unsorted.push_back(file);
    return others;
}

bool DemandReader::take(Element& element, const std::filesystem::path& file) {
    if (is_traffic(element.name)) {
        pending_.push_back({std::move(element), file});
    } else if (is_person(element.name)) {
        pending_persons_.push_back({std::move(element), file});
    } else if (is_container(element.name)) {
        left_out_.add(fmt::format("<{}>, which Clearway has no place for", element.name), element.text("id"));
    } else if (element.name == "vType") {
        take_type(element);
    } else if (element.name == "vTypeDistribution") {
        take_distribution(element, type_choices_);
    } else if (element.name == "route") {
        routes_[element.text("id")] = element;
    } else if (element.name == "routeDistribution") {
        take_distribution(element, route_choices_);
    } else {
        return false;
    }
    return true;
}

void DemandReader::take_type(const Element& element) {
    Element type = element;
    for (const char* const drawn : {"probability", "imgFile", "osgFile"})
        type.remove(drawn);
    demand_.types[element.text("id")] = std::move(type);
}

void DemandReader::take_distribution(const Element& element, std::map<std::string, Choice>& choices) {
    Choice& choice = choices[element.text("id")];
    const bool of_types = element.name == "vTypeDistribution";
    const std::vector<std::string> weights = words(element.text("probabilities"));
    std::size_t row = 0;
    for (const std::string& id : words(element.text(of_types ? "vTypes" : "routes"))) {
        choice.ids.push_back(id);
        choice.weights.push_back(row < weights.size() ? number(weights[row]).value_or(1.0) : 1.0);
        ++row;
    }
    for (const Element& member : element.children) {
        std::string id = member.text("id").empty() ? member.text("refId") : member.text("id");
        if (id.empty()) id = fmt::format("{}#{}", element.text("id"), choice.ids.size());
        choice.weights.push_back(member.has("probability") ? number(member.text("probability")).value_or(1.0)
                                                           : 1.0);
        choice.ids.push_back(id);
        Element named = member;
        named.set("id", id);
        if (member.name == "vType") take_type(named);
        if (member.name == "route" && member.has("edges")) routes_[id] = named;
    }
}

Demand DemandReader::finish() {
    for (const Pending& pending : pending_)
        resolve(pending, [&](const std::string& id, double depart_s) { add(pending, id, depart_s); });
    for (const Pending& pending : pending_persons_)
        resolve_person(pending);
    if (!problems_.empty()) throw core::InputError(problems_);
    std::set<std::string> used;
    for (const RoadUser& vehicle : demand_.vehicles)
        used.insert(vehicle.type);
    std::erase_if(demand_.types, [&](const auto& type) { return !used.contains(type.first); });
    return std::move(demand_);
}

void DemandReader::resolve(const Pending& pending, const Take& take) {
    const Element& element = pending.element;
    if (element.name == "flow" || element.name == "personFlow") return resolve_flow(pending, take);
    const auto depart_s = time_s(element.text("depart"));
    if (depart_s) return take(element.text("id"), *depart_s);
    const std::string& word = element.text("depart");
    if (word == "triggered" || word == "containerTriggered" || word == "split")
        return left_out_.add("vehicles that wait for passengers or goods", element.text("id"));
    if (word == "now") return take(element.text("id"), times_.begin_s);
    problem(fmt::format("{}:{}", pending.file.string(), element.line), element.text("id"),
            fmt::format("depart is \"{}\"", word), "a time in s, or h:mm:ss");
}

void DemandReader::resolve_flow(const Pending& pending, const Take& take) {
    const std::string place = fmt::format("{}:{}", pending.file.string(), pending.element.line);
    std::size_t row = 0;
    for (const double depart_s : departures(pending.element, place))
        take(fmt::format("{}.{}", pending.element.text("id"), row++), depart_s);
}

void DemandReader::resolve_person(const Pending& pending) {
    const Element& person = pending.element;
    if (const auto reason = reason_not_to_walk(person))
        return left_out_.add((person.name == "personFlow" ? "flows of " : "") + *reason, person.text("id"));
    resolve(pending, [&](const std::string& id, double depart_s) { add_person(pending, id, depart_s); });
}

std::vector<double> DemandReader::departures(const Element& flow, const std::string& place) {
    const std::string& id = flow.text("id");
    const double begin_s =
        flow.has("begin") ? time_s(flow.text("begin")).value_or(times_.begin_s) : times_.begin_s;
    const double end_s = flow.has("end") ? time_s(flow.text("end")).value_or(times_.end_s) : times_.end_s;
    const auto count = number(flow.text("number"));
    std::vector<double> times;
    const auto regular = [&](double period_s) {
        const double most = count.value_or(1e9);
        for (double row = 0; row < most && begin_s + row * period_s < end_s; ++row)
            times.push_back(begin_s + row * period_s);
    };
    const std::string& period = flow.text("period");
    std::string hourly = flow.text("perHour");
    for (const char* const name : {"vehsPerHour", "personsPerHour"})
        if (flow.has(name)) hourly = flow.text(name);
    if (period.starts_with("exp(")) {
        const double rate = number(period.substr(4, period.find(')') - 4)).value_or(0.0);
        std::uint64_t draw = 0;
        for (double at_s = begin_s; rate > 0.0;) {
            at_s -= std::log1p(-uniform(id, draw++)) / rate;
            if (at_s >= end_s) break;
            times.push_back(std::round(at_s * 100.0) / 100.0);
        }
    } else if (number(period).value_or(0.0) > 0.0) {
        regular(*number(period));
    } else if (number(hourly).value_or(0.0) > 0.0) {
        regular(3600.0 / *number(hourly));
    } else if (flow.has("probability")) {
        const double chance = number(flow.text("probability")).value_or(0.0);
        for (std::uint64_t second = 0; begin_s + static_cast<double>(second) < end_s; ++second)
            if (uniform(id, second) < chance) times.push_back(begin_s + static_cast<double>(second));
    } else if (count && *count > 0.0) {
        regular((end_s - begin_s) / *count);
    } else if (!number(hourly) && !count) {
        problem(place, id, "is a flow without a rate", "number, period, perHour or probability");
    }
    return times;
}

void DemandReader::add(const Pending& pending, const std::string& id, double depart_s) {
    const Element& source = pending.element;
    RoadUser vehicle;
    vehicle.id = id;
    vehicle.depart_s = depart_s;
    vehicle.place = fmt::format("{}:{}", pending.file.string(), source.line);
    if (!note_id(id, vehicle.place, places_)) return;
    vehicle.element.name = "vehicle";
    for (const char* const name : kept_attributes)
        if (source.has(name)) vehicle.element.set(name, source.text(name));
    for (const Element& child : source.children)
        if (child.name == "stop" || child.name == "param") vehicle.element.children.push_back(child);
    if (set_type(source, vehicle) && set_way(source, vehicle)) demand_.vehicles.push_back(std::move(vehicle));
}

void DemandReader::add_person(const Pending& pending, const std::string& id, double depart_s) {
    const Element& source = pending.element;
    Person person;
    person.id = id;
    person.depart_s = depart_s;
    person.element = walking_person(source);
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
    person.type = source.has("type") ? source.text("type") : default_person_type;
    const auto choice = type_choices_.find(person.type);
    if (choice != type_choices_.end()) person.type = chosen(choice->second, person.id);
    if (demand_.person_types.contains(person.type)) return true;
    const auto own = demand_.types.find(person.type);
    if (own == demand_.types.end() && person.type != default_person_type) {
        problem(person.place, person.id,
                fmt::format("has the type \"{}\", which is not defined", person.type),
                "a vType of the route and additional files");
        return false;
    }
    Element type;
    type.name = "vType";
    type.set("id", person.type);
    if (own != demand_.types.end()) type = own->second;
    if (!type.has("vClass")) {
        // SUMO takes such a type for a car's, warns, and people walk at 200 km/h.
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
    vehicle.type = source.has("type") ? source.text("type") : default_type;
    const auto choice = type_choices_.find(vehicle.type);
    if (choice != type_choices_.end()) vehicle.type = chosen(choice->second, vehicle.id);
    if (demand_.types.contains(vehicle.type)) return true;
    if (!vehicle.type.starts_with("DEFAULT_")) {
        problem(vehicle.place, vehicle.id,
                fmt::format("has the type \"{}\", which is not defined", vehicle.type),
                "a vType of the route and additional files");
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
    const Element* route = nullptr;
    for (const Element& child : source.children)
        if (child.name == "route") route = &child;
    if (source.has("route")) {
        route = find_route(source.text("route"), vehicle.id, vehicle.place);
        if (route == nullptr) return false;
    }
    if (route != nullptr) {
        vehicle.edges = words(route->text("edges"));
        for (const Element& child : route->children)
            if (child.name == "stop") vehicle.element.children.push_back(child);
        if (!vehicle.edges.empty()) return true;
        problem(vehicle.place, vehicle.id, "has a route without edges");
        return false;
    }
    if (!source.has("from") || !source.has("to")) {
        left_out_.add("vehicles between zones or junctions, or without a way", vehicle.id);
        return false;
    }
    vehicle.is_trip = true;
    vehicle.edges = {source.text("from")};
    for (std::string& edge : words(source.text("via")))
        vehicle.edges.push_back(std::move(edge));
    vehicle.edges.push_back(source.text("to"));
    return true;
}

const Element* DemandReader::find_route(std::string id, const std::string& user, const std::string& place) {
    const auto choice = route_choices_.find(id);
    if (choice != route_choices_.end()) id = chosen(choice->second, user);
    const auto found = routes_.find(id);
    if (found != routes_.end()) return &found->second;
    problem(place, user, fmt::format("has the route \"{}\", which is not defined", id),
            "a route of the route and additional files");
    return nullptr;
}

std::string DemandReader::chosen(const Choice& choice, const std::string& id) const {
    if (choice.ids.empty()) return {};
    double sum = 0.0;
    for (const double weight : choice.weights)
        sum += weight;
    constexpr std::uint64_t choice_draw = 1'000'000'000;
    double left = uniform(id, choice_draw) * sum;
    for (std::size_t row = 0; row + 1 < choice.ids.size(); ++row) {
        if (left < choice.weights[row]) return choice.ids[row];
        left -= choice.weights[row];
    }
    return choice.ids.back();
}

void DemandReader::problem(const std::string& place, const std::string& id, std::string what,
                           std::string allowed) {
    problems_.push_back({fmt::format("{}: \"{}\"", place, id), std::move(what), std::move(allowed), ""});
}

}  // namespace clearway::city::detail
