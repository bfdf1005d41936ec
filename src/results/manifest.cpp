#include "results/manifest.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/folder_name.hpp"
#include "core/json.hpp"
#include "experiment/condition_json.hpp"
#include "experiment/condition_titles.hpp"
#include "results/run_limit.hpp"

namespace clearway::results {
namespace {

core::Json to_object(const AnalysisPlan& plan) {
    core::Json object;
    object["metric"] = plan.metric;
    core::write_fields(object, plan);
    object["comparisons"] = core::Json::array();
    for (const PlannedComparison& comparison : plan.comparisons) {
        object["comparisons"].push_back({{"name", comparison.name},
                                         {"scenario", comparison.scenario},
                                         {"condition", comparison.condition},
                                         {"against", comparison.against},
                                         {"claim", name(comparison.claim)}});
    }
    return object;
}

AnalysisPlan plan_from(const core::Json& object, const std::string& where,
                       std::vector<core::Problem>& problems) {
    AnalysisPlan plan;
    core::ObjectReader reader(object, where, problems);
    reader.read("metric", plan.metric);
    reader.read_fields(plan);
    for (const core::Json& entry : reader.child("comparisons", core::Json::value_t::array)) {
        PlannedComparison& comparison = plan.comparisons.emplace_back();
        core::ObjectReader row(entry, where + ": comparisons", problems);
        row.read("name", comparison.name);
        row.read("scenario", comparison.scenario);
        row.read("condition", comparison.condition);
        row.read("against", comparison.against);
        row.read_name("claim", comparison.claim, core::value_from<Claim>);
    }
    return plan;
}

core::Json to_object(const Manifest& manifest) {
    core::Json object;
    object["format"] = manifest.format;
    object["study"] = manifest.study;
    object["clearway_version"] = manifest.clearway_version;
    object["clearway_build"] = manifest.clearway_build;
    object["sumo_version"] = manifest.sumo_version;
    object["study_seed"] = manifest.study_seed;
    object["replications"] = manifest.replications;
    object["scenarios"] = core::Json::array();
    for (const ScenarioEntry& scenario : manifest.scenarios) {
        core::Json entry;
        core::write_fields(entry, scenario);
        if (!scenario.factors.empty()) entry["factors"] = scenario.factors;
        if (!scenario.variant.empty()) entry["variant"] = scenario.variant;
        object["scenarios"].push_back(std::move(entry));
    }
    object["conditions"] = core::Json::array();
    for (const experiment::ConditionSpec& condition : manifest.conditions)
        object["conditions"].push_back(experiment::to_json(condition));
    if (manifest.precision) {
        object["precision"] = {{"metric", manifest.precision->metric},
                               {"half_width", manifest.precision->half_width},
                               {"at_most", manifest.precision->at_most}};
    }
    if (manifest.plan) object["plan"] = to_object(*manifest.plan);
    return object;
}

ScenarioEntry scenario_from(const core::Json& object, const std::string& where,
                            std::vector<core::Problem>& problems) {
    ScenarioEntry scenario;
    core::ObjectReader reader(object, where, problems);
    reader.read_fields(scenario);
    reader.read_if_there("factors", scenario.factors);
    reader.read_if_there("variant", scenario.variant);
    core::check_folder_name(where + ": name", scenario.name, problems);
    return scenario;
}

void check_format(const core::Json& object, const std::string& where) {
    const Manifest known;
    const auto format = object.find("format");
    if (format != object.end() && *format == known.format) return;
    throw core::InputError(
        {where + ": format", fmt::format("is {}", format == object.end() ? "missing" : format->dump()),
         fmt::format("{}", known.format), "Read this folder with the version of Clearway that wrote it"});
}

/// `conditions (old is not asked for; and 3 more)`, the first three.
std::string with_some(const char* what, std::vector<std::string> found) {
    constexpr std::size_t most = 3;
    const std::size_t more = found.size() - std::min(found.size(), most);
    found.resize(std::min(found.size(), most));
    return fmt::format("{} ({}{})", what, fmt::join(found, "; "),
                       more > 0 ? fmt::format("; and {} more", more) : "");
}

/// Values by table and key of a configuration that Clearway wrote; those of lists joined.
std::map<std::string, core::Settings> values_of(const std::string& configuration) {
    std::map<std::string, core::Settings> tables;
    std::string table;
    std::istringstream lines(configuration);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = line.find(" = ");
        if (line.starts_with("[")) {
            table = line.substr(line.find_first_not_of('['));
            table = table.substr(0, table.find(']')) + ".";
        } else if (equals != std::string::npos) {
            std::string& value = tables[table][line.substr(0, equals)];
            value += (value.empty() ? "" : ", ") + line.substr(equals + 3);
        }
    }
    return tables;
}

/// What the dense variant sets, and so is told with it.
bool is_of_variant(const std::string& key) {
    constexpr std::array keys = {"demand.density", "demand.emergency", "time.warm_up_s", "time.window_s"};
    return key.starts_with("dense.") || core::contains(keys, key);
}

/// `friction 0.5, speed_factor 1`.
std::string in_words(const core::Settings& values) {
    std::vector<std::string> words;
    for (const auto& [key, value] : values)
        words.push_back(key + " " + value);
    return core::listed(words);
}

void add_differing_values(const ScenarioEntry& left, const ScenarioEntry& right,
                          std::vector<std::string>& found) {
    const auto or_none = [](const std::string& text) { return text.empty() ? std::string("none") : text; };
    const auto add = [&](const std::string& key, const std::string& there, const std::string& now) {
        if (there != now)
            found.push_back(
                fmt::format("{}: {}: {} there, {} now", left.name, key, or_none(there), or_none(now)));
    };
    const auto variant = [](const ScenarioEntry& one) {
        return one.variant.empty() ? std::string("standard") : one.variant;
    };
    add("variant", variant(left), variant(right));
    auto before = values_of(left.configuration);
    auto after = values_of(right.configuration);
    std::set<std::string> keys;
    for (auto* const tables : {&before, &after})
        for (const auto& [table, values] : *tables)
            for (const auto& [key, value] : values)
                keys.insert(table + key);
    std::set<std::string> told;  // Tables that one lacks, once as a whole.
    for (const std::string& key : keys) {
        if (left.variant != right.variant && is_of_variant(key)) continue;
        const std::string table = key.substr(0, key.find('.') + 1);
        core::Settings& there = before[table];
        core::Settings& now = after[table];
        if (!there.empty() && !now.empty())
            add(key, there[key.substr(table.size())], now[key.substr(table.size())]);
        else if (told.insert(table).second)
            add(table.substr(0, table.size() - 1), in_words(there), in_words(now));
    }
}

/// `scenarios (line: variant: standard there, dense now)`.
std::string differing_scenarios(const Manifest& left, const Manifest& right) {
    std::vector<std::string> found;
    for (const ScenarioEntry& one : left.scenarios) {
        const auto same = std::ranges::find(right.scenarios, one.name, &ScenarioEntry::name);
        const std::size_t before = found.size();
        if (same == right.scenarios.end()) {
            found.push_back(one.name + " is not asked for");
        } else if (*same != one) {
            add_differing_values(one, *same, found);
            if (found.size() == before) found.push_back(one.name + ": its files");
        }
    }
    for (const ScenarioEntry& one : right.scenarios)
        if (!core::contains(left.scenarios, one.name, &ScenarioEntry::name))
            found.push_back(one.name + " is new");
    return found.empty() ? "order of scenarios" : with_some("scenarios", std::move(found));
}

/// `conditions (old is not asked for; Soft: soft.py has changed)`, at most three of them. New ones, which a
/// folder may take, are told only where nothing else differs.
std::string differing_conditions(const Manifest& left, const Manifest& right,
                                 const experiment::ConditionTitles& titles) {
    core::Settings named = titles.of(left.conditions);
    named.merge(titles.of(right.conditions));
    std::vector<std::string> found;
    std::vector<std::string> added;
    std::vector<std::string> order;
    for (const experiment::ConditionSpec& one : left.conditions) {
        if (!core::contains(right.conditions, one.name, &experiment::ConditionSpec::name))
            found.push_back(named.at(one.name) + " is not asked for");
        else
            order.push_back(one.name);
    }
    auto next = order.begin();
    for (const experiment::ConditionSpec& one : right.conditions) {
        const auto same = std::ranges::find(left.conditions, one.name, &experiment::ConditionSpec::name);
        if (same == left.conditions.end())
            added.push_back(named.at(one.name) + " is new");
        else if (*same != one)
            found.push_back(named.at(one.name) + ": " + experiment::what_differs(*same, one));
        if (next != order.end() && *next == one.name) ++next;
    }
    if (found.empty() && next != order.end()) return "order of conditions";
    if (found.empty()) found = std::move(added);
    return with_some("conditions", std::move(found));
}

}  // namespace

