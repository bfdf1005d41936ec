// What the event log of a signal says, in a scene small enough to write it by hand.
#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "metrics/recorder.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::metrics {
namespace {

using core::LaneIndex;
using core::SignalIndex;
using testing::ElementsAre;
using testing::IsEmpty;
using traffic::Coordination;
using traffic::SignalStage;

/// Links 0 (main, phase 1), 1 (side, phase 2) and 2 (a crossing, phase 3), which all conflict. Lane 0 leads
/// to link 0 and into lane 1.
RoadLayout junction() {
    RoadLayout layout;
    layout.signals = {"J", "K"};
    layout.signal_heads = {{{1, 1, false, {1, 2}}, {2, 2, false, {0, 2}}, {3, 0, true, {0, 1}}}, {}};
    layout.signal_ways = {{LaneIndex{1}, LaneIndex::none(), SignalIndex{0}, 0}};
    layout.approach_of_lane = {RoadLayout::no_approach, RoadLayout::no_approach};
    layout.internal_lane = {0, 1};
    layout.limit_of_lane_mps = {10.0F, 10.0F};
    WatchedRoute route;
    route.vehicle = core::vehicle_key("ev");
    route.id = "ev";
    layout.routes = {route};
    return layout;
}

class SignalLog : public testing::Test {
  protected:
    SignalLog() { recorder_.watch(junction()); }

    void step(double time_s, const std::string& state, const std::vector<traffic::SignalStatus>& asked = {},
              std::uint32_t lane = 0) {
        truth::Snapshot snapshot;
        snapshot.time = core::Seconds(time_s);
        snapshot.resize(1);
        snapshot.key[0] = core::vehicle_key("ev");
        snapshot.vehicle_class[0] = traffic::VehicleClass::emergency;
        snapshot.lane[0] = LaneIndex{lane};
        snapshot.signals.state = {state, "G"};
        recorder_.step(snapshot, {}, {}, {});
        recorder_.signals(snapshot, asked);
    }
    /// Signal J with a call of the vehicle for link 0, or without one.
    static std::vector<traffic::SignalStatus> asked(SignalStage stage, std::vector<std::uint16_t> held,
                                                    bool is_called = true) {
        traffic::SignalStatus status{SignalIndex{0}, stage, std::move(held), false, Coordination::none, {}};
        if (is_called) status.calls = {{core::vehicle_key("ev"), {0}}};
        return {status};
    }
    RunSummary finish() const {
        const support::TemporaryFolder folder;
        RunEnd end;
        end.tripinfo_files = {folder.write("tripinfo.xml", "<tripinfos>\n</tripinfos>\n")};
        return recorder_.finish(end);
    }
    /// `time code parameter links vehicle`.
    std::vector<std::string> lines() const {
        std::vector<std::string> text;
        const auto events = finish().signal_events;
        for (const SignalEvent& event : events.value_or(std::vector<SignalEvent>{}))
            text.push_back(fmt::format("{} {} {} {} [{}] {}", event.time_s, event.signal, event.event,
                                       event.parameter, event.links, event.vehicle));
        return text;
    }

