// Few files of the module include torch, whose headers take most of a minute to compile; so only those needed
// are included here.
#include "training/comparison/torch_net.hpp"

#include <cmath>

#include <torch/optim/adam.h>
#include <torch/utils.h>

#include "training/detail/torch_parts.hpp"

namespace clearway::training {
namespace {

using detail::float_tensor;
using detail::index_tensor;
using detail::Linear;
using detail::rows_of;
using detail::uniform_parameter;

/// Refers to the memory of a GraphBatch.
struct Inputs {
    explicit Inputs(const GraphBatch& batch)
        : x(float_tensor(batch.features, {static_cast<std::int64_t>(batch.vehicle_count()),
                                          std::int64_t{batch.feature_count}})),
          source(index_tensor(batch.message_source)),
          target(index_tensor(batch.message_target)),
          left(index_tensor(batch.pair_left)),
          right(index_tensor(batch.pair_right)),
          label(float_tensor(batch.label, {static_cast<std::int64_t>(batch.pair_count()), 1})) {
        const torch::Tensor received =
            torch::zeros({x.size(0)}).scatter_add(0, target, torch::ones(target.sizes()));
        share = (1.0 / received.clamp_min(1.0)).unsqueeze(1);
    }
    torch::Tensor x, source, target, left, right, label;
    torch::Tensor share;  ///< One over the number of messages that a row receives.
};

/// What stands for `conv1` and `conv2`.
class ConvolutionLayer {
  public:
    virtual ~ConvolutionLayer() = default;
    virtual torch::Tensor operator()(const torch::Tensor& x, const Inputs& inputs) const = 0;
    virtual detail::NamedTensors named(const std::string& prefix) const = 0;
};

/// SAGEConv of PyTorch Geometric with its defaults: lin_l (with bias) on the mean of the neighbours, lin_r
/// (without) on the row itself.
class SageLayer final : public ConvolutionLayer {
  public:
    SageLayer(std::int64_t inputs, std::int64_t outputs, at::Generator& generator)
        : neighbour_(inputs, outputs, generator),
          own_(uniform_parameter({outputs, inputs}, inputs, generator)) {}
    torch::Tensor operator()(const torch::Tensor& x, const Inputs& inputs) const override {
        const torch::Tensor messages = rows_of(x, inputs.source);
        const torch::Tensor receivers = inputs.target.unsqueeze(1).expand({-1, x.size(1)});
        const torch::Tensor mean = torch::zeros_like(x).scatter_add(0, receivers, messages) * inputs.share;
        return neighbour_(mean) + at::linear(x, own_);
    }
    detail::NamedTensors named(const std::string& prefix) const override {
        return {{prefix + ".lin_l.weight", neighbour_.weight},
                {prefix + ".lin_l.bias", neighbour_.bias},
                {prefix + ".lin_r.weight", own_}};
    }

  private:
    Linear neighbour_;
    torch::Tensor own_;
};

/// GCNConv or GATConv (one head) of PyTorch Geometric with their defaults: messages of a row to itself left
/// out, and each row among its own neighbours once.
class SelfLoopLayer final : public ConvolutionLayer {
  public:
    SelfLoopLayer(Convolution kind, std::int64_t inputs, std::int64_t outputs, at::Generator& generator)
        : kind_(kind),
          weight_(detail::glorot_parameter({outputs, inputs}, inputs + outputs, generator)),
          bias_(torch::zeros({outputs}).requires_grad_(true)) {
        if (kind_ != Convolution::gat) return;
        source_attention_ = detail::glorot_parameter({1, 1, outputs}, 1 + outputs, generator);
        target_attention_ = detail::glorot_parameter({1, 1, outputs}, 1 + outputs, generator);
    }
    torch::Tensor operator()(const torch::Tensor& x, const Inputs& inputs) const override {
        const torch::Tensor others = (inputs.source != inputs.target).nonzero().squeeze(1);
        const torch::Tensor all = torch::arange(x.size(0), torch::kInt64);
        const torch::Tensor source = at::cat({inputs.source.gather(0, others), all}, 0);
        const torch::Tensor target = at::cat({inputs.target.gather(0, others), all}, 0);
        const torch::Tensor projected = at::linear(x, weight_);
        const torch::Tensor share = kind_ == Convolution::gcn ? shares_by_degree(x.size(0), source, target)
                                                              : attention(projected, source, target);
        const torch::Tensor receivers = target.unsqueeze(1).expand({-1, projected.size(1)});
        return torch::zeros_like(projected).scatter_add(0, receivers,
                                                        rows_of(projected, source) * share.unsqueeze(1)) +
               bias_;
    }
    detail::NamedTensors named(const std::string& prefix) const override {
        detail::NamedTensors all = {{prefix + ".lin.weight", weight_}};
        if (kind_ == Convolution::gat) {
            all.emplace_back(prefix + ".att_src", source_attention_);
            all.emplace_back(prefix + ".att_dst", target_attention_);
        }
        all.emplace_back(prefix + ".bias", bias_);
        return all;
    }

