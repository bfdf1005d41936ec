#include "core/keyed_series.hpp"

#include <algorithm>
#include <cmath>

namespace clearway::core {
namespace {

constexpr double least_weight = 1e-3;

/// Even draws decide on renewals, odd ones on the state; both have the same purpose.
constexpr std::uint64_t renewal_draw(std::uint64_t step) {
    return 2 * step;
}
constexpr std::uint64_t state_draw(std::uint64_t step) {
    return 2 * step + 1;
}

}  // namespace

GilbertElliott::GilbertElliott(const KeyedRandom& random, Purpose purpose, const Config& config)
    : random_(random),
      purpose_(purpose),
      dark_share_(config.dark_share),
      renewal_(std::min(1.0, config.interval_s / config.mean_outage_s / (1.0 - config.dark_share))) {}

bool GilbertElliott::dark(std::uint64_t subject, std::uint64_t step) const {
    if (dark_share_ == 0.0) return false;
    while (step > 0 && random_.uniform(purpose_, subject, renewal_draw(step)) >= renewal_) {
        --step;
    }
    return random_.uniform(purpose_, subject, state_draw(step)) < dark_share_;
}

double draw_normal(const KeyedRandom& random, const NormalSeries& series, std::uint64_t subject,
                   std::uint64_t step) {
    double weight = 1.0;
    double sum = 0.0;
    double square = 0.0;
    while (weight >= least_weight) {
        sum += weight * random.normal(series.purpose, subject, series.axes * step + series.axis);
        square += weight * weight;
        weight *= series.correlation;
        if (step-- == 0) break;
    }
    return sum / std::sqrt(square);
}

}  // namespace clearway::core
