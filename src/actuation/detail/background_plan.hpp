#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/units.hpp"
#include "roads/network.hpp"

namespace clearway::actuation::detail {

/// The phase to continue with, and for how long.
struct PhaseChange {
    std::uint32_t phase = 0;
    core::Seconds lasting;
};

/// By link and phase: the shortest green that may be given, s.
using OwedGreen = std::function<double(std::uint16_t, std::uint32_t)>;

/// Whether other signals depend on a signal's timing: its program is not actuated by vehicles, and another
/// signal is within 800 m, the usual limit of coordination (MUTCD 2009, section 4D.17: half a mile).
bool keeps_step(core::SignalIndex signal, const roads::Network& network);

/// Follows a signal's background plan while nothing is held: in which phase it is, since when, and how to get
/// it back into step with its neighbours after it was restarted at another phase.
class BackgroundPlan {
  public:
    /// The signal outlives the object; `keeps_step`: see above.
    BackgroundPlan(const roads::Signal& signal, bool keeps_step);

    /// Notes what the signal shows while its background plan runs.
    void watch(const std::string& state, core::Seconds now);
    /// Notes that it was restarted at a phase out of turn.
    void disturb(core::Seconds now);
    /// Notes that it no longer runs.
    void leave();

    /// Whether its neighbours depend on its timing.
    bool keeps_step() const { return keeps_step_; }
    /// Nothing left to do: it is in step, is not coordinated, or cannot get back into step.
    bool is_in_step(core::Seconds now) const;
    /// Cycle time, s; 0 without a program.
    double cycle_s() const { return cycle_s_; }
    /// The phase after the present green if that has lasted `least_green` and the program's own minimum for
    /// it; nothing otherwise.
    std::optional<std::uint32_t> next_after(core::Seconds least_green, core::Seconds now) const;
    /// At the start of a green that is out of step: the green's new length, which leads back into step the
    /// shorter way. At least `least_green` and at most half as long again as usual.
    std::optional<PhaseChange> step_back(core::Seconds least_green, core::Seconds now);
    /// Where the program goes on after a hold: a fixed one where it would be without the hold, another one
    /// after the phase that was left; in both cases at the first phase from there on in which each green
    /// lasts as long as `owed_s` of its link and phase says, or as the program itself gives it. A phase that
    /// would have begun already lasts `least_rest` from now on, because it may be what others clear in.
    /// Nothing where no phase does, or where it is unknown which phase was left.
    std::optional<std::uint32_t> resume(const OwedGreen& owed_s, core::Seconds least_rest,
                                        core::Seconds now) const;
    /// For how long that phase of a fixed program lasts, s: until it would end in step, if that is enough,
    /// and at most half as long again as usual.
    double resumed_s(std::uint32_t phase, const OwedGreen& owed_s, core::Seconds least_rest,
                     core::Seconds now) const;

  private:
    /// Whether each green of a phase that began `since_s` ago lasts long enough from now on.
    bool pays_greens(std::uint32_t phase, double since_s, const OwedGreen& owed_s) const;
    double least_s(std::uint32_t phase, core::Seconds least_green) const;
    /// How much later the phase would end if it were in step, s; within half a cycle either way.
    double lag_s(std::uint32_t phase, core::Seconds now) const;

    const roads::Signal& signal_;
    bool keeps_step_ = false;
    double cycle_s_ = 0.0;
    std::string state_;  ///< Empty while the background plan does not run.
    std::string left_;   ///< What it showed when it was left.
    core::Seconds since_;
    bool in_step_ = true;
    core::Seconds disturbed_;
    bool just_changed_ = false;
};

}  // namespace clearway::actuation::detail
