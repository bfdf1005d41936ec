#pragma once

#include <memory>

#include "results/store.hpp"

namespace clearway::results {

/// Writes `runs.csv`, `vehicles.csv`, `leases.csv` and `results.sqlite` of a run folder run by run, so that
/// only one run is in memory at a time. `runs.csv` has a line for each run of the manifest: scenario,
/// condition, replication, outcome (ok, failed, missing), cause, safety checks, factors, metrics, provenance.
/// Equal runs give equal bytes. Nothing is replaced before `finish`.
class TableWriter {
  public:
    /// Throws core::EnvironmentError, as the other members do.
    explicit TableWriter(const Store& store);
    ~TableWriter();
    TableWriter(const TableWriter&) = delete;
    TableWriter& operator=(const TableWriter&) = delete;

    // Call one of these for each run of the manifest, in its order (Manifest::for_each_run).
    void add(const RunRecord& run);
    void add(const RunError& error);
    void add_missing(const experiment::RunKey& key);

    void finish();

  private:
    struct Files;
    std::unique_ptr<Files> files_;
};

/// Number of runs of a study by state.
struct RunCounts {
    std::size_t complete = 0;
    std::size_t failed = 0;
    std::size_t missing = 0;
};

/// Writes the tables of a run folder straight from its files. Time is about proportional to the number of
/// runs; memory is that of one run. Throws core::InputError for a damaged record.
RunCounts write_tables(const Store& store);

/// Removes `results.sqlite`, so that all tables are written anew when they are next needed: of a run which
/// was made anew no row stays, whatever somebody did to the database meanwhile.
void outdate_tables(const Store& store);

}  // namespace clearway::results
