#include "prediction/repair_schema.hpp"

#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::prediction {
namespace {

using ::testing::HasSubstr;

TEST(NetInput, scales_a_quantity_and_holds_it_within_its_bound) {
    const NetInput distance{"distance", "m", 50.0F, 3.0F, ""};
    EXPECT_EQ(distance.number(25.0F), 0.5F);
    EXPECT_EQ(distance.number(1000.0F), 3.0F);
    EXPECT_EQ(distance.number(-1000.0F), -3.0F);
    const NetInput speed{"speed", "m/s", 15.0F, unbounded, ""};
    EXPECT_EQ(speed.number(15000.0F), 1000.0F);
}

TEST(NetInputRow, writes_each_quantity_to_the_place_of_its_name) {
    std::array<float, edge_width> numbers{};
    NetInputRow row(edge_inputs, numbers);
    row.set(edge_input("distance"), 100.0F);
    row.set(edge_input("emergency"), true);
    EXPECT_EQ(numbers[3], 2.0F);
    EXPECT_EQ(numbers[17], 1.0F);
    EXPECT_EQ(numbers[0], 0.0F);
}

/// Weights that are shipped know inputs by these places; another number or order is another version.
TEST(RepairSchema, version_3_has_its_inputs_at_their_places) {
    EXPECT_EQ(repair_schema(), (FeatureSchema{"repair", 3, 62}));
    EXPECT_EQ(edge_width, 22u);
    EXPECT_EQ(pair_width, 21u);
    EXPECT_EQ(common_width, 6u);
    EXPECT_EQ(node_input("displacement"), 10u);
    EXPECT_EQ(node_input("leader"), 23u);
    EXPECT_EQ(node_input("follower"), 28u);
    EXPECT_EQ(node_input("fresh"), 44u);
    EXPECT_EQ(node_input("twin_displacement"), 46u);
    EXPECT_EQ(edge_input("detects"), 12u);
    EXPECT_EQ(pair_input("both_missing"), 3u);
    EXPECT_EQ(pair_input("twin_logit"), 14u);
}

void expect_each_input_described_once(std::span<const NetInput> table) {
    std::set<std::string_view> names;
    for (const NetInput& input : table) {
        EXPECT_TRUE(names.insert(input.name).second) << input.name;
        EXPECT_EQ(input.name.find(' '), std::string_view::npos) << "files separate names by spaces";
        EXPECT_FALSE(input.unit.empty() || input.doc.empty()) << input.name;
        EXPECT_GT(input.scale, 0.0F) << input.name;
        if (input.unit == "flag") {
            EXPECT_EQ(input.scale, 1.0F) << input.name;
        }
    }
}

TEST(RepairSchema, describes_each_input_once) {
    expect_each_input_described_once(node_inputs);
    expect_each_input_described_once(edge_inputs);
    expect_each_input_described_once(pair_inputs);
}

std::string markdown(std::span<const NetInput> table) {
    std::string text = "| input | unit | divided by | at most | what it is |\n|---|---|---|---|---|\n";
    for (const NetInput& input : table) {
        const std::string most = input.most == unbounded ? "" : fmt::format("{:g}", input.most);
        text += fmt::format("| `{}` | {} | {:g} | {} | {} |\n", input.name, input.unit, input.scale, most,
                            input.doc);
    }
    return text;
}

TEST(RepairSchema, is_what_the_model_card_lists) {
    const std::string card = core::read_file(std::string(CLEARWAY_SOURCE) + "/docs/models/graphsage.md");
    EXPECT_THAT(card, HasSubstr("\n" + markdown(node_inputs) + "\n"));
    EXPECT_THAT(card, HasSubstr("\n" + markdown(edge_inputs) + "\n"));
    EXPECT_THAT(card, HasSubstr("\n" + markdown(pair_inputs) + "\n"));
}

TEST(RepairSchema, refuses_weights_that_name_other_inputs) {
    Weights weights;
    weights.source = "net.weights";
    EXPECT_NO_THROW(weights.require_inputs(repair_input_names())) << "files without names pass";
    weights.inputs = repair_input_names();
    EXPECT_NO_THROW(weights.require_inputs(repair_input_names()));
    const auto message = [&] {
        try {
            weights.require_inputs(repair_input_names());
        } catch (const core::InputError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    std::swap(weights.inputs[0].inputs[3], weights.inputs[0].inputs[4]);
    EXPECT_THAT(message(), HasSubstr("input 4 of a node is smoothed_speed"));
    std::swap(weights.inputs[0].inputs[3], weights.inputs[0].inputs[4]);
    weights.inputs[0].inputs.pop_back();
    EXPECT_THAT(message(), HasSubstr("61 inputs of a node"));
}

}  // namespace
}  // namespace clearway::prediction
