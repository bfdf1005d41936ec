#pragma once

#include <cstdint>

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
    std::uint64_t signal_sent = 0;
    std::uint64_t signal_heard = 0;
    std::uint64_t signal_messages = 0;

    bool operator==(const RequestCounts&) const = default;
};

}  // namespace clearway::traffic
