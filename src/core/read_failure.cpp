#include "core/read_failure.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::core {

void fail_to_read(const std::filesystem::path& file, int reason) {
    switch (reason) {
        case ENOENT:
        case ENOTDIR:
        case EISDIR:
        case EACCES:
        case EPERM:
        case ELOOP:
        case ENAMETOOLONG:
        case ENXIO:
            throw InputError({file.string(), fmt::format("cannot be read: {}", std::strerror(reason)), "",
                              "Check that the file exists and is readable"});
        default:
            throw EnvironmentError(
                fmt::format("{}: cannot be read: {}. The machine failed, not the file's content: "
                            "give the same command again",
                            file.string(), std::strerror(reason)));
    }
}

}  // namespace clearway::core
