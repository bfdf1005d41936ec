#pragma once

#include <string>
#include <vector>

#include "results/record.hpp"

namespace clearway::results::detail {

// The files of one run, to and from text. The readers throw core::InputError, naming `where`.

/// `run.json`: everything but the vehicles, of which it holds the hash, and a hash of itself.
std::string run_to_json(const RunRecord& record, const std::string& vehicles_csv);
/// Record without vehicles. `vehicles_csv` must have the hash that the run was stored with.
RunRecord run_from_json(const std::string& text, const std::string& vehicles_csv, const std::string& where);

/// `vehicles.csv`: id, class, kind, outcome, numbers.
std::string vehicles_to_csv(const std::vector<metrics::VehicleRow>& vehicles);
std::vector<metrics::VehicleRow> vehicles_from_csv(const std::string& text, const std::string& where,
                                                   VehicleRows rows = VehicleRows::all);

/// `id,class,kind,outcome,...` and the cells below it, without a line end.
std::string vehicle_header();
std::string vehicle_cells(const metrics::VehicleRow& vehicle);

std::string timing_to_json(const RunTiming& timing);
RunTiming timing_from_json(const std::string& text, const std::string& where);
std::string error_to_json(const RunError& error);
RunError error_from_json(const std::string& text, const std::string& where);

}  // namespace clearway::results::detail
