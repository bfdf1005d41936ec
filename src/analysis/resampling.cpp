#include "analysis/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "core/random.hpp"

namespace clearway::analysis {
namespace {

std::optional<double> outside_share(const std::vector<std::size_t>& stratum_sizes, double level) {
    if (stratum_sizes.empty()) return std::nullopt;
    const auto smallest = static_cast<double>(*std::ranges::min_element(stratum_sizes));
    if (smallest < 2.0) return std::nullopt;
    const auto runs =
        static_cast<double>(std::accumulate(stratum_sizes.begin(), stratum_sizes.end(), std::size_t{0}));
    const double freedom = runs - static_cast<double>(stratum_sizes.size());
    const double t = boost::math::quantile(boost::math::students_t(freedom), 0.5 * (1.0 - level));
    return boost::math::cdf(boost::math::normal(), t * std::sqrt(smallest / (smallest - 1.0)));
}

}  // namespace

RunResampling::RunResampling(const std::vector<std::size_t>& stratum_sizes, const Config& config)
    : config_(config),
      runs_(std::accumulate(stratum_sizes.begin(), stratum_sizes.end(), std::size_t{0})),
      outside_(outside_share(stratum_sizes, config.level)),
      weights_(config.resamples * runs_, 0.0) {
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
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) return std::nullopt;
    std::ranges::sort(values);
    return Interval{quantile(values, *outside_), quantile(values, 1.0 - *outside_)};
}

}  // namespace clearway::analysis
