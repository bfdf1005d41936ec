#include "core/error.hpp"

#include <gtest/gtest.h>

namespace clearway::core {
namespace {

TEST(Problem, PrintsWhereWhatAllowedAndCure) {
    EXPECT_EQ(format_problem({"city.toml:3", "-3 is negative", "0 to 100", "Use a count"}),
              "city.toml:3: -3 is negative (allowed: 0 to 100). Use a count");
    EXPECT_EQ(format_problem({{"a\0b", 3}, "\x1b[31mc\x7f\td", "", ""}), "a\\x00b: \\x1b[31mc\\x7f\td");
    EXPECT_EQ(format_problem({"\u00e9\u009b\u00a0", "b", "", ""}), "\u00e9\\x9b\u00a0: b");
    EXPECT_EQ(format_problem({"a.py", "no B. Did you mean 'C'?", "", "correct it"}),
              "a.py: no B. Did you mean 'C'? Correct it");
    EXPECT_EQ(format_problem({"a", "is b", "", "a.csv has it"}), "a: is b. a.csv has it");
    EXPECT_EQ(format_problem({"a", "is b", "", "clearway list has it"}), "a: is b. clearway list has it");
    EXPECT_EQ(format_problem({"city.toml:3", "-3 is negative", "", ""}), "city.toml:3: -3 is negative");
    EXPECT_EQ(format_problem({"--seed", "\"x\" is no number", "a number", ""}),
              "--seed: \"x\" is no number (allowed: a number)");
}

TEST(InputError, ListsEveryProblemOnALineOfItsOwn) {
    const InputError error({{"a", "one", "", ""}, {"b", "two", "", ""}});
    EXPECT_STREQ(error.what(), "a: one\nb: two");
    EXPECT_EQ(error.problems().size(), 2u);
    EXPECT_EQ(error.problems()[1].where, "b");
    EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
    EXPECT_STREQ(InputError(Problem{"a", "one", "", ""}).what(), "a: one");
}

TEST(SimulatorError, GainsContextOnItsWayUp) {
    const SimulatorError error("cannot insert");
    EXPECT_STREQ(error.with_context("vehicle e1").with_context("time 12.5 s").what(),
                 "time 12.5 s: vehicle e1: cannot insert");
    EXPECT_EQ(error.with_context("x").exit_code(), ExitCode::runs_failed);
}

TEST(Errors, CarryTheirExitCodes) {
    EXPECT_EQ(static_cast<int>(EnvironmentError("x").exit_code()), 4);
    EXPECT_EQ(static_cast<int>(ConflictError("x").exit_code()), 7);
    EXPECT_EQ(static_cast<int>(InputError(Problem{}).exit_code()), 3);
    EXPECT_EQ(static_cast<int>(SimulatorError("x").exit_code()), 1);
}

TEST(Nearest, FindsTheWordThatWasMeant) {
    const std::vector<std::string> words = {"radius_m", "warm_up_s", "seeds"};
    EXPECT_EQ(nearest("radius_n", words), "radius_m");
    EXPECT_EQ(nearest("warmup_s", words), "warm_up_s");
    EXPECT_EQ(nearest("sedes", words), "seeds");
    EXPECT_EQ(nearest("seeds", words), "seeds");
    EXPECT_EQ(nearest("temperature", words), "");
    EXPECT_EQ(nearest("x", {}), "");
}

TEST(Nearest, LeavesHalfOfAShortWord) {
    EXPECT_EQ(nearest("on", {"ab", "off"}), "");
    EXPECT_EQ(nearest("gta", {"run", "gcn"}), "");
    EXPECT_EQ(nearest("gan", {"run", "gcn"}), "gcn");
    EXPECT_EQ(nearest("B01", {"B10", "B40"}), "B10") << "two letters exchanged";
    EXPECT_EQ(nearest("lst", {"run", "list"}), "list");
    EXPECT_EQ(nearest("x", {"y"}), "");
}

TEST(Nearest, TakesTheBeginningOfOneWordAlone) {
    EXPECT_EQ(nearest("traj", {"train", "trajectories"}), "trajectories");
    EXPECT_EQ(nearest("traj", {"trajectory_of_all", "trajectories"}), "");
    EXPECT_EQ(nearest("tr", {"figures", "trajectories"}), "");
    EXPECT_EQ(nearest("seed", {"sees", "seeds_of_all"}), "sees") << "one letter is nearer";
}

TEST(Nearest, LooksPastCapitals) {
    EXPECT_EQ(nearest("MERGE", {"city", "merge"}), "merge");
}

TEST(DidYouMean, NamesWhatContainsTheWordWhereNothingIsNear) {
    const std::vector<std::string> metrics = {"collisions", "emergency_travel_time_s",
                                              "others_travel_time_s"};
    EXPECT_EQ(did_you_mean("travel", metrics),
              "Did you mean 'emergency_travel_time_s' or 'others_travel_time_s'?");
    EXPECT_EQ(did_you_mean("tim", metrics, "no"), "no") << "three letters are in too many words";
    EXPECT_EQ(did_you_mean("ev_time", metrics), "Did you mean 'emergency_travel_time_s'?");
    EXPECT_EQ(did_you_mean("emergency_tme", metrics), "Did you mean 'emergency_travel_time_s'?");
    EXPECT_EQ(did_you_mean("travl", metrics), did_you_mean("travel", metrics)) << "but for a letter";
}

TEST(DidYouMean, PrefersThePartsOfARoadThatWasCut) {
    const std::vector<std::string> edges = {"157719692", "157719652#10", "157719652#2", "157719652#1"};
    EXPECT_EQ(did_you_mean("157719652", edges), "Did you mean '157719652#1'?");
    EXPECT_EQ(did_you_mean("15771965", edges), "Did you mean '157719692'?");
}

TEST(DidYouMean, KnowsThatSeedsAreReplicationsAndNeverTheSeed) {
    EXPECT_EQ(did_you_mean("seeds", {"seed", "replications"}), "Did you mean 'replications'?");
    EXPECT_EQ(did_you_mean("--replications", {"--seed", "--seeds"}), "Did you mean '--seeds'?");
    EXPECT_EQ(did_you_mean("--seeds", {"--seed", "--json"}, "no"), "no");
}

TEST(InputError, TellsAnEqualProblemOnce) {
    const InputError error({{"a", "one", "", ""}, {"b", "two", "", ""}, {"a", "one", "", ""}});
    EXPECT_EQ(error.problems().size(), 2U);
    EXPECT_STREQ(error.what(), "a: one\nb: two");
}

TEST(InputError, TellsTheCureOfSeveralLinesOnItsOwn) {
    EXPECT_STREQ(InputError({"a.py", "expected ':'\n    def f()\n           ^", "", "correct it"}).what(),
                 "a.py: expected ':'\n    def f()\n           ^\n  Correct it");
    EXPECT_STREQ(InputError({"a", "one line", "", "correct it"}).what(), "a: one line. Correct it");
}

TEST(InputError, TellsALongListOfWhatIsAllowedOnceForSeveralPlaces) {
    const std::string many(101, 'x');
    const auto unknown = [&](const char* where) { return Problem{where, "`B1` is unknown", many, ""}; };
    EXPECT_EQ(InputError({unknown("a"), unknown("b")}).what(),
              "a and b: `B1` is unknown (allowed: " + many + ")");
    EXPECT_EQ(InputError({unknown("a"), unknown("b"), unknown("c")}).what(),
              "a and 2 more: `B1` is unknown (allowed: " + many + ")");
    const auto negative = [](const char* where) { return Problem{where, "-1", "0 to 5", ""}; };
    EXPECT_STREQ(InputError({negative("a"), negative("b")}).what(),
                 "a: -1 (allowed: 0 to 5)\nb: -1 (allowed: 0 to 5)");
}

TEST(Nearest, PrefersTheSmallerDistanceThenTheEarlierWord) {
    EXPECT_EQ(nearest("lanes", {"lines", "lane", "lanes_m"}), "lines");
    EXPECT_EQ(nearest("lanes", {"planets", "lane"}), "lane");
}

}  // namespace
}  // namespace clearway::core
