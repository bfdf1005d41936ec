#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "roads/network.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario::detail {

/// Throws core::InputError, with file and line, for plain XML that is nested so deep that netconvert does not
/// end, and for signal programs in it that SUMO could not run, of which netconvert takes some.
void check_sources(const ScenarioConfig& config);

/// What netconvert says in its log of why it ended, to be shown after the log is gone; paths of files that
/// were made from the sources are replaced by `source`. `made` is the folder of those files.
std::string complaint_in(const std::filesystem::path& log, const std::filesystem::path& made,
                         const std::string& source);

/// The network that netconvert refused with these words.
core::Problem refusal(const ScenarioConfig& config, const std::string& ended, const std::string& complaint);

/// Reads a network that was made from the sources of `config`, and additional files. Throws core::InputError
/// for what is wrong with it, which names the user's file with its line; where only the made network shows
/// it, the scenario's key with its file.
roads::Network read_made(const ScenarioConfig& config, const std::filesystem::path& made,
                         const std::vector<std::filesystem::path>& additional = {});

}  // namespace clearway::scenario::detail
