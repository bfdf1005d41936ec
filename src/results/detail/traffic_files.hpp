#pragma once

#include <string>

#include "core/json.hpp"
#include "metrics/traffic_tables.hpp"

namespace clearway::results::detail {

/// The tables of a run as CSV texts in one JSON object. They stay in one file with the run's other numbers,
/// which is written, flushed and compared as a whole. Null if all tables are empty.
core::Json traffic_to_json(const metrics::TrafficTables& tables);

/// Approaches and recovery. The other tables are not read, because they are large and few readers want them.
/// Throws core::InputError, naming `where`.
metrics::TrafficTables traffic_from_json(const core::Json& run, const std::string& where);
/// All tables; empty ones for a record without them.
metrics::TrafficTables all_traffic_from_json(const core::Json& run, const std::string& where);

}  // namespace clearway::results::detail
