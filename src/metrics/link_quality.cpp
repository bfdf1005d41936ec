#include "metrics/link_quality.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

namespace clearway::metrics {
namespace {

/// Pairs at or above a score.
struct Counts {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
};

Counts totals(ScoredLinks links) {
    assert(links.probability.size() == links.linked.size());
    const auto positives = static_cast<std::uint64_t>(std::ranges::count(links.linked, 1));
    return {positives, links.linked.size() - positives};
}

/// Calls `visit(score, above, upto)` for each distinct score, from the highest down, with the counts of pairs
/// scored higher and of pairs scored at least as high.
template <class Visit>
void for_each_score(ScoredLinks links, Visit&& visit) {
    std::vector<std::size_t> order(links.probability.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, std::ranges::greater{}, [&](std::size_t row) { return links.probability[row]; });
    Counts above;
    for (std::size_t at = 0; at < order.size();) {
        const double score = links.probability[order[at]];
        Counts upto = above;
        for (; at < order.size() && links.probability[order[at]] == score; ++at) {
            ++(links.linked[order[at]] == 1 ? upto.positives : upto.negatives);
        }
        visit(score, above, upto);
        above = upto;
    }
}

double f1_from(Counts predicted, std::uint64_t all_positives) {
    return 2.0 * static_cast<double>(predicted.positives) /
           static_cast<double>(predicted.positives + predicted.negatives + all_positives);
}

}  // namespace

std::optional<double> area_under_roc(ScoredLinks links) {
    const Counts all = totals(links);
    if (all.positives == 0 || all.negatives == 0) return std::nullopt;
    double area = 0.0;  // In (true, false) pairs: one trapezoid per score.
    for_each_score(links, [&](double, Counts above, Counts upto) {
        area += static_cast<double>(upto.negatives - above.negatives) * 0.5 *
                static_cast<double>(above.positives + upto.positives);
    });
    return area / static_cast<double>(all.positives) / static_cast<double>(all.negatives);
}

std::optional<double> average_precision(ScoredLinks links) {
    const Counts all = totals(links);
    if (all.positives == 0) return std::nullopt;
    double sum = 0.0;
    for_each_score(links, [&](double, Counts above, Counts upto) {
        sum += static_cast<double>(upto.positives - above.positives) * static_cast<double>(upto.positives) /
               static_cast<double>(upto.positives + upto.negatives);
    });
    return sum / static_cast<double>(all.positives);
}

std::optional<double> f1_score(ScoredLinks links, double threshold) {
    const Counts all = totals(links);
    Counts predicted;
    for (std::size_t row = 0; row < links.linked.size(); ++row) {
        if (links.probability[row] < threshold) continue;
        ++(links.linked[row] == 1 ? predicted.positives : predicted.negatives);
    }
    if (predicted.positives + predicted.negatives + all.positives == 0) return std::nullopt;
    return f1_from(predicted, all.positives);
}

double best_f1_threshold(ScoredLinks links) {
    const Counts all = totals(links);
    double threshold = 0.5;
    double best = 0.0;
    for_each_score(links, [&](double score, Counts, Counts upto) {
        const double f1 = all.positives == 0 ? 0.0 : f1_from(upto, all.positives);
        if (f1 > best) {
            best = f1;
            threshold = score;
        }
    });
    return threshold;
}

std::optional<double> log_loss(ScoredLinks links) {
    if (links.linked.empty()) return std::nullopt;
    constexpr double margin = 1e-15;
    double sum = 0.0;
    for (std::size_t row = 0; row < links.linked.size(); ++row) {
        const double probability = std::clamp(links.probability[row], margin, 1.0 - margin);
        sum -= links.linked[row] == 1 ? std::log(probability) : std::log1p(-probability);
    }
    return sum / static_cast<double>(links.linked.size());
}

std::optional<double> brier_score(ScoredLinks links) {
    if (links.linked.empty()) return std::nullopt;
    double sum = 0.0;
    for (std::size_t row = 0; row < links.linked.size(); ++row) {
        const double error = links.probability[row] - static_cast<double>(links.linked[row]);
        sum += error * error;
    }
    return sum / static_cast<double>(links.linked.size());
}

std::optional<double> calibration_error(ScoredLinks links) {
    if (links.linked.empty()) return std::nullopt;
    constexpr int bin_count = 15;
    std::array<double, bin_count> excess{};  // Sum of probability minus label.
    for (std::size_t row = 0; row < links.linked.size(); ++row) {
        const int bin = std::clamp(static_cast<int>(links.probability[row] * bin_count), 0, bin_count - 1);
        excess[static_cast<std::size_t>(bin)] += links.probability[row] - links.linked[row];
    }
    const double sum = std::accumulate(excess.begin(), excess.end(), 0.0,
                                       [](double so_far, double bin) { return so_far + std::abs(bin); });
    return sum / static_cast<double>(links.linked.size());
}

LinkQuality link_quality(ScoredLinks links, double threshold) {
    LinkQuality quality;
    quality.pairs = links.linked.size();
    quality.true_links = totals(links).positives;
    quality.auc = area_under_roc(links);
    quality.ap = average_precision(links);
    quality.f1 = f1_score(links, threshold);
    quality.log_loss = log_loss(links);
    quality.ece = calibration_error(links);
    quality.threshold = threshold;
    return quality;
}

}  // namespace clearway::metrics
