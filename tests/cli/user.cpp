#include "user.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "core/files.hpp"

namespace clearway::cli {
namespace {

const char* const line_scenario = R"(name = "line"
version = "test"
title = "A straight road of two lanes"

[network]
nodes = "line.nod.xml"
edges = "line.edg.xml"

[time]
warm_up_s = 5.0
window_s = 20.0
horizon_s = 200.0

[demand]
human = 5
automated = 3
emergency = 1

[[flow]]
from = "first"
to = "second"
share = 1.0
)";

const char* const line_nodes = R"(<nodes>
    <node id="a" x="0" y="0"/><node id="b" x="300" y="0"/><node id="c" x="600" y="0"/><node id="d" x="300" y="200"/>
</nodes>
)";

// Nothing leads to `side`.
const char* const line_edges = R"(<edges>
    <edge id="first" from="a" to="b" numLanes="2" speed="20"/>
    <edge id="second" from="b" to="c" numLanes="2" speed="20"/>
    <edge id="side" from="d" to="b" numLanes="1" speed="20"/>
</edges>
)";

}  // namespace

bool has_trainer() {
    const support::TemporaryFolder folder;
    return core::run({.program = std::filesystem::path(CLEARWAY_BINARY_DIR) / "bin" / "clearway-train",
                      .arguments = {"--version"},
                      .output = folder.path() / "said"})
        .ok();
}

void UserTest::SetUp() {
    setenv("SUMO_HOME", "/usr/share/sumo", 0);
    unsetenv("CLEARWAY_HOME");
}

core::Child UserTest::start(const std::vector<std::string>& words, const Environment& environment) const {
    const std::string output = environment.output.empty() ? "stdout.txt" : environment.output;
    const std::string before = environment.before.empty() ? "" : environment.before + " && ";
    core::Command command{
        "/bin/sh",
        {"-c", "cd \"$1\" && shift && " + before + "exec \"$@\" > " + output + " 2> stderr.txt", "sh",
         folder().string(), std::string(CLEARWAY_BINARY_DIR) + "/bin/clearway"},
        environment.environment,
        {}};
    command.arguments.insert(command.arguments.end(), words.begin(), words.end());
    return core::start(command);
}

Ended UserTest::finish(const core::Child& child) const {
    const core::Exit exit = core::wait(child);
    const std::filesystem::path out = folder() / "stdout.txt";
    return {exit.signal != 0 ? 128 + exit.signal : exit.code,
            std::filesystem::exists(out) ? core::read_file(out) : std::string(),
            core::read_file(folder() / "stderr.txt")};
}

Ended UserTest::clearway(const std::vector<std::string>& words, const Environment& environment) const {
    return finish(start(words, environment));
}

Ended UserTest::on_terminal(const std::vector<std::string>& words, int columns,
                            const std::string& kind) const {
    std::vector<std::string> command = {std::string(CLEARWAY_BINARY_DIR) + "/bin/clearway"};
    command.insert(command.end(), words.begin(), words.end());
    const std::string line = "cd " + core::shell_text({folder().string()}) + " && stty cols " +
                             std::to_string(columns) + " && export TERM=" + kind + " && " +
                             core::shell_text(command);
    const std::filesystem::path transcript = folder() / "terminal.txt";
    const core::Exit exit =
        core::run({"/usr/bin/script", {"-q", "-e", "-c", line, transcript.string()}, {}, "/dev/null"});
    return {exit.code, core::read_file(transcript), ""};
}

std::string UserTest::read(const std::string& name) const {
    return core::read_file(folder() / name);
}

std::filesystem::path UserTest::write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder() / name).parent_path());
    return folder_.write(name, text);
}

void UserTest::write_program(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = write(name, "#!/bin/sh\necho '" + text + "'\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

void UserTest::write_line_scenario(const std::string& replaced, const std::string& replacement) const {
    std::string text = line_scenario;
    if (!replaced.empty()) {
        const std::size_t at = text.find(replaced);
        if (at == std::string::npos) throw std::invalid_argument(replaced + " is not in the scenario");
        text.replace(at, replaced.size(), replacement);
    }
    write("line/scenario.toml", text);
    write("line/line.nod.xml", line_nodes);
    write("line/line.edg.xml", line_edges);
}

}  // namespace clearway::cli
