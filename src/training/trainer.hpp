#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/spellings.hpp"
#include "metrics/link_quality.hpp"
#include "prediction/weights.hpp"
#include "training/seeds.hpp"

namespace clearway::training {

// What all trainings have in common: rounds with early stopping, and their result.

/// Parameters of a model, those of nets under PyTorch Geometric's names in the order of Python's
/// `state_dict()`.
using StateDict = std::vector<prediction::Tensor>;

/// Losses of one epoch, or of one tree more: the training loss as the mean of the epoch's steps and the other
/// after them. As published both are those of the parameters that the epoch started with.
struct EpochLoss {
    double train = 0.0;
    double held_out = 0.0;  ///< Validation seeds; as published the test pairs.
};

enum class Outcome : std::uint8_t {
    finished,       ///< All rounds ran.
    stopped_early,  ///< Validation no longer improved.
    diverged,       ///< A loss was not finite; the last good parameters are kept.
    interrupted,    ///< `should_stop` said so; the parameters so far are kept.
};
constexpr core::Spellings<Outcome, 4> spellings(Outcome) {
    return {{{Outcome::finished, "finished"},
             {Outcome::stopped_early, "stopped_early"},
             {Outcome::diverged, "diverged"},
             {Outcome::interrupted, "interrupted"}}};
}
using core::name;

/// How a caller follows a training. Both may be empty.
struct TrainingHooks {
    std::function<void(std::uint32_t epoch, const EpochLoss& loss)> on_epoch;  ///< `epoch` from 0.
    std::function<bool()> should_stop;                                         ///< Asked before every epoch.
};

/// Quality on the test seeds: for all pairs, or those of a failure, or of a scenario and a failure.
struct GroupQuality {
    std::string scenario;  ///< Empty: all.
    std::string failure;   ///< Empty: all.
    metrics::LinkQuality model;
    /// What needs no training, on the same pairs.
    std::optional<metrics::LinkQuality> reference = {};
    /// Mean absolute error of displacements, m; 0 without any. None of a model that moves no vehicle.
    std::optional<double> displacement_error_m = {};
    std::optional<double> reference_displacement_error_m = {};
};

/// What every training gives, and what its files call things.
struct TrainingResult {
    virtual ~TrainingResult() = default;
    /// What the summary says beside.
    virtual nlohmann::ordered_json facts() const { return nlohmann::ordered_json::object(); }
    /// The model; without tensors where none is good, or the program cannot run it.
    virtual prediction::Weights weights() const = 0;
    /// Writes files of its own. Throws core::EnvironmentError.
    virtual void write_more(const std::filesystem::path& /*folder*/) const {}

    Outcome outcome = Outcome::finished;
    std::vector<EpochLoss> losses;  ///< One per round; after a divergence the last is not finite.
    std::uint32_t best_round = 0;   ///< Of the least loss that is held out.
    StateDict state;                ///< Of the best round; none when no round had finite losses.
    SeedSplit seeds;
    std::uint64_t train_pairs = 0;
    double threshold = 0.5;                     ///< Of greatest F1 on the validation seeds.
    std::optional<double> reference_threshold;  ///< None: that of the reference's greatest F1, too.
    prediction::RadiusRange link_radius;        ///< Of all the data.
    std::vector<GroupQuality> groups;           ///< All, by failure, by scenario and failure.

    const char* round = "epoch";
    const char* held_out = "validation";
    const char* reference = "";  ///< The predictor that needs no training.
    std::string pth;  ///< Name of the file for `torch.load`, without its ending; empty: there is none.
};

struct RoundLimits {
    std::uint32_t rounds = 0;
    std::uint32_t patience = UINT32_MAX;  ///< Rounds without a better loss before training stops.
};
/// Runs rounds from `result.losses.size()` on, until one of the outcomes; sets outcome, losses and best
/// round. `run(round)` returns the losses, `keep(is_best)` is called after each round whose losses are
/// finite.
void run_rounds(const RoundLimits& limits, const TrainingHooks& hooks,
                const std::function<EpochLoss(std::uint32_t round)>& run,
                const std::function<void(bool is_best)>& keep, TrainingResult& result);

/// Probabilities of logits, for metrics.
std::vector<double> probabilities(const std::vector<double>& logits);
/// Labels 0 and 1 as metrics take them.
std::vector<std::uint8_t> link_flags(const std::vector<float>& labels);
/// Quality of logits. AUC and AP rank by the logits themselves: beyond 37 all probabilities round to 1 and
/// would tie.
metrics::LinkQuality quality_of_logits(const std::vector<double>& logits,
                                       const std::vector<std::uint8_t>& linked, double threshold = 0.5);

/// Sums of absolute errors of displacements.
struct DisplacementErrors {
    double model_m = 0.0;
    double reference_m = 0.0;
    std::size_t count = 0;
};
/// Scores of pairs by a model and by the reference, with labels.
struct Scores {
    std::vector<double> logits;
    std::vector<double> reference;  ///< Probabilities; empty without a reference.
    std::vector<std::uint8_t> linked;
    std::optional<DisplacementErrors> displacements;  ///< None of a model that moves no vehicle.
};
/// Chooses thresholds on the validation seeds and measures on the test seeds. `score(file)` scores all pairs
/// of a file, by its place in `origins`.
void measure(const Origins& origins, const std::function<Scores(std::size_t file)>& score,
             TrainingResult& result);

}  // namespace clearway::training
