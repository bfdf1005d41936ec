#include "study/status.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/headline.hpp"
#include "analysis/summary.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/verb.hpp"
#include "core/progress.hpp"
#include "study/merge.hpp"

namespace clearway::cli {
namespace {

using Json = nlohmann::ordered_json;
using study::CellStatus;
using study::State;
using study::StudyStatus;

/// Adds the cells of a shard to those of the shards before it.
void add_cells(const std::vector<CellStatus>& shard, std::vector<CellStatus>& total) {
    if (total.empty()) {
        total = shard;
        return;
    }
    for (std::size_t i = 0; i < std::min(shard.size(), total.size()); ++i) {
        total[i].runs += shard[i].runs;
        total[i].complete += shard[i].complete;
        total[i].failed += shard[i].failed;
    }
}

/// Running if any shard is running, else stopped if any is, else failed if any is.
State worse(State left, State right) {
    for (const State state : {State::running, State::stopped, State::failed}) {
        if (left == state || right == state) return state;
    }
    return State::complete;
}

/// A study in one folder, or in several as shards.
StudyStatus sum_of(const std::vector<StudyStatus>& parts, const std::filesystem::path& folder) {
    if (parts.size() == 1) return parts.front();
    StudyStatus total;
    total.folder = folder;
    total.state = parts.front().state;
    for (const StudyStatus& part : parts) {
        total.state = worse(total.state, part.state);
        add_cells(part.cells, total.cells);
        total.runs += part.runs;
        total.complete += part.complete;
        total.failed += part.failed;
        if (!part.holder.empty()) total.holder += (total.holder.empty() ? "" : ", ") + part.holder;
        if (part.time_left_s)
            total.time_left_s = std::max(total.time_left_s.value_or(0.0), *part.time_left_s);
    }
    return total;
}

std::string text_of(const StudyStatus& status, const std::string& headline) {
    constexpr std::string_view mark = " (!)";
    std::size_t scenario_width = std::string_view("scenario").size();
    std::size_t condition_width = std::string_view("condition").size();
    for (const CellStatus& cell : status.cells) {
        scenario_width = std::max(scenario_width, cell.scenario.size());
        condition_width = std::max(condition_width, cell.condition.size() + mark.size());
    }
    std::string text = fmt::format("{:{}}  {:{}} {:>8} {:>9} {:>7}\n", "scenario", scenario_width,
                                   "condition", condition_width, "runs", "complete", "failed");
    bool any_unsafe = false;
    for (const CellStatus& cell : status.cells) {
        const bool is_unsafe = cell.safety_checks == traffic::SafetyChecks::off;
        any_unsafe = any_unsafe || is_unsafe;
        text += fmt::format("{:{}}  {:{}} {:8} {:9} {:7}\n", cell.scenario, scenario_width,
                            fmt::format("{}{}", cell.condition, is_unsafe ? mark : ""), condition_width,
                            cell.runs, cell.complete, cell.failed);
    }
    if (any_unsafe) text += "(!): the simulator's safety checks were off in this condition.\n";
    text += fmt::format("\n{}: {}", status.folder.string(), study::name(status.state));
    if (!status.holder.empty()) text += fmt::format(" ({})", status.holder);
    text += fmt::format("; {} of {} runs complete, {} failed", status.complete, status.runs, status.failed);
    if (status.time_left_s) text += ", " + core::clock_text(*status.time_left_s) + " left";
    return text + "\n" + (headline.empty() ? "" : headline + "\n");
}

Json json_of(const analysis::Headline& headline) {
    const auto estimate = headline.estimate();
    if (!estimate) return nullptr;
    const auto& interval = estimate->interval;
    return {{"metric", analysis::primary_metric},
            {"scenario", headline.scenario()},
            {"condition", headline.condition()},
            {"baseline", headline.baseline().empty() ? Json(nullptr) : Json(headline.baseline())},
            {"mean_s", estimate->mean},
            {"low_s", interval ? Json(interval->low) : Json(nullptr)},
            {"high_s", interval ? Json(interval->high) : Json(nullptr)},
            {"n", estimate->n}};
}

std::string json_of(const StudyStatus& status, const analysis::Headline* headline) {
    Json cells = Json::array();
    for (const CellStatus& cell : status.cells)
        cells.push_back({{"scenario", cell.scenario},
                         {"condition", cell.condition},
                         {"safety_checks", experiment::name(cell.safety_checks)},
                         {"runs", cell.runs},
                         {"complete_runs", cell.complete},
                         {"failed_runs", cell.failed}});
    const Json object = {{"folder", status.folder.string()},
                         {"state", study::name(status.state)},
                         {"holder", status.holder.empty() ? Json(nullptr) : Json(status.holder)},
                         {"runs", status.runs},
                         {"complete_runs", status.complete},
                         {"failed_runs", status.failed},
                         {"time_left_s", status.time_left_s ? Json(*status.time_left_s) : Json(nullptr)},
                         {"headline", headline == nullptr ? Json(nullptr) : json_of(*headline)},
                         {"cells", std::move(cells)}};
    return object.dump(2) + "\n";
}

core::ExitCode print_status(const std::filesystem::path& path, Printing printing) {
    const std::vector<std::filesystem::path> folders = study::run_folders(path);
    std::vector<StudyStatus> parts;
    for (const std::filesystem::path& folder : folders)
        parts.push_back(study::read_status(folder));
    const StudyStatus status = sum_of(parts, path);
    // Conditions of a pair may be in different shards, so shards have no estimate of their own.
    std::optional<analysis::Headline> headline;
    if (folders.size() == 1) {
        headline.emplace(results::Store::open(folders.front()));
        headline->refresh();
    }
    fmt::print("{}", printing == Printing::json ? json_of(status, headline ? &*headline : nullptr)
                                                : text_of(status, headline ? headline->text() : ""));
    return core::ExitCode::ok;
}

}  // namespace

Action configure_status(CLI::App& app) {
    struct Arguments {
        std::string folder;
        Printing printing = Printing::text;
    };
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("folder", arguments->folder, "Run folder, or a folder with the shards of a study")
        ->required()
        ->option_text("DIR (required)");
    add_json_option(app, arguments->printing, "the state");
    return [arguments](const Invocation&) { return print_status(arguments->folder, arguments->printing); };
}

}  // namespace clearway::cli
