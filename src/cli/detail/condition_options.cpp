#include "cli/detail/condition_options.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "core/error.hpp"
#include "experiment/code_parts.hpp"
#include "experiment/settings.hpp"
#include "prediction/predictor.hpp"

namespace clearway::cli {
namespace {

using Conditions = std::vector<experiment::ConditionSpec>;

constexpr const char* option = "--model";

/// Predictors of the conditions, each once.
std::vector<std::string> predictors_of(const Conditions& conditions) {
    std::vector<std::string> names;
    for (const experiment::ConditionSpec& condition : conditions) {
        if (std::ranges::find(names, condition.predictor) == names.end())
            names.push_back(condition.predictor);
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

void add_condition_options(CLI::App& app, DescribedCondition& described, const std::string& usual_policy,
                           const std::string& group) {
    experiment::ConditionSpec& condition = described.condition;
    app.add_option("--policy", condition.policies,
                   "Policies, in this order; none: the car-following model alone")
        ->option_text("NAME ... [" + usual_policy + "]")
        ->group(group);
    app.add_option("--failure", condition.failure, "How sensors fail")
        ->option_text("NAME [perfect]")
        ->group(group);
    app.add_option("--predictor", condition.predictor, "How the graph is repaired")
        ->option_text("NAME [none]")
        ->group(group);
    add_setting_options(app, described.settings, described.model, "as shipped", group);
    add_switch(app, "--safety-checks", condition.safety_checks,
               "SUMO's own checks of commanded speeds and lane changes")
        ->option_text("on|off [on]")
        ->group(group);
}

void add_setting_options(CLI::App& app, std::vector<std::string>& settings, std::string& model,
                         const std::string& usual, const std::string& group) {
    app.add_option("--set", settings, "A setting of the condition (clearway list settings); can be repeated")
        ->option_text("COMPONENT.NAME=VALUE ... [defaults]")
        ->group(group);
    app.add_option(option, model,
                   "Net of a learned predictor: a file of clearway links train or of torch.save")
        ->check([](const std::string& file) { return file.empty() ? "is empty" : ""; })
        ->option_text("FILE [" + usual + "]")
        ->group(group);
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
        const bool is_named = word.size() < words.size() && std::ranges::find(known, word) != known.end();
        const std::string file = is_named ? words.substr(word.size() + 1) : words;
        if (!std::filesystem::is_regular_file(file))
            throw core::InputError({option, fmt::format("{} is not a file", file),
                                    "a file of clearway links train or of torch.save", ""});
        if (learned.empty() || (is_named && std::ranges::find(learned, word) == learned.end()))
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
