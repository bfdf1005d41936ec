#include "cli/detail/condition_options.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "cli/detail/common_options.hpp"
#include "core/error.hpp"
#include "experiment/code_parts.hpp"
#include "experiment/conditions.hpp"
#include "experiment/settings.hpp"
#include "prediction/predictor.hpp"

namespace clearway::cli {
namespace {

/// Whether any option describes a condition of the user's own.
bool has_own_condition(const experiment::ConditionSpec& own) {
    experiment::ConditionSpec untouched;
    untouched.name = own.name;
    return own != untouched;
}

/// The condition that the options describe. Without --policy they change the one that is named with
/// --condition, or else the usual one; `--policy none` and devices of SUMO mean the car-following model
/// alone. Throws core::InputError if they would change several.
experiment::ConditionSpec own_condition(const ConditionWords& words,
                                        const std::vector<experiment::ConditionSpec>& chosen) {
    DescribedCondition described = words.own;
    experiment::ConditionSpec& own = described.condition;
    const bool names_policies = !own.policies.empty();
    const bool changes = has_own_condition(condition_of(described));
    if (names_policies || !changes || own.bluelight == traffic::BlueLight::on || own.rerouting_s > 0.0 ||
        own.dispatch != experiment::Dispatch::free_flow)
        return condition_of(described);
    if (chosen.size() > 1) {
        const std::vector<std::string> names = core::texts_of(chosen, &experiment::ConditionSpec::name);
        throw core::InputError(
            {"--condition",
             fmt::format("names {}, and the options change one condition", core::listed(names)),
             "one condition to change, or several as they are",
             "Leave one, or describe a condition of your own with --policy"});
    }
    const experiment::ConditionSpec base =
        chosen.empty() ? experiment::built_in_condition(experiment::usual_condition, "--condition")
                       : chosen.front();
    const experiment::ConditionSpec untouched;
    own.policies = base.policies;
    if (own.failure == untouched.failure) own.failure = base.failure;
    if (own.predictor == untouched.predictor) own.predictor = base.predictor;
    return condition_of(described);
}

using Conditions = std::vector<experiment::ConditionSpec>;

constexpr const char* option = "--model";

/// Predictors of the conditions, each once.
std::vector<std::string> predictors_of(const Conditions& conditions) {
    std::vector<std::string> names;
    for (const experiment::ConditionSpec& condition : conditions) {
        if (!core::contains(names, condition.predictor)) names.push_back(condition.predictor);
    }
    return names;
}

std::vector<std::string> learned_among(std::vector<std::string> names) {
    std::erase_if(names, [](const std::string& name) {
        return !prediction::predictors().is(name, traffic::Trait::learned);
    });
    return names;
}

/// The predictor among `names` that the model in `file` is of.
std::string predictor_of(const std::string& file, const std::vector<std::string>& names) {
    std::vector<std::string> fit;
    std::vector<core::Problem> problems;
    for (const std::string& name : names) {
        try {
            prediction::check_model(name, file);
            fit.push_back(name);
        } catch (const core::InputError& error) {
            for (core::Problem problem : error.problems()) {
                problem.where = fmt::format("{}: predictor {}: {}", option, name, problem.where);
                problems.push_back(std::move(problem));
            }
        }
    }
    if (fit.empty()) throw core::InputError(std::move(problems));
    if (fit.size() > 1)
        throw core::InputError({option, fmt::format("{} is a model of {}", file, core::listed(fit)),
                                "one predictor of the conditions",
                                fmt::format("Say which: --model {}={}", fit.front(), file)});
    return fit.front();
}

void give_model(const std::string& predictor, const std::string& file, Conditions& conditions) {
    std::vector<core::Problem> problems;
    for (experiment::ConditionSpec& condition : conditions) {
        if (condition.predictor != predictor) continue;
        if (condition.model_file.empty()) {
            experiment::set_model(condition, file, option);
        } else {
            problems.push_back(
                {option,
                 fmt::format("condition {} has the model {} already, {} is another", condition.name,
                             condition.model_file, file),
                 "one model per condition",
                 fmt::format("Remove one: in the study file at {}, or from the command", condition.name)});
        }
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

}  // namespace

void add_once(std::vector<experiment::ConditionSpec>& conditions,
              const experiment::ConditionSpec& condition) {
    const auto same_name = [&](const auto& other) { return other.name == condition.name; };
    if (std::ranges::none_of(conditions, same_name)) conditions.push_back(condition);
}

std::vector<experiment::ConditionSpec> chosen_conditions(const ConditionWords& words) {
    std::vector<experiment::ConditionSpec> chosen;
    for (const std::string& name : words.names) {
        add_once(chosen, experiment::built_in_condition(name, "--condition"));
    }
    experiment::ConditionSpec own = own_condition(words, chosen);
    if (has_own_condition(own)) {
        const bool is_named = !own.name.empty();
        if (!is_named) own.name = experiment::described_name(own);
        if (!is_named && experiment::takes_built_in_name(own))
            throw core::InputError({"--policy", fmt::format("`{}` is a condition and no policy", own.name),
                                    "",
                                    fmt::format("Say --condition {}; a baseline is always added", own.name)});
        if (experiment::takes_built_in_name(own))
            throw core::InputError(
                {"--name", fmt::format("`{}` is a built-in condition", own.name), "", "Choose another name"});
        add_once(chosen, own);
        return chosen;
    }
    if (!own.name.empty())
        throw core::InputError(
            {"--name",
             fmt::format("`{}` names no condition, because none of your own is described", own.name),
             "a name beside --policy, --failure, --predictor, --set or another option of a condition",
             "Describe a condition, or leave --name out"});
    if (!words.own.condition.policies.empty())
        add_once(chosen, experiment::built_in_condition("baseline", "--policy"));
    return chosen;
}

experiment::ConditionSpec shown_condition(const std::vector<experiment::ConditionSpec>& chosen,
                                          const std::string& what) {
    if (chosen.empty()) return experiment::built_in_condition(experiment::usual_condition, what);
    if (chosen.size() == 1) return chosen.front();
    const std::vector<std::string> names = core::texts_of(chosen, &experiment::ConditionSpec::name);
    throw core::InputError({what, fmt::format("cannot show {} at once", core::listed(names)), "one condition",
                            "Name one with --condition, or describe one of your own (--policy ...)"});
}

void add_condition_words(App& app, ConditionWords& words) {
    app.add_option("--condition", words.names,
                   "A built-in condition; can be repeated. A baseline is always added")
        .option_text(
            fmt::format("NAME ... [{}, unless one of your own is described]", experiment::usual_condition));
}

void add_own_condition_options(App& app, DescribedCondition& described) {
    const OptionGroup group(app, "A condition of your own (names: clearway list)");
    add_condition_options(app, described, experiment::usual_condition);
    experiment::ConditionSpec& own = described.condition;
    add_switch(app, "--bluelight", own.bluelight,
               "SUMO's device.bluelight on every emergency vehicle, for comparison")
        .option_text("on|off [off]");
    app.add_option("--rerouting", own.rerouting_s,
                   "SUMO's device.rerouting on every emergency vehicle, with this period and true times, for "
                   "comparison")
        .range(0.0, 3600.0)
        .option_text("S [0: none]");
    app.add_option("--rerouting-penalty", own.rerouting_signal_penalty,
                   "That device's penalty for signals (SUMO's weights.tls-penalty), in mean waits")
        .range(0.0, 100.0)
        .option_text("SHARE [0: none]");
    app.add_choice("--dispatch", own.dispatch, "Which station answers a call of the scenario")
        .option_text("free_flow|straight_line|believed|true_times [free_flow]");
    app.add_choice(
           "--traffic-model", own.traffic_model,
           {{"standard", experiment::TrafficModel::standard}, {"sublane", experiment::TrafficModel::sublane}},
           "SUMO's lateral model; sublane adds a baseline of its own")
        .option_text("standard|sublane [standard]");
    app.add_option("--name", own.name, "Its name in tables and folders")
        .option_text("NAME [after its content: corridor_B10_graphsage]");
}

void add_condition_options(App& app, DescribedCondition& described, const std::string& usual_policy) {
    experiment::ConditionSpec& condition = described.condition;
    app.add_option("--policy", condition.policies,
                   "Policies of one condition, in this order; none: the car-following model alone")
        .option_text("NAME ... [" + usual_policy + "]");
    app.add_option("--failure", condition.failure, "How sensors fail").option_text("NAME [perfect]");
    app.add_option("--predictor", condition.predictor, "How the graph is repaired")
        .option_text("NAME [none]");
    add_setting_options(app, described.settings, described.model, "as shipped");
    add_switch(app, "--safety-checks", condition.safety_checks,
               "SUMO's own checks of commanded speeds and lane changes")
        .option_text("on|off [on]");
}

void add_setting_options(App& app, std::vector<std::string>& settings, std::string& model,
                         const std::string& usual) {
    app.add_option("--set", settings, "A setting of the condition (clearway list settings); can be repeated")
        .option_text("COMPONENT.NAME=VALUE ... [defaults]");
    app.add_option(option, model,
                   "Net of a learned predictor: a file of clearway links train or of torch.save")
        .check([](const std::string& file) { return file.empty() ? "is empty" : ""; })
        .option_text("FILE [" + usual + "]");
}

std::pair<std::string, std::string> assignment(const std::string& option, const std::string& words,
                                               const std::string& form) {
    const std::size_t equals = words.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == words.size())
        throw core::InputError({option, fmt::format("`{}` is not an assignment", words), form, ""});
    return {words.substr(0, equals), words.substr(equals + 1)};
}

void apply_settings(const std::vector<std::string>& settings, const std::string& model,
                    experiment::ConditionSpec& condition) {
    std::vector<core::Problem> problems;
    std::set<std::string> seen;
    for (const std::string& words : settings) {
        const auto [name, value] = assignment("--set", words);
        const std::vector<core::Problem> found =
            experiment::check_setting(name, value, "--set ", experiment::part_names(condition));
        problems.insert(problems.end(), found.begin(), found.end());
        if (!seen.insert(name).second)
            problems.push_back({"--set " + name, "is given twice", "each setting once", "Remove one"});
        experiment::set(condition, name, value);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    if (!model.empty()) experiment::set_model(condition, model, option);
}

void apply_models(const std::vector<std::string>& models, Conditions& conditions) {
    const std::vector<std::string> present = predictors_of(conditions);
    const std::vector<std::string> learned = learned_among(present);
    for (const std::string& words : models) {
        // A file name may contain `=`: only the name of a predictor before it makes an assignment.
        const std::string word = words.substr(0, words.find('='));
        const std::vector<std::string> known = prediction::predictors().names(traffic::Trait::learned);
        const bool is_named = word.size() < words.size() && core::contains(known, word);
        const std::string file = is_named ? words.substr(word.size() + 1) : words;
        if (!std::filesystem::is_regular_file(file))
            throw core::InputError({option, fmt::format("{} is not a file", file),
                                    "a file of clearway links train or of torch.save", ""});
        if (learned.empty() || (is_named && !core::contains(learned, word)))
            throw core::InputError({option,
                                    is_named
                                        ? fmt::format("no condition has the predictor {}", word)
                                        : fmt::format("no condition has a predictor that takes a model ({})",
                                                      core::listed(present)),
                                    core::listed(learned.empty() ? known : learned),
                                    "Give a condition that predictor, in [[condition]] of the study file"});
        give_model(predictor_of(file, is_named ? std::vector<std::string>{word} : learned), file, conditions);
    }
}

experiment::ConditionSpec condition_of(const DescribedCondition& described) {
    experiment::ConditionSpec condition = described.condition;
    if (condition.policies == std::vector<std::string>{"none"}) condition.policies.clear();
    experiment::resolve_parts(condition, {}, "--");
    apply_settings(described.settings, described.model, condition);
    return condition;
}

}  // namespace clearway::cli
