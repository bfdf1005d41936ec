#include "cli/plan_text.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/common_options.hpp"
#include "core/progress.hpp"
#include "results/store.hpp"

namespace clearway::cli {
namespace {

/// One row of the plan: a condition in a scenario.
struct Cell {
    std::string scenario;
    const results::ConditionSpec* condition = nullptr;
    std::size_t runs = 0;
    std::size_t complete = 0;
    std::optional<double> run_s;  ///< Wall time of one run, estimated. Nothing where nobody can tell.
};

/// Wall time of a vehicle on the road for one step, SUMO and coupling. From the project's measurements: 3.1
/// to 11.9 us for the bare step on two shared cores, a tenth to a quarter more for the coupling.
constexpr double vehicle_step_s = 10e-6;
/// Mean time on the road, s. Assumed: between the merge (80 s) and the city (200 s).
constexpr double mean_trip_s = 120.0;
/// Loading, warm-up and forking of a run, s. Assumed: from runs of the sparse scenarios.
constexpr double overhead_s = 0.2;

/// From counts, step length and the costs above; nothing for measured demand, whose size is in its files.
std::optional<double> estimated_run_s(const scenario::ScenarioConfig& config, results::Engine engine) {
    if (config.demand_kind() == scenario::DemandKind::measured) return std::nullopt;
    const scenario::Demand& demand = config.demand;
    const double others =
        engine == results::Engine::solo ? 0.0 : demand.density * (demand.human + demand.automated);
    const double vehicles = others + demand.emergency + static_cast<double>(config.emergency_trips.size());
    return overhead_s + vehicles * mean_trip_s / config.time.step_length_s * vehicle_step_s;
}

/// The folder's store when it holds this very study.
std::optional<results::Store> existing_store(const study::Plan& plan, const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / "manifest.json")) return std::nullopt;
    results::Store store = results::Store::open(folder);
    if (results::manifest_hash(store.manifest()) != results::manifest_hash(plan.manifest)) {
        return std::nullopt;
    }
    return store;
}

void count_complete(const results::Store& store, Cell& cell) {
    double total_s = 0.0;
    std::size_t timed = 0;
    for (std::uint32_t replication = 0; replication < cell.runs; ++replication) {
        const results::RunKey key{cell.scenario, cell.condition->name, replication};
        if (!store.complete(key)) continue;
        ++cell.complete;
        if (const std::optional<results::RunTiming> timing = store.read_timing(key)) {
            total_s += timing->wall_s;
            ++timed;
        }
    }
    if (timed > 0) cell.run_s = total_s / static_cast<double>(timed);
}

std::vector<Cell> cells_of(const study::Plan& plan, const std::filesystem::path& folder) {
    const std::optional<results::Store> store = existing_store(plan, folder);
    std::vector<Cell> cells;
    for (const scenario::ScenarioConfig& config : plan.scenarios) {
        for (const results::ConditionSpec& condition : plan.manifest.conditions) {
            Cell cell{.scenario = config.name,
                      .condition = &condition,
                      .runs = plan.manifest.replications,
                      .run_s = estimated_run_s(config, condition.engine)};
            if (store) count_complete(*store, cell);
            cells.push_back(cell);
        }
    }
    return cells;
}

/// Wall time of what is left, s; nothing when a cell's is unknown.
std::optional<double> time_left_s(const std::vector<Cell>& cells, unsigned workers) {
    double total_s = 0.0;
    for (const Cell& cell : cells) {
        if (cell.complete == cell.runs) continue;
        if (!cell.run_s) return std::nullopt;
        total_s += *cell.run_s * static_cast<double>(cell.runs - cell.complete);
    }
    const unsigned processes = workers > 0 ? workers : std::max(1U, std::thread::hardware_concurrency());
    return total_s / processes;
}

std::size_t complete_runs(const std::vector<Cell>& cells) {
    std::size_t complete = 0;
    for (const Cell& cell : cells) {
        complete += cell.complete;
    }
    return complete;
}

}  // namespace

std::string plan_text(const study::Plan& plan, const std::filesystem::path& folder, unsigned workers) {
    const std::vector<Cell> cells = cells_of(plan, folder);
    std::string text = fmt::format("{:14} {:24} {:9} {:>6} {:>9}  {}\n", "scenario", "condition", "engine",
                                   "runs", "complete", "failure, predictor, policy");
    for (const Cell& cell : cells) {
        const results::ConditionSpec& condition = *cell.condition;
        text +=
            fmt::format("{:14} {:24} {:9} {:6} {:9}  {}, {}, {}\n", cell.scenario, condition.name,
                        results::name(condition.engine), cell.runs, cell.complete, condition.failure,
                        condition.predictor, condition.parts.empty() ? "-" : joined(condition.parts, "+"));
    }
    const std::optional<double> left_s = time_left_s(cells, workers);
    text += fmt::format("\n{} runs in {} processes, {} complete in {}; ", plan.run_count(), plan.units.size(),
                        complete_runs(cells), folder.string());
    text += left_s ? fmt::format("about {} (h:m:s) for the rest\n", core::clock_text(*left_s))
                   : "time unknown: the size of measured demand stands in its files\n";
    return text;
}

std::string plan_json(const study::Plan& plan, const std::filesystem::path& folder, unsigned workers) {
    using Json = nlohmann::ordered_json;
    const std::vector<Cell> cells = cells_of(plan, folder);
    Json list = Json::array();
    for (const Cell& cell : cells) {
        list.push_back({{"scenario", cell.scenario},
                        {"condition", cell.condition->name},
                        {"engine", results::name(cell.condition->engine)},
                        {"failure", cell.condition->failure},
                        {"predictor", cell.condition->predictor},
                        {"policy", cell.condition->parts},
                        {"runs", cell.runs},
                        {"complete_runs", cell.complete},
                        {"estimated_run_s", cell.run_s ? Json(*cell.run_s) : Json(nullptr)}});
    }
    const std::optional<double> left_s = time_left_s(cells, workers);
    const Json plan_object = {{"study", plan.manifest.study},
                              {"folder", folder.string()},
                              {"study_seed", plan.manifest.study_seed},
                              {"replications", plan.manifest.replications},
                              {"runs", plan.run_count()},
                              {"complete_runs", complete_runs(cells)},
                              {"estimated_time_left_s", left_s ? Json(*left_s) : Json(nullptr)},
                              {"cells", std::move(list)}};
    return plan_object.dump(2) + "\n";
}

}  // namespace clearway::cli
