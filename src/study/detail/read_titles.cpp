#include "study/detail/read_titles.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::study::detail {

// NOLINTNEXTLINE(readability-function-size): a table, what its keys may name, and what it fills
std::vector<core::Problem> read_titles(core::StrictTable& root,
                                       const std::vector<experiment::ConditionSpec>& untouched,
                                       const Factors& factors, Extent extent, StudyConfig& config) {
    const toml::table* const table = root.table("titles");
    auto reader = root.below("titles");
    if (!reader) return {};
    std::vector<core::Problem> unnamed;
    std::vector<std::string> known = core::texts_of(config.conditions, &experiment::ConditionSpec::name);
    for (const experiment::ConditionSpec& condition : untouched)
        known.push_back(condition.name);
    std::vector<std::string> given;
    for (const Factor& factor : factors.list) {
        for (const FactorValue& value : factor.values)
            if (factor.group == "condition") given.push_back(value.text);
    }
    known.insert(known.end(), given.begin(), given.end());
    std::ranges::sort(known);
    known.erase(std::unique(known.begin(), known.end()), known.end());
    for (const auto& [key, node] : *table) {
        const std::string name(key.str());
        reader->text(name, config.titles[name]);
        const bool left_out = extent == Extent::quick && name.find('+') != std::string::npos;
        if (left_out || core::contains(known, name)) continue;
        std::vector<core::Problem>& problems =
            core::contains(given, core::nearest(name, known)) ? config.doubtful_titles : unnamed;
        problems.push_back({reader->where(name), "is no condition, and no text that a factor gives one",
                            core::listed(known), core::did_you_mean(name, known)});
    }
    return unnamed;
}

void read_controls(core::StrictTable& root, const std::vector<experiment::ConditionSpec>& untouched,
                   StudyConfig& config) {
    const toml::table* const table = root.table("controls");
    auto reader = root.below("controls");
    if (!reader) return;
    const std::vector<std::string> known = core::texts_of(untouched, &experiment::ConditionSpec::name);
    const std::vector<std::string> made = core::texts_of(config.conditions, &experiment::ConditionSpec::name);
    for (const auto& [key, node] : *table) {
        const std::string control(key.str());
        std::string of;
        reader->text(control, of);
        for (const std::string& name : {control, of}) {
            if (!name.empty() && !core::contains(known, name))
                reader->problem(control, fmt::format("'{}' is not in the study", name), core::listed(known),
                                core::did_you_mean(name, known));
        }
        if (table->contains(of))
            reader->problem(control, fmt::format("'{}' is a control itself", of), "a condition that is none",
                            "");
        for (const std::string& name : made) {
            if (name != control && !name.starts_with(control + "+")) continue;
            const std::string same = of + name.substr(control.size());
            if (core::contains(made, same))
                config.controls[name] = same;
            else if (core::contains(made, of))
                config.controls[name] = of;
        }
    }
}

}  // namespace clearway::study::detail
