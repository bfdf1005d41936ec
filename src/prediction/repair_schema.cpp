#include "prediction/repair_schema.hpp"

namespace clearway::prediction {
namespace {

InputNames names_of(std::string_view kind, std::span<const NetInput> table) {
    InputNames names{std::string(kind), {}};
    for (const NetInput& input : table)
        names.inputs.emplace_back(input.name);
    return names;
}

}  // namespace

FeatureSchema repair_schema() {
    return {"repair", 3, node_width};
}

std::vector<InputNames> repair_input_names() {
    return {names_of("node", node_inputs), names_of("edge", edge_inputs), names_of("pair", pair_inputs)};
}

}  // namespace clearway::prediction
