#pragma once

#include <string>
#include <vector>

#include "metrics/signal_event.hpp"

namespace clearway::results::detail {

/// Column names, without a newline: those of the field table, then what the code means in words.
std::string signal_event_header();
/// The cells of a row.
std::string signal_event_cells(const metrics::SignalEvent& event);

/// `signal_events.csv` of a run.
std::string signal_events_to_csv(const std::vector<metrics::SignalEvent>& events);
/// Throws core::InputError, naming file and line, for another header, cells that are missing or too many,
/// what is not a number, an unknown code and rows out of order.
std::vector<metrics::SignalEvent> signal_events_from_csv(const std::string& text, const std::string& where);

}  // namespace clearway::results::detail
