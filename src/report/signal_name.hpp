#pragma once

#include <string>

namespace clearway::report {

/// At most 24 characters of a signal's id for a terminal: those of joined junctions name all their nodes.
std::string short_signal_name(const std::string& id);

}  // namespace clearway::report
