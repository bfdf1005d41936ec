#include "training/torch_repair_net.hpp"

#include <cmath>
#include <stdexcept>

#include <torch/optim/adam.h>
#include <torch/utils.h>

#include "training/detail/torch_parts.hpp"

namespace clearway::training {
namespace {

using detail::float_tensor;
using detail::index_tensor;
using detail::Linear;
using detail::NamedTensors;
using detail::rows_of;
using detail::uniform_parameter;
using prediction::path_points;
using torch::Tensor;

std::int64_t size_of(std::size_t size) {
    return static_cast<std::int64_t>(size);
}

/// Refers to the memory of a RepairBatch.
struct BatchTensors {
    explicit BatchTensors(const RepairBatch& batch)
        : vehicles(size_of(batch.vehicle_count())),
          receivers(size_of(batch.receiver_count())),
          nodes(float_tensor(batch.nodes, {vehicles, prediction::node_width})),
          places(at::stack({float_tensor(batch.x_m, {vehicles}), float_tensor(batch.y_m, {vehicles})}, 1)),
          place_sigma(float_tensor(batch.place_sigma_m, {vehicles, 1})),
          path(float_tensor(batch.path, {receivers, path_points, 2})),
          displacement(float_tensor(batch.displacement_m, {receivers, 1})),
          reach(float_tensor(batch.reach_m, {receivers, 1})),
          true_displacement(float_tensor(batch.true_displacement_m, {receivers, 1})),
          source(index_tensor(batch.edge_source)),
          receiver(index_tensor(batch.edge_receiver)),
          edges(float_tensor(batch.edges, {size_of(batch.edge_count()), prediction::edge_width})),
          left(index_tensor(batch.pair_left)),
          right(index_tensor(batch.pair_right)),
          pair_features(
              float_tensor(batch.pair_features, {size_of(batch.pair_count()), prediction::pair_width})),
          radius(float_tensor(batch.radius_m, {size_of(batch.pair_count()), 1})),
          label(float_tensor(batch.label, {size_of(batch.pair_count()), 1})),
          weight(float_tensor(batch.weight, {size_of(batch.pair_count()), 1})) {
        degree = torch::zeros({vehicles}).scatter_add(0, receiver, torch::ones(receiver.sizes()));
    }
    std::int64_t vehicles, receivers;
    Tensor nodes, places, place_sigma, path, displacement, reach, true_displacement;
    Tensor source, receiver, edges, left, right, pair_features, radius, label, weight;
    Tensor degree;  ///< Messages that each row receives.
};

/// Sum over the messages of each receiver: receivers x width.
Tensor sum_to_receivers(const Tensor& messages, const BatchTensors& inputs) {
    const Tensor to = inputs.receiver.unsqueeze(1).expand({-1, messages.size(1)});
    return torch::zeros({inputs.receivers, messages.size(1)}).scatter_add(0, to, messages);
}

Tensor mean_to_receivers(const Tensor& messages, const BatchTensors& inputs) {
    const Tensor count = inputs.degree.narrow(0, 0, inputs.receivers).clamp_min(1.0).unsqueeze(1);
    return sum_to_receivers(messages, inputs) / count;
}

/// A gate in (0, 1) without an exponential.
Tensor gate_of(const Tensor& x) {
    return 0.5 + 0.5 * x / (1.0 + x.abs());
}

/// One round of messages. Writes new rows for the receivers; the known vehicles keep theirs.
struct MessageLayer {
    MessageLayer(std::int64_t width, Aggregation kind, at::Generator& generator)
        : aggregation(kind),
          gate_own(width, width, generator),
          gate_source(uniform_parameter({width, width}, width, generator)),
          gate_edge(uniform_parameter({width, prediction::edge_width}, prediction::edge_width, generator)),
          value_source(width, width, generator),
          value_edge(uniform_parameter({width, prediction::edge_width}, prediction::edge_width, generator)),
          out_message(width, width, generator),
          out_own(uniform_parameter({width, width}, width, generator)) {}

