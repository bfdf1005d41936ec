#include "metrics/recorder.hpp"

#include <array>
#include <set>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::metrics {
namespace {

using core::VehicleKey;
using traffic::VehicleClass;
using traffic::VehicleKind;

/// Attributes as SUMO 1.15 writes them.
std::string trip(const std::string& id, const std::string& depart, const std::string& delay,
                 const std::string& arrival, const std::string& duration, const std::string& waiting,
                 const std::string& loss, const std::string& vaporized = "") {
    return "<tripinfo id=\"" + id + "\" depart=\"" + depart + "\" departDelay=\"" + delay + "\" arrival=\"" +
           arrival + "\" duration=\"" + duration + "\" routeLength=\"500.00\" waitingTime=\"" + waiting +
           "\" waitingCount=\"1\" timeLoss=\"" + loss + "\" vaporized=\"" + vaporized + "\"/>\n";
}

std::string tripinfos(const std::string& trips) {
    return "<tripinfos>\n" + trips + "</tripinfos>\n";
}

PlannedVehicle planned(const std::string& id, VehicleClass vehicle_class, double depart_s) {
    return {id, vehicle_class, VehicleKind::car, depart_s};
}

/// Three EVs (one still driving, one never inserted), three others (one teleported, one removed).
class RecorderAtTheEnd : public testing::Test {
  protected:
    RunEnd end(const std::string& trips) {
        RunEnd result;
        result.tripinfo_files = {folder_.write("tripinfo.xml", tripinfos(trips))};
        result.planned = {
            planned("h1", VehicleClass::human, 0.0),      planned("a1", VehicleClass::automated, 1.0),
            planned("h2", VehicleClass::human, 2.0),      planned("e1", VehicleClass::emergency, 60.0),
            planned("e2", VehicleClass::emergency, 60.0), planned("e3", VehicleClass::emergency, 70.0)};
        result.time = core::Seconds(100.0);
        result.horizon = core::Seconds(300.0);
        return result;
    }

