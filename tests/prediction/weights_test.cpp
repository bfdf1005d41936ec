#include "prediction/weights.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "prediction/nets.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::prediction {
namespace {

using ::testing::HasSubstr;

Weights small() {
    Weights weights;
    weights.architecture = "graphsage_net";
    weights.features = {"corrected", 1, 5};
    weights.dimensions = {{"input", 5}, {"hidden", 2}};
    weights.inputs = {{"node", {"x", "y"}}, {"pair", {"distance"}}};
    weights.notes = {"trained by hand; 2 lines", ""};
    weights.tensors = {{"a.weight", {2, 3}, {0.1F, -2.5e-30F, 3.0F, 1.0F / 3.0F, 5e20F, -0.0F}},
                       {"a.bias", {2}, {std::numeric_limits<float>::denorm_min(), 1.0F}}};
    return weights;
}

/// The message about a text that must be refused.
std::string refusal(const std::string& text) {
    try {
        parse_weights(text, "net.weights");
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

std::string with(const std::string& old_part, const std::string& new_part) {
    std::string text = format_weights(small());
    const std::size_t at = text.find(old_part);
    EXPECT_NE(at, std::string::npos) << old_part;
    return text.replace(at, old_part.size(), new_part);
}

TEST(Weights, ReadBackExactly) {
    const support::TemporaryFolder folder;
    const auto file = folder.path() / "net.weights";
    const Weights written = small();
    write_weights(file, written);
    const Weights read = read_weights(file);
    EXPECT_EQ(read.architecture, written.architecture);
    EXPECT_EQ(read.features, written.features);
    EXPECT_EQ(read.dimensions, written.dimensions);
    EXPECT_EQ(read.inputs, written.inputs);
    EXPECT_EQ(read.notes, written.notes);
    ASSERT_EQ(read.tensors.size(), 2u);
    for (std::size_t at = 0; at < 2; ++at) {
        EXPECT_EQ(read.tensors[at].name, written.tensors[at].name);
        EXPECT_EQ(read.tensors[at].shape, written.tensors[at].shape);
        EXPECT_EQ(read.tensors[at].values, written.tensors[at].values);
    }
    EXPECT_EQ(read.source, file.string());
    EXPECT_EQ(format_weights(read), format_weights(written));
}

TEST(Weights, NameBothVersionsOfTheFormat) {
    EXPECT_THAT(refusal(with("clearway-weights 1", "clearway-weights 2")),
                AllOf(HasSubstr("net.weights:1"), HasSubstr("version 2"), HasSubstr("version 1")));
    EXPECT_THAT(refusal("hello"), HasSubstr("not a weights file"));
    EXPECT_THAT(refusal(""), HasSubstr("not a weights file"));
}

TEST(Weights, RefuseWhatIsNotTheFormatWithItsLine) {
    EXPECT_THAT(refusal(with("0.1 ", "0.1x ")), AllOf(HasSubstr("net.weights:11"), HasSubstr("0.1x")));
    EXPECT_THAT(refusal(with("0.1 ", "nan ")), HasSubstr("'nan' is not a finite number"));
    EXPECT_THAT(refusal(with("0.1 ", "inf ")), HasSubstr("finite"));
    EXPECT_THAT(refusal(with("0.1 ", "")), HasSubstr("2 values in a row of tensor a.weight"));
    EXPECT_THAT(refusal(with("0.1 ", "0.1 7 ")), HasSubstr("4 values in a row"));
    EXPECT_THAT(refusal(with("\nend\n", "\n")), HasSubstr("no end line"));
    EXPECT_THAT(refusal(with("a.bias", "a.weight")), HasSubstr("a.weight is listed twice"));
    EXPECT_THAT(refusal(with("dimension hidden", "dimension input")), HasSubstr("input is listed twice"));
    EXPECT_THAT(refusal(with("note", "nota")), HasSubstr("'nota' is unknown"));
    EXPECT_THAT(refusal(with("a.weight 2 3", "a.weight 2 -3")), HasSubstr("'-3' is not a number"));
    EXPECT_THAT(refusal(with("a.weight 2 3", "a.weight 99999999 99999999")), HasSubstr("impossible shape"));
    EXPECT_THAT(refusal(with("a.weight 2 3", "a.weight")), HasSubstr("impossible shape"));
    std::string cut = format_weights(small());
    cut.resize(cut.find("a.bias"));
    EXPECT_THAT(refusal(cut), HasSubstr("net.weights"));
}

TEST(Weights, SayWhatAMissingFileIs) {
    EXPECT_THROW(read_weights("no/such/net.weights"), core::InputError);
}

TEST(Weights, NameBothSchemasAndArchitecturesThatDiffer) {
    const Weights weights = small();
    EXPECT_NO_THROW(weights.require("graphsage_net", {"corrected", 1, 5}));
    try {
        weights.require("other_net", {"corrected", 2, 5});
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_EQ(error.problems().size(), 2u);
        EXPECT_THAT(error.what(), AllOf(HasSubstr("graphsage_net"), HasSubstr("other_net"),
                                        HasSubstr("corrected version 1"), HasSubstr("corrected version 2")));
    }
}

TEST(Weights, NameTensorsThatAreMissingOrShapedOtherwise) {
    const Weights weights = small();
    EXPECT_EQ(weights.tensor("a.bias", {2}).values[1], 1.0F);
    EXPECT_EQ(weights.dimension("hidden"), 2u);
    EXPECT_THROW(weights.dimension("output"), core::InputError);
    EXPECT_THROW(weights.tensor("b", {2}), core::InputError);
    try {
        weights.tensor("a.weight", {3, 2});
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("2 x 3"), HasSubstr("3 x 2")));
    }
}

}  // namespace
}  // namespace clearway::prediction
