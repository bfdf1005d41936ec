#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "metrics/link_quality.hpp"

namespace clearway::links {

/// The grid on which link probabilities are counted. It is fine near 0 and 1, where rankings are decided.
/// Bins are ordered by probability. From 2^-24 to 1 - 2^-24 a bin spans at most 1/64 of the smaller of p and
/// 1 - p; below 2^-24 it spans an eighth of an octave. Everything below 2^-64 is one bin, and so is 1 (the
/// next smaller float is 1 - 2^-24). Ranking measures from these counts differ from exact ones only by the
/// order of pairs within a bin.
struct LinkGrid {
    static constexpr std::uint32_t size = 3267;
    /// `probability` in [0, 1]; not checked.
    static std::uint32_t bin_of(float probability);
    /// The smallest probability in `bin` or above: `p >= lower_edge(b)` exactly when `bin_of(p) >= b`.
    static float lower_edge(std::uint32_t bin);
};

/// Number of bins for the calibration error and reliability curves.
inline constexpr std::size_t calibration_bins = 15;

/// Summary of scored pairs of one kind: counts on the grid, and sums from which log loss and calibration
/// error follow. All sums are integers, so the order in which summaries are added does not matter.
struct LinkSummary {
    struct Bin {
        std::uint32_t bin = 0;  ///< On LinkGrid.
        std::uint64_t linked = 0;
        std::uint64_t unlinked = 0;
        bool operator==(const Bin&) const = default;
    };
    struct Calibration {
        std::uint64_t pairs = 0;
        std::uint64_t linked = 0;
        std::uint64_t probability = 0;  ///< Sum, in units of 2^-32.
        bool operator==(const Calibration&) const = default;
    };
    std::vector<Bin> bins;  ///< Non-empty ones, ascending.
    std::array<Calibration, calibration_bins> calibration{};
    std::uint64_t log_loss = 0;  ///< Sum, in units of 2^-24 nat.
    std::uint64_t brier = 0;     ///< Sum of (probability - truth)^2, in units of 2^-32.

    static constexpr double probability_unit = 1.0 / 4294967296.0;
    static constexpr double log_loss_unit = 1.0 / 16777216.0;
    static constexpr double brier_unit = probability_unit;

    std::uint64_t pairs() const;
    std::uint64_t true_links() const;
    /// Adds all counts; linear in the bins of both.
    void add(const LinkSummary& other);
    bool operator==(const LinkSummary&) const = default;
};

/// Counts pairs one by one. O(1) per pair; allocates at the first one.
class LinkHistogram {
  public:
    void add(float probability, bool linked);
    LinkSummary summary() const;

  private:
    struct Counts {
        std::uint32_t linked = 0;
        std::uint32_t unlinked = 0;
    };
    std::vector<Counts> counts_;  ///< By bin; empty until the first pair.
    LinkSummary sums_;            ///< All but the bins.
};

/// Counts by ascending probability, one entry per bin, possibly weighted. Both spans have the same length.
/// The functions below are those of link_quality.hpp with the pairs of a bin tied.
struct RankedCounts {
    std::span<const double> linked;
    std::span<const double> unlinked;
};
std::optional<double> area_under_roc(RankedCounts counts);
std::optional<double> average_precision(RankedCounts counts);
/// Bins from `first` on count as predicted.
std::optional<double> f1_score(RankedCounts counts, std::size_t first);

/// The measures of link_quality.hpp, from a summary: log loss and ECE up to rounding, F1 exactly for a
/// threshold on the grid (others are rounded down to the lower edge of their bin), AUC and AP up to the order
/// within bins.
metrics::LinkQuality link_quality(const LinkSummary& summary, double threshold = 0.5);

/// As metrics::brier_score, up to rounding.
std::optional<double> brier_score(const LinkSummary& summary);

/// The threshold on the grid with the greatest F1, the highest if several; 0.5 without true links.
double best_f1_threshold(const LinkSummary& summary);

/// A point of a precision-recall curve.
struct PrecisionRecall {
    double threshold = 0.0;
    double precision = 0.0;
    double recall = 0.0;
};
/// One point per non-empty bin, from the highest probability down. Empty without true links.
std::vector<PrecisionRecall> precision_recall(const LinkSummary& summary);

}  // namespace clearway::links
