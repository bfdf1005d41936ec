#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.hpp"
#include "traffic/priority_request.hpp"

namespace clearway::traffic {

/// A request for green that is in force at a signal, served or not.
struct SignalCall {
    core::VehicleKey emergency;        ///< Value 0 where the policy named none.
    std::vector<std::uint16_t> links;  ///< That the emergency vehicle itself may take, ascending.
    RequestStatus status = RequestStatus::processing;
};

/// What a signal is doing about requests.
enum class SignalStage : std::uint8_t {
    program,     ///< Its own program runs.
    transition,  ///< Yellow or all red, towards a hold or back to the program.
    dwell,       ///< The hold is shown.
};

/// How a signal stands to its neighbours.
enum class Coordination : std::uint8_t { none, in_step, out_of_step };

/// One signal that policies ask for, or have asked for until it is back in its program and in step.
struct SignalStatus {
    core::SignalIndex signal;
    SignalStage stage = SignalStage::program;
    /// Links that it holds or is about to hold, ascending; empty on the way back and while its program runs.
    std::vector<std::uint16_t> held;
    bool capped = false;  ///< The hold reached its longest time and ends, whatever is asked for.
    Coordination coordination = Coordination::none;
    std::vector<SignalCall> calls;
};

}  // namespace clearway::traffic
