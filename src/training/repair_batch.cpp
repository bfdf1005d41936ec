#include "training/repair_batch.hpp"

namespace clearway::training {
namespace {

using prediction::edge_width;
using prediction::node_width;
using prediction::RepairInputs;

bool is_easy(float rule_probability) {
    return rule_probability < 0.02F || rule_probability > 0.98F;
}

/// Numbers of the batch for the rows of its samples: receivers first.
std::vector<std::vector<std::int64_t>> numbers_of(std::span<const samples::RepairSample* const> samples) {
    std::vector<std::vector<std::int64_t>> numbers(samples.size());
    std::int64_t next = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        numbers[i].assign(samples[i]->inputs.rows, -1);
        for (const prediction::Receiver& receiver : samples[i]->inputs.receivers) {
            numbers[i][receiver.row] = next++;
        }
    }
    for (std::vector<std::int64_t>& of_sample : numbers) {
        for (std::int64_t& number : of_sample) {
            if (number < 0) number = next++;
        }
    }
    return numbers;
}

void place_rows(const RepairInputs& inputs, const std::vector<std::int64_t>& numbers, RepairBatch& batch) {
    for (std::size_t row = 0; row < inputs.rows; ++row) {
        const auto to = static_cast<std::size_t>(numbers[row]);
        std::copy_n(&inputs.nodes[row * node_width], node_width, &batch.nodes[to * node_width]);
        batch.x_m[to] = inputs.x_m[row];
        batch.y_m[to] = inputs.y_m[row];
        batch.place_sigma_m[to] = inputs.place_sigma_m[row];
    }
}

void append_edges(const RepairInputs& inputs, const std::vector<std::int64_t>& numbers, MessageEdges edges,
                  RepairBatch& batch) {
    for (std::size_t i = 0; i < inputs.receivers.size(); ++i) {
        for (std::uint32_t edge = inputs.first_edge[i]; edge < inputs.first_edge[i + 1]; ++edge) {
            const float* const numbers_of_edge = &inputs.edges[std::size_t{edge} * edge_width];
            if (edges == MessageEdges::observed && numbers_of_edge[prediction::edge_input("detects")] == 0.0F)
                continue;
            batch.edge_source.push_back(numbers[inputs.source[edge]]);
            batch.edge_receiver.push_back(numbers[inputs.receivers[i].row]);
            batch.edges.insert(batch.edges.end(), numbers_of_edge, numbers_of_edge + edge_width);
        }
    }
}

void append_pairs(const samples::RepairSample& sample, const std::vector<std::int64_t>& numbers,
                  const PairSampling& sampling, RepairBatch& batch) {
    const RepairInputs& inputs = sample.inputs;
    for (std::size_t at = 0; at < inputs.pairs.size(); ++at) {
        const float weight = weight_of(sample, at, sampling);
        if (weight == 0.0F) continue;
        batch.pair_left.push_back(numbers[inputs.pairs[at].left]);
        batch.pair_right.push_back(numbers[inputs.pairs[at].right]);
        const float* const features = &inputs.pair_features[at * prediction::pair_width];
        batch.pair_features.insert(batch.pair_features.end(), features, features + prediction::pair_width);
        batch.radius_m.push_back(inputs.radius_m);
        batch.label.push_back(sample.linked[at]);
        batch.weight.push_back(weight);
    }
}

}  // namespace

float weight_of(const samples::RepairSample& sample, std::size_t at, const PairSampling& sampling) {
    if (sampling.easy_share >= 1.0 || !is_easy(sample.rule[at])) return 1.0F;
    const auto moment = static_cast<std::uint64_t>(sample.time_s * 1000.0);
    const double draw = sampling.random.uniform(core::Purpose::negative_sampling, moment, at);
    return draw < sampling.easy_share ? static_cast<float>(1.0 / sampling.easy_share) : 0.0F;
}

RepairBatch batch_of(std::span<const samples::RepairSample* const> samples, MessageEdges edges,
                     const PairSampling& sampling) {
    const std::vector<std::vector<std::int64_t>> numbers = numbers_of(samples);
    RepairBatch batch;
    std::size_t rows = 0;
    for (const auto& of_sample : numbers)
        rows += of_sample.size();
    batch.nodes.resize(rows * node_width);
    batch.x_m.resize(rows);
    batch.y_m.resize(rows);
    batch.place_sigma_m.resize(rows);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const RepairInputs& inputs = samples[i]->inputs;
        place_rows(inputs, numbers[i], batch);
        for (const prediction::Receiver& receiver : inputs.receivers) {
            batch.displacement_m.push_back(receiver.displacement_m);
            batch.reach_m.push_back(receiver.reach_m);
            for (const roads::Point& point : receiver.path.points) {
                batch.path.push_back(point.x_m);
                batch.path.push_back(point.y_m);
            }
        }
        batch.true_displacement_m.insert(batch.true_displacement_m.end(),
                                         samples[i]->true_displacement_m.begin(),
                                         samples[i]->true_displacement_m.end());
        append_edges(inputs, numbers[i], edges, batch);
        append_pairs(*samples[i], numbers[i], sampling, batch);
    }
    return batch;
}

}  // namespace clearway::training
