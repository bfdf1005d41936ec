#pragma once

#include <cstddef>

#include "roads/network.hpp"

namespace clearway::roads {

/// What a signal's own program gives one of its links.
struct LinkGreen {
    double share = 0.0;  ///< Of the cycle that it is green; yellow is not.
    /// Mean wait of a vehicle that comes at a random moment and finds nobody before it: the sum of r^2 / (2
    /// C) over the times r without green in a cycle C, which is the first term of F. V. Webster's delay
    /// (Traffic signal settings, Road Research Technical Paper 39, 1958) without flow. 0 for a link that is
    /// never green: what it lets pass, the program does not say.
    double wait_s = 0.0;
};

/// Whether a phase gives a link green; not if its state has no letter for it.
bool gives_green(const Phase& phase, std::size_t link);

/// By the durations of the phases; of a program that vehicles actuate, those that it states. Phases that run
/// side by side (controller NEMA) are taken for two rings of the same cycle.
LinkGreen link_green(const Signal& signal, std::size_t link);

}  // namespace clearway::roads
