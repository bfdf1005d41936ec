#include "scenario_import/sumo/demand.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/files.hpp"
#include "roads/route.hpp"
#include "scenario/network_document.hpp"
#include "scenario_import/sumo/additional.hpp"
#include "scenario_import/sumo/class_access.hpp"
#include "scenario_import/sumo/own_emergency.hpp"
#include "scenario_import/sumo/persons.hpp"
#include "scenario_import/sumo/plan_check.hpp"
#include "scenario_import/sumo/stop.hpp"
#include "scenario_import/sumo/vehicle_type.hpp"
#include "scenario_import/sumo/ways.hpp"

namespace clearway::scenario_import::detail {

namespace {

constexpr double usual_window_s = 1200.0;
constexpr double long_demand_s = 7200.0;

/// The end of a configuration; SUMO's -1 means none.
std::optional<double> end_of(const SumoFiles& files) {
    return files.end_s && *files.end_s > 0.0 ? files.end_s : std::nullopt;
}

/// Default begin and end of flows, and the departures that can fall into the window.
FlowTimes flow_times(const SumoFiles& files, const Import& import) {
    FlowTimes times;
    times.begin_s = files.begin_s.value_or(0.0);
    times.end_s = end_of(files);
    times.from_s = import.request.begin_s.value_or(times.begin_s);
    times.until_s = end_of(files).value_or(times.until_s);
    if (import.request.begin_s) times.until_s = std::min(times.until_s, times.from_s + usual_window_s);
    return times;
}

/// The twenty minutes with the most departures, and the ten minutes before them.
Window busiest(const std::vector<RoadUser>& vehicles, double begin_s) {
    constexpr double slot_s = 300.0;
    constexpr std::size_t slots = 4;
    constexpr double before_s = 600.0;
    std::vector<std::size_t> counts;
    for (const RoadUser& vehicle : vehicles) {
        if (vehicle.depart_s < begin_s) continue;
        const auto slot = static_cast<std::size_t>((vehicle.depart_s - begin_s) / slot_s);
        if (slot >= counts.size()) counts.resize(slot + 1);
        ++counts[slot];
    }
    counts.resize(std::max(counts.size(), slots));
    std::size_t best = 0;
    std::size_t most = 0;
    for (std::size_t first = 0; first + slots <= counts.size(); ++first) {
        std::size_t sum = 0;
        for (std::size_t row = first; row < first + slots; ++row)
            sum += counts[row];
        if (sum > most) std::tie(best, most) = std::pair{first, sum};
    }
    const double at_s = begin_s + static_cast<double>(best) * slot_s;
    const double start_s = std::max(begin_s, at_s - before_s);
    return {start_s, at_s - start_s + usual_window_s};
}

/// Without a stated begin it is that of the first vehicle, or of people up to ten minutes before it.
Window choose_window(const Demand& demand, const SumoFiles& files, const Import& import) {
    constexpr double longest_wait_s = 600.0;
    const std::vector<RoadUser>& vehicles = demand.vehicles;
    double last_s = 0.0;
    double first_s = vehicles.front().depart_s;
    for (const RoadUser& vehicle : vehicles) {
        last_s = std::max(last_s, vehicle.depart_s);
        first_s = std::min(first_s, vehicle.depart_s);
    }
    const double first_vehicle_s = first_s;
    for (const Person& person : demand.persons)
        if (person.depart_s >= first_vehicle_s - longest_wait_s) first_s = std::min(first_s, person.depart_s);
    // The end itself is not in the window.
    const double after_last_s = std::floor(last_s) + 1.0;
    const double end_s = std::min(end_of(files).value_or(after_last_s), after_last_s);
    const double begin_s = import.request.begin_s.value_or(files.begin_s.value_or(std::floor(first_s)));
    if (!import.request.begin_s && end_s - begin_s > long_demand_s) return busiest(vehicles, begin_s);
    constexpr double shortest_s = 60.0;
    return {begin_s, std::clamp(std::ceil(end_s - begin_s), shortest_s, usual_window_s)};
}

std::string vehicle_xml(RoadUser& vehicle, double begin_s, LeftOut& left_out) {
    Element element = std::move(vehicle.element);
    element.set("id", vehicle.id);
    end_waiting(element, left_out);
    take_out_devices(element, left_out);
    element.remove("id");
    Element route;
    route.name = "route";
    route.set("edges", fmt::format("{}", fmt::join(vehicle.edges, " ")));
    element.children.insert(element.children.begin(), std::move(route));
    return departing_xml(std::move(element), begin_s, {vehicle.id, vehicle.type, vehicle.depart_s});
}

bool is_car(const Demand& demand, const RoadUser& vehicle) {
    return kind_of_class(demand.types.at(vehicle.type).text("vClass")) == std::string_view("car");
}

/// Minimum length of the routes that emergency vehicles take: 1 km if at least five are that long, else the
/// length of the fifth longest. They take routes of cars, or of any vehicles if no car has one that is open
/// to them.
double emergency_length_m(const Demand& demand, const roads::Network& network, const ClassAccess& access) {
    constexpr double wanted_m = 1000.0;
    constexpr std::size_t enough = 5;
    std::set<std::vector<std::string>> seen;
    std::vector<double> of_cars_m;
    std::vector<double> of_others_m;
    for (const RoadUser& vehicle : demand.vehicles) {
        const bool car = is_car(demand, vehicle);
        if ((!car && !of_cars_m.empty()) || !seen.insert(vehicle.edges).second) continue;
        std::vector<core::EdgeIndex> route;
        for (const std::string& id : vehicle.edges)
            route.push_back(*network.find_edge(id));
        if (access.opens_way(route, "emergency"))
            (car ? of_cars_m : of_others_m).push_back(roads::route_length(network, route).value);
    }
    std::vector<double>& lengths_m = of_cars_m.empty() ? of_others_m : of_cars_m;
    if (lengths_m.empty())
        throw core::InputError(
            core::Problem{"the demand", "has no vehicle whose route emergency vehicles may drive",
                          "one whose edges are open to class passenger or emergency", "add such a vehicle"});
    std::ranges::sort(lengths_m, std::greater<>());
    return std::floor(std::min(wanted_m, lengths_m[std::min(enough, lengths_m.size()) - 1]));
}

/// Reads all files; returns the elements that are not demand, for additional.add.xml.
std::vector<Element> read_files(const SumoFiles& files, DemandReader& reader) {
    std::vector<Element> others;
    for (const auto* list : {&files.additional, &files.routes})
        for (const std::filesystem::path& file : *list)
            for (Element& element : reader.read(file))
                others.push_back(std::move(element));
    return others;
}

scenario::Measured describe_types(Import& import, const Demand& demand) {
    scenario::Measured measured;
    measured.automated_share = import.request.automated_share;
    measured.routes = {"traffic.rou.xml"};
    measured.own_types = scenario::OwnTypes{"types.add.xml", import.request.car_following};
    std::set<std::string> used;
    for (const RoadUser& vehicle : demand.vehicles)
        used.insert(vehicle.type);
    std::string types;
    for (const auto& [id, type] : demand.types) {
        if (!used.contains(id)) continue;
        const std::string& vehicle_class = type.text("vClass");
        measured.types.push_back(
            {id, kind_of_class(vehicle_class),
             vehicle_class == "ignoring" ? scenario::Access::unrestricted : scenario::Access::own});
        Element written = type;
        take_out_devices(written, import.left_out);
        types += written.xml();
    }
    core::write_atomically(import.scenario / "types.add.xml", file_text("additional", types));
    return measured;
}

/// Removes vehicles and persons that cannot drive or walk as the files say. If they are to be refused, throws
/// with all of them.
void take_out_bad(Import& import, Demand& demand, const roads::Network& network, const ClassAccess& access,
                  const std::vector<Element>& additional) {
    std::vector<core::Problem> problems =
        take_out_bad_vehicles(demand, network, access, additional, import.left_out);
    const bool has_traffic = !demand.vehicles.empty() || !problems.empty();
    std::vector<core::Problem> of_persons;
    if (has_traffic) of_persons = take_out_bad_persons(demand, network, additional, import.left_out);
    problems.insert(problems.end(), of_persons.begin(), of_persons.end());
    if (import.request.bad_vehicles == BadVehicles::refuse && !problems.empty())
        throw core::InputError(std::move(problems));
}

void set_times(const Window& window, scenario::ScenarioConfig& config) {
    config.time.window_s = window.length_s;
    constexpr double longest_warm_up_s = 900.0;
    config.time.warm_up_s = std::floor(std::min(longest_warm_up_s, window.length_s / 2.0));
    config.time.horizon_s = std::max(3600.0, 3.0 * window.length_s);
}

/// None of the vehicles in the files can be used; a synthetic demand in their place would mislead.
[[noreturn]] void refuse_without_vehicles(const Import& import) {
    const std::vector<std::string> lines = import.left_out.lines();
    throw core::InputError(
        core::Problem{import.request.files.front().string(),
                      fmt::format("no vehicle of its demand can be used{}{}",
                                  lines.empty() ? "" : "; left out: ", fmt::join(lines, "; ")),
                      "vehicles, trips or flows that depart in the time of the configuration",
                      "give them routes first, with od2trips, jtrrouter or duarouter; or import the network "
                      "alone, for a synthetic demand"});
}

/// Keeps only the vehicles of the window, by departure.
void keep_window(const Window& window, Demand& demand, Findings& findings, std::size_t all) {
    std::vector<RoadUser>& vehicles = demand.vehicles;
    std::ranges::stable_sort(vehicles, {}, &RoadUser::depart_s);
    std::erase_if(vehicles, [&](const RoadUser& vehicle) { return !window.holds(vehicle.depart_s); });
    if (vehicles.empty())
        throw core::InputError(core::Problem{
            "--begin",
            fmt::format("no vehicle departs in the {:.0f} s after {} s", window.length_s, window.begin_s),
            "a time with departures", "choose another begin"});
    if (vehicles.size() < all)
        findings.changes.push_back(
            fmt::format("of {} the {} that depart from {:.0f} s to {:.0f} s are taken; --begin "
                        "chooses another time",
                        core::counted(all, "vehicle"), vehicles.size(), window.begin_s, window.end_s()));
}

/// How vehicles without a route find one.
void describe_ways(const Demand& demand, Findings& findings) {
    const auto count = [&](auto&& is_so) {
        return static_cast<std::size_t>(std::ranges::count_if(demand.vehicles, is_so));
    };
    findings.routed_trips = count(&RoadUser::is_trip);
    findings.routed_at_departure = count(&RoadUser::is_routed_at_departure);
    if (findings.routed_at_departure > 0)
        findings.changes.push_back(
            fmt::format("{} vehicles without a route are routed by SUMO at departure, by the traffic of the "
                        "moment, as in the scenario; so their routes may differ between conditions",
                        findings.routed_at_departure));
    if (const std::size_t others = findings.routed_trips - findings.routed_at_departure; others > 0)
        findings.changes.push_back(
            fmt::format("{} vehicles without a route take the fastest one at free flow, as duarouter finds "
                        "it, because they have vias, or ends that are not edges; SUMO would choose at "
                        "departure, by the traffic of the moment, which spreads them over longer routes",
                        others));
}

void describe_vehicles(const Import& import, const Demand& demand, const Window& window, Findings& findings) {
    for (const RoadUser& vehicle : demand.vehicles)
        ++findings.vehicles[kind_of_class(demand.types.at(vehicle.type).text("vClass"))];
    findings.vehicles_per_hour = static_cast<double>(demand.vehicles.size()) * 3600.0 / window.length_s;
    describe_ways(demand, findings);
    findings.demand =
        fmt::format("{}, {:.0f} s of it; {:.0f} % of the cars are automated",
                    findings.routed_trips == 0 ? "as the route files say"
                    : findings.routed_trips == findings.routed_at_departure
                        ? "as the route files say, trips without a route routed by SUMO at departure"
                        : "departures as the route files say, routes of trips partly from duarouter",
                    window.length_s, 100.0 * import.request.automated_share);
}

/// Shifts the signal programs so that the scenario's time 0 is their `begin_s`.
void begin_programs_at(double begin_s, const std::filesystem::path& network_file) {
    if (begin_s == 0.0) return;
    scenario::NetworkDocument document(network_file);
    document.begin_programs_at(begin_s);
    core::write_atomically(network_file, document.text());
}

/// Writes additional.add.xml. Returns the list of that file for the scenario.
std::vector<std::string> write_additional(Import& import, const std::vector<Element>& elements,
                                          const std::map<std::string, Element>& types, double begin_s) {
    constexpr const char* name = "additional.add.xml";
    import.additional = keep_additional(elements, types, begin_s, import.left_out);
    if (import.additional.xml.empty()) return {};
    core::write_atomically(import.scenario / name, file_text("additional", import.additional.xml));
    return {name};
}

/// Signals whose program changes by a timetable.
std::set<std::string> switched_signals(const std::vector<Element>& elements) {
    std::set<std::string> ids;
    for (const Element& element : elements)
        if (element.name == "wautJunction") ids.insert(element.text("junctionID"));
    return ids;
}

/// Moves the signal programs among `others` into the network, but not those between which a timetable
/// switches. The last program that the files give a signal is the one that SUMO runs.
void write_programs(Import& import, std::vector<Element>& others, const std::filesystem::path& network_file) {
    scenario::NetworkDocument document(network_file);
    const std::set<std::string> switched = switched_signals(others);
    std::set<std::string> replaced;
    std::erase_if(others, [&](const Element& element) {
        const std::string& id = element.text("id");
        if (element.name != "tlLogic" || element.children.empty() || switched.contains(id)) return false;
        if (document.replace_programs(id, element.xml()))
            replaced.insert(id);
        else
            import.left_out.add("<tlLogic> of signals that the network does not have", id);
        return true;
    });
    if (replaced.empty()) return;
    core::write_atomically(network_file, document.text());
    import.findings.changes.push_back(
        fmt::format("signal programs of the files replace those of the network at {}",
                    core::counted(replaced.size(), "signal")));
}

/// Without vehicles, what belongs to the network is kept.
void keep_network(Import& import, const Demand& demand, std::vector<Element>& others, double begin_s,
                  scenario::ScenarioConfig& config) {
    const std::filesystem::path network_file = import.scenario / config.network.file;
    write_programs(import, others, network_file);
    begin_programs_at(begin_s, network_file);
    config.network.additional = write_additional(import, others, demand.types, begin_s);
    for (const Person& person : demand.persons)
        import.left_out.add("persons, because no vehicle is left", person.id);
}

/// Notes where the elements stand that SUMO may complain about.
void note_places(Import& import, const Demand& demand, const std::vector<Element>& others) {
    for (const Element& element : others)
        import.named.push_back({element.name, element.text("id"), element.place});
    for (const auto& [id, type] : demand.types)
        import.named.push_back({type.name, id, type.place});
    for (const RoadUser& vehicle : demand.vehicles)
        import.named.push_back({vehicle.element.name, vehicle.id, vehicle.place});
}

}  // namespace

bool add_sumo_demand(Import& import, const SumoFiles& files, const roads::Network& network,
                     const std::filesystem::path& network_file, scenario::ScenarioConfig& config) {
    DemandReader reader(flow_times(files, import), files.scale, import.left_out);
    std::vector<Element> others = read_files(files, reader);
    others = reader.with_named(std::move(others));
    Demand demand = reader.finish();
    Findings& findings = import.findings;
    for (const std::filesystem::path& file : demand.unsorted)
        findings.changes.push_back(fmt::format("{} is sorted by departure; SUMO would have dropped vehicles",
                                               file.filename().string()));
    findings.changes.insert(findings.changes.end(), demand.changes.begin(), demand.changes.end());
    const ClassAccess access(network_file, network);
    complete_trips(demand, others, import.left_out);
    const auto read = static_cast<double>(demand.vehicles.size());
    take_out_bad(import, demand, network, access, others);
    find_ways(import, demand, network_file, others);
    if (read > 0.0) findings.bad_vehicles_share = 1.0 - static_cast<double>(demand.vehicles.size()) / read;
    const std::size_t all = demand.vehicles.size();
    if (const auto end_s = end_of(files))
        std::erase_if(demand.vehicles, [&](const RoadUser& vehicle) { return vehicle.depart_s >= *end_s; });
    if (demand.vehicles.empty()) {
        if (demand.names_vehicles) refuse_without_vehicles(import);
        note_places(import, demand, others);
        const double begin_s = import.request.begin_s.value_or(files.begin_s.value_or(0.0));
        keep_network(import, demand, others, begin_s, config);
        return false;
    }

    const Window window = choose_window(demand, files, import);
    check_own_emergency(import, demand, window);
    keep_window(window, demand, findings, all);
    set_times(window, config);
    config.demand = {};
    config.demand.emergency = 6;
    take_own_emergency(import, demand, access, window.begin_s, config);
    describe_vehicles(import, demand, window, findings);
    add_routing_devices(demand, files.rerouting);
    config.measured = describe_types(import, demand);
    config.measured->emergency_minimum_length_m = emergency_length_m(demand, network, access);
    // The types are the scenario's own, so this is the largest allowed limit.
    constexpr double no_limit_kmh = 400.0;
    config.limits.human_kmh = config.limits.automated_kmh = no_limit_kmh;
    note_places(import, demand, others);
    config.measured->additional = write_additional(import, others, demand.types, window.begin_s);
    begin_programs_at(window.begin_s, network_file);
    check_rides(import, demand, others, window);
    add_persons(import, demand, network, window, config);
    std::string routes;
    for (RoadUser& vehicle : demand.vehicles)
        routes += vehicle_xml(vehicle, window.begin_s, import.left_out);
    core::write_atomically(import.scenario / "traffic.rou.xml", file_text("routes", routes));
    return true;
}

}  // namespace clearway::scenario_import::detail
