#include "training/as_published.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/features.hpp"

namespace clearway::training {
namespace {

constexpr std::size_t fewest_pairs = 5;

samples::PairDataset chosen(const samples::PairDataset& all, PairChoice pairs) {
    if (pairs == PairChoice::candidates) return all;
    samples::PairDataset kept;
    kept.feature_count = all.feature_count;
    kept.features = all.features;
    for (std::size_t pair = 0; pair < all.pair_count(); ++pair) {
        if (all.label[pair] != 1.0F) continue;
        kept.source.push_back(all.source[pair]);
        kept.target.push_back(all.target[pair]);
        kept.label.push_back(1.0F);
    }
    return kept;
}

bool finite(const EpochLoss& loss) {
    return std::isfinite(loss.train) && std::isfinite(loss.held_out);
}

/// The published loop. Leaves losses, outcome and state in `result`.
// NOLINTNEXTLINE(readability-function-size): the loop of the source, with all that it touches named
void run_epochs(TorchNet& net, const GraphBatch& train, const GraphBatch& test, std::uint32_t epochs,
                const TrainingHooks& hooks, AsPublishedResult& result) {
    for (std::uint32_t epoch = 0; epoch < epochs; ++epoch) {
        if (hooks.should_stop && hooks.should_stop()) {
            result.outcome = Outcome::interrupted;
            break;
        }
        const StateDict before = net.state();
        EpochLoss loss;
        loss.held_out = net.loss(test);
        loss.train = net.train_step(train);
        result.losses.push_back(loss);
        if (hooks.on_epoch) hooks.on_epoch(epoch, loss);
        if (!finite(loss)) {
            result.outcome = Outcome::diverged;
            return;  // `result.state` is still that of the last epoch with finite losses.
        }
        result.state = before;
    }
    if (result.losses.empty()) return;
    if (finite({net.loss(train), net.loss(test)})) {
        result.state = net.state();
    } else {
        result.outcome = Outcome::diverged;  // In the very last step.
    }
}

void score(TorchNet& net, const GraphBatch& train, const GraphBatch& test, AsPublishedResult& result) {
    net.load(result.state);
    result.logits = net.logits(train);
    const std::vector<float> test_logits = net.logits(test);
    result.train_quality = quality_of_logits(result.logits, link_flags(train.label));
    result.test_quality = quality_of_logits(test_logits, link_flags(test.label));
    result.logits.insert(result.logits.end(), test_logits.begin(), test_logits.end());
}

double constant_loss(const GraphBatch& train, const GraphBatch& test) {
    double share = 0.0;
    for (const float label : train.label)
        share += label / static_cast<double>(train.pair_count());
    const std::vector<double> constant(test.pair_count(), share);
    return *metrics::log_loss({constant, link_flags(test.label)});
}

void add_warnings(const GraphBatch& train, const GraphBatch& test, AsPublishedResult& result) {
    const auto one_class = [](const std::vector<float>& labels) {
        return std::ranges::adjacent_find(labels, std::ranges::not_equal_to{}) == labels.end();
    };
    if (one_class(train.label)) {
        result.warnings.push_back(
            fmt::format("every training label is {}: a net that always says so has the lowest loss, and "
                        "nothing about links is learnt",
                        train.label[0]));
    }
    if (one_class(test.label)) {
        result.warnings.push_back(fmt::format("every test label is {}: the AUC is undefined", test.label[0]));
    }
    result.warnings.push_back(
        "as published, messages flow along the very pairs that are predicted; at run time these pairs are "
        "unknown");
}

}  // namespace

AsPublishedResult train_as_published(const samples::PairDataset& dataset, PairChoice pairs,
                                     const TrainingConfig& config, const TrainingHooks& hooks,
                                     const std::filesystem::path& data) {
    AsPublishedResult result;
    result.dataset = chosen(dataset, pairs);
    const std::size_t count = result.dataset.pair_count();
    if (count < fewest_pairs) {
        throw core::InputError(
            {(data / samples::target_file).string(),
             fmt::format("{} {}pair{}", count, pairs == PairChoice::true_only ? "true " : "",
                         count == 1 ? "" : "s"),
             fmt::format("{} or more", fewest_pairs),
             "With fewer the ordered split leaves no pair to test on"});
    }
    result.split = ordered_split(count);
    const GraphBatch train = as_published_batch(result.dataset, 0, result.split.train);
    const GraphBatch test = as_published_batch(result.dataset, result.split.train, result.split.test);
    TorchNet net(
        {{result.dataset.feature_count, config.hidden, config.output}, config.seed, config.learning_rate});
    run_epochs(net, train, test, config.epochs, hooks, result);
    if (!result.state.empty()) score(net, train, test, result);
    result.constant_test_loss = constant_loss(train, test);
    add_warnings(train, test, result);
    return result;
}

UnseenQuality score_unseen(const StateDict& state, const TrainingConfig& config,
                           const samples::PairDataset& unseen, const std::string& data) {
    const std::uint32_t input = state.front().shape.back();
    if (unseen.feature_count != input) {
        throw core::InputError({data + "/" + samples::vehicle_features_file,
                                fmt::format("{} features a vehicle", unseen.feature_count),
                                fmt::format("{}", input),
                                "Give the unseen data the features that the net was trained on"});
    }
    TorchNet net({{input, config.hidden, config.output}, config.seed, config.learning_rate});
    net.load(state);
    const auto quality = [&](const GraphBatch& batch) {
        return quality_of_logits(net.logits(batch), link_flags(batch.label));
    };
    UnseenQuality result;
    result.data = data;
    GraphBatch batch = as_published_batch(unseen, 0, unseen.pair_count());
    result.listed = quality(batch);
    const samples::PairDataset links = chosen(unseen, PairChoice::true_only);
    const GraphBatch only_links = as_published_batch(links, 0, links.pair_count());
    batch.message_source = only_links.pair_left;
    batch.message_target = only_links.pair_right;
    result.true_links = quality(batch);
    batch.message_source.clear();
    batch.message_target.clear();
    result.no_messages = quality(batch);
    return result;
}

prediction::FeatureSchema as_published_schema(std::uint32_t feature_count) {
    assert(feature_count == 2 || feature_count == 5);
    return feature_count == 2 ? prediction::as_published_position_schema()
                              : prediction::as_published_attributes_schema();
}

}  // namespace clearway::training
