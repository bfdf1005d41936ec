#include "experiment/policy_words.hpp"

#include <cctype>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "policy/policy.hpp"

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

}  // namespace clearway::experiment
