#pragma once

#include <filesystem>
#include <string>

namespace clearway::core {

/// Makes a new folder `PLACE/PREFIXpid-XXXXXX` for this process, which only its user can enter, and its
/// parents. First removes those of the same prefix whose process is gone: one that was killed (SIGKILL) could
/// not do it itself. Numbers of processes are those of this machine; a folder whose number another process
/// has by now stays. Throws EnvironmentError when it cannot be made.
std::filesystem::path process_folder(const std::filesystem::path& place, const std::string& prefix);

}  // namespace clearway::core
