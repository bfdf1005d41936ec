#include "roads/controllers.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace clearway::roads {
namespace {

constexpr std::string_view needs_phases[] = {"sotl_phase",    "sotl_platoon", "sotl_request", "sotl_wave",
                                             "sotl_marching", "swarm",        "deterministic"};

/// SUMO 1.15 reads these for the signal of a road and then ends with a signal of the system.
bool is_no_signal(std::string_view type) {
    return type == "off" || type == "railSignal";
}

}  // namespace

const std::vector<std::string>& controllers() {
    static const std::vector<std::string> known = [] {
        std::vector<std::string> types = {"static", "actuated", "delay_based", "NEMA"};
        types.insert(types.end(), std::begin(needs_phases), std::end(needs_phases));
        types.emplace_back("railCrossing");
        return types;
    }();
    return known;
}

std::optional<core::Problem> controller_problem(std::string where, std::string_view signal,
                                                const std::string& type) {
    if (core::contains(controllers(), type)) return std::nullopt;
    if (is_no_signal(type))
        return core::Problem{
            std::move(where), fmt::format("type=\"{}\" of signal \"{}\" cannot be simulated", type, signal),
            core::listed(controllers()),
            fmt::format("Write one of these, or take the signal away: netconvert --sumo-net-file OLD "
                        "--tls.unset {} --output-file NEW",
                        signal)};
    return core::Problem{
        std::move(where), fmt::format("type=\"{}\" of signal \"{}\" is no controller of SUMO", type, signal),
        core::listed(controllers()),
        core::did_you_mean(type, controllers(),
                           "Write one of these; static shows its phases for their durations")};
}

bool needs_target_phase(std::string_view controller) {
    return std::ranges::find(needs_phases, controller) != std::end(needs_phases);
}

bool is_target_phase(std::string_view type, std::string_view target_lanes) {
    return type.find("target") != std::string_view::npos && !target_lanes.empty();
}

core::Problem target_phase_problem(std::string where, std::string_view signal, std::string_view controller) {
    return {std::move(where),
            fmt::format("type=\"{}\" of signal \"{}\" has no phase with type=\"target\" and targetLanes",
                        controller, signal),
            "at least one", "Give its greens both, or write type=\"static\""};
}

}  // namespace clearway::roads
