#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace clearway::scenario_import::detail {

/// Departures of a synthetic demand, s.
inline constexpr double demand_window_s = 900.0;
/// Until then everybody must have arrived, s: the horizon of its studies.
inline constexpr double demand_horizon_s = 3600.0;
/// Speeds and queues are judged over three minutes, s.
inline constexpr double judged_s = 180.0;

/// How SUMO's summary describes a run: means over minutes 12 to 15, the last of the departures, because a
/// network that fills slowly jams late; then totals.
struct Load {
    double running = 0.0;
    double relative_speed = 0.0;  ///< Mean ratio of speed to limit, over the vehicles on the road.
    double halting = 0.0;
    double waiting = 0.0;            ///< To enter.
    double speed_of_all_time = 0.0;  ///< As `relative_speed`, over the whole run.
    double teleports = 0.0;
    double left = 0.0;   ///< On the road or waiting to enter at the end.
    double end_s = 0.0;  ///< When the last arrived, or the end of the run.
};

/// Why a network cannot carry a load.
enum class LoadFault { none, fails, slow, queues, teleports, stays };

/// What a load is measured against.
struct LoadMeasure {
    /// All that depart. SUMO's own count, `loaded`, has those too that its option `scale` leaves out.
    double cars = 0.0;
    /// Mean ratio of speed to limit in a run with little traffic, signals as they are; 0 where that is not
    /// known yet, which asks for no speed.
    double free_speed = 0.0;
};

/// Reads the summary of a SUMO run while it is written and reports as soon as the load is too much or
/// carried. What it says depends on the rows alone, not on when it looks.
class LoadWatch {
  public:
    LoadWatch(std::filesystem::path summary, LoadMeasure measure);

    /// Reads what is new. Returns whether more rows cannot change the answer: the load is too much, or
    /// everybody has arrived.
    bool is_decided();
    /// After the end of the run.
    LoadFault fault();
    /// After a run without fault: whether the load is far from being too much, so that no other demand of as
    /// many cars is likely to be. Nobody was teleported, hardly anybody waited to enter, and the speed of
    /// minutes 12 to 15 is at least three quarters of the free speed.
    bool has_room() const;
    const Load& load() const { return load_; }

  private:
    bool is_empty() const { return window_is_over_ && load_.left == 0.0; }
    void take(const std::string& row);
    void end_early();
    void end_window();

    /// Sums over the rows of three minutes, of those before the last of the departures.
    struct Early {
        double end_s = judged_s;
        double rows = 0.0;
        double running = 0.0;
        double speeds = 0.0;
        double waiting = 0.0;
    };

    std::filesystem::path summary_;
    LoadMeasure measure_;
    Early early_;
    std::uintmax_t read_ = 0;
    Load load_;
    double rows_ = 0.0;
    double running_of_all_time_ = 0.0;
    bool window_is_over_ = false;
    LoadFault fault_ = LoadFault::none;
};

}  // namespace clearway::scenario_import::detail
