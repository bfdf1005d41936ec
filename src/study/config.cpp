#include "study/config.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/strict_table.hpp"
#include "experiment/conditions.hpp"
#include "experiment/settings.hpp"
#include "metrics/run_metrics.hpp"
#include "study/detail/factors.hpp"
#include "study/detail/read_settings.hpp"

namespace clearway::study {
namespace {

using core::StrictTable;
using Problems = std::vector<core::Problem>;

constexpr std::uint32_t most_replications = 100000;

void append(Problems& problems, const core::InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
}

/// Keys of `[overrides]`, which factors of scenarios may set, too.
const std::vector<std::string> override_keys = {"variant",
                                                "density",
                                                "automated_share",
                                                "road_limit_kmh",
                                                "warm_up_s",
                                                "horizon_s",
                                                "step_length_s",
                                                "time_to_teleport_s",
                                                "idm",
                                                "traffic_kinds",
                                                "emergency_kinds",
                                                "siren_compliance",
                                                "road_speed_factor",
                                                "friction",
                                                "pedestrians_per_hour"};

scenario::Options read_overrides(const toml::table& table, const std::string& file, Problems& problems) {
    scenario::Options options;
    StrictTable reader(table, "overrides", file, problems);
    reader.word<scenario::Variant>("variant", options.variant);
    reader.number("density", options.density);
    reader.number("automated_share", options.automated_share);
    reader.number("road_limit_kmh", options.road_limit_kmh);
    reader.number("warm_up_s", options.warm_up_s);
    reader.number("horizon_s", options.horizon_s);
    reader.number("step_length_s", options.step_length_s);
    reader.number("time_to_teleport_s", options.time_to_teleport_s);
    reader.word<scenario::IdmPreset>("idm", options.idm);
    reader.number("siren_compliance", options.siren_compliance);
    reader.number("road_speed_factor", options.road_speed_factor);
    reader.number("friction", options.friction);
    reader.number("pedestrians_per_hour", options.pedestrians);
    reader.text("traffic_kinds", options.traffic_kinds);
    reader.text("emergency_kinds", options.emergency_kinds);
    reader.finish();
    return options;
}

/// The overrides under a combination of factors.
scenario::Options options_with(const toml::table& overrides, const detail::Assignment& assignment,
                               const std::string& file, Problems& problems) {
    toml::table changed = overrides;
    core::Settings settings;
    for (const auto& [factor, value] : assignment) {
        if (std::ranges::find(override_keys, factor->key) == override_keys.end()) {
            settings[factor->key] = value->toml;
        } else {
            const toml::table parsed = toml::parse("value = " + value->toml);
            parsed.get("value")->visit(
                [&, key = factor->key](const auto& node) { changed.insert_or_assign(key, node); });
        }
    }
    scenario::Options options = read_overrides(changed, file, problems);
    options.settings = settings;
    return options;
}

/// Settings and model of a condition; its failure and predictor are known.
void read_settings(StrictTable& reader, const std::filesystem::path& file, Problems& problems,
                   experiment::ConditionSpec& condition) {
    if (const toml::table* const table = reader.table("set")) {
        for (const auto& [name, value] : detail::read_settings(*table, file.string(), problems))
            experiment::set(condition, name, value);
    }
    std::string model;
    reader.text("model", model);
    if (model.empty()) return;
    try {
        experiment::set_model(condition, (file.parent_path() / model).string(), reader.where("model"));
    } catch (const core::InputError& error) {
        append(problems, error);
    }
}

/// A list of texts, where one may stand alone.
void read_policies(StrictTable& reader, const toml::table& table, std::vector<std::string>& policies) {
    if (table.contains("policy") && table.get("policy")->is_string()) {
        reader.text("policy", policies.emplace_back());
    } else {
        reader.texts("policy", policies);
    }
    if (!reader.has("parts")) return;
    std::vector<std::string> ignored;
    reader.texts("parts", ignored);
    reader.problem("parts", "is now called policy", "policy = [\"corridor\"]", "Rename the key");
}

experiment::ConditionSpec read_condition(const toml::table& table, const std::filesystem::path& path,
                                         Problems& problems) {
    experiment::ConditionSpec condition;
    const std::string file = path.string();
    StrictTable reader(table, "condition", file, problems);
    reader.text("name", condition.name);
    reader.text("failure", condition.failure);
    reader.text("predictor", condition.predictor);
    read_policies(reader, table, condition.policies);
    reader.word<experiment::TrafficModel>("traffic_model", condition.traffic_model);
    reader.word<traffic::SafetyChecks>("safety_checks", condition.safety_checks);
    reader.word<traffic::BlueLight>("bluelight", condition.bluelight);
    read_settings(reader, path, problems, condition);
    reader.finish();
    if (condition.name.empty()) reader.problem("name", "is missing", "a name", "Name the condition");
    return condition;
}

void read_conditions(StrictTable& root, const std::filesystem::path& file, Problems& problems,
                     StudyConfig& config) {
    std::vector<std::string> names;
    root.texts("conditions", names);
    for (const std::string& name : names) {
        try {
            config.conditions.push_back(experiment::built_in_condition(name, root.where("conditions")));
        } catch (const core::InputError& error) {
            append(problems, error);
        }
    }
    for (const toml::table* table : root.tables("condition"))
        config.conditions.push_back(read_condition(*table, file, problems));
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

struct Reading {
    const std::filesystem::path& file;
    const detail::Factors& factors;
};

/// One of `[[scenario]]`: a scenario under a name of its own, with overrides beside those of the study.
// NOLINTNEXTLINE(readability-function-size): a table, what it is read with, and two lists to fill
void add_own_scenario(const toml::table& table, toml::table overrides, const detail::Assignment& assignment,
                      const Reading& reading, Problems& problems, StudyConfig& config) {
    const std::string file = reading.file.string();
    std::string from;
    std::string name;
    toml::table source;
    for (const auto& [key, node] : table) {
        const bool is_own = key == "from" || key == "name";
        node.visit([&, key = key](const auto& value) {
            (is_own ? source : overrides).insert_or_assign(key, value);
        });
    }
    StrictTable reader(source, "scenario", file, problems);
    reader.text("from", from);
    reader.text("name", name);
    reader.finish();
    if (from.empty() || name.empty()) {
        reader.problem(from.empty() ? "from" : "name", "is missing", "from and name",
                       "Say which scenario it is, and how it is called here");
        return;
    }
    const std::size_t before = config.scenarios.size();
    add_scenario(resolve(from, reading.file), options_with(overrides, assignment, file, problems), "",
                 problems, config);
    if (config.scenarios.size() > before)
        config.scenarios.back().name = name + detail::name_of(assignment, reading.factors);
}

void read_scenarios(StrictTable& root, const std::filesystem::path& file, const detail::Factors& factors,
                    Problems& problems, StudyConfig& config) {
    std::vector<std::string> names;
    root.texts("scenarios", names);
    const std::vector<const toml::table*> own = root.tables("scenario");
    if (names.empty() && own.empty())
        root.problem("scenarios", "the study has no scenario", "names of `clearway list`, folders or files",
                     "");
    const toml::table* const given = root.table("overrides");
    const toml::table overrides = given == nullptr ? toml::table{} : *given;
    for (const detail::Assignment& assignment : detail::combinations(factors, detail::Subject::scenarios)) {
        const scenario::Options options = options_with(overrides, assignment, file.string(), problems);
        for (const std::string& name : names)
            add_scenario(resolve(name, file), options, detail::name_of(assignment, factors), problems,
                         config);
        for (const toml::table* table : own)
            add_own_scenario(*table, overrides, assignment, {file, factors}, problems, config);
        for (const scenario::ScenarioConfig& scenario : config.scenarios) {
            if (!assignment.empty())
                config.scenario_factors.try_emplace(scenario.name, detail::factors_of(assignment));
        }
    }
}

/// One condition for each combination that differs in what the condition has.
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

/// Puts in the place of each condition that has a policy, a predictor or failing sensors one for each
/// combination of the factors.
void vary_conditions(const detail::Factors& factors, Problems& problems, StudyConfig& config) {
    const std::vector<detail::Assignment> all = detail::combinations(factors, detail::Subject::conditions);
    if (all.size() == 1 && all.front().empty()) return;
    if (std::ranges::none_of(config.conditions, detail::is_varied)) {
        problems.push_back({"factors", "no condition has failures, a predictor or a policy to vary",
                            "a condition beside baseline and solo", "Add one to the conditions"});
        return;
    }
    std::vector<experiment::ConditionSpec> varied;
    std::set<const detail::Factor*> used;
    for (const experiment::ConditionSpec& condition : config.conditions) {
        if (!detail::is_varied(condition)) {
            varied.push_back(condition);
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

std::vector<std::string> metric_names() {
    std::vector<std::string> names;
    core::for_each_field<metrics::RunMetrics>([&](const auto& field) { names.emplace_back(field.name); });
    return names;
}

void read_precision(StrictTable& root, const std::string& file, Problems& problems, StudyConfig& config) {
    const toml::table* const table = root.table("precision");
    if (table == nullptr) return;
    results::PrecisionTarget& target = config.precision.emplace();
    target.at_most = most_replications;
    StrictTable reader(*table, "precision", file, problems);
    reader.text("metric", target.metric);
    std::optional<double> half_width;
    reader.number("half_width", half_width);
    reader.integer<std::uint32_t>("at_most", least_replications, most_replications, target.at_most);
    reader.finish();
    const std::vector<std::string> names = metric_names();
    if (std::ranges::find(names, target.metric) == names.end()) {
        const std::string near = core::nearest(target.metric, names);
        reader.problem("metric", fmt::format("'{}' is no metric", target.metric), "columns of runs.csv",
                       near.empty() ? "" : fmt::format("Did you mean '{}'?", near));
    }
    if (!half_width || !(*half_width > 0.0) || !std::isfinite(*half_width))
        reader.problem("half_width",
                       half_width ? fmt::format("{} is not positive", *half_width) : "is missing",
                       "a number above 0, in the metric's unit", "");
    target.half_width = half_width.value_or(0.0);
    if (root.has("replications"))
        root.problem("replications", "is given beside [precision]", "either of them", "Remove one");
    config.replications = least_replications;
}

/// Leaves of `all` those that are named, in their old order; unknown names are problems.
template <class Element>
void keep_named(StrictTable& quick, const char* key, std::vector<Element>& all) {
    std::vector<std::string> kept;
    quick.texts(key, kept);
    if (kept.empty()) return;
    std::vector<std::string> names;
    for (const Element& element : all)
        names.push_back(element.name);
    for (const std::string& name : kept) {
        if (std::ranges::find(names, name) != names.end()) continue;
        const std::string near = core::nearest(name, names);
        quick.problem(key, fmt::format("'{}' is none of the study's", name),
                      fmt::format("{}", fmt::join(names, ", ")),
                      near.empty() ? "" : fmt::format("Did you mean '{}'?", near));
    }
    std::erase_if(
        all, [&](const Element& element) { return std::ranges::find(kept, element.name) == kept.end(); });
}

/// Reads [quick] in any case, so that its faults show early; applies it where it is wanted.
void read_quick(StrictTable& root, const std::string& file, Extent extent, Problems& problems,
                StudyConfig& config) {
    const toml::table* table = root.table("quick");
    if (table == nullptr) {
        if (extent == Extent::quick)
            root.problem("quick", "the file does not say what --quick leaves out", "a table [quick]",
                         "Add one, or run the whole study");
        return;
    }
    StudyConfig quick = config;
    quick.name += "-quick";
    StrictTable reader(*table, "quick", file, problems);
    reader.integer<std::uint32_t>("replications", 1, most_replications, quick.replications);
    keep_named(reader, "scenarios", quick.scenarios);
    keep_named(reader, "conditions", quick.conditions);
    reader.finish();
    if (extent == Extent::quick) config = std::move(quick);
}

}  // namespace

StudyConfig dissertation_study(std::uint32_t replications, std::uint64_t seed,
                               const scenario::Options& options) {
    StudyConfig config;
    config.name = "dissertation";
    config.seed = seed;
    config.replications = replications;
    Problems problems;
    add_scenario("merge", options, "", problems, config);
    // Where nobody waits, TABLE II is all zeros; in the dense merge there is something to gain.
    if (options.variant == scenario::Variant::standard) {
        scenario::Options dense = options;
        dense.variant = scenario::Variant::dense;
        add_scenario("merge", dense, "_dense", problems, config);
    }
    for (const char* name : {"intersection", "city"})
        add_scenario(name, options, "", problems, config);
    if (!problems.empty()) throw core::InputError(problems);
    for (const char* name : {"baseline", "graph_simulation", "graph_graphsage", "graph_graphsage_improved",
                             "graph_graphsage_as_published", "b10_no_repair", "b10_dead_reckoning", "solo"})
        config.conditions.push_back(experiment::built_in_condition(name, "conditions"));
    return config;
}

StudyConfig read_study(const std::filesystem::path& file, Extent extent) {
    const std::string name = file.string();
    const toml::table table = core::parse_toml(core::read_file(file), name);
    Problems problems;
    StrictTable root(table, "", name, problems);
    StudyConfig config;
    config.name = file.stem().string();
    root.text("name", config.name);
    root.integer<std::uint64_t>("seed", 0, std::numeric_limits<std::int64_t>::max(), config.seed);
    root.integer<std::uint32_t>("replications", 1, most_replications, config.replications);
    read_precision(root, name, problems, config);
    const toml::table* const factor_table = root.table("factors");
    detail::Factors factors;
    if (factor_table != nullptr) factors = detail::read_factors(*factor_table, name, problems);
    read_scenarios(root, file, factors, problems, config);
    read_conditions(root, file, problems, config);
    read_quick(root, name, extent, problems, config);
    vary_conditions(factors, problems, config);
    root.finish();
    if (!problems.empty()) throw core::InputError(problems);
    return config;
}

}  // namespace clearway::study
