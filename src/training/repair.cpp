#include "training/repair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.hpp"
#include "training/detail/figures.hpp"
#include "training/repair_checkpoint.hpp"

namespace clearway::training {
namespace {

using samples::RepairSample;
using samples::RepairSampleFile;

/// A share of the samples, evenly spread.
RepairSamples thinned(const RepairSamples& samples, std::size_t most) {
    if (most == 0 || samples.size() <= most) return samples;
    RepairSamples kept;
    for (std::size_t i = 0; i < most; ++i)
        kept.push_back(samples[i * samples.size() / most]);
    return kept;
}

template <class Visit>
void for_each_batch(const RepairSamples& samples, std::size_t size, const Visit& visit) {
    for (std::size_t first = 0; first < samples.size(); first += size) {
        visit(std::span(samples).subspan(first, std::min(size, samples.size() - first)));
    }
}

/// Mean over pairs, from means over batches.
class MeanLoss {
  public:
    void add(double loss, std::size_t pairs) {
        sum_ += loss * static_cast<double>(pairs);
        pairs_ += pairs;
    }
    // Rounded to float as in a checkpoint, so that resuming gives the same number.
    double value() const { return static_cast<float>(sum_ / static_cast<double>(pairs_)); }
    std::size_t pairs() const { return pairs_; }

  private:
    double sum_ = 0.0;
    std::size_t pairs_ = 0;
};

/// One training, epoch by epoch.
class Training {
  public:
    Training(const RepairConfig& config, const Checkpoint& checkpoint, RepairSamples train,
             RepairSamples validation)
        : config_(config),
          checkpoint_(checkpoint),
          train_(std::move(train)),
          validation_(std::move(validation)),
          net_(config.net()) {}

    void run(const TrainingHooks& hooks, RepairResult& result) {
        RepairProgress progress;
        if (read_checkpoint(checkpoint_, config_, progress)) {
            net_.load(progress.net);
            net_.load_optimizer(progress.optimizer);
            result.losses = progress.losses;
            result.best_round = progress.best_epoch;
            result.state = progress.best;
            if (progress.stopped_early) result.outcome = Outcome::stopped_early;
        }
        const auto keep = [&](bool is_best) {
            const StateDict state = net_.state();
            if (is_best) result.state = state;
            write_checkpoint(checkpoint_, config_,
                             {result.losses, result.best_round, result.outcome == Outcome::stopped_early,
                              state, result.state, net_.optimizer_state()});
        };
        run_rounds(
            {config_.epochs, config_.patience}, hooks, [&](std::uint32_t epoch) { return run_epoch(epoch); },
            keep, result);
        result.parameter_count = net_.parameter_count();
        if (!result.state.empty()) net_.load(result.state);
    }

    const TorchRepairNet& net() const { return net_; }

  private:
    EpochLoss run_epoch(std::uint32_t epoch) {
        const double share = static_cast<double>(epoch) / config_.epochs;
        const double rate = config_.learning_rate * 0.5 * (1.0 + std::cos(std::numbers::pi * share));
        const PairSampling sampling{
            config_.easy_share, core::KeyedRandom(core::StudySeed{config_.seed}, core::Replication{epoch})};
        RepairSamples order = train_;
        shuffle(order, config_.seed, epoch);
        MeanLoss loss;
        bool finite = true;
        for_each_batch(order, config_.batch_snapshots, [&](const auto& part) {
            if (!finite) return;
            const RepairBatch batch = batch_of(part, config_.edges, sampling);
            if (batch.pair_count() == 0) return;
            const RepairLoss step = net_.train_step(batch, rate);
            finite = std::isfinite(step.links) && std::isfinite(step.motion);
            loss.add(finite ? step.links : std::numeric_limits<double>::quiet_NaN(), batch.pair_count());
        });
        return {loss.value(), finite ? validation_loss() : std::numeric_limits<double>::quiet_NaN()};
    }

