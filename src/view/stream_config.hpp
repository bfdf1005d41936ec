#pragma once

#include <functional>

namespace clearway::view {

/// Whether a place of the network's plane (m) is shown.
using Area = std::function<bool(double x_m, double y_m)>;

/// How much of a run a stream holds.
struct StreamConfig {
    /// Time between frames, s; 0: one for each step. Marks keep the time of their step.
    double period_s = 0.0;
    /// A key frame at least this often, s: how far a viewer decodes to jump, or waits when frames were lost.
    double key_period_s = 5.0;
    Area area = {};
};

}  // namespace clearway::view
