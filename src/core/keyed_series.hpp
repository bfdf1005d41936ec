#pragma once

#include <cstdint>

#include "core/random.hpp"

namespace clearway::core {

// Random series in time whose value at a step is a pure function of (subject, step), so that it depends
// neither on when counting started nor on the order of calls.

/// A Gilbert-Elliott chain: dark or not, with transition probabilities per step that give the wanted mean
/// outage and share of time dark.
///
/// To depend only on the step, not on where counting started, the chain is drawn as a mixture: at each step,
/// the state is drawn anew (dark with probability `share`) with probability p = (1 / outage) / (1 - share),
/// outage in steps; otherwise it stays. The state at step k is the one drawn at the latest renewal at or
/// before k, found by walking back 1 / p steps on average. This is the same chain, because P(dark -> not) =
/// p (1 - share) = 1 / outage. It needs p <= 1, which whoever configures it ensures. (Walking a cached chain
/// forward from each vehicle's departure was rejected: departures differ between conditions.)
class GilbertElliott {
  public:
    struct Config {
        double interval_s = 1.0;  ///< Time between two steps; > 0.
        double dark_share = 0.0;  ///< [0, 1).
        double mean_outage_s = 10.0;
    };
    GilbertElliott(const KeyedRandom& random, Purpose purpose, const Config& config);
    /// Whether `subject` is in an outage at this step.
    bool dark(std::uint64_t subject, std::uint64_t step) const;

  private:
    KeyedRandom random_;
    Purpose purpose_;
    double dark_share_;
    double renewal_;  ///< Probability p above.
};

/// Normal series, one of `axes` independent ones of a subject.
struct NormalSeries {
    Purpose purpose = Purpose::position_noise;
    std::uint64_t axes = 1;
    std::uint64_t axis = 0;
    double correlation = 0.0;  ///< From one step to the next, [0, 1); 0 for white noise.
};
/// Standard normal: the stationary first-order process with that correlation, as a weighted sum of past white
/// noise, cut off where a weight falls below 1/1000.
double draw_normal(const KeyedRandom& random, const NormalSeries& series, std::uint64_t subject,
                   std::uint64_t step);

}  // namespace clearway::core
