#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace clearway::server {

/// Decides how far runs may go so that they stay in step, at a pace that a person can follow. Times are those
/// of the simulation, s. Clients have no say but through `pause`, `go`, `step` and `set_speed`. Pure.
class Pacer {
  public:
    /// `speed` times real time; 0: as fast as the slowest run can.
    Pacer(std::size_t runs, double speed) : progress_(runs, waiting), speed_(speed) {}

    /// A run has reached `time_s`; its first report is where it begins.
    void reached(std::size_t run, double time_s) { progress_[run] = time_s; }
    /// A run is over and holds nobody up any more.
    void ended(std::size_t run) { progress_[run] = over; }

    void pause() { paused_ = true; }
    void go() { paused_ = false; }
    /// One step of all runs, then a pause.
    void step();
    /// `speed` >= 0.
    void set_speed(double speed) { speed_ = speed; }

    /// Up to where all runs may go after `passed_s` of real time. Nothing is allowed before every run has
    /// begun. Never decreases.
    double allow(double passed_s);

    bool paused() const { return paused_; }
    double speed() const { return speed_; }

    static constexpr double waiting = -std::numeric_limits<double>::infinity();
    static constexpr double over = std::numeric_limits<double>::infinity();
    /// Runs never differ by more, s: two pictures side by side show one moment.
    static constexpr double lead_s = 1.0;

  private:
    double slowest() const;

    std::vector<double> progress_;
    double speed_;
    bool paused_ = false;
    double allowed_s_ = waiting;
};

}  // namespace clearway::server
