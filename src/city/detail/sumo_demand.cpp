#include "city/detail/sumo_demand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include "city/detail/sumo_persons.hpp"
#include "city/detail/walks.hpp"
#include "city/detail/ways.hpp"
#include "core/files.hpp"
#include "roads/route.hpp"

namespace clearway::city::detail {

namespace {

/// Additional elements that shape the traffic. Others watch it, write files or are drawn.
constexpr std::array<std::string_view, 11> kept_elements = {
    "busStop", "trainStop",    "containerStop", "chargingStation",   "parkingArea", "tlLogic",
    "WAUT",    "wautJunction", "rerouter",      "variableSpeedSign", "parkingSpace"};

const char* kind_of_class(std::string_view vehicle_class) {
    constexpr std::array<std::pair<std::string_view, const char*>, 16> kinds = {{{"", "car"},
                                                                                 {"passenger", "car"},
                                                                                 {"private", "car"},
                                                                                 {"hov", "car"},
                                                                                 {"taxi", "car"},
                                                                                 {"vip", "car"},
                                                                                 {"evehicle", "car"},
                                                                                 {"custom1", "car"},
                                                                                 {"custom2", "car"},
                                                                                 {"ignoring", "car"},
                                                                                 {"unspecified", "car"},
                                                                                 {"delivery", "van"},
                                                                                 {"truck", "truck"},
                                                                                 {"trailer", "truck"},
                                                                                 {"bus", "bus"},
                                                                                 {"coach", "bus"}}};
    for (const auto& [name, kind] : kinds)
        if (name == vehicle_class) return kind;
    return "other";
}

constexpr double usual_window_s = 1200.0;
constexpr double long_demand_s = 7200.0;

/// The twenty minutes with the most departures, and ten minutes before them.
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

Window choose_window(const std::vector<RoadUser>& vehicles, const SumoFiles& files, const Import& import) {
    double last_s = 0.0;
    double first_s = vehicles.front().depart_s;
    for (const RoadUser& vehicle : vehicles) {
        last_s = std::max(last_s, vehicle.depart_s);
        first_s = std::min(first_s, vehicle.depart_s);
    }
    const double end_s = files.end_s && *files.end_s > 0.0 ? std::min(*files.end_s, last_s) : last_s;
    const double begin_s = import.request.begin_s.value_or(files.begin_s.value_or(std::floor(first_s)));
    if (!import.request.begin_s && end_s - begin_s > long_demand_s) return busiest(vehicles, begin_s);
    constexpr double shortest_s = 60.0;
    return {begin_s, std::clamp(std::ceil(end_s - begin_s), shortest_s, usual_window_s)};
}

std::string vehicle_xml(RoadUser& vehicle, double begin_s) {
    Element element = std::move(vehicle.element);
    shift_stops(element, begin_s);
    Element route;
    route.name = "route";
    route.set("edges", fmt::format("{}", fmt::join(vehicle.edges, " ")));
    element.children.insert(element.children.begin(), std::move(route));
    std::vector<std::pair<std::string, std::string>> head = {
        {"id", vehicle.id},
        {"type", vehicle.type},
        {"depart", fmt::format("{:.2f}", vehicle.depart_s - begin_s)}};
    element.attributes.insert(element.attributes.begin(), head.begin(), head.end());
    return element.xml();
}

/// Keeps what shapes the traffic; answers what additional.add.xml says.
std::string additional_xml(const std::vector<Element>& elements, LeftOut& left_out) {
    std::string xml;
    for (const Element& element : elements) {
        const bool kept = std::ranges::find(kept_elements, element.name) != kept_elements.end();
        if (kept && !element.has("file")) {
            xml += element.xml();
            continue;
        }
        left_out.add(kept ? fmt::format("<{}> with a file of its own", element.name)
                          : fmt::format("<{}>, which does not shape the traffic", element.name),
                     element.text("id"));
    }
    return xml;
}

/// Length that emergency vehicles may ask of the routes of cars: 1 km where five routes are so long, else the
/// fifth longest.
double emergency_length_m(const std::vector<RoadUser>& vehicles, const Demand& demand,
                          const roads::Network& network) {
    constexpr double wanted_m = 1000.0;
    constexpr std::size_t enough = 5;
    std::set<std::vector<std::string>> seen;
    std::vector<double> lengths_m;
    for (const RoadUser& vehicle : vehicles) {
        if (kind_of_class(demand.types.at(vehicle.type).text("vClass")) != std::string_view("car")) continue;
        if (!seen.insert(vehicle.edges).second) continue;
        std::vector<core::EdgeIndex> route;
        for (const std::string& id : vehicle.edges)
            route.push_back(*network.find_edge(id));
        lengths_m.push_back(roads::route_length(network, route).value);
    }
    if (lengths_m.empty()) return wanted_m;
    std::ranges::sort(lengths_m, std::greater<>());
    return std::floor(std::min(wanted_m, lengths_m[std::min(enough, lengths_m.size()) - 1]));
}

/// Reads all files; what is no demand comes back for additional.add.xml.
std::vector<Element> read_files(const SumoFiles& files, DemandReader& reader) {
    std::vector<Element> others;
    for (const auto* list : {&files.additional, &files.routes})
        for (const std::filesystem::path& file : *list)
            for (Element& element : reader.read(file))
                others.push_back(std::move(element));
    return others;
}

scenario::Measured describe_types(Import& import, const Demand& demand,
                                  const std::vector<RoadUser>& vehicles) {
    scenario::Measured measured;
    measured.automated_share = import.request.automated_share;
    measured.routes = {"traffic.rou.xml"};
    measured.own_types = scenario::OwnTypes{"types.add.xml", import.request.car_following};
    std::set<std::string> used;
    for (const RoadUser& vehicle : vehicles)
        used.insert(vehicle.type);
    std::string types;
    for (const auto& [id, type] : demand.types) {
        if (!used.contains(id)) continue;
        const std::string& vehicle_class = type.text("vClass");
        measured.types.push_back(
            {id, kind_of_class(vehicle_class),
             vehicle_class == "ignoring" ? scenario::Access::unrestricted : scenario::Access::own});
        types += type.xml();
    }
    core::write_atomically(import.scenario / "types.add.xml", file_text("additional", types));
    return measured;
}

/// Takes out who cannot drive or walk as the files say. Where they are to be refused, all are, together.
void take_out_bad(Import& import, Demand& demand, const roads::Network& network,
                  const std::vector<Element>& additional) {
    std::vector<core::Problem> problems = take_out_bad_vehicles(demand, network, import.left_out);
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

}  // namespace

bool add_sumo_demand(Import& import, const SumoFiles& files, const roads::Network& network,
                     const std::filesystem::path& network_file, scenario::ScenarioConfig& config) {
    DemandReader reader(
        {files.begin_s.value_or(0.0), files.end_s.value_or(files.begin_s.value_or(0.0) + 3600.0)},
        import.left_out);
    const std::vector<Element> others = read_files(files, reader);
    Demand demand = reader.finish();
    Findings& findings = import.findings;
    for (const std::filesystem::path& file : demand.unsorted)
        findings.changes.push_back(fmt::format("{} is sorted by departure; SUMO would have dropped vehicles",
                                               file.filename().string()));
    take_out_bad(import, demand, network, others);
    find_ways(import, demand, network_file);
    const std::string additional = additional_xml(others, import.left_out);
    if (demand.vehicles.empty()) {
        for (const Person& person : demand.persons)
            import.left_out.add("persons, for no vehicle goes with them", person.id);
        return false;
    }

    const Window window = choose_window(demand.vehicles, files, import);
    std::vector<RoadUser>& vehicles = demand.vehicles;
    std::ranges::stable_sort(vehicles, {}, &RoadUser::depart_s);
    const std::size_t all = vehicles.size();
    std::erase_if(vehicles, [&](const RoadUser& vehicle) { return !window.holds(vehicle.depart_s); });
    if (vehicles.empty())
        throw core::InputError(core::Problem{
            "--begin",
            fmt::format("no vehicle departs in the {:.0f} s after {} s", window.length_s, window.begin_s),
            "a time with departures", "choose another begin"});
    if (vehicles.size() < all)
        findings.changes.push_back(fmt::format(
            "of {} vehicles the {} that depart from {:.0f} s to {:.0f} s are taken; --begin chooses "
            "another time",
            all, vehicles.size(), window.begin_s, window.end_s()));

    for (const RoadUser& vehicle : vehicles)
        ++findings.vehicles[kind_of_class(demand.types.at(vehicle.type).text("vClass"))];
    findings.vehicles_per_hour = static_cast<double>(vehicles.size()) * 3600.0 / window.length_s;
    findings.demand =
        fmt::format("as the route files say, {:.0f} s of it; {:.0f} % of the cars are automated",
                    window.length_s, 100.0 * import.request.automated_share);
    config.measured = describe_types(import, demand, vehicles);
    config.measured->emergency_minimum_length_m = emergency_length_m(vehicles, demand, network);
    if (!additional.empty()) {
        core::write_atomically(import.scenario / "additional.add.xml", file_text("additional", additional));
        config.measured->additional = {"additional.add.xml"};
    }
    set_times(window, config);
    add_persons(import, demand, network, window, config);
    config.demand = {};
    config.demand.emergency = 6;
    std::string routes;
    for (RoadUser& vehicle : vehicles)
        routes += vehicle_xml(vehicle, window.begin_s);
    core::write_atomically(import.scenario / "traffic.rou.xml", file_text("routes", routes));
    return true;
}

}  // namespace clearway::city::detail
