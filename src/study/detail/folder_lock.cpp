#include "study/detail/folder_lock.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::study::detail {
namespace {

std::string host() {
    std::array<char, 256> name{};
    ::gethostname(name.data(), name.size() - 1);
    return name.data();
}

std::string first_line(const std::filesystem::path& file) {
    const std::string text = core::read_file(file);
    return text.empty() ? "an unknown process" : text.substr(0, text.find('\n'));
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
    core::make_folder(folder);
    const std::filesystem::path file = folder / ".lock";
    descriptor_ = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (descriptor_ < 0)
        throw core::EnvironmentError(fmt::format("{}: {}", file.string(), std::strerror(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
        ::close(descriptor_);
        throw core::EnvironmentError(
            fmt::format("{}: another study works in this folder ({}). Wait for its end, stop it, or choose "
                        "another folder with --out",
                        folder.string(), first_line(file)));
    }
    const std::string holder = fmt::format("process {} on {}\n", ::getpid(), host());
    // Only for the message above: a full disk must not keep a study from being resumed.
    if (::ftruncate(descriptor_, 0) == 0) (void)!::write(descriptor_, holder.data(), holder.size());
}

FolderLock::~FolderLock() {
    ::close(descriptor_);
}

}  // namespace clearway::study::detail
