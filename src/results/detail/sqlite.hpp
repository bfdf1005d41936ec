#pragma once

#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>

#include <sqlite3.h>

#include "core/read_failure.hpp"

namespace clearway::results::detail {

struct CloseDatabase {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct FinishStatement {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, FinishStatement>;

/// An open SQLite file.
class Database {
  public:
    /// Must throw. `code` is SQLite's result code, `reason` the `errno` behind it or EIO, `words` SQLite's
    /// message.
    using Fail = void (*)(const std::filesystem::path& file, int code, int reason, const std::string& words);

    /// `flags` are those of sqlite3_open_v2. Every error of this and all other members goes to `fail`.
    Database(std::filesystem::path file, int flags, Fail fail) : file_(std::move(file)), fail_(fail) {
        sqlite3* opened = nullptr;
        const int code = sqlite3_open_v2(file_.c_str(), &opened, flags, nullptr);
        handle_.reset(opened);
        check(code);
    }

    const std::filesystem::path& file() const { return file_; }
    void check(int code) const {
        if (code == SQLITE_OK || code == SQLITE_DONE) return;
        const int reason = errno;  // sqlite3_system_errno() is 0 where a file is over `ulimit -f`
        fail_(file_, code, core::is_of_machine(reason) ? reason : EIO,
              handle_ ? sqlite3_errmsg(handle_.get()) : "no memory");
    }
    void execute(const std::string& sql) const {
        check(sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr));
    }
    Statement prepare(const std::string& sql) const {
        sqlite3_stmt* statement = nullptr;
        check(sqlite3_prepare_v2(handle_.get(), sql.c_str(), -1, &statement, nullptr));
        return Statement(statement);
    }
    /// Calls `visit` with the statement at each row.
    template <class Visit>
    void for_each_row(const std::string& sql, Visit&& visit) const {
        const Statement statement = prepare(sql);
        int step = SQLITE_ROW;
        while ((step = sqlite3_step(statement.get())) == SQLITE_ROW)
            visit(statement.get());
        check(step);
    }

  private:
    std::filesystem::path file_;
    Fail fail_;
    std::unique_ptr<sqlite3, CloseDatabase> handle_;
};

}  // namespace clearway::results::detail
