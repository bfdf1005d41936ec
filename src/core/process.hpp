#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace clearway::core {

/// How a child process is started. Arguments are passed as they are; no shell is involved.
struct Command {
    std::filesystem::path program;                        ///< Path, or a name looked up in PATH.
    std::vector<std::string> arguments = {};              ///< Without argv[0].
    std::map<std::string, std::string> environment = {};  ///< Added to, or replacing, the parent's.
    std::filesystem::path output =
        {};  ///< Both streams go to this file (created, truncated); empty: inherited.
    std::filesystem::path folder =
        {};  ///< Where it works; empty: inherited. Exit code 127 when it is not there.
};

/// How a child ended.
struct Exit {
    int code = 0;    ///< Exit status; 127 when the program could not be started.
    int signal = 0;  ///< Signal that killed it, or 0.
    double wall_s = 0.0;
    double cpu_s = 0.0;  ///< User and system time of the child and what it waited for.
    long peak_kib = 0;   ///< Largest resident size.
    bool ok() const { return code == 0 && signal == 0; }
    /// `exit code 3`, `killed by signal 11 (Segmentation fault)`.
    std::string describe() const;
};

/// A running child process.
struct Child {
    pid_t pid = -1;
    std::chrono::steady_clock::time_point started;
};

/// Starts a child. The child gets SIGTERM when this process dies (Linux), so that no worker outlives its
/// study. Throws EnvironmentError when the process table or a file prevents it.
Child start(const Command& command);

/// Waits for the end of `child`. Each child can be waited for once.
Exit wait(const Child& child);

/// How `child` ended, or nothing while it still runs. Each child can be collected once.
std::optional<Exit> poll(const Child& child);

/// Memory that a process holds at this moment, KiB; nothing when it is gone.
std::optional<long> resident_kib(pid_t process);

/// Starts and waits.
Exit run(const Command& command);

/// Words as one line for a shell, quoted where they must be.
std::string shell_text(const std::vector<std::string>& words);

/// The last `lines` lines of a text file; empty when it cannot be read.
std::string tail(const std::filesystem::path& file, int lines);

/// Folder of the running program, where its sister programs are.
std::filesystem::path program_folder();

}  // namespace clearway::core
