#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trace/recording.hpp"

namespace clearway::trace {

/// The parts of a recording that can be written as a tidy table: one line per step and vehicle (or link,
/// lease, signal, event).
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

/// A vehicle as a cell: SUMO's id, or the key when the roster does not know it; empty for no vehicle.
std::string vehicle_cell(const traffic::Roster& roster, core::VehicleKey key);

/// Header line of the table, line end included. Column names contain units.
std::string csv_header(RecordingTable table);
/// The lines of one step, in the order of the recording; empty when the step has no rows of the table. Reals
/// are the shortest text that reads back as the same number. A missing lane or vehicle is an empty cell.
std::string csv_lines(RecordingTable table, const RecordedStep& step, const RoadNames& names);

}  // namespace clearway::trace
