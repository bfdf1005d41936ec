#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "prediction/weights.hpp"

namespace clearway::training::detail {

/// Rows of inputs with labels, as XGBoost keeps them.
class BoostingData {
  public:
    /// `inputs` has `width` numbers for each label; every weight counts its row that often.
    BoostingData(const std::vector<float>& inputs, std::size_t width, const std::vector<float>& labels,
                 const std::vector<float>& weights);

    void* handle() const { return handle_.get(); }
    const std::vector<float>& labels() const { return labels_; }
    const std::vector<float>& weights() const { return weights_; }

  private:
    struct Free {
        void operator()(void* handle) const;
    };
    std::unique_ptr<void, Free> handle_;
    std::vector<float> labels_, weights_;
};

/// Trees of XGBoost for the log loss of a binary label. Its errors are thrown as std::runtime_error.
class Booster {
  public:
    struct Parameter {
        std::string name;
        std::string value;
    };
    /// Both outlive the booster.
    Booster(const BoostingData& train, const BoostingData& held_out,
            const std::vector<Parameter>& parameters);

    /// Adds one tree.
    void grow();
    /// Mean log loss of `data`, one of the two, nat.
    double loss(const BoostingData& data) const;
    /// Logits of the rows of `data`, one of the two.
    std::vector<float> logits(const BoostingData& data) const;
    /// The first `trees` trees, as prediction::BoostedTrees takes them: its tensors.
    std::vector<prediction::Tensor> tensors(std::size_t trees) const;

  private:
    struct Free {
        void operator()(void* handle) const;
    };
    const BoostingData& train_;
    std::unique_ptr<void, Free> handle_;
    int grown_ = 0;
};

}  // namespace clearway::training::detail
