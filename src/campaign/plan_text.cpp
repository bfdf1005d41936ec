#include "campaign/plan_text.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "campaign/detail/run_cost.hpp"
#include "core/counted.hpp"
#include "core/error.hpp"
#include "core/supervisor.hpp"
#include "core/temporary_folder.hpp"
#include "core/terminal.hpp"
#include "experiment/code_parts.hpp"
#include "experiment/condition_titles.hpp"
#include "experiment/condition_words.hpp"
#include "experiment/loop_config.hpp"
#include "experiment/settings.hpp"
#include "report/read_facts.hpp"
#include "results/store.hpp"
#include "scenario/network.hpp"
#include "scenario/overrides.hpp"
#include "scenario/road_limits.hpp"
#include "scenario/site.hpp"
#include "study/reuse.hpp"
#include "study/side_files.hpp"

namespace clearway::campaign {
namespace {

/// One row of the plan: a condition in a scenario.
struct Cell {
    std::string scenario;
    std::string variant;  ///< `, dense`; empty: the standard one.
    experiment::ConditionSpec condition;
    std::size_t runs = 0;
    std::size_t complete = 0;
    std::size_t reused = 0;  ///< Not complete, and taken over from another run folder.
    RunCost cost;            ///< Of one run.
};

/// The store in `folder` if it holds this study with at most as many replications.
std::optional<results::Store> existing_store(const study::Plan& plan, const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / "manifest.json")) return std::nullopt;
    results::Store store = results::Store::open(folder);
    if (!results::continues(plan.manifest, store.manifest())) return std::nullopt;
    return store;
}

std::vector<Cell> cells_of(const study::Plan& plan, const std::filesystem::path& folder,
                           const std::filesystem::path& from = {}) {
    std::map<experiment::RunKey, std::string> reused;
    if (!from.empty()) reused = study::reusable_runs(plan.manifest, results::Store::open(from));
    const std::optional<results::Store> store = existing_store(plan, folder);
    const CostBook book(folder);
    std::vector<Cell> cells;
    std::map<std::pair<std::string, std::string>, std::size_t> rows;
    for (std::size_t row = 0; row < plan.scenarios.size(); ++row) {
        const scenario::ScenarioConfig& config = plan.scenarios[row];
        const std::string& hash = plan.manifest.scenarios[row].configuration_hash;
        const std::string& variant = plan.manifest.scenarios[row].variant;
        std::map<experiment::TrafficModel, RunCost> costs;
        for (const experiment::ConditionSpec& condition : plan.manifest.conditions) {
            const auto [cost, is_new] = costs.try_emplace(condition.traffic_model);
            if (is_new) cost->second = book.of(config, hash, condition.traffic_model);
            rows[{config.name, condition.name}] = cells.size();
            cells.push_back({.scenario = config.name,
                             .variant = variant.empty() ? "" : ", " + variant,
                             .condition = condition,
                             .cost = cost->second});
        }
    }
    for (const study::PlannedUnit& planned : plan.units) {
        for (const experiment::ConditionSpec& condition : planned.unit.conditions) {
            Cell& cell = cells[rows.at({planned.unit.scenario, condition.name})];
            ++cell.runs;
            const experiment::RunKey key{planned.unit.scenario, condition.name, planned.unit.replication};
            if (store && store->complete(key))
                ++cell.complete;
            else if (reused.contains(key))
                ++cell.reused;
        }
    }
    return cells;
}

/// What is left of a plan.
struct Rest {
    std::size_t complete = 0;
    std::size_t reused = 0;
    std::optional<double> wall_s = 0.0;  ///< Nothing when it is unknown for a cell.
    double disk_bytes = 0.0;
    CostBasis basis = CostBasis::measured;  ///< The weakest.
};

Rest rest_of(const std::vector<Cell>& cells, unsigned workers) {
    Rest rest;
    const auto processes = static_cast<double>(core::process_count(workers));
    for (const Cell& cell : cells) {
        rest.complete += cell.complete;
        rest.reused += cell.reused;
        const auto open = static_cast<double>(cell.runs - cell.complete - cell.reused);
        if (open == 0.0) continue;
        rest.disk_bytes += open * cell.cost.disk_bytes;
        // An empty road costs little, and no check times it.
        if (cell.condition.traffic_model != experiment::TrafficModel::free_flow)
            rest.basis = std::min(rest.basis, cell.cost.basis);
        if (rest.wall_s && cell.cost.wall_s) {
            *rest.wall_s += open * *cell.cost.wall_s / processes;
        } else {
            rest.wall_s = std::nullopt;
        }
    }
    return rest;
}

