#include "results/detail/log_tables.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/json.hpp"
#include "metrics/signal_measures.hpp"
#include "results/detail/signal_event_files.hpp"

namespace clearway::results::detail {
namespace {

std::vector<std::string> event_rows(const std::vector<metrics::SignalEvent>& events) {
    return core::texts_of(events,
                          [](const metrics::SignalEvent& event) { return signal_event_cells(event); });
}

std::string measures_header() {
    std::string line;
    core::append_header<metrics::SignalMeasures>(line);
    return line.substr(1);
}

std::vector<std::string> measures_rows(const std::vector<metrics::SignalEvent>& events) {
    std::vector<std::string> rows;
    for (const metrics::SignalMeasures& measures : metrics::signal_measures(events)) {
        std::string line;
        core::append_cells(line, measures);
        rows.push_back(line.substr(1));
    }
    return rows;
}

std::vector<std::string> cells_of(const std::string& line) {
    core::CsvReader reader(line);
    reader.next();
    return {reader.cells().begin(), reader.cells().end()};
}

/// A number where the whole cell is one, null for an empty cell.
core::Json json_of(const std::string& cell) {
    if (cell.empty()) return nullptr;
    const core::Json parsed = core::Json::parse(cell, nullptr, false);
    return parsed.is_number() ? parsed : core::Json(cell);
}

/// Texts among the columns; others hold numbers.
bool is_text(std::string_view column) {
    constexpr std::array<std::string_view, 6> texts = {"scenario", "condition", "signal",
                                                       "links",    "vehicle",   "name"};
    return core::contains(texts, column);
}

}  // namespace

std::span<const LogTable> log_tables() {
    static const std::array tables{LogTable{"signal_events", signal_event_header, event_rows},
                                   LogTable{"signals", measures_header, measures_rows}};
    return tables;
}

void print_log_table(const Store& store, const LogTable& table, TableFormat format, std::ostream& out) {
    const std::string header = "scenario,condition,replication," + table.header();
    const std::vector<std::string> columns = cells_of(header);
    bool any_log = false;
    const char* separator = "";
    store.manifest().for_each_run([&](const experiment::RunKey& key) {
        const auto events = store.read_signal_events(key);
        if (!events) return;
        if (!any_log) out << (format == TableFormat::csv ? header + '\n' : "[");
        any_log = true;
        const std::string start = fmt::format("{},{},{},", core::csv_text(key.scenario),
                                              core::csv_text(key.condition), key.replication);
        for (const std::string& row : table.rows(*events)) {
            if (format == TableFormat::csv) {
                out << start << row << '\n';
                continue;
            }
            const std::vector<std::string> cells = cells_of(start + row);
            core::Json object = core::Json::object();
            for (std::size_t column = 0; column < columns.size(); ++column)
                object[columns[column]] =
                    is_text(columns[column]) ? core::Json(cells.at(column)) : json_of(cells.at(column));
            out << separator << "\n" << object.dump(-1, ' ', false, core::Json::error_handler_t::replace);
            separator = ",";
        }
    });
    if (!any_log)
        throw core::InputError({store.folder().string(),
                                fmt::format("holds no event logs for `{}`", table.name),
                                "a study with a policy that asks for greens, made by this version",
                                "Repeat its command (command.txt) with another --out"});
    if (format == TableFormat::json) out << "\n]\n";
}

}  // namespace clearway::results::detail
