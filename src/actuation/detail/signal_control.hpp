#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "actuation/detail/background_plan.hpp"
#include "actuation/detail/lease_queue.hpp"
#include "actuation/detail/signal_states.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"
#include "traffic/command.hpp"
#include "truth/self_knowledge.hpp"

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
};

/// Lanes, ascending.
using Lanes = std::vector<core::LaneIndex>;

/// What a signal meets in one step.
struct SignalContext {
    core::Seconds now;
    const std::string& state;  ///< What it shows now; empty when there is no such signal any more.
    const SignalTiming& timing;
    const Lanes& occupied;  ///< Internal lanes with a vehicle on them.
    /// Lanes with a vehicle that could stop before their end, but not comfortably. Looked for when the first
    /// signal of a step asks: few end a green.
    const std::function<const Lanes&()>& pressed;
    /// Asked for pedestrians when somebody is to get green, and for the program before one of its phases
    /// starts.
    const truth::SelfKnowledge& self;
};

/// The leases of one signal and where it is on the way between its background plan and what they hold.
///
/// background plan -> (yellow) -> (all red) -> hold -> (yellow) -> (all red) -> background plan. Yellow is
/// shown where a link loses green, all red wherever a link gains it, for longer while the junction is not
/// clear; links that keep green keep it all the way. Crossings turn red when others turn yellow, and nobody
/// may walk any more on one that gets crossed, whether by new green or by green that no longer yields. The
/// way back leads to the phase that a lease asks for; without one all links are cleared, because where the
/// program is by then is not known. A request that changes on the way starts the way again from what is shown
/// now. Simulated steps decide when a stage ends: it never is shorter than asked. A green ends when nobody on
/// it is so near that he could just stop, or a little later all the same.
///
/// In the background plan such a lease ends a green that serves none of its links, once that has lasted its
/// least time: the program goes on with its next phase, so with its own yellow. Afterwards a program of fixed
/// times is brought back into step, green by green: its neighbours count on it.
///
/// A hold that had to end at its cap comes again after a whole cycle of the background plan, so that nobody
/// is left without green for an emergency vehicle that is stuck.
class SignalControl {
  public:
    /// The network outlives the object.
    SignalControl(core::SignalIndex index, const roads::Network& network);

    void offer(const traffic::Lease& lease, Ledger& ledger);
    void step(const SignalContext& around, Ledger& ledger, std::vector<traffic::Command>& commands);
    void restore(std::vector<traffic::Command>& commands);

    std::size_t active() const { return holds_.size() + adjustments_.size(); }
    /// Nothing is held, and a new hold would be accepted at once.
    bool is_idle(core::Seconds now) const;

  private:
    enum class Stage : std::uint8_t { background_plan, yellow, all_red, hold };
    /// From what is shown to what shall be.
    struct Way {
        Links links;                                ///< What is to be held; empty on the way back.
        std::string target;                         ///< What is shown at its end.
        Links gaining;                              ///< Whose ways must be clear before: all that it serves.
        std::optional<std::uint32_t> return_phase;  ///< Where the program starts after the way back.
    };

    Links requested(Ledger& ledger);
    Links allowed_now(core::Seconds now, const SignalTiming& timing, Ledger& ledger);
    Way plan_hold(const Links& links) const;
    Way plan_return(Ledger& ledger);
    void begin(Way way, const SignalContext& around, std::vector<traffic::Command>& commands);
    void run_background_plan(const SignalContext& around, Ledger& ledger,
                             std::vector<traffic::Command>& commands);
    void proceed(const SignalContext& around, std::vector<traffic::Command>& commands);
    template <class IsBusy>
    bool is_clear(const Links& gaining, IsBusy&& is_busy) const;
    bool is_left_by_vehicles(const Links& gaining, const SignalContext& around) const;
    bool is_left_by_pedestrians(const SignalContext& around) const;
    bool may_open(const SignalContext& around) const;
    bool waits_for_gap(const std::string& target, const SignalContext& around);
    bool knows_program(const SignalContext& around) const;
    void enter(Stage stage, const std::string& state, core::Seconds now,
               std::vector<traffic::Command>& commands);
    void return_to_program(core::Seconds now, const SignalTiming& timing,
                           std::vector<traffic::Command>& commands);

    core::SignalIndex index_;
    const roads::Signal& signal_;
    std::vector<std::vector<core::LaneIndex>> inner_lanes_;  ///< By link: its ways through the junction.
    LeaseQueue holds_;
    LeaseQueue adjustments_;
    Stage stage_ = Stage::background_plan;
    core::Seconds stage_since_;
    /// When the signal last left its background plan, or was last handed over to links that conflict.
    core::Seconds taken_since_;
    core::Seconds lockout_until_{-1e9};
    bool capped_ = false;  ///< Held for the cap: on the way back whatever is asked.
    std::string shown_;
    Way way_;
    Links last_held_;                           ///< Links of the last way that was none back.
    std::optional<core::Seconds> gap_awaited_;  ///< Since when a green is kept for want of a gap.
    bool asked_for_gap_ = false;                ///< In this step.
    bool program_known_ = false;                ///< Of the program that was left.
    BackgroundPlan own_;
};

}  // namespace clearway::actuation::detail
