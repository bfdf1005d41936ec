#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "metrics/link_quality.hpp"
#include "samples/dataset_files.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

/// Whether the list holds only true edges is unsaid in the dissertation, so both readings exist.
enum class PairChoice : std::uint8_t {
    candidates,  ///< Every listed pair, with its label.
    true_only,   ///< The listed pairs whose label is 1, in their order.
};

/// How a trained net scores every listed pair of a snapshot that it was not trained on, by what its messages
/// may use.
struct UnseenQuality {
    std::string data;                 ///< Its folder.
    metrics::LinkQuality listed;      ///< Messages along the listed pairs, as the published test does.
    metrics::LinkQuality true_links;  ///< Messages along the true links: the answer is in the input.
    metrics::LinkQuality
        no_messages;  ///< Without messages: what is left when the pairs are unknown, as at run time.
};

struct AsPublishedResult {
    Outcome outcome = Outcome::finished;
    std::vector<EpochLoss>
        losses;  ///< One an epoch; after a divergence the last is the one that is not finite.
    /// Parameters after the last epoch; after a divergence those of the last epoch with finite losses, or
    /// none at all when the first epoch diverged.
    StateDict state;
    OrderedSplit split;
    samples::PairDataset dataset;  ///< The pairs that were used.
    std::vector<float> logits;     ///< By `state`, one a pair, each part with the messages of its own pairs.
    metrics::LinkQuality train_quality;
    metrics::LinkQuality test_quality;
    /// Log loss of the test labels when every pair gets the share of true links among the training pairs:
    /// what a net without any input reaches.
    double constant_test_loss = 0.0;
    std::vector<UnseenQuality> unseen;  ///< Filled by the caller with `score_unseen`.
    std::vector<std::string>
        warnings;  ///< What makes the figures say less than they seem to; a sentence each.
};

/// The dissertation's training (chapters 5.2 and 5.3), kept as it is: one snapshot; the list cut in its order
/// after three quarters; messages along the very pairs whose links are predicted; one Adam step an epoch on
/// all training pairs; both losses computed before the step. Throws core::InputError when fewer than 5 pairs
/// are left (the test part would be empty); `data` is the folder that it names. Deterministic.
AsPublishedResult train_as_published(const samples::PairDataset& dataset, PairChoice pairs,
                                     const TrainingConfig& config, const TrainingHooks& hooks = {},
                                     const std::filesystem::path& data = {});

/// Scores the net of `state` on `unseen`; `data` names it in messages. Throws core::InputError when its
/// vehicles have another number of features than the net takes.
UnseenQuality score_unseen(const StateDict& state, const TrainingConfig& config,
                           const samples::PairDataset& unseen, const std::string& data);

/// The schema of the published features with so many columns (2 or 5).
prediction::FeatureSchema as_published_schema(std::uint32_t feature_count);

}  // namespace clearway::training
