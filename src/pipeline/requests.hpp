#pragma once

#include <compare>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "experiment/condition.hpp"
#include "pipeline/decision_chain.hpp"
#include "sensing/channel.hpp"
#include "sensing/line_of_sight.hpp"
#include "sensing/processes.hpp"
#include "traffic/lease.hpp"
#include "traffic/request_counts.hpp"
#include "truth/snapshot.hpp"

namespace clearway::pipeline {

/// Delivers requests of policies to the vehicles and signals that receive them. Part of the environment: it
/// knows the truth, and nothing of it comes back to a policy.
///
/// A lease is a request when its beneficiary is another than its target. One to a stretch of road becomes a
/// request to each vehicle that is there when it is sent; a message goes out even where nobody is. All
/// requests of an emergency vehicle to vehicles at one decision are one message, those to signals another. A
/// vehicle hears it from the emergency vehicle or, with more than one hop, from an automated vehicle that has
/// heard it and sends it on; each hop adds the latency, and what comes after a newer request of the same
/// policy and sender is outdated. Human-driven vehicles that are not equipped hear nothing. Leases of
/// vehicles and signals about themselves need no message, nor do those that signals decided from messages
/// which have come to them already (SignalRadio). With perfect channels, every lease arrives at once, but for
/// the ways that FailureConfig::way_loss_rate takes. One thread.
class Requests {
  public:
    /// Throws core::InputError as DecisionChain does.
    Requests(const experiment::ConditionSpec& condition, const ChainContext& context);

    /// What a chain decided at this step.
    struct Decision {
        std::span<const traffic::Lease> leases;
        /// Vehicles that commands cannot reach, ordered by key: they hear nothing.
        std::span<const core::VehicleKey> unreachable;
        bool is_new = false;  ///< Whether a decision was made at this step.
        /// Policies whose leases signals decided on by themselves (SignalRadio): these need no message.
        std::span<const std::string_view> decided_there = {};
    };
    /// Call at every step.
    void step(const Decision& decision, const truth::Snapshot& snapshot, const traffic::Roster& roster);
    /// Leases that arrive at this step, those that a message lost, and those that arrive after a newer
    /// request of the same policy and sender to the same target; valid until the next step.
    std::span<const traffic::Lease> arrived() const { return arrived_; }
    std::span<const traffic::Lease> lost() const { return lost_; }
    std::span<const traffic::Lease> outdated() const { return outdated_; }
    const traffic::RequestCounts& counts() const { return counts_; }

  private:
    Requests(const experiment::ConditionSpec& condition, const ChainContext& context,
             const failures::FailureConfig& failure);

    /// Who asks whom for what kind of action.
    struct Asked {
        core::VehicleKey sender;
        core::VehicleKey vehicle;
        std::size_t action = 0;
        auto operator<=>(const Asked&) const = default;
    };
    struct OnItsWay {
        core::Seconds sent;
        double arrives_s = 0.0;
        traffic::Lease lease;
    };
    /// Who asks whom by which policy.
    using Asking = std::tuple<std::string_view, core::VehicleKey, traffic::Target>;
    /// Whose turn it is to send. An emergency vehicle has one message in each interval of the channel; it
    /// carries what the vehicle asks for at one decision. With a perfect channel, every decision is an
    /// interval of its own.
    class Turns {
      public:
        void begin_decision(const sensing::Channel& channel, core::Seconds now);
        bool is_new_interval() const { return is_new_interval_; }
        /// Whether the sender may send at this decision; if so, its turn is used up after it.
        bool take(core::VehicleKey sender);

      private:
        std::optional<sensing::MessageNumber> number_;  ///< Of the present interval.
        bool is_new_interval_ = false;
        std::set<core::VehicleKey> senders_, earlier_senders_;  ///< Of this decision, and before it.
    };
    /// Who hears a message: after how many hops, by row of the snapshot, and behind the rows those beside the
    /// road; 0: not at all. Empty when no message is sent.
    using Hearing = std::vector<int>;
    /// Everything about one decision.
    struct Moment {
        const Decision& decision;
        const truth::Snapshot& snapshot;
        const traffic::Roster& roster;
    };

    static bool is_request(const traffic::Lease& lease, std::span<const std::string_view> decided_there);
    /// Sorts out those that are outdated.
    void receive(core::Seconds now);
    void send(const Moment& moment);
    void ask_vehicle(const traffic::Lease& lease, core::VehicleKey vehicle, const Moment& moment);
    void ask_stretch(const traffic::Lease& lease, const Moment& moment);
    void ask_signal(const traffic::Lease& lease, core::SignalIndex signal, const Moment& moment);
    /// Vehicles that receive what the sender asks of vehicles now; the first call of a step sends the
    /// message.
    const Hearing& hearing_of(core::VehicleKey sender, const Moment& moment);
    Hearing spread(core::VehicleKey sender, const Moment& moment);
    /// Marks vehicles that receive a message of the row `from` and had not received it with fewer hops.
    void transmit(core::VehicleIndex from, int hop, const truth::Snapshot& snapshot, Hearing& hearing);
    static bool is_unreachable(core::VehicleKey vehicle, const Moment& moment);
    void deliver(const traffic::Lease& lease, double latency_s, core::Seconds now);
    void judge(const Moment& moment);

    /// Whether another way does not reach its vehicle.
    bool is_lost_way(const traffic::Lease& lease, core::Seconds now) const;

    sensing::Channel vehicles_, signals_;
    core::KeyedRandom random_;
    double way_loss_rate_;
    sensing::EquipmentProcess equipment_;
    std::vector<std::optional<sensing::Place>> signal_places_;
    /// The same policies with perfect sensors. Null where the condition has them itself, and where a policy
    /// is a user's code, which is asked once: what it wanted counts as needed.
    std::unique_ptr<DecisionChain> informed_;

    Turns vehicle_turns_, signal_turns_;
    std::vector<OnItsWay> on_their_way_;           ///< In the order of sending.
    std::map<Asking, core::Seconds> newest_sent_;  ///< Of those that came with a latency.
    std::vector<traffic::Lease> arrived_, lost_, outdated_;
    std::set<core::VehicleKey> asked_;
    traffic::RequestCounts counts_;
    // Of the present decision.
    std::map<core::VehicleKey, Hearing> hearings_;
    std::set<core::VehicleKey> signal_senders_;
    std::vector<Asked> wanted_, sent_, heard_, needed_;  ///< Wanted: whether or not it could be sent.
};

}  // namespace clearway::pipeline
