#include "study/config.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/near_file.hpp"
#include "core/shipped_files.hpp"
#include "core/strict_table.hpp"
#include "experiment/code_parts.hpp"
#include "experiment/condition_titles.hpp"
#include "experiment/conditions.hpp"
#include "experiment/settings.hpp"
#include "metrics/run_metrics.hpp"
#include "scenario/overrides.hpp"
#include "study/detail/factors.hpp"
#include "study/detail/read_plan.hpp"
#include "study/detail/read_settings.hpp"
#include "study/detail/read_titles.hpp"

namespace clearway::study {
namespace {

using core::StrictTable;
using core::TomlReading;
using results::most_replications;
using Problems = std::vector<core::Problem>;

constexpr std::int64_t most_seed = std::numeric_limits<std::int64_t>::max();

/// Every combination of factors loads the same scenarios with the same overrides: a problem is told once.
void append(Problems& problems, const core::InputError& error) {
    std::ranges::copy_if(error.problems(), std::back_inserter(problems), [&](const core::Problem& problem) {
        return !core::contains(problems, core::format_problem(problem), core::format_problem);
    });
}

/// The overrides with a combination of factors applied.
scenario::Options options_with(const toml::table& overrides, const detail::Assignment& assignment,
                               TomlReading& reading) {
    toml::table changed = overrides;
    scenario::Options options;
    for (const auto& [factor, value] : assignment) {
        if (scenario::is_override(factor->key)) {
            core::set_value(changed, factor->key, value->toml);
        } else {
            options.settings[factor->key] = value->toml;
        }
    }
    StrictTable reader(changed, "overrides", reading);
    scenario::read_overrides(reader, options);
    reader.finish();
    return options;
}

/// Reads settings and model of a condition whose failure and predictor have been read.
void read_settings(StrictTable& reader, TomlReading& reading, experiment::ConditionSpec& condition) {
    if (const toml::table* const table = reader.table("set")) {
        for (const auto& [name, value] : detail::read_settings(
                 *table, {reading.file, experiment::part_names(condition)}, reading.problems))
            experiment::set(condition, name, value);
    }
    std::string model;
    reader.text("model", model);
    if (model.empty()) return;
    try {
        const std::filesystem::path folder = std::filesystem::path(reading.file).parent_path();
        experiment::set_model(condition, (folder / model).string(), reader.where("model"));
    } catch (const core::InputError& error) {
        append(reading.problems, error);
    }
}

/// Reads a list of texts or a single text.
void read_policies(StrictTable& reader, const toml::table& table, std::vector<std::string>& policies) {
    if (table.contains("policy") && table.get("policy")->is_string()) {
        reader.text("policy", policies.emplace_back());
    } else {
        reader.texts("policy", policies);
    }
}

experiment::ConditionSpec read_condition(const toml::table& table, TomlReading& reading) {
    experiment::ConditionSpec condition;
    StrictTable reader(table, "condition", reading);
    reader.text("name", condition.name);
    reader.read(condition);
    read_policies(reader, table, condition.policies);
    read_settings(reader, reading, condition);
    reader.finish();
    if (condition.name.empty()) reader.problem("name", "is missing", "a name", "Name the condition");
    return condition;
}

void read_conditions(StrictTable& root, TomlReading& reading, StudyConfig& config) {
    std::vector<std::string> names;
    root.texts("conditions", names);
    for (const std::string& name : names) {
        try {
            config.conditions.push_back(experiment::built_in_condition(name, root.where("conditions")));
        } catch (const core::InputError& error) {
            append(reading.problems, error);
        }
    }
    for (const toml::table* table : root.tables("condition"))
        config.conditions.push_back(read_condition(*table, reading));
    if (names.empty() && config.conditions.empty())
        root.problem("conditions", "the study has no condition", "names of `clearway list`, or [[condition]]",
                     "");
}

/// A path in a study file is relative to that file; a bare word is a name.
std::string resolve(const std::string& scenario, const std::filesystem::path& study_file) {
    const std::filesystem::path path = scenario;
    const bool is_name = !path.has_parent_path() && path.extension() != ".toml";
    return is_name ? scenario : (study_file.parent_path() / path).string();
}

/// `my-city` of `./my-city`, of `./my-city/` and of `my-city/scenario.toml`.
std::string folder_name(const std::filesystem::path& scenario) {
    std::filesystem::path path = scenario.lexically_normal();
    if (!path.has_filename() || path.extension() == ".toml") path = path.parent_path();
    return path.filename().string();
}

void add_scenario(const std::string& path, const scenario::Options& options, const std::string& suffix,
                  Problems& problems, StudyConfig& config) {
    try {
        scenario::ScenarioConfig loaded = scenario::load(path, options);
        loaded.name += suffix;
        config.scenarios.push_back(std::move(loaded));
    } catch (const core::InputError& error) {
        append(problems, error);
    }
}

/// Adds a problem for each factor that changes nothing because an override sets the same key, and for each
/// override that a factor sets anew in every combination. One at a time, an override is the value of the
/// scenario that is not varied.
void check_overridden(const toml::table& overrides, const std::string& path, const detail::Factors& factors,
                      TomlReading& reading) {
    const StrictTable reader(overrides, path, reading);
    for (const scenario::Override& override : scenario::overrides()) {
        const std::string& name = override.value.name;
        const toml::node* const node = overrides.get(name);
        if (node == nullptr) continue;
        const std::string text = detail::setting_value(*node).value_or("");
        for (const detail::Factor& factor : factors.list) {
            if (factor.group != "scenario") continue;
            if (factor.key == name && factors.design == detail::Design::all_combinations) {
                reading.problems.push_back({factor.where, "replaces " + reader.where(name), "one of the two",
                                            "Remove the override, or list its value in the factor"});
            } else if (scenario::replaces(name, text, factor.key)) {
                reading.problems.push_back(
                    {factor.where, fmt::format("changes nothing, because {} replaces it", reader.where(name)),
                     "one of the two", "Remove the override, or the factor"});
            }
        }
    }
}

/// Adds a `[[scenario]]`: a scenario under a name of its own, with overrides in addition to those of the
/// study.
// NOLINTNEXTLINE(readability-function-size): a table, what it is read with, and what it fills
void add_own_scenario(const toml::table& table, toml::table overrides, const detail::Assignment& assignment,
                      const detail::Factors& factors, TomlReading& reading, StudyConfig& config) {
    std::string from;
    std::string name;
    toml::table source;
    for (const auto& [key, node] : table) {
        const bool is_own = key == "from" || key == "name";
        node.visit([&, key = key](const auto& value) {
            (is_own ? source : overrides).insert_or_assign(key, value);
        });
    }
    StrictTable reader(source, "scenario", reading);
    reader.text("from", from);
    reader.text("name", name);
    reader.finish();
    if (from.empty() || name.empty()) {
        reader.problem(from.empty() ? "from" : "name", "is missing", "from and name",
                       "Say which scenario it is and what it is called here");
        return;
    }
    const std::size_t before = config.scenarios.size();
    add_scenario(resolve(from, reading.file), options_with(overrides, assignment, reading), "",
                 reading.problems, config);
    if (config.scenarios.size() > before)
        config.scenarios.back().name = name + detail::name_of(assignment, factors);
}

/// `instead` are the scenarios that take the place of the file's.
// NOLINTNEXTLINE(readability-function-size): a table, what it is read with, and what it fills
void read_scenarios(StrictTable& root, const detail::Factors& factors,
                    const std::vector<std::string>& instead, TomlReading& reading, StudyConfig& config) {
    std::vector<std::string> names;
    root.texts("scenarios", names);
    std::ranges::transform(names, names.begin(),
                           [&](const std::string& name) { return resolve(name, reading.file); });
    std::vector<const toml::table*> own = root.tables("scenario");
    if (!instead.empty()) {
        names = instead;
        own.clear();
        for (const std::string& name : instead)
            config.name += "-" + folder_name(name);
    }
    if (names.empty() && own.empty())
        root.problem("scenarios", "the study has no scenario", "names of `clearway list`, folders or files",
                     "");
    const toml::table* const given = root.table("overrides");
    const toml::table overrides = given == nullptr ? toml::table{} : *given;
    check_overridden(overrides, "overrides", factors, reading);
    for (const toml::table* table : own)
        check_overridden(*table, "scenario", factors, reading);
    for (const detail::Assignment& assignment : detail::combinations(factors, detail::Subject::scenarios)) {
        const scenario::Options options = options_with(overrides, assignment, reading);
        for (const std::string& name : names)
            add_scenario(name, options, detail::name_of(assignment, factors), reading.problems, config);
        for (const toml::table* table : own)
            add_own_scenario(*table, overrides, assignment, factors, reading, config);
        for (const scenario::ScenarioConfig& scenario : config.scenarios) {
            if (!assignment.empty())
                config.scenario_factors.try_emplace(scenario.name, detail::factors_of(assignment));
        }
    }
}

/// Combinations are counted before they are made. Throws core::InputError with all problems so far: too many
/// would fill the memory.
void check_combinations(const detail::Factors& factors, TomlReading& reading, const StudyConfig& config) {
    for (const auto& [subject, word] : {std::pair(detail::Subject::scenarios, "scenario"),
                                        std::pair(detail::Subject::conditions, "condition")}) {
        const std::uint64_t count = detail::count_combinations(factors, subject);
        if (count <= config.most_runs) continue;
        reading.problems.push_back(
            {fmt::format("{}: factors", reading.file), fmt::format("make {} of each {}", count, word),
             fmt::format("at most {} runs", config.most_runs),
             "List fewer values, use design = \"one_at_a_time\", or allow more with --most-runs"});
        throw core::InputError(reading.problems);
    }
}

/// One condition per combination of the factors that concern it.
std::vector<experiment::ConditionSpec> variants(const experiment::ConditionSpec& condition,
                                                const detail::Factors& factors,
                                                std::set<const detail::Factor*>& used, Problems& problems) {
    std::vector<experiment::ConditionSpec> varied;
    std::set<detail::Assignment> seen;
    for (const detail::Assignment& full : detail::combinations(factors, detail::Subject::conditions)) {
        const detail::Assignment assignment = detail::concerning(condition, full);
        if (!seen.insert(assignment).second) continue;
        for (const auto& [factor, value] : assignment)
            used.insert(factor);
        varied.push_back(detail::with(condition, assignment, problems));
        varied.back().name += detail::name_of(assignment, factors);
    }
    return varied;
}

/// A condition that has nothing to vary but its environment: one for each of the environments that the
/// factors make, because a condition is compared with a baseline in its own.
std::vector<experiment::ConditionSpec> baselines(const experiment::ConditionSpec& condition,
                                                 const detail::Factors& factors) {
    if (condition.traffic_model == experiment::TrafficModel::free_flow) return {condition};
    detail::Factors environment{{}, factors.design};
    std::ranges::copy_if(factors.list, std::back_inserter(environment.list), detail::is_environment);
    std::set<const detail::Factor*> used;
    Problems told;  // when other conditions are varied
    return variants(condition, environment, used, told);
}

/// Replaces each condition that has a policy, a predictor or failing sensors with one condition per
/// combination of the factors.
void vary_conditions(const detail::Factors& factors, Problems& problems, StudyConfig& config) {
    const std::vector<detail::Assignment> all = detail::combinations(factors, detail::Subject::conditions);
    if (all.size() == 1 && all.front().empty()) return;
    if (std::ranges::none_of(config.conditions, detail::is_varied)) {
        problems.push_back({"factors", "no condition has failures, a predictor or a policy to vary",
                            "a condition other than baseline and solo", "Add one to the conditions"});
        return;
    }
    std::vector<experiment::ConditionSpec> varied;
    std::set<const detail::Factor*> used;
    for (const experiment::ConditionSpec& condition : config.conditions) {
        if (!detail::is_varied(condition)) {
            const std::vector<experiment::ConditionSpec> own = baselines(condition, factors);
            varied.insert(varied.end(), own.begin(), own.end());
            continue;
        }
        const std::vector<experiment::ConditionSpec> own = variants(condition, factors, used, problems);
        varied.insert(varied.end(), own.begin(), own.end());
    }
    for (const detail::Factor& factor : factors.list) {
        if (factor.group == "scenario" || used.contains(&factor)) continue;
        problems.push_back({factor.where, "is a setting that no condition has",
                            "settings of the conditions' policies and predictors",
                            "Add a condition with it, or remove the factor"});
    }
    config.conditions = std::move(varied);
}

/// Names of the parts in Python in a study file, wherever they stand.
std::vector<std::string> parts_in(const toml::node& node) {
    std::vector<std::string> names;
    const auto append = [&](const toml::node& below) {
        const std::vector<std::string> more = parts_in(below);
        names.insert(names.end(), more.begin(), more.end());
    };
    if (const auto text = node.value_exact<std::string>()) {
        if (const auto name = experiment::part_called(*text)) names.push_back(*name);
    } else if (const toml::array* const list = node.as_array()) {
        for (const toml::node& below : *list)
            append(below);
    } else if (const toml::table* const table = node.as_table()) {
        for (const auto& [key, below] : *table)
            append(below);
    }
    return names;
}

/// Files in Python are relative to the study file.
void resolve_parts(TomlReading& reading, StudyConfig& config) {
    const std::filesystem::path file(reading.file);
    for (experiment::ConditionSpec& condition : config.conditions) {
        try {
            // Those that factors made of one share its files, and what is wrong with these is told once.
            experiment::resolve_parts(
                condition, file.parent_path(),
                fmt::format("{}: condition {}: ", reading.file, experiment::name_before_factors(condition)));
        } catch (const core::InputError& error) {
            append(reading.problems, error);
        }
    }
}

/// Whether a key is misspelt that makes or names conditions: a title may then name one of those.
bool misses_conditions(const TomlReading& reading) {
    return std::ranges::any_of(std::array{"factors", "conditions", "condition", "condition.name"},
                               [&](const char* key) { return reading.meant.contains(key); });
}

std::vector<std::string> metric_names() {
    std::vector<std::string> names;
    core::for_each_field<metrics::RunMetrics>([&](const auto& field) { names.emplace_back(field.name); });
    return names;
}

void read_precision(StrictTable& root, StudyConfig& config) {
    auto reader = root.below("precision");
    if (!reader) return;
    results::PrecisionTarget& target = config.precision.emplace();
    target.at_most = most_replications;
    reader->text("metric", target.metric);
    std::optional<double> half_width;
    reader->number("half_width", half_width);
    reader->integer<std::uint32_t>("at_most", least_replications, most_replications, target.at_most);
    reader->finish();
    const std::vector<std::string> names = metric_names();
    if (!core::contains(names, target.metric)) {
        reader->problem("metric", fmt::format("'{}' is not a metric", target.metric), "columns of runs.csv",
                        core::did_you_mean(target.metric, names));
    }
    if (!half_width || !(*half_width > 0.0) || !std::isfinite(*half_width))
        reader->problem("half_width",
                        half_width ? fmt::format("{} is not positive", *half_width) : "is missing",
                        "a number above 0, in the metric's unit", "");
    target.half_width = half_width.value_or(0.0);
    if (root.has("replications"))
        root.problem("replications", "is given together with [precision]", "one of them", "Remove one");
    config.replications = least_replications;
}

/// Keeps those of `all` that are named, in their old order; unknown names are problems.
template <class Element>
void keep_named(StrictTable& quick, const char* key, std::vector<Element>& all) {
    std::vector<std::string> kept;
    quick.texts(key, kept);
    if (kept.empty()) return;
    const std::vector<std::string> names = core::texts_of(all, &Element::name);
    for (const std::string& name : kept) {
        if (core::contains(names, name)) continue;
        quick.problem(key, fmt::format("'{}' is not in the study", name), core::listed(names),
                      core::did_you_mean(name, names));
    }
    std::erase_if(all, [&](const Element& element) { return !core::contains(kept, element.name); });
}

/// Whose scenarios a study has: a command line can replace those of the file.
enum class ScenariosOf : std::uint8_t { file, command_line };

/// Always reads [quick], so that its errors show early; applies it only if it is wanted.
void read_quick(StrictTable& root, Extent extent, ScenariosOf scenarios, StudyConfig& config) {
    auto reader = root.below("quick");
    if (!reader) {
        if (extent == Extent::quick)
            root.problem("quick", "the file does not say what --quick runs", "a table [quick]",
                         "Add one, or run the whole study");
        return;
    }
    StudyConfig quick = config;
    quick.name += "-quick";
    reader->integer<std::uint64_t>("seed", 0, most_seed, quick.seed);
    if (root.has("plan") && quick.seed == config.seed)
        reader->problem("seed", fmt::format("{} is that of the study, which has a plan", quick.seed),
                        "another seed", "Keep the study's seed for the study: a trial would use it up");
    reader->integer<std::uint32_t>("replications", 1, most_replications, quick.replications);
    if (std::vector<std::string> replaced; scenarios == ScenariosOf::command_line)
        reader->texts("scenarios", replaced);
    else
        keep_named(*reader, "scenarios", quick.scenarios);
    keep_named(*reader, "conditions", quick.conditions);
    reader->finish();
    if (extent == Extent::quick) config = std::move(quick);
}

}  // namespace

std::filesystem::path study_file(const std::filesystem::path& name) {
    if (std::filesystem::exists(name)) return name;
    const auto own = core::shipped(name);
    return own && std::filesystem::is_regular_file(*own) ? *own : name;
}

namespace {

/// How to run a scenario, in place of which a study file is wanted.
[[noreturn]] void refuse_scenario(const std::filesystem::path& scenario) {
    const std::string folder = scenario.filename() == "scenario.toml"
                                   ? (scenario.has_parent_path() ? scenario.parent_path().string() : ".")
                                   : scenario.string();
    throw core::InputError({scenario.string(), "is a scenario", "a study file (.toml)",
                            fmt::format("`clearway run {0}` runs it, `clearway study studies/parts.toml "
                                        "--scenario {0}` compares the parts of a policy on it",
                                        folder)});
}

/// Refuses what is no file, or that of a scenario's folder, and says what it is.
void require_study_file(const std::filesystem::path& file) {
    if (file.empty()) throw core::InputError({"the study", "is an empty text", "a study file (.toml)", ""});
    if (std::filesystem::is_directory(file)) {
        if (std::filesystem::exists(file / "scenario.toml")) refuse_scenario(file);
        throw core::InputError(
            {file.string(), "is a folder", "a study file (.toml)",
             std::filesystem::exists(file / "manifest.json")
                 ? fmt::format("clearway report {0} shows its runs; {0}/command.txt made them", file.string())
                 : "Name a file in it"});
    }
    std::error_code unknown;
    if (std::filesystem::status(file, unknown).type() != std::filesystem::file_type::not_found) return;
    const std::vector<std::string> scenarios = scenario::list();
    if (core::contains(scenarios, file.string())) refuse_scenario(file);
    throw core::InputError(
        {file.string(), "there is no such file", "a study file (.toml)", core::did_you_mean_file(file)});
}

}  // namespace

StudyConfig read_study(const std::filesystem::path& name, Extent extent, std::uint64_t most_runs,
                       const std::vector<std::string>& scenarios) {
    const std::filesystem::path file = study_file(name);
    require_study_file(file);
    TomlReading reading{file.string(), {}, {}};
    StudyConfig config;
    config.text = core::read_file(file);
    const toml::table table = core::parse_toml(config.text, reading.file);
    if (table.contains("network") || table.contains("base")) refuse_scenario(file);
    StrictTable root(table, "", reading);
    config.most_runs = most_runs;
    config.name = file.stem().string();
    root.text("name", config.name);
    root.integer<std::uint64_t>("seed", 0, most_seed, config.seed);
    root.integer<std::uint32_t>("replications", 1, most_replications, config.replications);
    read_precision(root, config);
    const toml::table* const factor_table = root.table("factors");
    detail::Factors factors;
    if (factor_table != nullptr)
        factors = detail::read_factors(*factor_table, {reading.file, parts_in(table)}, reading.problems);
    check_combinations(factors, reading, config);
    read_scenarios(root, factors, scenarios, reading, config);
    read_conditions(root, reading, config);
    const std::vector<experiment::ConditionSpec> untouched = config.conditions;
    read_quick(root, extent, scenarios.empty() ? ScenariosOf::file : ScenariosOf::command_line, config);
    vary_conditions(factors, reading.problems, config);
    Problems unnamed = detail::read_titles(root, untouched, factors, extent, config);
    detail::read_controls(root, untouched, config);
    resolve_parts(reading, config);
    detail::read_plan(root, extent, config);
    // A key that is misspelt is the cause of others and comes first.
    const auto others = static_cast<std::ptrdiff_t>(reading.problems.size());
    root.finish();
    std::rotate(reading.problems.begin(), reading.problems.begin() + others, reading.problems.end());
    if (!misses_conditions(reading)) std::ranges::move(unnamed, std::back_inserter(reading.problems));
    if (!reading.problems.empty()) throw core::InputError(reading.problems);
    return config;
}

}  // namespace clearway::study
