#include "campaign/names.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "experiment/code_parts.hpp"
#include "experiment/settings.hpp"
#include "failures/failure_config.hpp"
#include "policy/policy.hpp"
#include "prediction/predictor.hpp"
#include "prediction/python_predictor.hpp"
#include "python/part_process.hpp"
#include "report/read_facts.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

core::Problem unknown_name(const std::string& where, const std::string& name,
                           const std::vector<std::string>& known, const std::string& listed_by) {
    constexpr std::size_t most_listed = 40;
    return {where, fmt::format("`{}` is unknown", name),
            known.size() > most_listed ? "" : core::listed(known),
            core::did_you_mean(name, known, fmt::format("`{}` describes them", listed_by))};
}

namespace {

/// A part of a condition that is none; a list and a class in Python may have been meant.
core::Problem unknown_part(const std::string& where, const std::string& name,
                           const std::vector<std::string>& known) {
    core::Problem problem = unknown_name(where, name, known);
    if (name.find(',') != std::string::npos)
        problem.cure = where.ends_with("predictor")
                           ? "A condition has one; a study file compares several, for instance by the factor "
                             "condition.predictor"
                           : "Separate several with spaces; in a study file they are a list";
    else if (name.find_first_of(":.") != std::string::npos)
        problem.cure = "A class in Python is FILE.py:CLASS";
    return problem;
}

using Levels = std::map<std::string, std::vector<std::string>>;

/// `condition.policy=corridor`.
std::string example_of(const Levels& levels) {
    return fmt::format("{}={}", levels.begin()->first, levels.begin()->second.front());
}

/// The levels of each factor that conditions have.
Levels levels_of(const std::vector<experiment::ConditionSpec>& conditions) {
    Levels levels;
    for (const experiment::ConditionSpec& condition : conditions) {
        for (const auto& [factor, level] : condition.factors) {
            std::vector<std::string>& known = levels[factor];
            if (!core::contains(known, level)) known.push_back(level);
        }
    }
    return levels;
}

}  // namespace

namespace {

constexpr std::string_view condition_prefix = "condition.";

Levels::const_iterator factor_named(const std::string& name, const Levels& levels) {
    return levels.contains(name) ? levels.find(name) : levels.find(std::string(condition_prefix) + name);
}

/// `policy=corridor,failure=B40,dark_share=0.5`: what follows a comma and is no factor belongs to the level
/// before.
std::vector<std::pair<std::string, std::string>> chosen_levels(const std::string& against,
                                                               const Levels& levels) {
    std::vector<std::pair<std::string, std::string>> chosen;
    std::istringstream words(against);
    for (std::string word; std::getline(words, word, ',');) {
        const std::size_t equals = std::min(word.find('='), word.size());
        const std::string factor = word.substr(0, equals);
        if (!chosen.empty() && factor_named(factor, levels) == levels.end())
            chosen.back().second += "," + word;
        else
            chosen.emplace_back(factor, word.substr(std::min(equals + 1, word.size())));
    }
    return chosen;
}

}  // namespace

namespace {

/// The level that `given` is, or else is the title of; null where there is none.
const std::string* level_of(const std::string& given, const std::vector<std::string>& known,
                            const core::Settings& titles) {
    auto found = std::ranges::find(known, given);
    if (found == known.end())
        found = std::ranges::find_if(known, [&](const std::string& level) {
            const auto title = titles.find(level);
            return title != titles.end() && title->second == given;
        });
    return found == known.end() ? nullptr : &*found;
}

}  // namespace

std::string condition_called(const std::string& word, const results::Store& store, const std::string& where) {
    const core::Settings titles = report::titles_of(store);
    if (word.empty() || titles.contains(word)) return word;
    const auto titled = std::ranges::find(titles, word, [](const auto& title) { return title.second; });
    if (titled != titles.end()) return titled->first;
    const auto shown = core::texts_of(titles, [](const auto& title) { return title.second; });
    const auto names = core::texts_of(titles, [](const auto& title) { return title.first; });
    core::Problem problem =
        unknown_name(where, word, shown, "clearway study status " + store.folder().string());
    if (!problem.allowed.empty()) problem.allowed = fmt::format("{}", fmt::join(shown, "; "));
    problem.cure = core::did_you_mean(word, names, problem.cure);
    throw core::InputError(std::move(problem));
}

analysis::Reference reference_from(const std::string& against,
                                   const std::vector<experiment::ConditionSpec>& conditions,
                                   const std::filesystem::path& folder) {
    if (against.empty()) return {};
    const char* const option = "--against";
    const std::vector<std::string> names = core::texts_of(conditions, &experiment::ConditionSpec::name);
    if (core::contains(names, against)) return {.name = against};
    const results::Store store = results::Store::open(folder);
    const core::Settings titles = report::titles_of(store);
    const auto titled = std::ranges::find(titles, against, [](const auto& title) { return title.second; });
    if (titled != titles.end()) return {.name = titled->first};
    if (against == "best") return {.chosen = analysis::Reference::Chosen::best};
    const Levels levels = levels_of(conditions);
    if (levels.empty() || against.find('=') == std::string::npos || against.find('+') != std::string::npos) {
        core::Problem problem =
            unknown_name(option, against, names, "clearway study status " + folder.string());
        problem.allowed += "; or best, each with the best of the others";
        if (!levels.empty()) problem.allowed += "; or a factor and its level, as " + example_of(levels);
        if (core::nearest(against, names).empty()) {
            const auto shown = core::texts_of(titles, [](const auto& title) { return title.second; });
            problem.cure = core::did_you_mean(against, shown, problem.cure);
        }
        throw core::InputError(std::move(problem));
    }
    const core::Settings given_titles = report::given_titles_of(store);
    analysis::Reference reference;
    for (const auto& [factor, level] : chosen_levels(against, levels)) {
        const auto found = factor_named(factor, levels);
        if (found == levels.end()) {
            const bool is_whole = factor.starts_with(condition_prefix);
            std::vector<std::string> factors;
            for (const auto& [name, known] : levels)
                factors.push_back(!is_whole && name.starts_with(condition_prefix)
                                      ? name.substr(condition_prefix.size())
                                      : name);
            throw core::InputError(unknown_name(fmt::format("{}: factor", option), factor, factors));
        }
        const std::string* const meant = level_of(level, found->second, given_titles);
        if (meant == nullptr)
            throw core::InputError(
                unknown_name(fmt::format("{}: level of {}", option, found->first), level, found->second));
        reference.levels[found->first] = *meant;
    }
    return reference;
}

