#include "training/trainer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace clearway::training {

std::string_view name(Outcome outcome) {
    switch (outcome) {
        case Outcome::finished:
            return "finished";
        case Outcome::stopped_early:
            return "stopped_early";
        case Outcome::diverged:
            return "diverged";
        case Outcome::interrupted:
            return "interrupted";
    }
    assert(false);
    return "";
}

std::vector<double> probabilities(const std::vector<float>& logits) {
    std::vector<double> result(logits.size());
    std::ranges::transform(logits, result.begin(),
                           [](float logit) { return 1.0 / (1.0 + std::exp(-static_cast<double>(logit))); });
    return result;
}

std::vector<std::uint8_t> link_flags(const std::vector<float>& labels) {
    std::vector<std::uint8_t> result(labels.size());
    std::ranges::transform(labels, result.begin(), [](float label) { return label > 0.5F ? 1 : 0; });
    return result;
}

metrics::LinkQuality quality_of_logits(const std::vector<float>& logits,
                                       const std::vector<std::uint8_t>& linked, double threshold) {
    metrics::LinkQuality quality = metrics::link_quality({probabilities(logits), linked}, threshold);
    const std::vector<double> scores(logits.begin(), logits.end());
    quality.auc = metrics::area_under_roc({scores, linked});
    quality.ap = metrics::average_precision({scores, linked});
    return quality;
}

}  // namespace clearway::training
