#include <fmt/format.h>

#include "core/atomic_file.hpp"
#include "core/csv.hpp"
#include "core/running_hash.hpp"
#include "results/detail/database.hpp"
#include "results/detail/record_files.hpp"
#include "results/factor_columns.hpp"
#include "results/table_writer.hpp"

namespace clearway::results {
namespace {

using core::csv_text;

std::string key_cells(const experiment::RunKey& key) {
    return fmt::format("{},{},{}", csv_text(key.scenario), csv_text(key.condition), key.replication);
}

/// The lines of `runs.csv`, without newlines.
class RunLines {
  public:
    explicit RunLines(const Manifest& manifest) : factors_(manifest) {}

    std::string header() const {
        std::string line = "scenario,condition,replication,outcome,cause,safety_checks";
        for (const std::string& name : factors_.names())
            line += "," + csv_text(name);
        core::append_header<metrics::RunMetrics>(line);
        core::append_header<experiment::Provenance>(line);
        return line + ",clearway_build";
    }
    std::string of(const RunRecord& run) const {
        std::string line = fmt::format("{},ok,,{}{}", key_cells(run.key),
                                       experiment::name(run.condition.safety_checks), factor_cells(run.key));
        core::append_cells(line, run.metrics);
        core::append_cells(line, run.provenance);
        return line + "," + csv_text(run.build);
    }
    std::string of(const RunError& error) const {
        return without_numbers(error.key, "failed", name(error.cause));
    }
    std::string of_missing(const experiment::RunKey& key) const {
        return without_numbers(key, "missing", "");
    }

  private:
    std::string factor_cells(const experiment::RunKey& key) const {
        std::string cells;
        for (const std::string& value : factors_.values(key.scenario, key.condition))
            cells += "," + csv_text(value);
        return cells;
    }
    std::string without_numbers(const experiment::RunKey& key, std::string_view outcome,
                                std::string_view cause) const {
        std::string line = fmt::format("{},{},{},{}", key_cells(key), outcome, cause, factor_cells(key));
        core::append_empty_cells<metrics::RunMetrics>(line);
        core::append_empty_cells<experiment::Provenance>(line);
        return line + ",";
    }

    FactorColumns factors_;
};

void append_vehicles(const RunRecord& run, std::string& text) {
    const std::string key = key_cells(run.key);
    for (const metrics::VehicleRow& vehicle : run.vehicles)
        text += key + "," + detail::vehicle_cells(vehicle) + "\n";
}

std::string vehicles_header() {
    return "scenario,condition,replication," + detail::vehicle_header();
}

/// `leases.csv`: a line for each count of each action, and one for each reason of refusal.
std::string leases_header() {
    return "scenario,condition,replication,policy,action,outcome,reason,leases";
}

void append_leases(const RunRecord& run, std::string& text) {
    const std::string key = key_cells(run.key);
    for (const metrics::LeaseRow& lease : run.leases) {
        const std::string start = fmt::format("{},{},{}", key, csv_text(lease.policy), name(lease.action));
        core::for_each_field<metrics::LeaseRow>([&](const auto& field) {
            text += fmt::format("{},{},,{}\n", start, field.name, lease.*field.member);
        });
        for (const auto& [reason, count] : lease.refused)
            text += fmt::format("{},refused,{},{}\n", start, name(reason), count);
    }
}

/// A table that is being written, and its hash.
class TableFile {
  public:
    explicit TableFile(const std::filesystem::path& file) : name_(file.filename().string()), file_(file) {}

    void write(const std::string& lines) {
        file_.write(lines);
        hash_.add(lines);
    }
    /// Puts it in place and notes its hash in the database.
    void commit(detail::DatabaseWriter& database) {
        file_.commit();
        database.note(name_, hash_.digest());
    }

  private:
    std::string name_;
    core::AtomicFile file_;
    core::RunningHash hash_;
};

}  // namespace

Results read_results(const Store& store, VehicleRows rows) {
    Results results;
    results.manifest = store.manifest();
    for (const experiment::RunKey& key : results.manifest.runs()) {
        if (auto run = store.read(key, rows)) {
            results.runs.push_back(std::move(*run));
        } else if (auto error = store.read_error(key)) {
            results.errors.push_back(std::move(*error));
        } else {
            results.missing.push_back(key);
        }
    }
    return results;
}

struct TableWriter::Files {
    explicit Files(const Store& store)
        : lines(store.manifest()),
          runs(store.runs_csv()),
          vehicles(store.vehicles_csv()),
          leases(store.folder() / "leases.csv"),
          database(store.folder() / "results.sqlite", store.manifest(), detail::runs_hash(store)) {
        runs.write(lines.header() + "\n");
        vehicles.write(vehicles_header() + "\n");
        leases.write(leases_header() + "\n");
    }
    RunLines lines;
    TableFile runs;
    TableFile vehicles;
    TableFile leases;
    detail::DatabaseWriter database;
};

TableWriter::TableWriter(const Store& store) : files_(std::make_unique<Files>(store)) {}
TableWriter::~TableWriter() = default;

void TableWriter::add(const RunRecord& run) {
    files_->runs.write(files_->lines.of(run) + "\n");
    std::string lines;
    append_vehicles(run, lines);
    files_->vehicles.write(lines);
    lines.clear();
    append_leases(run, lines);
    files_->leases.write(lines);
    files_->database.add(run);
}

void TableWriter::add(const RunError& error) {
    files_->runs.write(files_->lines.of(error) + "\n");
    files_->database.add(error);
}

void TableWriter::add_missing(const experiment::RunKey& key) {
    files_->runs.write(files_->lines.of_missing(key) + "\n");
    files_->database.add_missing(key);
}

void TableWriter::finish() {
    files_->runs.commit(files_->database);
    files_->vehicles.commit(files_->database);
    files_->leases.commit(files_->database);
    files_->database.finish();
}

RunCounts write_tables(const Store& store) {
    // Hashes the runs before they are read: what changes in between is seen next time.
    TableWriter writer(store);
    RunCounts counts;
    store.manifest().for_each_run([&](const experiment::RunKey& key) {
        if (const auto run = store.read(key)) {
            writer.add(*run);
            ++counts.complete;
        } else if (const auto error = store.read_error(key)) {
            writer.add(*error);
            ++counts.failed;
        } else {
            writer.add_missing(key);
            ++counts.missing;
        }
    });
    writer.finish();
    return counts;
}

void outdate_tables(const Store& store) {
    std::error_code ignored;  // What cannot be removed is still told apart by its hash of the runs.
    std::filesystem::remove(store.folder() / "results.sqlite", ignored);
}

}  // namespace clearway::results
