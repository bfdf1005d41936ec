#include "report/detail/condition_titles.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/condition_difference.hpp"
#include "experiment/code_parts.hpp"
#include "prediction/predictor.hpp"

namespace clearway::report::detail {
namespace {

constexpr const char* policy_factor = "condition.policy";

/// The dissertation's names for its conditions, and Clearway's names for the controls. A condition that
/// repairs the graph is named after its predictor.
std::string built_in_title(const std::string& name, const experiment::ConditionSpec& condition) {
    static const std::map<std::string, std::string> titles = {
        {"baseline", "Baseline"},
        {"graph_simulation", "Graph made by simulation attributes"},
        {"solo", "Alone on the road, signals open"},
    };
    if (const auto found = titles.find(name); found != titles.end()) return found->second;
    const std::string repair =
        prediction::title_of(condition.predictor) + (condition.model_file.empty() ? "" : ", other weights");
    if (name.starts_with("graph_graphsage") && !condition.factors.contains("condition.predictor"))
        return repair;
    if (name == "b10_no_repair" || name == "b10_dead_reckoning") return "Same failures, " + repair;
    return name;
}

/// The name that the study file gave: what follows `+` was added by factors.
std::string name_before_factors(const experiment::ConditionSpec& condition) {
    return condition.factors.empty() ? condition.name : condition.name.substr(0, condition.name.find('+'));
}

/// `preempt_signals.lead_s`, `4` -> `lead 4 s`.
std::string setting_text(const std::string& setting, const std::string& value) {
    static const std::map<std::string, const char*> units = {
        {"s", " s"}, {"m", " m"}, {"mps", " m/s"}, {"mps2", " m/s^2"}, {"hz", " Hz"}};
    std::string name = setting.substr(setting.rfind('.') + 1);
    const std::size_t end = name.rfind('_');
    const auto unit = end == std::string::npos ? units.end() : units.find(name.substr(end + 1));
    if (unit != units.end()) name.resize(end);
    std::ranges::replace(name, '_', ' ');
    return fmt::format("{} {}{}", name, value, unit == units.end() ? "" : unit->second);
}

}  // namespace

void ConditionTitles::give(std::vector<ConditionFacts>& conditions) const {
    std::set<std::string> bases;
    for (const ConditionFacts& condition : conditions) {
        if (condition.condition.factors.contains(policy_factor))
            bases.insert(name_before_factors(condition.condition));
    }
    std::map<std::string, int> uses;
    for (ConditionFacts& condition : conditions) {
        condition.title = of(condition.condition, bases.size() > 1 ? Bases::several : Bases::one);
        condition.base_title = base_of(condition.condition);
        condition.aspects = aspects_of(condition.condition);
        for (const auto& [factor, value] : condition.condition.factors) {
            const auto own = given_.find(value);
            if (own != given_.end() && factor.starts_with("condition."))
                condition.factor_titles[factor] = own->second;
            else if (const auto part = experiment::part_called(value))
                condition.factor_titles[factor] = *part;
        }
        ++uses[condition.title];
    }
    for (ConditionFacts& condition : conditions) {
        if (uses[condition.title] > 1) condition.title = condition.name();
    }
}

std::string ConditionTitles::of(const experiment::ConditionSpec& condition, Bases bases) const {
    if (const auto own = given_.find(condition.name); own != given_.end()) return own->second;
    const bool has_policy = condition.factors.contains(policy_factor);
    std::string title = has_policy ? policy_text(condition) : base_of(condition);
    if (has_policy && bases == Bases::several) title += ", " + base_of(condition);
    for (const auto& [factor, value] : condition.factors) {
        if (factor != policy_factor) title += ", " + value_text(factor, value);
    }
    return title;
}

std::string ConditionTitles::base_of(const experiment::ConditionSpec& condition) const {
    const std::string name = name_before_factors(condition);
    const auto own = given_.find(name);
    return own == given_.end() ? built_in_title(name, condition) : own->second;
}

std::string ConditionTitles::policy_text(const experiment::ConditionSpec& condition) const {
    if (const auto policy = condition.factors.find(policy_factor); policy != condition.factors.end()) {
        if (const auto own = given_.find(policy->second); own != given_.end()) return own->second;
    } else if (!condition.factors.empty()) {
        const auto own = given_.find(name_before_factors(condition));
        if (own != given_.end()) return own->second;
    }
    std::vector<std::string> words;
    for (const std::string& word : condition.policies)
        words.push_back(experiment::part_called(word).value_or(word));
    return words.empty() ? "no policy" : fmt::format("{}", fmt::join(words, " + "));
}

core::Settings ConditionTitles::aspects_of(const experiment::ConditionSpec& condition) const {
    core::Settings aspects;
    for (const auto& [name, value] : analysis::values_of(condition)) {
        const bool is_word = name == "failure" || name == "predictor";
        aspects[name] = is_word ? value_text("condition." + name, value) : setting_text(name, value);
    }
    for (const auto& [factor, value] : condition.factors) {
        if (factor.starts_with("failure.")) aspects["failure"].clear();  // the factor says it
    }
    for (const auto& [factor, value] : condition.factors)
        aspects[factor.starts_with("condition.") ? factor.substr(10) : factor] = value_text(factor, value);
    aspects["policy"] = policy_text(condition);
    return aspects;
}

std::string ConditionTitles::value_text(const std::string& factor, const std::string& value) const {
    const bool is_word = factor == "condition.failure" || factor == "condition.predictor";
    if (factor.starts_with("condition.")) {
        if (const auto own = given_.find(value); own != given_.end()) return own->second;
    }
    if (!is_word) return setting_text(factor, value);
    if (factor == "condition.predictor") return prediction::title_of(value);
    return value == "perfect" ? "perfect sensors" : value;
}

}  // namespace clearway::report::detail
