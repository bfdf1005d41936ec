#include "scenario_import/sumo/ways.hpp"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/files.hpp"
#include "scenario_import/detail/tool.hpp"
#include "scenario_import/sumo/stop.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// What is wrong, in words; nothing if all is well.
using Fault = std::optional<std::string>;

/// Finds out why a vehicle cannot drive as the files say.
class WayCheck {
  public:
    WayCheck(const roads::Network& network, const ClassAccess& access, const std::vector<Element>& additional)
        : network_(network), access_(access), stops_(additional) {}

    Fault fault_of(const RoadUser& vehicle, const std::string& vehicle_class) const {
        if (auto fault = fault_of_edges(vehicle, vehicle_class)) return fault;
        for (const Element& stop : vehicle.element.children) {
            if (stop.name != "stop") continue;
            if (const auto place = stops_.unknown_place(stop))
                return fmt::format("stops at {}, which is not defined", *place);
            const std::string edge = stops_.edge_of(stop);
            if (!vehicle.is_trip && !edge.empty() && !core::contains(vehicle.edges, edge))
                return fmt::format("stops on edge \"{}\", which its route does not pass", edge);
        }
        return std::nullopt;
    }

  private:
    Fault fault_of_edges(const RoadUser& vehicle, const std::string& vehicle_class) const {
        const char* const named_class = vehicle_class.empty() ? "passenger" : vehicle_class.c_str();
        std::optional<core::EdgeIndex> before;
        for (const std::string& id : vehicle.edges) {
            const auto edge = network_.find_edge(id);
            if (!edge || network_.edge(*edge).internal)
                return fmt::format("the network has no edge \"{}\"", id);
            if (!access_.opens(*edge, vehicle_class))
                return fmt::format("edge \"{}\" is closed to its class, {}", id, named_class);
            if (before && !vehicle.is_trip && *before != *edge &&
                !access_.joins(*before, *edge, vehicle_class))
                return fmt::format("its route has a gap: nothing leads from edge \"{}\" to \"{}\"{}",
                                   network_.edge(*before).id, id,
                                   access_.joins(*before, *edge, "ignoring")
                                       ? fmt::format(" for its class, {}", named_class)
                                       : "");
            before = edge;
        }
        return std::nullopt;
    }

    const roads::Network& network_;
    const ClassAccess& access_;
    StopEdges stops_;
};

/// Trips with the same ends and type share a route.
using TripKey = std::pair<std::string, std::string>;
using Ways = std::map<TripKey, std::vector<std::string>>;

TripKey key_of(const RoadUser& vehicle) {
    return {vehicle.type, vehicle.trip.xml()};
}

/// Makes the route of a trip pass the edges of its stops, in their order.
void pass_stops(RoadUser& vehicle, const StopEdges& stops) {
    const std::vector<std::string> vias = words(vehicle.trip.text("via"));
    std::vector<std::string> passed = vias;
    std::string last = vehicle.trip.text("from");
    for (const Element& stop : vehicle.element.children) {
        if (stop.name != "stop") continue;
        const std::string edge = stops.edge_of(stop);
        if (!edge.empty() && edge != last && !core::contains(vias, edge)) passed.push_back(edge);
        if (!edge.empty()) last = edge;
    }
    if (last == vehicle.trip.text("to") && !passed.empty() && passed.back() == last) passed.pop_back();
    if (passed.size() > vias.size()) vehicle.trip.set("via", fmt::format("{}", fmt::join(passed, " ")));
}

/// Writes the zones that trips may name and returns duarouter's options for them.
std::vector<std::string> zone_options(const Import& import, const std::vector<Element>& additional) {
    std::string zones;
    for (const Element& element : additional) {
        if (element.name == "taz") zones += element.xml();
        if (element.name != "tazs") continue;
        for (const Element& zone : element.children)
            zones += zone.xml();
    }
    std::vector<std::string> options = {"--junction-taz"};
    if (zones.empty()) return options;
    const std::filesystem::path file = import.work / "zones.xml";
    core::write_atomically(file, file_text("additional", zones));
    options.insert(options.end(), {"--additional-files", file.string()});
    return options;
}

