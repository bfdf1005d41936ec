#include "analysis/signal_audit.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"

namespace clearway::analysis {
namespace {

using metrics::SignalEvent;
using testing::HasSubstr;
using testing::IsEmpty;

/// Links 0 and 1 conflict: 4 s of yellow, 2 s of red clearance, 10 s of green. Link 2 conflicts with nobody.
std::map<std::string, SignalLimits> limits() {
    SignalLimits owed{{4.0, 4.0, 4.0}, {2.0, 2.0, {}}, {10.0, 10.0, 10.0}, {}};
    owed.foes = {{false, true, false}, {true, false, false}, {false, false, false}};
    return {{"J", owed}};
}

/// Link 0 loses green, link 1 gets it.
std::vector<SignalEvent> change(double green_s, double yellow_s, double red_s) {
    const double first_s = 100.0;
    return {{first_s, "J", 1, 1, "0", ""},
            {first_s + green_s, "J", 8, 1, "0", ""},
            {first_s + green_s + yellow_s, "J", 10, 1, "0", ""},
            {first_s + green_s + yellow_s + red_s, "J", 1, 2, "1", ""}};
}

SignalAudit audited(const std::vector<SignalEvent>& events, double step_s = 0.25) {
    return audit_signals(events, limits(), step_s);
}

TEST(SignalAudit, FindsNothingWhereAllTimesAreKept) {
    const SignalAudit audit = audited(change(10.0, 4.0, 2.0));
    EXPECT_THAT(audit.findings, IsEmpty());
    EXPECT_EQ(audit.greens, 1U);
    EXPECT_EQ(audit.yellows, 1U);
    EXPECT_EQ(audit.reds, 1U);
}

TEST(SignalAudit, TellsWhatWasTooShortWhereAndWhen) {
    const auto yellow = audited(change(10.0, 3.0, 2.0)).findings;
    ASSERT_EQ(yellow.size(), 1U);
    EXPECT_EQ(yellow[0].what, Shortfall::yellow);
    EXPECT_EQ(yellow[0].signal, "J");
    EXPECT_EQ(yellow[0].link, 0U);
    EXPECT_DOUBLE_EQ(yellow[0].ended_s, 113.0);
    EXPECT_DOUBLE_EQ(yellow[0].lasted_s, 3.0);
    EXPECT_DOUBLE_EQ(yellow[0].least_s, 4.0);
    const auto red = audited(change(10.0, 4.0, 1.75)).findings;
    ASSERT_EQ(red.size(), 1U);
    EXPECT_EQ(red[0].what, Shortfall::red_clearance);
    const auto green = audited(change(9.75, 4.0, 2.0)).findings;
    ASSERT_EQ(green.size(), 1U);
    EXPECT_EQ(green[0].what, Shortfall::green);
}

TEST(SignalAudit, OwesNoClearanceBetweenLinksThatGetGreenTogether) {
    std::vector<SignalEvent> events = change(10.0, 4.0, 1.0);
    events.back().links = "0 1";
    const SignalAudit audit = audited(events);
    EXPECT_THAT(audit.findings, IsEmpty()) << "one of them yields";
    EXPECT_EQ(audit.reds, 0U);
}

TEST(SignalAudit, OwesThoseOnFootNoClearanceWithWhomALinkIsGreenLater) {
    std::vector<SignalEvent> events{
        {100.0, "J", 21, 1, "0", ""}, {120.0, "J", 23, 1, "0", ""}, {121.0, "J", 1, 2, "1", ""}};
    EXPECT_EQ(audited(events).findings.size(), 1U) << "1 s instead of 2 s";
    events.push_back({122.0, "J", 21, 1, "0", ""});
    EXPECT_THAT(audited(events).findings, IsEmpty()) << "link 1 yields";
    events.back() = {150.0, "J", 21, 1, "0", ""};
    events.insert(events.end() - 1, {140.0, "J", 8, 2, "1", ""});
    EXPECT_EQ(audited(events).findings.size(), 1U) << "link 1 had no green any more";
}

TEST(SignalAudit, ComparesWholeStepsOfTheSimulation) {
    EXPECT_THAT(audited(change(10.0, 4.0, 2.0), 1.0).findings, IsEmpty());
    const auto of_three = [](double step_s) {
        auto owed = limits();
        owed["J"].yellow_s[0] = 3.5;
        return audit_signals(change(10.0, 3.0, 2.0), owed, step_s).findings.size();
    };
    EXPECT_EQ(of_three(1.0), 0U) << "SUMO shows a yellow of 3.5 s for 3 or 4 s when its step is 1 s";
    EXPECT_EQ(of_three(0.5), 1U);
}

TEST(SignalAudit, FindsAGreenThatEndsWithoutYellowAndAFoeThatOpensAtTheSameTime) {
    const auto at_once =
        audited({{100.0, "J", 1, 1, "0", ""}, {120.0, "J", 1, 2, "1", ""}, {120.0, "J", 10, 1, "0", ""}});
    ASSERT_EQ(at_once.findings.size(), 2U);
    EXPECT_EQ(at_once.findings[0].what, Shortfall::yellow);
    EXPECT_EQ(at_once.findings[1].what, Shortfall::red_clearance);
}

TEST(SignalAudit, LeavesAloneWhatNobodyConflictsWithAndWhatTheLogDoesNotHold) {
    auto events = change(10.0, 4.0, 2.0);
    events[3].links = "2";
    EXPECT_EQ(audited(events).reds, 0U) << "link 2 crosses nobody";
    events.erase(events.begin(), events.begin() + 2);
    EXPECT_EQ(audited(events).yellows, 0U) << "nobody knows when the yellow began";
}

TEST(SignalAudit, ForgetsWhatWasShownBeforeTheLogWasInterrupted) {
    auto events = change(10.0, 4.0, 2.0);
    events.insert(events.begin(), {100.0, "J", 102, 1, "0", "ev"});
    events.push_back({117.0, "J", 104, 1, "0", "ev"});
    events.push_back({117.0, "J", 150, 0, "", ""});
    events.push_back({119.0, "J", 10, 2, "1", ""});  // its yellow is not in the log
    events.push_back({121.0, "J", 102, 1, "0", "ev"});
    EXPECT_THAT(audited(events).findings, IsEmpty());
    events.erase(events.begin() + 5, events.begin() + 7);
    EXPECT_EQ(audited(events).findings.size(), 2U) << "without the interruption green and yellow were cut";
}

TEST(SignalAudit, RefusesALogOfAnotherNetwork) {
    const auto error_of = [](const SignalEvent& event) -> std::string {
        try {
            audited({event});
        } catch (const core::InputError& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_THAT(error_of({1.0, "K", 1, 1, "0", ""}), HasSubstr("no signal \"K\""));
    EXPECT_THAT(error_of({1.0, "J", 1, 1, "3", ""}), HasSubstr("0 to 2"));
    EXPECT_THAT(error_of({1.0, "J", 1, 1, "a", ""}), HasSubstr("\"a\""));
}

}  // namespace
}  // namespace clearway::analysis
