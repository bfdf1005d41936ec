#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "results/store.hpp"
#include "trace/recording.hpp"

namespace clearway::campaign {

/// How a run is named in arguments and messages.
inline constexpr const char* run_name_form = "FOLDER/SCENARIO/CONDITION/N";

/// `runs/mine/city/corridor/7`.
std::string run_name(const std::filesystem::path& folder, const experiment::RunKey& key);

/// Whether the text has the form of a run's name and its folder is a run folder.
bool names_a_run(const std::string& text);

/// A run of a study in its run folder; it need not be complete.
struct NamedRun {
    results::Store store;
    experiment::RunKey key;
};

/// The run that `name` means, by the name or the title of its condition. Throws core::InputError: naming
/// `where` (an option or argument) for text that is not a run's name, and naming the run for an unknown
/// scenario, condition or replication, with the nearest.
NamedRun run_named(const std::string& name, const std::string& where);

/// A recording, opened: its whole content is hashed then, so it is opened once.
struct NamedRecording {
    std::filesystem::path file;  ///< Absolute.
    std::unique_ptr<trace::RecordingReader> reader;
};

/// The recording of a run, given by the run's name or as the file itself. Throws core::InputError as above,
/// for a run that was not recorded, and for the recording of another run in its place; otherwise as
/// RecordingReader.
NamedRecording recording_named(const std::string& name, const std::string& where);

}  // namespace clearway::campaign
