#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace clearway::metrics {

/// A traffic flow counted on a road.
struct EdgeCount {
    std::string edge;
    double vehicles_per_hour = 0.0;
};

/// Reads counted flows: CSV with the columns `edge,vehicles_per_hour`, one line per edge. Throws
/// core::InputError with every problem, each with file and line: another header, an edge listed twice, a
/// missing or negative number, no edge at all.
std::vector<EdgeCount> read_counts(const std::filesystem::path& file);

}  // namespace clearway::metrics
