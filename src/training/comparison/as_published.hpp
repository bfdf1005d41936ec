#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "metrics/link_quality.hpp"
#include "samples/dataset_files.hpp"
#include "training/comparison/graph_batch.hpp"
#include "training/comparison/net_training.hpp"

namespace clearway::training {

/// The dissertation does not say whether the list holds only true edges, so both readings exist.
enum class PairChoice : std::uint8_t {
    candidates,  ///< Every listed pair, with its label.
    true_only,   ///< The listed pairs whose label is 1, in their order.
};
constexpr core::Spellings<PairChoice, 2> spellings(PairChoice) {
    return {{{PairChoice::candidates, "candidates"}, {PairChoice::true_only, "true-links"}}};
}

/// How a trained net scores every listed pair of a snapshot that it was not trained on, by what its messages
/// may use.
struct UnseenQuality {
    std::string data;                 ///< Its folder.
    metrics::LinkQuality listed;      ///< Messages along the listed pairs, as the published test does.
    metrics::LinkQuality true_links;  ///< Messages along the true links: the answer is in the input.
    /// Without messages: what is left when the pairs are unknown, as at run time.
    metrics::LinkQuality no_messages;
};

/// After a divergence `state` are the parameters of the last epoch with finite losses, otherwise those after
/// the last epoch. None when the first epoch diverged.
struct AsPublishedResult : NetResult {
    AsPublishedResult() {
        held_out = "test";
        pth = "GraphSAGENet";
    }
    nlohmann::ordered_json facts() const override;
    /// predictions.csv: every listed pair with its label, part of the split, logit and probability.
    void write_more(const std::filesystem::path& folder) const override;

    OrderedSplit split;
    samples::PairDataset dataset;  ///< The pairs that were used.
    /// By `state`, one per pair; train and test pairs each with messages along their own pairs.
    std::vector<double> logits;
    metrics::LinkQuality train_quality;
    metrics::LinkQuality test_quality;
    /// Log loss of the test labels when every pair gets the share of true links among the training pairs:
    /// what a net without any input reaches.
    double constant_test_loss = 0.0;
    std::vector<UnseenQuality> unseen;  ///< Filled by the caller with `score_unseen`.
    /// Reasons why the figures mean less than they seem to; one sentence each.
    std::vector<std::string> warnings;
};

/// The dissertation's training (chapters 5.2 and 5.3), kept as it is: one snapshot; the list cut in its order
/// after three quarters; messages along the very pairs whose links are predicted; one Adam step per epoch on
/// all training pairs; both losses computed before the step. Throws core::InputError when fewer than 5 pairs
/// are left (the test part would be empty); `data` is the folder that it names. Deterministic.
AsPublishedResult train_as_published(const samples::PairDataset& dataset, PairChoice pairs,
                                     const TrainingConfig& config, const TrainingHooks& hooks = {},
                                     const std::filesystem::path& data = {});

/// Scores the net of `state` on `unseen`; `data` names it in messages. Throws core::InputError when its
/// vehicles have another number of features than the net takes.
UnseenQuality score_unseen(const StateDict& state, const TrainingConfig& config,
                           const samples::PairDataset& unseen, const std::string& data);

/// The schema of the published features with this number of columns (2 or 5).
prediction::FeatureSchema as_published_schema(std::uint32_t feature_count);

/// Text of `predictions.csv`.
std::string predictions_csv(const AsPublishedResult& result);
/// Identifies a training.
Identity identity_of(PairChoice pairs, const TrainingConfig& config, const std::string& data_hash);

}  // namespace clearway::training