    const std::string all_trips_ = trip("h1", "0.00", "0.00", "50.00", "50.00", "4.00", "10.00") +
                                   trip("a1", "3.00", "2.00", "43.00", "40.00", "20.00", "30.00") +
                                   trip("h2", "2.00", "0.00", "22.00", "20.00", "0.00", "2.00", "collision") +
                                   trip("e1", "61.00", "1.00", "81.00", "20.00", "2.00", "5.00") +
                                   trip("e2", "63.00", "3.00", "-1.00", "37.00", "6.00", "25.00", "end") +
                                   trip("e3", "-1", "30.00", "-1.00", "0.00", "0.00", "0.00", "end");
    support::TemporaryFolder folder_;
};

TEST_F(RecorderAtTheEnd, AveragesOverThoseThatArrivedOrWereInserted) {
    const RunMetrics metrics = Recorder().finish(end(all_trips_)).metrics;
    EXPECT_DOUBLE_EQ(*metrics.emergency_travel_time_s, 20.0);  // e1
    EXPECT_DOUBLE_EQ(*metrics.emergency_restricted_travel_time_s, (20.0 + 300.0 + 300.0) / 3.0);
    EXPECT_DOUBLE_EQ(*metrics.emergency_time_loss_s, 5.0);     // e1
    EXPECT_DOUBLE_EQ(*metrics.emergency_waiting_time_s, 4.0);  // e1, e2
    EXPECT_DOUBLE_EQ(*metrics.emergency_depart_delay_s, 2.0);  // e1, e2
    EXPECT_DOUBLE_EQ(*metrics.others_time_loss_s, 14.0);       // 10, 30, 2
    EXPECT_DOUBLE_EQ(*metrics.others_waiting_time_s, 8.0);     // 4, 20, 0
    EXPECT_DOUBLE_EQ(*metrics.waiting_time_s, 32.0 / 5.0);     // e3 has none
    EXPECT_DOUBLE_EQ(*metrics.depart_delay_s, 6.0 / 5.0);
    EXPECT_DOUBLE_EQ(*metrics.others_travel_time_s, 45.0);  // h1, a1
    EXPECT_DOUBLE_EQ(metrics.simulated_s, 100.0);
    EXPECT_DOUBLE_EQ(metrics.vehicle_km, 5 * 0.5);
}

TEST_F(RecorderAtTheEnd, AStopThatWasCommandedIsTimeLostAndWaiting) {
    Recorder recorder;
    truth::Snapshot snapshot;
    for (const double now_s : {10.0, 10.5, 11.0, 11.5}) {
        snapshot.time = core::Seconds(now_s);
        snapshot.commanded_stops.clear();
        if (now_s >= 10.5) snapshot.commanded_stops = {core::vehicle_key("a1"), core::vehicle_key("e3")};
        recorder.step(snapshot, {}, {}, {});
    }
    const RunSummary summary = recorder.finish(end(all_trips_));
    const auto row = std::ranges::find(summary.vehicles, "a1", &VehicleRow::id);
    EXPECT_DOUBLE_EQ(*row->time_loss_s, 31.5);
    EXPECT_DOUBLE_EQ(*row->waiting_time_s, 21.5);
    EXPECT_DOUBLE_EQ(*summary.metrics.others_time_loss_s, 14.5);
    EXPECT_FALSE(std::ranges::find(summary.vehicles, "e3", &VehicleRow::id)->time_loss_s) << "never entered";
}

TEST_F(RecorderAtTheEnd, CountsThoseWhoseMeansLackThem) {
    const RunMetrics metrics = Recorder().finish(end(all_trips_)).metrics;
    EXPECT_EQ(metrics.emergency_count, 3U);
    EXPECT_EQ(metrics.emergency_arrived, 1U);
    EXPECT_EQ(metrics.vehicle_count, 6U);
    EXPECT_EQ(metrics.arrived, 3U);
    EXPECT_EQ(metrics.unfinished, 1U);
    EXPECT_EQ(metrics.not_inserted, 1U);
    EXPECT_EQ(metrics.removed, 1U);
}

TEST_F(RecorderAtTheEnd, ATeleportedVehicleDidNotArriveHoweverItsTripinfoLooks) {
    Recorder recorder;
    truth::Events events;
    events.teleported = {core::vehicle_key("e1")};
    recorder.step({}, {}, events, {});
    const RunSummary summary = recorder.finish(end(all_trips_));
    EXPECT_EQ(summary.metrics.emergency_arrived, 0U);
    EXPECT_FALSE(summary.metrics.emergency_travel_time_s);
    EXPECT_EQ(summary.metrics.teleports, 1U);
    const auto row = std::ranges::find(summary.vehicles, "e1", &VehicleRow::id);
    EXPECT_EQ(row->outcome, VehicleOutcome::teleported);
    EXPECT_EQ(row->teleports, 1U);
}

TEST_F(RecorderAtTheEnd, AVehicleWithoutTripinfoWasNotInserted) {
    const RunSummary summary =
        Recorder().finish(end(trip("h1", "0.00", "0.00", "5.00", "5.00", "0.00", "0.00")));
    EXPECT_EQ(summary.metrics.not_inserted, 5U);
    EXPECT_FALSE(summary.metrics.emergency_waiting_time_s);
    EXPECT_FALSE(summary.vehicles.back().depart_s);
}

TEST_F(RecorderAtTheEnd, AVehicleMayArriveInTheFirstStep) {
    const RunSummary summary =
        Recorder().finish(end(trip("h1", "0.00", "0.00", "0.00", "0.00", "0.00", "0.00")));
    EXPECT_EQ(summary.vehicles.front().outcome, VehicleOutcome::arrived);
    EXPECT_EQ(summary.vehicles.front().arrival_s, 0.0);
}

TEST_F(RecorderAtTheEnd, CountsRequestsToVehicles) {
    RunEnd end;
    end.leases.requests = {.sent = 1,
                           .heard = 2,
                           .relayed = 3,
                           .needed = 4,
                           .useless = 5,
                           .missed = 6,
                           .messages = 7,
                           .vehicles_asked = 8};
    const RunMetrics metrics = Recorder().finish(end).metrics;
    EXPECT_THAT((std::array{metrics.requests_sent, metrics.requests_heard, metrics.requests_relayed,
                            metrics.requests_needed, metrics.requests_useless, metrics.requests_missed,
                            metrics.request_messages, metrics.vehicles_asked}),
                testing::ElementsAre(1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U));
}

TEST_F(RecorderAtTheEnd, CountsRequestsToSignalsThatWereMessagesAndThoseThatWereLeases) {
    RunEnd end;
    end.leases.requests.signal_sent = 10;
    end.leases.requests.signal_heard = 7;
    end.leases.requests.signal_messages = 20;
    end.leases.signal_requests.sent = 4;
    end.leases.signal_requests.heard = 3;
    end.leases.signal_requests.messages = 5;
    const RunMetrics before = Recorder().finish(end).metrics;
    EXPECT_EQ(before.signal_requests_sent, 14U);
    EXPECT_EQ(before.signal_requests_heard, 10U);
    EXPECT_EQ(before.signal_request_messages, 25U);
    EXPECT_FALSE(before.signal_granted_after_s);
    auto& told = end.leases.signal_requests.told;
    told[static_cast<std::size_t>(traffic::RequestStatus::granted)] = 1;
    end.leases.signal_requests.until_granted_s = 8.0;
    EXPECT_EQ(Recorder().finish(end).metrics.signal_granted_after_s, 8.0);
    told[static_cast<std::size_t>(traffic::RequestStatus::granted)] = 2;
    EXPECT_EQ(Recorder().finish(end).metrics.signal_granted_after_s, 4.0);
}

TEST_F(RecorderAtTheEnd, RefusesATripinfoThatIsCutOffUnknownOrDouble) {
    RunEnd cut = end(all_trips_);
    folder_.write("tripinfo.xml", "<tripinfos>\n" + all_trips_);
    EXPECT_THROW(Recorder().finish(cut), core::SimulatorError);
    EXPECT_THROW(Recorder().finish(end(trip("x", "0.00", "0.00", "5.00", "5.00", "0.00", "0.00"))),
                 core::SimulatorError);
    EXPECT_THROW(Recorder().finish(end(all_trips_ + all_trips_)), core::SimulatorError);
    EXPECT_THROW(Recorder().finish(end(trip("h1", "soon", "0.00", "5.00", "5.00", "0.00", "0.00"))),
                 core::SimulatorError);
    RunEnd missing = end(all_trips_);
    missing.tripinfo_files = {folder_.path() / "none.xml"};
    EXPECT_THROW(Recorder().finish(missing), core::SimulatorError);
}

TEST_F(RecorderAtTheEnd, TakesOneFilePerVehicleOfASoloRun) {
    RunEnd solo;
    solo.planned = {planned("e2", VehicleClass::emergency, 9.0), planned("e1", VehicleClass::emergency, 5.0)};
    solo.tripinfo_files = {
        folder_.write("1.xml", tripinfos(trip("e1", "5.00", "0.00", "15.00", "10.00", "0.00", "0.00"))),
        folder_.write("2.xml", tripinfos(trip("e2", "9.00", "0.00", "29.00", "20.00", "0.00", "0.00")))};
    const RunSummary summary = Recorder().finish(solo);
    EXPECT_DOUBLE_EQ(*summary.metrics.emergency_travel_time_s, 15.0);
    EXPECT_EQ(summary.vehicles.front().id, "e1");
}

TEST_F(RecorderAtTheEnd, CountsWalksAndAveragesTheTimeLostOnThoseThatEnded) {
    RunEnd end;
    end.tripinfo_files = {
        folder_.write("walks.xml",
                      "<tripinfos>"
                      "<personinfo id=\"a\"><walk arrival=\"0\" timeLoss=\"4\"/></personinfo>"
                      "<personinfo id=\"b\"><walk arrival=\"9\" timeLoss=\"6\"/></personinfo>"
                      "<personinfo id=\"c\"><walk arrival=\"-1\" timeLoss=\"0\"/></personinfo>"
                      "</tripinfos>")};
    const RunMetrics metrics = Recorder().finish(end).metrics;
    EXPECT_EQ(metrics.pedestrian_count, 3U);
    EXPECT_EQ(metrics.pedestrians_unfinished, 1U);
    EXPECT_DOUBLE_EQ(*metrics.pedestrian_time_loss_s, 5.0);
}

TEST(Recorder, CountsEventsOverAllSteps) {
    Recorder recorder;
    truth::Snapshot snapshot;
    snapshot.resize(3);
    truth::Events events;
    truth::Collision at_junction;
    at_junction.place = truth::CollisionPlace::junction;
    truth::Collision with_emergency;
    with_emergency.with_emergency_vehicle = true;
    truth::Collision with_pedestrian = with_emergency;
    with_pedestrian.victim = VehicleKey{2};
    events.collisions = {at_junction, with_emergency, with_pedestrian};
    traffic::Roster roster;
    traffic::VehicleInfo victim;
    victim.id = "victim";
    roster.add(victim);
    events.emergency_brakings.resize(4);
    recorder.step(snapshot, roster, events, {});
    recorder.step(snapshot, roster, events, {});
    const RunMetrics metrics = recorder.finish({}).metrics;
    EXPECT_EQ(metrics.pedestrian_collisions, 2U);
    EXPECT_EQ(metrics.emergency_pedestrian_collisions, 2U);
    EXPECT_EQ(metrics.collisions, 4U);
    EXPECT_EQ(metrics.junction_collisions, 2U);
    EXPECT_EQ(metrics.emergency_collisions, 2U);
    EXPECT_EQ(metrics.emergency_brakings, 8U);
    EXPECT_EQ(metrics.vehicle_steps, 6U);
}

/// Four vehicles in a row of keys 1 to 4; true links 1-2, 2-3, 3-4.
struct LinkScene {
    LinkScene() {
        snapshot.resize(4);
        for (std::uint32_t row = 0; row < 4; ++row) {
            snapshot.key[row] = VehicleKey{row + 1};
            snapshot.x_m[row] = 40.0F * static_cast<float>(row);
            snapshot.vehicle_class[row] =
                row % 2 == 0 ? traffic::VehicleClass::human : traffic::VehicleClass::automated;
        }
        links.look(snapshot);
    }
    truth::Snapshot snapshot;
    TrueLinks links{graph::LinkRules{}};
};

TEST(RecorderLinks, AreComparedByKeyWithDarkEndsApart) {
    const LinkScene scene;
    traffic::BelievedGraph belief;  // 1 and 2 fresh, 4 dark, 9 has left; 3 was never seen.
    for (const auto& [key, age_s] : {std::pair(1U, 0.0F), {2U, 0.0F}, {4U, 5.0F}, {9U, 7.0F}}) {
        traffic::BelievedVehicle vehicle;
        vehicle.key = VehicleKey{key};
        vehicle.age_s = age_s;
        belief.vehicles.push_back(vehicle);
    }
    // Links 1-2 (true), 2-4 (false, dark), 4-9 (a ghost: false, dark).
    belief.first_link = {0, 1, 3, 5, 6};
    for (const std::uint32_t neighbour : {1U, 0U, 2U, 1U, 3U, 2U})
        belief.links.push_back({neighbour, 10.0F, 1.0F});

    Recorder recorder;
    recorder.links(scene.snapshot, scene.links, belief);
    EXPECT_EQ(recorder.link_counts(), (LinkCounts{1, 2, 2}));
    EXPECT_EQ(recorder.dark_link_counts(), (LinkCounts{0, 2, 2}));  // Lost: 2-3 and 3-4, both ends of 3.
    recorder.links(scene.snapshot, scene.links, belief);
    EXPECT_EQ(recorder.link_counts(), (LinkCounts{2, 4, 4}));
    EXPECT_DOUBLE_EQ(*recorder.link_counts().f1(), 4.0 / (4.0 + 4.0 + 4.0));
    EXPECT_DOUBLE_EQ(*recorder.link_counts().precision(), 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(*recorder.link_counts().recall(), 1.0 / 3.0);
}

TEST(RecorderLinks, OlderReportsAreFreshWhereTheSensorIsLate) {
    const LinkScene scene;
    traffic::BelievedGraph belief;
    belief.first_link = {0, 0, 0, 0, 0};
    for (std::uint64_t key = 1; key <= 4; ++key) {
        traffic::BelievedVehicle vehicle;
        vehicle.key = VehicleKey{key};
        vehicle.age_s = 2.0F;
        belief.vehicles.push_back(vehicle);
    }
    Recorder strict;
    strict.links(scene.snapshot, scene.links, belief);
    EXPECT_EQ(strict.dark_link_counts().false_negative, 3U);
    Recorder late(RecorderConfig{2.01F});
    late.links(scene.snapshot, scene.links, belief);
    EXPECT_EQ(late.dark_link_counts().false_negative, 0U);
    EXPECT_EQ(late.link_counts().false_negative, 3U);
}

TEST(LinkCounts, HaveNoQualityWithoutLinks) {
    EXPECT_FALSE(LinkCounts{}.f1());
    EXPECT_FALSE(LinkCounts{}.precision());
    EXPECT_DOUBLE_EQ(*(LinkCounts{0, 0, 3}.recall()), 0.0);
}

class TraceHashOfARun : public testing::Test {
  protected:
    TraceHashOfARun() { snapshot_.resize(2); }
    std::string hash(const std::vector<traffic::Lease>& leases = {}) const {
        Recorder recorder;
        recorder.step(snapshot_, {}, {}, leases);
        return recorder.finish({}).trace_hash;
    }
    truth::Snapshot snapshot_;
};

TEST_F(TraceHashOfARun, MovesWithEveryNumberOfASnapshot) {
    const std::string before = hash();
    EXPECT_EQ(before.size(), 32U);
    EXPECT_EQ(hash(), before);
    snapshot_.speed_mps[1] = 0.001F;
    const std::string faster = hash();
    EXPECT_NE(faster, before);
    snapshot_.signals.state = {"Gr"};
    EXPECT_NE(hash(), faster);
}

TEST_F(TraceHashOfARun, MovesWithEveryColumnOfASnapshot) {
    std::set<std::string> hashes{hash()};
    const auto look = [&](auto& cell, auto value) {
        cell = value;
        EXPECT_TRUE(hashes.insert(hash()).second) << hashes.size();
    };
    look(snapshot_.time, core::Seconds(0.5));
    look(snapshot_.key[1], VehicleKey{7});
    look(snapshot_.vehicle_class[1], VehicleClass::emergency);
    look(snapshot_.x_m[1], 0.5F);
    look(snapshot_.y_m[1], 0.5F);
    look(snapshot_.heading_rad[1], 0.5F);
    look(snapshot_.speed_mps[1], 0.5F);
    look(snapshot_.acceleration_mps2[1], 0.5F);
    look(snapshot_.lane[1], core::LaneIndex{3});
    look(snapshot_.lane_position_m[1], 0.5F);
    look(snapshot_.route_edge[1], 2U);
    look(snapshot_.signals.state, std::vector<std::string>{"G", "r"});
    look(snapshot_.signals.state, std::vector<std::string>{"Gr", ""});
}

TEST_F(TraceHashOfARun, MovesWithEveryMemberOfALease) {
    std::set<std::string> hashes{hash()};
    traffic::Lease lease;
    const auto look = [&](auto& member, auto value) {
        member = value;
        EXPECT_TRUE(hashes.insert(hash({lease})).second) << hashes.size();
    };
    look(lease.target, traffic::Target{VehicleKey{1}});
    look(lease.priority, 2);
    look(lease.policy, "a policy");
    look(lease.reason, "a reason");
    look(lease.beneficiary, VehicleKey{9});
    for (const traffic::Action& action :
         {traffic::Action{traffic::ChangeLane{}}, traffic::Action{traffic::ChangeLane{1}},
          traffic::Action{traffic::HoldLane{}}, traffic::Action{traffic::PullAside{traffic::Side::right}},
          traffic::Action{traffic::PullAside{traffic::Side::left}}, traffic::Action{traffic::StopAtLine{}},
          traffic::Action{traffic::HoldGreen{{1}, {}}}, traffic::Action{traffic::HoldGreen{{1}, {1}}},
          traffic::Action{traffic::HoldGreen{{}, {1}}}, traffic::Action{traffic::AdjustGreen{{1}}},
          traffic::Action{traffic::AdjustGreen{{1, 2}}}, traffic::Action{traffic::PassRed{}},
          traffic::Action{traffic::StandBack{}}, traffic::Action{traffic::TakeRoute{{core::EdgeIndex{1}}}},
          traffic::Action{traffic::TakeRoute{{core::EdgeIndex{2}}}}})
        look(lease.action, action);
    EXPECT_NE(hash({lease}), hash({lease, lease}));
}

TEST_F(TraceHashOfARun, StaysWhereAWayIsOnlyConsidered) {
    traffic::Lease lease;
    lease.target = VehicleKey{1};
    lease.action = traffic::StandBack{{core::EdgeIndex{1}}};
    EXPECT_EQ(hash({lease}), hash());
    traffic::Lease taken = lease;
    taken.action = traffic::TakeRoute{{core::EdgeIndex{1}}};
    EXPECT_EQ(hash({lease, taken}), hash({taken}));
}

TEST_F(TraceHashOfARun, MovesWithTargetActionAndExpiryOfALease) {
    traffic::Lease lease;
    lease.target = VehicleKey{1};
    lease.action = traffic::DriveAt{core::MetresPerSecond(5.0)};
    const std::string first = hash({lease});
    EXPECT_NE(first, hash());
    lease.expiry = core::Seconds(3.0);
    const std::string later = hash({lease});
    EXPECT_NE(later, first);
    lease.action = traffic::DriveAt{core::MetresPerSecond(5.5)};
    const std::string faster = hash({lease});
    EXPECT_NE(faster, later);
    lease.target = core::SignalIndex{1};
    EXPECT_NE(hash({lease}), faster);
}

TEST_F(TraceHashOfARun, MovesWithEveryNumberOfAStretch) {
    traffic::Stretch stretch;
    std::set<std::string> hashes;
    const auto look = [&] {
        traffic::Lease lease;
        lease.target = stretch;
        hashes.insert(hash({lease}));
    };
    look();
    stretch.lane = core::LaneIndex{1};
    look();
    stretch.from_m = 1.0F;
    look();
    stretch.to_m = 2.0F;
    look();
    stretch.below_mps = 3.0F;
    look();
    stretch.addressed = traffic::Addressed::drivers;
    look();
    EXPECT_EQ(hashes.size(), 6U);
}

}  // namespace
}  // namespace clearway::metrics
