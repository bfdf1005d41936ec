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

/// A run with damaged files, and where they were moved.
struct SetAside {
    experiment::RunKey key;
    std::filesystem::path place;
    std::string why;            ///< What is wrong, and in which file.
    bool is_recording = false;  ///< Of a run whose other files are whole.
};

/// The run folder of a study.
///
///     manifest.json                                      what the study is
///     scenarios/SCENARIO/                                effective configuration and network
///     runs/SCENARIO/CONDITION/REPLICATION/run.json       a completed run; never changes
///                                         /vehicles.csv
///                                         /signal_events.csv where a policy could ask for greens
///                                         /timing.json   differs from machine to machine
///     errors/SCENARIO/CONDITION/REPLICATION.json         a run without a record
///     recordings/SCENARIO/CONDITION/REPLICATION.h5       every step of a run, if requested
///     damaged/SCENARIO/CONDITION/                        runs that did not match their hashes
///     units/, logs/                                      jobs of workers, and their output
///     work/                                              SUMO's files of runs that failed
///     runs.csv, vehicles.csv, leases.csv, results.sqlite all runs in one table each
///
/// Several processes may write different runs, or the same run, at the same time: a run's folder is written
/// under a temporary name, flushed and renamed without replacing another, so it exists as a whole or not at
/// all.
class Store {
  public:
    /// Opens `folder` for a study, and makes it if it is new. More replications than the folder holds extend
    /// its study. Throws core::InputError when it holds another study, the same study with more replications,
    /// or something other than a run folder; core::EnvironmentError when it cannot be written.
    static Store create(const std::filesystem::path& folder, const Manifest& manifest);
    /// Throws core::InputError where `create` does, and writes nothing. `titles` are those of the study file.
    static void require_fits(const std::filesystem::path& folder, const Manifest& manifest,
                             const core::Settings& titles = {});
    /// Throws core::InputError when `folder` is neither a run folder nor new or empty.
    static void refuse_others(const std::filesystem::path& folder);
    /// Opens an existing run folder. Throws core::InputError when it is not one.
    static Store open(const std::filesystem::path& folder);

    const std::filesystem::path& folder() const { return folder_; }
    const Manifest& manifest() const { return manifest_; }

    /// Effective configuration and files of a scenario; its network is in `network` below it.
    std::filesystem::path scenario_folder(const std::string& scenario) const;
    /// Folder of a run, whether or not it exists.
    std::filesystem::path run_folder(const experiment::RunKey& key) const;
    std::filesystem::path unit_file(const std::string& unit) const;
    std::filesystem::path log_file(const std::string& unit) const;
    std::filesystem::path work_folder(const std::string& unit) const { return folder_ / "work" / unit; }
    /// Why a run failed; there is none for others.
    std::filesystem::path error_file(const experiment::RunKey& key) const;
    std::filesystem::path runs_csv() const { return folder_ / "runs.csv"; }
    std::filesystem::path vehicles_csv() const { return folder_ / "vehicles.csv"; }

    enum class Written : std::uint8_t { first, already_there };
    /// Stores a completed run and forgets an earlier error of it. The first writer wins; a second must bring
    /// the same bytes, else core::ConflictError is thrown. Throws core::EnvironmentError (disk full) and then
    /// leaves nothing behind.
    Written write(const RunRecord& record, const RunTiming& timing) const;
    /// Adopts a complete run from another store of the same study: its files are linked, or copied and
    /// flushed if they cannot be linked; `flush` flushes their entries. Throws core::InputError for a damaged
    /// record, which is not adopted. As with `write`, the first wins and a second must be equal.
    Written adopt(const Store& other, const experiment::RunKey& key) const;
    /// Likewise one whose condition has the same content and another name in that store, as a run of this
    /// study's condition.
    Written adopt(const Store& other, const experiment::RunKey& key,
                  const std::string& condition_there) const;
    /// Likewise its recording, unless this store has one. Throws core::InputError for one that is damaged.
    void adopt_recording(const Store& other, const experiment::RunKey& key) const;
    bool has_recording(const experiment::RunKey& key) const;
    /// Complete runs, and failed runs that are not complete; in no particular order.
    std::vector<experiment::RunKey> complete_runs() const;
    std::vector<experiment::RunKey> failed_runs() const;
    /// Flushes the folders and the folder entries of those runs that are complete. Their content is on the
    /// disk already.
    void flush(const std::vector<experiment::RunKey>& keys) const;
    /// Replaces an earlier error of the same run; does nothing when the run is complete.
    void write(const RunError& error) const;

    bool complete(const experiment::RunKey& key) const;
    /// Whether nothing is left to do for a condition of a unit: it is complete, and recorded if that was
    /// asked for.
    bool done(const experiment::RunJob& unit, const experiment::ConditionSpec& condition) const;
    /// Nothing if the run is not complete. Throws core::InputError for a damaged record and for one of
    /// another study.
    std::optional<RunRecord> read(const experiment::RunKey& key, VehicleRows rows = VehicleRows::all) const;
    /// All tables of where a run lost time and how its emergency vehicles travelled, also those that `read`
    /// leaves out; empty for runs that are not complete or did not keep them. Throws core::InputError for a
    /// damaged record.
    metrics::TrafficTables read_traffic(const experiment::RunKey& key) const;
    /// The event log of the signals; nothing for runs that are not complete or kept none. Throws
    /// core::InputError, naming file and line, for a log that is damaged or missing.
    std::optional<std::vector<metrics::SignalEvent>> read_signal_events(const experiment::RunKey& key) const;
    /// Nothing, too, when a power failure took it: it is the one file that is not flushed.
    std::optional<RunTiming> read_timing(const experiment::RunKey& key) const;
    std::optional<RunError> read_error(const experiment::RunKey& key) const;
    /// Forgets an error so that the run can be tried again.
    void forget_error(const experiment::RunKey& key) const;
    /// Throws core::InputError when a file of the run does not match its hash; its recording counts.
    void check(const experiment::RunKey& key) const;
    /// Checks the files of these runs, but for recordings, against their hashes and moves what is damaged to
    /// `damaged`, so that such a run counts as missing. Reads all of them. No other process may write
    /// meanwhile. Throws core::EnvironmentError when a file cannot be moved.
    std::vector<SetAside> set_damaged_aside(const std::vector<experiment::RunKey>& keys) const;
    /// Likewise the recordings of these runs, which are large.
    std::vector<SetAside> set_damaged_recordings_aside(const std::vector<experiment::RunKey>& keys) const;
    /// Removes what killed writers left behind. No other process may write meanwhile.
    void remove_leftovers() const;

  private:
    /// A slash at the end of `folder` does not count.
    Store(const std::filesystem::path& folder, Manifest manifest);
    /// Visits the runs that have an entry in `root` (runs or errors).
    void for_each_file(const std::filesystem::path& root,
                       const std::function<void(const experiment::RunKey&)>& visit) const;
    /// The record without its vehicles, and their text. Throws core::InputError unless both match their
    /// hashes and the record was made in the study of the manifest.
    RunRecord read_checked(const experiment::RunKey& key, std::string& vehicles) const;
    void check_record(const experiment::RunKey& key) const;
    void check_recording(const experiment::RunKey& key) const;
    /// A new place below `damaged`.
    std::filesystem::path make_place(const experiment::RunKey& key) const;

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

}  // namespace clearway::results
