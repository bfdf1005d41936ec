#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiment/condition.hpp"

namespace clearway::experiment {

/// Makes the names of parts in Python absolute, below `folder`, with the hashes of their files
/// (python::resolved). Throws core::InputError, naming `where`.
void resolve_parts(ConditionSpec& condition, const std::filesystem::path& folder, const std::string& where);

/// Copies parts in Python, with the files that they are made of (python::sources_of), and models into a run
/// folder, `code/HASH/`: their user may edit them while runs are made, or take the folder elsewhere. Throws
/// core::InputError for one that was changed since it was resolved, and core::EnvironmentError.
void keep_code(const std::vector<ConditionSpec>& conditions, const std::filesystem::path& run_folder);

/// The folders of these copies.
std::vector<std::filesystem::path> kept_code(const std::filesystem::path& run_folder);

/// The condition with its parts in Python and its model where they are now (python::located_file). Throws
/// core::InputError, naming `where`.
ConditionSpec located(ConditionSpec condition, const std::vector<std::filesystem::path>& folders,
                      const std::string& where);

/// The condition with copies in a run folder in place of what was changed or is gone. Without a copy it stays
/// as it is: where the part is loaded, it is told what changed.
ConditionSpec with_kept_code(const ConditionSpec& condition, const std::filesystem::path& run_folder);

/// What settings, leases and tables call a part in Python (python::short_name); nothing for other words.
std::optional<std::string> part_called(const std::string& word);
/// The names of the parts in Python that a condition has.
std::vector<std::string> part_names(const ConditionSpec& condition);

}  // namespace clearway::experiment
