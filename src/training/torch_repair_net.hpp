#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/spellings.hpp"
#include "prediction/repair_net.hpp"
#include "training/repair_batch.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

/// How vehicles that are not known gather what their neighbours know. `gated` is the net that is shipped.
enum class Aggregation : std::uint8_t {
    gated,  ///< Mean over messages, each scaled by a gate of both ends and the edge.
    mean,   ///< GraphSAGE: mean over messages of source and edge.
    gcn,    ///< Kipf and Welling 2017: sum over sources, by the roots of both degrees; blind to edges.
    gat,    ///< Brody et al. 2022 (GATv2), one head; edges speak in the attention alone.
};
constexpr core::Spellings<Aggregation, 4> spellings(Aggregation) {
    return {{{Aggregation::gated, "gated"},
             {Aggregation::mean, "mean"},
             {Aggregation::gcn, "gcn"},
             {Aggregation::gat, "gat"}}};
}

/// What a net consists of. Whatever differs from the default is for ablation studies: it can be trained and
/// measured, and the program cannot run it.
struct RepairNetConfig {
    prediction::RepairDimensions dimensions;
    Aggregation aggregation = Aggregation::gated;
    bool motion_head = true;     ///< Off: every vehicle stays where the rule puts it.
    bool pair_features = true;   ///< Off: the decoder sees embeddings alone.
    double motion_weight = 0.2;  ///< Of the motion loss beside the link loss.
    std::uint64_t seed = 1;
};

/// Mean losses of a batch.
struct RepairLoss {
    double links = 0.0;   ///< Log loss of the pairs, nat.
    double motion = 0.0;  ///< Of displacements under a Laplace density, nat; receivers with a label alone.
};

struct RepairOutput {
    std::vector<float> logits;          ///< One per pair.
    std::vector<float> displacement_m;  ///< One per receiver.
    std::vector<float> sigma_m;
};

/// The improved net in libtorch (prediction::RepairNet says what it computes), and Adam. The oracle of
/// prediction::RepairNet. One core, deterministic. No header of torch is needed to use it.
class TorchRepairNet {
  public:
    explicit TorchRepairNet(const RepairNetConfig& config);
    TorchRepairNet(TorchRepairNet&&) noexcept;
    TorchRepairNet& operator=(TorchRepairNet&&) noexcept;
    ~TorchRepairNet();

    RepairOutput run(const RepairBatch& batch) const;
    RepairLoss loss(const RepairBatch& batch) const;
    /// One step of Adam. Returns the losses before it. When they are not finite the parameters stay.
    RepairLoss train_step(const RepairBatch& batch, double learning_rate);

    StateDict state() const;
    /// Throws std::logic_error for other names or shapes.
    void load(const StateDict& state);
    /// Adam's moments, and the number of steps as a tensor of one value; empty before the first step.
    StateDict optimizer_state() const;
    void load_optimizer(const StateDict& state);
    std::size_t parameter_count() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace clearway::training
