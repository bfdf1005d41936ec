// Few files of the module include torch, whose headers take most of a minute to compile; so only those needed
// are included here.
#include "training/torch_net.hpp"

#include <cmath>

#include <torch/csrc/jit/serialization/pickle.h>
#include <torch/optim/adam.h>
#include <torch/utils.h>

#include "core/error.hpp"
#include "core/files.hpp"
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

/// SAGEConv of PyTorch Geometric with its defaults: lin_l (with bias) on the mean of the neighbours, lin_r
/// (without) on the row itself.
struct Convolution {
    Convolution(std::int64_t inputs, std::int64_t outputs, at::Generator& generator)
        : neighbour(inputs, outputs, generator),
          own(uniform_parameter({outputs, inputs}, inputs, generator)) {}
    torch::Tensor operator()(const torch::Tensor& x, const Inputs& inputs) const {
        const torch::Tensor messages = rows_of(x, inputs.source);
        const torch::Tensor receivers = inputs.target.unsqueeze(1).expand({-1, x.size(1)});
        const torch::Tensor mean = torch::zeros_like(x).scatter_add(0, receivers, messages) * inputs.share;
        return neighbour(mean) + at::linear(x, own);
    }
    Linear neighbour;
    torch::Tensor own;
};

}  // namespace

struct TorchNet::Parts {
    explicit Parts(const TorchNetConfig& config) : Parts(config, detail::prepared_generator(config.seed)) {}

    Parts(const TorchNetConfig& config, at::Generator generator)
        : conv1(config.dimensions.input, config.dimensions.hidden, generator),
          conv2(config.dimensions.hidden, config.dimensions.output, generator),
          fc1(config.dimensions.output, config.dimensions.hidden, generator),
          fc2(config.dimensions.hidden, 1, generator),
          optimizer(detail::tensors_of(named()), torch::optim::AdamOptions(config.learning_rate)) {}

    detail::NamedTensors named() const {
        return {{"graphsage.conv1.lin_l.weight", conv1.neighbour.weight},
                {"graphsage.conv1.lin_l.bias", conv1.neighbour.bias},
                {"graphsage.conv1.lin_r.weight", conv1.own},
                {"graphsage.conv2.lin_l.weight", conv2.neighbour.weight},
                {"graphsage.conv2.lin_l.bias", conv2.neighbour.bias},
                {"graphsage.conv2.lin_r.weight", conv2.own},
                {"nn.fc1.weight", fc1.weight},
                {"nn.fc1.bias", fc1.bias},
                {"nn.fc2.weight", fc2.weight},
                {"nn.fc2.bias", fc2.bias}};
    }
    torch::Tensor forward(const Inputs& inputs) const {
        const torch::Tensor z = conv2(conv1(inputs.x, inputs), inputs);
        const torch::Tensor product = rows_of(z, inputs.left) * rows_of(z, inputs.right);
        return fc2(at::relu(fc1(product)));
    }

    Convolution conv1, conv2;
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

StateDict read_pth(const std::string& file) {
    const std::string bytes = core::read_file(file);
    StateDict state;
    try {
        const c10::IValue value = torch::jit::pickle_load(std::vector<char>(bytes.begin(), bytes.end()));
        for (const auto& entry : value.toGenericDict()) {
            state.push_back(detail::to_named(entry.key().toStringRef(), entry.value().toTensor()));
        }
    } catch (const std::exception& error) {  // c10::Error, and what the archive reader lets through.
        const std::string message = error.what();
        throw core::InputError(
            {file, "not a state dict: " + message.substr(0, message.find('\n')), "",
             "Save one with clearway train or Python's torch.save(dict(model.state_dict()), file)"});
    }
    return state;
}

}  // namespace clearway::training
