#include "roads/signal_name.hpp"

#include <gmock/gmock.h>

#include "support/crossing_scene.hpp"

namespace clearway::roads {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string problem_of(const std::string& name) {
    std::vector<core::Problem> problems;
    EXPECT_FALSE(named_signal(clearway::testing::two_crossings(), name, "here", problems));
    return problems.size() == 1 ? core::format_problem(problems.front()) : "";
}

TEST(SignalNames, AreIdsOrTheNumbersThatTablesShow) {
    std::vector<core::Problem> problems;
    const Network& network = clearway::testing::two_crossings();
    EXPECT_EQ(named_signal(network, "B", "here", problems), network.find_signal("B"));
    EXPECT_EQ(named_signal(network, "#1", "here", problems), network.find_signal("A"));
    EXPECT_EQ(named_signal(network, "#2", "here", problems), network.find_signal("B"));
    EXPECT_TRUE(problems.empty());
}

TEST(SignalNames, OutsideTheRangeAreRefusedWithIt) {
    for (const char* const name : {"#0", "#3", "#-1", "#", "#1x", "#99999999999"})
        EXPECT_THAT(problem_of(name), AllOf(HasSubstr("here"), HasSubstr(name), HasSubstr("#1 to #2")));
    EXPECT_THAT(problem_of("2"), HasSubstr("Did you mean '#2'?"));
    EXPECT_THAT(problem_of("BB"), HasSubstr("Did you mean 'B'?"));
}

}  // namespace
}  // namespace clearway::roads
