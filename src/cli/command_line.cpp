#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/detail/app.hpp"
#include "cli/verb.hpp"
#include "core/build_stamp.hpp"
#include "core/error.hpp"
#include "core/process.hpp"
#include "core/program.hpp"
#include "core/usage.hpp"
#include "failures/failure_config.hpp"
#include "prediction/predictor.hpp"

namespace clearway::cli {
namespace {

constexpr std::array study_parts = {
    Verb{"status", "Show the progress of a study, also while it runs elsewhere",
         "clearway study status runs/mine --json", configure_status},
    Verb{"submit", "Divide a study into shards for a cluster, GNU parallel or local processes",
         "clearway study submit my-study.toml --engine slurm --out /shared/mine --go", configure_submit},
    Verb{"merge", "Merge the shards of a study", "clearway study merge /shared/mine --out runs/mine",
         configure_merge},
};

constexpr std::array export_parts = {
    Verb{"figures", "Write every figure and table of a report as SVG, PDF, PNG, CSV and LaTeX",
         "clearway export figures runs/parts --out figures", configure_figures},
    Verb{"results", "Print any table of a run folder as CSV or JSON",
         "clearway export results runs/parts vehicles --csv", configure_results},
    Verb{"trajectories", "Write where EVs and their neighbours drove, as GeoJSON and CSV",
         "clearway export trajectories runs/city-1a2b3c/city/corridor/0", configure_trajectories},
};

constexpr std::array links_parts = {
    Verb{"dataset", "Record a data set for link prediction from a scenario",
         "clearway links dataset city --out data/city", configure_dataset},
    Verb{"train", "Train the net of link prediction that is named",
         "clearway links train graphsage --data data/graphsage --out trained/graphsage", configure_train},
    Verb{"evaluate", "Evaluate predictors by their links, on seeds kept for this purpose",
         "clearway links evaluate --benchmark eval_v1 --quick", configure_evaluate},
};

constexpr std::array scenario_parts = {
    Verb{"init", "Copy a scenario into a folder of your own to edit",
         "clearway scenario init my-crossing --from intersection", configure_init},
    Verb{"import", "Make a scenario from an OpenStreetMap extract or a SUMO scenario",
         "clearway scenario import monaco.osm.pbf --name monaco", configure_import},
    Verb{"check", "Run a scenario briefly and check whether it is fit for a study",
         "clearway scenario check ./monaco", configure_check},
    Verb{"signals", "List a scenario's signals, draw them, write their preemption parameters",
         "clearway scenario signals city --svg signals.svg --out preemption.csv", configure_signals},
    Verb{"mean-times", "Write mean times of edges from runs on other days, for `navigate`",
         "clearway scenario mean-times city --out mean_times.csv", configure_mean_times},
};

constexpr std::array python_parts = {
    Verb{"environment", "Serve episodes to clearway.env of the Python package, which starts it",
         "clearway python environment intersection --out /tmp/env --channel 3 4 5", configure_environment},
};

constexpr std::array all_verbs = {
    Verb{"run", "Run one scenario under chosen conditions",
         "clearway run intersection --dense --policy dissertation --failure B10 --predictor dead_reckoning",
         configure_run},
    Verb{"study", "Run a study file: scenarios x conditions x factors x replications",
         "clearway study my-study.toml --out runs/mine", configure_study, study_parts},
    Verb{"report", "Print the tables of a run folder and write its report.html", "clearway report runs/parts",
         configure_report},
    Verb{"compare", "Compare the conditions of a run folder, or two run folders, pair by pair",
         "clearway compare runs/old runs/new --tolerance 1 --tolerance collisions=0.5", configure_compare},
    Verb{"export", "Write figures, tables or trajectories of finished runs as files",
         "clearway export figures runs/parts --out figures", nullptr, export_parts},
    Verb{"verify", "Repeat stored runs and compare every number",
         "clearway verify runs/parts/city/corridor/7", configure_verify},
    Verb{"replay", "Replay a recorded run in a browser, otherwise predicted, or as CSV",
         "clearway replay runs/city-1a2b3c/city/corridor/0 --predictor dead_reckoning", configure_replay},
    Verb{"live", "Run a scenario and show it in a browser while it happens",
         "clearway live city --policy corridor --against baseline", configure_live},
    Verb{"attach", "Take over a SUMO that was started elsewhere, with a policy of Clearway",
         "clearway attach localhost:8813 --policy corridor --failure B10 --predictor graphsage",
         configure_attach},
    Verb{"equip", "Find out which signals to equip first for EVs, and what that is worth",
         "clearway equip city --budget 5 --out runs/equip-city", configure_equip},
    Verb{"links", "Record data for link prediction, train it, evaluate it",
         "clearway links evaluate --benchmark eval_v1 --quick", nullptr, links_parts},
    Verb{"scenario", "Copy, import or check a scenario, list its signals",
         "clearway scenario import monaco.osm.pbf --name monaco", nullptr, scenario_parts},
    Verb{"list", "List scenarios, conditions, failures, predictors, policies and settings",
         "clearway list --json", configure_list},
    Verb{"python", "Install the Python package: `import clearway`", "clearway python --venv ./venv",
         configure_python, python_parts},
    Verb{"doctor", "Check that this machine has what Clearway needs", "clearway doctor", configure_doctor},
};

const char* const purpose =
    "Clearway: how much time does an emergency vehicle gain in mixed traffic, from which measure,\n"
    "at what cost to everybody else, and how much of it survives when sensors fail?";

const char* const footer =
    "Example:\n  clearway study studies/parts.toml\n\n"
    "Results go to standard output, progress and messages to standard error. Units are SI unless an option\n"
    "says otherwise. Exit codes: 0 ok, 1 runs failed, 2 usage, 3 bad input, 4 environment, 5 incomplete,\n"
    "6 a comparison fell short, 7 conflicting results, 130 and 143 interrupted.\n"
    "`clearway VERB --help` describes a verb.";

Invocation invocation_of(int argument_count, const char* const* arguments) {
    std::vector<std::string> words(arguments, arguments + argument_count);
    words.front() = "clearway";
    return {core::shell_text(words), words};
}

std::string names_of(std::span<const Verb> verbs) {
    return core::listed(core::texts_of(verbs, &Verb::name));
}

/// `study status` for `status` and what is nearly that; a part is found without the word before it.
std::string meant(const std::string& word) {
    std::map<std::string, std::string> commands = {{"reproduce", "study studies/dissertation.toml"}};
    for (const Verb& verb : all_verbs) {
        commands.emplace(verb.name, verb.name);
        for (const Verb& part : verb.parts)
            commands.emplace(part.name, fmt::format("{} {}", verb.name, part.name));
    }
    const std::vector<std::string> names =
        core::texts_of(commands, [](const auto& entry) { return entry.first; });
    const std::string near = core::nearest(word, names);
    return near.empty() ? "" : commands.at(near);
}

/// What is wrong with the word behind a verb that takes a file or a part: it is no file and nearly a part.
std::optional<std::string> part_problem(const Verb& verb, const std::string& word) {
    const std::vector<std::string> names = core::texts_of(verb.parts, &Verb::name);
    const std::string near = core::nearest(word, names);
    std::error_code unknown;
    if (near.empty() || near == word || word.starts_with('-') || std::filesystem::exists(word, unknown))
        return std::nullopt;
    return fmt::format("`{0} {1}` is not a verb, and {1} is not a file. Did you mean '{0} {2}'?", verb.name,
                       word, near);
}

/// What to do instead of an option that other programs have.
std::string other_way(const std::string& message) {
    for (const char* const quiet : {"-q", "--quiet", "--silent"})
        if (message.find(fmt::format(": {} is not known", quiet)) != std::string::npos)
            return "Progress goes to standard error, which 2>/dev/null hides\n";
    if (message.starts_with("clearway study: --seeds ") ||
        message.starts_with("clearway study: --replications "))
        return "The key `replications` of the study file is the number of seeds: replications = 30\n";
    return "";
}

/// For a predictor or failure that stands alone, or is the second value of its option; empty for all else.
std::string lone_value(const CLI::App& command) {
    const auto presets = failures::failure_presets();
    for (const std::string& word : command.remaining()) {
        const char* option = nullptr;
        if (prediction::predictors().find(word) != nullptr) option = "predictor";
        if (core::contains(presets, word, &failures::FailurePreset::name)) option = "failure";
        if (option == nullptr) continue;
        const CLI::Option* const known = command.get_option_no_throw(fmt::format("--{}", option));
        if (known == nullptr) continue;
        if (known->count() == 0)
            return fmt::format("Values follow their option: did you mean '--{} {}'?", option, word);
        return fmt::format(
            "{} is a second {}, and a condition has one. A study file compares several, by the factor "
            "condition.{}",
            word, option, option);
    }
    return "";
}

/// The message for a command line that cannot be parsed, as the verb that was called states it.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App* deepest = &app;
    std::string name = "clearway";
    while (!deepest->get_subcommands().empty()) {
        deepest = deepest->get_subcommands().front();
        name += " " + deepest->get_name();
    }
    if (const std::string lone = lone_value(*deepest); !lone.empty())
        return fmt::format("{}: {}\n`{} --help` says more.\n", name, lone, name);
    const std::string message = core::usage_message(*deepest, name, error);
    return other_way(message) + message;
}

/// What is wrong with the words that should be a verb and, where it needs one, a part of it.
std::optional<std::string> verb_problem(int argument_count, const char* const* arguments) {
    std::span<const Verb> known = all_verbs;
    std::string before;
    for (int at = 1; at < argument_count; ++at) {
        const std::string word = arguments[at];
        if (word.starts_with('-')) return std::nullopt;
        const auto found =
            std::ranges::find(known, word, [](const Verb& verb) { return std::string(verb.name); });
        if (found == known.end()) {
            const std::string near = meant(word);
            return fmt::format("`{}{}` is not a verb{}", before, word,
                               near.empty() ? fmt::format("; verbs are {}", names_of(known))
                                            : fmt::format(". Did you mean '{}'?", near));
        }
        if (found->configure != nullptr)
            return at + 1 < argument_count ? part_problem(*found, arguments[at + 1]) : std::nullopt;
        known = found->parts;
        before = word + " ";
    }
    return fmt::format("which verb? One of {}", names_of(known));
}

/// The required options of a verb with parts, which the parser must not ask for any more: to it, the name of
/// a part would be the value of a required argument.
std::vector<CLI::Option*> waived_options(CLI::App& command) {
    std::vector<CLI::Option*> waived;
    for (CLI::Option* const option : command.get_options()) {
        if (option->get_required()) waived.push_back(option);
        option->required(false);
    }
    return waived;
}

/// Declares the verbs on `app`. A verb that has parts and an action of its own asks for its arguments only
/// where no part is named.
void declare(CLI::App& app, std::span<const Verb> verbs, Action& action) {
    for (const Verb& verb : verbs) {
        CLI::App* const command = app.add_subcommand(verb.name, verb.summary);
        command->footer(fmt::format("Example:\n  {}", verb.example));
        declare(*command, verb.parts, action);
        if (verb.configure == nullptr) {
            command->require_subcommand(1);
            continue;
        }
        App options(*command);
        const Action own = verb.configure(options);
        const std::vector<CLI::Option*> required =
            verb.parts.empty() ? std::vector<CLI::Option*>{} : waived_options(*command);
        // The callbacks of parts come first.
        command->callback([&action, own, required] {
            if (action) return;
            for (const CLI::Option* const option : required)
                if (option->count() == 0) throw CLI::RequiredError(option->get_name());
            action = own;
        });
    }
}

void declare(CLI::App& app, Action& action) {
    app.name("clearway");
    app.footer(footer);
    app.set_version_flag("-V,--version",
                         fmt::format("clearway " CLEARWAY_VERSION "\nbuild {}", core::build_stamp()));
    app.formatter(std::make_shared<core::HelpFormatter>());
    app.require_subcommand(1);
    declare(app, all_verbs, action);
}

/// `help run` is `run --help`; `version` and `run --version` are `--version`.
std::vector<const char*> meant_arguments(std::vector<const char*> words) {
    const auto is = [&](std::size_t at, std::string_view word) {
        return words.size() > at && words[at] == word;
    };
    if (is(1, "help")) {
        words.erase(words.begin() + 1);
        words.push_back("--help");
    }
    const auto asks = [](std::string_view word) { return word == "--version"; };
    if (is(1, "version") || std::ranges::any_of(words, asks)) return {words.front(), "--version"};
    return words;
}

}  // namespace

std::span<const Verb> verbs() {
    return all_verbs;
}

int run_command_line(int argument_count, const char* const* arguments) {
    const std::vector<const char*> meant = meant_arguments({arguments, arguments + argument_count});
    argument_count = static_cast<int>(meant.size());
    arguments = meant.data();
    // Line buffering for pipes too, so that messages on standard error never land within a line of output.
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    const int usage = static_cast<int>(core::ExitCode::usage);
    if (const std::optional<std::string> problem = verb_problem(argument_count, arguments)) {
        fmt::print(stderr, "clearway: {}\n`clearway --help` describes them.\n", *problem);
        return usage;
    }
    CLI::App app(purpose);
    Action action;
    declare(app, action);
    try {
        app.parse(argument_count, arguments);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "{}", usage_message(app, error));
        return usage;
    }
    const Invocation invocation = invocation_of(argument_count, arguments);
    return static_cast<int>(core::end_of("clearway", [&] { return action(invocation); }));
}

}  // namespace clearway::cli
