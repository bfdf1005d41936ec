#include "study/detail/factors.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/folder_name.hpp"
#include "experiment/settings.hpp"
#include "results/run_limit.hpp"
#include "scenario/keys.hpp"
#include "scenario/overrides.hpp"
#include "study/detail/read_settings.hpp"

namespace clearway::study::detail {
namespace {

using Problems = std::vector<core::Problem>;

constexpr const char* several = "set";
constexpr const char* design_key = "design";
constexpr const char* policy_key = "policy";

/// What a factor may vary below `condition.`.
const std::vector<std::string>& condition_keys() {
    static const std::vector<std::string> keys = [] {
        std::vector<std::string> names = {policy_key};
        core::for_each_field<experiment::ConditionSpec>(
            [&](const auto& field) { names.emplace_back(field.name); });
        return names;
    }();
    return keys;
}

/// What a factor may vary: conditions, scenarios, several settings, or any component with settings, those in
/// Python included.
std::vector<std::string> groups(const SettingsPlace& place) {
    std::vector<std::string> names = {"condition", "scenario", several};
    for (const experiment::Component& component : experiment::components())
        names.push_back(component.name);
    names.insert(names.end(), place.parts.begin(), place.parts.end());
    return names;
}

bool is_component(const std::string& group) {
    return group != "condition" && group != "scenario" && group != several;
}

std::string place(const toml::node& node, const std::string& file, const std::string& key) {
    return fmt::format("{}:{}:{}: factors.{}", file, node.source().begin.line, node.source().begin.column,
                       key);
}

std::string last_part(const std::string& key) {
    return key.substr(key.rfind('.') == std::string::npos ? 0 : key.rfind('.') + 1);
}

void add_unknown(const std::string& where, const std::string& word, const std::vector<std::string>& known,
                 Problems& problems) {
    problems.push_back(
        {where, fmt::format("'{}' is unknown", word), core::listed(known), core::did_you_mean(word, known)});
}

bool read_value(const toml::node& node, FactorValue& value) {
    std::ostringstream toml_text;
    if (const toml::array* list = node.as_array()) {
        for (const toml::node& element : *list) {
            const auto word = element.value_exact<std::string>();
            if (!word) return false;
            value.words.push_back(*word);
            value.text += (value.text.empty() ? "" : ".") + *word;
        }
        toml_text << *list;
    } else if (const auto text = setting_value(node)) {
        value.text = *text;
        node.visit([&](const auto& plain) { toml_text << plain; });
    } else {
        return false;
    }
    value.toml = toml_text.str();
    return true;
}

void read_list(const toml::array& list, Factor factor, std::vector<Factor>& factors, Problems& problems) {
    if (list.empty())
        problems.push_back(
            {factor.where, "has no values", "one value or more", "List them, or remove the factor"});
    for (const toml::node& node : list) {
        FactorValue value;
        if (read_value(node, value)) {
            factor.values.push_back(std::move(value));
        } else {
            problems.push_back({factor.where, "holds something other than values",
                                "numbers, texts, truth values, or lists of texts", ""});
        }
    }
    factors.push_back(std::move(factor));
}

/// `set = [{ "a.b" = 1, "c.d" = 2 }, ...]`: each value sets several settings at once.
void read_several(const toml::node& node, const SettingsPlace& settings, std::vector<Factor>& factors,
                  Problems& problems) {
    Factor factor{several, several, place(node, settings.file, several), {}};
    const toml::array* const list = node.as_array();
    if (list == nullptr || list->empty() || !list->is_homogeneous(toml::node_type::table)) {
        problems.push_back(
            {factor.where, "is not a list of settings", R"([{ "COMPONENT.NAME" = VALUE, ... }, ...])", ""});
        return;
    }
    for (const toml::node& element : *list) {
        FactorValue value;
        value.settings = read_settings(*element.as_table(), settings, problems);
        if (element.as_table()->empty())
            problems.push_back({factor.where, "sets nothing", R"({ "COMPONENT.NAME" = VALUE, ... })",
                                "The condition as it is runs too under design = \"one_at_a_time\""});
        for (const auto& [name, text] : value.settings)
            value.text += (value.text.empty() ? "" : ".") + last_part(name) + "_" + text;
        factor.values.push_back(std::move(value));
    }
    factors.push_back(std::move(factor));
}

Design read_design(const toml::node& node, const std::string& file, Problems& problems) {
    const auto word = node.value_exact<std::string>();
    if (word == "one_at_a_time") return Design::one_at_a_time;
    if (word != "all_combinations")
        problems.push_back(
            {place(node, file, design_key), "is not known", "all_combinations, one_at_a_time", ""});
    return Design::all_combinations;
}

// NOLINTNEXTLINE(readability-function-size): a table, its place, and two lists to fill
void read_group(const toml::table& table, const std::string& file, const std::string& group,
                const std::string& prefix, std::vector<Factor>& factors, Problems& problems) {
    for (const auto& [name, node] : table) {
        const std::string key = prefix + std::string(name.str());
        Factor factor{group, key, place(node, file, group + "." + key), {}};
        if (const toml::table* deeper = node.as_table(); deeper != nullptr && group == "scenario") {
            read_group(*deeper, file, group, key + ".", factors, problems);
        } else if (const toml::array* list = node.as_array()) {
            read_list(*list, std::move(factor), factors, problems);
        } else {
            problems.push_back({factor.where, "is not a list", "a list of values, [0.1, 0.3]", ""});
        }
    }
}

/// Every setting, key of a condition or key of a scenario may be varied by one factor alone, because columns
/// and names could not say which value ran.
void check_repeated(const std::vector<Factor>& factors, Problems& problems) {
    std::set<std::string> seen;
    for (const Factor& factor : factors) {
        std::set<std::string> names;
        if (factor.group == several) {
            for (const FactorValue& value : factor.values) {
                for (const auto& [name, text] : value.settings)
                    names.insert(name);
            }
        } else {
            names.insert(factor.group + "." + factor.key);
        }
        for (const std::string& name : names) {
            if (!seen.insert(name).second)
                problems.push_back({factor.where, fmt::format("{} is varied by another factor too", name),
                                    "one factor for each", "Remove one of them"});
        }
    }
}

void check_levels(const std::vector<Factor>& factors, Problems& problems) {
    for (const Factor& factor : factors) {
        std::set<std::string> seen;
        for (const FactorValue& value : factor.values)
            if (!seen.insert(value.text).second)
                problems.push_back({factor.where, fmt::format("has the level {} twice", value.text),
                                    "each level once", "Remove one of them"});
    }
}

/// A factor on a key would change nothing where another factor is an override of that key.
void check_replaced(const std::vector<Factor>& factors, Problems& problems) {
    for (const Factor& factor : factors) {
        for (const Factor& other : factors) {
            if (factor.group != "scenario" || other.group != "scenario") continue;
            const bool replaced = std::ranges::any_of(other.values, [&](const FactorValue& value) {
                return &factor != &other && scenario::replaces(other.key, value.text, factor.key);
            });
            if (!replaced) continue;
            problems.push_back({factor.where, fmt::format("is replaced by another factor, {}", other.where),
                                "one factor for each key", "Remove one of them"});
        }
    }
}

/// One at a time, a scenario and a condition would still be varied together.
void check_design(const Factors& factors, Problems& problems) {
    const auto of_scenarios = [](const Factor& factor) { return factor.group == "scenario"; };
    const auto first = std::ranges::find_if(factors.list, of_scenarios);
    const bool mixed = first != factors.list.end() && !std::ranges::all_of(factors.list, of_scenarios);
    if (factors.design == Design::one_at_a_time && mixed)
        problems.push_back(
            {first->where, "cannot be varied one at a time beside settings of conditions",
             "factors of scenarios or of conditions, because every condition runs in every scenario",
             "Use two study files, or design = \"all_combinations\""});
}

/// Keys that every scenario may have, and overrides.
std::vector<std::string> scenario_names() {
    std::vector<std::string> names = core::texts_of(
        scenario::overrides(), [](const scenario::Override& override) { return override.value.name; });
    for (const core::FieldTable& table : scenario::key_tables()) {
        if (table.title.starts_with("[[")) continue;
        for (const core::SettingInfo& row : table.rows)
            names.push_back(row.name);
    }
    for (const char* const list :
         {"network.additional", "measured.routes", "measured.additional", "measured.persons"})
        names.emplace_back(list);
    return names;
}

/// Removes the factors that no scenario knows and adds a problem for each, so that not every scenario reports
/// them.
void drop_unknown_keys(std::vector<Factor>& factors, Problems& problems) {
    const std::vector<std::string> known = scenario_names();
    std::erase_if(factors, [&](const Factor& factor) {
        const bool is_stretch = factor.key.starts_with("road.stretch.");  // its name is the scenario's own
        if (factor.group != "scenario" || is_stretch || core::contains(known, factor.key)) return false;
        // `drivers.speed_factor_mean` for `speed_factor_mean`
        const auto same_end = std::ranges::find_if(
            known, [&](const std::string& name) { return last_part(name) == last_part(factor.key); });
        const std::string near = same_end == known.end() ? core::nearest(factor.key, known) : *same_end;
        problems.push_back({factor.where, fmt::format("'{}' is unknown", factor.key),
                            "overrides and keys of `clearway list scenario-keys`",
                            near.empty() ? "" : fmt::format("Did you mean 'scenario.{}'?", near)});
        return true;
    });
}

void check_names(const std::vector<Factor>& factors, const SettingsPlace& settings, Problems& problems) {
    for (const Factor& factor : factors) {
        if (factor.group == "condition" && !core::contains(condition_keys(), factor.key))
            add_unknown(factor.where, factor.key, condition_keys(), problems);
        if (!is_component(factor.group)) continue;
        const std::string name = factor.group + "." + factor.key;
        for (const FactorValue& value : factor.values) {
            for (const core::Problem& problem :
                 experiment::check_setting(name, value.text, "", settings.parts))
                problems.push_back({factor.where, problem.what, problem.allowed, problem.cure});
        }
    }
}

void set_condition_key(const Factor& factor, const FactorValue& value, experiment::ConditionSpec& condition,
                       Problems& problems) {
    if (factor.key == policy_key)
        condition.policies = value.words.empty() ? std::vector{value.text} : value.words;
    core::for_each_field<experiment::ConditionSpec>([&](const auto& field) {
        if (factor.key != field.name) return;
        if (auto problem = core::set_member(field, value.text, factor.where, condition.*field.member))
            problems.push_back(std::move(*problem));
    });
}

/// Reads `"preempt_signals.lead_s" = [4, 8]`, a setting with its full name in quotes. Returns whether `name`
/// is one.
bool read_quoted(const std::string& name, const toml::node& node, const SettingsPlace& settings,
                 std::vector<Factor>& factors, Problems& problems) {
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos) return false;
    const std::string group = name.substr(0, dot);
    const std::vector<std::string> known = groups(settings);
    if (!core::contains(known, group)) return false;
    const std::string where = place(node, settings.file, name);
    if (const toml::array* const list = node.as_array()) {
        read_list(*list, {group, name.substr(dot + 1), where, {}}, factors, problems);
    } else {
        problems.push_back({where, "is not a list", "a list of values, [0.1, 0.3]", ""});
    }
    return true;
}

}  // namespace