/// The input file for duarouter; `rows` receives the entries of `ways` in the order of its trips.
std::string trips_text(const Demand& demand, const std::map<TripKey, Element>& trips, Ways& ways,
                       std::vector<std::vector<std::string>*>& rows) {
    std::string xml;
    std::map<std::string, std::string> type_numbers;
    for (const auto& [id, type] : demand.types) {
        Element numbered = type;
        type_numbers[id] = fmt::format("t{}", type_numbers.size());
        numbered.set("id", type_numbers[id]);
        xml += numbered.xml();
    }
    for (const auto& [key, ends] : trips) {
        Element trip = ends;
        trip.set("id", std::to_string(rows.size()));
        trip.set("type", type_numbers[key.first]);
        trip.set("depart", "0");
        xml += trip.xml();
        rows.push_back(&ways[key]);
    }
    return file_text("routes", xml);
}

Ways ways_of_trips(const Import& import, const Demand& demand, const std::filesystem::path& network_file,
                   const std::vector<Element>& additional) {
    std::map<TripKey, Element> trips;
    for (const RoadUser& vehicle : demand.vehicles)
        if (vehicle.is_trip) trips.try_emplace(key_of(vehicle), vehicle.trip);
    Ways ways;
    if (trips.empty()) return ways;
    std::vector<std::vector<std::string>*> rows;
    const std::filesystem::path file = import.work / "trips.xml";
    const std::filesystem::path found = import.work / "ways.xml";
    const std::filesystem::path log = import.work / "duarouter.log";
    core::write_atomically(file, trips_text(demand, trips, ways, rows));
    Tool tool{
        "duarouter",
        {"--net-file", network_file.string(), "--route-files", file.string(), "--output-file", found.string(),
         "--ignore-errors", "--no-warnings", "--no-step-log", "--xml-validation", "never"},
        log,
        "finding routes",
        "sumo"};
    for (std::string& option : zone_options(import, additional))
        tool.arguments.push_back(std::move(option));
    if (!succeeds(tool, import.on_progress))
        throw core::InputError(core::Problem{"the trips", fmt::format("duarouter says:\n{}", complaint(log)),
                                             "trips between edges of the network", ""});
    for_each_element(found, [&](Element&& vehicle) {
        if (vehicle.name != "vehicle" || vehicle.children.empty()) return;
        *rows.at(std::stoul(vehicle.text("id"))) = words(vehicle.children.front().text("edges"));
    });
    return ways;
}

/// `town.rou.xml:3: bus` for the vehicle `bus.12` of a flow.
std::string flow_of(const RoadUser& vehicle) {
    return fmt::format("{}: {}", vehicle.place, without_number(vehicle.id));
}

bool has_any(const Element& trip, std::initializer_list<const char*> names) {
    return std::ranges::any_of(names, [&](const char* const name) { return trip.has(name); });
}

