#include "results/detail/database.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "core/leftovers.hpp"
#include "core/open_file.hpp"
#include "core/read_failure.hpp"
#include "core/running_hash.hpp"
#include "results/detail/sqlite.hpp"
#include "results/factor_columns.hpp"

namespace clearway::results::detail {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int code, int reason, const std::string& words) {
    // SQLite calls the disk full, too, where a file is over `ulimit -f`.
    const bool is_too_large = reason == EFBIG;
    throw core::EnvironmentError(
        fmt::format("{}: {}. {}", file.string(), is_too_large ? std::strerror(reason) : words,
                    core::cure_of(code == SQLITE_FULL && !is_too_large ? ENOSPC : reason)));
}

/// Inserts row after row; values fill the columns from left to right.
class Inserter {
  public:
    Inserter(Database& database, const std::string& sql)
        : database_(database), statement_(database.prepare(sql)) {}

    void add(std::string_view text) {
        database_.check(sqlite3_bind_text(statement_.get(), ++column_, text.data(),
                                          static_cast<int>(text.size()), SQLITE_TRANSIENT));
    }
    void add(double number) { database_.check(sqlite3_bind_double(statement_.get(), ++column_, number)); }
    /// SQLite's integers are signed; seeds above 2^63 keep their bits.
    void add(std::uint64_t number) {
        database_.check(sqlite3_bind_int64(statement_.get(), ++column_, static_cast<sqlite3_int64>(number)));
    }
    void add(std::uint32_t number) { add(std::uint64_t{number}); }
    template <class Value>
    void add(const std::optional<Value>& value) {
        if (value) {
            add(*value);
        } else {
            database_.check(sqlite3_bind_null(statement_.get(), ++column_));
        }
    }
    template <class Struct>
    void add_fields(const Struct& source) {
        core::for_each_field<Struct>([&](const auto& field) { add(source.*field.member); });
    }
    void add_key(const experiment::RunKey& key) {
        add(std::string_view(key.scenario));
        add(std::string_view(key.condition));
        add(key.replication);
    }
    void insert() {
        database_.check(sqlite3_step(statement_.get()));
        database_.check(sqlite3_reset(statement_.get()));
        column_ = 0;
    }

  private:
    Database& database_;
    Statement statement_;
    int column_ = 0;
};

template <class Value>
constexpr const char* column_type() {
    if constexpr (core::OptionalMember<Value>::value) {
        return column_type<typename Value::value_type>();
    } else if constexpr (std::is_integral_v<Value>) {
        return "INTEGER";
    } else {
        return std::is_floating_point_v<Value> ? "REAL" : "TEXT";
    }
}

template <class Struct>
std::string columns() {
    std::string text;
    core::for_each_field<Struct>([&](const auto& field) {
        using Member = std::decay_t<decltype(std::declval<Struct>().*field.member)>;
        text += fmt::format(", {} {}", field.name, column_type<Member>());
    });
    return text;
}

/// `(?, ?, ?)`: placeholders for the key, `words` texts, and the members of field tables.
template <class... Structs>
std::string places(int words) {
    int count = 3 + words;
    (core::for_each_field<Structs>([&](const auto&) { ++count; }), ...);
    std::string text = "(?";
    while (--count > 0)
        text += ", ?";
    return text + ")";
}

constexpr const char* key_columns = "scenario TEXT, condition TEXT, replication INTEGER";

void write_study(Database& database, const Manifest& manifest, const std::string& runs_hash) {
    database.execute("CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT)");
    Inserter row(database, "INSERT INTO study VALUES (?, ?)");
    for (const auto& [key, value] : {std::pair<const char*, std::string>{"manifest", to_json(manifest)},
                                     {"manifest_hash", manifest_hash(manifest)},
                                     {"runs_hash", runs_hash},
                                     {"format", fmt::format("{}", manifest.format)}}) {
        row.add(std::string_view(key));
        row.add(std::string_view(value));
        row.insert();
    }
}

/// `, "failure.dark_share" NUMERIC`.
std::string columns(const FactorColumns& factors) {
    std::string text;
    for (std::string name : factors.names()) {
        const char* const type = factors.is_number(name) ? "NUMERIC" : "TEXT";
        for (std::size_t at = 0; (at = name.find('"', at)) != std::string::npos; at += 2)
            name.insert(at, "\"");
        text += fmt::format(", \"{}\" {}", name, type);
    }
    return text;
}

void create_tables(Database& database, const FactorColumns& factors) {
    database.execute(fmt::format(
        "CREATE TABLE runs ({}, safety_checks TEXT{}{}{}, clearway_build TEXT, PRIMARY KEY (scenario, "
        "condition, replication))",
        key_columns, columns(factors), columns<metrics::RunMetrics>(), columns<experiment::Provenance>()));
    database.execute(
        fmt::format("CREATE TABLE vehicles ({}, id TEXT, class TEXT, kind TEXT, outcome TEXT{}, "
                    "PRIMARY KEY (scenario, condition, replication, id)) WITHOUT ROWID",
                    key_columns, columns<metrics::VehicleRow>()));
    database.execute(
        fmt::format("CREATE TABLE leases ({}, policy TEXT, action TEXT, outcome TEXT, reason TEXT, leases "
                    "INTEGER)",
                    key_columns));
    database.execute(
        fmt::format("CREATE TABLE errors ({}, outcome TEXT, cause TEXT, message TEXT)", key_columns));
}

