#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "metrics/link_quality.hpp"
#include "training/torch_net.hpp"

namespace clearway::training {

/// Settings shared by both trainings of the published net. The defaults are the dissertation's.
struct TrainingConfig {
    std::uint32_t epochs = 100;
    double learning_rate = 0.01;
    std::uint32_t hidden = 10;
    std::uint32_t output = 5;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using C = TrainingConfig;
        return std::make_tuple(
            core::Field{"epochs", "1", &C::epochs, 1.0, 100000.0, "Passes over the training pairs, at most",
                        "dissertation 5.3"},
            core::Field{"learning_rate", "1", &C::learning_rate, 1e-9, 1e30, "Step size of Adam",
                        "dissertation 5.3"},
            core::Field{"hidden", "1", &C::hidden, 1.0, 4096.0,
                        "Width between the two convolutions, and of the decoder", "dissertation 5.3"},
            core::Field{"output", "1", &C::output, 1.0, 4096.0, "Width of a vehicle's embedding",
                        "dissertation 5.3"},
            core::Field{"seed", "1", &C::seed, 0.0, 9e15,
                        "Seed of the initial parameters and of every shuffle", "the dissertation sets none"});
    }
};

/// Losses of one epoch, both with the parameters that the epoch started with (as published), or the training
/// loss as the mean of its steps and the other after them (corrected).
struct EpochLoss {
    double train = 0.0;
    double held_out = 0.0;  ///< Test pairs (as published), validation seeds (corrected).
};

enum class Outcome : std::uint8_t {
    finished,       ///< All epochs ran.
    stopped_early,  ///< Validation no longer improved.
    diverged,       ///< A loss was not finite; the last good parameters are kept.
    interrupted,    ///< `should_stop` said so; the parameters so far are kept.
};
/// `finished`, `stopped_early`, `diverged`, `interrupted`.
std::string_view name(Outcome outcome);

/// How a caller follows a training. Both may be empty.
struct TrainingHooks {
    std::function<void(std::uint32_t epoch, const EpochLoss& loss)> on_epoch;  ///< `epoch` from 0.
    std::function<bool()> should_stop;                                         ///< Asked before every epoch.
};

/// Probabilities of logits, for metrics.
std::vector<double> probabilities(const std::vector<float>& logits);
/// Labels 0 and 1 as metrics take them.
std::vector<std::uint8_t> link_flags(const std::vector<float>& labels);

/// Quality of logits. AUC and AP rank by the logits themselves: beyond 37 all probabilities round to 1 and
/// would tie.
metrics::LinkQuality quality_of_logits(const std::vector<float>& logits,
                                       const std::vector<std::uint8_t>& linked, double threshold = 0.5);

}  // namespace clearway::training
