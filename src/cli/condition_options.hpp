#pragma once

#include <string>

#include <CLI/App.hpp>

#include "results/unit.hpp"

namespace clearway::cli {

/// Declares `--policy`, `--failure`, `--predictor` and `--safety-checks` in a group of the help. Names are
/// checked later (names.hpp).
void add_condition_options(CLI::App& app, results::ConditionSpec& condition, const std::string& group);

}  // namespace clearway::cli
