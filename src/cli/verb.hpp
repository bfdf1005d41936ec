#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace clearway::cli {

class App;

/// How this program was called.
struct Invocation {
    std::string command;                  ///< One line for a shell: `clearway run city --seeds 5`.
    std::vector<std::string> words = {};  ///< Of it, each as it was given.
};

/// What a verb does once its arguments are parsed. Throws core::Error for errors that are reported to the
/// user.
using Action = std::function<core::ExitCode(const Invocation& invocation)>;

/// A verb of the command line: `configure` declares its options on `app` and returns what to do with them.
struct Verb {
    const char* name;
    const char* summary;               ///< One line for `clearway --help`.
    const char* example;               ///< Shown at the end of the verb's own help.
    Action (*configure)(App&);         ///< Null: one of the parts must be named.
    std::span<const Verb> parts = {};  ///< `status` of `study status`.
};

/// All verbs, in the order of the help.
std::span<const Verb> verbs();

/// The whole program: parses, runs the verb, prints errors on standard error. Returns the exit code.
int run_command_line(int argument_count, const char* const* arguments);

Action configure_run(App& app);
Action configure_study(App& app);
Action configure_submit(App& app);
Action configure_merge(App& app);
Action configure_status(App& app);
Action configure_report(App& app);
Action configure_figures(App& app);
Action configure_compare(App& app);
Action configure_results(App& app);
Action configure_replay(App& app);
Action configure_verify(App& app);
Action configure_dataset(App& app);
Action configure_train(App& app);
Action configure_evaluate(App& app);
Action configure_live(App& app);
Action configure_list(App& app);
Action configure_init(App& app);
Action configure_import(App& app);
Action configure_signals(App& app);
Action configure_mean_times(App& app);
Action configure_equip(App& app);
Action configure_check(App& app);
Action configure_attach(App& app);
Action configure_trajectories(App& app);
Action configure_environment(App& app);
Action configure_python(App& app);
Action configure_doctor(App& app);

}  // namespace clearway::cli
