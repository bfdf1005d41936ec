#pragma once

#include <cstdint>

#include "core/keyed_series.hpp"
#include "core/random.hpp"
#include "core/units.hpp"
#include "failures/failure_config.hpp"

namespace clearway::sensing {

/// Number of a message of a sender: message k goes out at the first decision at or after k x interval since
/// time 0 of the simulation at which there is something to send, or never. All draws are keyed by it, so they
/// depend neither on the step length nor on other senders.
using MessageNumber = std::uint64_t;

/// Which receivers hear a request of an emergency vehicle: a pure function of (sender, receiver, message
/// number, distance), so that all conditions of a replication have the same channel.
///
/// A receiver in outage (Gilbert-Elliott) hears nothing. Otherwise it hears a message that reaches it, except
/// for the share that is lost. `sharp`: a message reaches everybody within the range. `los`, `nlos`: it
/// reaches a receiver where path loss and shadowing together stay below the path loss at the range R,
///
///     10 n log10(d / R) + X < 0,   X normal with standard deviation s
///
/// so that half of all receivers at the range are in reach. n and s are those of 3GPP TR 37.885, table
/// 6.2.1-1: line of sight on highways PL = 32.4 + 20 log10(d) + 20 log10(f), so n = 2, s = 3 dB; without line
/// of sight PL = 36.85 + 30 log10(d) + 18.9 log10(f), so n = 3, s = 4 dB. Constant and frequency cancel.
/// X is the same both ways. Along the way it decorrelates as exp(-travelled / 10 m) (TR 36.885, table
/// A.1.4-1, urban), here at 50 km/h from one message to the next, because draws cannot depend on speeds.
/// Fast fading and collisions of messages are left to the loss rate.
class Channel {
  public:
    /// Which draws it uses: requests to vehicles and to signals fail independently.
    enum class Receivers : std::uint8_t { vehicles, signals };
    Channel(const failures::FailureConfig& config, const core::KeyedRandom& random, Receivers receivers);

    bool is_perfect() const { return config_.propagation == failures::Propagation::perfect; }
    const failures::ChannelConfig& config() const { return config_; }
    /// Number of the latest message that is due at a time of at least 0.
    MessageNumber message_at(core::Seconds time) const;
    /// Whether the sender's own radio is in an outage. `sender` is the value of a vehicle's key.
    bool is_silent(std::uint64_t sender, MessageNumber message) const;
    /// Whether the receiver, a vehicle's key or a signal's number, hears the message.
    bool hears(std::uint64_t sender, std::uint64_t receiver, MessageNumber message, double distance_m) const;
    /// Whether `sender` hears an answer of `receiver`: shadowing and outages are those of the way there, for
    /// the radios are the same; the loss is drawn anew.
    bool hears_answer(std::uint64_t sender, std::uint64_t receiver, MessageNumber message,
                      double distance_m) const;

  private:
    bool is_lost(std::uint64_t from, std::uint64_t to, MessageNumber message) const;
    Channel(const failures::ChannelConfig& config, failures::EmergencyDark sender_dark,
            const core::KeyedRandom& random, Receivers receivers);
    bool is_in_reach(std::uint64_t sender, std::uint64_t receiver, MessageNumber message,
                     double distance_m) const;

    failures::ChannelConfig config_;
    failures::EmergencyDark sender_dark_;
    core::KeyedRandom random_;
    core::Purpose loss_;
    core::GilbertElliott outages_;
    core::NormalSeries shadowing_;
};

}  // namespace clearway::sensing
