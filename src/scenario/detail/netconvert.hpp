#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "scenario/config.hpp"

namespace clearway::scenario::detail {

/// Runs netconvert on sources of `config`; `arguments` name its `--output-file`. It leaves a log in `folder`.
/// Throws core::InputError, in netconvert's words, for what it refuses, and for what it does not work through
/// in `longest`; core::EnvironmentError when it does not start or the machine failed.
void run_netconvert(const ScenarioConfig& config, std::vector<std::string> arguments,
                    const std::filesystem::path& folder,
                    std::chrono::duration<double> longest = std::chrono::hours(1));

}  // namespace clearway::scenario::detail
