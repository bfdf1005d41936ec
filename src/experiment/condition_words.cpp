#include "experiment/condition_words.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "experiment/settings.hpp"
#include "failures/failure_config.hpp"
#include "policy/policy.hpp"
#include "python/part_name.hpp"

namespace clearway::experiment {
std::string policy_words(const ConditionSpec& condition) {
    std::vector<std::string> words;
    for (const std::string& name : condition.policies) {
        const policy::PolicyEntry* const entry = policy::policies().find(name);
        if (entry == nullptr) return "";
        for (const std::string& part : entry->components) {
            std::string& summary = words.emplace_back(policy::policies().at(part).summary);
            summary.front() = static_cast<char>(std::tolower(summary.front()));
        }
    }
    return fmt::format("{}", fmt::join(words, "; "));
}

bool loses_no_request(const ConditionSpec& condition) {
    if (condition.failure == ConditionSpec().failure || condition.policies.empty()) return false;
    const failures::FailureConfig failure = failures::failure_from(condition.failure);
    return failure.dark_commands == failures::DarkCommands::received &&
           static_cast<const failures::RequestChannel&>(failure) == failures::RequestChannel{} &&
           static_cast<const failures::SignalRequestChannel&>(failure) == failures::SignalRequestChannel{};
}

std::string unsent_words(const ConditionSpec& condition) {
    const failures::FailureConfig failure = failures::failure_from(condition.failure);
    const std::vector<std::string> silent = policies_with(condition, traffic::Trait::asks_without_radio);
    const bool others_send = policies_with(condition, traffic::Trait::asks_signals).size() > silent.size() ||
                             std::ranges::any_of(condition.policies, [](const std::string& one) {
                                 return python::part_name_from(one).has_value();
                             });
    if (silent.empty() || others_send ||
        static_cast<const failures::SignalRequestChannel&>(failure) == failures::SignalRequestChannel{})
        return {};
    return fmt::format("{} {} no messages, so those that this failure loses stand for nothing",
                       core::listed(silent), silent.size() == 1 ? "sends" : "send");
}

std::string failure_words(const ConditionSpec& condition) {
    const auto& presets = failures::failure_presets();
    std::vector<std::string> words;
    std::istringstream items(condition.failure);
    for (std::string item; std::getline(items, item, ',');) {
        if (item == ConditionSpec().failure) continue;
        const auto preset = std::ranges::find(presets, item, &failures::FailurePreset::name);
        words.push_back(preset == presets.end() ? item : preset->summary);
    }
    return fmt::format("{}", fmt::join(words, "; "));
}

}  // namespace clearway::experiment
