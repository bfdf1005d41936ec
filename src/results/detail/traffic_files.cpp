#include "results/detail/traffic_files.hpp"

#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include "core/csv.hpp"

namespace clearway::results::detail {
namespace {

using metrics::ApproachRow;
using metrics::ConsideredRow;
using metrics::EdgeTimeRow;
using metrics::JourneyRow;
using metrics::LockRow;
using metrics::RecoveryRow;
using metrics::SignalHoldRow;

/// The words before the numbers of a row.
std::string words_of(const ApproachRow& row) {
    return fmt::format("{},{}", core::csv_text(row.edge), traffic::name(row.vehicle_class));
}
std::string words_of(const JourneyRow& row) {
    return fmt::format("{},{},{}", core::csv_text(row.vehicle), core::csv_text(row.signal),
                       core::csv_text(row.state));
}
std::string words_of(const EdgeTimeRow& row) {
    return fmt::format("{},{}", core::csv_text(row.vehicle), core::csv_text(row.edge));
}
std::string words_of(const ConsideredRow& row) {
    return fmt::format("{},{}", core::csv_text(row.vehicle), core::csv_text(row.edge));
}
std::string words_of(const SignalHoldRow& row) {
    return core::csv_text(row.signal);
}
std::string words_of(const LockRow& row) {
    return fmt::format("{},{}", core::csv_text(row.edge), core::csv_text(row.junction));
}

using Cells = std::vector<std::string_view>;

std::size_t read_words(const Cells& cells, ApproachRow& row) {
    const auto vehicle_class = core::value_from<traffic::VehicleClass>(cells.at(1));
    if (!vehicle_class) throw std::runtime_error(fmt::format("\"{}\" is not a class", cells[1]));
    row.edge = cells[0];
    row.vehicle_class = *vehicle_class;
    return 2;
}
std::size_t read_words(const Cells& cells, JourneyRow& row) {
    row.vehicle = cells.at(0);
    row.signal = cells.at(1);
    row.state = cells.at(2);
    return 3;
}
std::size_t read_words(const Cells& cells, EdgeTimeRow& row) {
    row.vehicle = cells.at(0);
    row.edge = cells.at(1);
    return 2;
}
std::size_t read_words(const Cells& cells, ConsideredRow& row) {
    row.vehicle = cells.at(0);
    row.edge = cells.at(1);
    return 2;
}
std::size_t read_words(const Cells& cells, SignalHoldRow& row) {
    row.signal = cells.at(0);
    return 1;
}
std::size_t read_words(const Cells& cells, LockRow& row) {
    row.edge = cells.at(0);
    row.junction = cells.at(1);
    return 2;
}
std::size_t read_words(const Cells&, RecoveryRow&) {
    return 0;
}

template <class Row>
std::string to_csv(const std::vector<Row>& rows, const char* words) {
    if (rows.empty()) return {};
    std::string head = words;
    core::append_header<Row>(head);
    std::string text = (head.starts_with(',') ? head.substr(1) : head) + "\n";
    for (const Row& row : rows) {
        std::string line;
        if constexpr (!std::is_same_v<Row, RecoveryRow>) line = words_of(row);
        core::append_cells(line, row);
        text += (line.starts_with(',') && *words == '\0' ? line.substr(1) : line) + "\n";
    }
    return text;
}

template <class Row>
std::vector<Row> from_csv(const core::Json& run, const char* name, const std::string& where) {
    const auto tables = run.find("traffic");
    if (tables == run.end()) return {};
    std::vector<Row> rows;
    std::size_t line = 1;
    try {
        core::CsvReader reader(tables->at(name).get_ref<const std::string&>());
        reader.next();
        for (; reader.next(); ++line) {
            Row row;
            std::size_t column = read_words(reader.cells(), row);
            core::for_each_field<Row>(
                [&](const auto& field) { core::read_cell(reader.cells().at(column++), row.*field.member); });
            rows.push_back(std::move(row));
        }
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw core::InputError(
            {fmt::format("{}: traffic.{}: line {}", where, name, line + 1), error.what(), "", ""});
    }
    return rows;
}

}  // namespace

core::Json traffic_to_json(const metrics::TrafficTables& tables) {
    if (tables == metrics::TrafficTables{}) return nullptr;
    core::Json object;
    object["approaches"] = to_csv(tables.approaches, "edge,class");
    object["recovery"] = to_csv(tables.recovery, "");
    object["journeys"] = to_csv(tables.journeys, "vehicle,signal,state");
    object["edge_times"] = to_csv(tables.edge_times, "vehicle,edge");
    object["holds"] = to_csv(tables.holds, "signal");
    object["locks"] = to_csv(tables.locks, "edge,junction");
    // Left out where it is empty, as in older run folders.
    if (!tables.considered.empty()) object["considered"] = to_csv(tables.considered, "vehicle,edge");
    return object;
}

metrics::TrafficTables traffic_from_json(const core::Json& run, const std::string& where) {
    metrics::TrafficTables tables;
    tables.approaches = from_csv<ApproachRow>(run, "approaches", where);
    tables.recovery = from_csv<RecoveryRow>(run, "recovery", where);
    return tables;
}

metrics::TrafficTables all_traffic_from_json(const core::Json& run, const std::string& where) {
    metrics::TrafficTables tables = traffic_from_json(run, where);
    tables.journeys = from_csv<JourneyRow>(run, "journeys", where);
    tables.edge_times = from_csv<EdgeTimeRow>(run, "edge_times", where);
    tables.holds = from_csv<SignalHoldRow>(run, "holds", where);
    tables.locks = from_csv<LockRow>(run, "locks", where);
    if (const auto written = run.find("traffic"); written != run.end() && written->contains("considered"))
        tables.considered = from_csv<ConsideredRow>(run, "considered", where);
    return tables;
}

}  // namespace clearway::results::detail
