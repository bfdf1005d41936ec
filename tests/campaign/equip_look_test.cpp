#include "campaign/detail/equip_look.hpp"

#include <gmock/gmock.h>

#include "campaign/equip_rounds.hpp"

namespace clearway::campaign::detail {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Two signals, numbers 4 and 8.
class EquipLook : public testing::Test {
  protected:
    EquipLook()
        : built_{{}, roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/cut_squares.net.xml"), ""},
          signals_{built_, {}, std::vector<std::string>(8), {}} {
        signals_.candidates.signals = {core::SignalIndex{3}, core::SignalIndex{7}};
        signals_.all_streets[3] = "High Street";
        signals_.all_streets[7] = "Low Road";
    }

    scenario::BuiltNetwork built_;
    Signals signals_;
};

TEST_F(EquipLook, tells_the_candidates_that_gained_most) {
    const Look look{.none = {90.0, 92.0},
                    .sets = {{}, {0}, {1}, {0, 1}},
                    .values = {{90.0, 92.0}, {88.0, 90.0}, {80.0, 82.0}, {70.0, 70.0}},
                    .replications = 2};
    const std::string words = interim_words(look, signals_);
    EXPECT_THAT(words, AllOf(HasSubstr("no ranking yet; the last complete look, 2 seeds. Gains, s"),
                             HasSubstr("  #4 High Street: 2.0"), HasSubstr("  #8 Low Road: 10.0"),
                             Not(HasSubstr("chosen so far"))));
    EXPECT_LT(words.find("#8"), words.find("#4")) << "the greatest gain first, pairs left out";
    EXPECT_THAT(interim_words({}, signals_), HasSubstr("no gain can be told yet"));
}

TEST_F(EquipLook, tells_what_those_gain_that_are_chosen) {
    const Look look{.none = {90.0, 92.0, 91.0},
                    .sets = {{1}, {1, 0}},
                    .values = {{80.0, 82.0}, {79.0, 81.0}},
                    .replications = 2};
    EXPECT_THAT(interim_words(look, signals_),
                AllOf(HasSubstr("beside those chosen so far, #8 Low Road, which gain 10.0"),
                      HasSubstr("  #4 High Street: 1.0")));
}

TEST_F(EquipLook, tells_what_was_chosen_where_fresh_seeds_are_interrupted) {
    analysis::EquipPlan plan;
    const analysis::MaybeEstimate gain = less_time({90.0, 92.0}, {80.0, 82.0});
    plan.steps.emplace_back().candidate = 1;
    plan.steps.back().gain = gain;
    plan.candidates.resize(2);
    plan.candidates[1].gain = gain;
    EXPECT_THAT(
        chosen_words(plan, signals_),
        AllOf(
            HasSubstr("the search has ended"), HasSubstr("in this order, which no gain confirms yet"),
            HasSubstr("  1) #8 Low Road: 10.0, not shown\n"),
            HasSubstr("Each alone, up to 2 seeds, too few for intervals, which need 5:\n  #8 Low Road: 10.0"),
            HasSubstr("  #4 High Street: "), HasSubstr("What the others lose, and locks, the complete")));
    plan.steps.back().gain = less_time({90.0, 92.0, 91.0, 89.0, 93.0}, {80.0, 82.5, 81.0, 79.0, 83.0});
    plan.steps.back().partner = 0;
    plan.candidates[1].gain = plan.steps.back().gain;
    EXPECT_THAT(
        chosen_words(plan, signals_),
        AllOf(
            HasSubstr("  1) #8 Low Road with #4, half of what both gain:"), HasSubstr("], shown\n"),
            HasSubstr(
                "Each alone, up to 5 seeds, with intervals for all rows together (Bonferroni):\n  #8 Low")));
    plan.steps.clear();
    EXPECT_THAT(chosen_words(plan, signals_), HasSubstr("It chose no signal."));
}

TEST(EquipLate, is_told_where_the_first_look_took_longer_than_foretold) {
    const EquipForecast forecast{.first_look = 10, .race = 10, .later = 5, .later_most = 20, .fresh = 15};
    EXPECT_THAT(late_warning(forecast, 150.0, 300.0), HasSubstr("takes about 10:00 (m:s), not 5:00"));
    EXPECT_EQ(late_warning(forecast, 80.0, 300.0), "");
    EXPECT_EQ(late_warning(forecast, 150.0, 0.0), "") << "no time was given";
    EXPECT_EQ(late_warning({.fresh = 15}, 150.0, 300.0), "") << "nothing to race";
}

}  // namespace
}  // namespace clearway::campaign::detail
