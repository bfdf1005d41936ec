#include "prediction/tree_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prediction/repair_net.hpp"

namespace clearway::prediction {
namespace {

consteval std::size_t meeting_input(std::string_view name) {
    return input_index(meeting_inputs, name);
}
consteval std::size_t gathered_input(std::string_view name) {
    return input_index(gathered_inputs, name);
}

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

/// One end of a pair.
struct End {
    std::uint32_t row = 0;
    std::size_t receiver = none;
    std::span<const float> node;
    roads::Point place;  ///< By the kinematics along the route.
};

End end_of(const RepairInputs& inputs, std::uint32_t row) {
    End end;
    end.row = row;
    end.node = std::span(inputs.nodes).subspan(row * node_width, node_width);
    end.place = {inputs.x_m[row], inputs.y_m[row]};
    const auto found = std::ranges::lower_bound(inputs.receivers, row, {}, &Receiver::row);
    if (found == inputs.receivers.end() || found->row != row) return end;
    end.receiver = static_cast<std::size_t>(found - inputs.receivers.begin());
    end.place = found->path.place_at(found->displacement_m, found->reach_m);
    return end;
}

/// Whether `one` is the first end. Equal numbers make equal rows, whichever comes first.
bool comes_first(const End& one, const End& other) {
    if ((one.receiver == none) != (other.receiver == none)) return one.receiver != none;
    const float age = one.node[node_input("age")];
    const float other_age = other.node[node_input("age")];
    if (age != other_age) return age > other_age;
    return !std::ranges::lexicographical_compare(one.node, other.node);
}

float distance_m(roads::Point one, roads::Point other) {
    return std::hypot(one.x_m - other.x_m, one.y_m - other.y_m);
}

void write_meeting(const RepairInputs& inputs, const End& first, const End& second, std::span<float> row) {
    NetInputRow out(meeting_inputs, row);
    if (first.receiver == none) return;
    const Receiver& receiver = inputs.receivers[first.receiver];
    float nearest_m = std::numeric_limits<float>::max();
    int within = 0;
    for (const roads::Point point : receiver.path.points) {
        const float away_m = distance_m(point, second.place);
        nearest_m = std::min(nearest_m, away_m);
        if (away_m < static_cast<float>(repair_link_radius_m)) ++within;
    }
    const roads::Point along = receiver.path.direction_at(receiver.displacement_m, receiver.reach_m);
    const float x_m = second.place.x_m - first.place.x_m;
    const float y_m = second.place.y_m - first.place.y_m;
    out.set(meeting_input("nearest"), nearest_m);
    out.set(meeting_input("share_within"), static_cast<float>(within) / static_cast<float>(path_points));
    out.set(meeting_input("ahead"), along.x_m * x_m + along.y_m * y_m);
    out.set(meeting_input("left"), along.x_m * y_m - along.y_m * x_m);
}

/// Numbers of an edge in its own unit.
class Edge {
  public:
    Edge(const RepairInputs& inputs, std::size_t at) : numbers_(&inputs.edges[at * edge_width]) {}
    float operator[](std::size_t input) const { return numbers_[input] * edge_inputs[input].scale; }

  private:
    const float* numbers_;
};

void write_gathered(const RepairInputs& inputs, const End& end, std::span<float> row) {
    NetInputRow out(gathered_inputs, row);
    if (end.receiver == none) return;
    const std::size_t from = inputs.first_edge[end.receiver];
    const std::size_t to = inputs.first_edge[end.receiver + 1];
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
    return {"tree_pairs", 1, static_cast<std::uint32_t>(tree_width)};
}

std::vector<InputNames> tree_input_names() {
    InputNames pair{"pair", {}};
    append_names(pair_inputs, "", pair.inputs);
    append_names(meeting_inputs, "", pair.inputs);
    for (const char* const end : {"first_", "second_"}) {
        append_names(node_inputs, end, pair.inputs);
        append_names(gathered_inputs, end, pair.inputs);
    }
    return {pair};
}

void write_tree_inputs(const RepairInputs& inputs, std::size_t at, std::span<float> row) {
    assert(row.size() == tree_width);
    std::ranges::fill(row, 0.0F);
    End first = end_of(inputs, inputs.pairs[at].left);
    End second = end_of(inputs, inputs.pairs[at].right);
    if (!comes_first(first, second)) std::swap(first, second);

    std::ranges::copy(std::span(inputs.pair_features).subspan(at * pair_width, pair_width), row.begin());
    std::span<float> rest = row.subspan(pair_width);
    write_meeting(inputs, first, second, rest.first(meeting_inputs.size()));
    rest = rest.subspan(meeting_inputs.size());
    for (const End* const end : {&first, &second}) {
        std::ranges::copy(end->node, rest.begin());
        write_gathered(inputs, *end, rest.subspan(node_width, gathered_inputs.size()));
        rest = rest.subspan(node_width + gathered_inputs.size());
    }
}

}  // namespace clearway::prediction
