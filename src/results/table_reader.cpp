#include "results/table_reader.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "core/open_file.hpp"
#include "core/read_failure.hpp"
#include "results/detail/database.hpp"
#include "results/detail/log_tables.hpp"
#include "results/detail/record_files.hpp"
#include "results/detail/sqlite.hpp"

namespace clearway::results {
namespace {

using detail::Database;
using detail::log_tables;
using detail::LogTable;

constexpr const char* database_name = "results.sqlite";
constexpr std::array csv_tables = {"runs.csv", "vehicles.csv", "leases.csv"};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw core::InputError(
        {file.string(), what, "a database that this version wrote",
         "Give the same command again, in case the machine failed to read it; otherwise remove "
         "it: `clearway report` on the folder writes it again from its runs"});
}

[[noreturn]] void fail(const std::filesystem::path& file, int code, int reason, const std::string& words) {
    if (code == SQLITE_IOERR || code == SQLITE_NOMEM) core::fail_to_read(file, reason);
    refuse(file, code == SQLITE_CANTOPEN ? "cannot be read" : words);
}

std::string text_at(sqlite3_stmt* row, int column) {
    const auto* const text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
    return {text, static_cast<std::size_t>(sqlite3_column_bytes(row, column))};
}

/// A value of table `study`; empty if it has none.
std::string study_value(const Database& database, const char* key) {
    std::string value;
    database.for_each_row(fmt::format("SELECT value FROM study WHERE key = '{}'", key),
                          [&](sqlite3_stmt* row) { value = text_at(row, 0); });
    return value;
}

/// Opens `results.sqlite` of a run folder read-only and checks that it is of this version.
Database open_database(const Store& store) {
    const std::filesystem::path file = store.folder() / database_name;
    const core::OpenFile is_no_pipe(file);  // SQLite waits at one
    std::error_code unknown;
    if (std::filesystem::is_directory(file, unknown))
        throw core::InputError({file.string(), "is a folder", "a database that this version wrote",
                                "Remove it, or move it elsewhere: the tables are made from the runs"});
    Database database(file, SQLITE_OPEN_READONLY, fail);
    const std::string format = study_value(database, "format");
    if (format != fmt::format("{}", store.manifest().format))
        refuse(database.file(),
               fmt::format("is of another version: format \"{}\", not {}", format, store.manifest().format));
    return database;
}

std::vector<std::string> names_in(const Database& database) {
    std::vector<std::string> names;
    database.for_each_row("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name",
                          [&](sqlite3_stmt* row) { names.push_back(text_at(row, 0)); });
    return names;
}

/// Whether the column's integers are signed. Those of factors are; others are never negative, and seeds use
/// all 64 bits.
bool is_signed(sqlite3_stmt* row, int column) {
    const char* const type = sqlite3_column_decltype(row, column);
    return type != nullptr && std::string_view(type) == "NUMERIC";
}

/// A cell; empty text for a missing value.
std::string csv_cell_at(sqlite3_stmt* row, int column) {
    switch (sqlite3_column_type(row, column)) {
        case SQLITE_NULL:
            return {};
        case SQLITE_INTEGER:
            if (is_signed(row, column)) return fmt::format("{}", sqlite3_column_int64(row, column));
            return fmt::format("{}", static_cast<std::uint64_t>(sqlite3_column_int64(row, column)));
        case SQLITE_FLOAT:
            return fmt::format("{}", sqlite3_column_double(row, column));
        default:
            return core::csv_text(text_at(row, column));
    }
}

core::Json json_at(sqlite3_stmt* row, int column) {
    switch (sqlite3_column_type(row, column)) {
        case SQLITE_NULL:
            return nullptr;
        case SQLITE_INTEGER:
            if (is_signed(row, column)) return sqlite3_column_int64(row, column);
            return static_cast<std::uint64_t>(sqlite3_column_int64(row, column));
        case SQLITE_FLOAT:
            return sqlite3_column_double(row, column);
        default:
            return text_at(row, column);
    }
}

void print_csv(const Database& database, const std::string& table, std::ostream& out) {
    const char* separator = "";
    database.for_each_row(fmt::format("SELECT name FROM pragma_table_info('{}')", table),
                          [&](sqlite3_stmt* row) {
                              out << separator << csv_cell_at(row, 0);
                              separator = ",";
                          });
    out << '\n';
    database.for_each_row("SELECT * FROM " + table, [&](sqlite3_stmt* row) {
        for (int column = 0; column < sqlite3_column_count(row); ++column)
            out << (column == 0 ? "" : ",") << csv_cell_at(row, column);
        out << '\n';
    });
}

void print_json(const Database& database, const std::string& table, std::ostream& out) {
    const char* separator = "";
    out << "[";
    database.for_each_row("SELECT * FROM " + table, [&](sqlite3_stmt* row) {
        core::Json object = core::Json::object();
        for (int column = 0; column < sqlite3_column_count(row); ++column)
            object[sqlite3_column_name(row, column)] = json_at(row, column);
        out << separator << "\n" << object.dump(-1, ' ', false, core::Json::error_handler_t::replace);
        separator = ",";
    });
    out << "\n]\n";
}

}  // namespace

std::vector<std::string> edited_tables(const Store& store) {
    std::vector<std::string> edited;
    if (!std::filesystem::exists(store.folder() / database_name)) return edited;
    const Database database = open_database(store);
    std::int32_t seal = 0;
    database.for_each_row("PRAGMA user_version",
                          [&](sqlite3_stmt* row) { seal = sqlite3_column_int(row, 0); });
    if (seal != 0 && seal != detail::seal_of(database.file())) edited.emplace_back(database_name);
    for (const char* const table : csv_tables) {
        const std::filesystem::path file = store.folder() / table;
        const std::string hash = study_value(database, table);
        if (!hash.empty() && std::filesystem::exists(file) &&
            core::content_hash(core::read_file(file)) != hash)
            edited.emplace_back(table);
    }
    return edited;
}

bool tables_are_current(const Store& store) {
    if (!std::filesystem::exists(store.folder() / database_name)) return false;
    for (const char* const table : csv_tables)
        if (!std::filesystem::exists(store.folder() / table)) return false;
    const Database database = open_database(store);
    return study_value(database, "manifest_hash") == manifest_hash(store.manifest()) &&
           study_value(database, "runs_hash") == detail::runs_hash(store);
}

std::vector<std::string> table_names(const Store& store) {
    std::vector<std::string> names = names_in(open_database(store));
    for (const LogTable& table : log_tables())
        names.emplace_back(table.name);
    std::ranges::sort(names);
    return names;
}

void print_table(const Store& store, const std::string& table, TableFormat format, std::ostream& out) {
    for (const LogTable& log : log_tables())
        if (table == log.name) return print_log_table(store, log, format, out);
    const Database database = open_database(store);
    const std::vector<std::string> known = table_names(store);
    if (!core::contains(known, table)) {
        throw core::InputError({"table",
                                fmt::format("there is no `{}` in {}", table, store.folder().string()),
                                core::listed(known), core::did_you_mean(table, known)});
    }
    format == TableFormat::csv ? print_csv(database, table, out) : print_json(database, table, out);
}

}  // namespace clearway::results
