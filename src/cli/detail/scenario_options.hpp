#pragma once

#include <string>

#include "cli/detail/app.hpp"
#include "scenario/config.hpp"

namespace clearway::cli {

/// Declares the scenario that a verb needs, its first word.
void add_scenario_argument(App& app, std::string& scenario);

/// Declares an option for each override of a scenario (`--dense`, `--density`, ...; scenario/overrides.hpp).
/// `options` receives the values and must outlive the parsing. Ranges are checked when the scenario is
/// loaded, together with the rest of it.
void add_scenario_options(App& app, scenario::Options& options);

/// Declares `--override NAME=VALUE` instead: all overrides by their names in study files.
void add_override_option(App& app, scenario::Options& options);

}  // namespace clearway::cli
