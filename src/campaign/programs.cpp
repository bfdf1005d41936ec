#include "campaign/programs.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "core/build_stamp.hpp"
#include "core/error.hpp"
#include "core/machine_failure.hpp"
#include "core/process.hpp"
#include "core/temporary_folder.hpp"
#include "study/plan.hpp"

namespace clearway::campaign {

namespace {

/// How a program ends, and the last lines that it prints.
std::pair<core::Exit, std::string> answer_of(const std::string& program,
                                             const std::vector<std::string>& arguments) {
    const core::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "answer";
    const core::Exit exit =
        core::run({.program = program, .arguments = arguments, .environment = {}, .output = file});
    return {exit, core::tail(file, 100)};
}

}  // namespace

std::optional<std::string> output_of(const std::string& program, const std::vector<std::string>& arguments) {
    const auto& [exit, text] = answer_of(program, arguments);
    return exit.ok() ? std::optional(text) : std::nullopt;
}

std::string cure_of_no_start() {
    return core::cure_of_no_start("Give the same command again; `clearway doctor` shows what is missing");
}

std::string sister_program(const std::string& name) {
    return core::program_folder() / name;
}

void require_python(const std::string& program) {
    const auto& [exit, text] = answer_of(program, {"-c", "import sys; print(sys.version_info.major * 6)"});
    if (exit.code == program_not_started || text == "18\n") return;
    throw core::InputError({"--python", fmt::format("{} is no Python 3", program),
                            "a Python, such as /usr/bin/python3", "Leave the option out for that one"});
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

std::optional<study::Versions> versions_from(const std::string& text) {
    const std::string head = "clearway-run ";
    const std::string middle = " with SUMO ";
    const std::string last = "\nbuild ";
    const std::size_t split = text.find(middle);
    if (!text.starts_with(head) || split == std::string::npos) return std::nullopt;
    const std::size_t sumo = split + middle.size();
    study::Versions versions{text.substr(head.size(), split - head.size()),
                             text.substr(sumo, text.find('\n', sumo) - sumo), "unknown"};
    if (const std::size_t end = text.find(last, sumo); end != std::string::npos) {
        const std::size_t build = end + last.size();
        versions.build = text.substr(build, text.find('\n', build) - build);
    }
    return versions;
}

bool is_of_this_build(const study::Versions& worker) {
    return worker.build == core::build_stamp();
}

study::Versions installed_versions() {
    const std::string program = sister_program("clearway-run");
    const auto worker = versions_from(output_of(program, {"--version"}).value_or(""));
    if (!worker)
        throw core::EnvironmentError(fmt::format("{}: cannot be started. {}", program, cure_of_no_start()));
    if (!is_of_this_build(*worker))
        throw core::EnvironmentError(
            fmt::format("{}: is of another build than this clearway: build {}, not {}. Defaults, models and "
                        "results may differ. {}",
                        program, worker->build, core::build_stamp(), cure_of_another_build));
    return *worker;
}

std::string worker_program() {
    static const study::Versions checked = installed_versions();
    return sister_program("clearway-run");
}

}  // namespace clearway::campaign
