#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "results/store.hpp"

namespace clearway::results::detail {

/// Hash of a closed or committed database but for its header, which `finish` keeps as the user version, a
/// number that SQLite leaves to whoever writes the file. Throws as core::read_file.
std::int32_t seal_of(const std::filesystem::path& file);

/// Writes a study into one SQLite file, run by run: tables `study` (key, value), `runs`, `vehicles`,
/// `errors`, with the columns of the CSV files. The database is a temporary file until `finish` renames it;
/// without `finish` it is removed. All members throw core::EnvironmentError.
class DatabaseWriter {
  public:
    /// `runs_hash` (detail/runs_hash.hpp) tells later whether the tables still are those of the runs.
    DatabaseWriter(const std::filesystem::path& file, const Manifest& manifest, const std::string& runs_hash);
    ~DatabaseWriter();
    DatabaseWriter(const DatabaseWriter&) = delete;
    DatabaseWriter& operator=(const DatabaseWriter&) = delete;

    void add(const RunRecord& run);
    void add(const RunError& error);
    void add_missing(const experiment::RunKey& key);
    /// A row of table `study`.
    void note(std::string_view key, std::string_view value);
    void finish();

  private:
    struct Tables;
    void add(const experiment::RunKey& key, const metrics::VehicleRow& vehicle);
    void add(const experiment::RunKey& key, const metrics::LeaseRow& lease, std::string_view outcome,
             std::string_view reason, std::uint64_t count);
    void discard();

    std::filesystem::path file_;
    std::filesystem::path part_;
    std::unique_ptr<Tables> tables_;
};

}  // namespace clearway::results::detail
