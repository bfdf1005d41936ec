#include "prediction/repair_net.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/detail/net_kernel.hpp"

namespace clearway::prediction {
namespace {

using detail::Activation;
using detail::Linear;
using detail::Rows;

/// Pairs that are decoded together: their inputs stay in the processor's cache.
constexpr std::size_t block_pairs = 48;
constexpr float root_half = 0.70710678F;

float softplus(float x) {
    return x > 20.0F ? x : std::log1p(std::exp(x));
}

Rows rows_in(const std::vector<std::uint32_t>& numbers) {
    return {numbers.data(), numbers.size()};
}

void require_size(const Weights& weights, const char* name, std::uint32_t wanted) {
    const std::uint32_t found = weights.dimension(name);
    if (found == wanted) return;
    throw core::InputError({weights.source, fmt::format("dimension {} is {}", name, found),
                            fmt::format("{}, as this program computes it", wanted),
                            "Train the model again with this version"});
}

}  // namespace

RepairNet::RepairNet(const Weights& weights, Kernel kernel) : source_(weights.source), kernel_(kernel) {
    weights.require(repair_architecture, repair_schema());
    require_size(weights, "edge", edge_width);
    require_size(weights, "pair", pair_width);
    weights.require_inputs(repair_input_names());
    dimensions_ = {weights.dimension("hidden"),    weights.dimension("layers"),  weights.dimension("motion"),
                   weights.dimension("embedding"), weights.dimension("decoder"), weights.dimension("last")};
    const std::uint32_t hidden = dimensions_.hidden;
    const auto linear = [&](const std::string& name, std::uint32_t inputs, std::uint32_t outputs,
                            Linear::Bias bias = Linear::Bias::own) {
        return Linear(weights, name, inputs, outputs, bias);
    };
    encoder_ = linear("encoder", std::uint32_t{node_width}, hidden);
    for (std::uint32_t number = 1; number <= dimensions_.layers; ++number) {
        const std::string layer = fmt::format("layer{}.", number);
        layers_.push_back(
            {linear(layer + "gate_own", hidden, hidden),
             linear(layer + "gate_source", hidden, hidden, Linear::Bias::zero),
             linear(layer + "gate_edge", std::uint32_t{edge_width}, hidden, Linear::Bias::none),
             linear(layer + "value_source", hidden, hidden),
             linear(layer + "value_edge", std::uint32_t{edge_width}, hidden, Linear::Bias::none),
             linear(layer + "out_message", hidden, hidden),
             linear(layer + "out_own", hidden, hidden, Linear::Bias::none)});
    }
    motion1_ = linear("motion1", hidden, dimensions_.motion);
    motion2_ = linear("motion2", dimensions_.motion, 2);
    embedding_ = linear("embedding", hidden, dimensions_.embedding);
    decoder1_ = linear("decoder1", decoder_width(dimensions_), dimensions_.decoder);
    decoder2_ = linear("decoder2", dimensions_.decoder, dimensions_.last);
    decoder3_ = linear("decoder3", dimensions_.last, 1);
    skip_ = weights.tensor("skip", {1}).values.front();
    weights.require_tensors(15 + 10 * std::size_t{dimensions_.layers});
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
    apply(kernel_, embedding_, {hidden_.data(), encoder_.stride()}, rows_in(pair_rows_), Activation::none,
          embeddings_);
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
    apply(kernel_, encoder_, {inputs.nodes.data(), node_width}, rows_in(receiver_rows_),
          Activation::rectified, hidden_);
    apply(kernel_, encoder_, {inputs.nodes.data(), node_width, common_width}, rows_in(known_rows_),
          Activation::rectified, hidden_);
}

void RepairNet::exchange(const Layer& layer, const RepairInputs& inputs) {
    const std::size_t width = encoder_.stride();
    const std::size_t receivers = receiver_rows_.size();
    const Rows sources = rows_in(source_rows_);
    const Rows all{nullptr, receivers};
    source_gate_.resize(inputs.rows * width);
    source_value_.resize(inputs.rows * width);
    apply(kernel_, layer.gate_source, {hidden_.data(), width}, sources, Activation::none, source_gate_);
    apply(kernel_, layer.value_source, {hidden_.data(), width}, sources, Activation::none, source_value_);

    own_hidden_.resize(receivers * width);
    for (std::size_t i = 0; i < receivers; ++i) {
        std::copy_n(&hidden_[receiver_rows_[i] * width], width, &own_hidden_[i * width]);
    }
    own_gate_.resize(receivers * width);
    apply(kernel_, layer.gate_own, {own_hidden_.data(), width}, all, Activation::none, own_gate_);

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
    apply(kernel_, layer.out_message, {message_.data(), width}, all, Activation::none, renewed_);
    apply(kernel_, layer.out_own, {own_hidden_.data(), width}, all, Activation::rectified, renewed_);
    for (std::size_t i = 0; i < receivers; ++i) {
        std::copy_n(&renewed_[i * width], width, &hidden_[receiver_rows_[i] * width]);
    }
}

void RepairNet::move(const RepairInputs& inputs, std::vector<BelievedMotion>& motions) {
    const Rows receivers = rows_in(receiver_rows_);
    motion_hidden_.resize(inputs.rows * motion1_.stride());
    motion_out_.resize(inputs.rows * motion2_.stride());
    apply(kernel_, motion1_, {hidden_.data(), encoder_.stride()}, receivers, Activation::rectified,
          motion_hidden_);
    apply(kernel_, motion2_, {motion_hidden_.data(), motion1_.stride()}, receivers, Activation::none,
          motion_out_);

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
        apply(kernel_, decoder1_, {block_.data(), width}, all, Activation::rectified, block1_);
        apply(kernel_, decoder2_, {block1_.data(), decoder1_.stride()}, all, Activation::rectified, block2_);
        apply(kernel_, decoder3_, {block2_.data(), decoder2_.stride()}, all, Activation::none, block3_);
        for (std::size_t i = 0; i < count; ++i) {
            logits[first + i] = block3_[i * decoder3_.stride()] + skip_ * scores[i];
        }
    }
}

}  // namespace clearway::prediction
