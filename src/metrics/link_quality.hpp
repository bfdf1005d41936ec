#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/fields.hpp"

namespace clearway::metrics {

/// Predicted links and the truth, one entry per pair. Both spans have the same length.
struct ScoredLinks {
    std::span<const double> probability;   ///< In [0, 1]; not checked.
    std::span<const std::uint8_t> linked;  ///< 1 where the link is true, else 0.
};

/// How good predicted link probabilities are. Empty where a measure is not defined. All functions here are
/// pure; the order of the pairs affects only rounding.
struct LinkQuality {
    std::uint64_t pairs = 0;
    std::uint64_t true_links = 0;
    std::optional<double> auc;       ///< See `area_under_roc`.
    std::optional<double> ap;        ///< See `average_precision`.
    std::optional<double> f1;        ///< See `f1_score`.
    std::optional<double> log_loss;  ///< See `log_loss`.
    std::optional<double> ece;       ///< See `calibration_error`.
    double threshold = 0.5;          ///< At or above it a link counts as predicted, for `f1`.

    static constexpr void fields(const auto& table) {
        using Q = LinkQuality;
        table(
            core::Field{"pairs", "1", &Q::pairs, 0.0, 1e12, "Pairs scored", ""},
            core::Field{"true_links", "1", &Q::true_links, 0.0, 1e12, "Pairs that are linked", ""},
            core::Field{"auc", "1", &Q::auc, 0.0, 1.0,
                        "Area under the receiver operating characteristic; 0.5 is chance", ""},
            core::Field{"ap", "1", &Q::ap, 0.0, 1.0, "Average precision; chance is the share of true links",
                        ""},
            core::Field{"f1", "1", &Q::f1, 0.0, 1.0, "Harmonic mean of precision and recall at the threshold",
                        ""},
            core::Field{"log_loss", "nat", &Q::log_loss, 0.0, 1e3, "Mean of -ln p(true answer)", ""},
            core::Field{"ece", "1", &Q::ece, 0.0, 1.0, "Expected calibration error",
                        "15 bins: Guo et al. 2017"},
            core::Field{"threshold", "1", &Q::threshold, 0.0, 1.0,
                        "Probability from which a link counts as predicted", "0.5: the more likely answer"});
    }
};

LinkQuality link_quality(ScoredLinks links, double threshold = 0.5);

/// Probability that a true link is scored above a false one, ties counting half (Mann and Whitney). Empty
/// unless both kinds are present. O(n log n).
std::optional<double> area_under_roc(ScoredLinks links);

/// Sum over the distinct scores, from the highest, of (recall gained) x (precision at that score): no
/// interpolation; tied pairs enter together. Empty without true links. O(n log n).
std::optional<double> average_precision(ScoredLinks links);

/// 2 TP / (2 TP + FP + FN), where a link is predicted if probability >= threshold. Empty when no link is true
/// and none predicted.
std::optional<double> f1_score(ScoredLinks links, double threshold);

/// The score that as a threshold gives the greatest F1 (the highest such score), to be chosen on validation
/// seeds; 0.5 without true links. O(n log n).
double best_f1_threshold(ScoredLinks links);

/// Mean of -ln p for linked pairs and -ln(1 - p) for others, with probabilities clamped to [1e-15, 1 -
/// 1e-15]. Empty without pairs.
std::optional<double> log_loss(ScoredLinks links);

/// Mean of (probability - truth)^2, where the truth is 1 or 0 (Brier 1950). Empty without pairs.
std::optional<double> brier_score(ScoredLinks links);

/// Expected calibration error: mean over pairs of |mean probability - share of true links| of the pair's bin,
/// 15 bins of equal width (Guo et al. 2017, "On Calibration of Modern Neural Networks", with the probability
/// of a link in place of the confidence). Empty without pairs.
std::optional<double> calibration_error(ScoredLinks links);

}  // namespace clearway::metrics
