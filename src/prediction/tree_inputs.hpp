#pragma once

#include <array>
#include <span>
#include <vector>

#include "prediction/net_input.hpp"
#include "prediction/repair_inputs.hpp"
#include "prediction/repair_schema.hpp"

namespace clearway::prediction {

// What gradient boosting is given of a candidate pair. It is made from what the improved net is given and
// nothing else, so that the two differ in the model alone.

/// Of an end: what its edges tell. Vehicles that were heard have no edges, and 0.
inline constexpr std::array gathered_inputs = {
    NetInput{"sources", "1", 1.0F, unbounded, "Vehicles near it, its leader, its follower, who detects it"},
    NetInput{"known_sources", "1", 1.0F, unbounded, "Of these, heard just now"},
    NetInput{"nearest_known", "m", 50.0F, 4.0F, "Distance of the nearest one that was heard"},
    NetInput{"lane_speed_near", "m/s", 15.0F, 4.0F, "Mean speed of those that were heard in its lane"},
    NetInput{"detectors", "1", 1.0F, unbounded, "Of these, detecting it"},
    NetInput{"farthest_detector", "m", 50.0F, 4.0F, "Distance of the farthest one that detects it"},
    NetInput{"range_error", "m", 50.0F, 3.0F, "Mean of the distances less the ranges that were measured"},
};

/// In this order: the pair, then node and gathered inputs of its first end and of its second.
inline constexpr std::size_t tree_width = pair_width + 2 * (node_width + gathered_inputs.size());

/// Name and version of all of this.
FeatureSchema tree_schema();
/// The names, for files of weights.
std::vector<InputNames> tree_input_names();

/// Writes the inputs of pair `at` into `row`, which has `tree_width` numbers. They do not depend on the order
/// of the pair.
void write_tree_inputs(const RepairInputs& inputs, std::size_t at, std::span<float> row);

}  // namespace clearway::prediction
