#include "city/detail/ways.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "city/detail/tool.hpp"
#include "core/files.hpp"

namespace clearway::city::detail {

namespace {

bool joins(const roads::Network& network, core::EdgeIndex from, core::EdgeIndex to) {
    for (std::uint32_t lane = 0; lane < network.edge(from).lane_count; ++lane)
        for (const roads::Connection& way : network.connections_from(network.lane_of(from, lane)))
            if (network.lane(way.to).edge == to) return true;
    return false;
}

/// What is wrong with the way of a vehicle, if anything is.
std::optional<std::string> fault_of(const roads::Network& network, const RoadUser& vehicle) {
    std::optional<core::EdgeIndex> before;
    for (const std::string& id : vehicle.edges) {
        const auto edge = network.find_edge(id);
        if (!edge || network.edge(*edge).internal) return fmt::format("the network has no edge \"{}\"", id);
        if (before && !vehicle.is_trip && *before != *edge && !joins(network, *before, *edge))
            return fmt::format("its route has a gap: nothing leads from edge \"{}\" to \"{}\"",
                               network.edge(*before).id, id);
        before = edge;
    }
    return std::nullopt;
}

/// Trips with the same ends and type share a way.
using TripKey = std::pair<std::string, std::vector<std::string>>;

std::map<TripKey, std::vector<std::string>> ways_of_trips(const Import& import, const Demand& demand,
                                                          const std::filesystem::path& network_file) {
    std::map<TripKey, std::vector<std::string>> ways;
    for (const RoadUser& vehicle : demand.vehicles)
        if (vehicle.is_trip) ways[{vehicle.type, vehicle.edges}];
    if (ways.empty()) return ways;
    std::string xml = "<routes>\n";
    std::map<std::string, std::string> type_numbers;
    for (const auto& [id, type] : demand.types) {
        Element numbered = type;
        type_numbers[id] = fmt::format("t{}", type_numbers.size());
        numbered.set("id", type_numbers[id]);
        xml += numbered.xml();
    }
    std::vector<std::vector<std::string>*> rows;
    for (auto& [key, way] : ways) {
        Element trip;
        trip.name = "trip";
        trip.attributes = {{"id", std::to_string(rows.size())},
                           {"type", type_numbers[key.first]},
                           {"depart", "0"},
                           {"from", key.second.front()},
                           {"to", key.second.back()}};
        if (key.second.size() > 2)
            trip.set("via", fmt::format("{}", fmt::join(key.second.begin() + 1, key.second.end() - 1, " ")));
        xml += trip.xml();
        rows.push_back(&way);
    }
    const std::filesystem::path trips = import.work / "trips.xml";
    const std::filesystem::path found = import.work / "ways.xml";
    const std::filesystem::path log = import.work / "duarouter.log";
    core::write_atomically(trips, xml + "</routes>\n");
    const Tool tool{
        "duarouter",
        {"--net-file", network_file.string(), "--route-files", trips.string(), "--output-file",
         found.string(), "--ignore-errors", "--no-warnings", "--no-step-log", "--xml-validation", "never"},
        log,
        "finding ways",
        "sumo"};
    if (!succeeds(tool, import.on_progress))
        throw core::InputError(core::Problem{"the trips", fmt::format("duarouter says:\n{}", complaint(log)),
                                             "trips between edges of the network", ""});
    for_each_element(found, [&](Element&& vehicle) {
        if (vehicle.name != "vehicle" || vehicle.children.empty()) return;
        *rows.at(std::stoul(vehicle.text("id"))) = words(vehicle.children.front().text("edges"));
    });
    return ways;
}

}  // namespace

std::vector<core::Problem> take_out_bad_vehicles(Demand& demand, const roads::Network& network,
                                                 LeftOut& left_out) {
    std::vector<core::Problem> problems;
    std::erase_if(demand.vehicles, [&](const RoadUser& vehicle) {
        const auto fault = fault_of(network, vehicle);
        if (!fault) return false;
        left_out.add("vehicles that cannot drive their route", fmt::format("{}: {}", vehicle.id, *fault));
        if (problems.size() < named_problems)
            problems.push_back(
                {fmt::format("{}: \"{}\"", vehicle.place, vehicle.id), *fault,
                 "edges of the network that lead into each other",
                 "correct the route, or leave such vehicles out with --leave-out-bad-vehicles"});
        return true;
    });
    return problems;
}

void find_ways(Import& import, Demand& demand, const std::filesystem::path& network_file) {
    const auto ways = ways_of_trips(import, demand, network_file);
    std::erase_if(demand.vehicles, [&](RoadUser& vehicle) {
        if (!vehicle.is_trip) return false;
        vehicle.edges = ways.at({vehicle.type, vehicle.edges});
        if (vehicle.edges.empty())
            import.left_out.add("trips without any way between their ends", vehicle.id);
        return vehicle.edges.empty();
    });
}

}  // namespace clearway::city::detail