void Manifest::for_each_run(const std::function<void(const experiment::RunKey&)>& visit) const {
    const auto sorted_names = [](const auto& entries) {
        std::vector<std::string> names =
            core::texts_of(entries, [](const auto& entry) { return entry.name; });
        std::ranges::sort(names);
        return names;
    };
    const std::vector<std::string> condition_names = sorted_names(conditions);
    for (const std::string& scenario : sorted_names(scenarios)) {
        for (const std::string& condition : condition_names) {
            for (std::uint32_t replication = 0; replication < replications; ++replication)
                visit({scenario, condition, replication});
        }
    }
}

std::vector<experiment::RunKey> Manifest::runs() const {
    std::vector<experiment::RunKey> keys;
    keys.reserve(run_count());
    for_each_run([&](const experiment::RunKey& key) { keys.push_back(key); });
    return keys;
}

experiment::Provenance planned_provenance(const Manifest& manifest, const std::string& scenario) {
    experiment::Provenance provenance;
    provenance.clearway_version = manifest.clearway_version;
    provenance.sumo_version = manifest.sumo_version;
    provenance.study_seed = manifest.study_seed;
    const auto entry = std::ranges::find(manifest.scenarios, scenario, &ScenarioEntry::name);
    if (entry != manifest.scenarios.end()) provenance.configuration_hash = entry->configuration_hash;
    return provenance;
}

