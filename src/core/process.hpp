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
    std::map<std::string, std::string> environment = {};  ///< Added to the parent's, or replacing it.
    /// File for both output streams (created, truncated); empty: inherited.
    std::filesystem::path output = {};
    /// Working folder; empty: inherited. If it does not exist, the exit code is 127.
    std::filesystem::path folder = {};
};

/// How a child ended.
struct Exit {
    int code = 0;    ///< Exit status; 127 when the program could not be started.
    int signal = 0;  ///< Signal that killed it, or 0.
    double wall_s = 0.0;
    double cpu_s = 0.0;  ///< User and system time of the child and of children it waited for.
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

/// Starts a child, and returns when it is its program: until then its memory is counted as this process's.
/// The child gets SIGTERM when this process dies (Linux), so that no worker outlives its study. Throws
/// EnvironmentError when the fork fails or the output file cannot be opened.
Child start(const Command& command);

/// Waits for the end of `child`. Each child can be waited for once.
Exit wait(const Child& child);

/// How `child` ended, or nothing while it still runs. Each child can be collected once.
std::optional<Exit> poll(const Child& child);

/// Resident memory of a process, KiB; nothing when the process has ended.
std::optional<long> resident_kib(pid_t process);

/// Starts and waits.
Exit run(const Command& command);

/// Opens /dev/null for those of the standard streams that are closed, so that no file which this process
/// opens becomes one: messages would be written into it. Writing to standard output then fails. For the
/// begin of a program, before it opens anything.
void open_standard_streams();

/// What each program does first. Opens the standard streams; lets a file over `ulimit -f` be an error that
/// names it instead of a signal; raises a small soft limit of the stack (`ulimit -s`), at whose end a program
/// is killed without a word. Ends the process, with a message, where the hard limit is below 1 MiB.
void begin_program();

/// Words as one shell command, quoted where necessary.
std::string shell_text(const std::vector<std::string>& words);

/// The words of a command with this option at this value, in place of the one that they give it, if any.
std::vector<std::string> with_option(std::vector<std::string> words, const std::string& name,
                                     const std::string& value);

/// The last `lines` lines of a text file; empty when it cannot be read.
std::string tail(const std::filesystem::path& file, int lines);

/// Folder of the running program; Clearway's other programs are there too.
std::filesystem::path program_folder();

}  // namespace clearway::core
