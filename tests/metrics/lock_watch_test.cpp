// Which vehicles count as locked, in scenes small enough to count by hand.
#include <gmock/gmock.h>

#include "metrics/recorder.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::metrics {
namespace {

using core::EdgeIndex;
using core::LaneIndex;
using core::SignalIndex;
using testing::ElementsAre;
using traffic::VehicleClass;

// Two roads cross at J, 100 m each but east with 20 m, with the lanes 1 and 4 inside:
//
//     west 0 ---- 1 ---- 2 east        south 3 ---- 4 ---- 5 north
//
// Signal 0 stands at the ends of west (link 0) and east (link 1); south has none. A crossing for pedestrians
// lies at J.
constexpr std::uint32_t west = 0, inside_we = 1, east = 2, south = 3, inside_sn = 4, north = 5, crossing = 6;

RoadLayout junction() {
    RoadLayout layout;
    layout.approach_of_lane.assign(7, RoadLayout::no_approach);
    layout.internal_lane = {0, 1, 0, 0, 1, 0, 1};
    layout.limit_of_lane_mps.assign(7, 10.0F);
    layout.signals = {"J"};
    LaneChain& chain = layout.chain;
    const auto way = [](std::uint32_t next, std::uint32_t onto, SignalIndex signal) {
        return std::vector<LaneWay>{{EdgeIndex{next}, LaneIndex{onto}, signal, 0}};
    };
    chain.ways = {way(east, inside_we, SignalIndex{0}),
                  way(east, east, SignalIndex::none()),
                  {LaneWay{EdgeIndex{north}, LaneIndex{north}, SignalIndex{0}, 1}},
                  way(north, inside_sn, SignalIndex::none()),
                  way(north, north, SignalIndex::none()),
                  {},
                  {}};
    for (std::uint32_t lane = 0; lane < 7; ++lane)
        chain.edge.push_back(EdgeIndex{lane});
    chain.length_m = {100.0F, 10.0F, 20.0F, 100.0F, 10.0F, 100.0F, 5.0F};
    chain.approach = chain.edge;
    chain.approach[inside_we] = EdgeIndex{west};
    chain.approach[inside_sn] = EdgeIndex{south};
    chain.edge_ids = {"west", ":J_0", "east", "south", ":J_1", "north", ":J_c0"};
    chain.junctions = {"J", "", "E", "J", "", "N", ""};
    chain.crossings.assign(7, {});
    chain.crossings[south] = {LaneIndex{crossing}};
    chain.foes.assign(7, {});
    chain.prior.assign(7, {});
    chain.foes[inside_we] = {LaneIndex{inside_sn}};
    chain.foes[inside_sn] = {LaneIndex{inside_we}};
    chain.prior[inside_sn] = {LaneIndex{west}};
    return layout;
}

// Edge 0 has lanes 0 and 1, edge 1 lanes 2 and 3. Lane 1 leads to lane 3, lane 0 to lane 2 and, where it fans
// out, to both. Lane 2 leads to edge 2, lane 3 at a red to edge 3.
RoadLayout street(bool fans_out) {
    RoadLayout layout;
    layout.approach_of_lane.assign(6, RoadLayout::no_approach);
    layout.internal_lane.assign(6, 0);
    layout.limit_of_lane_mps.assign(6, 10.0F);
    layout.signals = {"J"};
    LaneChain& chain = layout.chain;
    const LaneWay right{EdgeIndex{1}, LaneIndex{2}, SignalIndex::none(), 0};
    const LaneWay left{EdgeIndex{1}, LaneIndex{3}, SignalIndex::none(), 0};
    chain.ways = {{right},
                  {left},
                  {{EdgeIndex{2}, LaneIndex{4}, SignalIndex::none(), 0}},
                  {{EdgeIndex{3}, LaneIndex{5}, SignalIndex{0}, 0}},
                  {},
                  {}};
    if (fans_out) chain.ways[0].push_back(left);
    chain.edge = {EdgeIndex{0}, EdgeIndex{0}, EdgeIndex{1}, EdgeIndex{1}, EdgeIndex{2}, EdgeIndex{3}};
    chain.length_m = {100.0F, 100.0F, 20.0F, 20.0F, 100.0F, 100.0F};
    chain.approach = chain.edge;
    chain.edge_ids = {"street", "fan", "right", "left"};
    chain.junctions = {"F", "J", "R", "L"};
    chain.crossings.assign(4, {});
    chain.foes.assign(6, {});
    chain.prior.assign(6, {});
    return layout;
}

class LockWatch : public testing::Test {
  protected:
    LockWatch() { watch({}); }

