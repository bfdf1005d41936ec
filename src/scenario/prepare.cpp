#include "scenario/prepare.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "scenario/detail/demand.hpp"
#include "scenario/detail/driver_types.hpp"
#include "scenario/detail/measured_persons.hpp"
#include "scenario/detail/pedestrians.hpp"
#include "scenario/vehicle_types.hpp"

namespace clearway::scenario {

namespace {

std::string routes_xml(const std::vector<detail::PlannedVehicle>& vehicles) {
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<routes>\n";
    for (const detail::PlannedVehicle& vehicle : vehicles)
        xml += vehicle.xml;
    return xml + "</routes>\n";
}

std::string emergency_csv(const std::vector<traffic::EmergencyDeparture>& departures) {
    std::string text = "id,type,kind,depart_s,depart_lane,depart_speed,edges\n";
    for (const traffic::EmergencyDeparture& departure : departures)
        text += fmt::format("{},{},{},{:.2f},{},{},{}\n", departure.id, departure.type,
                            traffic::name(departure.kind), departure.depart.value, departure.depart_lane,
                            departure.depart_speed, fmt::join(departure.edges, " "));
    return text;
}

int count(const std::vector<detail::PlannedVehicle>& vehicles, traffic::VehicleClass vehicle_class) {
    return static_cast<int>(std::count_if(
        vehicles.begin(), vehicles.end(),
        [&](const detail::PlannedVehicle& vehicle) { return vehicle.vehicle_class == vehicle_class; }));
}

std::uint64_t simulator_seed(const core::KeyedRandom& random) {
    constexpr std::uint64_t largest = (std::uint64_t{1} << 31) - 1;
    return 1 + random.below(largest - 1, core::Purpose::simulator, 0);
}

void delay(std::vector<PlacedIncident>& incidents, core::Seconds time) {
    for (PlacedIncident& placed : incidents) {
        placed.closed.from.value += time.value;
        placed.closed.to.value += time.value;
    }
}

}  // namespace

void refuse_commas(const std::filesystem::path& folder) {
    if (folder.string().find(',') == std::string::npos) return;
    throw core::InputError(core::Problem{folder.string(),
                                         "has a comma in its path, which SUMO takes as a separator",
                                         "a path without commas", "choose another folder"});
}

Prepared prepare(const ScenarioConfig& config, const BuiltNetwork& network, core::StudySeed seed,
                 core::Replication replication, const std::filesystem::path& folder) {
    refuse_commas(std::filesystem::absolute(folder));
    std::vector<PlacedIncident> incidents = place_incidents(config, network.network);
    const detail::DemandContext context{config, network.network, core::KeyedRandom(seed, replication)};
    detail::PlannedDemand demand =
        config.measured ? detail::read_measured(context) : detail::generate(context);
    detail::add_emergency_trips(context, demand);
    Calls calls = place_calls(config, network.network, incidents);
    const core::Seconds events_delay = detail::events_delay(context);
    delay(incidents, events_delay);
    draw_times(calls, events_delay, context.random);
    detail::add_calls(context, calls, demand);
    detail::sort_by_departure(demand);

    const std::string types = detail::with_driver_types(context, demand, vehicle_types_xml(config));
    const std::string routes = routes_xml(demand.vehicles);
    const std::string emergency = emergency_csv(demand.emergency);
    const bool has_persons = config.measured && !config.measured->persons.empty();
    const std::string persons = has_persons ? detail::measured_persons_xml(context, demand) : "";
    const std::string pedestrians = config.pedestrians.walk() ? detail::pedestrians_xml(context) : "";
    core::make_folder(folder);
    core::write_atomically(folder / "vehicle_types.add.xml", types);
    core::write_atomically(folder / "traffic.rou.xml", routes);
    core::write_atomically(folder / "emergency.csv", emergency);

    Prepared prepared;
    prepared.network_file = network.file;
    prepared.route_files = {folder / "traffic.rou.xml"};
    for (const auto& [name, content] :
         {std::pair{"persons.rou.xml", &persons}, std::pair{"pedestrians.rou.xml", &pedestrians}}) {
        if (content->empty()) continue;
        prepared.route_files.push_back(folder / name);
        core::write_atomically(prepared.route_files.back(), *content);
    }
    prepared.additional_files = additional_files(config);
    if (config.measured) prepared.options = config.measured->options;
    prepared.additional_files.insert(prepared.additional_files.begin(), folder / "vehicle_types.add.xml");
    prepared.human = count(demand.vehicles, traffic::VehicleClass::human);
    prepared.automated = count(demand.vehicles, traffic::VehicleClass::automated);
    prepared.emergency = std::move(demand.emergency);
    prepared.incidents = std::move(incidents);
    prepared.calls = std::move(calls);
    prepared.time = config.time;
    prepared.simulator_seed = simulator_seed(context.random);
    prepared.demand_hash = core::content_hash(types + routes + emergency + persons + pedestrians);
    return prepared;
}

}  // namespace clearway::scenario
