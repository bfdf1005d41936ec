#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "experiment/condition.hpp"

namespace clearway::cli {

/// Declares `--policy`, `--failure`, `--predictor` and `--safety-checks` in a group of the help. Names are
/// checked later (names.hpp).
void add_condition_options(CLI::App& app, experiment::ConditionSpec& condition, const std::string& group);

/// Declares an option that is `on` or `off`; returns it for its group and text.
template <class Switch>
CLI::Option* add_switch(CLI::App& app, const std::string& name, Switch& value, const std::string& help) {
    return app
        .add_option_function<std::string>(
            name, [&value](const std::string& word) { value = *experiment::switch_from<Switch>(word); }, help)
        ->check(CLI::IsMember({"on", "off"}));
}

}  // namespace clearway::cli
