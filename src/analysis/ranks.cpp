#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/normal.hpp>

#include "analysis/estimate.hpp"

namespace clearway::analysis {
namespace {

/// For more differences the normal approximation is used.
constexpr std::size_t largest_exact = 25;

/// Rank sums of the absolute differences, without zeros.
struct Ranked {
    double positive_sum = 0.0;    ///< Ranks of the positive differences.
    double tie_correction = 0.0;  ///< Sum of t^3 - t over groups of t ties.
    std::size_t count = 0;
};

Ranked rank(std::span<const double> condition, std::span<const double> baseline) {
    assert(condition.size() == baseline.size());
    std::vector<double> kept;
    for (std::size_t row = 0; row < condition.size(); ++row) {
        const double difference = condition[row] - baseline[row];
        if (difference != 0.0) kept.push_back(difference);
    }
    const auto size = [](double difference) { return std::abs(difference); };
    std::ranges::sort(kept, {}, size);
    Ranked ranked;
    ranked.count = kept.size();
    for (std::size_t first = 0; first < kept.size();) {
        std::size_t last = first;
        while (last + 1 < kept.size() && size(kept[last + 1]) == size(kept[first]))
            ++last;
        const double mean_rank = 0.5 * static_cast<double>(first + last) + 1.0;
        for (std::size_t row = first; row <= last; ++row) {
            if (kept[row] > 0.0) ranked.positive_sum += mean_rank;
        }
        const auto ties = static_cast<double>(last - first + 1);
        ranked.tie_correction += ties * ties * ties - ties;
        first = last + 1;
    }
    return ranked;
}

/// Two-sided, by counting the subsets of 1..n for each sum.
double exact_p(const Ranked& ranked) {
    const std::size_t largest_sum = ranked.count * (ranked.count + 1) / 2;
    std::vector<double> subsets(largest_sum + 1, 0.0);
    subsets[0] = 1.0;
    for (std::size_t number = 1; number <= ranked.count; ++number) {
        for (std::size_t sum = largest_sum; sum >= number; --sum)
            subsets[sum] += subsets[sum - number];
    }
    // The distribution is symmetric, so the smaller tail is doubled.
    const auto sum = static_cast<std::size_t>(ranked.positive_sum);
    const std::size_t smaller = std::min(sum, largest_sum - sum);
    const auto end = subsets.begin() + static_cast<std::ptrdiff_t>(smaller) + 1;
    const double tail = std::accumulate(subsets.begin(), end, 0.0);
    return std::min(1.0, 2.0 * tail / std::exp2(static_cast<double>(ranked.count)));
}

double normal_p(const Ranked& ranked) {
    const auto n = static_cast<double>(ranked.count);
    const double mean = n * (n + 1.0) / 4.0;
    const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ranked.tie_correction / 48.0;
    const double z = std::max(0.0, std::abs(ranked.positive_sum - mean) - 0.5) / std::sqrt(variance);
    return std::min(1.0, 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), z)));
}

}  // namespace

std::optional<double> wilcoxon_p(std::span<const double> condition, std::span<const double> baseline) {
    const Ranked ranked = rank(condition, baseline);
    if (ranked.count == 0) return std::nullopt;
    const bool has_zeros = ranked.count < condition.size();
    const bool exact = ranked.tie_correction == 0.0 && !has_zeros && ranked.count <= largest_exact;
    return exact ? exact_p(ranked) : normal_p(ranked);
}

std::vector<double> holm(std::span<const double> p_values) {
    std::vector<std::size_t> order(p_values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t row) { return p_values[row]; });
    std::vector<double> adjusted(p_values.size());
    double largest = 0.0;
    for (std::size_t step = 0; step < order.size(); ++step) {
        const auto factor = static_cast<double>(order.size() - step);
        largest = std::max(largest, std::min(1.0, factor * p_values[order[step]]));
        adjusted[order[step]] = largest;
    }
    return adjusted;
}

}  // namespace clearway::analysis
