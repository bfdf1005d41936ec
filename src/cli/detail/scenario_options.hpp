#pragma once

#include <CLI/App.hpp>

#include "scenario/config.hpp"

namespace clearway::cli {

/// Declares the options that change a scenario (`--dense`, `--density`, ...). `options` receives the values
/// and must outlive the parsing. Ranges are checked when the scenario is loaded, together with the rest of
/// it.
void add_scenario_options(CLI::App& app, scenario::Options& options);

}  // namespace clearway::cli
