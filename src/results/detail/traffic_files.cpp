#include "results/detail/traffic_files.hpp"

#include <new>
#include <stdexcept>
#include <tuple>

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
template <class Row>
constexpr std::tuple<> words_of = {};
template <>
constexpr auto words_of<ApproachRow> = std::tuple(&ApproachRow::edge, &ApproachRow::vehicle_class);
template <>
constexpr auto words_of<JourneyRow> = std::tuple(&JourneyRow::vehicle, &JourneyRow::signal,
                                                 &JourneyRow::state);
template <>
constexpr auto words_of<EdgeTimeRow> = std::tuple(&EdgeTimeRow::vehicle, &EdgeTimeRow::edge);
template <>
constexpr auto words_of<ConsideredRow> = std::tuple(&ConsideredRow::vehicle, &ConsideredRow::edge);
template <>
constexpr auto words_of<SignalHoldRow> = std::tuple(&SignalHoldRow::signal);
template <>
constexpr auto words_of<LockRow> = std::tuple(&LockRow::edge, &LockRow::junction);

std::string cell_of(const std::string& word) {
    return core::csv_text(word);
}
std::string cell_of(traffic::VehicleClass word) {
    return std::string(traffic::name(word));
}

void read_word(std::string_view cell, std::string& word) {
    word = cell;
}
void read_word(std::string_view cell, traffic::VehicleClass& word) {
    const auto known = core::value_from<traffic::VehicleClass>(cell);
    if (!known) throw std::runtime_error(fmt::format("\"{}\" is not a class", cell));
    word = *known;
}

template <class Row>
std::string to_csv(const std::vector<Row>& rows, const char* words) {
    if (rows.empty()) return {};
    std::string head = words;
    core::append_header<Row>(head);
    std::string text = (head.starts_with(',') ? head.substr(1) : head) + "\n";
    for (const Row& row : rows) {
        std::string line;
        std::apply([&](auto... word) { ((line += "," + cell_of(row.*word)), ...); }, words_of<Row>);
        core::append_cells(line, row);
        text += line.substr(1) + "\n";
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
            std::size_t column = 0;
            const auto next = [&] { return reader.cells().at(column++); };
            std::apply([&](auto... word) { (read_word(next(), row.*word), ...); }, words_of<Row>);
            core::for_each_field<Row>([&](const auto& field) { core::read_cell(next(), row.*field.member); });
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
