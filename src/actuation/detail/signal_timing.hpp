#pragma once

#include "actuation/detail/clearance.hpp"
#include "actuation/detail/link_history.hpp"

namespace clearway::actuation::detail {

/// Times of a signal's transitions, s.
struct SignalTiming {
    double yellow_s;
    double all_red_s;
    double clearing_s;
    double walking_s;
    double gap_wait_s;
    double hold_cap_s;
    double lockout_s;
    double least_green_s;
    double entry_green_s;
    double walk_s;
};

/// What a signal owes its links beyond SignalTiming, when clearance follows its own program.
struct SignalDuties {
    const Clearance& clearance;
    LinkHistory& history;  ///< Also told what the signal is made to show.
};

}  // namespace clearway::actuation::detail