std::vector<std::string> failure_names() {
    return core::texts_of(failures::failure_presets(), &failures::FailurePreset::name);
}

void check_failure(const std::string& where, const std::string& failure,
                   std::vector<core::Problem>& problems) {
    if (failure.find_first_of("=,") == std::string::npos) {
        const std::vector<std::string> known = failure_names();
        if (!core::contains(known, failure)) problems.push_back(unknown_name(where, failure, known));
        return;
    }
    try {
        failures::failure_from(failure);
    } catch (const core::InputError& error) {
        for (core::Problem problem : error.problems()) {
            problem.where = fmt::format("{} `{}`: {}", where, failure, problem.where);
            problems.push_back(std::move(problem));
        }
    }
}

namespace {

/// `condition linked: policy`, or `factors.condition.policy` where a factor gives it.
std::string place_of(const experiment::ConditionSpec& condition, const std::string& key) {
    const std::string factor = "condition." + key;
    return condition.factors.contains(factor) ? "factors." + factor
                                              : fmt::format("condition {}: {}", condition.name, key);
}

/// Settings, leases and tables know parts in Python by their classes, so those of a condition must differ.
void check_part_names(const experiment::ConditionSpec& condition, const std::string& where,
                      std::vector<core::Problem>& problems) {
    std::vector<std::string> names = experiment::part_names(condition);
    std::ranges::sort(names);
    if (const auto twice = std::ranges::adjacent_find(names); twice != names.end())
        problems.push_back({where + "parts", fmt::format("two are called `{}`", *twice),
                            "a name of its own for each", "Rename one of the classes"});
}

/// Loads each part in Python once, so that what its file cannot do is told before anything runs.
void check_parts(const std::vector<experiment::ConditionSpec>& conditions) {
    std::set<std::tuple<std::string, python::PartKind, core::Settings>> seen;
    const auto check = [&](const std::string& where, const std::string& word, python::PartKind kind,
                           const core::Settings& settings) {
        const auto name = python::part_name_from(word);
        if (name && seen.emplace(word, kind, settings).second)
            python::check_part(*name, kind, settings, where);
    };
    for (const experiment::ConditionSpec& condition : conditions) {
        check(place_of(condition, "predictor"), condition.predictor, python::PartKind::predictor,
              prediction::parted_settings(experiment::predictor_settings(condition)).own);
        for (const std::string& policy : condition.policies)
            check(place_of(condition, "policy"), policy, python::PartKind::policy,
                  core::settings_of(condition.settings, python::short_name(policy)));
    }
}

/// A policy that a condition names again, by itself or as a part of another.
std::optional<core::Problem> given_twice(const experiment::ConditionSpec& condition,
                                         const std::string& where) {
    constexpr const char* once = "each policy once";
    std::vector<std::string> sorted = condition.policies;
    std::ranges::sort(sorted);
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
        return core::Problem{where + "policy", fmt::format("`{}` is given twice", *twice), once,
                             "Remove one of the two"};
    for (const std::string& whole : sorted) {
        const policy::PolicyEntry* const known = policy::policies().find(whole);
        if (known == nullptr) continue;
        for (const std::string& part : known->components) {
            if (part != whole && std::ranges::binary_search(sorted, part))
                return core::Problem{
                    where + "policy", fmt::format("`{}` is a part of `{}` already", part, whole), once,
                    fmt::format("Remove {}; to compare the two, give each a condition of a study file",
                                part)};
        }
    }
    return std::nullopt;
}

}  // namespace

void check_names(const std::vector<experiment::ConditionSpec>& conditions) {
    std::vector<core::Problem> problems;
    const auto check = [&](const std::string& where, const std::string& name,
                           const std::vector<std::string>& known) {
        if (!python::part_name_from(name) && !core::contains(known, name)) {
            problems.push_back(unknown_part(where, name, known));
        }
    };
    for (const experiment::ConditionSpec& condition : conditions) {
        const std::string where = fmt::format("condition {}: ", condition.name);
        check_failure(place_of(condition, "failure"), condition.failure, problems);
        check(place_of(condition, "predictor"), condition.predictor, prediction::predictors().names());
        for (const std::string& policy : condition.policies) {
            check(place_of(condition, "policy"), policy, policy::policies().names());
        }
        if (const std::optional<core::Problem> twice = given_twice(condition, where))
            problems.push_back(*twice);
        else
            check_part_names(condition, where, problems);
        const std::vector<core::Problem> unfit = experiment::check_settings(condition, where);
        problems.insert(problems.end(), unfit.begin(), unfit.end());
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    check_parts(conditions);
}

}  // namespace clearway::campaign