    Recorder recorder_;
};

TEST_F(SignalLog, IsEmptyWhileNobodyAsks) {
    step(0, "Grr");
    step(1, "yrr", {}, 1);  // past the signal
    step(2, "rGr", {}, 0);
    EXPECT_THAT(lines(), IsEmpty());
}

TEST_F(SignalLog, TellsAHoldFromItsCallToTheReturnWithTheChangeBeforeIt) {
    step(0, "rrG");
    step(1, "rGr");
    step(2, "rGr", asked(SignalStage::program, {}));
    step(3, "rGr", asked(SignalStage::transition, {0}));
    step(4, "ryr", asked(SignalStage::transition, {0}));
    step(5, "rrr", asked(SignalStage::dwell, {0}));
    step(6, "Grr", asked(SignalStage::dwell, {0}));
    step(7, "Grr", asked(SignalStage::dwell, {0}), 1);
    step(8, "Grr", asked(SignalStage::transition, {}, false), 1);
    step(9, "yrr", asked(SignalStage::program, {}, false), 1);
    step(10, "rrr", {}, 1);
    step(11, "rGr", {}, 1);
    EXPECT_THAT(lines(), ElementsAre("1 J 1 2 [1] ",      // green of the side road before the call
                                     "1 J 23 3 [2] ",     // and the end of the crossing's
                                     "2 J 102 1 [0] ev",  //
                                     "3 J 105 1 [0] ev",  //
                                     "4 J 8 2 [1] ",      //
                                     "5 J 10 2 [1] ",     //
                                     "5 J 107 1 [0] ev",  //
                                     "6 J 11 2 [1] ",     //
                                     "6 J 1 1 [0] ",      //
                                     "7 J 82 1 [0] ev",   //
                                     "8 J 104 1 [0] ev",  //
                                     "8 J 111 1 [0] ",    //
                                     "9 J 8 1 [0] ",      //
                                     "10 J 10 1 [0] ",    // the program's first state
                                     "10 J 150 0 [] "))
        << "link 0 was red before the log began, and nobody knows since when; nothing after the end";
    EXPECT_EQ(finish().metrics.signal_calls, 1U);
    EXPECT_THAT(finish().metrics.signal_entry_delay_s, testing::Optional(1.0));
    EXPECT_THAT(finish().metrics.signal_dwell_s, testing::Optional(3.0));
}

TEST_F(SignalLog, TellsTheLongestTimeAndTheReturnIntoStep) {
    step(0, "Grr");
    step(1, "Grr", asked(SignalStage::dwell, {0}));
    auto late = asked(SignalStage::dwell, {0});
    late[0].capped = true;
    late[0].coordination = Coordination::out_of_step;
    step(2, "Grr", late);
    late[0].held.clear();
    late[0].stage = SignalStage::transition;
    step(3, "Grr", late);
    late[0].capped = false;
    late[0].stage = SignalStage::program;
    step(4, "Grr", late);
    step(5, "Grr", late);
    late[0].coordination = Coordination::in_step;
    late[0].calls.clear();
    step(6, "Grr", late);
    step(7, "Grr");
    EXPECT_THAT(lines(),
                ElementsAre("1 J 102 1 [0] ev", "1 J 105 1 [0] ev", "1 J 107 1 [0] ev", "2 J 110 1 [0] ",
                            "3 J 111 1 [0] ", "5 J 150 2 [] ", "6 J 104 1 [0] ev", "7 J 150 1 [] "));
}

TEST_F(SignalLog, ThatBeginsAgainTellsOnlyWhatChangedSince) {
    step(0, "rrG");
    step(1, "rGr");
    step(2, "rGr", asked(SignalStage::program, {}));
    step(3, "rGr");
    step(4, "ryr");
    step(5, "rrr");
    step(6, "Grr", asked(SignalStage::program, {}));
    EXPECT_THAT(lines(), ElementsAre("1 J 1 2 [1] ", "1 J 23 3 [2] ", "2 J 102 1 [0] ev", "3 J 104 1 [0] ev",
                                     "3 J 150 0 [] ", "5 J 10 2 [1] ", "6 J 1 1 [0] ", "6 J 102 1 [0] ev"))
        << "the yellow in between is lost";
}

TEST_F(SignalLog, ThatBeginsAgainDoesNotRepeatItsLastMoment) {
    step(0, "rGr");
    step(1, "rGr", asked(SignalStage::program, {}));
    step(2, "ryr");
    step(3, "ryr", asked(SignalStage::program, {}));
    EXPECT_THAT(lines(), ElementsAre("1 J 102 1 [0] ev", "2 J 8 2 [1] ", "2 J 104 1 [0] ev", "2 J 150 0 [] ",
                                     "3 J 102 1 [0] ev"));
}

TEST_F(SignalLog, WritesLinksOfAPhaseThatChangeTogetherInOneRow) {
    RoadLayout layout = junction();
    layout.signal_heads[0].push_back({2, 2, false, {0}});
    recorder_.watch(layout);
    step(0, "rrrr");
    step(1, "rrrr", asked(SignalStage::program, {}));
    step(2, "GGrG", asked(SignalStage::program, {}));
    EXPECT_THAT(lines(), ElementsAre("1 J 102 1 [0] ev", "2 J 1 1 [0] ", "2 J 1 2 [1 3] "))
        << "nobody knows since when the links were red, so no clearance ends";
}

TEST_F(SignalLog, EndsTheClearanceOfRedLinksOnly) {
    step(0, "rrr");
    step(1, "Grr", asked(SignalStage::program, {}));
    step(2, "GGr", asked(SignalStage::program, {}));
    step(3, "rGr", asked(SignalStage::program, {}));
    step(4, "rGG", asked(SignalStage::program, {}));
    EXPECT_THAT(lines(), ElementsAre("1 J 1 1 [0] ", "1 J 102 1 [0] ev", "2 J 1 2 [1] ", "3 J 10 1 [0] ",
                                     "4 J 11 1 [0] ", "4 J 21 3 [2] "));
}

TEST_F(SignalLog, HasNoApproachesOfSignalsWithoutHeads) {
    RoadLayout layout = junction();
    layout.signal_heads.clear();
    recorder_.watch(layout);
    step(0, "Grr", asked(SignalStage::program, {}));
    EXPECT_THAT(lines(), ElementsAre("0 J 102 0 [0] ev"));
}

TEST_F(SignalLog, NamesACallByTheFirstOfItsLinksWithAnApproach) {
    RoadLayout layout = junction();
    layout.signal_heads[0][0].approach = 0;
    recorder_.watch(layout);
    auto calls = asked(SignalStage::program, {});
    calls[0].calls[0].links = {0, 1};
    step(0, "rrr", calls);
    EXPECT_THAT(lines(), ElementsAre("0 J 102 2 [0 1] ev"));
}

TEST_F(SignalLog, LeavesOutSignalsThatOnlyGiveTimeBack) {
    step(0, "Grr");
    step(1, "rrr", asked(SignalStage::program, {}, false));
    step(2, "rGr", asked(SignalStage::program, {}, false));
    EXPECT_THAT(lines(), IsEmpty());
}

TEST(SignalCodes, HaveTheWordsOfTheEnumerations) {
    EXPECT_EQ(name(SignalCode::call_on), "Preempt (Call) Input On");
    EXPECT_EQ(name(static_cast<SignalCode>(103)), "") << "there are no gates";
}

}  // namespace
}  // namespace clearway::metrics