std::string differences(const Manifest& left, const Manifest& right, const core::Settings& titles) {
    std::string list;
    const auto add = [&](bool differs, const std::string& part) {
        if (differs) list += (list.empty() ? "" : ", ") + part;
    };
    add(left.study != right.study, "study name");
    add(left.clearway_version != right.clearway_version, "Clearway version");
    add(left.clearway_build != right.clearway_build, another_build);
    add(left.sumo_version != right.sumo_version, "SUMO version");
    add(left.study_seed != right.study_seed, "seed");
    add(left.replications != right.replications, "replications");
    if (left.scenarios != right.scenarios) add(true, differing_scenarios(left, right));
    const bool others = left.conditions != right.conditions;
    add(others, others ? differing_conditions(left, right, experiment::ConditionTitles(titles)) : "");
    add(left.precision != right.precision, "precision");
    add(left.plan != right.plan, "plan");
    return list;
}

bool continues(const Manifest& wanted, const Manifest& stored) {
    Manifest less = wanted;
    less.replications = stored.replications;
    auto known = stored.conditions.begin();
    for (const experiment::ConditionSpec& condition : wanted.conditions)
        if (known != stored.conditions.end() && condition == *known) ++known;
    if (!wanted.plan && known == stored.conditions.end()) less.conditions = stored.conditions;
    return less == stored && wanted.replications >= stored.replications;
}

std::string manifest_hash(const Manifest& manifest) {
    return core::content_hash(core::to_text(to_object(manifest)));
}

std::string study_hash(Manifest manifest) {
    for (experiment::ConditionSpec& condition : manifest.conditions)
        condition = experiment::without_folders(condition);
    return manifest_hash(manifest);
}

std::string to_json(const Manifest& manifest) {
    core::Json object = to_object(manifest);
    object["hash"] = manifest_hash(manifest);
    return core::to_text(object);
}

Manifest manifest_from_json(const std::string& text, const std::string& where) {
    const core::Json object = core::parse_object(text, where);
    check_format(object, where);
    Manifest manifest;
    std::string hash;
    std::vector<core::Problem> problems;
    core::ObjectReader reader(object, where, problems);
    reader.read("study", manifest.study);
    core::check_folder_name(where + ": study", manifest.study, problems);
    reader.read("clearway_version", manifest.clearway_version);
    reader.read("clearway_build", manifest.clearway_build);
    reader.read("sumo_version", manifest.sumo_version);
    reader.read("study_seed", manifest.study_seed);
    reader.read("replications", manifest.replications);
    for (const core::Json& scenario : reader.child("scenarios", core::Json::value_t::array))
        manifest.scenarios.push_back(scenario_from(scenario, where + ": scenarios", problems));
    for (const core::Json& condition : reader.child("conditions", core::Json::value_t::array))
        manifest.conditions.push_back(
            experiment::condition_from(condition, where + ": conditions", problems));
    if (object.contains("plan"))
        manifest.plan =
            plan_from(reader.child("plan", core::Json::value_t::object), where + ": plan", problems);
    if (object.contains("precision")) {
        PrecisionTarget& target = manifest.precision.emplace();
        core::ObjectReader precision(reader.child("precision", core::Json::value_t::object),
                                     where + ": precision", problems);
        precision.read("metric", target.metric);
        precision.read("half_width", target.half_width);
        precision.read("at_most", target.at_most);
    }
    const std::uint64_t runs =
        runs_of(manifest.scenarios.size(), manifest.conditions.size(), manifest.replications);
    if (manifest.replications > most_replications || runs > greatest_most_runs)
        problems.push_back(
            {where + ": replications", fmt::format("{} make {} runs", manifest.replications, runs),
             fmt::format("at most {} replications and {} runs", most_replications, greatest_most_runs),
             "This is no manifest that Clearway wrote; take the folder from a backup"});
    reader.read("hash", hash);
    if (problems.empty() && hash != manifest_hash(manifest))
        problems.push_back({where + ": hash", "does not fit the rest", "",
                            "The manifest was edited or is damaged: take it from a backup"});
    if (!problems.empty()) throw core::InputError(problems);
    return manifest;
}

}  // namespace clearway::results
