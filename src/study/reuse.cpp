#include "study/reuse.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/plain_files.hpp"
#include "study/folder_lock.hpp"

namespace clearway::study {
namespace {

using Conditions = std::vector<experiment::ConditionSpec>;

/// Names of our conditions that both studies have, with those of theirs: the same name if it is one of them.
core::Settings shared(const Conditions& ours, const Conditions& theirs) {
    core::Settings names;
    for (const experiment::ConditionSpec& condition : ours) {
        for (const experiment::ConditionSpec& other : theirs) {
            experiment::ConditionSpec renamed = other;
            renamed.name = condition.name;
            if (renamed != condition) continue;
            if (other.name == condition.name) names[condition.name] = other.name;
            names.try_emplace(condition.name, other.name);
        }
    }
    return names;
}

void require_comparable(const results::Manifest& ours, const results::Manifest& theirs,
                        const std::string& from) {
    std::vector<core::Problem> problems;
    const auto require = [&](const char* what, const std::string& held, const std::string& wanted) {
        if (held != wanted)
            problems.push_back({from, fmt::format("has the {} {}", what, held), wanted,
                                "Leave --reuse out: no run there is one of this study"});
    };
    require("seed", std::to_string(theirs.study_seed), std::to_string(ours.study_seed));
    require("build of Clearway", theirs.clearway_build, ours.clearway_build);
    require("version of SUMO", theirs.sumo_version, ours.sumo_version);
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

}  // namespace

std::map<experiment::RunKey, std::string> reusable_runs(const results::Manifest& study,
                                                        const results::Store& source) {
    const results::Manifest& theirs = source.manifest();
    const std::string from = source.folder().string();
    require_comparable(study, theirs, from);
    std::vector<results::ScenarioEntry> scenarios = study.scenarios;
    std::erase_if(scenarios, [&](const results::ScenarioEntry& scenario) {
        return !core::contains(theirs.scenarios, scenario);
    });
    const core::Settings conditions = shared(study.conditions, theirs.conditions);
    for (const auto& [none, what] :
         {std::pair(scenarios.empty(), "scenario"), std::pair(conditions.empty(), "condition")})
        if (none)
            throw core::InputError({from, fmt::format("has no {} of this study", what),
                                    "the run folder of a study that shares some",
                                    "Leave --reuse out, or name another folder"});
    std::map<experiment::RunKey, std::string> runs;
    for (const results::ScenarioEntry& scenario : scenarios)
        for (const auto& [condition, there] : conditions)
            for (std::uint32_t at = 0; at < std::min(study.replications, theirs.replications); ++at)
                if (source.complete({scenario.name, there, at})) runs[{scenario.name, condition, at}] = there;
    return runs;
}

Reused reuse(const results::Store& store, const std::filesystem::path& from) {
    core::require_plain_files(from);
    const results::Store source = results::Store::open(from);
    const results::Manifest& theirs = source.manifest();
    const std::map<experiment::RunKey, std::string> runs = reusable_runs(store.manifest(), source);
    const core::Settings conditions = shared(store.manifest().conditions, theirs.conditions);
    Reused result;
    for (const experiment::ConditionSpec& condition : store.manifest().conditions) {
        const std::string& name = condition.name;
        if (const auto same = conditions.find(name); same != conditions.end()) {
            if (same->second != name)
                result.renamed.push_back(fmt::format("{} ({} there)", name, same->second));
        } else if (core::contains(theirs.conditions, name, &experiment::ConditionSpec::name)) {
            result.other_conditions.push_back(name);
        }
    }
    const FolderLock lock(store.folder());
    std::vector<experiment::RunKey> adopted;
    for (const auto& [key, condition_there] : runs) {
        if (store.complete(key)) continue;
        try {
            store.adopt(source, key, condition_there);
            adopted.push_back(key);
        } catch (const core::InputError& error) {
            result.damaged.push_back(fmt::format("{}. It is left out", error.what()));
        }
    }
    store.flush(adopted);
    result.runs = adopted.size();
    return result;
}

}  // namespace clearway::study
