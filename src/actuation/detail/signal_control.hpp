#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "actuation/detail/background_plan.hpp"
#include "actuation/detail/lease_queue.hpp"
#include "actuation/detail/link_transition.hpp"
#include "actuation/detail/signal_states.hpp"
#include "actuation/detail/signal_timing.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"
#include "traffic/command.hpp"
#include "traffic/signal_status.hpp"
#include "truth/self_knowledge.hpp"

namespace clearway::actuation::detail {

/// Lanes, ascending.
using Lanes = std::vector<core::LaneIndex>;

/// The situation of a signal in one step.
struct SignalContext {
    core::Seconds now;
    const std::string& state;  ///< What it shows now; empty when the signal no longer exists.
    const SignalTiming& timing;
    const Lanes& occupied;  ///< Internal lanes with a vehicle on them.
    /// Lanes with a vehicle that could stop before their end, but not comfortably. Computed on demand,
    /// because few signals end a green in a step.
    const std::function<const Lanes&()>& pressed;
    /// Tells whether pedestrians are on crossings, and which program runs.
    const truth::SelfKnowledge& self;
    const SignalDuties& duties;
};

/// The leases of one signal, and its transitions between the background plan and their holds.
///
/// background plan -> transition -> hold -> transition -> background plan. In a transition each link ends,
/// waits and opens by itself (LinkTransition); links that keep green keep it throughout, and no green ends
/// before its least time. The return leads to the phase that a lease asks for; without one, to where the
/// program goes on; if that is unknown, all links are cleared. If the request changes during a transition,
/// the transition turns to the new target. A yellow or red ends at a simulated step, so it is never shorter
/// than configured. A green ends when no vehicle on it could only just stop, or after a short wait.
///
/// While the background plan runs, an AdjustGreen lease ends a green that serves none of its links once that
/// has lasted its least time: the program goes on to its next phase, through its own yellow. Afterwards a
/// fixed-time program is brought back into step, green by green, because its neighbours depend on it.
///
/// A signal may have parameters of its own (traffic::Preemption): a request waits for its delay; a hold that
/// has begun lasts its least duration and dwell even if the request has ended, unless another takes over;
/// the return leads to the exit phase, regardless of what a lease asks for.
///
/// A hold that ended at its cap may return after a whole cycle of the background plan, so that an emergency
/// vehicle that is stuck does not keep everybody else waiting.
class SignalControl {
  public:
    /// The network outlives the object.
    SignalControl(core::SignalIndex index, const roads::Network& network);

    void offer(const traffic::Lease& lease, Ledger& ledger);
    void step(const SignalContext& around, Ledger& ledger, std::vector<traffic::Command>& commands);
    /// The last call.
    void restore(std::vector<traffic::Command>& commands) const;

    std::size_t active() const { return holds_.size() + adjustments_.size(); }
    /// Whether nothing is held and a new hold would be accepted at once.
    bool is_idle(core::Seconds now) const;
    /// For displays and logs.
    traffic::SignalStatus status(core::Seconds now) const;

  private:
    enum class Stage : std::uint8_t { background_plan, transition, hold };
    /// A transition from what is shown to a target.
    struct Way {
        Links links;         ///< Links to hold; empty on the way back.
        std::string target;  ///< State shown at its end.
        Links gaining;       ///< All links that are green in `target`; their ways must be clear first.
        /// Phase at which the program restarts after the way back.
        std::optional<std::uint32_t> return_phase;
        bool in_turn = false;  ///< Nobody asked for that phase: it is where the program goes on.
    };

    traffic::RequestStatus status_of(const HeldLease& held, core::Seconds now) const;
    std::uint16_t link_count() const { return static_cast<std::uint16_t>(inner_lanes_.size()); }
    std::optional<traffic::Refusal> reason_to_wait(HeldLease& held, const SignalContext& around) const;
    Links requested(const SignalContext& around, Ledger& ledger);
    Links allowed_now(const SignalContext& around, Ledger& ledger);
    bool must_go_on(const SignalContext& around) const;
    Way plan_hold(const Links& links) const;
    Way plan_return(const SignalContext& around, Ledger& ledger);
    std::optional<std::uint32_t> phase_after_hold(const SignalTiming& timing, Ledger& ledger);
    void begin(Way way, const SignalContext& around);
    void run_background_plan(const SignalContext& around, Ledger& ledger,
                             std::vector<traffic::Command>& commands);
    void proceed(const SignalContext& around, std::vector<traffic::Command>& commands);
    bool waits_for_gap(const std::string& target, const SignalContext& around);
    double owed_green_s(std::uint16_t link, std::optional<std::uint32_t> phase,
                        const SignalTiming& timing) const;
    OwedGreen owed_by(const SignalTiming& timing) const;
    bool owes_green(const std::string& target, const SignalContext& around) const;
    void clear_link_by_link(const SignalContext& around, std::vector<traffic::Command>& commands);
    bool knows_program(const SignalContext& around) const;
    void enter(Stage stage, const std::string& state, core::Seconds now,
               std::vector<traffic::Command>& commands);
    std::optional<core::Seconds> first_duration(std::uint32_t phase, const SignalTiming& timing) const;
    void return_to_program(core::Seconds now, const SignalTiming& timing,
                           std::vector<traffic::Command>& commands);

    core::SignalIndex index_;
    const roads::Signal& signal_;
    std::vector<std::vector<core::LaneIndex>> inner_lanes_;  ///< By link: internal lanes of its ways.
    LeaseQueue holds_;
    LeaseQueue adjustments_;
    Stage stage_ = Stage::background_plan;
    core::Seconds stage_since_;
    /// When the signal last left its background plan, or its hold last passed to conflicting links.
    core::Seconds taken_since_;
    core::Seconds lockout_until_{-1e9};
    bool capped_ = false;  ///< The hold reached its cap: it goes back, whatever leases ask for.
    std::string shown_;
    Way way_;
    LinkTransition transition_;
    Links last_held_;                           ///< Links of the last hold.
    std::optional<core::Seconds> gap_awaited_;  ///< Since when a green waits for a gap.
    bool asked_for_gap_ = false;                ///< In this step.
    bool program_known_ = false;                ///< Whether the program that was left is the known one.
    BackgroundPlan own_;
};

}  // namespace clearway::actuation::detail
