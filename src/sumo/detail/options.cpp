#include "sumo/detail/options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::sumo::detail {
namespace {

using Option = std::pair<std::string, std::string>;

/// Options that the session sets itself, so extra arguments must not change them. The last one drops vehicles
/// without a trace, even from the trip table.
constexpr std::array<std::string_view, 16> reserved = {"--net-file",
                                                       "--route-files",
                                                       "--additional-files",
                                                       "--begin",
                                                       "--step-length",
                                                       "--seed",
                                                       "--random",
                                                       "--route-steps",
                                                       "--tripinfo-output",
                                                       "--time-to-teleport",
                                                       "--ignore-junction-blocker",
                                                       "--remote-port",
                                                       "--configuration-file",
                                                       "--end",
                                                       "--load-state",
                                                       "--max-depart-delay"};

/// `--step-length` of `--step-length=0.5`; empty for a value.
std::string option_name(const std::string& argument) {
    if (!argument.starts_with("--")) return {};
    return argument.substr(0, argument.find('='));
}

std::string joined(const std::vector<std::filesystem::path>& files) {
    std::string names;
    for (const std::filesystem::path& file : files) {
        names += (names.empty() ? "" : ",") + file.string();
    }
    return names;
}

/// Which faults SUMO reports, and how it treats them.
std::vector<Option> fault_options() {
    return {
        // Shipped files fail against their own schemas.
        {"--xml-validation", "never"},
        {"--xml-validation.net", "never"},
        {"--xml-validation.routes", "never"},
        // The default teleports colliding vehicles away, which hides the collision and clears the road.
        {"--collision.action", "warn"},
        {"--collision.check-junctions", "true"},
        // A collision is physical contact. By default it is a gap below half of minGap (IDM), which depends
        // on the car-following style and would hide the real contacts.
        {"--collision.mingap-factor", "0"},
        // Vehicles that never arrive or never depart must not drop out of the means.
        {"--tripinfo-output.write-unfinished", "true"},
        {"--tripinfo-output.write-undeparted", "true"},
        // Messages come through std::cerr (see MessageLog); wall times would differ between equal runs.
        {"--no-step-log", "true"},
        {"--duration-log.disable", "true"},
    };
}

std::vector<Option> scenario_options(const SessionConfig& config) {
    std::vector<Option> options = {
        {"--net-file", config.network.string()},
        // Load everything at once: forked children would share the offset of a route file that is still being
        // read.
        {"--route-steps", "0"},
        {"--begin", fmt::format("{}", config.begin.value)},
        {"--step-length", fmt::format("{}", config.step_length.value)},
        {"--seed", fmt::format("{}", config.seed & 0x7fffffffU)},
        {"--time-to-teleport",
         fmt::format("{}", config.time_to_teleport.value < 0 ? -1.0 : config.time_to_teleport.value)},
        {"--tripinfo-output", (config.folder / trip_file).string()},
    };
    // Where it is off it is left out: SUMO's default.
    if (config.ignore_junction_blocker.value >= 0.0)
        options.emplace_back("--ignore-junction-blocker",
                             fmt::format("{}", config.ignore_junction_blocker.value));
    if (!config.route_files.empty()) options.emplace_back("--route-files", joined(config.route_files));
    if (!config.additional_files.empty())
        options.emplace_back("--additional-files", joined(config.additional_files));
    return options;
}

}  // namespace

void check(const SessionConfig& config) {
    std::vector<core::Problem> problems;
    const double step = config.step_length.value;
    if (!(step >= 0.01 && step <= 1.0))
        problems.push_back({"step length", fmt::format("{} s is out of range", step), "0.01 to 1 s", ""});
    else if (std::abs(step * 1000.0 - std::round(step * 1000.0)) > 1e-6)
        problems.push_back({"step length",
                            fmt::format("{} s is not whole milliseconds, SUMO's unit of time", step),
                            "a multiple of 0.001 s", ""});
    if (!(config.begin.value >= 0.0 && std::isfinite(config.begin.value)))
        problems.push_back(
            {"begin", fmt::format("{} s is out of range", config.begin.value), "0 s or later", ""});
    if (!std::isfinite(config.time_to_teleport.value))
        problems.push_back({"time to teleport", "is not a number", "seconds, negative for never", ""});
    if (!std::isfinite(config.ignore_junction_blocker.value))
        problems.push_back({"ignore junction blocker", "is not a number", "seconds, negative for never", ""});
    for (const std::string& argument : config.extra_arguments) {
        if (core::contains(reserved, option_name(argument)) || (argument.size() == 2 && argument[0] == '-'))
            problems.push_back({"extra SUMO arguments", argument + " is set by the session itself",
                                "long options that the session does not set",
                                "Use the scenario's own setting."});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

std::filesystem::path prepare_folder(const std::filesystem::path& folder) {
    core::make_folder(folder);
    const std::filesystem::path canonical = std::filesystem::canonical(folder);
    if (std::filesystem::is_directory(canonical / trip_file))
        throw core::EnvironmentError((canonical / trip_file).string() +
                                     " is a folder; SUMO needs to write a file there");
    core::write_atomically(canonical / trip_file, "");
    return canonical;
}

std::vector<std::string> arguments(const SessionConfig& config) {
    std::vector<std::string> result;
    std::vector<Option> options = scenario_options(config);
    for (Option& option : fault_options()) {
        const bool replaced = std::ranges::any_of(config.extra_arguments, [&](const std::string& argument) {
            return option_name(argument) == option.first;
        });
        if (!replaced) options.push_back(std::move(option));
    }
    for (Option& option : options) {
        result.push_back(std::move(option.first));
        result.push_back(std::move(option.second));
    }
    result.insert(result.end(), config.extra_arguments.begin(), config.extra_arguments.end());
    return result;
}

void set_sumo_home() {
    constexpr int keep_the_users = 0;
    ::setenv("SUMO_HOME", CLEARWAY_SUMO_HOME, keep_the_users);
}

}  // namespace clearway::sumo::detail
