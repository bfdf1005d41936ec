#pragma once

#include <array>
#include <cstdint>

#include "traffic/priority_request.hpp"

namespace clearway::traffic {

/// What became of the requests of a run. A request is a lease that an emergency vehicle asks another vehicle
/// or a signal for; what it does itself is none. Requests are counted once for each message that carries
/// them, so one that is renewed counts again.
struct RequestCounts {
    std::uint64_t sent = 0;     ///< To vehicles.
    std::uint64_t heard = 0;    ///< Of `sent`: those that the vehicle heard, itself or by a relay.
    std::uint64_t relayed = 0;  ///< Of `heard`: those that only a relay brought.
    /// What the same policies, had they known everything, would have asked at the same moments.
    std::uint64_t needed = 0;
    std::uint64_t useless = 0;         ///< Of `sent`: those that were not needed.
    std::uint64_t missed = 0;          ///< Of `needed`: those not sent or not heard.
    std::uint64_t messages = 0;        ///< Transmissions to vehicles: one for each sender and relay.
    std::uint64_t vehicles_asked = 0;  ///< Different vehicles that heard a request.
    std::uint64_t signal_sent = 0;     ///< To signals, by policies whose leases are the requests.
    std::uint64_t signal_heard = 0;
    std::uint64_t signal_messages = 0;

    bool operator==(const RequestCounts&) const = default;
};

/// What became of the requests that emergency vehicles sent to signals as messages
/// (traffic::PriorityRequest), and what they were told. Requests are counted once for each message that
/// carries them.
struct SignalRequestCounts {
    std::uint64_t sent = 0;
    std::uint64_t heard = 0;          ///< Of `sent`: by the signal.
    std::uint64_t messages = 0;       ///< Transmissions of vehicles.
    std::uint64_t updates = 0;        ///< Of `sent`.
    std::uint64_t cancellations = 0;  ///< Of `sent`.
    std::uint64_t answers_sent = 0;   ///< One for each message of a signal and open request.
    std::uint64_t answers_heard = 0;  ///< Of `answers_sent`: by the vehicle.
    /// By RequestStatus: requests whose vehicle heard this status at least once.
    std::array<std::uint64_t, request_status_count> told{};
    double until_granted_s = 0.0;  ///< From the first message to the first answer `granted`, summed.

    bool operator==(const SignalRequestCounts&) const = default;
};

/// Greens that signals held for an emergency vehicle, from the moment at which it may go until it may not.
struct HeldGreenCounts {
    std::uint64_t greens = 0;
    std::uint64_t useless = 0;  ///< Of `greens`: its vehicle did not pass in it.
    double useless_s = 0.0;     ///< Their duration, summed.

    bool operator==(const HeldGreenCounts&) const = default;
};

}  // namespace clearway::traffic