/// A new database with the study's metadata and empty tables.
Database begin_database(const std::filesystem::path& file, const Manifest& manifest,
                        const std::string& runs_hash) {
    std::filesystem::remove(file);
    Database database(file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, fail);
    // An unfinished file is thrown away as a whole, so it needs no journal.
    database.execute("PRAGMA journal_mode = OFF");
    database.execute("BEGIN");
    write_study(database, manifest, runs_hash);
    create_tables(database, FactorColumns(manifest));
    return database;
}

}  // namespace

std::int32_t seal_of(const std::filesystem::path& file) {
    constexpr std::size_t header_bytes = 100;
    constexpr std::size_t seal_digits = 8;
    core::RunningHash hash;
    std::size_t skipped = 0;
    core::OpenFile(file).read([&](std::string_view piece) {
        const std::size_t count = std::min(header_bytes - skipped, piece.size());
        skipped += count;
        hash.add(piece.substr(count));
    });
    return static_cast<std::int32_t>(std::stoul(hash.digest().substr(0, seal_digits), nullptr, 16));
}

struct DatabaseWriter::Tables {
    Tables(const std::filesystem::path& part, const Manifest& manifest, const std::string& runs_hash)
        : database(begin_database(part, manifest, runs_hash)),
          factors(manifest),
          runs(database, "INSERT INTO runs VALUES " + places<metrics::RunMetrics, experiment::Provenance>(
                                                          2 + static_cast<int>(factors.names().size()))),
          vehicles(database, "INSERT INTO vehicles VALUES " + places<metrics::VehicleRow>(4)),
          leases(database, "INSERT INTO leases VALUES (?, ?, ?, ?, ?, ?, ?, ?)"),
          errors(database, "INSERT INTO errors VALUES (?, ?, ?, ?, ?, ?)") {}

    void add_error(const experiment::RunKey& key, std::string_view outcome, std::string_view cause,
                   std::string_view message) {
        errors.add_key(key);
        errors.add(outcome);
        errors.add(cause);
        errors.add(message);
        errors.insert();
    }

    Database database;
    FactorColumns factors;
    Inserter runs;
    Inserter vehicles;
    Inserter leases;
    Inserter errors;
};

DatabaseWriter::DatabaseWriter(const std::filesystem::path& file, const Manifest& manifest,
                               const std::string& runs_hash)
    : file_(file), part_(file.string() + fmt::format(".{}{}", ::getpid(), core::part_ending)) {
    try {
        tables_ = std::make_unique<Tables>(part_, manifest, runs_hash);
    } catch (...) {
        discard();
        throw;
    }
}

DatabaseWriter::~DatabaseWriter() {
    discard();
}

void DatabaseWriter::discard() {
    tables_.reset();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
}

void DatabaseWriter::add(const RunRecord& run) {
    Inserter& row = tables_->runs;
    row.add_key(run.key);
    row.add(experiment::name(run.condition.safety_checks));
    for (const std::string& value : tables_->factors.values(run.key.scenario, run.key.condition))
        row.add(value.empty() ? std::optional<std::string_view>() : std::string_view(value));
    row.add_fields(run.metrics);
    row.add_fields(run.provenance);
    row.add(std::string_view(run.build));
    row.insert();
    for (const metrics::VehicleRow& vehicle : run.vehicles)
        add(run.key, vehicle);
    for (const metrics::LeaseRow& lease : run.leases) {
        core::for_each_field<metrics::LeaseRow>(
            [&](const auto& field) { add(run.key, lease, field.name, "", lease.*field.member); });
        for (const auto& [reason, count] : lease.refused)
            add(run.key, lease, "refused", name(reason), count);
    }
}

void DatabaseWriter::add(const experiment::RunKey& key, const metrics::LeaseRow& lease,
                         std::string_view outcome, std::string_view reason, std::uint64_t count) {
    Inserter& row = tables_->leases;
    row.add_key(key);
    row.add(std::string_view(lease.policy));
    row.add(name(lease.action));
    row.add(outcome);
    row.add(reason);
    row.add(count);
    row.insert();
}

void DatabaseWriter::add(const experiment::RunKey& key, const metrics::VehicleRow& vehicle) {
    Inserter& row = tables_->vehicles;
    row.add_key(key);
    row.add(std::string_view(vehicle.id));
    row.add(traffic::name(vehicle.vehicle_class));
    row.add(traffic::name(vehicle.kind));
    row.add(metrics::name(vehicle.outcome));
    row.add_fields(vehicle);
    row.insert();
}

void DatabaseWriter::add(const RunError& error) {
    tables_->add_error(error.key, "failed", name(error.cause), error.message);
}

void DatabaseWriter::add_missing(const experiment::RunKey& key) {
    tables_->add_error(key, "missing", "", "");
}

void DatabaseWriter::note(std::string_view key, std::string_view value) {
    Inserter row(tables_->database, "INSERT INTO study VALUES (?, ?)");
    row.add(key);
    row.add(value);
    row.insert();
}

void DatabaseWriter::finish() {
    tables_->database.execute("COMMIT");
    tables_->database.execute(fmt::format("PRAGMA user_version = {}", seal_of(part_)));
    tables_.reset();
    std::error_code error;
    std::filesystem::rename(part_, file_, error);
    if (error) throw core::write_error(file_, error.value());
    core::flush_folder(file_.parent_path());
}

}  // namespace clearway::results::detail
