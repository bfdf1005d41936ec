#include "metrics/signal_measures.hpp"

#include <gmock/gmock.h>

namespace clearway::metrics {
namespace {

using testing::IsEmpty;
using testing::Optional;

TEST(SignalMeasures, AreThoseOfEachSignalAndOfAll) {
    const std::vector<SignalEvent> events = {
        {100.0, "J", 102, 1, "0", "a"}, {102.0, "J", 105, 1, "0", "a"}, {108.0, "J", 107, 1, "0", "a"},
        {115.0, "J", 82, 1, "0", "a"},  {118.0, "J", 104, 1, "0", "a"}, {118.0, "J", 111, 1, "0", ""},
        {124.0, "J", 150, 2, "", ""},   {160.0, "J", 150, 1, "", ""},  // the first call
        {200.0, "K", 102, 2, "4", "a"}, {200.0, "K", 105, 2, "4", "a"}, {204.0, "K", 107, 2, "4", "a"},
        {264.0, "K", 110, 2, "4", ""},  {264.0, "K", 111, 2, "4", ""},  // capped, and the vehicle is not past
        {270.0, "K", 150, 0, "", ""},   {275.0, "K", 104, 2, "4", "a"}, {300.0, "K", 102, 1, "0", "b"},
        {303.0, "K", 104, 1, "0", "b"},  // never served
    };
    const auto measures = signal_measures(events);
    ASSERT_EQ(measures.size(), 3U);
    const SignalMeasures& j = measures[0];
    EXPECT_EQ(j.signal, "J");
    EXPECT_EQ(j.calls, 1U);
    EXPECT_EQ(j.granted, 1U);
    EXPECT_EQ(j.useless_holds, 0U);
    EXPECT_THAT(j.entry_delay_s, Optional(2.0));
    EXPECT_THAT(j.time_to_service_s, Optional(8.0));
    EXPECT_THAT(j.dwell_s, Optional(10.0));
    EXPECT_THAT(j.recovery_s, Optional(42.0)) << "until it is in step, not until its program runs";
    const SignalMeasures& k = measures[1];
    EXPECT_EQ(k.calls, 2U);
    EXPECT_EQ(k.granted, 1U);
    EXPECT_EQ(k.useless_holds, 1U);
    EXPECT_EQ(k.capped, 1U);
    EXPECT_THAT(k.dwell_s, Optional(60.0));
    EXPECT_THAT(k.recovery_s, Optional(6.0));
    const SignalMeasures& all = measures[2];
    EXPECT_EQ(all.signal, "");
    EXPECT_EQ(all.calls, 3U);
    EXPECT_EQ(all.granted, 2U);
    EXPECT_EQ(all.useless_holds, 1U);
    EXPECT_EQ(all.capped, 1U);
    EXPECT_THAT(all.entry_delay_s, Optional(1.0)) << "of the two that were entered";
    EXPECT_THAT(all.time_to_service_s, Optional(6.0)) << "of the two that were granted";
    EXPECT_THAT(all.dwell_s, Optional(35.0));
    EXPECT_THAT(all.recovery_s, Optional(24.0));
}

TEST(SignalMeasures, CountAHoldThatLapsesBeforeItsVehicleComes) {
    std::vector<SignalEvent> events = {{1.0, "J", 102, 1, "0", "a"}, {1.0, "J", 105, 1, "0", "a"},
                                       {5.0, "J", 107, 1, "0", "a"}, {7.0, "J", 104, 1, "0", "a"},
                                       {7.0, "J", 111, 1, "0", ""},  {9.0, "J", 82, 1, "0", "a"}};
    const auto measures = signal_measures(events);
    EXPECT_EQ(measures[0].useless_holds, 1U);
    EXPECT_EQ(measures[0].recovery_s, std::nullopt) << "not back when the log ends";
    events.erase(events.begin() + 2);
    EXPECT_EQ(signal_measures(events)[0].useless_holds, 0U) << "its green was never shown";
    EXPECT_EQ(signal_measures(events)[0].granted, 0U);
}

TEST(SignalMeasures, TakeNoRecoveryFromAHoldThatTheNextOneFollows) {
    const std::vector<SignalEvent> events = {{0.0, "J", 102, 1, "0", "a"},  {0.0, "J", 105, 1, "0", "a"},
                                             {10.0, "J", 111, 1, "0", ""},  {12.0, "J", 102, 1, "0", "b"},
                                             {12.0, "J", 105, 1, "0", "b"}, {30.0, "J", 150, 1, "", ""},
                                             {40.0, "J", 111, 1, "0", ""},  {47.0, "J", 150, 1, "", ""}};
    const auto measures = signal_measures(events);
    EXPECT_THAT(measures[0].recovery_s, Optional(7.0));
}

TEST(SignalMeasures, OfNoEventsAreNone) {
    EXPECT_THAT(signal_measures({}), IsEmpty());
}

}  // namespace
}  // namespace clearway::metrics
