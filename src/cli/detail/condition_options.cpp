#include "cli/detail/condition_options.hpp"

#include <set>

#include <fmt/format.h>

#include "core/error.hpp"
#include "experiment/settings.hpp"

namespace clearway::cli {

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
    app.add_option("--model", model, "Model file of a learned predictor")
        ->option_text("FILE [" + usual + "]")
        ->group(group);
}

std::pair<std::string, std::string> assignment(const std::string& option, const std::string& words) {
    const std::size_t equals = words.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == words.size())
        throw core::InputError({option, fmt::format("`{}` is not an assignment", words), "NAME=VALUE", ""});
    return {words.substr(0, equals), words.substr(equals + 1)};
}

void apply_settings(const std::vector<std::string>& settings, const std::string& model,
                    experiment::ConditionSpec& condition) {
    std::vector<core::Problem> problems;
    std::set<std::string> seen;
    for (const std::string& words : settings) {
        const auto [name, value] = assignment("--set", words);
        const std::vector<core::Problem> found = experiment::check_setting(name, value, "--set ");
        problems.insert(problems.end(), found.begin(), found.end());
        if (!seen.insert(name).second)
            problems.push_back({"--set " + name, "is given twice", "each setting once", "Remove one"});
        experiment::set(condition, name, value);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    if (!model.empty()) experiment::set_model(condition, model, "--model");
}

experiment::ConditionSpec condition_of(const DescribedCondition& described) {
    experiment::ConditionSpec condition = described.condition;
    if (condition.policies == std::vector<std::string>{"none"}) condition.policies.clear();
    apply_settings(described.settings, described.model, condition);
    return condition;
}

}  // namespace clearway::cli
