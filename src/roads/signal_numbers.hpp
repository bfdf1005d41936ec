#pragma once

#include <cstdint>
#include <vector>

#include "roads/network.hpp"

namespace clearway::roads {

/// The numbers by which a controller would speak of the links of a signal, by link; 0 for a link that
/// controls nothing.
struct SignalNumbers {
    /// With the controller NEMA, the number by which the phase that serves the link is named; of several the
    /// lowest. Else signal groups, which American controllers call phases: links with the same colour in
    /// every phase of the program, vehicles and people on foot apart, counted from 1 in the order of their
    /// first links.
    std::vector<std::uint32_t> phase;
    /// Approaches (edges), counted from 1 in the order of their first links: one pre-empt for each. 0 for
    /// crossings.
    std::vector<std::uint32_t> approach;
};
SignalNumbers signal_numbers(const Network& network, const Signal& signal);

}  // namespace clearway::roads
