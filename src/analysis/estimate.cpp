#include "analysis/estimate.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>

#include <boost/math/distributions/students_t.hpp>

namespace clearway::analysis {
namespace {

double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Sample standard deviation, n - 1, in two passes.
double deviation_of(std::span<const double> values, double mean) {
    if (values.size() < 2) return 0.0;
    double sum = 0.0;
    for (const double value : values)
        sum += (value - mean) * (value - mean);
    return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

std::vector<double> differences(std::span<const double> condition, std::span<const double> baseline) {
    assert(condition.size() == baseline.size());
    std::vector<double> result(condition.size());
    std::ranges::transform(condition, baseline, result.begin(), std::minus<>());
    return result;
}

/// t of a two-sided interval.
double quantile_of_t(double freedom, double level) {
    const boost::math::students_t distribution(freedom);
    return boost::math::quantile(boost::math::complement(distribution, 0.5 * (1.0 - level)));
}

/// The least count of at least 2 that suffices, where every greater one does; at most `most_replications`.
template <class Suffices>
std::size_t least_count(const Suffices& suffices) {
    std::size_t enough = 2;
    while (!suffices(enough)) {
        if (enough >= most_replications) return most_replications;
        enough *= 2;
    }
    std::size_t too_few = enough / 2;
    while (enough - too_few > 1 && enough > 2) {
        const std::size_t middle = too_few + (enough - too_few) / 2;
        (suffices(middle) ? enough : too_few) = middle;
    }
    return enough;
}

}  // namespace

double half_width(double deviation, std::size_t n, double level) {
    assert(n >= 2);
    const auto count = static_cast<double>(n);
    return quantile_of_t(count - 1.0, level) * deviation / std::sqrt(count);
}

MaybeEstimate estimate_mean(std::span<const double> values, double level) {
    if (values.empty()) return std::nullopt;
    Estimate estimate;
    estimate.n = values.size();
    estimate.mean = mean_of(values);
    estimate.deviation = deviation_of(values, estimate.mean);
    if (estimate.n < 2) return estimate;
    const double reach = half_width(estimate.deviation, estimate.n, level);
    estimate.interval = Interval{estimate.mean - reach, estimate.mean + reach};
    return estimate;
}

MaybeEstimate estimate_adjusted(std::span<const double> values, std::span<const double> covariate,
                                std::span<const double> all, double level) {
    assert(values.size() == covariate.size() && values.size() <= all.size());
    if (values.size() < fewest_for_interval) return std::nullopt;
    const auto n = static_cast<double>(values.size());
    const double mean = mean_of(values);
    const double centre = mean_of(covariate);
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t at = 0; at < values.size(); ++at) {
        squares += (covariate[at] - centre) * (covariate[at] - centre);
        products += (covariate[at] - centre) * (values[at] - mean);
    }
    if (!(squares > 0.0)) return std::nullopt;
    const double slope = products / squares;
    double left = 0.0;
    for (std::size_t at = 0; at < values.size(); ++at)
        left += std::pow(values[at] - mean - slope * (covariate[at] - centre), 2);
    const auto count = static_cast<double>(all.size());
    const double centre_of_all = mean_of(all);
    const double shift = centre_of_all - centre;
    const double of_residuals = left / (n - 2.0) * (1.0 / n + shift * shift / squares);
    const double of_all = std::pow(slope * deviation_of(all, centre_of_all), 2) / count;
    Estimate estimate{values.size(), mean + slope * shift, std::sqrt(left / (n - 2.0)), {}};
    const double variance = of_residuals + of_all;
    const double freedom =
        variance > 0.0 ? variance * variance /
                             (of_residuals * of_residuals / (n - 2.0) + of_all * of_all / (count - 1.0))
                       : n - 2.0;
    const double reach = quantile_of_t(freedom, level) * std::sqrt(variance);
    estimate.interval = Interval{estimate.mean - reach, estimate.mean + reach};
    return estimate;
}

MaybeEstimate estimate_ratio(std::span<const double> sums, std::span<const double> counts, double level) {
    assert(sums.size() == counts.size());
    const double count = std::accumulate(counts.begin(), counts.end(), 0.0);
    if (count <= 0.0) return std::nullopt;
    const double ratio = std::accumulate(sums.begin(), sums.end(), 0.0) / count;
    const auto clusters = static_cast<double>(counts.size() - std::ranges::count(counts, 0.0));
    std::vector<double> values;
    for (std::size_t at = 0; at < sums.size(); ++at)
        if (counts[at] > 0.0) values.push_back(ratio + (sums[at] - ratio * counts[at]) * clusters / count);
    return estimate_mean(values, level);
}

MaybeEstimate estimate_not_negative(std::span<const double> values, double level) {
    auto estimate = estimate_mean(values, level);
    if (!estimate || !estimate->interval || estimate->interval->low >= 0.0 || !(estimate->mean > 0.0))
        return estimate;
    const double stretch = std::exp(estimate->interval->half_width() / estimate->mean);
    estimate->interval = Interval{estimate->mean / stretch, estimate->mean * stretch};
    return estimate;
}

MaybeEstimate estimate_difference(std::span<const double> condition, std::span<const double> baseline,
                                  double level) {
    return estimate_mean(differences(condition, baseline), level);
}

MaybeEstimate relative_difference(std::span<const double> condition, std::span<const double> baseline,
                                  double level) {
    auto estimate = estimate_difference(condition, baseline, level);
    if (!estimate) return std::nullopt;
    const double reference = mean_of(baseline);
    if (!(reference > 0.0)) return std::nullopt;
    estimate->mean /= reference;
    estimate->deviation /= reference;
    if (estimate->interval) {
        estimate->interval->low /= reference;
        estimate->interval->high /= reference;
    }
    return estimate;
}

std::optional<double> effect_size(std::span<const double> condition, std::span<const double> baseline) {
    const auto estimate = estimate_difference(condition, baseline);
    if (!estimate || !(estimate->deviation > 0.0)) return std::nullopt;
    return estimate->mean / estimate->deviation;
}

std::optional<double> paired_t_p(std::span<const double> condition, std::span<const double> baseline) {
    const auto effect = effect_size(condition, baseline);
    if (!effect) return std::nullopt;
    const auto n = static_cast<double>(condition.size());
    const boost::math::students_t distribution(n - 1.0);
    const double t = std::abs(*effect) * std::sqrt(n);
    return 2.0 * boost::math::cdf(boost::math::complement(distribution, t));
}

std::optional<double> paired_equivalence_p(std::span<const double> condition,
                                           std::span<const double> baseline, double margin) {
    assert(margin > 0.0);
    const auto difference = estimate_difference(condition, baseline);
    if (!difference || difference->n < 2) return std::nullopt;
    const double inside = margin - std::abs(difference->mean);
    if (difference->deviation == 0.0) return inside > 0.0 ? 0.0 : 1.0;
    const boost::math::students_t distribution(static_cast<double>(difference->n) - 1.0);
    const double t = inside / difference->deviation * std::sqrt(static_cast<double>(difference->n));
    return boost::math::cdf(boost::math::complement(distribution, t));
}

std::size_t required_replications(double deviation, double half_width, double level) {
    assert(half_width > 0.0);
    return least_count(
        [&](std::size_t n) { return clearway::analysis::half_width(deviation, n, level) <= half_width; });
}

std::size_t replications_to_show(double deviation, double difference, double level) {
    assert(difference > 0.0);
    return least_count([&](std::size_t n) {
        const auto count = static_cast<double>(n);
        const boost::math::students_t distribution(count - 1.0);
        const double reserve =
            boost::math::quantile(distribution, usual_power) * deviation / std::sqrt(count);
        return half_width(deviation, n, level) + reserve <= difference;
    });
}

double geh(double modelled_per_hour, double counted_per_hour) {
    const double sum = modelled_per_hour + counted_per_hour;
    if (!(sum > 0.0)) return 0.0;
    const double difference = modelled_per_hour - counted_per_hour;
    return std::sqrt(2.0 * difference * difference / sum);
}

}  // namespace clearway::analysis
