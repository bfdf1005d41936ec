#include "scenario_import/sumo/vehicle_type.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::scenario_import::detail {

namespace {

using Names = std::pair<std::string_view, std::string_view>;

/// Devices that only observe; `bluelight` and `toc` are reported separately.
constexpr std::array<std::string_view, 8> watching_devices = {
    "ssm", "fcd", "emissions", "vehroute", "tripinfo", "btreceiver", "btsender", "example"};

/// `ssm` of `has.ssm.device` and `device.ssm.file`; empty for other keys.
std::string_view device_of(std::string_view key) {
    constexpr std::string_view has = "has.";
    constexpr std::string_view device = "device.";
    if (key.starts_with(has))
        key.remove_prefix(has.size());
    else if (key.starts_with(device))
        key.remove_prefix(device.size());
    else
        return {};
    return key.substr(0, key.find('.'));
}

/// The reason, as words in the plural; empty for devices that stay.
std::string reason_to_take_out(std::string_view device) {
    if (core::contains(watching_devices, device)) return "output devices of types and vehicles";
    if (device == "toc") return "ToC devices of types and vehicles, which affect the traffic";
    if (device == "bluelight") return "blue-light devices of types and vehicles, which affect the traffic";
    return {};
}

}  // namespace

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

std::string_view older_class(std::string_view vehicle_class) {
    // Class ship stands for vehicles that do not use roads.
    constexpr std::array<Names, 7> classes = {{{"subway", "rail_urban"},
                                               {"cable_car", "rail_urban"},
                                               {"scooter", "bicycle"},
                                               {"wheelchair", "pedestrian"},
                                               {"aircraft", "ship"},
                                               {"drone", "ship"},
                                               {"container", "ship"}}};
    for (const auto& [newer, older] : classes)
        if (newer == vehicle_class) return older;
    return {};
}

bool has_blue_lights(const Element& element) {
    constexpr std::array<std::string_view, 3> shapes = {"emergency", "firebrigade", "police"};
    if (element.text("vClass") == "emergency" || core::contains(shapes, element.text("guiShape")))
        return true;
    return std::ranges::any_of(element.children, [](const Element& child) {
        return child.name == "param" && child.text("key") == "has.bluelight.device" &&
               is_true(child.text("value"));
    });
}

void take_out_devices(Element& element, LeftOut& left_out) {
    std::set<std::string> named;
    std::erase_if(element.children, [&](const Element& child) {
        if (child.name != "param") return false;
        const std::string_view device = device_of(child.text("key"));
        const std::string reason = reason_to_take_out(device);
        if (reason.empty()) return child.text("key").ends_with(".file") && !device.empty();
        if (named.insert(reason).second)
            left_out.add(reason, fmt::format("{} of {} \"{}\"", device, element.name, element.text("id")));
        return true;
    });
}

}  // namespace clearway::scenario_import::detail
