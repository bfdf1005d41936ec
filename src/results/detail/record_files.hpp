#pragma once

#include <string>
#include <vector>

#include "results/record.hpp"
#include "results/store.hpp"

namespace clearway::results::detail {

/// Hash of everything in the runs of a folder that its tables hold: what each `run.json` says, which knows
/// the hash of its vehicles, and why other runs failed. It changes when a run is added, removed or made anew
/// with another result. Times of files would see a copied folder as another one. Reads every record: 0.03 ms
/// for one of 100 KB. Throws core::InputError for a damaged error.
std::string runs_hash(const Store& store);

/// Key of `run.json`: hash of `signal_events.csv`; missing where there is no such file.
inline constexpr const char* signal_events_hash_key = "signal_events_hash";

// The files of one run, to and from text. The readers throw core::InputError, naming `where`.

/// `run.json`: everything but the vehicles, with the build that made it, the hash of vehicles.csv and a hash
/// of itself.
std::string run_to_json(const RunRecord& record, const std::string& vehicles_csv, const std::string& build);
/// The `run.json` of the same run as one of this key and condition.
std::string run_named(const std::string& run_json, const experiment::RunKey& key,
                      const experiment::ConditionSpec& condition);
/// The record without vehicles. `vehicles_csv` must have the hash stored in `text`.
RunRecord run_from_json(const std::string& text, const std::string& vehicles_csv, const std::string& where);

/// `vehicles.csv`: id, class, kind, outcome, numbers.
std::string vehicles_to_csv(const std::vector<metrics::VehicleRow>& vehicles);
std::vector<metrics::VehicleRow> vehicles_from_csv(const std::string& text, const std::string& where,
                                                   VehicleRows rows = VehicleRows::all);

/// `id,class,kind,outcome,...` and one row of cells, both without a newline.
std::string vehicle_header();
std::string vehicle_cells(const metrics::VehicleRow& vehicle);

std::string timing_to_json(const RunTiming& timing);
RunTiming timing_from_json(const std::string& text, const std::string& where);
std::string error_to_json(const RunError& error);
RunError error_from_json(const std::string& text, const std::string& where);

}  // namespace clearway::results::detail
