#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trace/recording.hpp"

namespace clearway::trace {

/// What of a recording can be written as a tidy table: one line a vehicle (or link, lease, signal, event) and
/// step.
enum class RecordingTable : std::uint8_t {
    snapshot,
    signals,
    events,
    observation,
    detections,
    belief,
    links,
    leases,
};
/// `snapshot`, `signals`, ...
std::string_view name(RecordingTable table);
std::vector<std::string> recording_table_names();
std::optional<RecordingTable> recording_table_from(std::string_view word);

/// SUMO's ids by index.
struct RoadNames {
    std::vector<std::string> lanes;
    std::vector<std::string> signals;
};

/// A vehicle as a cell: SUMO's id, or its key where the roster does not know it; empty for none.
std::string vehicle_cell(const traffic::Roster& roster, core::VehicleKey key);

/// Header of the table, units in the names of columns, with its line end.
std::string csv_header(RecordingTable table);
/// The lines of one step, in the order of the recording; empty where the step has nothing of the table. Reals
/// are the shortest text that reads back as the same number; an empty cell is a lane or vehicle that is none.
std::string csv_lines(RecordingTable table, const RecordedStep& step, const RoadNames& names);

}  // namespace clearway::trace
