#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "analysis/detail/condition_summary.hpp"
#include "analysis/summary.hpp"
#include "core/counted.hpp"
#include "core/error.hpp"

namespace clearway::analysis {
namespace {

using experiment::ConditionSpec;

[[noreturn]] void refuse_pair(const std::string& what, const results::Results& first,
                              const results::Results& second) {
    throw core::InputError({first.manifest.study + " and " + second.manifest.study,
                            "cannot be paired: another " + what,
                            "two folders of the same scenarios, seed and conditions",
                            "Run both with the same --seed and scenario options"});
}

bool has_scenario(const results::Manifest& manifest, const std::string& name) {
    return core::contains(manifest.scenarios, name, &results::ScenarioEntry::name);
}

bool has_condition(const results::Manifest& manifest, const std::string& name) {
    return core::contains(manifest.conditions, name, &ConditionSpec::name);
}

/// Adds what `one` has and `other` does not have.
void add_only_in(const results::Manifest& one, const results::Manifest& other, const char* folder,
                 std::vector<Unpaired>& unpaired) {
    const std::string why = fmt::format("is only in the {} folder", folder);
    for (const results::ScenarioEntry& scenario : one.scenarios) {
        if (!has_scenario(other, scenario.name)) {
            unpaired.push_back({scenario.name, "", why});
            continue;
        }
        for (const ConditionSpec& condition : one.conditions) {
            if (!has_condition(other, condition.name))
                unpaired.push_back({scenario.name, condition.name, why});
        }
    }
}

}  // namespace

Summary compare_studies(const results::Results& first, const results::Results& second, double level,
                        std::optional<double> response_threshold_s) {
    Summary summary;
    summary.manifest = second.manifest;
    summary.level = level;
    const detail::Index first_index(first);
    const detail::Index second_index(second);
    detail::ResampleCache resamples(level);
    if (first.manifest.clearway_build != second.manifest.clearway_build)
        summary.builds.emplace(first.manifest.clearway_build, second.manifest.clearway_build);
    if (first.manifest.study_seed != second.manifest.study_seed) refuse_pair("seed", first, second);
    add_only_in(first.manifest, second.manifest, "first", summary.unpaired);
    add_only_in(second.manifest, first.manifest, "second", summary.unpaired);
    if (first.manifest.replications != second.manifest.replications)
        summary.unpaired.push_back({"", "",
                                    fmt::format("the first folder has {}, the second {}",
                                                core::counted(first.manifest.replications, "replication"),
                                                second.manifest.replications)});
    for (const ConditionSpec& condition : second.manifest.conditions) {
        const auto same = std::ranges::find(first.manifest.conditions, condition.name, &ConditionSpec::name);
        if (same == first.manifest.conditions.end()) continue;
        std::ranges::move(condition_differences(*same, condition), std::back_inserter(summary.differing));
    }
    for (const results::ScenarioEntry& entry : second.manifest.scenarios) {
        const auto same =
            std::ranges::find(first.manifest.scenarios, entry.name, &results::ScenarioEntry::name);
        if (same == first.manifest.scenarios.end()) continue;
        if (same->configuration_hash != entry.configuration_hash)
            refuse_pair("configuration of scenario " + entry.name, first, second);
        ScenarioSummary scenario{entry.name, entry.title, {}};
        const double threshold_s =
            detail::threshold_of(second_index, entry.name, second.manifest.conditions, response_threshold_s);
        for (const ConditionSpec& condition : second.manifest.conditions) {
            if (!has_condition(first.manifest, condition.name)) continue;
            const ConditionSummary before =
                detail::describe_condition(first_index, entry.name, condition, resamples);
            ConditionSummary& after = scenario.conditions.emplace_back(
                detail::describe_condition(second_index, entry.name, condition, resamples));
            after.baseline = condition.name;
            const detail::Runs runs = second_index.runs(entry.name, condition.name);
            const detail::Runs baseline_runs = first_index.runs(entry.name, condition.name);
            detail::compare_conditions(runs, baseline_runs, before, resamples, after);
            after.response = response_of(runs, baseline_runs, threshold_s, level);
            detail::add_unfinished(entry.name, before, " in the first folder", summary.unpaired);
            detail::add_unfinished(entry.name, after, " in the second folder", summary.unpaired);
        }
        detail::adjust(scenario);
        if (!scenario.conditions.empty()) summary.scenarios.push_back(std::move(scenario));
    }
    if (summary.scenarios.empty()) refuse_pair("set of scenarios and conditions", first, second);
    return summary;
}

}  // namespace clearway::analysis
