#include "experiment/condition_titles.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiment/code_parts.hpp"
#include "prediction/predictor.hpp"

namespace clearway::experiment {
namespace {

constexpr const char* policy_factor = "condition.policy";

/// The dissertation's names for its conditions, and Clearway's names for the controls. A condition that
/// repairs the graph is named after its predictor.
std::string built_in_title(const std::string& name, const ConditionSpec& condition) {
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

}  // namespace

std::string name_before_factors(const ConditionSpec& condition) {
    return condition.factors.empty() ? condition.name : condition.name.substr(0, condition.name.find('+'));
}

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

core::Settings ConditionTitles::of(const std::vector<ConditionSpec>& conditions) const {
    std::set<std::string> bases;
    for (const ConditionSpec& condition : conditions) {
        if (condition.factors.contains(policy_factor)) bases.insert(name_before_factors(condition));
    }
    core::Settings titles;
    std::map<std::string, int> uses;
    for (const ConditionSpec& condition : conditions)
        ++uses[titles[condition.name] = one(condition, bases.size() > 1 ? Bases::several : Bases::one)];
    for (auto& [name, title] : titles) {
        if (uses[title] > 1) title = name;
    }
    return titles;
}

std::string ConditionTitles::one(const ConditionSpec& condition, Bases bases) const {
    if (const auto own = given_.find(condition.name); own != given_.end()) return own->second;
    const bool has_policy = condition.factors.contains(policy_factor);
    std::string title = has_policy ? policy_text(condition) : base_of(condition);
    if (has_policy && bases == Bases::several) title += ", " + base_of(condition);
    for (const auto& [factor, value] : condition.factors) {
        if (factor != policy_factor) title += ", " + value_text(factor, value);
    }
    return title;
}

std::string ConditionTitles::base_of(const ConditionSpec& condition) const {
    const std::string name = name_before_factors(condition);
    const auto own = given_.find(name);
    return own == given_.end() ? built_in_title(name, condition) : own->second;
}

std::string ConditionTitles::policy_text(const ConditionSpec& condition) const {
    if (const auto policy = condition.factors.find(policy_factor); policy != condition.factors.end()) {
        if (const auto own = given_.find(policy->second); own != given_.end()) return own->second;
    } else if (!condition.factors.empty()) {
        const auto own = given_.find(name_before_factors(condition));
        if (own != given_.end()) return own->second;
    }
    std::vector<std::string> words;
    for (const std::string& word : condition.policies)
        words.push_back(part_called(word).value_or(word));
    return words.empty() ? "no policy" : fmt::format("{}", fmt::join(words, " + "));
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

}  // namespace clearway::experiment
