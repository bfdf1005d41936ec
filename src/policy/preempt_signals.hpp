#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "core/fields.hpp"
#include "core/spellings.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/hold_planner.hpp"
#include "policy/detail/request_table.hpp"
#include "policy/detail/room.hpp"
#include "policy/request_memory.hpp"
#include "policy/signal_messages.hpp"
#include "roads/short_loops.hpp"

namespace clearway::policy {

/// From when a signal is held.
enum class HoldTiming : std::uint8_t {
    lead,      ///< A lead before arrival, longer behind standing vehicles.
    queues,    ///< Earlier than that where a model of the queues at the signal finds it worth while.
    no_queue,  ///< The same with a model that sees no vehicles: a control.
};
constexpr core::Spellings<HoldTiming, 3> spellings(HoldTiming) {
    return {{{HoldTiming::lead, "lead"}, {HoldTiming::queues, "queues"}, {HoldTiming::no_queue, "no_queue"}}};
}

/// Settings of PreemptSignals.
struct PreemptSignalsConfig {
    double lead_s = 8.0;
    double lead_per_halted_s = 2.0;
    double longest_lead_s = 40.0;
    double slowest_share = 0.5;
    double horizon_m = 600.0;
    double halted_mps = 0.5;
    double short_block_m = roads::usual_short_block_m;
    double exit_room_m = 0.0;
    int signals_ahead = 3;
    double lease_s = 0.0;
    HoldTiming timing = HoldTiming::queues;
    double emergency_worth = 50.0;
    double least_gain_s = 2.0;
    double longest_early_s = 20.0;
    double longest_late_s = 0.0;

    static constexpr void fields(const auto& table) {
        using C = PreemptSignalsConfig;
        using core::Field;
        table(
            Field{"lead_s", "s", &C::lead_s, 0.0, 60.0, "Green is asked for this long before arrival",
                  "trials: 20 s helps little more and makes others wait much longer"},
            Field{"lead_per_halted_s", "s", &C::lead_per_halted_s, 0.0, 10.0,
                  "And this much earlier per vehicle that stands ahead", "saturation headway"},
            Field{"longest_lead_s", "s", &C::longest_lead_s, 0.0, 60.0, "But no earlier than this",
                  "assumed: leaves 20 s of the longest hold for driving through"},
            Field{"slowest_share", "1", &C::slowest_share, 0.01, 1.0,
                  "Arrival is estimated with at least this share of the allowed speed",
                  "assumed: a standing queue moves once it has green"},
            Field{"horizon_m", "m", &C::horizon_m, 1.0, 5000.0, "Signals farther away than this are ignored",
                  "assumed: the longest lead at 15 m/s"},
            Field{"halted_mps", "m/s", &C::halted_mps, 0.0, 5.0, "A slower vehicle counts as standing",
                  "assumed: walking pace is 1.4 m/s"},
            Field{"short_block_m", "m", &C::short_block_m, 0.0, 1000.0,
                  "For signals on closed loops of blocks shorter than this, `exit_room_m` and "
                  "`signals_ahead` limit holds; 0: no signal is limited",
                  "docs/findings/short-blocks.md; no scenario of the other findings has such loops"},
            Field{"exit_room_m", "m", &C::exit_room_m, 0.0, 200.0,
                  "On such loops no request begins while standing vehicles leave less than this free behind "
                  "the signal; 0: no limit",
                  "0: no gain from it is shown, docs/findings/short-blocks.md"},
            Field{"signals_ahead", "1", &C::signals_ahead, 0.0, 50.0,
                  "On such loops at most this many of the next signals are held for one emergency vehicle; "
                  "0: no limit",
                  "fewest jams of 0, 2 and 3: docs/findings/short-blocks.md, confirmed on fresh "
                  "seeds"},
            Field{"lease_s", "s", &C::lease_s, 0.0, 60.0,
                  "Lifetime of a hold that the signal does not renew; 0: two periods",
                  "short, because the next emergency vehicle waits for its end; `memory` says how long a "
                  "request lasts"},
            Field{"timing", "", &C::timing, 0, 0,
                  "`queues` asks earlier than the lead where a model of the queues finds it worth while; "
                  "`no_queue` is its control: the same with a model that sees no vehicles",
                  "faster than `lead` in some networks, slower in none: docs/findings/cities.md"},
            Field{"emergency_worth", "1", &C::emergency_worth, 0.0, 10000.0,
                  "With `queues`: a second of an emergency vehicle is worth so many of other vehicles",
                  "trials on twelve sets of streets: 30 to 100 are level, 300 costs others more"},
            Field{"least_gain_s", "s", &C::least_gain_s, 0.0, 60.0,
                  "With `queues`: a hold begins earlier than the lead says only for a gain of so much",
                  "assumed: about what the model errs by"},
            Field{"longest_early_s", "s", &C::longest_early_s, 0.0, 60.0,
                  "With `queues`: a hold begins at most so much earlier than the lead says",
                  "trials: without a limit the others lose 4 % more in the dense city"},
            Field{"longest_late_s", "s", &C::longest_late_s, 0.0, 60.0,
                  "With `queues`: where that or none costs less by `emergency_worth`, a hold begins later, "
                  "until "
                  "the vehicle is so much nearer than the lead asks for; from 40 on: no limit",
                  "0: never later, as in docs/findings/cities.md where it is not named"});
    }
};

/// Preempts the signals on the route of every emergency vehicle: green for its approach, early enough that
/// the queue ahead is gone when it arrives. Yellow, all-red, the longest hold, lockout and the return to the
/// background plan are up to actuation. Where short blocks form closed loops it holds back.
///
/// Emergency vehicles ask by message, and each signal decides from what came to it (SignalMessages). With a
/// perfect channel every signal knows what every emergency vehicle knows of itself.
class PreemptSignals : public ConfiguredPolicy<PreemptSignalsConfig>, public SignalMessages {
  public:
    explicit PreemptSignals(const PolicyContext& context, PreemptSignalsConfig config = {},
                            RequestMemorySettings memory = {});

