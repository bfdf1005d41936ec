#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment/run_job.hpp"
#include "results/manifest.hpp"
#include "results/record.hpp"

namespace clearway::results {

/// A run whose files are not what was written, and where they were put.
struct SetAside {
    experiment::RunKey key;
    std::filesystem::path place;
    std::string why;  ///< What is wrong, with the file.
};

/// The run folder of a study.
///
///     manifest.json                                      what the study is
///     scenarios/SCENARIO/                                effective configuration and network
///     runs/SCENARIO/CONDITION/REPLICATION/run.json       a completed run; never changes once it is there
///                                        /vehicles.csv
///                                        /timing.json    differs from machine to machine
///     errors/SCENARIO/CONDITION/REPLICATION.json       a run without a record
///     recordings/SCENARIO/CONDITION/REPLICATION.h5  every step of a run, where asked for
///     damaged/SCENARIO/CONDITION/                        runs whose files did not fit their hash, kept
///     units/, logs/                                      orders for workers, and what they said
///     work/                                              SUMO's files of runs that did not end well
///     runs.csv, vehicles.csv, leases.csv, results.sqlite all runs in one table each, written at the end
///
/// Several processes may write different runs, or the same run, at one time: a run's folder is written aside,
/// flushed to the disk and renamed without replacing, so it is there as a whole or not at all.
class Store {
  public:
    /// Opens `folder` for a study, making it when it is new. More replications than the folder holds extend
    /// its study. Throws core::InputError when it holds another study, one of more replications, or something
    /// else than a run folder; core::EnvironmentError when it cannot be written.
    static Store create(const std::filesystem::path& folder, const Manifest& manifest);
    /// Opens an existing run folder. Throws core::InputError when it is none.
    static Store open(const std::filesystem::path& folder);

    const std::filesystem::path& folder() const { return folder_; }
    const Manifest& manifest() const { return manifest_; }

    /// Effective configuration and files of a scenario; its network is in `network` below it.
    std::filesystem::path scenario_folder(const std::string& scenario) const;
    /// Folder of a run, whether or not it exists.
    std::filesystem::path run_folder(const experiment::RunKey& key) const;
    std::filesystem::path unit_file(const std::string& unit) const;
    std::filesystem::path log_file(const std::string& unit) const;
    std::filesystem::path runs_csv() const { return folder_ / "runs.csv"; }
    std::filesystem::path vehicles_csv() const { return folder_ / "vehicles.csv"; }

    enum class Written : std::uint8_t { first, already_there };
    /// Stores a completed run and forgets an earlier error of it. The first writer wins; a second must
    /// bring the same bytes, else core::ConflictError. Throws core::EnvironmentError (disk full) and then
    /// leaves no trace.
    Written write(const RunRecord& record, const RunTiming& timing) const;
    /// Takes a complete run over from another store of the same study: its files are linked, or copied where
    /// that cannot be. As with `write`, the first wins and a second must be equal.
    Written adopt(const Store& other, const experiment::RunKey& key) const;
    /// Runs that are complete, and runs that failed and are not, as the folders have them: in no order.
    std::vector<experiment::RunKey> complete_runs() const;
    std::vector<experiment::RunKey> failed_runs() const;
    /// Waits until the names of these runs, as far as they are complete, are on the disk. Their content
    /// already is.
    void flush(const std::vector<experiment::RunKey>& keys) const;
    /// Replaces an earlier error of the same run; does nothing when the run is complete.
    void write(const RunError& error) const;

    bool complete(const experiment::RunKey& key) const;
    /// Whether nothing is left to do for a condition of a unit: complete, and recorded where that is asked
    /// for.
    bool done(const experiment::RunJob& unit, const experiment::ConditionSpec& condition) const;
    /// Nothing unless the run is complete. Throws core::InputError for a damaged record.
    std::optional<RunRecord> read(const experiment::RunKey& key, VehicleRows rows = VehicleRows::all) const;
    /// How the emergency vehicles of a run travelled; empty for a run that is not complete and for those
    /// whose journeys were not kept. Throws core::InputError for a damaged record.
    std::vector<metrics::JourneyRow> read_journeys(const experiment::RunKey& key) const;
    std::optional<RunTiming> read_timing(const experiment::RunKey& key) const;
    std::optional<RunError> read_error(const experiment::RunKey& key) const;
    /// Forgets an error so that the run can be tried again.
    void forget_error(const experiment::RunKey& key) const;
    /// Checks the files of these runs against their hashes and moves what is damaged to `damaged`, so that
    /// such a run counts as not yet made. Reads all of them. Only while nobody writes. Throws
    /// core::EnvironmentError where it cannot be moved.
    std::vector<SetAside> set_damaged_aside(const std::vector<experiment::RunKey>& keys) const;
    /// Removes what killed writers left behind. Only while nobody writes.
    void remove_leftovers() const;

  private:
    Store(std::filesystem::path folder, Manifest manifest);
    std::filesystem::path error_file(const experiment::RunKey& key) const;
    /// Runs of which `root` (runs or errors) has an entry.
    void for_each_file(const std::filesystem::path& root,
                       const std::function<void(const experiment::RunKey&)>& visit) const;
    /// The record without its vehicles, and their text. Throws core::InputError unless both fit their hashes.
    RunRecord read_checked(const experiment::RunKey& key, std::string& vehicles) const;
    void check(const experiment::RunKey& key) const;

    std::filesystem::path folder_;
    Manifest manifest_;
};

/// Everything in a run folder, by key.
struct Results {
    Manifest manifest;
    std::vector<RunRecord> runs;
    std::vector<RunError> errors;
    std::vector<experiment::RunKey> missing;  ///< Neither complete nor failed.
};
Results read_results(const Store& store, VehicleRows rows = VehicleRows::all);

/// All runs as one tidy table, one line a run of the manifest: scenario, condition, replication, outcome (ok,
/// failed, missing), cause, metrics, trace hash. Sorted; equal results give equal bytes.
std::string runs_csv(const Results& results);
/// All vehicles of all complete runs, one line a vehicle. Sorted; equal results give equal bytes.
std::string vehicles_csv(const Results& results);

/// Writes `runs.csv`, `vehicles.csv`, `leases.csv` and `results.sqlite` of a run folder from its runs.
void write_tables(const Store& store, const Results& results);

}  // namespace clearway::results
