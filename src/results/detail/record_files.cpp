#include "results/detail/record_files.hpp"

#include <string_view>

#include <fmt/format.h>

#include "core/csv.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "experiment/condition_json.hpp"
#include "results/detail/signal_event_files.hpp"
#include "results/detail/traffic_files.hpp"

namespace clearway::results::detail {
namespace {

void write_key(core::Json& object, const experiment::RunKey& key) {
    object["scenario"] = key.scenario;
    object["condition"] = key.condition;
    object["replication"] = key.replication;
}

void read_key(core::ObjectReader& reader, experiment::RunKey& key) {
    reader.read("scenario", key.scenario);
    reader.read("condition", key.condition);
    reader.read("replication", key.replication);
}

/// Holds the hash of everything else in `run.json`.
constexpr const char* hash_key = "hash";

/// The text of `run.json` without its last entry, the hash: the text which was hashed. The entry is cut out,
/// because writing the parsed object again would take longer than the rest of reading.
std::string without_hash(const std::string& text) {
    const std::string before = fmt::format(",\n  \"{}\": \"", hash_key);
    const std::size_t at = text.rfind(before);
    return at == std::string::npos ? text : text.substr(0, at) + "\n}\n";
}

/// First column after the four words at the start of a row.
constexpr std::size_t first_number = 4;

metrics::VehicleRow vehicle_from(const std::vector<std::string_view>& cells) {
    if (cells.size() < first_number) throw std::runtime_error("is too short");
    metrics::VehicleRow row;
    std::size_t column = first_number;
    core::for_each_field<metrics::VehicleRow>([&](const auto& field) {
        if (column == cells.size()) throw std::runtime_error("is too short");
        core::read_cell(cells[column++], row.*field.member);
    });
    if (column != cells.size()) throw std::runtime_error("is too long");
    const auto vehicle_class = core::value_from<traffic::VehicleClass>(cells[1]);
    const auto kind = core::value_from<traffic::VehicleKind>(cells[2]);
    const auto outcome = core::value_from<metrics::VehicleOutcome>(cells[3]);
    if (!vehicle_class || !kind || !outcome)
        throw std::runtime_error("has an unknown class, kind or outcome");
    row.id = cells[0];
    row.key = core::vehicle_key(row.id);
    row.vehicle_class = *vehicle_class;
    row.kind = *kind;
    row.outcome = *outcome;
    return row;
}

core::Json leases_to_json(const std::vector<metrics::LeaseRow>& leases) {
    core::Json rows = core::Json::array();
    for (const metrics::LeaseRow& lease : leases) {
        core::Json row;
        row["policy"] = lease.policy;
        row["action"] = name(lease.action);
        core::write_fields(row, lease);
        row["refused"] = lease.refused_words();
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<metrics::LeaseRow> leases_from_json(const core::Json& rows, const std::string& where,
                                                std::vector<core::Problem>& problems) {
    std::vector<metrics::LeaseRow> leases;
    for (const core::Json& row : rows) {
        metrics::LeaseRow& lease = leases.emplace_back();
        core::ObjectReader reader(row, where + ": leases", problems);
        reader.read("policy", lease.policy);
        reader.read("action", lease.action);
        reader.read_fields(lease);
        std::map<std::string, std::uint64_t> refused;
        reader.read("refused", refused);
        for (const auto& [word, count] : refused) {
            if (const auto reason = core::value_from<traffic::Refusal>(word))
                lease.refused.emplace(*reason, count);
            else
                reader.problem("refused", fmt::format("\"{}\" is no reason", word));
        }
    }
    return leases;
}

}  // namespace

std::string runs_hash(const Store& store) {
    std::string text;
    store.manifest().for_each_run([&](const experiment::RunKey& key) {
        text += experiment::to_text(key);
        if (store.complete(key)) {
            text += " ok " + core::content_hash(core::read_file(store.run_folder(key) / "run.json"));
        } else if (const auto error = store.read_error(key)) {
            text += fmt::format(" {} {}", name(error->cause), error->message);
        }
        text += '\n';
    });
    return core::content_hash(text);
}

std::string run_to_json(const RunRecord& record, const std::string& vehicles_csv, const std::string& build) {
    core::Json object;
    write_key(object, record.key);
    object["build"] = build;
    object["condition_spec"] = to_json(record.condition);
    core::write_fields(object["provenance"], record.provenance);
    core::write_fields(object["metrics"], record.metrics);
    object["leases"] = leases_to_json(record.leases);
    object["vehicles_hash"] = core::content_hash(vehicles_csv);
    if (record.signal_events)
        object[signal_events_hash_key] = core::content_hash(signal_events_to_csv(*record.signal_events));
    if (core::Json traffic = traffic_to_json(record.traffic); !traffic.is_null())
        object["traffic"] = std::move(traffic);
    object[hash_key] = core::content_hash(core::to_text(object));
    return core::to_text(object);
}

std::string run_named(const std::string& run_json, const experiment::RunKey& key,
                      const experiment::ConditionSpec& condition) {
    core::Json object = core::parse_object(run_json, to_text(key));
    write_key(object, key);
    object["condition_spec"] = to_json(condition);
    object.erase(hash_key);
    object[hash_key] = core::content_hash(core::to_text(object));
    return core::to_text(object);
}

RunRecord run_from_json(const std::string& text, const std::string& vehicles_csv, const std::string& where) {
    const core::Json object = core::parse_object(text, where);
    RunRecord record;
    std::string hash;
    std::string vehicles_hash;
    std::vector<core::Problem> problems;
    core::ObjectReader reader(object, where, problems);
    reader.read(hash_key, hash);
    read_key(reader, record.key);
    reader.read("build", record.build);
    record.condition = experiment::condition_from(reader.child("condition_spec", core::Json::value_t::object),
                                                  where, problems);
    core::ObjectReader(reader.child("provenance", core::Json::value_t::object), where + ": provenance",
                       problems)
        .read_fields(record.provenance);
    core::ObjectReader(reader.child("metrics", core::Json::value_t::object), where + ": metrics", problems)
        .read_fields(record.metrics);
    record.leases = leases_from_json(reader.child("leases", core::Json::value_t::array), where, problems);
    reader.read("vehicles_hash", vehicles_hash);
    if (problems.empty() && hash != core::content_hash(without_hash(text)))
        reader.problem(hash_key, "does not fit the rest");
    if (problems.empty() && vehicles_hash != core::content_hash(vehicles_csv))
        reader.problem("vehicles_hash", "does not fit vehicles.csv");
    if (!problems.empty()) throw core::InputError(problems);
    record.traffic = traffic_from_json(object, where);
    return record;
}

std::string vehicle_header() {
    std::string line = "id,class,kind,outcome";
    core::append_header<metrics::VehicleRow>(line);
    return line;
}

std::string vehicle_cells(const metrics::VehicleRow& vehicle) {
    std::string line =
        fmt::format("{},{},{},{}", core::csv_text(vehicle.id), traffic::name(vehicle.vehicle_class),
                    traffic::name(vehicle.kind), metrics::name(vehicle.outcome));
    core::append_cells(line, vehicle);
    return line;
}

std::string vehicles_to_csv(const std::vector<metrics::VehicleRow>& vehicles) {
    std::string text = vehicle_header() + "\n";
    for (const metrics::VehicleRow& vehicle : vehicles)
        text += vehicle_cells(vehicle) + "\n";
    return text;
}

std::vector<metrics::VehicleRow> vehicles_from_csv(const std::string& text, const std::string& where,
                                                   VehicleRows rows) {
    std::vector<metrics::VehicleRow> vehicles;
    if (!text.starts_with(vehicle_header() + "\n"))
        throw core::InputError({where + ":1", "is not the header of this version", vehicle_header(), ""});
    std::size_t line = 1;
    try {
        core::CsvReader reader(text);
        reader.next();
        for (; reader.next(); ++line) {
            const bool wanted = rows == VehicleRows::all || reader.cells().size() <= 1 ||
                                reader.cells()[1] == traffic::name(traffic::VehicleClass::emergency);
            if (wanted) vehicles.push_back(vehicle_from(reader.cells()));
        }
    } catch (const std::runtime_error& error) {
        throw core::InputError({fmt::format("{}:{}", where, line + 1), error.what(), "", ""});
    }
    return vehicles;
}

std::string timing_to_json(const RunTiming& timing) {
    core::Json object;
    core::write_fields(object, timing);
    object["processor_s"] = timing.processor_s;
    const PhaseTimes& phases = timing.phases;
    object["phases"] = {{"reading_s", phases.reading_s},       {"sensing_s", phases.sensing_s},
                        {"prediction_s", phases.prediction_s}, {"policy_s", phases.policy_s},
                        {"actuation_s", phases.actuation_s},   {"recording_s", phases.recording_s}};
    object["steps"] = timing.steps;
    object["vehicle_steps"] = timing.vehicle_steps;
    object["made_at"] = timing.made_at;
    return core::to_text(object);
}

RunTiming timing_from_json(const std::string& text, const std::string& where) {
    const core::Json object = core::parse_object(text, where);
    RunTiming timing;
    std::vector<core::Problem> problems;
    core::ObjectReader reader(object, where, problems);
    reader.read_fields(timing);
    reader.read("made_at", timing.made_at);
    if (!problems.empty()) throw core::InputError(problems);
    return timing;
}

std::string error_to_json(const RunError& error) {
    core::Json object;
    write_key(object, error.key);
    object["cause"] = name(error.cause);
    object["message"] = error.message;
    object["exit_code"] = error.exit_code;
    object["signal"] = error.signal;
    object["attempts"] = error.attempts;
    object["log_tail"] = error.log_tail;
    object["command"] = error.command;
    return core::to_text(object);
}

RunError error_from_json(const std::string& text, const std::string& where) {
    const core::Json object = core::parse_object(text, where);
    RunError error;
    std::vector<core::Problem> problems;
    core::ObjectReader reader(object, where, problems);
    read_key(reader, error.key);
    reader.read_name("cause", error.cause, core::value_from<ErrorCause>);
    reader.read("message", error.message);
    reader.read("exit_code", error.exit_code);
    reader.read("signal", error.signal);
    reader.read("attempts", error.attempts);
    reader.read("log_tail", error.log_tail);
    reader.read("command", error.command);
    if (!problems.empty()) throw core::InputError(problems);
    return error;
}

}  // namespace clearway::results::detail
