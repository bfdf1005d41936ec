#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "roads/network.hpp"
#include "traffic/preemption.hpp"

namespace clearway::scenario {

/// A row of a file of preemption parameters.
struct PreemptionRow {
    traffic::Preemption values;
    std::size_t line = 0;  ///< In the file, from 1.
};
/// By the name of the signal in the file (roads::named_signal).
using PreemptionRows = std::map<std::string, PreemptionRow>;

/// Reads a CSV with one row for each signal: `signal` and the fields of traffic::Preemption, all of them, in
/// any order. Empty cells and signals without a row are not set. Appends every problem, with line and column.
PreemptionRows read_preemption_rows(const std::filesystem::path& file, std::vector<core::Problem>& problems);

/// The parameters by core::SignalIndex. Throws core::InputError with every row of a signal that the network
/// does not have, every minimum green or walk that is longer than the signal's cycle, and every exit phase
/// that its program does not have or that is no green.
std::vector<traffic::Preemption> preemption_of(const PreemptionRows& rows, const std::filesystem::path& file,
                                               const roads::Network& network);

/// What a network tells of its signals: least greens and pedestrian clearance of their programs.
std::vector<traffic::Preemption> preemption_in(const roads::Network& network);

/// The file for these signals, by id; the inverse of reading.
std::string preemption_csv(const roads::Network& network, const std::vector<traffic::Preemption>& signals);

}  // namespace clearway::scenario
