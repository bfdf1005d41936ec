#include "results/factor_columns.hpp"

#include <cmath>

namespace clearway::results {
namespace {

/// The value of a factor in the settings of an entry; nullptr if either is missing.
const std::string* find(const std::map<std::string, core::Settings>& entries, const std::string& entry,
                        const std::string& factor) {
    const auto settings = entries.find(entry);
    if (settings == entries.end()) return nullptr;
    const auto value = settings->second.find(factor);
    return value == settings->second.end() ? nullptr : &value->second;
}

}  // namespace

FactorColumns::FactorColumns(const Manifest& manifest) {
    std::set<std::string> names;
    const auto add = [&](const auto& entries, std::map<std::string, core::Settings>& target) {
        for (const auto& entry : entries) {
            if (entry.factors.empty()) continue;
            target[entry.name] = entry.factors;
            for (const auto& [name, value] : entry.factors) {
                names.insert(name);
                const auto number = core::number_from(value);
                if (!number || !std::isfinite(*number)) texts_.insert(name);
            }
        }
    };
    add(manifest.scenarios, of_scenarios_);
    add(manifest.conditions, of_conditions_);
    names_.assign(names.begin(), names.end());
}

std::vector<std::string> FactorColumns::values(const std::string& scenario,
                                               const std::string& condition) const {
    std::vector<std::string> values;
    for (const std::string& name : names_) {
        const std::string* value = find(of_conditions_, condition, name);
        if (value == nullptr) value = find(of_scenarios_, scenario, name);
        values.push_back(value == nullptr ? std::string() : *value);
    }
    return values;
}

core::Settings FactorColumns::settings(const std::string& scenario, const std::string& condition) const {
    core::Settings settings;
    const std::vector<std::string> all = values(scenario, condition);
    for (std::size_t column = 0; column < all.size(); ++column) {
        if (!all[column].empty()) settings[names_[column]] = all[column];
    }
    return settings;
}

}  // namespace clearway::results
