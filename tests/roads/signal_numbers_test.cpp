#include "roads/signal_numbers.hpp"

#include <gmock/gmock.h>

#include "support/crossing_scene.hpp"

namespace clearway::roads {
namespace {

using ::testing::ElementsAre;

TEST(SignalNumbers, GroupLinksWithTheSameColoursAndNumberApproaches) {
    const Network& network = clearway::testing::two_crossings();
    Signal signal = network.signal(core::SignalIndex{0});
    signal.program = {{40.0, "GGGgrrrrGGGgrrrr"}, {5.0, "yyygrrrryyygrrrr"}, {40.0, "rrrrGGGgrrrrGGGg"}};
    const SignalNumbers numbers = signal_numbers(network, signal);
    EXPECT_THAT(numbers.phase, ElementsAre(1, 1, 1, 2, 3, 3, 3, 3, 1, 1, 1, 2, 3, 3, 3, 3))
        << "left turns that stay green form a group of their own";
    EXPECT_THAT(numbers.approach, ElementsAre(1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4));
    signal.crossings[3] = true;
    signal.links[4].clear();
    const SignalNumbers with_crossing = signal_numbers(network, signal);
    EXPECT_EQ(with_crossing.approach[3], 0U);
    EXPECT_NE(with_crossing.phase[3], with_crossing.phase[11]) << "people on foot are apart";
    EXPECT_EQ(with_crossing.phase[4], 0U) << "it controls nothing";
}

TEST(SignalNumbers, OfTheControllerNemaAreTheNamesOfItsPhases) {
    const Network& network = clearway::testing::two_crossings();
    Signal signal = network.signal(core::SignalIndex{0});
    const auto phase = [](const char* name, const char* state) {
        Phase made{30.0, state};
        made.yellow_s = 4.0;
        made.name = name;
        return made;
    };
    signal.program = {phase("6", "rrrrGGGgrrrrrrrr"), phase("2", "rrrrrrrrrrrrGGGg"),
                      phase("4", "GrrrrrrrrrrrrrrG")};
    EXPECT_THAT(signal_numbers(network, signal).phase,
                ElementsAre(4, 0, 0, 0, 6, 6, 6, 6, 0, 0, 0, 0, 2, 2, 2, 2))
        << "phases 2 and 4 serve the last link";
    signal.program[0].name = "main";
    EXPECT_EQ(signal_numbers(network, signal).phase[0], 1U) << "names that are no numbers";
}

}  // namespace
}  // namespace clearway::roads
