#include "training/comparison/corrected.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "prediction/comparison/features.hpp"
#include "training/comparison/graph_batch.hpp"
#include "training/detail/figures.hpp"

namespace clearway::training {
namespace {

using samples::GraphSample;
using samples::GraphSampleFile;

constexpr double reach_m = prediction::corrected_reach_m;

/// The samples of some seeds that have a pair to learn from or to score.
std::vector<const GraphSample*> samples_of(const std::vector<GraphSampleFile>& files,
                                           const std::vector<DataSeed>& seeds) {
    std::vector<const GraphSample*> samples;
    for (const GraphSampleFile& file : files) {
        if (!is_of(file.origin, seeds)) continue;
        for (const GraphSample& sample : file.samples) {
            const bool useful = std::ranges::any_of(
                sample.candidates, [](const auto& pair) { return pair.dead_reckoned_m < reach_m; });
            if (useful) samples.push_back(&sample);
        }
    }
    return samples;
}

LabelCounts labels_of(const std::vector<const GraphSample*>& samples) {
    LabelCounts counts;
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

/// Every candidate of a file in order, those out of reach with probability 0.
Scores scores_of(const TorchNet& net, const GraphSampleFile& file) {
    Scores scores;
    for (const GraphSample& sample : file.samples) {
        GraphBatch batch;
        append_sample(sample, file.origin.features.width, reach_m, batch);
        const std::vector<float> within = batch.pair_count() == 0 ? std::vector<float>{} : net.logits(batch);
        std::size_t next = 0;
        for (const samples::CandidatePair& pair : sample.candidates) {
            scores.logits.push_back(
                pair.dead_reckoned_m < reach_m ? within[next++] : -std::numeric_limits<double>::infinity());
            scores.reference.push_back(file.origin.link_radius_m /
                                       (file.origin.link_radius_m + pair.dead_reckoned_m));
            scores.linked.push_back(pair.linked);
        }
        assert(next == within.size());
    }
    return scores;
}

}  // namespace

nlohmann::ordered_json CorrectedResult::facts() const {
    nlohmann::ordered_json json = NetResult::facts();
    json["train_snapshot_count"] = train_snapshots;
    return json;
}

Identity identity_of(const CorrectedConfig& config, const std::string& data_hash) {
    nlohmann::ordered_json configuration = detail::json_from(config.training);
    configuration.update(detail::json_from(config));
    return {{"mode", corrected_name(config.convolution)},
            {"data_hash", data_hash},
            {"configuration", configuration}};
}

CorrectedResult train_corrected(const std::vector<GraphSampleFile>& files, const CorrectedConfig& config,
                                const TrainingHooks& hooks) {
    const TrainingConfig& training = config.training;
    CorrectedResult result;
    const Origins origins = origins_of(files);
    result.seeds = split_files(origins, {training.seed, config.validation_share, config.test_share},
                               "SCENARIO --samples");
    require_alike(origins);
    result.link_radius = link_radii(origins);
    result.convolution = config.convolution;
    result.features = origins.front()->features;
    const std::uint32_t width = result.features.width;
    result.dimensions = {width, training.hidden, training.output};
    result.pth =
        config.convolution == Convolution::sage ? "GraphSAGENet" : corrected_name(config.convolution);

    std::vector<const GraphSample*> train = samples_of(files, result.seeds.train);
    const std::vector<const GraphSample*> held_out = samples_of(files, result.seeds.validation);
    const LabelCounts labels = labels_of(train);
    require_both_classes(labels, "training");
    require_both_classes(labels_of(held_out), "validation");
    require_both_classes(labels_of(samples_of(files, result.seeds.test)), "test");
    result.train_snapshots = train.size();
    result.train_pairs = labels.linked + labels.unlinked;
    const std::vector<GraphBatch> validation = batches_from(held_out, width, config.batch_snapshots);
    TorchNet net({result.dimensions, training.seed, training.learning_rate, config.convolution});
    const auto run = [&](std::uint32_t epoch) {
        shuffle(train, training.seed, epoch);
        const double loss = train_epoch(net, batches_from(train, width, config.batch_snapshots));
        return EpochLoss{loss, mean_loss(net, validation)};
    };
    const auto keep = [&](bool is_best) {
        if (is_best) result.state = net.state();
    };
    run_rounds({training.epochs, config.patience}, hooks, run, keep, result);
    if (result.state.empty()) return result;
    net.load(result.state);
    measure(
        origins, [&](std::size_t file) { return scores_of(net, files[file]); }, result);
    for (GroupQuality& group : result.groups)
        group.reference->log_loss = group.reference->ece = std::nullopt;
    return result;
}

}  // namespace clearway::training
