#include "cli/detail/chosen_conditions.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/error.hpp"
#include "experiment/conditions.hpp"
#include "experiment/settings.hpp"

namespace clearway::cli {
namespace {

/// Whether any option describes a condition of the user's own.
bool has_own_condition(const experiment::ConditionSpec& own) {
    experiment::ConditionSpec untouched;
    untouched.name = own.name;
    return own != untouched;
}

/// The condition that the options describe. Without --policy they change the one that is named with
/// --condition, or else the usual one; `--policy none` and device.bluelight mean the car-following model
/// alone. Throws core::InputError if they would change several.
experiment::ConditionSpec own_condition(const ConditionWords& words,
                                        const std::vector<experiment::ConditionSpec>& chosen) {
    DescribedCondition described = words.own;
    experiment::ConditionSpec& own = described.condition;
    const bool names_policies = !own.policies.empty();
    const bool changes = has_own_condition(condition_of(described));
    if (names_policies || !changes || own.bluelight == traffic::BlueLight::on) return condition_of(described);
    if (chosen.size() > 1) {
        std::vector<std::string> names;
        for (const experiment::ConditionSpec& condition : chosen)
            names.push_back(condition.name);
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
        if (own.name.empty()) own.name = experiment::described_name(own);
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
    std::vector<std::string> names;
    for (const experiment::ConditionSpec& condition : chosen)
        names.push_back(condition.name);
    throw core::InputError({what, fmt::format("cannot show {} at once", core::listed(names)), "one condition",
                            "Name one with --condition, or describe one of your own (--policy ...)"});
}

void add_condition_words(CLI::App& app, ConditionWords& words) {
    app.add_option("--condition", words.names,
                   "A built-in condition; can be repeated. A baseline is always added")
        ->option_text(
            fmt::format("NAME ... [{}, unless one of your own is described]", experiment::usual_condition));
}

void add_own_condition_options(CLI::App& app, DescribedCondition& described) {
    const char* const group = "A condition of your own (names: clearway list)";
    add_condition_options(app, described, experiment::usual_condition, group);
    experiment::ConditionSpec& own = described.condition;
    add_switch(app, "--bluelight", own.bluelight,
               "SUMO's device.bluelight on every emergency vehicle, for comparison")
        ->option_text("on|off [off]")
        ->group(group);
    static const std::map<std::string, experiment::TrafficModel> models = {
        {"standard", experiment::TrafficModel::standard}, {"sublane", experiment::TrafficModel::sublane}};
    app.add_option_function<std::string>(
           "--traffic-model", [&own](const std::string& name) { own.traffic_model = models.at(name); },
           "SUMO's lateral model; sublane adds a baseline of its own")
        ->check(CLI::IsMember(models))
        ->option_text("standard|sublane [standard]")
        ->group(group);
    app.add_option("--name", own.name, "Its name in tables and folders")
        ->option_text("NAME [after its content: corridor_B10_graphsage]")
        ->group(group);
}

}  // namespace clearway::cli
