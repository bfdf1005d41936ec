// clearway-train: trains link prediction. A program of its own because linking libtorch costs 0.24 s and 90
// MB at each launch; `clearway links train` becomes this program.
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/process.hpp"
#include "core/program.hpp"
#include "core/usage.hpp"

namespace clearway::training {
namespace {

/// What can be trained, the recommended net first.
std::string list_of_nets() {
    const auto lines = [](std::span<const Net> nets) {
        std::string text;
        for (const Net& net : nets)
            text += fmt::format("  {:<23} {}\n", net.name, net.summary);
        return text;
    };
    return "Nets:\n" + lines(repair_nets()) + "To compare, and to repeat the dissertation:\n" +
           lines(comparison_nets()) +
           "\nThe data set comes from `clearway links dataset`; `clearway links train NET --help` says how, "
           "and "
           "describes the\n"
           "options.\n";
}

const Net* net_of(std::string_view name) {
    for (const std::span<const Net> nets : {repair_nets(), comparison_nets()}) {
        for (const Net& net : nets) {
            if (net.name == name) return &net;
        }
    }
    return nullptr;
}

std::vector<std::string> net_names() {
    std::vector<std::string> names;
    for (const std::span<const Net> nets : {repair_nets(), comparison_nets()}) {
        for (const Net& net : nets)
            names.emplace_back(net.name);
    }
    return names;
}

/// Parses the command line; the exit code where nothing is left to do.
std::optional<int> parse(CLI::App& app, int argument_count, char** argument_values) {
    app.formatter(std::make_shared<core::HelpFormatter>());
    try {
        app.parse(argument_count, argument_values);
        return std::nullopt;
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "{}", core::usage_message(app, app.get_name(), error, net_names()));
        return static_cast<int>(core::ExitCode::usage);
    }
}

int run_without_net(int argument_count, char** argument_values) {
    CLI::App app("Trains a model of link prediction: clearway links train NET --data DIR --out DIR.");
    app.name("clearway links train");
    app.set_version_flag("--version", "clearway-train " CLEARWAY_VERSION);
    app.footer(list_of_nets() +
               "\nExample:\n  clearway links train graphsage --data data/graphsage --out trained/graphsage");
    const bool starts_with_word = argument_count > 1 && argument_values[1][0] != '-';
    if (!starts_with_word) app.allow_extras();
    if (const auto code = parse(app, argument_count, argument_values)) return *code;
    fmt::print(stderr,
               "clearway links train: which net? Name one: clearway links train NET --data DIR --out DIR\n{}",
               list_of_nets());
    return static_cast<int>(core::ExitCode::usage);
}

int run(int argument_count, char** argument_values) {
    const Net* const net = argument_count > 1 ? net_of(argument_values[1]) : nullptr;
    if (net == nullptr) return run_without_net(argument_count, argument_values);
    CLI::App app(fmt::format("Trains {}: {}.", net->name, net->summary));
    app.name(fmt::format("clearway links train {}", net->name));
    CommonArguments arguments;
    const std::string recording = net->data[0] == '\0' ? "" : fmt::format(" {}", net->data);
    app.add_option("--data", arguments.data,
                   fmt::format("Data set of `clearway links dataset SCENARIO{} --out DIR`", recording))
        ->required()
        ->option_text("DIR (required)");
    app.add_option("--out", arguments.out, "Folder for the results; made when absent")
        ->required()
        ->option_text("DIR (required)");
    app.add_flag_callback(
        "--quiet", [&] { arguments.printing = Printing::closing_only; },
        "Do not print the losses of each epoch");
    app.add_flag_callback(
        "--json", [&] { arguments.printing = Printing::json; },
        "Print the summary as JSON, and nothing else");
    app.footer(fmt::format(
        "Results: {0}\n\nExample:\n  clearway links dataset city{1}{2} --out data/{3}\n"
        "  clearway links train {3} --data data/{3} --out trained/{3}",
        net->results, recording, recording.empty() ? "" : " --failure B10 --seeds 10", net->name));
    const auto train = net->configure(app, arguments);
    if (const auto code = parse(app, argument_count - 1, argument_values + 1)) return *code;
    watch_signals();
    core::make_folder(arguments.out);
    return static_cast<int>(train());
}

}  // namespace
}  // namespace clearway::training

int main(int argument_count, char** argument_values) {
    namespace core = clearway::core;
    core::begin_program();
    return static_cast<int>(core::end_of("clearway-train", [&] {
        return static_cast<core::ExitCode>(clearway::training::run(argument_count, argument_values));
    }));
}
