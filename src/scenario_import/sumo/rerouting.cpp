#include "scenario_import/sumo/rerouting.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "scenario_import/sumo/demand_reader.hpp"
#include "scenario_import/sumo/draw.hpp"

namespace clearway::scenario_import::detail {

namespace {

void set_parameter(Element& vehicle, const char* key, const std::string& value) {
    std::erase_if(vehicle.children,
                  [&](const Element& child) { return child.name == "param" && child.text("key") == key; });
    Element parameter;
    parameter.name = "param";
    parameter.set("key", key);
    parameter.set("value", value);
    vehicle.children.insert(vehicle.children.begin(), std::move(parameter));
}

}  // namespace

void add_routing_devices(Demand& demand, const Rerouting& rerouting) {
    for (RoadUser& vehicle : demand.vehicles) {
        const bool is_drawn = uniform(vehicle.id, NamedDraw::routing_device) < rerouting.share;
        // SUMO's mark of a trip. Unlike the device, it also accepts a way that is closed by then.
        if (vehicle.is_routed_at_departure) vehicle.element.set("reroute", "true");
        if (!is_drawn) continue;
        set_parameter(vehicle.element, "has.rerouting.device", "true");
        if (rerouting.period_s > 0.0)
            set_parameter(vehicle.element, "device.rerouting.period",
                          fmt::format("{:g}", rerouting.period_s));
    }
}

}  // namespace clearway::scenario_import::detail