Factors read_factors(const toml::table& table, const SettingsPlace& settings, Problems& problems) {
    Factors factors;
    const std::string& file = settings.file;
    const std::vector<std::string> known = groups(settings);
    for (const auto& [name, node] : table) {
        const std::string group(name.str());
        const std::string where = place(node, file, group);
        if (group == design_key) {
            factors.design = read_design(node, file, problems);
        } else if (group == several) {
            read_several(node, settings, factors.list, problems);
        } else if (read_quoted(group, node, settings, factors.list, problems)) {
            continue;
        } else if (!core::contains(known, group)) {
            const bool bare = core::contains(condition_keys(), group);
            if (bare)
                problems.push_back(
                    {where, "is unknown", core::listed(known), "Did you mean 'condition." + group + "'?"});
            if (!bare)
                problems.push_back(
                    {where, fmt::format("'{}' is unknown", group), core::listed(known),
                     core::did_you_mean(group, known,
                                        experiment::check_setting(group, "", "").front().cure)});
        } else if (const toml::table* below = node.as_table()) {
            read_group(*below, file, group, "", factors.list, problems);
        } else {
            problems.push_back({where, "is not a table", group + ".NAME = [values]",
                                group == "failure" ? "Did you mean 'condition.failure'?" : ""});
        }
    }
    drop_unknown_keys(factors.list, problems);
    check_names(factors.list, settings, problems);
    check_repeated(factors.list, problems);
    check_levels(factors.list, problems);
    check_replaced(factors.list, problems);
    check_design(factors, problems);
    return factors;
}

