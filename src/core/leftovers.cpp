#include "core/leftovers.hpp"

#include <cerrno>
#include <csignal>
#include <optional>
#include <vector>

#include "core/files.hpp"
#include "core/number.hpp"
#include "core/read_failure.hpp"

namespace clearway::core {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view import_mark = ".clearway-import-";

struct Leftover {
    std::string of;  ///< The name of what was being written.
    pid_t process = 0;
};

std::optional<Leftover> leftover_from(std::string name) {
    std::size_t begin = std::string::npos;  // of the number
    std::size_t end = name.size();
    std::size_t name_end = name.rfind(import_mark);
    if (name_end != std::string::npos) {
        begin = name_end + import_mark.size();
    } else if (name.ends_with(part_ending)) {
        end -= std::string_view(part_ending).size();
        name_end = name.substr(0, end).rfind('.');
        if (name_end != std::string::npos) begin = name_end + 1;
    }
    if (begin == std::string::npos) return std::nullopt;
    const auto process = number_from<pid_t>(name.substr(begin, end - begin));
    if (!process || *process <= 0) return std::nullopt;
    return Leftover{name.substr(0, name_end), *process};
}

/// Removes the leftovers in `folder` whose process is gone and of which `is_meant`.
template <class IsMeant>
void remove_leftovers(const fs::path& folder, const IsMeant& is_meant) {
    std::error_code ignored;
    std::vector<fs::path> left;
    for (auto entry = fs::directory_iterator(folder.empty() ? "." : folder, ignored);
         !ignored && entry != fs::directory_iterator(); entry.increment(ignored)) {
        const auto leftover = leftover_from(entry->path().filename().string());
        if (leftover && is_meant(leftover->of) && is_gone(leftover->process)) left.push_back(entry->path());
    }
    for (const fs::path& path : left)
        fs::remove_all(path, ignored);
}

}  // namespace

bool is_leftover(const fs::path& path) {
    return leftover_from(path.filename().string()).has_value();
}

bool is_abandoned(const fs::path& path) {
    const auto leftover = leftover_from(path.filename().string());
    return leftover && is_gone(leftover->process);
}

bool holds_only(const fs::path& folder, const std::function<bool(const std::string&)>& allowed) {
    std::error_code error;
    for (auto entry = fs::directory_iterator(folder, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        if (!allowed(entry->path().filename().string()) && !is_leftover(entry->path())) return false;
    }
    if (error == std::errc::not_a_directory) return false;
    if (error && error != std::errc::no_such_file_or_directory) fail_to_read(folder, error.value());
    return true;
}

bool is_absent_or_empty(const fs::path& folder) {
    return holds_only(folder, [](const std::string& name) { return name.starts_with('.'); });
}

bool is_gone(pid_t process) {
    return ::kill(process, 0) != 0 && errno == ESRCH;
}

void remove_abandoned_parts(const fs::path& folder) {
    remove_leftovers(folder, [](const std::string&) { return true; });
}

void remove_leftovers_of(const fs::path& target) {
    const std::string name = target.filename().string();
    remove_leftovers(target.parent_path(),
                     [&](const std::string& of) { return of == name || of == "." + name; });
}

void write_output(const fs::path& file, std::string_view content) {
    remove_leftovers_of(file);
    write_atomically(file, content);
}

}  // namespace clearway::core
