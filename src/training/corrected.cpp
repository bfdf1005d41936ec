#include "training/corrected.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/features.hpp"
#include "training/detail/sample_parts.hpp"

namespace clearway::training {
namespace {

using samples::GraphSample;
using samples::GraphSampleFile;

constexpr double reach_m = prediction::corrected_reach_m;

void check_origins(const std::vector<GraphSampleFile>& files) {
    if (files.empty())
        throw core::InputError(
            {"--data", "no graph samples", "", "Record some with clearway dataset SCENARIO --samples"});
    const samples::SampleOrigin& first = files.front().origin;
    for (const GraphSampleFile& file : files) {
        if (file.origin.features != first.features || file.origin.link_radius_m != first.link_radius_m) {
            throw core::InputError({fmt::format("--data: {}, {}, replication {}", file.origin.scenario,
                                                file.origin.failure, file.origin.replication),
                                    fmt::format("features {} {} ({} inputs), links below {} m",
                                                file.origin.features.name, file.origin.features.version,
                                                file.origin.features.width, file.origin.link_radius_m),
                                    fmt::format("{} {} ({} inputs), links below {} m, as in the other files",
                                                first.features.name, first.features.version,
                                                first.features.width, first.link_radius_m),
                                    "Record all files with one version of the program and one link radius"});
        }
    }
}

/// The samples of some seeds that have a pair to learn from or to score.
std::vector<const GraphSample*> samples_of(const std::vector<GraphSampleFile>& files,
                                           const std::vector<DataSeed>& seeds) {
    std::vector<const GraphSample*> samples;
    for (const GraphSampleFile& file : files) {
        if (!detail::is_of(file, seeds)) continue;
        for (const GraphSample& sample : file.samples) {
            const bool useful = std::ranges::any_of(
                sample.candidates, [](const auto& pair) { return pair.dead_reckoned_m < reach_m; });
            if (useful) samples.push_back(&sample);
        }
    }
    return samples;
}

detail::LabelCounts labels_of(const std::vector<const GraphSample*>& samples) {
    detail::LabelCounts counts;
    for (const GraphSample* const sample : samples) {
        for (const samples::CandidatePair& pair : sample->candidates) {
            if (pair.dead_reckoned_m < reach_m) counts.add(pair.linked);
        }
    }
    return counts;
}

std::vector<GraphBatch> batches_from(const std::vector<const GraphSample*>& samples, std::uint32_t width,
                                     std::uint32_t batch_snapshots) {
    std::vector<GraphBatch> batches;
    for (std::size_t at = 0; at < samples.size(); ++at) {
        if (at % batch_snapshots == 0) batches.emplace_back();
        append_sample(*samples[at], width, reach_m, batches.back());
    }
    return batches;
}

/// Mean loss over all pairs of the batches.
double mean_loss(const TorchNet& net, const std::vector<GraphBatch>& batches) {
    double sum = 0.0;
    std::size_t pairs = 0;
    for (const GraphBatch& batch : batches) {
        sum += net.loss(batch) * static_cast<double>(batch.pair_count());
        pairs += batch.pair_count();
    }
    return sum / static_cast<double>(pairs);
}

double train_epoch(TorchNet& net, const std::vector<GraphBatch>& batches) {
    double sum = 0.0;
    std::size_t pairs = 0;
    for (const GraphBatch& batch : batches) {
        const double loss = net.train_step(batch);
        if (!std::isfinite(loss)) return loss;
        sum += loss * static_cast<double>(batch.pair_count());
        pairs += batch.pair_count();
    }
    return sum / static_cast<double>(pairs);
}

/// Probabilities and labels, which `metrics::ScoredLinks` refers to.
struct Scores {
    std::vector<double> net;
    std::vector<double> dead_reckoning;
    std::vector<std::uint8_t> linked;

