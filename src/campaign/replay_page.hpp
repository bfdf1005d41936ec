#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "roads/network.hpp"
#include "trace/recording.hpp"
#include "view/recorded_run.hpp"

namespace clearway::campaign {

/// The network of a recording: that of `option` (--network) if it is not empty, or that of the run folder in
/// which `recording` lies. Throws core::InputError when it is missing or another one.
roads::Network recorded_network(const trace::RecordingInfo& info, const std::filesystem::path& recording,
                                const std::filesystem::path& option);

/// The mean times of other days that the scenario of a recorded run names, by edge; empty where it names
/// none, and where the run folder is not there or another network was named.
std::vector<double> recorded_mean_times(const trace::RecordingInfo& info,
                                        const std::filesystem::path& recording,
                                        const std::filesystem::path& option);

/// The run folder in which a recording lies, whether or not it is one.
std::filesystem::path run_folder_of(const std::filesystem::path& recording);

/// What `clearway replay --view` was asked for.
struct ReplayPage {
    std::vector<std::string> runs;  ///< One or two, by name or file.
    std::filesystem::path network;  ///< Empty: that of their run folder.
    std::filesystem::path file;     ///< Empty: named after the runs, in the present folder.
    view::Window window;
};

/// What is said of a page once it is written: where, how large, and for a large one how to make it smaller.
std::string written_words(const std::filesystem::path& file, std::size_t bytes);

/// Writes a page that plays the runs side by side, and says where it is. Throws core::InputError for runs
/// that are not recorded, or not on one network.
core::ExitCode write_replay_page(const ReplayPage& page);

}  // namespace clearway::campaign
