#pragma once

#include <filesystem>

#include "roads/network.hpp"
#include "trace/recording.hpp"

namespace clearway::campaign {

/// The network of a recording: that of `option` (--network) if it is not empty, or that of the run folder in
/// which `recording` lies. Throws core::InputError when it is missing or another one.
roads::Network recorded_network(const trace::RecordingInfo& info, const std::filesystem::path& recording,
                                const std::filesystem::path& option);

/// The run folder in which a recording lies, whether or not it is one.
std::filesystem::path run_folder_of(const std::filesystem::path& recording);

}  // namespace clearway::campaign
