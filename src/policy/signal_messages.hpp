#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "traffic/belief.hpp"
#include "traffic/priority_request.hpp"

namespace clearway::policy {

/// An emergency vehicle and a signal that it asks.
using RequestKey = std::pair<core::VehicleKey, core::SignalIndex>;

/// A part of which emergency vehicles ask signals by message. It has two ends: what the crew's unit sends,
/// and what the signals do about what has come. One that is never told of messages has a perfect channel:
/// every signal then knows, at every decision, what each emergency vehicle knows of itself.
class SignalMessages {
  public:
    SignalMessages() = default;
    SignalMessages(const SignalMessages&) = delete;
    SignalMessages& operator=(const SignalMessages&) = delete;
    virtual ~SignalMessages() = default;

    /// The policy whose leases signals decide on by themselves, as the leases name it; static storage.
    virtual std::string_view part() const = 0;
    /// Appends what emergency vehicles ask of signals now, as they know themselves: ordered by vehicle, each
    /// signal once. Request id, sequence and type are left to the radio.
    virtual void ask(const traffic::BelievedGraph& belief,
                     std::vector<traffic::PriorityRequest>& wanted) const = 0;
    /// Messages that have come to signals since the last decision, in the order of their coming. From the
    /// first call on, it acts on messages alone. Call before each `act`.
    virtual void hear(std::span<const traffic::PriorityRequest> messages) = 0;
    /// Requests that are open at their signals since the last `act`, ascending. None while it was never told
    /// of messages.
    virtual std::vector<RequestKey> open_requests() const = 0;
};

}  // namespace clearway::policy
