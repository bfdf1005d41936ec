#include "analysis/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "core/random.hpp"

namespace clearway::analysis {
namespace {

/// Values that are all numbers.
bool all_finite(std::span<const double> values) {
    return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

bool enough_runs(std::span<const std::size_t> stratum_sizes) {
    if (stratum_sizes.empty() || std::ranges::min(stratum_sizes) < 2) return false;
    const std::size_t runs = std::accumulate(stratum_sizes.begin(), stratum_sizes.end(), std::size_t{0});
    return runs - stratum_sizes.size() + 1 >= fewest_for_interval;
}

}  // namespace

RunResampling::RunResampling(const std::vector<std::size_t>& stratum_sizes, const Config& config)
    : config_(config),
      runs_(std::accumulate(stratum_sizes.begin(), stratum_sizes.end(), std::size_t{0})),
      weights_(config.resamples * runs_, 0.0) {
    if (enough_runs(stratum_sizes)) {
        const auto smallest = static_cast<double>(std::ranges::min(stratum_sizes));
        freedom_ = static_cast<double>(runs_ - stratum_sizes.size());
        stretch_ = std::sqrt(smallest / (smallest - 1.0));
        const double t = boost::math::quantile(boost::math::students_t(freedom_), 0.5 * (1.0 - config.level));
        outside_ = boost::math::cdf(boost::math::normal(), t * stretch_);
    }
    const core::KeyedRandom random(core::StudySeed{config.seed}, core::Replication{0});
    for (std::size_t number = 0; number < config.resamples; ++number) {
        std::size_t first = 0;
        for (const std::size_t size : stratum_sizes) {
            for (std::size_t draw = 0; draw < size; ++draw) {
                const std::size_t run =
                    first + random.below(size, core::Purpose::bootstrap, number, first + draw);
                weights_[number * runs_ + run] += 1.0;
            }
            first += size;
        }
    }
}

std::optional<Interval> RunResampling::interval(std::vector<double> values) const {
    if (!outside_ || values.empty()) return std::nullopt;
    if (!all_finite(values)) return std::nullopt;
    std::ranges::sort(values);
    return Interval{quantile(values, *outside_), quantile(values, 1.0 - *outside_)};
}

std::optional<double> RunResampling::p(std::span<const double> values) const {
    if (!outside_ || values.empty() || !all_finite(values)) return std::nullopt;
    const auto not_above = std::ranges::count_if(values, [](double value) { return value <= 0.0; });
    const auto not_below = std::ranges::count_if(values, [](double value) { return value >= 0.0; });
    const double share = (static_cast<double>(std::min(not_above, not_below)) + 1.0) /
                         (static_cast<double>(values.size()) + 1.0);
    if (share >= 0.5) return 1.0;
    const double t = boost::math::quantile(boost::math::normal(), share) / stretch_;
    return 2.0 * boost::math::cdf(boost::math::students_t(freedom_), t);
}

}  // namespace clearway::analysis
