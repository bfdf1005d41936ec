#pragma once

#include <CLI/App.hpp>

#include "scenario/config.hpp"

namespace clearway::cli {

/// Declares the options that change a scenario (`--dense`, `--density`, `--av-share`, `--kinds`,
/// `--emergency-kinds`, `--road-limit`, `--warm-up`, `--horizon`, `--step-length`, `--time-to-teleport`,
/// `--siren`, `--road-speed`, `--friction`, `--idm`). Values arrive in `options`, which outlives the parsing;
/// their ranges are checked when the scenario is loaded, together with the rest of it.
void add_scenario_options(CLI::App& app, scenario::Options& options);

}  // namespace clearway::cli
