#include "results/table_reader.hpp"

#include <algorithm>
#include <memory>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sqlite3.h>

#include "core/csv_table.hpp"
#include "core/error.hpp"
#include "core/json.hpp"

namespace clearway::results {
namespace {

struct CloseDatabase {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct FinishStatement {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// `results.sqlite` of a run folder, read only and of this version.
class Database {
  public:
    explicit Database(const Store& store) : file_(store.folder() / "results.sqlite") {
        sqlite3* opened = nullptr;
        const int code = sqlite3_open_v2(file_.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
        handle_.reset(opened);
        if (code != SQLITE_OK) refuse("cannot be read");
        std::string format;
        for_each_row("SELECT value FROM study WHERE key = 'format'",
                     [&](sqlite3_stmt* row) { format = text_at(row, 0); });
        if (format != fmt::format("{}", store.manifest().format))
            refuse(
                fmt::format("is of another version: format \"{}\", not {}", format, store.manifest().format));
    }

    /// Calls `visit` with the statement at each row.
    template <class Visit>
    void for_each_row(const std::string& sql, Visit&& visit) const {
        sqlite3_stmt* prepared = nullptr;
        const int code = sqlite3_prepare_v2(handle_.get(), sql.c_str(), -1, &prepared, nullptr);
        const std::unique_ptr<sqlite3_stmt, FinishStatement> statement(prepared);
        if (code != SQLITE_OK) refuse(sqlite3_errmsg(handle_.get()));
        int step = SQLITE_ROW;
        while ((step = sqlite3_step(prepared)) == SQLITE_ROW)
            visit(prepared);
        if (step != SQLITE_DONE) refuse(sqlite3_errmsg(handle_.get()));
    }

    static std::string text_at(sqlite3_stmt* row, int column) {
        const auto* const text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
        return {text, static_cast<std::size_t>(sqlite3_column_bytes(row, column))};
    }

  private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw core::InputError({file_.string(), what, "a database that this version wrote",
                                "Remove it; `clearway report` on the folder writes it again from its runs"});
    }

    std::filesystem::path file_;
    std::unique_ptr<sqlite3, CloseDatabase> handle_;
};

std::uint64_t count_of(const Database& database, const std::string& sql) {
    std::uint64_t count = 0;
    database.for_each_row(
        sql, [&](sqlite3_stmt* row) { count = static_cast<std::uint64_t>(sqlite3_column_int64(row, 0)); });
    return count;
}

std::vector<std::string> names_in(const Database& database) {
    std::vector<std::string> names;
    database.for_each_row("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name",
                          [&](sqlite3_stmt* row) { names.push_back(Database::text_at(row, 0)); });
    return names;
}

/// Whether the column's whole numbers have a sign: those of factors have, while others are never negative and
/// seeds use all of their 64 bits.
bool is_signed(sqlite3_stmt* row, int column) {
    const char* const type = sqlite3_column_decltype(row, column);
    return type != nullptr && std::string_view(type) == "NUMERIC";
}

/// A cell; empty text for what is not available.
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
            return core::csv_text(Database::text_at(row, column));
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
            return Database::text_at(row, column);
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

bool tables_are_current(const Store& store) {
    if (!std::filesystem::exists(store.folder() / "results.sqlite")) return false;
    const Database database(store);
    std::string study;
    database.for_each_row("SELECT value FROM study WHERE key = 'manifest_hash'",
                          [&](sqlite3_stmt* row) { study = Database::text_at(row, 0); });
    if (study != manifest_hash(store.manifest())) return false;
    std::uint64_t complete = 0;
    std::uint64_t failed = 0;
    for (const experiment::RunKey& key : store.manifest().runs()) {
        if (store.complete(key)) {
            ++complete;
        } else if (store.read_failure(key)) {
            ++failed;
        }
    }
    return count_of(database, "SELECT count(*) FROM runs") == complete &&
           count_of(database, "SELECT count(*) FROM failures WHERE outcome = 'failed'") == failed;
}

std::vector<std::string> table_names(const Store& store) {
    return names_in(Database(store));
}

void print_table(const Store& store, const std::string& table, TableFormat format, std::ostream& out) {
    const Database database(store);
    const std::vector<std::string> known = names_in(database);
    if (std::ranges::find(known, table) == known.end()) {
        throw core::InputError({"table",
                                fmt::format("there is no `{}` in {}", table, store.folder().string()),
                                fmt::format("{}", fmt::join(known, ", ")), ""});
    }
    format == TableFormat::csv ? print_csv(database, table, out) : print_json(database, table, out);
}

}  // namespace clearway::results
