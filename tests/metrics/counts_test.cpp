#include "metrics/counts.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::metrics {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string error_of(const std::string& text) {
    const support::TemporaryFolder folder;
    try {
        read_counts(folder.write("counts.csv", text));
    } catch (const core::InputError& error) {
        return error.what();
    }
    return {};
}

TEST(Counts, AreReadByEdge) {
    const support::TemporaryFolder folder;
    const auto counts = read_counts(
        folder.write("counts.csv", "edge,vehicles_per_hour\r\nnorth,480\r\na,b,12.5\n\nsouth,0\n"));
    ASSERT_EQ(counts.size(), 3U);
    EXPECT_EQ(counts[0].edge, "north");
    EXPECT_EQ(counts[1].edge, "a,b");
    EXPECT_EQ(counts[1].vehicles_per_hour, 12.5);
    EXPECT_EQ(counts[2].vehicles_per_hour, 0.0);
}

TEST(Counts, TellEveryProblemWithFileAndLine) {
    EXPECT_THAT(
        error_of("edge,vehicles_per_hour\nnorth,many\nsouth,-1\nwest,5\nwest,6\neast\neast,inf\n,7\n"),
        AllOf(HasSubstr("counts.csv:2: \"north,many\""), HasSubstr("counts.csv:3:"),
              HasSubstr("counts.csv:5: edge west is listed twice"), HasSubstr("counts.csv:6:"),
              HasSubstr("counts.csv:7:"), HasSubstr("counts.csv:8:")));
    EXPECT_THAT(error_of("edge,count\nnorth,4\n"), HasSubstr("counts.csv:1:"));
    EXPECT_THAT(error_of(""), HasSubstr("counts.csv:1:"));
    EXPECT_THAT(error_of("edge,vehicles_per_hour\n"), HasSubstr("lists no edge"));
}

TEST(Counts, ThatAreMissingAreNamed) {
    EXPECT_THROW(read_counts("/nowhere/counts.csv"), core::InputError);
}

}  // namespace
}  // namespace clearway::metrics
