#include "scenario_import/sumo/additional.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "scenario_import/sumo/vehicle_type.hpp"

namespace clearway::scenario_import::detail {

namespace {

constexpr std::array<std::string_view, 13> kept_elements = {
    "busStop",      "trainStop", "containerStop",    "chargingStation", "parkingArea",
    "tlLogic",      "WAUT",      "wautJunction",     "rerouter",        "variableSpeedSign",
    "parkingSpace", "route",     "routeDistribution"};

constexpr std::array<std::string_view, 4> detectors = {"inductionLoop", "e1Detector", "laneAreaDetector",
                                                       "e2Detector"};

void shift(Element& element, const char* attribute, double begin_s) {
    const auto at_s = time_s(element.text(attribute));
    if (at_s) element.set(attribute, fmt::format("{:.2f}", *at_s - begin_s));
}

void shift_intervals(Element& rerouter, double begin_s) {
    std::erase_if(rerouter.children, [&](Element& interval) {
        if (interval.name != "interval") return false;
        for (const char* const name : {"begin", "end"})
            shift(interval, name, begin_s);
        if (number(interval.text("end")).value_or(1.0) <= 0.0) return true;
        if (number(interval.text("begin")).value_or(0.0) < 0.0) interval.set("begin", "0.00");
        return false;
    });
}

/// Of the steps before the begin, only the last still matters.
void shift_steps(Element& sign, double begin_s) {
    std::vector<Element>& steps = sign.children;
    for (Element& step : steps)
        if (step.name == "step") shift(step, "time", begin_s);
    const auto is_past = [](const Element& step) {
        return step.name == "step" && number(step.text("time")).value_or(0.0) < 0.0;
    };
    while (std::ranges::count_if(steps, is_past) > 1)
        steps.erase(std::ranges::find_if(steps, is_past));
    for (Element& step : steps)
        if (is_past(step)) step.set("time", "0.00");
}

void shift_program(Element& program, double begin_s) {
    double cycle_s = 0.0;
    for (const Element& phase : program.children)
        if (phase.name == "phase") cycle_s += number(phase.text("duration")).value_or(0.0);
    const auto offset_s = program.has("offset") ? time_s(program.text("offset")) : 0.0;
    if (!offset_s || cycle_s <= 0.0) return;
    const double shifted_s = std::fmod(*offset_s - begin_s, cycle_s);
    program.set("offset", fmt::format("{:.2f}", shifted_s < 0.0 ? shifted_s + cycle_s : shifted_s));
}

void shift_times(Element& element, double begin_s) {
    if (element.name == "rerouter") shift_intervals(element, begin_s);
    if (element.name == "variableSpeedSign") shift_steps(element, begin_s);
    if (element.name == "tlLogic") shift_program(element, begin_s);
    // Switches count from refTime, which stays; past ones decide which program runs.
    for (Element& child : element.children)
        if (child.name == "wautSwitch") shift(child, "time", begin_s);
}

/// A run has each type as a human one, and car types also as automated ones.
void rename_types(Element& element, const std::map<std::string, Element>& types) {
    std::string renamed;
    for (const std::string& id : words(element.text("vTypes"))) {
        const auto type = types.find(id);
        if (type == types.end()) continue;
        renamed += fmt::format("{}human.{}", renamed.empty() ? "" : " ", id);
        if (kind_of_class(type->second.text("vClass")) == std::string_view("car"))
            renamed += fmt::format(" automated.{}", id);
    }
    if (!renamed.empty()) element.set("vTypes", renamed);
}

/// Removes the parameters that make a program write files.
void write_nothing(Element& program) {
    std::erase_if(program.children, [](const Element& child) {
        return child.name == "param" && (child.text("key") == "file" || child.text("key") == "freq");
    });
}

/// Ids of the detectors that signal programs name: as parameters, or in conditions such as `z:loop > 3`.
std::set<std::string> named_detectors(const std::vector<Element>& elements) {
    std::set<std::string> ids;
    for (const Element& program : elements) {
        if (program.name != "tlLogic") continue;
        for (const Element& child : program.children)
            for (const auto& [name, value] : child.attributes)
                for (const std::string& word : words(value, " \t()")) {
                    ids.insert(word);
                    ids.insert(word.substr(word.find(':') + 1));
                }
    }
    return ids;
}

std::string reason_to_leave_out(const Element& element) {
    const bool shapes = element.name == "calibrator" || element.name == "railSignalConstraints";
    return fmt::format("<{}>, which {} the traffic", element.name, shapes ? "affects" : "does not affect");
}

}  // namespace

bool shapes_traffic(const Element& element) {
    return core::contains(kept_elements, element.name);
}

Additional keep_additional(const std::vector<Element>& elements, const std::map<std::string, Element>& types,
                           double begin_s, LeftOut& left_out) {
    const std::set<std::string> needed = named_detectors(elements);
    Additional additional;
    unsigned long line = 3;
    for (const Element& element : elements) {
        const bool is_needed = core::contains(detectors, element.name) && needed.contains(element.text("id"));
        if (!is_needed && !shapes_traffic(element)) {
            left_out.add(reason_to_leave_out(element), element.text("id"));
            continue;
        }
        Element kept = element;
        if (is_needed) kept.set("file", "NUL");
        if (kept.name == "tlLogic") write_nothing(kept);
        if (begin_s != 0.0) shift_times(kept, begin_s);
        if (kept.has("vTypes")) rename_types(kept, types);
        const std::string xml = kept.xml();
        additional.places[line] = element.place;
        line += static_cast<unsigned long>(std::ranges::count(xml, '\n'));
        additional.xml += xml;
    }
    return additional;
}

}  // namespace clearway::scenario_import::detail
