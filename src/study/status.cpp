#include "study/status.hpp"

#include <algorithm>
#include <chrono>

#include "study/folder_lock.hpp"
#include "study/shard.hpp"
#include "study/work_estimate.hpp"

namespace clearway::study {
namespace {

/// The cells of a folder with their runs: those of the whole study, or of the folder's shard.
std::vector<CellStatus> cells_of(const results::Manifest& manifest, const Shard& shard) {
    std::vector<CellStatus> cells;
    for (const results::ScenarioEntry& scenario : manifest.scenarios) {
        for (const experiment::ConditionSpec& condition : manifest.conditions)
            cells.push_back({scenario.name, condition.name, condition.safety_checks, 0, 0, 0});
    }
    const std::vector<UnitPlace> units = units_of(manifest);
    for (std::size_t unit = 0; unit < units.size(); ++unit) {
        if (!has_unit(shard, unit)) continue;
        for (std::size_t i = 0; i < manifest.conditions.size(); ++i) {
            if (experiment::process_of(manifest.conditions[i]) == units[unit].process)
                ++cells[units[unit].scenario * manifest.conditions.size() + i].runs;
        }
    }
    return cells;
}

State state_of(const StudyStatus& status) {
    if (!status.holder.empty()) return State::running;
    if (status.complete + status.failed < status.runs) return State::stopped;
    return status.failed > 0 ? State::failed : State::complete;
}

/// Wall time of a run of a cell, from its first complete ones.
std::optional<double> run_s(const results::Store& store, const CellStatus& cell) {
    constexpr std::size_t sampled_runs = 5;
    double sum_s = 0.0;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < store.manifest().replications && count < sampled_runs; ++i) {
        const experiment::RunKey key{cell.scenario, cell.condition, i};
        const auto timing = store.complete(key) ? store.read_timing(key) : std::nullopt;
        if (!timing) continue;
        sum_s += timing->wall_s;
        ++count;
    }
    return count == 0 ? std::nullopt : std::optional(sum_s / static_cast<double>(count));
}

/// Estimated from the start time and the number of ended runs that the running process noted, and from what
/// runs of each cell cost; one without a complete run costs what the others do on average.
std::optional<double> time_left_s(const results::Store& store, const StudyStatus& status,
                                  const LockNote& note) {
    const double elapsed_s =
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count() -
        note.started_unix_s;
    const std::size_t ended = status.complete + status.failed;
    if (ended <= note.ended_runs || elapsed_s <= 0.0) return std::nullopt;
    WorkEstimate work(std::vector<WorkEstimate::Expected>(status.cells.size()));
    for (std::size_t row = 0; row < status.cells.size(); ++row) {
        const CellStatus& cell = status.cells[row];
        const std::optional<double> each_s = run_s(store, cell);
        for (std::size_t run = 0; run < cell.runs; ++run)
            work.add(row);
        for (std::size_t run = 0; each_s && run < cell.complete + cell.failed; ++run)
            work.end(row, *each_s);
    }
    const double since_s =
        work.done_s() * static_cast<double>(ended - note.ended_runs) / static_cast<double>(ended);
    if (since_s <= 0.0) return std::nullopt;
    return elapsed_s * (work.total_s() - work.done_s()) / since_s;
}

}  // namespace

std::string_view name(State state) {
    switch (state) {
        case State::running:
            return "running";
        case State::stopped:
            return "stopped";
        case State::complete:
            return "complete";
        case State::failed:
            return "failed";
    }
    return "";
}

StudyStatus read_status(const std::filesystem::path& folder) {
    const results::Store store = results::Store::open(folder);
    StudyStatus status;
    status.folder = folder;
    status.cells = cells_of(store.manifest(), shard_of(folder));
    const auto cell_of = [&](const experiment::RunKey& key) -> CellStatus& {
        return *std::ranges::find_if(status.cells, [&](const CellStatus& cell) {
            return cell.scenario == key.scenario && cell.condition == key.condition;
        });
    };
    for (const experiment::RunKey& key : store.complete_runs())
        ++cell_of(key).complete;
    for (const experiment::RunKey& key : store.failed_runs())
        ++cell_of(key).failed;
    for (const CellStatus& cell : status.cells) {
        status.runs += cell.runs;
        status.complete += cell.complete;
        status.failed += cell.failed;
    }
    const auto note = holder_of(folder);
    if (note) status.holder = note->holder;
    status.state = state_of(status);
    if (note) status.time_left_s = time_left_s(store, status, *note);
    return status;
}

}  // namespace clearway::study
