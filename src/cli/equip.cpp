#include "campaign/equip.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/equipment.hpp"
#include "campaign/study_run.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/process.hpp"
#include "experiment/conditions.hpp"
#include "experiment/equipped_signals.hpp"
#include "report/locks.hpp"

namespace clearway::cli {
namespace {

constexpr std::size_t most_signals = 10000;

struct EquipArguments {
    Mode mode = Mode::run;
    std::string scenario;
    ConditionWords conditions;
    scenario::Options options;
    campaign::EquipRequest request;
};

/// Whether a word is this option, or this option with its value behind `=`.
bool is_option(const std::string& word, const std::string& name) {
    return word == name || word.starts_with(name + "=");
}

/// `x` of `--option=x`; empty where the value is a word of its own.
std::string value_behind(const std::string& word) {
    const std::size_t equals = word.find('=');
    return equals == std::string::npos ? "" : word.substr(equals + 1);
}

/// The command, in a folder of its own where it names one: the other holds another search.
std::vector<std::string> moved(const std::vector<std::string>& command, const campaign::EquipRequest& request,
                               const std::string& ending) {
    if (request.run.folder.empty()) return command;
    return core::with_option(command, "--out", request.run.folder.string() + ending);
}

/// The command as one of `clearway run`: without what only equip takes, seeds, where it writes, its name and
/// what was equipped. The scenario comes first, so that no option of several values takes it.
std::vector<std::string> study_words(const std::vector<std::string>& command, const std::string& scenario) {
    const std::vector<std::string> with_value = {"--budget", "--candidates", "--seeds", "--seed",
                                                 "--within", "--out",        "--name"};
    const std::vector<std::string> flags = {"--thorough", "--dry-run", "--json"};
    const std::string equipped = std::string(experiment::equipped_setting) + "=";
    std::vector<std::string> words = {command.front(), "run", scenario};
    bool has_condition = false;
    bool has_scenario = false;
    bool is_in_settings = false;
    for (std::size_t at = 2; at < command.size(); ++at) {
        const std::string& word = command[at];
        const auto is_word = [&](const std::string& name) { return is_option(word, name); };
        const bool begins_settings = is_word("--set");
        is_in_settings = begins_settings || (is_in_settings && !word.starts_with('-'));
        if (!has_scenario && word == scenario) {
            has_scenario = true;
        } else if (std::ranges::any_of(with_value, is_word)) {
            if (word.find('=') == std::string::npos) ++at;
        } else if (is_in_settings) {
            const std::string setting = begins_settings ? value_behind(word) : word;
            if (!setting.empty() && !setting.starts_with(equipped))
                words.insert(words.end(), {"--set", setting});
        } else if (std::ranges::none_of(flags, is_word)) {
            has_condition = has_condition || is_word("--condition") || is_word("--policy");
            words.push_back(word);
        }
    }
    if (!has_condition) words.insert(words.end(), {"--condition", experiment::usual_condition});
    words.insert(words.end(), {"--name", "chosen"});
    return words;
}

void add_study_options(App& app, const std::shared_ptr<EquipArguments>& arguments) {
    campaign::EquipRequest& request = arguments->request;
    app.add_option("--budget", request.budget,
                   "How many signals to equip. Gains count from none equipped, where the "
                   "policy's other parts, such as clear_lane, work all the same; for signals alone in "
                   "today's traffic: --policy preempt_signals --av-share 0")
        .required()
        .range(std::size_t{1}, most_signals)
        .option_text(fmt::format("N, 1 to {} (required)", most_signals));
    add_condition_words(app, arguments->conditions);
    app.add_option("--candidates", request.most_candidates,
                   "Try only the N signals at whose red EVs wait longest, by the programs")
        .range(std::size_t{1}, most_signals)
        .option_text(fmt::format("N, 1 to {} [all that EVs pass]", most_signals));
    app.add_flag_callback(
        "--thorough", [&request] { request.search = analysis::Search::thorough; },
        "Race all signals for every place [for later places those that could still be the best]");
    app.add_flag_callback(
        "--dry-run", [arguments] { arguments->mode = Mode::dry_run; },
        "Print numbers of runs and estimated time, and run nothing [off]");
    const Option seeds =
        app.add_option("--seeds", request.replications,
                       "Replications that decide, and fresh ones that estimate; all sets share their demand")
            .range(2U, analysis::most_equip_replications)
            .option_text(
                fmt::format("N, 2 to {} [{}]", analysis::most_equip_replications, request.replications));
    add_within_option(app, request.within_s).excludes(seeds);
    add_seed_option(app, request.seed);
    app.add_option("--out", request.run.folder,
                   "Folder of the result and of the runs; what was interrupted there is continued")
        .option_text("DIR [runs/equip-SCENARIO-xxxxxx, a hash of what is run]");
    add_jobs_option(app, request.run.workers);
    add_limit_options(app, request.run.limits);
    add_retry_option(app, request.run.retried);
    add_json_option(app, request.run.publish.printing, "the result");
}

}  // namespace

Action configure_equip(App& app) {
    const auto arguments = std::make_shared<EquipArguments>();
    arguments->request.replications = usual_seeds;
    add_scenario_argument(app, arguments->scenario);
    add_study_options(app, arguments);
    add_own_condition_options(app, arguments->conditions.own);
    add_scenario_options(app, arguments->options);
    app.set_everyday({"--budget", "--condition", "--policy", "--failure", "--seeds", "--within", "--density",
                      "--av-share", "--out", "--dry-run"});
    return [arguments](const Invocation& invocation) {
        campaign::EquipRequest& request = arguments->request;
        request.condition = shown_condition(chosen_conditions(arguments->conditions), "equip");
        request.scenario = scenario::load(arguments->scenario, arguments->options);
        request.run.command = invocation.command;
        request.density = arguments->options.number("density", 1.0);
        request.study = study_words(invocation.words, arguments->scenario);
        request.words = invocation.words;
        request.more_seeds = moved(invocation.words, request, "-more-seeds");
        const std::string density = report::less_density(request.density);
        request.calmer =
            core::with_option(moved(invocation.words, request, "-density-" + density), "--density", density);
        return arguments->mode == Mode::dry_run ? campaign::equip_dry_run(request) : campaign::equip(request);
    };
}

}  // namespace clearway::cli
