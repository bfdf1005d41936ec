#include "study/status.hpp"

#include <algorithm>
#include <chrono>

#include "study/folder_lock.hpp"
#include "study/shard.hpp"

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
            if (manifest.conditions[i].traffic_model == units[unit].traffic_model)
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

/// Estimated from the start time and the number of ended runs that the running process noted.
std::optional<double> time_left_s(const StudyStatus& status, const LockNote& note) {
    const double elapsed_s =
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count() -
        note.started_unix_s;
    const std::size_t ended = status.complete + status.failed;
    if (ended <= note.ended_runs || elapsed_s <= 0.0) return std::nullopt;
    const double each_s = elapsed_s / static_cast<double>(ended - note.ended_runs);
    return each_s * static_cast<double>(status.runs - std::min(status.runs, ended));
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
    if (note) status.time_left_s = time_left_s(status, *note);
    return status;
}

}  // namespace clearway::study
