#include "scenario/detail/netconvert.hpp"

#include <algorithm>
#include <csignal>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/machine_failure.hpp"
#include "core/process.hpp"
#include "core/read_failure.hpp"
#include "scenario/detail/network_sources.hpp"
#include "scenario/network_document.hpp"

namespace clearway::scenario::detail {

namespace {

/// Nothing for a program that was ended because it did not end by itself.
std::optional<core::Exit> run_within(std::chrono::duration<double> longest, const core::Command& command) {
    const core::Child child = core::start(command);
    while (true) {
        if (const auto exit = core::poll(child)) return exit;
        if (std::chrono::steady_clock::now() - child.started > longest) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ::kill(child.pid, SIGKILL);
    core::wait(child);
    return std::nullopt;
}

}  // namespace

void run_netconvert(const ScenarioConfig& config, std::vector<std::string> arguments,
                    const std::filesystem::path& folder, std::chrono::duration<double> longest) {
    arguments.insert(arguments.end(), {"--xml-validation", "never"});
    core::Command command;
    command.program = "netconvert";
    command.arguments = std::move(arguments);
    command.output = folder / "netconvert.log";
    const auto exit = run_within(longest, command);
    if (!exit)
        throw core::InputError(
            {config.where("network"), fmt::format("netconvert does not end within {:g} s", longest.count()),
             "a network that it builds in that time", "Take a smaller one, or look for impossible values"});
    constexpr int not_found = 127;
    if (exit->code == not_found)
        throw core::EnvironmentError(
            "netconvert does not start. " +
            core::cure_of_no_start(
                "Install the package sumo, or give the same command again if the machine failed"));
    if (exit->ok()) return require_whole(*(std::ranges::find(command.arguments, "--output-file") + 1));
    const std::string complaint =
        complaint_in(command.output, folder, resolve(config, config.network.file).string());
    if (exit->signal == SIGKILL || core::tells_of_machine(complaint))  // so the system ends it without memory
        throw core::EnvironmentError(
            fmt::format("netconvert fails ({}):\n{}\nThe machine failed: give the same command again",
                        exit->describe(), complaint));
    throw core::InputError(refusal(config, exit->describe(), complaint));
}

}  // namespace clearway::scenario::detail
