#pragma once

#include <vector>

#include "roads/network.hpp"

namespace clearway::roads {

/// What the program of a signal shows of one link, s; 0 where it shows none.
struct OwnClearance {
    double yellow_s = 0.0;  ///< Longest yellow after a green.
    /// From the end of the yellow (of the green, without one) until any link opens, but not while other
    /// vehicles go for whom that one waits: the shortest in the cycle of those after which a link that
    /// conflicts opens before it is green again. 0 where a link opens during the yellow already.
    double red_s = 0.0;
};

/// By link number.
std::vector<OwnClearance> own_clearances(const Signal& signal);

}  // namespace clearway::roads
