// Where a recorder says that time was lost, in scenes small enough to count by hand.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "metrics/recorder.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::metrics {
namespace {

using core::LaneIndex;
using core::SignalIndex;
using testing::ElementsAre;
using traffic::VehicleClass;

/// Lanes 0 and 1 lead to signal 0, lane 2 is inside the junction, lane 3 leaves it. All are limited to 10
/// m/s.
RoadLayout crossing() {
    RoadLayout layout;
    layout.approaches = {{"main", SignalIndex{0}}, {"side", SignalIndex{0}}};
    layout.approach_of_lane = {0, 1, RoadLayout::no_approach, RoadLayout::no_approach};
    layout.internal_lane = {0, 0, 1, 0};
    layout.limit_of_lane_mps = {10.0F, 10.0F, 10.0F, 10.0F};
    layout.signals = {"J"};
    WatchedRoute route{core::vehicle_key("ev"),      "ev", {"in", "out"}, {0.0, 110.0}, {100.0, 200.0},
                       {0, RoadLayout::no_approach}, {}};
    route.signals = {{SignalIndex{0}, "J", {0, 1}, 100.0}};
    layout.routes = {route};
    layout.keep_journeys = true;
    layout.demand_until_s = 60.0;
    return layout;
}

class TrafficWatch : public testing::Test {
  protected:
    TrafficWatch() { watch_anew(); }

    void watch_anew(const RoadLayout& layout = crossing()) {
        recorder_ = Recorder();
        recorder_.watch(layout);
    }

    void put(const std::string& id, VehicleClass vehicle_class, std::uint32_t lane, float speed_mps,
             float position_m = 0.0F, std::uint32_t route_edge = 0) {
        rows_[core::vehicle_key(id)] = {vehicle_class, lane, speed_mps, position_m, route_edge};
    }
    /// One step with the vehicles that were put since the last one.
    void step(double time_s, const std::string& signal = "rr",
              const std::vector<traffic::Lease>& leases = {}) {
        step(time_s, std::vector{signal}, leases);
    }
    void step(double time_s, const std::vector<std::string>& signals,
              const std::vector<traffic::Lease>& leases = {}) {
        truth::Snapshot snapshot;
        snapshot.time = core::Seconds(time_s);
        snapshot.resize(rows_.size());
        std::size_t row = 0;
        for (const auto& [key, vehicle] : rows_) {
            snapshot.key[row] = key;
            snapshot.vehicle_class[row] = vehicle.vehicle_class;
            snapshot.lane[row] = LaneIndex{vehicle.lane};
            snapshot.speed_mps[row] = vehicle.speed_mps;
            snapshot.lane_position_m[row] = vehicle.position_m;
            snapshot.route_edge[row++] = vehicle.route_edge;
        }
        snapshot.signals.state = signals;
        recorder_.step(snapshot, roster_, {}, leases);
        rows_.clear();
    }
    RunSummary summary() {
        RunEnd end;
        end.tripinfo_files = {folder_.write("tripinfo.xml", "<tripinfos></tripinfos>")};
        return recorder_.finish(end);
    }
    TrafficTables tables() { return summary().traffic; }

    traffic::Roster roster_;

