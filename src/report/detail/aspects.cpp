#include "report/detail/aspects.hpp"

#include "analysis/condition_difference.hpp"
#include "experiment/code_parts.hpp"

namespace clearway::report::detail {
namespace {

core::Settings aspects_of(const experiment::ConditionTitles& titles,
                          const experiment::ConditionSpec& condition) {
    core::Settings aspects;
    for (const auto& [name, value] : analysis::values_of(condition)) {
        const bool is_word = name == "failure" || name == "predictor";
        aspects[name] =
            is_word ? titles.value_text("condition." + name, value) : experiment::setting_text(name, value);
    }
    for (const auto& [factor, value] : condition.factors) {
        if (factor.starts_with("failure.")) aspects["failure"].clear();  // the factor says it
    }
    for (const auto& [factor, value] : condition.factors)
        aspects[factor.starts_with("condition.") ? factor.substr(10) : factor] =
            titles.value_text(factor, value);
    aspects["policy"] = titles.policy_text(condition);
    return aspects;
}

}  // namespace

void give_titles(const experiment::ConditionTitles& titles, std::vector<ConditionFacts>& conditions) {
    std::vector<experiment::ConditionSpec> specs;
    for (const ConditionFacts& condition : conditions)
        specs.push_back(condition.condition);
    const core::Settings words = titles.of(specs);
    for (ConditionFacts& condition : conditions) {
        condition.title = words.at(condition.name());
        condition.base_title = titles.base_of(condition.condition);
        condition.aspects = aspects_of(titles, condition.condition);
        for (const auto& [factor, value] : condition.condition.factors) {
            const auto own = titles.given().find(value);
            if (own != titles.given().end() && factor.starts_with("condition."))
                condition.factor_titles[factor] = own->second;
            else if (const auto part = experiment::part_called(value))
                condition.factor_titles[factor] = *part;
            else if (factor == "condition.failure" && value == experiment::ConditionSpec().failure)
                condition.factor_titles[factor] = titles.value_text(factor, value);
        }
    }
}

}  // namespace clearway::report::detail
