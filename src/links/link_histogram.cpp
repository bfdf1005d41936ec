#include "links/link_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "links/detail/sparse_bins.hpp"

namespace clearway::links {
namespace {

// The parts of the grid, by ascending probability.
constexpr std::uint32_t coarse_octaves = 40;  // 2^-64 to 2^-24
constexpr std::uint32_t coarse_shift = 20;    // of a float's bits: 8 bins per octave
constexpr std::uint32_t fine_octaves = 23;    // 2^-24 to 2^-1
constexpr std::uint32_t fine_shift = 17;      // 64 bins per octave
constexpr std::uint32_t first_fine = 1 + coarse_octaves * 8;
constexpr std::uint32_t first_upper = first_fine + fine_octaves * 64;  // the bin of 0.5
constexpr std::uint32_t last_upper = first_upper + fine_octaves * 64;  // 1 - p from 2^-24 on
constexpr std::uint32_t certain = last_upper + 1;                      // p = 1
static_assert(certain + 1 == LinkGrid::size);

constexpr float least_fine = 0x1p-24F;
constexpr float least_coarse = 0x1p-64F;

std::uint32_t steps_above(float value, float least, std::uint32_t shift) {
    return (std::bit_cast<std::uint32_t>(value) - std::bit_cast<std::uint32_t>(least)) >> shift;
}

float value_at(std::uint32_t steps, float least, std::uint32_t shift) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(least) + (steps << shift));
}

std::uint64_t fixed(double value, double unit) {
    return static_cast<std::uint64_t>(std::llround(value / unit));
}

std::size_t calibration_bin(float probability) {
    const int bin = static_cast<int>(static_cast<double>(probability) * calibration_bins);
    return static_cast<std::size_t>(std::clamp(bin, 0, static_cast<int>(calibration_bins) - 1));
}

double loss_of(double probability, bool linked) {
    constexpr double margin = 1e-15;  // as log_loss in link_quality.hpp
    const double held = std::clamp(probability, margin, 1.0 - margin);
    return linked ? -std::log(held) : -std::log1p(-held);
}

/// A summary's bins as columns.
struct Columns {
    std::vector<double> linked, unlinked;
    RankedCounts ranked() const { return {linked, unlinked}; }
};

Columns columns_of(const LinkSummary& summary) {
    Columns columns;
    for (const LinkSummary::Bin& bin : summary.bins) {
        columns.linked.push_back(static_cast<double>(bin.linked));
        columns.unlinked.push_back(static_cast<double>(bin.unlinked));
    }
    return columns;
}

double sum(std::span<const double> values) {
    double total = 0.0;
    for (const double value : values)
        total += value;
    return total;
}

/// Calls `visit(threshold, found, predicted)` for the lower edge of each bin, from the highest down.
template <class Visit>
void for_each_threshold(const LinkSummary& summary, const Visit& visit) {
    double found = 0.0;
    double predicted = 0.0;
    for (std::size_t at = summary.bins.size(); at-- > 0;) {
        const LinkSummary::Bin& bin = summary.bins[at];
        found += static_cast<double>(bin.linked);
        predicted += static_cast<double>(bin.linked + bin.unlinked);
        visit(LinkGrid::lower_edge(bin.bin), found, predicted);
    }
}

std::optional<double> calibration_error(const LinkSummary& summary) {
    const auto pairs = static_cast<double>(summary.pairs());
    if (pairs == 0.0) return std::nullopt;
    double excess = 0.0;
    for (const LinkSummary::Calibration& bin : summary.calibration) {
        excess += std::abs(static_cast<double>(bin.probability) * LinkSummary::probability_unit -
                           static_cast<double>(bin.linked));
    }
    return excess / pairs;
}

}  // namespace

std::uint32_t LinkGrid::bin_of(float probability) {
    if (probability >= 0.5F) {
        const float rest = 1.0F - probability;  // exact (Sterbenz)
        return rest < least_fine ? certain : last_upper - steps_above(rest, least_fine, fine_shift);
    }
    if (probability >= least_fine) return first_fine + steps_above(probability, least_fine, fine_shift);
    if (probability >= least_coarse) return 1 + steps_above(probability, least_coarse, coarse_shift);
    return 0;
}

float LinkGrid::lower_edge(std::uint32_t bin) {
    if (bin == 0) return 0.0F;
    if (bin < first_fine) return value_at(bin - 1, least_coarse, coarse_shift);
    if (bin < first_upper) return value_at(bin - first_fine, least_fine, fine_shift);
    if (bin >= certain) return 1.0F;
    // In the upper half, a bin holds values of 1 - p from one grid value up to, but not including, the next.
    const float above = value_at(last_upper - bin + 1, least_fine, fine_shift);
    float edge = std::max(0.5F, 1.0F - above);
    while (1.0F - edge >= above)
        edge = std::nextafter(edge, 1.0F);
    return edge;
}

std::uint64_t LinkSummary::pairs() const {
    std::uint64_t count = 0;
    for (const Bin& bin : bins)
        count += bin.linked + bin.unlinked;
    return count;
}

std::uint64_t LinkSummary::true_links() const {
    std::uint64_t count = 0;
    for (const Bin& bin : bins)
        count += bin.linked;
    return count;
}