    void watch(StandingReasons reasons) { recorder_.watch(junction(), std::move(reasons)); }
    void watch_street(bool fans_out) { recorder_.watch(street(fans_out), {}); }
    /// A queue to the red on the left lane of edge 1 that leaves no room for another vehicle.
    void fill_left_lane() {
        put("b1", 3, 19.0F);
        put("b2", 3, 11.5F);
    }
    /// A vehicle for the steps to come; it stands unless it has a speed.
    void put(const std::string& id, std::uint32_t lane, float position_m, float speed_mps = 0.0F,
             VehicleClass vehicle_class = VehicleClass::human) {
        rows_[core::vehicle_key(id)] = {vehicle_class, lane, position_m, speed_mps};
    }
    void drives(const std::string& id, const std::vector<EdgeIndex>& route, float length_m = 5.0F) {
        traffic::VehicleInfo info;
        info.length_m = length_m;
        info.key = core::vehicle_key(id);
        info.id = id;
        info.route = roster_.add_route(route);
        roster_.add(info);
    }
    void step(const std::string& signal) {
        truth::Snapshot snapshot;
        snapshot.time = core::Seconds(time_s_);
        time_s_ += step_s_;
        snapshot.resize(rows_.size());
        std::size_t row = 0;
        for (const auto& [key, vehicle] : rows_) {
            snapshot.key[row] = key;
            snapshot.vehicle_class[row] = vehicle.vehicle_class;
            snapshot.lane[row] = LaneIndex{vehicle.lane};
            snapshot.lane_position_m[row] = vehicle.position_m;
            snapshot.speed_mps[row++] = vehicle.speed_mps;
        }
        snapshot.signals.state = {signal};
        recorder_.step(snapshot, roster_, {}, {});
    }
    void stand(int seconds, const std::string& signal = "G") {
        for (int second = 0; second < seconds; ++second)
            step(signal);
    }
    void take_steps_of(double step_s, double first_s = 100.0) {
        step_s_ = step_s;
        time_s_ = first_s;
    }
    RunSummary finish() {
        RunEnd end;
        end.tripinfo_files = {folder_.write("tripinfo.xml", "<tripinfos></tripinfos>")};
        return recorder_.finish(end);
    }

