#include "prediction/tree_inputs.hpp"

#include <algorithm>

namespace clearway::prediction {
namespace {

consteval std::size_t gathered_input(std::string_view name) {
    return input_index(gathered_inputs, name);
}

/// Numbers of an edge in its own unit.
class Edge {
  public:
    Edge(const RepairInputs& inputs, std::size_t at) : numbers_(&inputs.edges[at * edge_width]) {}
    float operator[](std::size_t input) const { return numbers_[input] * edge_inputs[input].scale; }

  private:
    const float* numbers_;
};

void write_gathered(const RepairInputs& inputs, std::uint32_t end, std::span<float> row) {
    NetInputRow out(gathered_inputs, row);
    const auto found = std::ranges::lower_bound(inputs.receivers, end, {}, &Receiver::row);
    if (found == inputs.receivers.end() || found->row != end) return;
    const auto receiver = static_cast<std::size_t>(found - inputs.receivers.begin());
    const std::size_t from = inputs.first_edge[receiver];
    const std::size_t to = inputs.first_edge[receiver + 1];
    float known = 0.0F, in_lane = 0.0F, detectors = 0.0F, ranges = 0.0F;
    float speed_sum_mps = 0.0F, error_sum_m = 0.0F, farthest_m = 0.0F;
    float nearest_m = gathered_inputs[gathered_input("nearest_known")].scale *
                      gathered_inputs[gathered_input("nearest_known")].most;
    for (std::size_t at = from; at < to; ++at) {
        const Edge edge(inputs, at);
        const float away_m = edge[edge_input("distance")];
        if (edge[edge_input("detects")] != 0.0F) {
            ++detectors;
            farthest_m = std::max(farthest_m, away_m);
        }
        if (edge[edge_input("range_measured")] != 0.0F) {
            ++ranges;
            error_sum_m += edge[edge_input("range_error")];
        }
        if (edge[edge_input("known")] == 0.0F) continue;
        ++known;
        nearest_m = std::min(nearest_m, away_m);
        if (edge[edge_input("same_lane")] == 0.0F) continue;
        ++in_lane;
        speed_sum_mps += edge[edge_input("speed")];
    }
    out.set(gathered_input("sources"), static_cast<float>(to - from));
    out.set(gathered_input("known_sources"), known);
    out.set(gathered_input("nearest_known"), nearest_m);
    out.set(gathered_input("lane_speed_near"), in_lane > 0.0F ? speed_sum_mps / in_lane : -15.0F);
    out.set(gathered_input("detectors"), detectors);
    out.set(gathered_input("farthest_detector"), farthest_m);
    out.set(gathered_input("range_error"), ranges > 0.0F ? error_sum_m / ranges : 0.0F);
}

template <std::size_t Count>
void append_names(const std::array<NetInput, Count>& table, const char* before,
                  std::vector<std::string>& names) {
    for (const NetInput& input : table)
        names.push_back(before + std::string(input.name));
}

}  // namespace

FeatureSchema tree_schema() {
    return {"tree_pairs", 2, static_cast<std::uint32_t>(tree_width)};
}

std::vector<InputNames> tree_input_names() {
    InputNames pair{"pair", {}};
    append_names(pair_inputs, "", pair.inputs);
    for (const char* const end : {"first_", "second_"}) {
        append_names(node_inputs, end, pair.inputs);
        append_names(gathered_inputs, end, pair.inputs);
    }
    return {pair};
}

void write_tree_inputs(const RepairInputs& inputs, std::size_t at, std::span<float> row) {
    assert(row.size() == tree_width);
    std::ranges::fill(row, 0.0F);
    const RowPair ends = first_end_first(inputs, inputs.pairs[at]);
    std::ranges::copy(std::span(inputs.pair_features).subspan(at * pair_width, pair_width), row.begin());
    std::span<float> rest = row.subspan(pair_width);
    for (const std::uint32_t end : {ends.left, ends.right}) {
        std::ranges::copy(std::span(inputs.nodes).subspan(end * node_width, node_width), rest.begin());
        write_gathered(inputs, end, rest.subspan(node_width, gathered_inputs.size()));
        rest = rest.subspan(node_width + gathered_inputs.size());
    }
}

}  // namespace clearway::prediction