void LinkSummary::add(const LinkSummary& other) {
    detail::add_bins(bins, other.bins, [](Bin& sum, const Bin& bin) {
        sum.linked += bin.linked;
        sum.unlinked += bin.unlinked;
    });
    for (std::size_t bin = 0; bin < calibration.size(); ++bin) {
        calibration[bin].pairs += other.calibration[bin].pairs;
        calibration[bin].linked += other.calibration[bin].linked;
        calibration[bin].probability += other.calibration[bin].probability;
    }
    log_loss += other.log_loss;
    brier += other.brier;
}

void LinkHistogram::add(float probability, bool linked) {
    if (counts_.empty()) counts_.resize(LinkGrid::size);
    Counts& counts = counts_[LinkGrid::bin_of(probability)];
    std::uint32_t& count = linked ? counts.linked : counts.unlinked;
    if (count == std::numeric_limits<std::uint32_t>::max())
        throw std::overflow_error("more than 2^32 pairs of one probability in one run");
    ++count;
    LinkSummary::Calibration& calibration = sums_.calibration[calibration_bin(probability)];
    ++calibration.pairs;
    calibration.linked += linked ? 1 : 0;
    calibration.probability += fixed(probability, LinkSummary::probability_unit);
    if (probability == 0.0F && !linked) return;  // Right and certain: no loss of either kind.
    sums_.log_loss += fixed(loss_of(probability, linked), LinkSummary::log_loss_unit);
    const double error = static_cast<double>(probability) - (linked ? 1.0 : 0.0);
    sums_.brier += fixed(error * error, LinkSummary::brier_unit);
}

LinkSummary LinkHistogram::summary() const {
    LinkSummary summary = sums_;
    for (std::uint32_t bin = 0; bin < counts_.size(); ++bin) {
        if (counts_[bin].linked + counts_[bin].unlinked > 0)
            summary.bins.push_back({bin, counts_[bin].linked, counts_[bin].unlinked});
    }
    return summary;
}

std::optional<double> area_under_roc(RankedCounts counts) {
    const double positives = sum(counts.linked);
    const double negatives = sum(counts.unlinked);
    if (positives == 0.0 || negatives == 0.0) return std::nullopt;
    double area = 0.0;
    double above = 0.0;
    for (std::size_t bin = counts.linked.size(); bin-- > 0;) {
        area += counts.unlinked[bin] * (above + 0.5 * counts.linked[bin]);
        above += counts.linked[bin];
    }
    return area / positives / negatives;
}

std::optional<double> average_precision(RankedCounts counts) {
    double found = 0.0;
    double predicted = 0.0;
    double area = 0.0;
    for (std::size_t bin = counts.linked.size(); bin-- > 0;) {
        found += counts.linked[bin];
        predicted += counts.linked[bin] + counts.unlinked[bin];
        if (counts.linked[bin] > 0.0) area += counts.linked[bin] * found / predicted;
    }
    if (found == 0.0) return std::nullopt;
    return area / found;
}

std::optional<double> f1_score(RankedCounts counts, std::size_t first) {
    const double found = sum(counts.linked.subspan(first));
    const double wrong = sum(counts.unlinked.subspan(first));
    const double all = found + wrong + sum(counts.linked);
    if (all == 0.0) return std::nullopt;
    return 2.0 * found / all;
}

metrics::LinkQuality link_quality(const LinkSummary& summary, double threshold) {
    const Columns columns = columns_of(summary);
    const auto first = std::ranges::lower_bound(summary.bins, LinkGrid::bin_of(static_cast<float>(threshold)),
                                                {}, &LinkSummary::Bin::bin);
    metrics::LinkQuality quality;
    quality.pairs = summary.pairs();
    quality.true_links = summary.true_links();
    quality.auc = area_under_roc(columns.ranked());
    quality.ap = average_precision(columns.ranked());
    quality.f1 = f1_score(columns.ranked(), static_cast<std::size_t>(first - summary.bins.begin()));
    if (quality.pairs > 0) {
        quality.log_loss = static_cast<double>(summary.log_loss) * LinkSummary::log_loss_unit /
                           static_cast<double>(quality.pairs);
    }
    quality.ece = calibration_error(summary);
    quality.threshold = threshold;
    return quality;
}

std::optional<double> brier_score(const LinkSummary& summary) {
    const auto pairs = static_cast<double>(summary.pairs());
    if (pairs == 0.0) return std::nullopt;
    return static_cast<double>(summary.brier) * LinkSummary::brier_unit / pairs;
}

double best_f1_threshold(const LinkSummary& summary) {
    const auto all = static_cast<double>(summary.true_links());
    double best = 0.0;
    double threshold = 0.5;
    for_each_threshold(summary, [&](double edge, double found, double predicted) {
        const double f1 = all == 0.0 ? 0.0 : 2.0 * found / (predicted + all);
        if (f1 <= best) return;
        best = f1;
        threshold = edge;
    });
    return threshold;
}

std::vector<PrecisionRecall> precision_recall(const LinkSummary& summary) {
    const auto all = static_cast<double>(summary.true_links());
    std::vector<PrecisionRecall> curve;
    if (all == 0.0) return curve;
    for_each_threshold(summary, [&](double edge, double found, double predicted) {
        curve.push_back({edge, found / predicted, found / all});
    });
    return curve;
}

}  // namespace clearway::links