    double validation_loss() const {
        MeanLoss loss;
        for_each_batch(validation_, config_.batch_snapshots, [&](const auto& part) {
            const RepairBatch batch = batch_of(part, config_.edges);
            loss.add(net_.loss(batch).links, batch.pair_count());
        });
        return loss.value();
    }

    const RepairConfig& config_;
    const Checkpoint& checkpoint_;
    RepairSamples train_, validation_;
    TorchRepairNet net_;
};

void score(const TorchRepairNet& net, MessageEdges edges, const RepairSampleFile& file, Scores& scores) {
    DisplacementErrors& errors = scores.displacements.emplace();
    for (const RepairSample& sample : file.samples) {
        const RepairSample* const one = &sample;
        const RepairBatch batch = batch_of(std::span(&one, 1), edges);
        const RepairOutput output = net.run(batch);
        scores.logits.insert(scores.logits.end(), output.logits.begin(), output.logits.end());
        for (std::size_t i = 0; i < batch.receiver_count(); ++i) {
            const float truth = batch.true_displacement_m[i];
            if (truth < 0.0F) continue;
            errors.model_m += std::abs(std::clamp(output.displacement_m[i], 0.0F, batch.reach_m[i]) - truth);
            errors.reference_m += std::abs(batch.displacement_m[i] - truth);
            ++errors.count;
        }
    }
}

}  // namespace

RepairNetConfig RepairConfig::net() const {
    RepairNetConfig net;
    net.dimensions.layers = layers;
    net.dimensions.hidden = hidden;
    net.aggregation = aggregation;
    net.motion_head = motion_head;
    net.pair_features = pair_features;
    net.motion_weight = motion_weight;
    net.seed = seed;
    return net;
}

bool RepairConfig::is_whole() const {
    return layers > 0 && aggregation == Aggregation::gated && edges == MessageEdges::believed &&
           motion_head && pair_features;
}

nlohmann::ordered_json RepairResult::facts() const {
    return {{"arithmetic", detail::json_from(arithmetic())},
            {"parameter_count", parameter_count},
            {"train_snapshot_count", train_snapshots}};
}

prediction::Weights RepairResult::weights() const {
    return repair_weights(config.is_whole() ? state : StateDict{}, config.net().dimensions);
}

prediction::Weights repair_weights(const StateDict& state, const prediction::RepairDimensions& dimensions) {
    prediction::Weights weights;
    weights.architecture = prediction::repair_architecture;
    weights.features = prediction::repair_schema();
    weights.dimensions = {{"hidden", dimensions.hidden},    {"layers", dimensions.layers},
                          {"motion", dimensions.motion},    {"embedding", dimensions.embedding},
                          {"decoder", dimensions.decoder},  {"last", dimensions.last},
                          {"edge", prediction::edge_width}, {"pair", prediction::pair_width}};
    weights.inputs = prediction::repair_input_names();
    weights.tensors = state;
    return weights;
}

Identity identity_of(const RepairConfig& config, const std::string& data_hash) {
    return {{"mode", "graphsage"}, {"data_hash", data_hash}, {"configuration", detail::json_from(config)}};
}

RepairResult train_repair(const std::vector<RepairSampleFile>& files, const RepairConfig& config,
                          const Checkpoint& checkpoint, const TrainingHooks& hooks) {
    RepairResult result;
    result.config = config;
    result.seeds = split_repair_files(files, {config.split_seed, config.validation_share, config.test_share},
                                      "the net is");
    result.link_radius = link_radii(origins_of(files));
    const RepairSamples train = thinned(samples_of(files, result.seeds.train), config.most_snapshots);
    result.train_snapshots = train.size();
    for (const RepairSample* const sample : train)
        result.train_pairs += sample->linked.size();
    Training training(config, checkpoint, train, samples_of(files, result.seeds.validation));
    training.run(hooks, result);
    if (!result.state.empty() && result.outcome != Outcome::interrupted) {
        const auto by_net = [&](const RepairSampleFile& file, Scores& scores) {
            score(training.net(), config.edges, file, scores);
        };
        measure(files, by_net, result);
    }
    return result;
}

}  // namespace clearway::training
