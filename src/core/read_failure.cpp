#include "core/read_failure.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace clearway::core {
namespace {

constexpr std::array reasons_of_machine = {EIO, EMFILE, ENFILE, ENOMEM, ENOSPC, EDQUOT, EFBIG, ESTALE};

bool has_working_folder() {
    std::error_code gone;
    return !std::filesystem::current_path(gone).empty();
}

}  // namespace

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

const char* cure_of(int reason) {
    switch (reason) {
        case ENOSPC:
        case EDQUOT:
            return "Free some space there and give the same command again";
        case EFBIG:
            return "Raise the limit of `ulimit -f` and give the same command again";
        case EIO:
        case EMFILE:
        case ENFILE:
        case ENOMEM:
        case EAGAIN:
            return "The machine failed: give the same command again";
        case ENOENT:
            return has_working_folder() ? "Make its folder first, or choose another place"
                                        : "The working folder was removed: change to a folder that exists";
        case ELOOP:
            return "A symbolic link there leads to itself: remove it, or choose another place";
        default:
            return "Choose another place, or change its permissions";
    }
}

Error error_of(const std::system_error& fault) {
    const int reason = fault.code().value();
    const auto* const call = dynamic_cast<const std::filesystem::filesystem_error*>(&fault);
    if (call == nullptr || (reason != ELOOP && reason != ENAMETOOLONG))
        return {ExitCode::environment, fmt::format("{}. {}", fault.what(), cure_of(reason))};
    return {
        ExitCode::bad_input,
        format_problem({call->path1().string(), fmt::format("cannot be looked at: {}", std::strerror(reason)),
                        "", cure_of(reason)})};
}

bool is_of_machine(int reason) {
    return core::contains(reasons_of_machine, reason);
}

bool tells_of_machine(std::string_view words) {
    // SUMO, of a file that it may read
    if (words.find("Cannot get file attributes for file") != std::string_view::npos) return true;
    return std::ranges::any_of(reasons_of_machine, [&](int reason) {
        return words.find(std::strerror(reason)) != std::string_view::npos;
    });
}

}  // namespace clearway::core
