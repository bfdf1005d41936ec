#include "study/reuse.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/plain_files.hpp"
#include "study/folder_lock.hpp"

namespace clearway::study {
namespace {

/// Names of the elements that both studies have in the same words.
template <class Element>
std::set<std::string> shared(const std::vector<Element>& ours, const std::vector<Element>& theirs) {
    std::set<std::string> names;
    for (const Element& element : ours)
        if (std::ranges::find(theirs, element) != theirs.end()) names.insert(element.name);
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

std::vector<experiment::RunKey> reusable_runs(const results::Manifest& study, const results::Store& source) {
    const results::Manifest& theirs = source.manifest();
    const std::string from = source.folder().string();
    require_comparable(study, theirs, from);
    const std::set<std::string> scenarios = shared(study.scenarios, theirs.scenarios);
    const std::set<std::string> conditions = shared(study.conditions, theirs.conditions);
    for (const auto& [names, what] : {std::pair(&scenarios, "scenario"), std::pair(&conditions, "condition")})
        if (names->empty())
            throw core::InputError({from, fmt::format("has no {} of this study", what),
                                    "the run folder of a study that shares some",
                                    "Leave --reuse out, or name another folder"});
    std::vector<experiment::RunKey> runs = source.complete_runs();
    std::erase_if(runs, [&](const experiment::RunKey& key) {
        return !scenarios.contains(key.scenario) || !conditions.contains(key.condition) ||
               key.replication >= study.replications;
    });
    std::ranges::sort(runs);
    return runs;
}

Reused reuse(const results::Store& store, const std::filesystem::path& from) {
    core::require_plain_files(from);
    const results::Store source = results::Store::open(from);
    const results::Manifest& theirs = source.manifest();
    const std::vector<experiment::RunKey> runs = reusable_runs(store.manifest(), source);
    Reused result;
    for (const experiment::ConditionSpec& condition : store.manifest().conditions) {
        const auto named =
            std::ranges::find(theirs.conditions, condition.name, &experiment::ConditionSpec::name);
        if (named != theirs.conditions.end() && *named != condition)
            result.other_conditions.push_back(condition.name);
    }
    const FolderLock lock(store.folder());
    std::vector<experiment::RunKey> adopted;
    for (const experiment::RunKey& key : runs) {
        if (store.complete(key)) continue;
        try {
            store.adopt(source, key);
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
