#include "study/status.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/headline.hpp"
#include "analysis/summary.hpp"
#include "campaign/printout.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/verb.hpp"
#include "core/counted.hpp"
#include "core/progress.hpp"
#include "report/read_facts.hpp"
#include "study/merge.hpp"

namespace clearway::cli {
namespace {

using core::Json;
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

campaign::Table table_of(const std::vector<CellStatus>& cells, const core::Settings& titles) {
    campaign::Table table{"cells",
                          {{"scenario", "scenario"},
                           {"condition", ""},
                           {"", "condition"},
                           {"safety_checks", ""},
                           {"runs", "runs"},
                           {"complete_runs", "complete"},
                           {"failed_runs", "failed"}},
                          {}};
    for (const CellStatus& cell : cells) {
        const bool is_unsafe = cell.safety_checks == traffic::SafetyChecks::off;
        table.rows.push_back(
            {{cell.scenario, cell.condition, titles.at(cell.condition) + (is_unsafe ? " (!)" : ""),
              experiment::name(cell.safety_checks), cell.runs, cell.complete, cell.failed}});
    }
    return table;
}

std::string text_of(const StudyStatus& status, const std::string& headline) {
    std::string text;
    if (core::contains(status.cells, traffic::SafetyChecks::off, &CellStatus::safety_checks))
        text = "(!): the simulator's safety checks were off in this condition.\n";
    text += fmt::format("\n{}: {}", status.folder.string(), study::name(status.state));
    if (!status.holder.empty()) text += fmt::format(" ({})", status.holder);
    text += fmt::format("; {} of {} complete, {} failed", status.complete, core::counted(status.runs, "run"),
                        status.failed);
    if (status.time_left_s) text += ", " + core::clock_text(*status.time_left_s) + " left";
    return text + "\n" + (headline.empty() ? "" : headline + "\n");
}

campaign::Printout printout_of(const StudyStatus& status, const analysis::Headline* headline,
                               const core::Settings& titles) {
    return {{{"folder", status.folder.string()},
             {"state", study::name(status.state)},
             {"holder", status.holder.empty() ? Json(nullptr) : Json(status.holder)},
             {"runs", status.runs},
             {"complete_runs", status.complete},
             {"failed_runs", status.failed},
             {"time_left_s", core::to_json_value(status.time_left_s)},
             {"headline", headline == nullptr ? Json(nullptr) : json_of(*headline)}},
            {table_of(status.cells, titles)},
            text_of(status, headline == nullptr ? "" : headline->text())};
}

core::ExitCode print_status(const std::filesystem::path& path, Printing printing) {
    const std::vector<std::filesystem::path> folders = study::run_folders(path);
    std::vector<StudyStatus> parts;
    core::Settings titles;
    for (const std::filesystem::path& folder : folders) {
        parts.push_back(study::read_status(folder));
        titles.merge(report::titles_of(results::Store::open(folder)));
    }
    const StudyStatus status = sum_of(parts, path);
    // Conditions of a pair may be in different shards, so shards have no estimate of their own.
    std::optional<analysis::Headline> headline;
    if (folders.size() == 1) {
        const results::Store store = results::Store::open(folders.front());
        headline.emplace(store, report::titles_of(store));
        headline->refresh();
    }
    campaign::print(printout_of(status, headline ? &*headline : nullptr, titles), printing);
    return core::ExitCode::ok;
}

}  // namespace

Action configure_status(App& app) {
    struct StatusArguments {
        std::string folder;
        Printing printing = Printing::text;
    };
    const auto arguments = std::make_shared<StatusArguments>();
    app.add_option("folder", arguments->folder, "Run folder, or a folder with the shards of a study")
        .required()
        .option_text("DIR (required)");
    add_json_option(app, arguments->printing, "the state");
    return [arguments](const Invocation&) { return print_status(arguments->folder, arguments->printing); };
}

}  // namespace clearway::cli
