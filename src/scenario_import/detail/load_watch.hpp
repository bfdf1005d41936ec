#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "core/spellings.hpp"

namespace clearway::scenario_import::detail {

/// Departures of a synthetic demand, s.
inline constexpr double demand_window_s = 900.0;
/// Until then everybody must have arrived, s: the horizon of its studies.
inline constexpr double demand_horizon_s = 3600.0;

/// How SUMO's summary describes a run: means over minutes 12 to 15, the last of the departures, because a
/// network that fills slowly jams late; then totals.
struct Load {
    double running = 0.0;
    double relative_speed = 0.0;  ///< Mean ratio of speed to limit, over the vehicles on the road.
    double halting = 0.0;
    double waiting = 0.0;            ///< To enter.
    double speed_of_all_time = 0.0;  ///< As `relative_speed`, over the whole run.
    double loaded = 0.0;
    double teleports = 0.0;
    double left = 0.0;   ///< On the road or waiting to enter at the end.
    double end_s = 0.0;  ///< When the last arrived, or the end of the run.
};

/// Why a network does not bear a load.
enum class LoadFault { none, fails, slow, queues, teleports, stays };

/// Reads the summary of a SUMO run while it is written and says as soon as the load is too much or borne.
/// What it says depends on the rows alone, not on when it looks.
class LoadWatch {
  public:
    /// `free_speed`: mean ratio of speed to limit in a run with little traffic, signals as they are; 0 where
    /// that is not known yet, which asks for no speed.
    LoadWatch(std::filesystem::path summary, double free_speed);

    /// Reads what is new. Returns whether more rows cannot change the answer: the load is too much, or
    /// everybody has arrived.
    bool is_decided();
    /// After the end of the run.
    LoadFault fault();
    const Load& load() const { return load_; }

  private:
    bool is_empty() const { return window_is_over_ && load_.left == 0.0; }
    void take(const std::string& row);
    void end_window();

    std::filesystem::path summary_;
    double free_speed_;
    std::streamoff read_ = 0;
    Load load_;
    double rows_ = 0.0;
    double running_of_all_time_ = 0.0;
    bool window_is_over_ = false;
    LoadFault fault_ = LoadFault::none;
};

}  // namespace clearway::scenario_import::detail
