#pragma once

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <sys/resource.h>

#include "core/error.hpp"

namespace clearway::core {

/// The error to throw, or to tell, where there was no memory.
inline EnvironmentError no_memory() {
    return EnvironmentError(
        "out of memory. Free some, or raise the limit of `ulimit -v`, and give the same command again");
}

/// What to do about a program that does not start: names the limit that a shell sets on memory (`ulimit -v`),
/// where there is one.
inline std::string cure_of_no_start(const std::string& otherwise) {
    rlimit memory{};
    if (::getrlimit(RLIMIT_AS, &memory) != 0 || memory.rlim_cur == RLIM_INFINITY) return otherwise;
    return fmt::format(
        "Its memory is limited to {} KiB, perhaps too few: raise the limit of `ulimit -v` and give the same "
        "command again",
        memory.rlim_cur / 1024);
}

/// The error to throw where another program or a library wrote only a part of `file` and does not say why.
inline EnvironmentError cut_short(const std::filesystem::path& file) {
    rlimit size{};
    const bool is_limited = ::getrlimit(RLIMIT_FSIZE, &size) == 0 && size.rlim_cur != RLIM_INFINITY;
    return EnvironmentError(fmt::format(
        "{}: only a part of it was written. {}", file.string(),
        is_limited ? fmt::format("Files are limited to {} KiB: raise the limit of `ulimit -f` and give the "
                                 "same command again",
                                 size.rlim_cur / 1024)
                   : "Perhaps the disk is full: free some space there and give the same command again"));
}

}  // namespace clearway::core
