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

/// Ranks of the absolute differences, without zeros; ties share the mean of theirs.
struct Ranked {
    std::vector<std::size_t> doubled;      ///< Twice each rank, which is whole.
    std::size_t doubled_positive_sum = 0;  ///< Of the positive differences.
    double tie_correction = 0.0;           ///< Sum of t^3 - t over groups of t ties.
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
    for (std::size_t first = 0; first < kept.size();) {
        std::size_t last = first;
        while (last + 1 < kept.size() && size(kept[last + 1]) == size(kept[first]))
            ++last;
        const std::size_t doubled_rank = first + last + 2;
        for (std::size_t row = first; row <= last; ++row) {
            ranked.doubled.push_back(doubled_rank);
            if (kept[row] > 0.0) ranked.doubled_positive_sum += doubled_rank;
        }
        const auto ties = static_cast<double>(last - first + 1);
        ranked.tie_correction += ties * ties * ties - ties;
        first = last + 1;
    }
    return ranked;
}

/// Two-sided, by counting the subsets of the ranks for each sum.
double exact_p(const Ranked& ranked) {
    const std::size_t largest_sum =
        std::accumulate(ranked.doubled.begin(), ranked.doubled.end(), std::size_t{0});
    std::vector<double> subsets(largest_sum + 1, 0.0);
    subsets[0] = 1.0;
    for (const std::size_t rank : ranked.doubled) {
        for (std::size_t sum = largest_sum; sum >= rank; --sum)
            subsets[sum] += subsets[sum - rank];
    }
    // The distribution is symmetric, so the smaller tail is doubled.
    const std::size_t smaller =
        std::min(ranked.doubled_positive_sum, largest_sum - ranked.doubled_positive_sum);
    const auto end = subsets.begin() + static_cast<std::ptrdiff_t>(smaller) + 1;
    const double tail = std::accumulate(subsets.begin(), end, 0.0);
    return std::min(1.0, 2.0 * tail / std::exp2(static_cast<double>(ranked.doubled.size())));
}

double normal_p(const Ranked& ranked) {
    const auto n = static_cast<double>(ranked.doubled.size());
    const double mean = n * (n + 1.0) / 4.0;
    const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ranked.tie_correction / 48.0;
    const double positive_sum = 0.5 * static_cast<double>(ranked.doubled_positive_sum);
    const double z = std::max(0.0, std::abs(positive_sum - mean) - 0.5) / std::sqrt(variance);
    return std::min(1.0, 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), z)));
}

}  // namespace

std::optional<double> wilcoxon_p(std::span<const double> condition, std::span<const double> baseline) {
    const Ranked ranked = rank(condition, baseline);
    if (ranked.doubled.empty()) return std::nullopt;
    return ranked.doubled.size() <= largest_exact ? exact_p(ranked) : normal_p(ranked);
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