    std::string_view name() const override { return "preempt_signals"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;
    SignalMessages* messages() override { return this; }

    std::string_view part() const override { return name(); }
    void ask(const traffic::BelievedGraph& belief,
             std::vector<traffic::PriorityRequest>& wanted) const override;
    void hear(std::span<const traffic::PriorityRequest> messages) override;
    std::vector<RequestKey> open_requests() const override;

  private:
    /// Seconds to a place so far ahead.
    double arrival_s(const detail::View& view, const traffic::BelievedVehicle& emergency,
                     double distance_m) const;
    /// Emergency vehicles that come to signals, as these know.
    std::vector<detail::Arrival> arrivals(const detail::View& view);
    /// Whether a signal in short blocks does not answer.
    bool stands_back(const detail::Arrival& arrival, const detail::Room* room, bool is_asked) const;
    /// When the lead asks, from now; not above 0: it is time.
    double early_s(const detail::View& view, const detail::Arrival& arrival) const;
    /// Whether a signal is to be held for it now; `is_asked`: it was at the last call.
    bool is_due(const detail::View& view, const detail::Arrival& arrival, bool is_asked);

    RequestMemorySettings memory_;
    std::vector<bool> is_careful_;  ///< By signal; empty if none is on a loop of short blocks.
    /// Vehicles and the signals requested for them at the last call. A request stands until the vehicle has
    /// passed, because a queue that begins to move is not gone yet.
    std::set<RequestKey> asked_;
    std::optional<detail::HoldPlanner> planner_;  ///< Unless the lead alone decides.
    std::optional<detail::RequestTable> table_;   ///< Once it was told of messages.
    std::vector<traffic::PriorityRequest> inbox_;
};

}  // namespace clearway::policy