  private:
    struct Vehicle {
        VehicleClass vehicle_class;
        std::uint32_t lane;
        float speed_mps;
        float position_m;
        std::uint32_t route_edge;
    };
    std::map<core::VehicleKey, Vehicle> rows_;
    Recorder recorder_;
    support::TemporaryFolder folder_;
};

TEST_F(TrafficWatch, SumsLostAndStoodTimeByApproachAndClass) {
    // In steps of 0.5 s: h1 stands twice on `side`, a1 drives at half the limit on `main` and leaves, h2
    // drives faster than the limit.
    for (const double time_s : {10.0, 10.5, 11.0}) {
        put("h1", VehicleClass::human, 1, 0.0F);
        if (time_s < 11.0) put("a1", VehicleClass::automated, 0, 5.0F);
        put("h2", VehicleClass::human, 0, 12.0F);
        put("ev", VehicleClass::emergency, 0, 0.0F);
        put("gone", VehicleClass::human, 3, 0.0F);
        step(time_s);
    }
    EXPECT_THAT(tables().approaches,
                ElementsAre(ApproachRow{"main", VehicleClass::human, 1, 0.0, 0.0, 0.0},
                            ApproachRow{"main", VehicleClass::automated, 1, 0.0, 0.25, 0.0},
                            ApproachRow{"side", VehicleClass::human, 1, 1.0, 1.0, 0.0}));
}

TEST_F(TrafficWatch, DoesNotTakeWhoCreepsForStanding) {
    for (const double time_s : {10.0, 10.5}) {
        put("h1", VehicleClass::human, 1, 0.1F);
        step(time_s);
    }
    ASSERT_EQ(tables().approaches.size(), 1U);
    EXPECT_EQ(tables().approaches[0].waiting_time_s, 0.0);
    EXPECT_NEAR(tables().approaches[0].time_loss_s, 0.5 * 0.99, 1e-6);
}

TEST_F(TrafficWatch, AveragesTheQueueOfASingleApproach) {
    RoadLayout layout = crossing();
    layout.approaches.pop_back();
    layout.approach_of_lane[1] = RoadLayout::no_approach;
    watch_anew(layout);
    step(0.0);
    for (const double time_s : {1.0, 2.0}) {
        put("h1", VehicleClass::human, 0, 0.0F);
        if (time_s > 1.0) put("h2", VehicleClass::human, 0, 0.0F);
        step(time_s);
    }
    EXPECT_EQ(summary().metrics.signal_queue_vehicles, 1.5);
}

TEST_F(TrafficWatch, CountsAVehicleAgainWhenItComesBack) {
    for (int lap = 0; lap < 3; ++lap) {
        put("h1", VehicleClass::human, 0, 10.0F);
        step(lap);
        put("h1", VehicleClass::human, 2, 10.0F);
        step(lap + 0.5);
    }
    ASSERT_EQ(tables().approaches.size(), 1U);
    EXPECT_EQ(tables().approaches[0].vehicles, 3U);
}

TEST_F(TrafficWatch, TakesFlowsWhileDemandDeparts) {
    // One vehicle every 10 s until 100 s; the watch begins with one there already; demand departs until 60 s.
    for (int second = 0; second <= 100; ++second) {
        put("h" + std::to_string(second / 10), VehicleClass::human, 0, 10.0F);
        step(second);
    }
    ASSERT_EQ(tables().approaches.size(), 1U);
    EXPECT_EQ(tables().approaches[0].vehicles, 11U);
    EXPECT_DOUBLE_EQ(tables().approaches[0].flow_per_hour, 6.0 / 60.0 * 3600.0);
}

TEST_F(TrafficWatch, OfOneMomentHasNoFlow) {
    put("h1", VehicleClass::human, 0, 10.0F);
    step(5.0);
    EXPECT_THAT(tables().approaches, ElementsAre(ApproachRow{"main", VehicleClass::human, 1, 0.0, 0.0, 0.0}));
}

TEST_F(TrafficWatch, ShowsTheQueueOnTheOtherApproachesAroundAPassage) {
    // One vehicle stands on `side` all the time, a second from 20 s to 40 s; one stands on the EV's own
    // approach. The EV crosses at 20 s.
    for (double time_s = 0.0; time_s <= 60.0; time_s += 1.0) {
        put("h1", VehicleClass::human, 1, 0.0F);
        if (time_s >= 20.0 && time_s < 40.0) put("h2", VehicleClass::human, 1, 0.0F);
        put("h3", VehicleClass::human, 0, 0.0F);
        const bool before = time_s < 20.0;
        put("ev", VehicleClass::emergency, before ? 0 : 3, 5.0F, 0.0F, before ? 0 : 1);
        step(time_s);
    }
    const TrafficTables found = tables();
    ASSERT_FALSE(found.recovery.empty());
    EXPECT_EQ(found.recovery.front().offset_s, -20.0);
    EXPECT_EQ(found.recovery.back().offset_s, 40.0);
    for (const RecoveryRow& row : found.recovery) {
        EXPECT_EQ(row.passages, 1U);
        EXPECT_EQ(row.halted_vehicles, row.offset_s >= 0.0 && row.offset_s < 20.0 ? 2.0 : 1.0)
            << row.offset_s;
    }
}

TEST_F(TrafficWatch, CountsTheFirstApproachAmongTheOthers) {
    RoadLayout layout = crossing();
    layout.routes[0].approach[0] = 1;
    watch_anew(layout);
    for (int second = 0; second <= 40; ++second) {
        put("h1", VehicleClass::human, 0, 0.0F);
        put("ev", VehicleClass::emergency, second < 20 ? 1 : 3, 5.0F, 0.0F, second < 20 ? 0 : 1);
        step(second);
    }
    const TrafficTables found = tables();
    ASSERT_FALSE(found.recovery.empty());
    for (const RecoveryRow& row : found.recovery)
        EXPECT_EQ(row.halted_vehicles, 1.0) << row.offset_s;
}

TEST_F(TrafficWatch, TakesTheLastLookBeforeAPassageThatFallsBetweenTwo) {
    // Looks at 3, 8, 13 s and so on; the EV crosses at 17 s, and one vehicle stands on `side` until 12 s.
    for (int second = 3; second <= 30; ++second) {
        if (second <= 12) put("h1", VehicleClass::human, 1, 0.0F);
        put("ev", VehicleClass::emergency, second < 17 ? 0 : 3, 5.0F, 0.0F, second < 17 ? 0 : 1);
        step(second);
    }
    const TrafficTables found = tables();
    ASSERT_EQ(found.recovery.size(), 6U) << "from 7 s, which shows the look at 3 s, to 32 s";
    EXPECT_EQ(found.recovery.front().offset_s, -10.0);
    for (const RecoveryRow& row : found.recovery)
        EXPECT_EQ(row.halted_vehicles, row.offset_s <= -5.0 ? 1.0 : 0.0) << row.offset_s;
}

TEST_F(TrafficWatch, KeepsAJourneyInAsFewPlacesAsItsSpeedNeeds) {
    // 10 m/s for 9 s, halt for 5 s at the stop line, then on over the junction.
    for (int second = 0; second <= 24; ++second) {
        const float driven = 10.0F * static_cast<float>(second < 10 ? second : second < 15 ? 9 : second - 5);
        const bool inside = driven > 100.0F && driven < 110.0F;
        const bool beyond = driven >= 110.0F;
        put("ev", VehicleClass::emergency,
            beyond   ? 3
            : inside ? 2
                     : 0,
            10.0F,
            beyond   ? driven - 110.0F
            : inside ? driven - 100.0F
                     : driven,
            beyond ? 1 : 0);
        step(second, second < 12 ? "rr" : second < 14 ? "ry" : "rG");
    }
    std::vector<std::pair<double, double>> places;
    std::vector<std::string> states;
    for (const JourneyRow& row : tables().journeys) {
        EXPECT_EQ(row.vehicle, "ev");
        if (row.signal.empty()) {
            places.emplace_back(row.time_s, row.distance_m);
        } else {
            EXPECT_EQ(row.signal, "J");
            EXPECT_EQ(row.distance_m, 100.0);
            states.push_back(row.state + std::to_string(static_cast<int>(row.time_s)));
        }
    }
    EXPECT_THAT(places, ElementsAre(std::pair(0.0, 0.0), std::pair(9.0, 90.0), std::pair(14.0, 90.0),
                                    std::pair(24.0, 190.0)));
    EXPECT_THAT(states, ElementsAre("red0", "yellow12", "green14"));
}

TEST_F(TrafficWatch, KeepsAPlaceThatALineMissesByMoreThanTwoMetres) {
    const auto times = [&](const std::vector<float>& positions_m) {
        watch_anew();
        double time_s = 0.0;
        for (const float position_m : positions_m) {
            put("ev", VehicleClass::emergency, 0, 10.0F, position_m);
            step(time_s++);
        }
        std::vector<double> kept_s;
        for (const JourneyRow& row : tables().journeys)
            if (row.signal.empty()) kept_s.push_back(row.time_s);
        return kept_s;
    };
    EXPECT_THAT(times({0.0F}), ElementsAre(0.0));
    EXPECT_THAT(times({0.0F, 12.0F, 20.0F}), ElementsAre(0.0, 2.0));
    EXPECT_THAT(times({0.0F, 12.5F, 20.0F}), ElementsAre(0.0, 1.0, 2.0));
}

TEST_F(TrafficWatch, TellsHowLongAnEmergencyVehicleNeedsForEachEdge) {
    // 6 s on the first edge, 2 s across the junction behind it, which count there, 4 s on the last one.
    for (int second = 0; second <= 12; ++second) {
        put("ev", VehicleClass::emergency,
            second < 6   ? 0
            : second < 8 ? 2
                         : 3,
            10.0F, 0.0F, second < 8 ? 0 : 1);
        step(second);
    }
    EXPECT_THAT(tables().edge_times,
                ElementsAre(EdgeTimeRow{"ev", "in", 0.0, 8.0}, EdgeTimeRow{"ev", "out", 8.0, 4.0}));
}

TEST_F(TrafficWatch, LeavesOutAnEdgeThatAnEmergencyVehicleDidNotDriveToItsEnd) {
    put("ev", VehicleClass::emergency, 0, 10.0F);
    step(0.0);
    step(1.0);
    EXPECT_TRUE(tables().edge_times.empty());
}

TEST_F(TrafficWatch, LeavesOutAnEdgeBehindTheEndOfTheRoute) {
    for (int second = 0; second <= 4; ++second) {
        put("ev", VehicleClass::emergency, 3, 10.0F, 0.0F, second < 3 ? 1 : 2);
        step(second);
    }
    EXPECT_THAT(tables().edge_times, ElementsAre(EdgeTimeRow{"ev", "out", 0.0, 2.0}));
}

/// The crossing with edges 0 `in`, 1 `out` and 2 `aside`, which leads to signal K after 60 m.
RoadLayout fork() {
    RoadLayout layout = crossing();
    layout.chain.edge_ids = {"in", "out", "aside"};
    layout.approaches.push_back({"aside", SignalIndex{1}});
    layout.approach_of_lane.push_back(2);
    layout.internal_lane.push_back(0);
    layout.limit_of_lane_mps.push_back(10.0F);
    layout.signals.push_back("K");
    layout.routes[0].signals.push_back({SignalIndex{2}, "L", {0}, 310.0});
    layout.on_way = [](const RoadLayout&, const WatchedRoute& route, std::span<const core::EdgeIndex> edges) {
        EXPECT_THAT(edges, ElementsAre(core::EdgeIndex{0}, core::EdgeIndex{2}));
        WatchedRoute other{route.vehicle, route.id, {"in", "aside"}, {0.0, 110.0}, {100.0, 60.0}, {0, 2}, {}};
        other.signals = {{SignalIndex{0}, "J", {1}, 100.0}, {SignalIndex{1}, "K", {0}, 170.0, 0.0, 2}};
        return other;
    };
    return layout;
}

TEST_F(TrafficWatch, FollowsAnEmergencyVehicleOnTheWayThatItTakesInstead) {
    watch_anew(fork());
    roster_.add({.key = core::vehicle_key("ev"),
                 .id = "ev",
                 .vehicle_class = VehicleClass::emergency,
                 .route = roster_.add_route({core::EdgeIndex{0}, core::EdgeIndex{1}})});
    for (int second = 0; second <= 20; ++second) {
        if (second == 5)
            roster_.set_route(core::vehicle_key("ev"),
                              roster_.add_route({core::EdgeIndex{0}, core::EdgeIndex{2}}));
        const bool is_aside = second >= 11;
        const auto driven_m = static_cast<float>(10 * second);
        put("ev", VehicleClass::emergency, is_aside ? 4 : 0, 10.0F, is_aside ? driven_m - 110.0F : driven_m,
            is_aside ? 1 : 0);
        step(second, {"rr", second < 8 ? "r" : "G", "r"});
    }
    const TrafficTables found = tables();
    EXPECT_THAT(found.edge_times,
                ElementsAre(EdgeTimeRow{"ev", "in", 0.0, 11.0}, EdgeTimeRow{"ev", "aside", 11.0, 9.0}));
    std::vector<std::string> signals;
    for (const JourneyRow& row : found.journeys) {
        if (!row.signal.empty())
            signals.push_back(fmt::format("{} {} {} {}", row.signal, row.state, row.time_s, row.distance_m));
    }
    EXPECT_THAT(signals, ElementsAre("J red 0 100", "K red 5 170", "K green 8 170"))
        << "L is on the way that it left";
}

TEST_F(TrafficWatch, LooksFromAMinuteBeforeAPassageToFourMinutesAfter) {
    for (int second = 0; second <= 400; ++second) {
        put("ev", VehicleClass::emergency, second < 100 ? 0 : 3, 5.0F, 0.0F, second < 100 ? 0 : 1);
        step(second);
    }
    const TrafficTables found = tables();
    ASSERT_EQ(found.recovery.size(), 61U) << "every five seconds";
    EXPECT_EQ(found.recovery.front().offset_s, -60.0);
    EXPECT_EQ(found.recovery.back().offset_s, 240.0);
}

TEST_F(TrafficWatch, CountsASignalAsHeldWhileItIsAskedForGreenAndShowsIt) {
    const auto green = [](double expiry_s) {
        traffic::Lease lease;
        lease.target = SignalIndex{0};
        lease.action = traffic::HoldGreen{.links = {1}};
        lease.expiry = core::Seconds(expiry_s);
        return lease;
    };
    step(0.0, "rG", {green(4.0)});  // asked for from the first step on
    step(1.0, "rG");
    step(1.5, "Gr");  // the other link is green
    step(2.0, "yr");
    step(3.0, "rG", {green(6.0)});  // renewed, and green from here on
    traffic::Lease shorter;
    shorter.target = SignalIndex{0};
    shorter.action = traffic::AdjustGreen{};
    traffic::Lease slower;
    slower.target = core::vehicle_key("h1");
    slower.action = traffic::DriveAt{};
    step(5.0, "rG", {shorter, slower});  // no holds
    step(8.0, "rG");                     // it expired at 6 s
    step(9.0, "rG", {green(10.0)});      // a second time
    EXPECT_THAT(tables().holds, ElementsAre(SignalHoldRow{"J", 2, 5.0}));
}

TEST_F(TrafficWatch, CountsTheEdgesOfWaysThatWereConsideredBesideTheVehicleSOwn) {
    RoadLayout layout = crossing();
    layout.chain.edge_ids = {"in", "out", "aside", "round"};
    watch_anew(layout);
    const auto edges = [](std::initializer_list<std::uint32_t> numbers) {
        std::vector<core::EdgeIndex> found;
        for (const std::uint32_t number : numbers)
            found.push_back({number});
        return found;
    };
    const core::VehicleKey ev = core::vehicle_key("ev");
    roster_.add({.key = ev,
                 .id = "ev",
                 .vehicle_class = VehicleClass::emergency,
                 .route = roster_.add_route(edges({0, 1}))});
    const auto issue = [&](double time_s, traffic::Action action) {
        traffic::Lease lease;
        lease.target = ev;
        lease.action = std::move(action);
        step(time_s, "rr", {lease});
    };
    issue(0.0, traffic::StandBack{edges({0, 2, 1})});
    issue(1.0, traffic::StandBack{edges({0, 3, 2, 1})});
    issue(2.0, traffic::StandBack{});
    issue(3.0, traffic::TakeRoute{edges({0, 3})});
    roster_.set_route(ev, roster_.add_route(edges({0, 3})));
    issue(4.0, traffic::StandBack{edges({0, 3, 2})});
    EXPECT_THAT(tables().considered,
                ElementsAre(ConsideredRow{"ev", "aside", 3}, ConsideredRow{"ev", "round", 1}));
}

TEST_F(TrafficWatch, CountsAHoldThatIsRenewedWhenItExpiresOnce) {
    traffic::Lease lease;
    lease.target = SignalIndex{0};
    lease.action = traffic::HoldGreen{.links = {1}};
    for (const double time_s : {0.0, 4.0, 8.0}) {
        lease.expiry = core::Seconds(time_s + 4.0);
        step(time_s, "rG", {lease});
    }
    EXPECT_THAT(tables().holds, ElementsAre(SignalHoldRow{"J", 1, 8.0}));
}

TEST_F(TrafficWatch, OfNobodyIsEmpty) {
    step(0.0);
    EXPECT_EQ(tables(), TrafficTables{});
}

TEST(Recorder, SaysNothingOfRoadsUnlessItWatches) {
    const support::TemporaryFolder folder;
    RunEnd end;
    end.tripinfo_files = {folder.write("tripinfo.xml", "<tripinfos></tripinfos>")};
    EXPECT_EQ(Recorder().finish(end).traffic, TrafficTables{});
}

}  // namespace
}  // namespace clearway::metrics
