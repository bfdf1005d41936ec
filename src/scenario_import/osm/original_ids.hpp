#pragma once

#include <filesystem>

namespace clearway::scenario_import::detail {

/// Writes the XML map `numbered`, whose ids osmium renumber made, into `restored` with the ids that they had
/// before. `index` is the folder of osmium's index files. Holds 8 bytes for each object of the map that was
/// renumbered. Throws core::InputError for an id that the index does not have, core::EnvironmentError when it
/// cannot write.
void restore_ids(const std::filesystem::path& numbered, const std::filesystem::path& index,
                 const std::filesystem::path& restored);

}  // namespace clearway::scenario_import::detail