    Tensor messages(const Tensor& h, const BatchTensors& inputs) const {
        const Tensor own = h.narrow(0, 0, inputs.receivers);
        const Tensor value = rows_of(value_source(h), inputs.source) + at::linear(inputs.edges, value_edge);
        if (aggregation == Aggregation::mean) return mean_to_receivers(value, inputs);
        if (aggregation == Aggregation::gated) {
            const Tensor gate =
                gate_of(rows_of(at::linear(h, gate_source), inputs.source) +
                        rows_of(gate_own(own), inputs.receiver) + at::linear(inputs.edges, gate_edge));
            return mean_to_receivers(gate * value, inputs);
        }
        const Tensor sources = rows_of(value_source(h), inputs.source);
        if (aggregation == Aggregation::gcn) {
            const Tensor root = (inputs.degree + 1.0).rsqrt();
            const Tensor scale = (root.gather(0, inputs.source) * root.gather(0, inputs.receiver));
            const Tensor self = value_source(own) * root.narrow(0, 0, inputs.receivers).square().unsqueeze(1);
            return sum_to_receivers(sources * scale.unsqueeze(1), inputs) + self;
        }
        const Tensor mixed = at::leaky_relu(
            sources + rows_of(gate_own(own), inputs.receiver) + at::linear(inputs.edges, gate_edge), 0.2);
        const Tensor score = at::linear(mixed, gate_source.narrow(0, 0, 1)).clamp(-30.0, 30.0).exp();
        return sum_to_receivers(score * sources, inputs) / sum_to_receivers(score, inputs).clamp_min(1e-12);
    }

    Tensor operator()(const Tensor& h, const BatchTensors& inputs) const {
        const Tensor own = h.narrow(0, 0, inputs.receivers);
        const Tensor others = h.narrow(0, inputs.receivers, inputs.vehicles - inputs.receivers);
        const Tensor renewed = at::relu(out_message(messages(h, inputs)) + at::linear(own, out_own));
        return at::cat({renewed, others}, 0);
    }

    NamedTensors named(const std::string& prefix) const {
        return {{prefix + "gate_own.weight", gate_own.weight},
                {prefix + "gate_own.bias", gate_own.bias},
                {prefix + "gate_source.weight", gate_source},
                {prefix + "gate_edge.weight", gate_edge},
                {prefix + "value_source.weight", value_source.weight},
                {prefix + "value_source.bias", value_source.bias},
                {prefix + "value_edge.weight", value_edge},
                {prefix + "out_message.weight", out_message.weight},
                {prefix + "out_message.bias", out_message.bias},
                {prefix + "out_own.weight", out_own}};
    }

    Aggregation aggregation;
    Linear gate_own;
    Tensor gate_source, gate_edge;
    Linear value_source;
    Tensor value_edge;
    Linear out_message;
    Tensor out_own;
};

/// Where the receivers are believed to be: one row each.
struct Motion {
    Tensor displacement;  ///< As estimated; may lie outside of [0, reach].
    Tensor sigma;
    Tensor place;      ///< x, y of the displacement held within the reach.
    Tensor direction;  ///< Unit vector.
};

Motion place_on_path(const Tensor& displacement, const Tensor& sigma, const BatchTensors& inputs) {
    constexpr auto segments = static_cast<double>(path_points - 1);
    const Tensor at_path = (displacement / inputs.reach).clamp(0.0, 1.0) * segments;
    const Tensor segment = at_path.detach().floor().clamp_max(segments - 1.0);
    const Tensor share = at_path - segment;
    // When training diverges, places are NaN: then any segment will do, because the loss shows the
    // divergence.
    const Tensor index = segment.nan_to_num(0.0).to(torch::kInt64).unsqueeze(2).expand({-1, 1, 2});
    const Tensor from = inputs.path.gather(1, index).squeeze(1);
    const Tensor along = inputs.path.gather(1, index + 1).squeeze(1) - from;
    const Tensor length = (along * along).sum(1, true).sqrt() + 1e-6;
    return {displacement, sigma, from + share * along, along / length};
}

}  // namespace

struct TorchRepairNet::Parts {
    explicit Parts(const RepairNetConfig& net) : Parts(net, detail::prepared_generator(net.seed)) {}

    Parts(const RepairNetConfig& net, at::Generator generator)
        : config(net),
          encoder(prediction::node_width, net.dimensions.hidden, generator),
          motion1(net.dimensions.hidden, net.dimensions.motion, generator),
          motion2(net.dimensions.motion, 2, generator),
          embedding(net.dimensions.hidden, net.dimensions.embedding, generator),
          decoder1(prediction::decoder_width(net.dimensions), net.dimensions.decoder, generator),
          decoder2(net.dimensions.decoder, net.dimensions.last, generator),
          decoder3(net.dimensions.last, 1, generator),
          skip(torch::ones({1}).requires_grad_(true)) {
        for (std::uint32_t layer = 0; layer < net.dimensions.layers; ++layer) {
            layers.emplace_back(net.dimensions.hidden, net.aggregation, generator);
        }
        optimizer = std::make_unique<torch::optim::Adam>(detail::tensors_of(named()),
                                                         torch::optim::AdamOptions(1e-3));
    }

