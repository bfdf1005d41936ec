#pragma once

#include <cstdint>
#include <string>

#include "core/fields.hpp"
#include "training/comparison/torch_net.hpp"
#include "training/output_folder.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

// What both trainings of the dissertation's net share.

/// The defaults are the dissertation's.
struct TrainingConfig {
    std::uint32_t epochs = 100;
    double learning_rate = 0.01;
    std::uint32_t hidden = 10;
    std::uint32_t output = 5;
    std::uint64_t seed = 1;

    static constexpr void fields(const auto& table) {
        using C = TrainingConfig;
        table(
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

/// The predictor that such a net drives, trained as published or soundly; it names the training.
inline std::string corrected_name(Convolution convolution) {
    return convolution == Convolution::sage ? "graphsage_corrected" : std::string(name(convolution));
}
inline constexpr const char* as_published_name = "graphsage_as_published";

/// The result of either, with its net.
struct NetResult : TrainingResult {
    nlohmann::ordered_json facts() const override;
    prediction::Weights weights() const override;

    Convolution convolution = Convolution::sage;
    prediction::FeatureSchema features;
    prediction::NetDimensions dimensions;
};

}  // namespace clearway::training
