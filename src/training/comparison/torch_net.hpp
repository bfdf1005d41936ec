#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "prediction/comparison/dissertation_net.hpp"
#include "prediction/weights.hpp"
#include "training/comparison/graph_batch.hpp"
#include "training/trainer.hpp"

namespace clearway::training {

using prediction::Convolution;

struct TorchNetConfig {
    prediction::NetDimensions dimensions;
    std::uint64_t seed = 1;       ///< Of the initial parameters.
    double learning_rate = 0.01;  ///< Of Adam; its other numbers are torch's defaults. Dissertation 5.3.
    Convolution convolution = Convolution::sage;
};

/// The dissertation's GraphSAGENet in libtorch: GraphSAGE of two SAGEConv (mean, no activation between),
/// Hadamard product of the ends of a pair, Linear, ReLU, Linear; binary cross entropy with logits; Adam. Or
/// the same with GCNConv or GATConv. The oracle for `prediction::DissertationNet`. Parameters start uniform
/// in +-1/sqrt(inputs), the default of torch's Linear and of PyTorch Geometric's (kaiming_uniform with a =
/// sqrt(5)), from a generator of its own; those of GCNConv and GATConv in +-sqrt(6 / (inputs + outputs)),
/// biases 0, as PyTorch Geometric's (glorot, zeros). Runs on one processor core with deterministic
/// algorithms: same seed and data, same bits. No header of torch is needed to use it.
class TorchNet {
  public:
    explicit TorchNet(const TorchNetConfig& config);
    TorchNet(TorchNet&&) noexcept;
    TorchNet& operator=(TorchNet&&) noexcept;
    ~TorchNet();

    /// One logit per pair of the batch.
    std::vector<float> logits(const GraphBatch& batch) const;
    /// Mean loss over the pairs; NaN without pairs.
    double loss(const GraphBatch& batch) const;
    /// One step of Adam on the batch's mean loss. Returns the loss before the step. When that is not finite
    /// the parameters stay as they are.
    double train_step(const GraphBatch& batch);

    StateDict state() const;
    /// Replaces the parameters, not Adam's moments. Throws std::logic_error for other names or shapes.
    void load(const StateDict& state);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace clearway::training
