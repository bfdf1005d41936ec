#include "prediction/repair_net.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/detail/repair_kernel.hpp"

namespace clearway::prediction {
namespace {

/// Pairs that are decoded together: their inputs stay in the processor's cache.
constexpr std::size_t block_pairs = 48;
constexpr float root_half = 0.70710678F;

float softplus(float x) {
    return x > 20.0F ? x : std::log1p(std::exp(x));
}

void require_size(const Weights& weights, const char* name, std::uint32_t wanted) {
    const std::uint32_t found = weights.dimension(name);
    if (found == wanted) return;
    throw core::InputError({weights.source, fmt::format("dimension {} is {}", name, found),
                            fmt::format("{}, as this program computes it", wanted),
                            "Train the model again with this version"});
}

}  // namespace

std::size_t RepairNet::Linear::stride() const {
    return detail::padded(outputs);
}

RepairNet::Linear RepairNet::linear_from(const Weights& weights, const std::string& name,
                                         std::uint32_t inputs, std::uint32_t outputs, Bias bias) {
    Linear linear;
    linear.inputs = inputs;
    linear.outputs = outputs;
    const std::size_t stride = linear.stride();
    const Tensor& tensor = weights.tensor(name + ".weight", {outputs, inputs});
    linear.weight.assign(inputs * stride, 0.0F);
    for (std::size_t output = 0; output < outputs; ++output) {
        for (std::size_t input = 0; input < inputs; ++input) {
            linear.weight[input * stride + output] = tensor.values[output * inputs + input];
        }
    }
    linear.bias.assign(stride, 0.0F);
    if (bias == Bias::with) {
        std::ranges::copy(weights.tensor(name + ".bias", {outputs}).values, linear.bias.begin());
    }
    return linear;
}

RepairNet::RepairNet(const Weights& weights, Kernel kernel) : source_(weights.source), kernel_(kernel) {
    weights.require(repair_architecture, repair_schema());
    require_size(weights, "edge", edge_width);
    require_size(weights, "pair", pair_width);
    weights.require_inputs("node", node_inputs);
    weights.require_inputs("edge", edge_inputs);
    weights.require_inputs("pair", pair_inputs);
    dimensions_ = {weights.dimension("hidden"),    weights.dimension("layers"),  weights.dimension("motion"),
                   weights.dimension("embedding"), weights.dimension("decoder"), weights.dimension("last")};
    const std::uint32_t hidden = dimensions_.hidden;
    encoder_ = linear_from(weights, "encoder", std::uint32_t{node_width}, hidden, Bias::with);
    for (std::uint32_t number = 1; number <= dimensions_.layers; ++number) {
        const std::string layer = fmt::format("layer{}.", number);
        layers_.push_back(
            {linear_from(weights, layer + "gate_own", hidden, hidden, Bias::with),
             linear_from(weights, layer + "gate_source", hidden, hidden, Bias::without),
             linear_from(weights, layer + "gate_edge", std::uint32_t{edge_width}, hidden, Bias::without),
             linear_from(weights, layer + "value_source", hidden, hidden, Bias::with),
             linear_from(weights, layer + "value_edge", std::uint32_t{edge_width}, hidden, Bias::without),
             linear_from(weights, layer + "out_message", hidden, hidden, Bias::with),
             linear_from(weights, layer + "out_own", hidden, hidden, Bias::without)});
    }
    motion1_ = linear_from(weights, "motion1", hidden, dimensions_.motion, Bias::with);
    motion2_ = linear_from(weights, "motion2", dimensions_.motion, 2, Bias::with);
    embedding_ = linear_from(weights, "embedding", hidden, dimensions_.embedding, Bias::with);
    decoder1_ = linear_from(weights, "decoder1", decoder_width(dimensions_), dimensions_.decoder, Bias::with);
    decoder2_ = linear_from(weights, "decoder2", dimensions_.decoder, dimensions_.last, Bias::with);
    decoder3_ = linear_from(weights, "decoder3", dimensions_.last, 1, Bias::with);
    skip_ = weights.tensor("skip", {1}).values.front();
    weights.require_tensors(15 + 10 * std::size_t{dimensions_.layers});
}

// NOLINTNEXTLINE(readability-function-size): a matrix, what goes in, and where it comes out
void RepairNet::apply(const Linear& linear, const float* input, std::size_t input_stride, Rows rows,
                      Activation activation, std::vector<float>& result) const {
    detail::DenseTask task;
    task.input = input;
    task.input_stride = input_stride;
    task.inputs = linear.inputs;
    task.rows = rows.numbers;
    task.row_count = rows.count;
    task.weight = linear.weight.data();
    task.bias = linear.bias.data();
    task.rectified = activation == Activation::rectified;
    task.result = result.data();
    task.result_stride = linear.stride();
    kernel_ == Kernel::avx2 ? detail::dense_avx2(task) : detail::dense_scalar(task);
}

void RepairNet::run(const RepairInputs& inputs, std::vector<float>& logits,
                    std::vector<BelievedMotion>& motions) {
    sort_rows(inputs);
    encode(inputs);
    for (const Layer& layer : layers_) {
        exchange(layer, inputs);
    }
    move(inputs, motions);
    embeddings_.resize(inputs.rows * embedding_.stride());
    apply(embedding_, hidden_.data(), encoder_.stride(), {pair_rows_.data(), pair_rows_.size()},
          Activation::none, embeddings_);
    decode(inputs, logits);
}

/// Lists receivers, other vehicles that matter, sources of messages, and ends of pairs.
void RepairNet::sort_rows(const RepairInputs& inputs) {
    constexpr std::uint8_t is_receiver = 1;
    constexpr std::uint8_t is_source = 2;
    constexpr std::uint8_t is_end = 4;
    marked_.assign(inputs.rows, 0);
    for (const Receiver& receiver : inputs.receivers) {
        marked_[receiver.row] = is_receiver;
    }
    for (const std::uint32_t row : inputs.source) {
        marked_[row] |= is_source;
    }
    for (const RowPair pair : inputs.pairs) {
        marked_[pair.left] |= is_end;
        marked_[pair.right] |= is_end;
    }
    for (std::vector<std::uint32_t>* const list :
         {&receiver_rows_, &known_rows_, &source_rows_, &pair_rows_}) {
        list->clear();
    }
    for (std::uint32_t row = 0; row < inputs.rows; ++row) {
        const std::uint8_t mark = marked_[row];
        if ((mark & is_receiver) != 0) {
            receiver_rows_.push_back(row);
        } else if (mark != 0) {
            known_rows_.push_back(row);
        }
        if ((mark & is_source) != 0) source_rows_.push_back(row);
        if ((mark & is_end) != 0) pair_rows_.push_back(row);
    }
}

void RepairNet::encode(const RepairInputs& inputs) {
    hidden_.resize(inputs.rows * encoder_.stride());
    apply(encoder_, inputs.nodes.data(), node_width, {receiver_rows_.data(), receiver_rows_.size()},
          Activation::rectified, hidden_);
    detail::DenseTask task;
    task.input = inputs.nodes.data();
    task.input_stride = node_width;
    task.inputs = common_width;
    task.rows = known_rows_.data();
    task.row_count = known_rows_.size();
    task.weight = encoder_.weight.data();
    task.bias = encoder_.bias.data();
    task.rectified = true;
    task.result = hidden_.data();
    task.result_stride = encoder_.stride();
    kernel_ == Kernel::avx2 ? detail::dense_avx2(task) : detail::dense_scalar(task);
}

void RepairNet::exchange(const Layer& layer, const RepairInputs& inputs) {
    const std::size_t width = encoder_.stride();
    const std::size_t receivers = receiver_rows_.size();
    const Rows sources{source_rows_.data(), source_rows_.size()};
    const Rows all{nullptr, receivers};
    source_gate_.resize(inputs.rows * width);
    source_value_.resize(inputs.rows * width);
    apply(layer.gate_source, hidden_.data(), width, sources, Activation::none, source_gate_);
    apply(layer.value_source, hidden_.data(), width, sources, Activation::none, source_value_);

    own_hidden_.resize(receivers * width);
    for (std::size_t i = 0; i < receivers; ++i) {
        std::copy_n(&hidden_[receiver_rows_[i] * width], width, &own_hidden_[i * width]);
    }
    own_gate_.resize(receivers * width);
    apply(layer.gate_own, own_hidden_.data(), width, all, Activation::none, own_gate_);

    message_.resize(receivers * width);
    detail::MessageTask task;
    task.receiver_count = receivers;
    task.first_edge = inputs.first_edge.data();
    task.source = inputs.source.data();
    task.edges = inputs.edges.data();
    task.edge_width = edge_width;
    task.width = width;
    task.source_gate = source_gate_.data();
    task.source_value = source_value_.data();
    task.own_gate = own_gate_.data();
    task.edge_gate = layer.gate_edge.weight.data();
    task.edge_value = layer.value_edge.weight.data();
    task.mean = message_.data();
    kernel_ == Kernel::avx2 ? detail::gather_messages_avx2(task) : detail::gather_messages_scalar(task);

    renewed_.resize(receivers * width);
    apply(layer.out_message, message_.data(), width, all, Activation::none, renewed_);
    detail::DenseTask own;
    own.input = own_hidden_.data();
    own.input_stride = width;
    own.inputs = layer.out_own.inputs;
    own.row_count = receivers;
    own.weight = layer.out_own.weight.data();
    own.rectified = true;
    own.result = renewed_.data();
    own.result_stride = width;
    kernel_ == Kernel::avx2 ? detail::dense_avx2(own) : detail::dense_scalar(own);
    for (std::size_t i = 0; i < receivers; ++i) {
        std::copy_n(&renewed_[i * width], width, &hidden_[receiver_rows_[i] * width]);
    }
}

void RepairNet::move(const RepairInputs& inputs, std::vector<BelievedMotion>& motions) {
    const Rows receivers{receiver_rows_.data(), receiver_rows_.size()};
    motion_hidden_.resize(inputs.rows * motion1_.stride());
    motion_out_.resize(inputs.rows * motion2_.stride());
    apply(motion1_, hidden_.data(), encoder_.stride(), receivers, Activation::rectified, motion_hidden_);
    apply(motion2_, motion_hidden_.data(), motion1_.stride(), receivers, Activation::none, motion_out_);

    place_x_m_ = inputs.x_m;
    place_y_m_ = inputs.y_m;
    sigma_m_.assign(inputs.rows, 0.0F);
    direction_x_.assign(inputs.rows, 0.0F);
    direction_y_.assign(inputs.rows, 0.0F);
    motions.clear();
    for (const Receiver& receiver : inputs.receivers) {
        const float* const out = &motion_out_[receiver.row * motion2_.stride()];
        const float spread_m = motion_step_m + motion_share * receiver.reach_m;
        const float displacement_m =
            std::clamp(receiver.displacement_m + spread_m * out[0], 0.0F, receiver.reach_m);
        const float sigma_m = least_sigma_m + spread_m * softplus(out[1]);
        if (!std::isfinite(displacement_m) || !std::isfinite(sigma_m)) refuse_result();
        motions.push_back({displacement_m, sigma_m});
        const roads::Point place = receiver.path.place_at(displacement_m, receiver.reach_m);
        const roads::Point direction = receiver.path.direction_at(displacement_m, receiver.reach_m);
        place_x_m_[receiver.row] = place.x_m;
        place_y_m_[receiver.row] = place.y_m;
        direction_x_[receiver.row] = direction.x_m;
        direction_y_[receiver.row] = direction.y_m;
        sigma_m_[receiver.row] = sigma_m;
    }
}

void RepairNet::refuse_result() const {
    throw core::InputError(
        {source_, "its results overflow", "", "Its numbers are damaged: use another file"});
}

/// Writes the distance inputs of the decoder and returns the score.
float RepairNet::distance_facts(const RepairInputs& inputs, const RowPair& pair, float* facts) const {
    const float x_m = place_x_m_[pair.left] - place_x_m_[pair.right];
    const float y_m = place_y_m_[pair.left] - place_y_m_[pair.right];
    const float distance_m = std::sqrt(x_m * x_m + y_m * y_m + 1e-3F);
    const auto variance = [&](std::uint32_t row) {
        const float along = (direction_x_[row] * x_m + direction_y_[row] * y_m) / distance_m;
        const float place_m = inputs.place_sigma_m[row];
        return place_m * place_m + sigma_m_[row] * sigma_m_[row] * (side_share + along * along);
    };
    const float spread_m = std::sqrt(1.0F + variance(pair.left) + variance(pair.right));
    const float score = std::clamp((inputs.radius_m - distance_m) / spread_m, -6.0F, 6.0F);
    facts[0] = std::min(distance_m / 50.0F, 4.0F);
    facts[1] = 0.5F * score;
    facts[2] = 0.5F + 0.5F * std::erf(score * root_half);
    facts[3] = std::min(spread_m / 20.0F, 6.0F);
    return score;
}

void RepairNet::decode(const RepairInputs& inputs, std::vector<float>& logits) {
    const std::size_t width = decoder_width(dimensions_);
    const std::size_t embedding = dimensions_.embedding;
    logits.resize(inputs.pairs.size());
    block_.resize(block_pairs * width);
    block1_.resize(block_pairs * decoder1_.stride());
    block2_.resize(block_pairs * decoder2_.stride());
    block3_.resize(block_pairs * decoder3_.stride());
    float scores[block_pairs];
    for (std::size_t first = 0; first < inputs.pairs.size(); first += block_pairs) {
        const std::size_t count = std::min(block_pairs, inputs.pairs.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            const RowPair pair = inputs.pairs[first + i];
            const float* const left = &embeddings_[pair.left * embedding_.stride()];
            const float* const right = &embeddings_[pair.right * embedding_.stride()];
            float* const row = &block_[i * width];
            for (std::size_t at = 0; at < embedding; ++at) {
                row[at] = left[at] * right[at];
                row[embedding + at] = std::abs(left[at] - right[at]);
            }
            std::copy_n(&inputs.pair_features[(first + i) * pair_width], pair_width, row + 2 * embedding);
            scores[i] = distance_facts(inputs, pair, row + 2 * embedding + pair_width);
        }
        const Rows all{nullptr, count};
        apply(decoder1_, block_.data(), width, all, Activation::rectified, block1_);
        apply(decoder2_, block1_.data(), decoder1_.stride(), all, Activation::rectified, block2_);
        apply(decoder3_, block2_.data(), decoder2_.stride(), all, Activation::none, block3_);
        for (std::size_t i = 0; i < count; ++i) {
            logits[first + i] = block3_[i * decoder3_.stride()] + skip_ * scores[i];
        }
    }
}

}  // namespace clearway::prediction
