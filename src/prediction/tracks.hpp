#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.hpp"
#include "roads/network.hpp"
#include "traffic/observation.hpp"

namespace clearway::prediction {

/// Every vehicle of an observation twice: where it was last seen, and where it would be now if it had kept
/// its speed along its route (dead reckoning). One row per vehicle, ordered by key, as in the observation. A
/// structure of arrays.
struct Tracks {
    std::vector<core::VehicleKey> key;
    std::vector<traffic::VehicleClass> vehicle_class;
    /// Null where the roster does not have it. Valid until the roster changes.
    std::vector<const traffic::VehicleInfo*> info;
    std::vector<float> last_x_m, last_y_m;    ///< As reported.
    std::vector<float> x_m, y_m;              ///< Dead-reckoned to now.
    std::vector<float> age_s;                 ///< Of the report.
    std::vector<float> sensor_sigma_m;        ///< As the sensor states it.
    std::vector<traffic::MotionState> last;   ///< As reported.
    std::vector<traffic::MotionState> state;  ///< Dead-reckoned; the speed is the reported one.
    std::vector<float> past_end_m;  ///< > 0: dead reckoning took it past the end of its route: it left.
    std::vector<traffic::Freshness> freshness;
    /// 1 where nothing needs to be predicted: the newest report arrived, states no error and is at most one
    /// report interval old.
    std::vector<std::uint8_t> known;

    double time_s = 0.0;  ///< Of the observation.
    bool exits_known = true;
    bool all_known = true;
    bool all_current = true;  ///< Every age is 0: both positions are the same.

    std::size_t size() const { return key.size(); }
    /// Whether dead reckoning says that the vehicle left; never where exits are known and it is still listed.
    bool has_left(std::size_t row) const { return !exits_known && past_end_m[row] > 0.0F; }
    /// Row of a vehicle, or the number of rows. O(log rows).
    std::uint32_t row_of(core::VehicleKey vehicle) const;
    void resize(std::size_t rows);
};

/// A fresh report is at most this old, s, to count as known: reports come at 1 Hz or faster, so that only
/// latency makes them older.
inline constexpr float known_age_s = 1.0F;

/// Fills `tracks`. A vehicle goes on at its reported speed along its route (roads::advance); one whose route
/// is not on the roster goes straight on. No allocation once buffers have grown, save what roads::advance
/// needs.
void dead_reckon(const traffic::Observation& observation, const roads::Network& network, Tracks& tracks);

}  // namespace clearway::prediction