    NamedTensors named() const {
        NamedTensors all = {{"encoder.weight", encoder.weight}, {"encoder.bias", encoder.bias}};
        for (std::size_t layer = 0; layer < layers.size(); ++layer) {
            const NamedTensors more = layers[layer].named("layer" + std::to_string(layer + 1) + ".");
            all.insert(all.end(), more.begin(), more.end());
        }
        const NamedTensors rest = {{"motion1.weight", motion1.weight},
                                   {"motion1.bias", motion1.bias},
                                   {"motion2.weight", motion2.weight},
                                   {"motion2.bias", motion2.bias},
                                   {"embedding.weight", embedding.weight},
                                   {"embedding.bias", embedding.bias},
                                   {"decoder1.weight", decoder1.weight},
                                   {"decoder1.bias", decoder1.bias},
                                   {"decoder2.weight", decoder2.weight},
                                   {"decoder2.bias", decoder2.bias},
                                   {"decoder3.weight", decoder3.weight},
                                   {"decoder3.bias", decoder3.bias},
                                   {"skip", skip}};
        all.insert(all.end(), rest.begin(), rest.end());
        return all;
    }

    Motion move(const Tensor& h, const BatchTensors& inputs) const {
        const Tensor spread = prediction::motion_step_m + prediction::motion_share * inputs.reach;
        if (!config.motion_head) return place_on_path(inputs.displacement, 0.5 * spread, inputs);
        const Tensor out = motion2(at::relu(motion1(h.narrow(0, 0, inputs.receivers))));
        const Tensor displacement = inputs.displacement + spread * out.narrow(1, 0, 1);
        const Tensor sigma = prediction::least_sigma_m + spread * at::softplus(out.narrow(1, 1, 1));
        return place_on_path(displacement, sigma, inputs);
    }

    /// Distance inputs of the decoder: distance, score, P(d < r), spread.
    static Tensor distances(const Motion& motion, const BatchTensors& inputs, Tensor& score) {
        const std::int64_t known = inputs.vehicles - inputs.receivers;
        const Tensor places = at::cat({motion.place, inputs.places.narrow(0, inputs.receivers, known)}, 0);
        const Tensor sigmas = at::cat({motion.sigma, torch::zeros({known, 1})}, 0);
        const Tensor directions = at::cat({motion.direction, torch::zeros({known, 2})}, 0);
        const Tensor apart = rows_of(places, inputs.left) - rows_of(places, inputs.right);
        const Tensor distance = ((apart * apart).sum(1, true) + 1e-3).sqrt();
        const Tensor towards = apart / distance;
        const auto variance = [&](const Tensor& rows) {
            const Tensor along = (rows_of(directions, rows) * towards).sum(1, true);
            return rows_of(inputs.place_sigma, rows).square() +
                   rows_of(sigmas, rows).square() * (prediction::side_share + along.square());
        };
        const Tensor spread = (1.0 + variance(inputs.left) + variance(inputs.right)).sqrt();
        score = ((inputs.radius - distance) / spread).clamp(-6.0, 6.0);
        const Tensor probability = 0.5 + 0.5 * at::erf(score * M_SQRT1_2);
        return at::cat(
            {(distance / 50.0).clamp_max(4.0), 0.5 * score, probability, (spread / 20.0).clamp_max(6.0)}, 1);
    }

    static Tensor link_loss(const Tensor& logits, const BatchTensors& inputs) {
        return at::binary_cross_entropy_with_logits(logits, inputs.label, inputs.weight, {},
                                                    at::Reduction::Sum) /
               inputs.weight.sum();
    }

    struct Result {
        Motion motion;
        Tensor logits;
    };
    Result forward(const BatchTensors& inputs) const {
        Tensor h = at::relu(encoder(inputs.nodes));
        for (const MessageLayer& layer : layers)
            h = layer(h, inputs);
        const Motion motion = move(h, inputs);
        const Tensor z = embedding(h);
        const Tensor left = rows_of(z, inputs.left);
        const Tensor right = rows_of(z, inputs.right);
        Tensor score;
        Tensor facts = at::cat({inputs.pair_features, distances(motion, inputs, score)}, 1);
        if (!config.pair_features) facts = torch::zeros_like(facts);
        const Tensor pair = at::cat({left * right, (left - right).abs(), facts}, 1);
        Tensor logits = decoder3(at::relu(decoder2(at::relu(decoder1(pair)))));
        if (config.pair_features) logits = logits + skip * score;
        return {motion, logits};
    }

    static Tensor motion_loss(const Motion& motion, const BatchTensors& inputs) {
        const Tensor labelled = (inputs.true_displacement >= 0.0).to(torch::kFloat32);
        const Tensor error = (motion.displacement - inputs.true_displacement).abs();
        const Tensor loss = error / motion.sigma + (2.0 * motion.sigma).log();
        return (loss * labelled).sum() / labelled.sum().clamp_min(1.0);
    }

