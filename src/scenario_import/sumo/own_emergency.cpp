#include "scenario_import/sumo/own_emergency.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "scenario_import/sumo/vehicle_type.hpp"

namespace clearway::scenario_import::detail {
namespace {

/// Traffic that is on the road before the first emergency vehicle.
constexpr double usual_lead_s = 300.0;

/// By the shape that SUMO draws, which is the only thing that tells them apart.
std::string kind_of(const RoadUser& vehicle, const Element& type) {
    const std::string& own = vehicle.element.text("guiShape");
    const std::string& shape = own.empty() ? type.text("guiShape") : own;
    if (shape == "firebrigade") return "fire_engine";
    return shape == "police" ? "police_car" : "ambulance";
}

bool is_own(const Demand& demand, const RoadUser& vehicle) {
    return has_blue_lights(demand.types.at(vehicle.type)) || has_blue_lights(vehicle.element);
}

[[noreturn]] void refuse(const Import& import, const std::string& what, const std::string& cure) {
    throw core::InputError(core::Problem{
        import.request.files.front().string(), what,
        "with --own-emergency measure: vehicles with blue lights (class emergency, guiShape or device) and "
        "others",
        cure});
}

}  // namespace

void check_own_emergency(const Import& import, const Demand& demand, const Window& window) {
    if (import.request.own_emergency == OwnEmergency::traffic) return;
    std::optional<double> first_s;
    for (const RoadUser& vehicle : demand.vehicles) {
        if (!is_own(demand, vehicle)) continue;
        if (window.holds(vehicle.depart_s)) return;
        first_s = std::min(first_s.value_or(vehicle.depart_s), vehicle.depart_s);
    }
    if (!first_s) refuse(import, "has no emergency vehicle of its own", "leave out --own-emergency");
    refuse(import,
           fmt::format("has no emergency vehicle of its own from {:.0f} s to {:.0f} s; the first departs at "
                       "{:.0f} s",
                       window.begin_s, window.end_s(), *first_s),
           fmt::format("choose the time: --begin {:.0f}", std::max(0.0, *first_s - usual_lead_s)));
}

void take_own_emergency(Import& import, Demand& demand, const ClassAccess& access, double begin_s,
                        scenario::ScenarioConfig& config) {
    const auto own_one = [&](const RoadUser& vehicle) { return is_own(demand, vehicle); };
    std::vector<std::string>& changes = import.findings.changes;
    const auto count = std::ranges::count_if(demand.vehicles, own_one);
    if (import.request.own_emergency == OwnEmergency::traffic) {
        if (count > 0)
            changes.insert(changes.begin(),
                           fmt::format("{} emergency vehicles of the scenario drive as ordinary traffic, and "
                                       "{} of Clearway's are measured; --own-emergency measure takes the "
                                       "scenario's own",
                                       count, config.demand.emergency));
        return;
    }
    std::vector<RoadUser> own;
    std::ranges::copy_if(demand.vehicles, std::back_inserter(own), own_one);
    std::erase_if(demand.vehicles, own_one);
    for (const RoadUser& vehicle : own) {
        std::vector<core::EdgeIndex> route;
        for (const std::string& edge : vehicle.edges)
            route.push_back(*access.network().find_edge(edge));
        if (!access.opens_way(route, "emergency")) {
            import.left_out.add("own emergency vehicles whose way is closed to class emergency", vehicle.id);
            continue;
        }
        for (const Element& child : vehicle.element.children)
            if (child.name == "stop")
                import.left_out.add("stops of the scenario's own emergency vehicles", vehicle.id);
        config.emergency_trips.push_back({.from = {},
                                          .to = {},
                                          .edges = fmt::format("{}", fmt::join(vehicle.edges, " ")),
                                          .depart_s = vehicle.depart_s - begin_s,
                                          .kind = kind_of(vehicle, demand.types.at(vehicle.type))});
    }
    if (config.emergency_trips.empty())
        refuse(import, "has no emergency vehicle of its own whose way is open to class emergency",
               "open its way, or leave out --own-emergency");
    if (demand.vehicles.empty())
        refuse(import, "has no vehicle besides its emergency vehicles", "add traffic");
    config.demand.emergency = 0;
    for (const scenario::EmergencyTrip& trip : config.emergency_trips)
        config.time.warm_up_s = std::min(config.time.warm_up_s, std::floor(trip.depart_s));
    changes.insert(changes.begin(),
                   fmt::format("{} emergency vehicles of the scenario are the ones that are measured, with "
                               "their routes and departures; they are Clearway's types, and have blue lights "
                               "where a condition says so (bluelight)",
                               config.emergency_trips.size()));
}

}  // namespace clearway::scenario_import::detail