/// Completes the ends of a trip. Returns whether it has both.
bool complete(RoadUser& vehicle, const StopEdges& stops) {
    Element& trip = vehicle.trip;
    std::vector<std::string> vias = words(trip.text("via"));
    std::vector<std::string> stopped;
    for (const Element& stop : vehicle.element.children)
        if (std::string edge = stop.name == "stop" ? stops.edge_of(stop) : ""; !edge.empty())
            stopped.push_back(std::move(edge));
    const bool has_from = has_any(trip, {"from", "fromTaz", "fromJunction"});
    const bool has_to = has_any(trip, {"to", "toTaz", "toJunction"});
    if (!has_from && !vias.empty()) {
        trip.set("from", vias.front());
        vias.erase(vias.begin());
    } else if (!has_from && (!stopped.empty() || trip.has("to"))) {
        trip.set("from", stopped.empty() ? trip.text("to") : stopped.front());
    }
    if (!has_to && !stopped.empty()) {
        trip.set("to", stopped.back());
    } else if (!has_to && !vias.empty()) {
        trip.set("to", vias.back());
        vias.pop_back();
    } else if (!has_to && trip.has("from")) {
        trip.set("to", trip.text("from"));
    }
    vias.empty() ? trip.remove("via") : trip.set("via", fmt::format("{}", fmt::join(vias, " ")));
    if (!has_any(trip, {"from", "fromTaz", "fromJunction"}) || !has_any(trip, {"to", "toTaz", "toJunction"}))
        return false;
    vehicle.is_routed_at_departure = trip.has("from") && trip.has("to") && vias.empty();
    for (const char* const name : {"from", "via", "to"})
        for (std::string& edge : words(trip.text(name)))
            vehicle.edges.push_back(std::move(edge));
    // SUMO lets a trip that names one edge drive that edge.
    const std::string& only = vehicle.edges.empty() ? trip.text("from") : vehicle.edges.front();
    const auto is_only = [&](const std::string& edge) { return edge == only; };
    if (!(has_from && has_to) && trip.has("from") && trip.has("to") &&
        std::ranges::all_of(vehicle.edges, is_only) && std::ranges::all_of(stopped, is_only)) {
        vehicle.is_trip = vehicle.is_routed_at_departure = false;
        vehicle.edges = {trip.text("from")};
    }
    return true;
}

}  // namespace

void complete_trips(Demand& demand, const std::vector<Element>& additional, LeftOut& left_out) {
    const StopEdges stops(additional);
    std::erase_if(demand.vehicles, [&](RoadUser& vehicle) {
        if (!vehicle.is_trip || complete(vehicle, stops)) return false;
        left_out.add("vehicles without a route: origin or destination is missing", vehicle.id);
        return true;
    });
}

std::vector<core::Problem> take_out_bad_vehicles(Demand& demand, const roads::Network& network,
                                                 const ClassAccess& access,
                                                 const std::vector<Element>& additional, LeftOut& left_out) {
    const WayCheck check(network, access, additional);
    std::vector<core::Problem> problems;
    std::set<std::pair<std::string, std::string>> named;
    std::erase_if(demand.vehicles, [&](const RoadUser& vehicle) {
        const auto fault = check.fault_of(vehicle, demand.types.at(vehicle.type).text("vClass"));
        if (!fault) return false;
        left_out.add("vehicles that cannot drive their route", fmt::format("{}: {}", vehicle.id, *fault));
        // It may need lanes that were taken from its class, which cannot be corrected in the files.
        if (demand.types_made_older.contains(vehicle.type)) return true;
        if (problems.size() < named_problems && named.insert({flow_of(vehicle), *fault}).second)
            problems.push_back(
                {fmt::format("{}: \"{}\"", vehicle.place, vehicle.id), *fault,
                 "edges of the network that lead into each other",
                 "correct the route, or leave such vehicles out with --leave-out-bad-vehicles"});
        return true;
    });
    return problems;
}

void find_ways(Import& import, Demand& demand, const std::filesystem::path& network_file,
               const std::vector<Element>& additional) {
    const StopEdges stops(additional);
    for (RoadUser& vehicle : demand.vehicles)
        if (vehicle.is_trip) pass_stops(vehicle, stops);
    const Ways ways = ways_of_trips(import, demand, network_file, additional);
    std::erase_if(demand.vehicles, [&](RoadUser& vehicle) {
        if (!vehicle.is_trip) return false;
        vehicle.edges = ways.at(key_of(vehicle));
        if (vehicle.edges.empty())
            import.left_out.add("trips without a route between their ends", vehicle.id);
        return vehicle.edges.empty();
    });
}

}  // namespace clearway::scenario_import::detail