    RepairNetConfig config;
    Linear encoder;
    std::vector<MessageLayer> layers;
    Linear motion1, motion2, embedding, decoder1, decoder2, decoder3;
    Tensor skip;
    std::unique_ptr<torch::optim::Adam> optimizer;
};

TorchRepairNet::TorchRepairNet(const RepairNetConfig& config) : parts_(std::make_unique<Parts>(config)) {}
TorchRepairNet::TorchRepairNet(TorchRepairNet&&) noexcept = default;
TorchRepairNet& TorchRepairNet::operator=(TorchRepairNet&&) noexcept = default;
TorchRepairNet::~TorchRepairNet() = default;

RepairOutput TorchRepairNet::run(const RepairBatch& batch) const {
    const torch::NoGradGuard no_gradient;
    const Parts::Result result = parts_->forward(BatchTensors(batch));
    const auto numbers = [](const Tensor& tensor) {
        const Tensor flat = tensor.contiguous();
        return std::vector<float>(flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel());
    };
    return {numbers(result.logits), numbers(result.motion.displacement), numbers(result.motion.sigma)};
}

RepairLoss TorchRepairNet::loss(const RepairBatch& batch) const {
    const torch::NoGradGuard no_gradient;
    const BatchTensors inputs(batch);
    const Parts::Result result = parts_->forward(inputs);
    return {Parts::link_loss(result.logits, inputs).item<float>(),
            Parts::motion_loss(result.motion, inputs).item<float>()};
}

RepairLoss TorchRepairNet::train_step(const RepairBatch& batch, double learning_rate) {
    const BatchTensors inputs(batch);
    torch::optim::Adam& optimizer = *parts_->optimizer;
    static_cast<torch::optim::AdamOptions&>(optimizer.param_groups().front().options()).lr(learning_rate);
    optimizer.zero_grad();
    const Parts::Result result = parts_->forward(inputs);
    const Tensor links = Parts::link_loss(result.logits, inputs);
    const Tensor motion = Parts::motion_loss(result.motion, inputs);
    const RepairLoss loss{links.item<float>(), motion.item<float>()};
    if (!std::isfinite(loss.links) || !std::isfinite(loss.motion)) return loss;
    const bool moves = parts_->config.motion_head;
    (moves ? links + parts_->config.motion_weight * motion : links).backward();
    optimizer.step();
    return loss;
}

StateDict TorchRepairNet::state() const {
    return detail::state_of(parts_->named());
}

void TorchRepairNet::load(const StateDict& state) {
    detail::copy_state(state, parts_->named());
}

StateDict TorchRepairNet::optimizer_state() const {
    StateDict state;
    std::int64_t steps = 0;
    for (const auto& [name, tensor] : parts_->named()) {
        const auto found =
            parts_->optimizer->state().find(c10::guts::to_string(tensor.unsafeGetTensorImpl()));
        if (found == parts_->optimizer->state().end()) continue;
        const auto& adam = static_cast<const torch::optim::AdamParamState&>(*found->second);
        state.push_back(detail::to_named(name + ".mean", adam.exp_avg()));
        state.push_back(detail::to_named(name + ".square", adam.exp_avg_sq()));
        steps = adam.step();
    }
    if (!state.empty()) state.push_back({"steps", {1}, {static_cast<float>(steps)}});
    return state;
}

void TorchRepairNet::load_optimizer(const StateDict& state) {
    if (state.empty()) return;
    const NamedTensors named = parts_->named();
    const auto steps = static_cast<std::int64_t>(state.back().values.at(0));
    std::size_t at = 0;
    for (const auto& [name, tensor] : named) {
        // Parameters that got no gradient (of parts that the ablation leaves out) have no moments.
        if (at >= state.size() || state[at].name != name + ".mean") continue;
        auto adam = std::make_unique<torch::optim::AdamParamState>();
        adam->step(steps);
        adam->exp_avg(float_tensor(state[at].values, tensor.sizes()).clone());
        adam->exp_avg_sq(float_tensor(state.at(at + 1).values, tensor.sizes()).clone());
        parts_->optimizer->state()[c10::guts::to_string(tensor.unsafeGetTensorImpl())] = std::move(adam);
        at += 2;
    }
    if (at + 1 != state.size()) throw std::logic_error("moments of another net");
}

std::size_t TorchRepairNet::parameter_count() const {
    std::size_t count = 0;
    for (const auto& [name, tensor] : parts_->named())
        count += static_cast<std::size_t>(tensor.numel());
    return count;
}

}  // namespace clearway::training