  private:
    static torch::Tensor shares_by_degree(std::int64_t rows, const torch::Tensor& source,
                                          const torch::Tensor& target) {
        const torch::Tensor degree = torch::zeros({rows}).scatter_add(0, target, torch::ones(target.sizes()));
        const torch::Tensor root = degree.rsqrt();
        return root.gather(0, source) * root.gather(0, target);
    }
    torch::Tensor attention(const torch::Tensor& projected, const torch::Tensor& source,
                            const torch::Tensor& target) const {
        const torch::Tensor by_source = at::matmul(projected, source_attention_.flatten());
        const torch::Tensor by_target = at::matmul(projected, target_attention_.flatten());
        const torch::Tensor score =
            at::leaky_relu(by_source.gather(0, source) + by_target.gather(0, target), 0.2);
        // The greatest score of a row keeps exponentials finite; it cancels, so no gradient needs it.
        const torch::Tensor greatest =
            torch::full({projected.size(0)}, -INFINITY).scatter_reduce(0, target, score.detach(), "amax");
        const torch::Tensor weight = (score - greatest.gather(0, target)).exp();
        const torch::Tensor sum = torch::zeros({projected.size(0)}).scatter_add(0, target, weight);
        return weight / sum.gather(0, target);
    }

    Convolution kind_;
    torch::Tensor weight_, bias_, source_attention_, target_attention_;
};

std::unique_ptr<ConvolutionLayer> layer_of(Convolution kind, std::int64_t inputs, std::int64_t outputs,
                                           at::Generator& generator) {
    if (kind == Convolution::sage) return std::make_unique<SageLayer>(inputs, outputs, generator);
    return std::make_unique<SelfLoopLayer>(kind, inputs, outputs, generator);
}

/// What stands before the names of the convolutions' tensors.
std::string prefix_of(Convolution kind) {
    return kind == Convolution::sage ? "graphsage" : std::string(name(kind));
}

}  // namespace

struct TorchNet::Parts {
    explicit Parts(const TorchNetConfig& config) : Parts(config, detail::prepared_generator(config.seed)) {}

    Parts(const TorchNetConfig& config, at::Generator generator)
        : prefix(prefix_of(config.convolution)),
          conv1(layer_of(config.convolution, config.dimensions.input, config.dimensions.hidden, generator)),
          conv2(layer_of(config.convolution, config.dimensions.hidden, config.dimensions.output, generator)),
          fc1(config.dimensions.output, config.dimensions.hidden, generator),
          fc2(config.dimensions.hidden, 1, generator),
          optimizer(detail::tensors_of(named()), torch::optim::AdamOptions(config.learning_rate)) {}

    detail::NamedTensors named() const {
        detail::NamedTensors all = conv1->named(prefix + ".conv1");
        for (const auto& [name, tensor] : conv2->named(prefix + ".conv2"))
            all.emplace_back(name, tensor);
        for (const auto& [name, tensor] : detail::NamedTensors{{"nn.fc1.weight", fc1.weight},
                                                               {"nn.fc1.bias", fc1.bias},
                                                               {"nn.fc2.weight", fc2.weight},
                                                               {"nn.fc2.bias", fc2.bias}})
            all.emplace_back(name, tensor);
        return all;
    }
    torch::Tensor forward(const Inputs& inputs) const {
        const torch::Tensor z = (*conv2)((*conv1)(inputs.x, inputs), inputs);
        const torch::Tensor product = rows_of(z, inputs.left) * rows_of(z, inputs.right);
        return fc2(at::relu(fc1(product)));
    }

    std::string prefix;
    std::unique_ptr<ConvolutionLayer> conv1, conv2;
    Linear fc1, fc2;
    torch::optim::Adam optimizer;
};

TorchNet::TorchNet(const TorchNetConfig& config) : parts_(std::make_unique<Parts>(config)) {}
TorchNet::TorchNet(TorchNet&&) noexcept = default;
TorchNet& TorchNet::operator=(TorchNet&&) noexcept = default;
TorchNet::~TorchNet() = default;

std::vector<float> TorchNet::logits(const GraphBatch& batch) const {
    const torch::NoGradGuard no_gradient;
    const torch::Tensor result = parts_->forward(Inputs(batch)).contiguous();
    return {result.data_ptr<float>(), result.data_ptr<float>() + result.numel()};
}

double TorchNet::loss(const GraphBatch& batch) const {
    const torch::NoGradGuard no_gradient;
    const Inputs inputs(batch);
    return at::binary_cross_entropy_with_logits(parts_->forward(inputs), inputs.label).item<float>();
}

double TorchNet::train_step(const GraphBatch& batch) {
    const Inputs inputs(batch);
    parts_->optimizer.zero_grad();
    const torch::Tensor loss = at::binary_cross_entropy_with_logits(parts_->forward(inputs), inputs.label);
    const double value = loss.item<float>();
    if (!std::isfinite(value)) return value;
    loss.backward();
    parts_->optimizer.step();
    return value;
}

StateDict TorchNet::state() const {
    return detail::state_of(parts_->named());
}

void TorchNet::load(const StateDict& state) {
    detail::copy_state(state, parts_->named());
}

}  // namespace clearway::training
