#include "training/repair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/random.hpp"
#include "training/detail/sample_parts.hpp"
#include "training/repair_checkpoint.hpp"

namespace clearway::training {
namespace {

using samples::RepairSample;
using samples::RepairSampleFile;
using Samples = std::vector<const RepairSample*>;

Samples samples_of(const std::vector<RepairSampleFile>& files, const std::vector<DataSeed>& seeds) {
    Samples samples;
    for (const RepairSampleFile& file : files) {
        if (!detail::is_of(file, seeds)) continue;
        for (const RepairSample& sample : file.samples)
            samples.push_back(&sample);
    }
    return samples;
}

detail::LabelCounts labels_of(const Samples& samples) {
    detail::LabelCounts counts;
    for (const RepairSample* const sample : samples)
        counts.add(sample->linked);
    return counts;
}

void check_radius(const std::vector<RepairSampleFile>& files) {
    for (const RepairSampleFile& file : files) {
        if (file.origin.link_radius_m == prediction::repair_link_radius_m) continue;
        throw core::InputError(
            {fmt::format("--data: {}, {}, replication {}", file.origin.scenario, file.origin.failure,
                         file.origin.replication),
             fmt::format("links below {} m", file.origin.link_radius_m),
             fmt::format("{} m, for which the net is made", prediction::repair_link_radius_m),
             "Record with link_radius_m = 50"});
    }
}

/// A share of the samples, evenly spread.
Samples thinned(const Samples& samples, std::size_t most) {
    if (most == 0 || samples.size() <= most) return samples;
    Samples kept;
    for (std::size_t i = 0; i < most; ++i)
        kept.push_back(samples[i * samples.size() / most]);
    return kept;
}

template <class Visit>
void for_each_batch(const Samples& samples, std::size_t size, const Visit& visit) {
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
    Training(const RepairConfig& config, const Checkpoint& checkpoint, Samples train, Samples validation)
        : config_(config),
          checkpoint_(checkpoint),
          train_(std::move(train)),
          validation_(std::move(validation)),
          net_(config.net()) {
        if (read_checkpoint(checkpoint_, config_, progress_)) {
            net_.load(progress_.net);
            net_.load_optimizer(progress_.optimizer);
        }
    }

    void run(const TrainingHooks& hooks, RepairResult& result) {
        for (auto epoch = static_cast<std::uint32_t>(progress_.losses.size());
             epoch < config_.epochs && !progress_.stopped_early; ++epoch) {
            if (hooks.should_stop && hooks.should_stop()) {
                result.outcome = Outcome::interrupted;
                break;
            }
            const EpochLoss loss = run_epoch(epoch);
            if (!std::isfinite(loss.train) || !std::isfinite(loss.held_out)) {
                result.outcome = Outcome::diverged;
                progress_.losses.push_back(loss);
                break;
            }
            take(epoch, loss);
            if (hooks.on_epoch) hooks.on_epoch(epoch, loss);
        }
        if (progress_.stopped_early) result.outcome = Outcome::stopped_early;
        result.losses = progress_.losses;
        result.best_epoch = progress_.best_epoch;
        result.state = progress_.best;
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
        Samples order = train_;
        detail::shuffle(order, config_.seed, epoch);
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

    void take(std::uint32_t epoch, const EpochLoss& loss) {
        const double best = progress_.best.empty() ? std::numeric_limits<double>::infinity()
                                                   : progress_.losses[progress_.best_epoch].held_out;
        progress_.losses.push_back(loss);
        progress_.net = net_.state();
        progress_.optimizer = net_.optimizer_state();
        if (loss.held_out < best) {
            progress_.best_epoch = epoch;
            progress_.best = progress_.net;
        } else if (epoch - progress_.best_epoch >= config_.patience) {
            progress_.stopped_early = true;
        }
        write_checkpoint(checkpoint_, config_, progress_);
    }

    const RepairConfig& config_;
    const Checkpoint& checkpoint_;
    Samples train_, validation_;
    TorchRepairNet net_;
    RepairProgress progress_;
};

/// Scores of pairs by the net and by the rule, with labels, and errors of displacements.
struct Scores {
    std::vector<float> logits;
    std::vector<double> rule;
    std::vector<std::uint8_t> linked;
    double error_m = 0.0, rule_error_m = 0.0;
    std::size_t moved = 0;

    void append(const Scores& more) {
        logits.insert(logits.end(), more.logits.begin(), more.logits.end());
        rule.insert(rule.end(), more.rule.begin(), more.rule.end());
        linked.insert(linked.end(), more.linked.begin(), more.linked.end());
        error_m += more.error_m;
        rule_error_m += more.rule_error_m;
        moved += more.moved;
    }
};

Scores scores_of(const TorchRepairNet& net, const RepairConfig& config, const RepairSampleFile& file) {
    Scores scores;
    for (const RepairSample& sample : file.samples) {
        const RepairSample* const one = &sample;
        const RepairBatch batch = batch_of(std::span(&one, 1), config.edges);
        const RepairOutput output = net.run(batch);
        scores.logits.insert(scores.logits.end(), output.logits.begin(), output.logits.end());
        scores.rule.insert(scores.rule.end(), sample.rule.begin(), sample.rule.end());
        scores.linked.insert(scores.linked.end(), sample.linked.begin(), sample.linked.end());
        for (std::size_t i = 0; i < batch.receiver_count(); ++i) {
            const float truth = batch.true_displacement_m[i];
            if (truth < 0.0F) continue;
            scores.error_m += std::abs(std::clamp(output.displacement_m[i], 0.0F, batch.reach_m[i]) - truth);
            scores.rule_error_m += std::abs(batch.displacement_m[i] - truth);
            ++scores.moved;
        }
    }
    return scores;
}

/// AUC and AP rank by logits, because beyond 37 all probabilities round to 1 and would tie.
metrics::LinkQuality quality_by_net(const Scores& scores, double threshold) {
    metrics::LinkQuality quality =
        metrics::link_quality({probabilities(scores.logits), scores.linked}, threshold);
    const std::vector<double> ranks(scores.logits.begin(), scores.logits.end());
    quality.auc = metrics::area_under_roc({ranks, scores.linked});
    quality.ap = metrics::average_precision({ranks, scores.linked});
    return quality;
}

RepairGroup group_of(const std::string& scenario, const std::string& failure, const Scores& scores,
                     const RepairResult& result) {
    const double moved = static_cast<double>(std::max<std::size_t>(scores.moved, 1));
    return {scenario,
            failure,
            quality_by_net(scores, result.threshold),
            metrics::link_quality({scores.rule, scores.linked}, result.rule_threshold),
            scores.error_m / moved,
            scores.rule_error_m / moved};
}

/// Chooses thresholds on the validation seeds and measures on the test seeds.
void measure(const TorchRepairNet& net, const std::vector<RepairSampleFile>& files,
             const RepairConfig& config, RepairResult& result) {
    Scores validation, all;
    std::map<std::string, Scores> by_failure;
    std::map<std::pair<std::string, std::string>, Scores> by_both;
    for (const RepairSampleFile& file : files) {
        if (detail::is_of(file, result.seeds.validation)) validation.append(scores_of(net, config, file));
        if (!detail::is_of(file, result.seeds.test)) continue;
        const Scores scores = scores_of(net, config, file);
        all.append(scores);
        by_failure[file.origin.failure].append(scores);
        by_both[{file.origin.failure, file.origin.scenario}].append(scores);
    }
    result.threshold = metrics::best_f1_threshold({probabilities(validation.logits), validation.linked});
    result.rule_threshold = metrics::best_f1_threshold({validation.rule, validation.linked});
    result.groups.push_back(group_of("", "", all, result));
    for (const auto& [failure, scores] : by_failure)
        result.groups.push_back(group_of("", failure, scores, result));
    for (const auto& [both, scores] : by_both)
        result.groups.push_back(group_of(both.second, both.first, scores, result));
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

RepairResult train_repair(const std::vector<RepairSampleFile>& files, const RepairConfig& config,
                          const Checkpoint& checkpoint, const TrainingHooks& hooks) {
    if (files.empty()) {
        throw core::InputError({"--data", "no samples", "",
                                "Record some with clearway dataset SCENARIO --samples --net graphsage"});
    }
    check_radius(files);
    RepairResult result;
    result.seeds =
        detail::split_files(files, {config.split_seed, config.validation_share, config.test_share});
    const Samples train = thinned(samples_of(files, result.seeds.train), config.most_snapshots);
    const Samples validation = samples_of(files, result.seeds.validation);
    detail::require_both_classes(labels_of(train), "training");
    detail::require_both_classes(labels_of(validation), "validation");
    detail::require_both_classes(labels_of(samples_of(files, result.seeds.test)), "test");
    result.train_snapshots = train.size();
    for (const RepairSample* const sample : train)
        result.train_pairs += sample->linked.size();

    Training training(config, checkpoint, train, validation);
    training.run(hooks, result);
    const bool measured = !result.state.empty() && result.outcome != Outcome::interrupted;
    if (measured) measure(training.net(), files, config, result);
    return result;
}

}  // namespace clearway::training