std::uint64_t count_combinations(const Factors& factors, Subject subject) {
    std::uint64_t count = 1;
    for (const Factor& factor : factors.list) {
        if ((factor.group == "scenario") != (subject == Subject::scenarios)) continue;
        count = factors.design == Design::one_at_a_time ? count + factor.values.size()
                                                        : results::product(count, factor.values.size());
    }
    return count;
}

std::vector<Assignment> combinations(const Factors& factors, Subject subject) {
    std::vector<Assignment> all = {{}};
    for (const Factor& factor : factors.list) {
        if ((factor.group == "scenario") != (subject == Subject::scenarios)) continue;
        if (factors.design == Design::one_at_a_time) {
            for (const FactorValue& value : factor.values)
                all.push_back({{&factor, &value}});
            continue;
        }
        std::vector<Assignment> longer;
        for (const Assignment& assignment : all) {
            for (const FactorValue& value : factor.values) {
                longer.push_back(assignment);
                longer.back().emplace_back(&factor, &value);
            }
        }
        all = std::move(longer);
    }
    return all;
}

std::string name_of(const Assignment& assignment, const Factors& factors) {
    std::string name;
    for (const auto& [factor, value] : assignment) {
        const std::string key = last_part(factor->key);
        const auto alike = std::ranges::count_if(
            factors.list, [&](const Factor& other) { return last_part(other.key) == key; });
        name += fmt::format("+{}={}", alike > 1 ? factor->group + "." + factor->key : key,
                            core::as_folder_name(value->text));
    }
    return name;
}

