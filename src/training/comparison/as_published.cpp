#include "training/comparison/as_published.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "prediction/comparison/features.hpp"
#include "training/detail/figures.hpp"

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

struct Batches {
    GraphBatch train;
    GraphBatch test;
};

/// The published loop. Leaves losses, outcome and state in `result`.
void run_epochs(TorchNet& net, const Batches& batches, std::uint32_t epochs, const TrainingHooks& hooks,
                AsPublishedResult& result) {
    StateDict before;
    const auto run = [&](std::uint32_t) {
        before = net.state();
        EpochLoss loss;
        loss.held_out = net.loss(batches.test);
        loss.train = net.train_step(batches.train);
        return loss;
    };
    run_rounds(
        {epochs}, hooks, run, [&](bool) { result.state = before; }, result);
    if (result.losses.empty() || result.outcome == Outcome::diverged) return;
    if (std::isfinite(net.loss(batches.train)) && std::isfinite(net.loss(batches.test))) {
        result.state = net.state();
    } else {
        result.outcome = Outcome::diverged;  // In the very last step.
    }
}

std::vector<double> widened(const std::vector<float>& logits) {
    return {logits.begin(), logits.end()};
}

void score(TorchNet& net, const GraphBatch& train, const GraphBatch& test, AsPublishedResult& result) {
    net.load(result.state);
    result.logits = widened(net.logits(train));
    const std::vector<double> test_logits = widened(net.logits(test));
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
            fmt::format("every training label is {0}: a net that always answers {0} has the lowest loss and "
                        "learns nothing about links",
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
    result.train_pairs = result.split.train;
    result.features = as_published_schema(result.dataset.feature_count);
    result.dimensions = {result.dataset.feature_count, config.hidden, config.output};
    const Batches batches{as_published_batch(result.dataset, 0, result.split.train),
                          as_published_batch(result.dataset, result.split.train, result.split.test)};
    TorchNet net({result.dimensions, config.seed, config.learning_rate});
    run_epochs(net, batches, config.epochs, hooks, result);
    if (!result.state.empty()) score(net, batches.train, batches.test, result);
    result.constant_test_loss = constant_loss(batches.train, batches.test);
    add_warnings(batches.train, batches.test, result);
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
        return quality_of_logits(widened(net.logits(batch)), link_flags(batch.label));
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

std::string predictions_csv(const AsPublishedResult& result) {
    std::string text = "pair,source,target,label,split,logit,probability\n";
    const std::vector<double> probability = probabilities(result.logits);
    for (std::size_t pair = 0; pair < result.logits.size(); ++pair) {
        text += fmt::format("{},{},{},{},{},{},{}\n", pair, result.dataset.source[pair],
                            result.dataset.target[pair], result.dataset.label[pair],
                            pair < result.split.train ? "train" : "test",
                            static_cast<float>(result.logits[pair]), probability[pair]);
    }
    return text;
}

void AsPublishedResult::write_more(const std::filesystem::path& folder) const {
    core::write_atomically(folder / "predictions.csv", predictions_csv(*this));
}

Identity identity_of(PairChoice pairs, const TrainingConfig& config, const std::string& data_hash) {
    return {{"mode", as_published_name},
            {"data_hash", data_hash},
            {"configuration", detail::json_from(config)},
            {"pairs", name(pairs)}};
}

nlohmann::ordered_json AsPublishedResult::facts() const {
    using detail::json_from;
    nlohmann::ordered_json json = NetResult::facts();
    json["vehicle_count"] = dataset.vehicle_count();
    json["feature_count"] = dataset.feature_count;
    json["pair_count"] = dataset.pair_count();
    json["test_pair_count"] = split.test;
    json["constant_test_loss_nat"] = constant_test_loss;
    if (!state.empty()) {
        json["train"] = json_from(train_quality);
        json["test"] = json_from(test_quality);
    }
    for (const UnseenQuality& data : unseen) {
        json["unseen"].push_back({{"data", data.data},
                                  {"messages_listed", json_from(data.listed)},
                                  {"messages_true_links", json_from(data.true_links)},
                                  {"messages_none", json_from(data.no_messages)}});
    }
    json["warnings"] = warnings;
    return json;
}

}  // namespace clearway::training
