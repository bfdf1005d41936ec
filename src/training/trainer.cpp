#include "training/trainer.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace clearway::training {
namespace {

void append(const Scores& more, Scores& scores) {
    const auto extend = [](auto& list, const auto& by) { list.insert(list.end(), by.begin(), by.end()); };
    extend(scores.logits, more.logits);
    extend(scores.reference, more.reference);
    extend(scores.linked, more.linked);
    if (!more.displacements) return;
    DisplacementErrors& sum = scores.displacements ? *scores.displacements : scores.displacements.emplace();
    sum.model_m += more.displacements->model_m;
    sum.reference_m += more.displacements->reference_m;
    sum.count += more.displacements->count;
}

GroupQuality group_of(const std::string& scenario, const std::string& failure, const Scores& scores,
                      const TrainingResult& result) {
    GroupQuality group{scenario, failure, quality_of_logits(scores.logits, scores.linked, result.threshold)};
    if (!scores.reference.empty())
        group.reference =
            metrics::link_quality({scores.reference, scores.linked}, *result.reference_threshold);
    if (scores.displacements) {
        const double count = static_cast<double>(std::max<std::size_t>(scores.displacements->count, 1));
        group.displacement_error_m = scores.displacements->model_m / count;
        group.reference_displacement_error_m = scores.displacements->reference_m / count;
    }
    return group;
}

}  // namespace

void run_rounds(const RoundLimits& limits, const TrainingHooks& hooks,
                const std::function<EpochLoss(std::uint32_t round)>& run,
                const std::function<void(bool is_best)>& keep, TrainingResult& result) {
    for (auto round = static_cast<std::uint32_t>(result.losses.size());
         round < limits.rounds && result.outcome == Outcome::finished; ++round) {
        if (hooks.should_stop && hooks.should_stop()) {
            result.outcome = Outcome::interrupted;
            return;
        }
        const EpochLoss loss = run(round);
        result.losses.push_back(loss);
        if (std::isfinite(loss.train) && std::isfinite(loss.held_out)) {
            const bool is_best = round == 0 || loss.held_out < result.losses[result.best_round].held_out;
            if (is_best) {
                result.best_round = round;
            } else if (round - result.best_round >= limits.patience) {
                result.outcome = Outcome::stopped_early;
            }
            keep(is_best);
        } else {
            result.outcome = Outcome::diverged;
        }
        if (hooks.on_epoch) hooks.on_epoch(round, loss);
    }
}

std::vector<double> probabilities(const std::vector<double>& logits) {
    std::vector<double> result(logits.size());
    std::ranges::transform(logits, result.begin(),
                           [](double logit) { return 1.0 / (1.0 + std::exp(-logit)); });
    return result;
}

std::vector<std::uint8_t> link_flags(const std::vector<float>& labels) {
    std::vector<std::uint8_t> result(labels.size());
    std::ranges::transform(labels, result.begin(), [](float label) { return label > 0.5F ? 1 : 0; });
    return result;
}

metrics::LinkQuality quality_of_logits(const std::vector<double>& logits,
                                       const std::vector<std::uint8_t>& linked, double threshold) {
    metrics::LinkQuality quality = metrics::link_quality({probabilities(logits), linked}, threshold);
    quality.auc = metrics::area_under_roc({logits, linked});
    quality.ap = metrics::average_precision({logits, linked});
    return quality;
}

void measure(const Origins& origins, const std::function<Scores(std::size_t file)>& score,
             TrainingResult& result) {
    Scores validation, all;
    std::map<std::string, Scores> by_failure;
    std::map<std::pair<std::string, std::string>, Scores> by_both;
    for (std::size_t file = 0; file < origins.size(); ++file) {
        const samples::SampleOrigin& origin = *origins[file];
        if (is_of(origin, result.seeds.validation)) append(score(file), validation);
        if (!is_of(origin, result.seeds.test)) continue;
        const Scores scores = score(file);
        append(scores, all);
        append(scores, by_failure[origin.failure]);
        append(scores, by_both[{origin.failure, origin.scenario}]);
    }
    result.threshold = metrics::best_f1_threshold({probabilities(validation.logits), validation.linked});
    if (!result.reference_threshold && !validation.reference.empty())
        result.reference_threshold = metrics::best_f1_threshold({validation.reference, validation.linked});
    result.groups.push_back(group_of("", "", all, result));
    for (const auto& [failure, scores] : by_failure)
        result.groups.push_back(group_of("", failure, scores, result));
    for (const auto& [both, scores] : by_both)
        result.groups.push_back(group_of(both.second, both.first, scores, result));
}

}  // namespace clearway::training