Assignment concerning(const experiment::ConditionSpec& condition, const Assignment& assignment) {
    experiment::ConditionSpec changed = condition;
    Problems ignored;  // `with` reports them
    for (const auto& [factor, value] : assignment) {
        if (factor->group == "condition") set_condition_key(*factor, *value, changed, ignored);
    }
    const std::vector<std::string> present = experiment::components_of(changed);
    const auto has = [&](const std::string& component) { return core::contains(present, component); };
    Assignment concerned;
    for (const auto& [factor, value] : assignment) {
        const bool has_all = std::ranges::all_of(value->settings, [&](const auto& setting) {
            return has(setting.first.substr(0, setting.first.find('.')));
        });
        if (has_all && (!is_component(factor->group) || has(factor->group)))
            concerned.emplace_back(factor, value);
    }
    return concerned;
}

core::Settings factors_of(const Assignment& assignment) {
    core::Settings factors;
    for (const auto& [factor, value] : assignment) {
        if (value->settings.empty()) factors[factor->group + "." + factor->key] = value->text;
        factors.insert(value->settings.begin(), value->settings.end());
    }
    return factors;
}

experiment::ConditionSpec with(experiment::ConditionSpec condition, const Assignment& assignment,
                               Problems& problems) {
    condition.factors = factors_of(assignment);
    for (const auto& [factor, value] : assignment) {
        if (factor->group == "condition") set_condition_key(*factor, *value, condition, problems);
    }
    // Set the failure before its fields.
    for (const auto& [factor, value] : assignment) {
        if (is_component(factor->group))
            experiment::set(condition, factor->group + "." + factor->key, value->text);
        for (const auto& [name, text] : value->settings)
            experiment::set(condition, name, text);
    }
    return condition;
}

bool is_environment(const Factor& factor) {
    return experiment::is_environment(factor.group);
}

bool is_varied(const experiment::ConditionSpec& condition) {
    experiment::ConditionSpec plain;
    plain.name = condition.name;
    plain.traffic_model = condition.traffic_model;
    return condition.traffic_model != experiment::TrafficModel::free_flow && condition != plain;
}

}  // namespace clearway::study::detail
