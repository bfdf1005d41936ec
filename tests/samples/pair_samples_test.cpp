#include "samples/pair_samples.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::samples {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

PairSampleFile two_pairs() {
    return {.origin = {.scenario = "city",
                       .failure = "B10,dark_share=0.5",
                       .features = prediction::pair_feature_schema(),
                       .study_seed = 7,
                       .replication = 3},
            .features = {{1, 2, 3, 4, 5, 6, 7, 8}, {-0.5F, 0, 0, 0, 0, 0, 0, 1e-3F}},
            .linked = {1, 0}};
}

class PairSamples : public ::testing::Test {
  protected:
    void SetUp() override { write_pair_samples(file_, two_pairs()); }

    /// The message about the file with one part of its text replaced.
    std::string refusal(const std::string& old_part, const std::string& new_part) const {
        std::string text = core::read_file(file_);
        const std::size_t at = text.find(old_part);
        EXPECT_NE(at, std::string::npos) << old_part;
        core::write_atomically(file_, text.replace(at, old_part.size(), new_part));
        try {
            read_pair_samples(file_);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "accepted";
    }

    support::TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "city.pairs.csv";
};

TEST_F(PairSamples, ReadBackAsWritten) {
    const PairSampleFile read = read_pair_samples(file_);
    EXPECT_EQ(read.features, two_pairs().features);
    EXPECT_EQ(read.linked, two_pairs().linked);
    EXPECT_EQ(read.origin, two_pairs().origin);
}

TEST_F(PairSamples, AreRefusedWithFileAndLine) {
    EXPECT_THAT(refusal("1,2,3", "1,nan,3"),
                AllOf(HasSubstr("city.pairs.csv:3"), HasSubstr("value 2: `nan`")));
}
TEST_F(PairSamples, AreRefusedWhenRagged) {
    EXPECT_THAT(refusal("7,8,1", "7,8,9,1"), AllOf(HasSubstr("city.pairs.csv:3"), HasSubstr("more than 9")));
}
TEST_F(PairSamples, AreRefusedWhenShort) {
    EXPECT_THAT(refusal("7,8,1", "7,8"), AllOf(HasSubstr("city.pairs.csv:3"), HasSubstr("fewer than 9")));
}
TEST_F(PairSamples, AreRefusedForOtherLabels) {
    EXPECT_THAT(refusal("7,8,1", "7,8,2"), HasSubstr("the label 2 is neither 0 nor 1"));
}
TEST_F(PairSamples, NameBothVersionsOfOtherFeatures) {
    EXPECT_THAT(refusal("\"feature_version\":1", "\"feature_version\":9"),
                AllOf(HasSubstr("pair_features version 9"), HasSubstr("pair_features version 1")));
}
TEST_F(PairSamples, AreRefusedForOtherColumns) {
    EXPECT_THAT(refusal("margin,", "edge,"), HasSubstr("city.pairs.csv:2"));
}
TEST_F(PairSamples, AreRefusedForAnotherKindOfFile) {
    EXPECT_THAT(refusal("# clearway pair samples 2", "# anything"), HasSubstr("city.pairs.csv:1"));
}
TEST_F(PairSamples, AreFoundByTheirEnding) {
    EXPECT_EQ(find_pair_samples(folder_.path()), std::vector{file_});
    EXPECT_THROW(find_pair_samples(folder_.path() / "none"), core::InputError);
}

}  // namespace
}  // namespace clearway::samples
