#include "cli/detail/programs.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/process.hpp"

namespace clearway::cli {
namespace {

/// An empty file that is removed when this object is destroyed.
class TemporaryFile {
  public:
    TemporaryFile() : path_((std::filesystem::temp_directory_path() / "clearway-XXXXXX").string()) {
        const int descriptor = ::mkstemp(path_.data());
        if (descriptor < 0) {
            throw core::EnvironmentError(
                fmt::format("{}: cannot write there. Set TMPDIR to a writable folder",
                            std::filesystem::temp_directory_path().string()));
        }
        ::close(descriptor);
    }
    ~TemporaryFile() { ::unlink(path_.c_str()); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

}  // namespace

std::optional<std::string> output_of(const std::string& program, const std::vector<std::string>& arguments) {
    const TemporaryFile file;
    const core::Exit exit =
        core::run({.program = program, .arguments = arguments, .environment = {}, .output = file.path()});
    if (!exit.ok()) return std::nullopt;
    return core::tail(file.path(), 100);
}

std::string sister_program(const std::string& name) {
    return core::program_folder() / name;
}

void become(const std::string& program, const std::vector<std::string>& arguments) {
    std::vector<std::string> words = {program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    ::execv(program.c_str(), pointers.data());
    throw core::EnvironmentError(fmt::format("{}: cannot be started: {}", program, std::strerror(errno)));
}

study::Versions installed_versions() {
    const std::string program = sister_program("clearway-run");
    const std::string text = output_of(program, {"--version"}).value_or("");
    // `clearway-run 0.1.0 with SUMO 1.15.0`
    const std::string head = "clearway-run ";
    const std::string middle = " with SUMO ";
    const std::size_t split = text.find(middle);
    if (!text.starts_with(head) || split == std::string::npos) {
        throw core::EnvironmentError(
            fmt::format("{}: cannot be started. `clearway doctor` shows what is missing", program));
    }
    const std::size_t sumo = split + middle.size();
    return {text.substr(head.size(), split - head.size()), text.substr(sumo, text.find('\n', sumo) - sumo)};
}

}  // namespace clearway::cli
