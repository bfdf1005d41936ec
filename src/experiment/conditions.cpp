#include "experiment/conditions.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.hpp"
#include "failures/failure_config.hpp"
#include "policy/policy.hpp"
#include "prediction/predictor.hpp"

namespace clearway::experiment {
namespace {

/// Bursty outages of 10 s on average, dark 30 % of the time: where repair matters most.
constexpr const char* usual_failure = "B10";
constexpr const char* dissertation_policy = "dissertation";

BuiltInCondition with_policy(const char* name, const char* failure, const char* predictor,
                             const char* summary) {
    ConditionSpec condition;
    condition.name = name;
    condition.failure = failure;
    condition.predictor = predictor;
    condition.policies = {dissertation_policy};
    return {summary, condition};
}

std::vector<BuiltInCondition> make_conditions() {
    ConditionSpec baseline;
    baseline.name = "baseline";
    ConditionSpec solo;
    solo.name = "solo";
    solo.traffic_model = TrafficModel::free_flow;
    ConditionSpec corridor;
    corridor.name = usual_condition;
    corridor.policies = {"corridor"};
    return {
        {"The car-following model alone (IDM), with which all others are compared", baseline},
        {"Signals preempted, the lane cleared and the crossing traffic recovered, with perfect sensing; "
         "`clearway run` compares it with the baseline",
         corridor},
        with_policy(
            "graph_simulation", "perfect", "none",
            "The dissertation's policy on the graph from simulation attributes, with perfect sensing"),
        with_policy(
            "graph_graphsage", usual_failure, "graphsage_corrected",
            "The dissertation's policy on the graph that GraphSAGE rebuilds under B10 failures: its net "
            "with corrected inputs"),
        with_policy("graph_graphsage_improved", usual_failure, "graphsage",
                    "The same with the improved net, `graphsage`"),
        with_policy("graph_graphsage_as_published", usual_failure, "graphsage_as_published",
                    "The same with the dissertation's net as published"),
        with_policy("b10_no_repair", usual_failure, "none", "Control: the same failures without repair"),
        with_policy("b10_dead_reckoning", usual_failure, "dead_reckoning",
                    "Control: the same failures repaired by dead reckoning"),
        {"Each emergency vehicle alone on the road, every signal open: the practical floor", solo},
    };
}

/// `--policy navigate`, or as a study file has it, for a part of a condition; empty for what is none.
std::string part_words(const std::string& name, bool on_command_line) {
    const auto words = [&](const char* option, const char* in_file) {
        return on_command_line ? fmt::format("--{} {}", option, name)
                               : fmt::format(fmt::runtime(in_file), name);
    };
    if (policy::policies().find(name) != nullptr)
        return words("policy",
                     "[[condition]] with policy = [\"{0}\"], in Python Condition(NAME, policy=\"{0}\")");
    if (prediction::predictors().find(name) != nullptr)
        return words("predictor",
                     "[[condition]] with predictor = \"{0}\", in Python Condition(NAME, predictor=\"{0}\")");
    const auto presets = failures::failure_presets();
    if (core::contains(presets, name, &failures::FailurePreset::name))
        return words("failure",
                     "[[condition]] with failure = \"{0}\", in Python Condition(NAME, failure=\"{0}\")");
    return "";
}

}  // namespace

const std::vector<BuiltInCondition>& built_in_conditions() {
    static const std::vector<BuiltInCondition> conditions = make_conditions();
    return conditions;
}

bool takes_built_in_name(const ConditionSpec& condition) {
    return std::ranges::any_of(built_in_conditions(), [&](const BuiltInCondition& known) {
        return known.condition.name == condition.name && known.condition != condition;
    });
}

ConditionSpec built_in_condition(const std::string& name, const std::string& where) {
    std::vector<std::string> names;
    for (const BuiltInCondition& known : built_in_conditions()) {
        if (known.condition.name == name) return known.condition;
        names.push_back(known.condition.name);
    }
    if (const std::string words = part_words(name, where == "--condition"); !words.empty())
        throw core::InputError({where, fmt::format("'{}' is a part of conditions, and no condition", name),
                                core::listed(names), "Use " + words});
    throw core::InputError(
        {where, fmt::format("'{}' is not a built-in condition", name), core::listed(names),
         core::did_you_mean(
             name, names,
             "Define it in [[condition]], in Python as Condition(NAME, policy=...), or use a known name")});
}

}  // namespace clearway::experiment