    metrics::ScoredLinks by_net() const { return {net, linked}; }
    metrics::ScoredLinks by_dead_reckoning() const { return {dead_reckoning, linked}; }
    void append(const Scores& more) {
        net.insert(net.end(), more.net.begin(), more.net.end());
        dead_reckoning.insert(dead_reckoning.end(), more.dead_reckoning.begin(), more.dead_reckoning.end());
        linked.insert(linked.end(), more.linked.begin(), more.linked.end());
    }
};

/// Every candidate of a file in order, those out of reach with probability 0.
Scores scores_of(const TorchNet& net, const GraphSampleFile& file) {
    Scores scores;
    for (const GraphSample& sample : file.samples) {
        GraphBatch batch;
        append_sample(sample, file.origin.features.width, reach_m, batch);
        const std::vector<double> within =
            batch.pair_count() == 0 ? std::vector<double>{} : probabilities(net.logits(batch));
        std::size_t next = 0;
        for (const samples::CandidatePair& pair : sample.candidates) {
            scores.net.push_back(pair.dead_reckoned_m < reach_m ? within[next++] : 0.0);
            scores.dead_reckoning.push_back(file.origin.link_radius_m /
                                            (file.origin.link_radius_m + pair.dead_reckoned_m));
            scores.linked.push_back(pair.linked);
        }
        assert(next == within.size());
    }
    return scores;
}

GroupQuality quality_of(const std::string& scenario, const std::string& failure, const Scores& scores,
                        double threshold) {
    return {scenario, failure, metrics::link_quality(scores.by_net(), threshold),
            metrics::link_quality(scores.by_dead_reckoning())};
}

/// Chooses the threshold on the validation seeds and measures on the test seeds.
void measure(const TorchNet& net, const std::vector<GraphSampleFile>& files, CorrectedResult& result) {
    Scores validation, all;
    std::map<std::pair<std::string, std::string>, Scores> groups;
    for (const GraphSampleFile& file : files) {
        if (detail::is_of(file, result.seeds.validation)) validation.append(scores_of(net, file));
        if (!detail::is_of(file, result.seeds.test)) continue;
        const Scores scores = scores_of(net, file);
        groups[{file.origin.scenario, file.origin.failure}].append(scores);
        all.append(scores);
    }
    result.threshold = metrics::best_f1_threshold(validation.by_net());
    result.groups.push_back(quality_of("", "", all, result.threshold));
    for (const auto& [group, scores] : groups) {
        result.groups.push_back(quality_of(group.first, group.second, scores, result.threshold));
    }
}

/// Records the epoch's losses. Returns whether training should continue.
bool take_epoch(const TorchNet& net, const EpochLoss& loss, std::uint32_t patience, CorrectedResult& result) {
    const auto epoch = static_cast<std::uint32_t>(result.losses.size());
    const double best = result.state.empty() ? std::numeric_limits<double>::infinity()
                                             : result.losses[result.best_epoch].held_out;
    result.losses.push_back(loss);
    if (!std::isfinite(loss.train) || !std::isfinite(loss.held_out)) {
        result.outcome = Outcome::diverged;
        return false;
    }
    if (loss.held_out < best) {
        result.best_epoch = epoch;
        result.state = net.state();
    } else if (epoch - result.best_epoch >= patience) {
        result.outcome = Outcome::stopped_early;
        return false;
    }
    return true;
}

}  // namespace

CorrectedResult train_corrected(const std::vector<GraphSampleFile>& files, const CorrectedConfig& config,
                                const TrainingHooks& hooks) {
    check_origins(files);
    CorrectedResult result;
    result.convolution = config.convolution;
    result.link_radius_m = files.front().origin.link_radius_m;
    result.seeds =
        detail::split_files(files, {config.training.seed, config.validation_share, config.test_share});

    std::vector<const GraphSample*> train = samples_of(files, result.seeds.train);
    const std::vector<const GraphSample*> held_out = samples_of(files, result.seeds.validation);
    detail::require_both_classes(labels_of(train), "training");
    detail::require_both_classes(labels_of(held_out), "validation");
    detail::require_both_classes(labels_of(samples_of(files, result.seeds.test)), "test");
    const std::uint32_t width = files.front().origin.features.width;
    const std::vector<GraphBatch> validation = batches_from(held_out, width, config.batch_snapshots);

    const TrainingConfig& training = config.training;
    TorchNet net({{width, training.hidden, training.output},
                  training.seed,
                  training.learning_rate,
                  config.convolution});
    for (std::uint32_t epoch = 0; epoch < training.epochs; ++epoch) {
        if (hooks.should_stop && hooks.should_stop()) {
            result.outcome = Outcome::interrupted;
            break;
        }
        detail::shuffle(train, training.seed, epoch);
        const std::vector<GraphBatch> batches = batches_from(train, width, config.batch_snapshots);
        const double train_loss = train_epoch(net, batches);
        const bool go_on = take_epoch(net, {train_loss, mean_loss(net, validation)}, config.patience, result);
        if (hooks.on_epoch) hooks.on_epoch(epoch, result.losses.back());
        if (epoch == 0) {
            for (const GraphBatch& batch : batches)
                result.train_pairs += batch.pair_count();
        }
        if (!go_on) break;
    }
    result.train_snapshots = train.size();
    if (!result.state.empty()) {
        net.load(result.state);
        measure(net, files, result);
    }
    return result;
}

}  // namespace clearway::training
