#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "policy/signal_messages.hpp"
#include "roads/network.hpp"
#include "sensing/channel.hpp"
#include "sensing/line_of_sight.hpp"
#include "traffic/priority_request.hpp"
#include "traffic/request_counts.hpp"
#include "traffic/signal_status.hpp"
#include "truth/snapshot.hpp"

namespace clearway::pipeline {

/// The radio between emergency vehicles and signals. A vehicle sends one message for all signals that it
/// asks, at most once an interval of the channel; each of these hears it or not. What it asked for in the
/// message before is an update, and a signal that it has passed gets its cancellation with the next three
/// messages, because nobody confirms one. A signal answers with what becomes of each request that is open
/// there, over the same channel. Answers change nothing that is decided; they are counted. Part of the
/// environment: it knows the truth, and gives messages alone to policies. One thread.
class SignalRadio {
  public:
    /// The network outlives the radio.
    SignalRadio(const roads::Network& network, const failures::FailureConfig& failure,
                const core::KeyedRandom& random);

    bool is_perfect() const { return channel_.is_perfect(); }
    /// At each decision: sends what emergency vehicles want, as SignalMessages::ask lists it.
    void exchange(std::span<const traffic::PriorityRequest> wanted, const truth::Snapshot& snapshot);
    /// Messages that have come to signals by the last exchange and not before it.
    std::span<const traffic::PriorityRequest> arrived() const { return arrived_; }
    /// After each decision was carried out: signals answer the requests that are open there.
    void answer(std::span<const policy::RequestKey> open, std::span<const traffic::SignalStatus> signals,
                const truth::Snapshot& snapshot);
    const traffic::SignalRequestCounts& counts() const { return counts_; }

  private:
    using Key = policy::RequestKey;
    /// One approach of a vehicle to a signal, as the vehicle keeps it.
    struct Approach {
        traffic::PriorityRequest last;
        std::optional<core::Seconds> first_sent;
        bool is_wanted = true;
        int cancellations_left = 0;
        std::array<bool, traffic::request_status_count> told{};
    };
    struct Answer {
        double arrives_s = 0.0;
        Key key;
        std::uint32_t request_id = 0;
        traffic::RequestStatus status = traffic::RequestStatus::requested;
    };
    struct OnItsWay {
        double arrives_s = 0.0;
        traffic::PriorityRequest message;
    };

    bool is_due(core::Seconds now);
    void want(const traffic::PriorityRequest& request);
    /// Sends the message of one vehicle.
    void send(core::VehicleKey vehicle, const truth::Snapshot& snapshot);
    void transmit(const traffic::PriorityRequest& message, core::VehicleIndex sender,
                  const truth::Snapshot& snapshot);
    void receive_answers(core::Seconds now);
    double apart_m(core::VehicleIndex vehicle, core::SignalIndex signal,
                   const truth::Snapshot& snapshot) const;

    sensing::Channel channel_;
    std::vector<std::optional<sensing::Place>> places_;  ///< By signal.
    std::optional<sensing::MessageNumber> last_message_;
    bool is_due_ = false;  ///< At the present decision.
    std::map<Key, Approach> approaches_;
    std::map<core::VehicleKey, std::uint32_t> sequences_, request_ids_;
    std::vector<OnItsWay> on_their_way_;
    std::vector<traffic::PriorityRequest> arrived_;
    std::vector<Answer> answers_;
    traffic::SignalRequestCounts counts_;
};

}  // namespace clearway::pipeline
