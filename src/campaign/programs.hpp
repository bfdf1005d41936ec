#pragma once

#include <optional>
#include <string>
#include <vector>

namespace clearway::study {
struct Versions;
}  // namespace clearway::study

namespace clearway::campaign {

/// What a program prints on both streams (its last 100 lines), or nothing when it cannot be started or fails.
/// `program` is a path or a name looked up in PATH.
std::optional<std::string> output_of(const std::string& program, const std::vector<std::string>& arguments);

/// Exit code of a program that cannot be started, as a shell has it.
inline constexpr int program_not_started = 127;

/// What to do about it: names the limit that a shell sets on memory (`ulimit -v`), where there is one.
std::string cure_of_no_start();

/// Path of another of Clearway's programs, in the folder of this one.
std::string sister_program(const std::string& name);

inline constexpr const char* why_no_trainer =
    "only training needs libtorch and XGBoost: `./clearway links train` installs them and builds it. Without "
    "the launcher, install the package clearway-train, or those of part `train` in packaging/packages.txt "
    "and "
    "build again";

/// Throws core::InputError for a program that is no Python 3: it may well end without an error and do
/// nothing. One that cannot be started is not refused here.
void require_python(const std::string& program);

/// Replaces this process with `program`, a path. Throws core::EnvironmentError when it cannot be started.
[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments);

/// What a worker says of itself in `clearway-run --version`, with the build "unknown" if it names none;
/// nothing for any other text:
///
///     clearway-run 0.1.0 with SUMO 1.15.0
///     build 0123456789abcdef
std::optional<study::Versions> versions_from(const std::string& text);

/// Whether a worker and this program were built from the same sources.
bool is_of_this_build(const study::Versions& worker);

inline constexpr const char* cure_of_another_build =
    "Build both programs together: ./clearway does so by itself, or `cmake --build FOLDER --target programs`";

/// Versions of Clearway and of the SUMO inside its worker, as the worker reports them. Throws
/// core::EnvironmentError when it cannot be started, usually because a shared library is missing, and when it
/// is of another build than this program.
study::Versions installed_versions();

/// Path of the worker. Throws as installed_versions, and asks the worker once in a process.
std::string worker_program();

}  // namespace clearway::campaign
