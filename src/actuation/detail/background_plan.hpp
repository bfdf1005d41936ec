#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/units.hpp"
#include "roads/network.hpp"

namespace clearway::actuation::detail {

/// A phase to go on with, and for how long.
struct PhaseChange {
    std::uint32_t phase = 0;
    core::Seconds lasting;
};

/// Whether other signals count on a signal's times: its program waits for no vehicle, and another signal
/// stands within 800 m, up to where signals are usually coordinated (MUTCD 2009, section 4D.17: half a mile).
bool keeps_step(core::SignalIndex signal, const roads::Network& network);

/// What a signal's background plan does while nothing is held: which phase it is in, since when, and what
/// would bring it back into step with its neighbours after it was started at a phase of ours.
class BackgroundPlan {
  public:
    /// The signal outlives the object; `keeps_step`: see above.
    BackgroundPlan(const roads::Signal& signal, bool keeps_step);

    /// What the signal shows while its background plan runs.
    void watch(const std::string& state, core::Seconds now);
    /// It was started at a phase, out of turn.
    void disturb(core::Seconds now);
    /// It no longer runs.
    void leave() { state_.clear(); }

    /// Nothing is left to do: in step, or without a step to keep, or there is no way back.
    bool is_in_step(core::Seconds now) const;
    /// Time of one cycle, s; 0 without a program.
    double cycle_s() const { return cycle_s_; }
    /// The phase after a green that has lasted `least_green_s`; nothing otherwise.
    std::optional<std::uint32_t> next_after(core::Seconds least_green, core::Seconds now) const;
    /// At the start of a green of a fixed-time program that is out of step: how long the green lasts on the
    /// shorter way back into step: not under `least_green`, nor more than half as long again.
    std::optional<PhaseChange> step_back(core::Seconds least_green, core::Seconds now);

  private:
    /// How much later than on its own the phase would end in step, in half a cycle either way, s.
    double lag_s(std::uint32_t phase, core::Seconds now) const;

    const roads::Signal& signal_;
    bool keeps_step_ = false;
    double cycle_s_ = 0.0;
    std::string state_;  ///< Empty while another than the background plan runs.
    core::Seconds since_;
    bool in_step_ = true;
    core::Seconds disturbed_;
    bool just_changed_ = false;
};

}  // namespace clearway::actuation::detail
