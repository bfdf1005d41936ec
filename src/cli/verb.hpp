#pragma once

#include <functional>
#include <span>
#include <string>

#include <CLI/App.hpp>

#include "core/error.hpp"

namespace clearway::cli {

/// How this program was called.
struct Invocation {
    std::string command;  ///< One line for a shell: `clearway run city --seeds 5`.
};

/// What a verb does once its arguments are parsed. Throws core::Error for errors that are reported to the
/// user.
using Action = std::function<core::ExitCode(const Invocation& invocation)>;

/// A verb of the command line: `configure` declares its options on `app` and returns what to do with them.
struct Verb {
    const char* name;
    const char* summary;               ///< One line for `clearway --help`.
    const char* example;               ///< Shown at the end of the verb's own help.
    Action (*configure)(CLI::App&);    ///< Null: one of the parts must be named.
    std::span<const Verb> parts = {};  ///< `status` of `study status`.
};

/// All verbs, in the order of the help.
std::span<const Verb> verbs();

/// The whole program: parses, runs the verb, prints errors on standard error. Returns the exit code.
int run_command_line(int argument_count, const char* const* arguments);

Action configure_run(CLI::App& app);
Action configure_study(CLI::App& app);
Action configure_submit(CLI::App& app);
Action configure_merge(CLI::App& app);
Action configure_status(CLI::App& app);
Action configure_report(CLI::App& app);
Action configure_figures(CLI::App& app);
Action configure_compare(CLI::App& app);
Action configure_results(CLI::App& app);
Action configure_replay(CLI::App& app);
Action configure_verify(CLI::App& app);
Action configure_dataset(CLI::App& app);
Action configure_train(CLI::App& app);
Action configure_evaluate(CLI::App& app);
Action configure_live(CLI::App& app);
Action configure_list(CLI::App& app);
Action configure_init(CLI::App& app);
Action configure_import(CLI::App& app);
Action configure_signals(CLI::App& app);
Action configure_mean_times(CLI::App& app);
Action configure_equip(CLI::App& app);
Action configure_check(CLI::App& app);
Action configure_attach(CLI::App& app);
Action configure_trajectories(CLI::App& app);
Action configure_environment(CLI::App& app);
Action configure_python(CLI::App& app);
Action configure_doctor(CLI::App& app);

}  // namespace clearway::cli
