#include "sumo/detail/outputs.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/read_failure.hpp"

namespace clearway::sumo::detail {
namespace {

bool is_written_file(int descriptor) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return false;
    const int flags = ::fcntl(descriptor, F_GETFL);
    return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

[[noreturn]] void fail(const std::filesystem::path& file, const char* verb) {
    const int reason = errno;
    throw core::EnvironmentError(std::string("cannot ") + verb + " " + file.string() + ": " +
                                 std::strerror(reason) + ". " + core::cure_of(reason));
}

/// A new file with `content`, positioned at its end, with the flags of `like`.
int create_like(int like, const std::filesystem::path& file, const std::string& content) {
    const int append = ::fcntl(like, F_GETFL) & O_APPEND;
    const int created = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | append, 0644);
    if (created < 0) fail(file, "create");
    std::size_t done = 0;
    while (done < content.size()) {
        const ssize_t written = ::write(created, content.data() + done, content.size() - done);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) {
            ::close(created);
            fail(file, "write");
        }
        done += static_cast<std::size_t>(written);
    }
    return created;
}

}  // namespace

std::set<int> Outputs::open_descriptors() {
    std::set<int> descriptors;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error))
        descriptors.insert(std::stoi(entry.path().filename().string()));
    if (error)
        throw core::EnvironmentError("/proc/self/fd cannot be read: " + error.message() + ". " +
                                     (core::is_of_machine(error.value())
                                          ? core::cure_of(error.value())
                                          : "Mount /proc: the files that SUMO writes are found there"));
    // The descriptor of the listing itself is among them, but closed by now.
    std::erase_if(descriptors, [](int descriptor) { return ::fcntl(descriptor, F_GETFD) < 0; });
    return descriptors;
}

Outputs::Outputs(const std::set<int>& before, const std::filesystem::path& folder) : folder_(folder) {
    std::vector<core::Problem> problems;
    for (const int descriptor : open_descriptors()) {
        if (before.contains(descriptor) || !is_written_file(descriptor)) continue;
        const std::filesystem::path file =
            std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor));
        const std::filesystem::path relative = file.lexically_relative(folder);
        if (relative.empty() || *relative.begin() == "..")
            problems.push_back({"SUMO output " + file.string(), "is not in the folder of the run",
                                folder.string() + " and below", "Give a path in that folder."});
        outputs_.push_back({descriptor, relative});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

void Outputs::move_to(const std::filesystem::path& folder) {
    for (const Output& output : outputs_) {
        const std::filesystem::path target = folder / output.relative;
        core::make_folder(target.parent_path());
        const int created =
            create_like(output.descriptor, target, core::read_file(folder_ / output.relative));
        const bool moved = ::dup2(created, output.descriptor) >= 0;
        ::close(created);
        if (!moved) fail(target, "redirect an output to");
    }
    folder_ = folder;
}

}  // namespace clearway::sumo::detail
