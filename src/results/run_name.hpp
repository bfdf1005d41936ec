#pragma once

#include <filesystem>
#include <string>

#include "results/store.hpp"

namespace clearway::results {

/// How a run is named wherever one is asked for or told of.
inline constexpr const char* run_name_form = "FOLDER/SCENARIO/CONDITION/N";

/// `runs/mine/city/corridor/7`.
std::string run_name(const std::filesystem::path& folder, const experiment::RunKey& key);

/// A run of a run folder; it may be missing there.
struct NamedRun {
    Store store;
    experiment::RunKey key;
};

/// The run that `name` means. Throws core::InputError, saying `where` (an option or argument), for what is no
/// such name, and for a folder, scenario, condition or replication that is not there, with the nearest.
NamedRun run_named(const std::string& name, const std::string& where);

/// The recording of a run, which is given by its name or as the file itself. Throws core::InputError as
/// above, and for a run that was not recorded.
std::filesystem::path recording_named(const std::string& name, const std::string& where);

}  // namespace clearway::results