/// Whether choices are tried in copies of the run, whose cost no estimate knows.
bool drives_copies(const experiment::ConditionSpec& condition) {
    const experiment::LoopConfig loop = experiment::loop_config(condition);
    return loop.ways_tried > 0 || loop.holds_tried > 0 || loop.units_tried > 0;
}

std::string size_text(double bytes) {
    if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
    return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

/// `intersection: roads of 140 km/h`, a line for all scenarios that are alike.
std::string roads_text(const std::vector<scenario::ScenarioConfig>& scenarios) {
    std::map<std::string, std::vector<std::string>> alike;
    for (const scenario::ScenarioConfig& config : scenarios)
        alike[scenario::road_limits(config).words()].push_back(config.name);
    std::string text;
    for (const auto& [roads, names] : alike)
        if (!roads.empty())
            text += core::wrapped(fmt::format("{}: {}", core::listed(names), roads), 4) + "\n";
    return text;
}

std::string precision_text(const results::PrecisionTarget& target) {
    return fmt::format(
        "replications: those of this round; further rounds follow until {} is known to +- {:g}, with {} "
        "replications at most",
        target.metric, target.half_width, target.at_most);
}

/// What the study sets out to show, a line for each comparison.
std::string analysis_plan_text(const results::AnalysisPlan& plan, const core::Settings& titles) {
    std::string text =
        core::wrapped(
            fmt::format("plan: {}, paired; {}, any false finding with probability {:g} at most (Holm)",
                        plan.metric, core::counted(plan.comparisons.size(), "claim"), plan.alpha),
            4) +
        "\n";
    for (const results::PlannedComparison& one : plan.comparisons)
        text += core::wrapped(fmt::format("  {}: {} against {}{}, {}", one.name, titles.at(one.condition),
                                          titles.at(one.against),
                                          one.scenario.empty() ? "" : " in " + one.scenario, name(one.claim)),
                              4) +
                "\n";
    return text;
}

std::string policy_of(const experiment::ConditionSpec& condition) {
    std::vector<std::string> means;
    for (const std::string& word : condition.policies)
        means.push_back(experiment::part_called(word).value_or(word));
    if (condition.bluelight == traffic::BlueLight::on) means.emplace_back("bluelight");
    if (condition.rerouting_s > 0.0)
        means.push_back(fmt::format("rerouting every {:g} s{}", condition.rerouting_s,
                                    condition.rerouting_signal_penalty > 0.0
                                        ? fmt::format(", signals {:g}", condition.rerouting_signal_penalty)
                                        : ""));
    if (condition.dispatch != experiment::Dispatch::free_flow)
        means.push_back(fmt::format("dispatch {}", experiment::name(condition.dispatch)));
    const bool is_checked = condition.safety_checks == traffic::SafetyChecks::on;
    const std::string settings = experiment::settings_text(condition);
    return (means.empty() ? "-" : fmt::format("{}", fmt::join(means, "+"))) +
           (is_checked ? "" : ", safety checks off (!)") + (settings.empty() ? "" : ", " + settings);
}

Table table_of(const std::vector<Cell>& cells, const core::Settings& titles) {
    const bool all_standard = std::ranges::all_of(cells, [](const Cell& cell) {
        return cell.condition.traffic_model == experiment::TrafficModel::standard;
    });
    Table table{"cells",
                {{"scenario", ""},
                 {"", "scenario"},
                 {"condition", ""},
                 {"", "condition"},
                 {"traffic_model", all_standard ? "" : "traffic model"},
                 {"failure", ""},
                 {"settings", ""},
                 {"model", ""},
                 {"predictor", ""},
                 {"policy", ""},
                 {"safety_checks", ""},
                 {"runs", "runs"},
                 {"complete_runs", "complete"},
                 {"reused_runs", ""},
                 {"estimated_run_s", ""},
                 {"estimated_run_disk_bytes", ""},
                 {"estimate_measured", ""}},
                {}};
    for (const Cell& cell : cells) {
        const experiment::ConditionSpec& condition = cell.condition;
        Row row{{cell.scenario, cell.scenario + cell.variant, condition.name, titles.at(condition.name),
                 experiment::name(condition.traffic_model), condition.failure, condition.settings,
                 condition.model_file, condition.predictor, condition.policies,
                 experiment::name(condition.safety_checks), cell.runs, cell.complete, cell.reused,
                 core::to_json_value(cell.cost.wall_s), cell.cost.disk_bytes,
                 cell.cost.basis == CostBasis::measured}};
        row.below.push_back(fmt::format("failure {}, predictor {}, policy {}", condition.failure,
                                        condition.predictor, policy_of(condition)));
        if (std::string unsent = experiment::unsent_words(condition); !unsent.empty())
            row.below.push_back(std::move(unsent));
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace

Printout plan_printout(const study::Plan& plan, const RunOptions& options) {
    const std::filesystem::path& folder = options.folder;
    const std::vector<Cell> cells = cells_of(plan, folder, options.reused);
    const Rest rest = rest_of(cells, options.workers);
    const std::string head = fmt::format(
        "{}, {} in {}, {} complete in {}{}", core::counted(cells.size(), "cell"),
        core::counted(plan.run_count(), "run"),
        plan.units.size() == 1
            ? "1 process"
            : fmt::format("{} processes, {} at a time", plan.units.size(),
                          std::min<std::size_t>(plan.units.size(), core::process_count(options.workers))),
        rest.complete, folder.string(),
        options.reused.empty()
            ? ""
            : fmt::format(", {} taken over from {}", rest.reused, options.reused.string()));
    std::string text = "the rest: ";
    text += rest.wall_s ? fmt::format("about {}", clock_words(*rest.wall_s))
                        : "time unknown: the route files of measured demand cannot be read";
    text += fmt::format(", about {} on the disk ({}{})", size_text(rest.disk_bytes), words(rest.basis),
                        std::ranges::any_of(plan.manifest.conditions, drives_copies)
                            ? "; without the copies that it drives of runs"
                            : "");
    text = "\n" + core::wrapped(head, 4) + "\n" + core::wrapped(text, 4) + "\n";
    text += roads_text(plan.scenarios);
    for (const scenario::ScenarioConfig& config : plan.scenarios)
        if (const std::string density = scenario::density_words(config); !density.empty())
            text += core::wrapped(fmt::format("{}: {}", config.name, density), 4) + "\n";
    if (plan.manifest.precision) text += core::wrapped(precision_text(*plan.manifest.precision), 4) + "\n";
    const core::Settings titles = experiment::ConditionTitles(plan.titles).of(plan.manifest.conditions);
    if (plan.manifest.plan) text += analysis_plan_text(*plan.manifest.plan, titles);
    return {{{"study", plan.manifest.study},
             {"folder", folder.string()},
             {"study_hash", results::study_hash(plan.manifest)},
             {"study_seed", plan.manifest.study_seed},
             {"replications", plan.manifest.replications},
             {"runs", plan.run_count()},
             {"complete_runs", rest.complete},
             {"reused_runs", rest.reused},
             {"estimated_time_left_s", core::to_json_value(rest.wall_s)},
             {"estimated_disk_left_bytes", rest.disk_bytes}},
            {table_of(cells, titles)},
            text};
}

namespace {

/// Sites and counts lie on roads, which a plan does not read otherwise. Variants of a scenario share them.
void check_places(const study::StudyConfig& config) {
    std::set<std::filesystem::path> checked;
    std::vector<core::Problem> problems;
    for (const scenario::ScenarioConfig& scenario : config.scenarios) {
        const bool has_places = !scenario.emergency_sites.empty() || !scenario.demand.counts.empty();
        if (!has_places || !checked.insert(scenario.folder).second) continue;
        const core::TemporaryFolder folder;
        const scenario::BuiltNetwork built = scenario::build_network(scenario, folder.path());
        scenario::site_edges(scenario, built.network, problems);
        if (problems.empty()) study::check_counts(scenario, built.network);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

}  // namespace

core::ExitCode print_plan(study::StudyConfig config, const study::Shard& shard, RunOptions options) {
    config.replications = replications_so_far(config, options.folder);
    require_divisible(config, shard);
    study::Plan plan = plan_for(config, options);
    study::require_own_shard(options.folder, shard);
    study::require_ready(plan, options.folder);
    check_places(config);
    std::optional<core::InputError> refusal;
    try {
        results::Store::require_fits(options.folder, plan.manifest, plan.titles);
    } catch (const core::InputError& error) {
        refusal = error;  // the plan is wanted all the same
    }
    study::keep_shard(plan, shard);
    print(plan_printout(plan, options), options.publish.printing);
    if (refusal) throw core::InputError(*refusal);
    return core::ExitCode::ok;
}

std::optional<TimeLeft> estimated_time_left(const study::Plan& plan, const std::filesystem::path& folder,
                                            unsigned workers) {
    const Rest rest = rest_of(cells_of(plan, folder), workers);
    if (!rest.wall_s) return std::nullopt;
    return TimeLeft{*rest.wall_s, rest.basis};
}

}  // namespace clearway::campaign
