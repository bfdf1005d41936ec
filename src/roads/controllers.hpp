#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace clearway::roads {

/// What runs a signal program: attribute `type` of a `tlLogic`. Those of SUMO 1.15 (SUMOXMLDefinitions) with
/// which a road network can be simulated; tried one by one, since SUMO reads more of them than it can run.
const std::vector<std::string>& controllers();

/// What is wrong with the controller `type` of `signal`, which stands at `where`; nothing for one of
/// `controllers`.
std::optional<core::Problem> controller_problem(std::string where, std::string_view signal,
                                                const std::string& type);

/// Whether this controller asks for at least one phase with type="target" and targetLanes: the
/// self-organising ones. SUMO ends without.
bool needs_target_phase(std::string_view controller);
/// Whether a phase with these attributes is one.
bool is_target_phase(std::string_view type, std::string_view target_lanes);
core::Problem target_phase_problem(std::string where, std::string_view signal, std::string_view controller);

}  // namespace clearway::roads
