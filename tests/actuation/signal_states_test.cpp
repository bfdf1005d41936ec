#include "actuation/detail/signal_states.hpp"

#include <gtest/gtest.h>

#include "support/crossing_scene.hpp"

namespace clearway::testing {
namespace {

using actuation::detail::best_phase;
using actuation::detail::hold_state;

/// Link 0 crosses 1 and 2; 1 and 2 go together; link 3 has no way in the network.
roads::Signal small_signal() {
    roads::Signal signal;
    signal.id = "small";
    signal.links = {{{}}, {{}}, {{}}, {}};
    signal.foes = {{false, true, true, false},
                   {true, false, false, false},
                   {true, false, false, false},
                   {false, false, false, false}};
    signal.crossings.assign(4, false);
    signal.program = {{30.0, "GrrG"}, {3.0, "yrrr"}, {30.0, "rGgr"}, {3.0, "ryyr"}};
    return signal;
}

TEST(HoldState, is_green_for_the_request_and_red_for_what_crosses_it) {
    EXPECT_EQ(hold_state(small_signal(), "rGgr", {0}), "Grrr") << "crossings for pedestrians, too";
}

TEST(HoldState, leaves_green_what_does_not_conflict) {
    roads::Signal signal = small_signal();
    signal.program.clear();
    EXPECT_EQ(hold_state(signal, "rGgr", {1}), "rGgr");
    EXPECT_EQ(hold_state(signal, "rGgr", {2}), "rGGr");
}

TEST(HoldState, of_an_approach_at_the_crossing_is_protected) {
    const roads::Signal& signal = two_crossings().signal(two_crossings().find_signal("A").value());
    EXPECT_EQ(hold_state(signal, signal.program[0].state, {12, 13, 14, 15}), "GrrrGrrrrrrrGGGG")
        << "right turns that cross nobody have or keep green, the left turn has no oncoming traffic";
    EXPECT_EQ(hold_state(signal, signal.program[2].state, {12, 13, 14, 15}), "rrrrGrrrrrrrGGGG");
}

TEST(HoldState, gives_green_to_all_whom_the_best_phase_serves_beside_the_request) {
    // Links 1 and 2 go together in a phase, 0 crosses both, 4 crosses 2 alone.
    roads::Signal signal = small_signal();
    signal.links.push_back({{}});
    for (auto& row : signal.foes)
        row.push_back(false);
    signal.foes.emplace_back(5, false);
    signal.foes[2][4] = signal.foes[4][2] = true;
    signal.program = {{30.0, "GrrrG"}, {30.0, "rGGrr"}};
    EXPECT_EQ(hold_state(signal, "GrrrG", {1}), "rGGrr")
        << "2 has its green; 4, green until now, would cross it";
    EXPECT_EQ(hold_state(signal, "GrrrG", {1, 4}), "rGrrG") << "2 would cross what is asked for";
    signal.program.clear();
    EXPECT_EQ(hold_state(signal, "GrrrG", {1}), "rGrrG") << "no program is known: what is green stays";
}

TEST(HoldState, takes_letters_of_conflicting_requests_from_the_phase_that_serves_them_all) {
    roads::Signal signal = small_signal();
    signal.foes[1][2] = signal.foes[2][1] = true;
    EXPECT_EQ(hold_state(signal, "GrrG", {1, 2}), "rGgr");
    signal.program.clear();
    EXPECT_EQ(hold_state(signal, "GrrG", {1, 2}), "rGgr");
}

TEST(BestPhase, is_none_in_which_others_end) {
    roads::Signal signal = small_signal();
    signal.program = {{30.0, "Grrr"}, {3.0, "yGGr"}, {30.0, "rGGr"}, {3.0, "ryyr"}};
    EXPECT_EQ(best_phase(signal, {1, 2}), 2U);
    signal.program = {{30.0, "Grrr"}, {3.0, "yGGr"}};
    EXPECT_FALSE(best_phase(signal, {1, 2}).has_value());
}

TEST(BestPhase, serves_most_of_the_links) {
    EXPECT_EQ(best_phase(small_signal(), {1, 2}), 2U);
    EXPECT_EQ(best_phase(small_signal(), {0}), 0U);
    roads::Signal silent = small_signal();
    silent.program = {{30.0, "rrrr"}};
    EXPECT_FALSE(best_phase(silent, {0}).has_value());
}

}  // namespace
}  // namespace clearway::testing
