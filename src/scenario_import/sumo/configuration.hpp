#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario_import/sumo/rerouting.hpp"

namespace clearway::scenario_import::detail {

/// What an import takes from a SUMO configuration.
struct Configuration {
    std::filesystem::path network;
    std::vector<std::filesystem::path> routes;      ///< In order.
    std::vector<std::filesystem::path> additional;  ///< In order.
    std::optional<double> begin_s;
    std::optional<double> end_s;
    double scale = 1.0;          ///< Number of copies of each vehicle.
    double step_length_s = 1.0;  ///< SUMO's default where it says nothing.
    /// After which SUMO teleports a vehicle that stands; -1: never. Nothing: SUMO's default.
    std::optional<double> time_to_teleport_s;
    /// After which a vehicle that stands inside a junction no longer blocks it; -1: never. Nothing: SUMO's
    /// default.
    std::optional<double> ignore_junction_blocker_s;
    double sublane_width_m = 0.0;  ///< Of the sublane model (`lateral-resolution`); 0: lanes are whole.
    bool ignores_route_errors = false;
    Rerouting rerouting;
    std::vector<std::string> kept_options;   ///< As scenario::Measured::options.
    std::vector<std::string> other_options;  ///< Set there, but not taken over: `time-to-teleport = 60`.
};

/// Reads a .sumocfg: paths relative to it, lists with commas or blanks, `${VARIABLE}` as SUMO replaces it
/// (SUMO_HOME defaults to the usual one). Values are in `value`, in `v` or text. Throws core::InputError with
/// every missing file and the most similar name, for several networks and for an end before the begin.
Configuration read_configuration(const std::filesystem::path& file);

}  // namespace clearway::scenario_import::detail
