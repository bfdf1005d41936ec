#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "experiment/condition.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

/// Whether Python code that a stored folder names may run. Neither a path nor an owner nor a file of the
/// folder proves who wrote the code, so only the user can say so.
enum class CodeTrust : std::uint8_t { none, trusted };

/// The study that a run folder holds; nothing where there is none yet.
std::optional<results::Manifest> study_in(const std::filesystem::path& folder);

/// Throws core::InputError, naming each part in Python that conditions of `where` have, unless it is trusted.
/// `titles` are by the names of conditions; one without a title has its name.
void require_trust(const std::vector<experiment::ConditionSpec>& conditions, const core::Settings& titles,
                   const std::string& where, CodeTrust trust);

/// The condition of a run folder with the user's files where they are now (experiment::located): at their own
/// place, beside the run folder, in it, or in the current folder. Throws core::InputError.
experiment::ConditionSpec with_files_found(const experiment::ConditionSpec& condition,
                                           const std::filesystem::path& run_folder);

/// Writes the tables of a run folder anew where somebody edited one of them, and says so on standard error. A
/// folder that cannot be written is left alone with a warning. Throws core::InputError for a damaged record.
void renew_edited_tables(const results::Store& store);

/// Says on standard error where the lines are that code in Python printed, if it printed any.
void tell_printed(const results::Store& store);

/// Says on standard error how many of all runs are missing, if any are. Returns incomplete then, else ok.
core::ExitCode tell_missing(std::size_t missing, std::size_t all);

}  // namespace clearway::campaign
