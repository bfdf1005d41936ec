#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/units.hpp"
#include "roads/network.hpp"
#include "traffic/signal.hpp"

namespace clearway::policy::detail {

/// Where the program of a signal stands, from what it shows.
class ProgramClock {
  public:
    /// At each decision; `shown` may be empty (not known).
    void watch(const std::string& shown, core::Seconds now);
    /// Since the program's cycle began, s. A fixed program is in step while it shows what it should, another
    /// one is where the phase that it shows began; while it shows no phase, it counts as in step.
    double cycle_time_s(const roads::Signal& signal, core::Seconds now) const;

  private:
    std::string shown_;
    core::Seconds since_;
};

/// What a signal shows in a piece of time, s from now. Letters as in traffic::SignalStates.
struct ShownPiece {
    double from_s = 0.0;
    double to_s = 0.0;
    std::string_view state;
};

/// Piece after piece. Filled again, it allocates nothing; `held` is cleared before another forecaster fills
/// it. Its pieces refer to the signal's program and to states of its own, so it stays where it is.
struct SignalForecast {
    SignalForecast() = default;
    SignalForecast(const SignalForecast&) = delete;
    SignalForecast& operator=(const SignalForecast&) = delete;

    std::vector<ShownPiece> pieces;
    std::string before, held, after;  ///< Shown before a hold, in it and after it, by no phase.
};

/// Foretells what a signal shows, with and without a hold. Coarser than actuation: every transition takes the
/// same time, phases last as the program says, a hold shows what the program's phase for its links shows, and
/// after it the program is in step again. Not for the controller NEMA, whose phases run side by side.
class SignalForecaster {
  public:
    /// Keeps references to all but the number. `held`: links of the hold, ascending. `shown`: what it shows
    /// now, or nothing where that is not known. `cycle_time_s`: see ProgramClock.
    SignalForecaster(const roads::Signal& signal, std::span<const std::uint16_t> held, std::string_view shown,
                     double cycle_time_s);

    /// Duration of the program's cycle, s; 0 without a program.
    double cycle_s() const { return cycle_s_; }
    /// No hold.
    void program(double until_s, SignalForecast& forecast) const;
    /// A hold that begins at `start_s`, well before `until_s`, and goes on.
    void hold(double start_s, double until_s, SignalForecast& forecast) const;
    /// Ends that hold.
    void release(SignalForecast& forecast, double at_s, double until_s) const;

  private:
    void run(double from_s, double to_s, SignalForecast& forecast) const;
    std::string_view shown_at(double time_s) const;  ///< By the program; empty without one.
    void set_held(std::size_t letters, std::string& state) const;

    const roads::Signal& signal_;
    std::span<const std::uint16_t> held_;
    std::string_view shown_;
    double cycle_time_s_ = 0.0;
    double cycle_s_ = 0.0;
};

}  // namespace clearway::policy::detail