  private:
    struct Vehicle {
        VehicleClass vehicle_class;
        std::uint32_t lane;
        float position_m;
        float speed_mps;
    };
    std::map<core::VehicleKey, Vehicle> rows_;
    double time_s_ = 100.0;
    double step_s_ = 1.0;
    traffic::Roster roster_;
    Recorder recorder_;
    support::TemporaryFolder folder_;
};

TEST_F(LockWatch, two_queues_that_block_each_other_inside_a_junction_are_one_lock) {
    // a1 stands inside the junction with nothing ahead, a2 and a3 behind it; b1 cannot cross its way.
    put("a1", inside_we, 5.0F);
    put("a2", west, 99.0F);
    put("a3", west, 91.5F, 0.0F, VehicleClass::emergency);
    put("b1", south, 99.0F);
    stand(81);
    const RunSummary summary = finish();
    // From 100 to 180 s; everybody waits for a1.
    EXPECT_THAT(summary.traffic.locks, ElementsAre(LockRow{"west", "J", 100.0, 80.0, 4, 1}));
    EXPECT_EQ(summary.metrics.locks, 1U);
    EXPECT_EQ(summary.metrics.locked_vehicles, 4U);
    EXPECT_EQ(summary.metrics.locked_emergency_vehicles, 1U);
    EXPECT_DOUBLE_EQ(summary.metrics.locked_vehicle_s, 4 * 80.0);
    EXPECT_DOUBLE_EQ(summary.metrics.longest_lock_s, 80.0);
}

TEST_F(LockWatch, a_ring_is_one_lock) {
    // Each stands across the way of the other.
    put("a1", inside_we, 5.0F);
    put("b1", inside_sn, 5.0F);
    stand(81);
    EXPECT_EQ(finish().metrics.locked_vehicles, 2U);
    EXPECT_EQ(finish().metrics.locks, 1U);
}

TEST_F(LockWatch, one_that_waits_for_a_gap_in_a_stream_is_not_locked) {
    put("b1", south, 99.0F);
    put("stream", west, 0.0F, 8.0F);
    stand(200);
    put("stream", inside_we, 5.0F, 8.0F);
    stand(200);
    EXPECT_EQ(finish().metrics.locks, 0U);
    put("stream", east, 5.0F, 8.0F);
    stand(62);
    EXPECT_EQ(finish().metrics.locked_vehicles, 1U);
}

TEST_F(LockWatch, one_waits_for_a_vehicle_with_the_right_of_way_that_stands_at_its_line) {
    put("b1", south, 99.0F);
    put("a1", west, 95.0F);
    stand(100, "r");
    EXPECT_EQ(finish().metrics.locks, 0U);
    put("a1", west, 94.0F);
    stand(62, "r");
    EXPECT_EQ(finish().metrics.locked_vehicles, 1U);
}

TEST_F(LockWatch, one_whose_way_a_queue_to_a_red_blocks_is_not_locked) {
    put("a1", east, 19.0F);
    put("a2", east, 11.5F);
    put("a3", east, 4.0F);
    put("a4", inside_we, 9.0F);
    put("b1", south, 99.0F);
    stand(100, "Gr");
    EXPECT_EQ(finish().metrics.locks, 0U);
}

TEST_F(LockWatch, sixty_seconds_are_no_lock_yet) {
    put("a1", inside_we, 5.0F);
    stand(61);
    EXPECT_EQ(finish().metrics.locks, 0U);
}

TEST_F(LockWatch, a_vehicle_that_moves_up_starts_anew) {
    put("a1", inside_we, 5.0F);
    stand(50);
    put("a1", inside_we, 6.0F);
    stand(50);
    EXPECT_EQ(finish().metrics.locks, 0U);
}

TEST_F(LockWatch, a_vehicle_that_creeps_is_looked_at_once_a_second_whatever_the_step) {
    // 0.08 m a half second are 0.16 m a second: more than one that stands may drift.
    take_steps_of(0.5);
    for (int step = 0; step < 200; ++step) {
        put("a1", inside_we, 1.0F + 0.08F * static_cast<float>(step % 100));
        stand(1);
    }
    EXPECT_EQ(finish().metrics.locks, 0U);
    for (int step = 0; step < 200; ++step) {
        put("a1", inside_we, 1.0F + 0.04F * static_cast<float>(step));
        stand(1);
    }
    EXPECT_EQ(finish().metrics.locks, 1U);
}

TEST_F(LockWatch, looks_are_a_second_apart_from_the_first_moment_on) {
    take_steps_of(0.5, 0.0);
    put("a1", inside_we, 5.0F, 3.0F);
    stand(1);
    put("a1", inside_we, 5.0F);  // from 0.5 s on, which the look at 1 s sees
    stand(140);
    EXPECT_THAT(finish().traffic.locks, ElementsAre(LockRow{"west", "J", 1.0, 69.0, 1, 0}));
}

TEST_F(LockWatch, red_and_the_queue_before_it_are_no_lock) {
    put("a1", west, 99.0F);
    put("a2", west, 91.5F);
    stand(200, "r");
    stand(60, "G");  // Green, and it does not drive: the 60 s begin here.
    EXPECT_EQ(finish().metrics.locks, 0U);
    stand(2, "G");
    EXPECT_EQ(finish().metrics.locked_vehicles, 2U);
}

TEST_F(LockWatch, a_queue_through_a_junction_that_ends_at_a_red_is_no_lock) {
    put("a1", east, 19.0F);
    put("a2", east, 11.5F);
    put("a3", east, 4.0F);
    put("a4", inside_we, 9.0F);
    put("a5", west, 99.0F);
    stand(100, "Gr");
    EXPECT_EQ(finish().metrics.locks, 0U);
}

TEST_F(LockWatch, one_that_keeps_a_junction_clear_stands_in_the_queue_beyond) {
    put("a1", east, 19.0F);
    put("a2", east, 11.5F);  // Leaves 6.5 m: no room for another.
    put("a3", west, 99.0F);
    stand(200, "Gr");
    EXPECT_EQ(finish().metrics.locks, 0U);
}

TEST_F(LockWatch, one_behind_a_tram_that_reaches_back_over_the_junction_stands_in_its_queue) {
    put("a1", east, 19.0F);
    put("tram", east, 11.5F);
    put("a3", west, 84.0F);
    drives("tram", {EdgeIndex{east}}, 35.0F);
    drives("a3", {EdgeIndex{west}, EdgeIndex{east}});
    stand(200, "Gr");
    EXPECT_EQ(finish().metrics.locks, 0U);
    put("tram", east, 11.5F, 1.0F);
    put("a1", east, 19.0F, 1.0F);
    put("a3", west, 60.0F);
    stand(100, "Gr");
    EXPECT_EQ(finish().metrics.locks, 1U) << "farther behind than a queue";
}

TEST_F(LockWatch, a_red_beyond_free_road_explains_nothing) {
    put("a1", west, 99.0F);
    stand(200, "Gr");
    EXPECT_EQ(finish().metrics.locks, 1U);
}

TEST_F(LockWatch, a_red_is_too_far_where_a_vehicle_and_a_gap_just_fit_before_it) {
    put("a1", west, 99.0F);
    drives("a1", {EdgeIndex{west}, EdgeIndex{east}, EdgeIndex{north}}, 10.0F);
    stand(100, "Gr");
    EXPECT_EQ(finish().metrics.locks, 1U);
}

TEST_F(LockWatch, vehicles_that_end_their_routes_wait_for_nobody_ahead) {
    watch_street(false);
    drives("a1", {EdgeIndex{1}});
    put("a1", 3, 19.0F);  // at a red that it does not pass
    drives("a2", {EdgeIndex{3}});
    put("a2", 5, 99.0F);
    stand(100, "r");
    EXPECT_EQ(finish().metrics.locked_vehicles, 2U);
}

TEST_F(LockWatch, a_queue_behind_a_moving_vehicle_is_no_lock) {
    put("a1", east, 4.0F, 1.0F);
    put("a2", inside_we, 8.0F);
    put("a3", west, 99.0F);
    stand(100);
    EXPECT_EQ(finish().metrics.locks, 0U);
}

TEST_F(LockWatch, ten_metres_are_the_longest_gap_in_a_queue) {
    put("a1", west, 60.0F, 1.0F);
    put("a2", west, 45.0F);
    stand(100);
    EXPECT_EQ(finish().metrics.locks, 0U);
    put("a2", west, 44.0F);
    stand(62);
    EXPECT_EQ(finish().metrics.locked_vehicles, 1U);
}

TEST_F(LockWatch, a_vehicle_far_ahead_explains_nothing) {
    put("b1", north, 60.0F, 1.0F);
    put("b2", inside_sn, 8.0F);
    stand(100);
    EXPECT_EQ(finish().metrics.locked_vehicles, 1U);
}

TEST_F(LockWatch, a_vehicle_at_a_stop_and_those_behind_it_are_no_lock) {
    watch({.at_stop = [](core::VehicleKey vehicle) { return vehicle == core::vehicle_key("bus"); },
           .pedestrian_on = {}});
    put("bus", west, 99.0F);
    put("a2", west, 91.5F);
    stand(200);
    EXPECT_EQ(finish().metrics.locks, 0U);
}

TEST_F(LockWatch, a_bus_at_its_stop_in_a_locked_queue_is_not_locked) {
    watch({.at_stop = [](core::VehicleKey vehicle) { return vehicle == core::vehicle_key("bus"); },
           .pedestrian_on = {}});
    put("a1", inside_we, 5.0F);
    put("bus", west, 99.0F);
    put("a3", west, 91.5F);
    stand(81);
    EXPECT_EQ(finish().metrics.locked_vehicles, 2U);
}

TEST_F(LockWatch, pedestrians_hold_the_vehicles_before_their_crossing) {
    bool walks = true;
    watch({.at_stop = {}, .pedestrian_on = [&](LaneIndex lane) { return walks && lane.value == crossing; }});
    put("b1", south, 99.0F);  // At the crossing of its junction.
    put("b2", south, 91.5F);
    stand(200);
    EXPECT_EQ(finish().metrics.locks, 0U);
    walks = false;
    stand(62);
    EXPECT_EQ(finish().metrics.locked_vehicles, 2U);
}

TEST_F(LockWatch, a_lock_that_dissolves_and_comes_back_later_counts_twice) {
    put("a1", inside_we, 5.0F);
    stand(70);
    put("a1", inside_we, 5.0F, 3.0F);
    stand(120);
    put("a1", inside_we, 5.0F);
    stand(70);
    const RunSummary summary = finish();
    EXPECT_THAT(summary.traffic.locks, ElementsAre(LockRow{"west", "J", 100.0, 69.0, 1, 0},
                                                   LockRow{"west", "J", 290.0, 69.0, 1, 0}));
    EXPECT_EQ(summary.metrics.locked_vehicles, 1U);
}

TEST_F(LockWatch, a_lock_lasts_over_a_minute_without_a_locked_vehicle) {
    // a1 is locked until second 69; b1, behind it, is locked 61 s after it came.
    for (const auto& [came_s, locks] : {std::pair(68, 1U), std::pair(69, 2U)}) {
        watch({});
        put("a1", inside_we, 5.0F);
        put("b1", south, 50.0F, 3.0F);
        stand(came_s);
        put("b1", south, 50.0F);
        stand(70 - came_s);
        put("a1", east, 10.0F, 3.0F);
        stand(62);
        EXPECT_EQ(finish().metrics.locks, locks);
    }
}

const std::vector<EdgeIndex> to_the_left = {EdgeIndex{0}, EdgeIndex{1}, EdgeIndex{3}};
const std::vector<EdgeIndex> to_the_right = {EdgeIndex{0}, EdgeIndex{1}, EdgeIndex{2}};

TEST_F(LockWatch, where_a_lane_fans_out_a_vehicle_waits_for_the_one_that_leads_to_its_way) {
    for (const auto& [route, locked] : {std::pair(to_the_left, 0U), std::pair(to_the_right, 1U)}) {
        watch_street(true);
        drives("a1", route);
        put("a1", 0, 99.0F);
        fill_left_lane();
        stand(100, "r");
        EXPECT_EQ(finish().metrics.locks, locked);
    }
}

TEST_F(LockWatch, of_lanes_that_end_the_route_a_vehicle_waits_for_the_fullest) {
    watch_street(true);
    drives("a1", {EdgeIndex{0}, EdgeIndex{1}});
    put("a1", 0, 99.0F);
    fill_left_lane();
    stand(100, "r");
    EXPECT_EQ(finish().metrics.locks, 0U);
}

TEST_F(LockWatch, one_that_has_to_change_lanes_waits_for_the_queue_beside_it_or_behind_the_junction) {
    drives("a1", to_the_left);
    const auto locks = [&] {
        watch_street(false);
        put("a1", 0, 99.0F);
        stand(100, "r");
        return finish().metrics.locks;
    };
    EXPECT_EQ(locks(), 1U);
    fill_left_lane();
    EXPECT_EQ(locks(), 0U);
    put("b3", 1, 99.0F);
    EXPECT_EQ(locks(), 0U);
}

TEST_F(LockWatch, one_that_has_to_change_to_a_lane_of_a_lower_number_waits_for_it_too) {
    drives("a1", to_the_right);
    const auto locks = [&] {
        watch_street(false);
        put("a1", 1, 99.0F);
        stand(100, "r");
        return finish().metrics.locks;
    };
    EXPECT_EQ(locks(), 1U);
    put("b1", 0, 99.0F, 1.0F);
    EXPECT_EQ(locks(), 0U);
}

}  // namespace
}  // namespace clearway::metrics
