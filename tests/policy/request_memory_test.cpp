// What signals do about requests that come by message, and between two messages.
#include <gmock/gmock.h>

#include "policy/preempt_signals.hpp"
#include "support/crossing_scene.hpp"

namespace clearway::testing {
namespace {

using policy::RequestMemory;
using traffic::PriorityRequest;
using traffic::VehicleClass;

constexpr double approach_mps =
    10.0;  ///< 80 m before the line the vehicle is 8 s away: as early as it calls.
const core::VehicleKey vehicle = core::vehicle_key("e");
const core::SignalIndex first_signal = two_crossings().find_signal("A").value();
/// The links of the eastbound approach are red, or green, at both signals.
const std::string red_letters = "GGGgrrrrGGGgrrrr";
const std::string green_letters = "rrrrGGGgrrrrGGGg";

/// The signals, which see the road and hear what the test tells them, and an ambulance that they do not see.
class Junction {
  public:
    explicit Junction(RequestMemory memory, policy::RequestMemorySettings settings = {}) {
        settings.memory = memory;
        policy_.emplace(policy::PolicyContext{two_crossings()}, policy::PreemptSignalsConfig{}, settings);
    }

    /// What the ambulance would send now.
    static PriorityRequest message(double before_line_m, double at_s) {
        CrossingScene scene(at_s);
        scene.add({"e", VehicleClass::emergency, eastbound, 1, line_m - before_line_m, approach_mps});
        std::vector<PriorityRequest> wanted;
        policy::PreemptSignals({two_crossings()}).ask(scene.belief(), wanted);
        return wanted.at(0);
    }
    /// Whether the first signal is held at this time, after these messages have come.
    bool holds(double at_s, const std::vector<PriorityRequest>& messages = {}) {
        policy_->hear(messages);
        traffic::BelievedGraph& belief = road.belief(shown);
        belief.time = core::Seconds(at_s);
        std::vector<traffic::Lease> leases;
        policy_->act(belief, leases);
        return !leases.empty();
    }
    /// When it ends to be held, looking each half second.
    double held_until_s(double from_s, double to_s) {
        for (double now_s = from_s; now_s < to_s; now_s += 0.5) {
            if (!holds(now_s)) return now_s;
        }
        return to_s;
    }

    CrossingScene road = known_route();  ///< Without the ambulance.
    std::string shown = green_letters;

  private:
    static CrossingScene known_route() {
        CrossingScene scene;
        scene.remove(scene.add({"e", VehicleClass::emergency, eastbound, 1, 0.0, 0.0}));
        return scene;
    }
    std::optional<policy::PreemptSignals> policy_;
};

class EveryMemory : public ::testing::TestWithParam<RequestMemory> {};

TEST_P(EveryMemory, knows_nothing_of_a_vehicle_that_it_has_not_heard) {
    Junction junction(GetParam());
    junction.road.add({"e", VehicleClass::emergency, eastbound, 1, line_m - 40.0, approach_mps});
    EXPECT_FALSE(junction.holds(100.0)) << "though the vehicle knows itself and the graph has it";
    EXPECT_TRUE(junction.holds(100.5, {Junction::message(35.0, 100.5)}));
}

TEST_P(EveryMemory, acts_on_a_message_of_this_moment_as_on_the_vehicle_itself) {
    for (const double before_line_m : {20.0, 66.0, 67.0, 90.0}) {
        Junction junction(GetParam());
        CrossingScene scene(100.0);
        scene.add({"e", VehicleClass::emergency, eastbound, 1, line_m - before_line_m, approach_mps});
        policy::PreemptSignals told_nothing({two_crossings()});
        std::vector<traffic::Lease> leases;
        told_nothing.act(scene.belief(green_letters), leases);
        EXPECT_EQ(junction.holds(100.0, {Junction::message(before_line_m, 100.0)}), !leases.empty())
            << before_line_m;
    }
}

TEST_P(EveryMemory, ends_with_the_cancellation) {
    Junction junction(GetParam());
    PriorityRequest message = Junction::message(40.0, 100.0);
    ASSERT_TRUE(junction.holds(100.0, {message}));
    message.type = traffic::RequestType::cancellation;
    message.sent = core::Seconds(100.5);
    EXPECT_FALSE(junction.holds(100.5, {message}));
    EXPECT_FALSE(junction.holds(101.0));
}

TEST_P(EveryMemory, ends_when_the_vehicle_is_seen_behind_the_line) {
    Junction junction(GetParam());
    ASSERT_TRUE(junction.holds(100.0, {Junction::message(20.0, 100.0)}));
    junction.road.remove(junction.road.add({"e", VehicleClass::emergency, {"A_B", "B_east"}, 1, 9.0, 9.0}));
    junction.road.add({"e", VehicleClass::emergency, {"A_B", "B_east"}, 1, 5.0, approach_mps});
    EXPECT_FALSE(junction.holds(101.0));
    EXPECT_FALSE(junction.holds(101.5, {Junction::message(5.0, 100.5)}))
        << "a message from before, which comes late";
}

TEST_P(EveryMemory, never_outlives_the_longest_age_of_a_message) {
    policy::RequestMemorySettings patient;
    patient.timeout_s = 60.0;
    patient.window_s = 60.0;
    patient.longest_memory_s = 8.0;
    Junction junction(GetParam(), patient);
    junction.shown = red_letters;  // It is believed to wait.
    ASSERT_TRUE(junction.holds(100.0, {Junction::message(20.0, 100.0)}));
    EXPECT_EQ(junction.held_until_s(100.5, 150.0), 108.5);
}

INSTANTIATE_TEST_SUITE_P(Memories, EveryMemory,
                         ::testing::Values(RequestMemory::forget, RequestMemory::hold_eta,
                                           RequestMemory::dead_reckon, RequestMemory::graph),
                         [](const auto& one) { return std::string(core::name(one.param)); });

TEST(ForgettingSignal, lets_go_when_a_message_is_overdue) {
    Junction junction(RequestMemory::forget);
    ASSERT_TRUE(junction.holds(100.0, {Junction::message(40.0, 100.0)}));
    EXPECT_EQ(junction.held_until_s(100.5, 150.0), 102.5) << "2 s are over";
    EXPECT_TRUE(junction.holds(103.0, {Junction::message(15.0, 103.0)})) << "it comes back";
}

TEST(HoldingSignal, counts_down_to_the_announced_arrival_and_its_window) {
    Junction junction(RequestMemory::hold_eta);
    ASSERT_FALSE(junction.holds(100.0, {Junction::message(150.0, 100.0)})) << "15 s away";
    EXPECT_FALSE(junction.holds(106.5)) << "8.5 s away";
    EXPECT_TRUE(junction.holds(107.0)) << "8 s away, though nothing more was heard";
    EXPECT_EQ(junction.held_until_s(107.5, 150.0), 125.5) << "arrival after 15 s, and 10 s of window";
}

TEST(ReckoningSignal, drives_the_vehicle_on_and_waits_a_window_at_an_open_line) {
    Junction junction(RequestMemory::dead_reckon);
    ASSERT_FALSE(junction.holds(100.0, {Junction::message(150.0, 100.0)}));
    EXPECT_FALSE(junction.holds(106.5));
    EXPECT_TRUE(junction.holds(107.0)) << "70 m driven, 80 m left";
    EXPECT_EQ(junction.held_until_s(107.5, 150.0), 125.5) << "at the line after 15 s";
}

TEST(ReckoningSignal, stops_the_vehicle_at_red_and_counts_the_window_from_green) {
    Junction junction(RequestMemory::dead_reckon);
    junction.shown = red_letters;
    ASSERT_TRUE(junction.holds(100.0, {Junction::message(50.0, 100.0)}));
    EXPECT_TRUE(junction.holds(112.0));
    junction.shown = green_letters;
    EXPECT_EQ(junction.held_until_s(112.5, 150.0), 123.0);
}

TEST(ReckoningSignal, stops_the_vehicle_behind_a_standing_queue) {
    Junction junction(RequestMemory::dead_reckon);
    junction.road.add({"h", VehicleClass::human, eastbound, 1, line_m - 3.0, 0.0});
    ASSERT_TRUE(junction.holds(100.0, {Junction::message(50.0, 100.0)}));
    EXPECT_EQ(junction.held_until_s(100.5, 150.0), 130.5)
        << "until the longest age: it never gets to the line";
}

TEST(ReckoningSignal, makes_up_for_the_latency) {
    Junction late(RequestMemory::dead_reckon);
    EXPECT_TRUE(late.holds(105.0, {Junction::message(120.0, 100.0)})) << "70 m left";
    Junction naive(RequestMemory::forget);
    EXPECT_FALSE(naive.holds(105.0, {Junction::message(120.0, 100.0)})) << "120 m left when it was sent";
}

TEST(BelievingSignal, takes_the_place_that_the_graph_knows_better) {
    for (const RequestMemory memory : {RequestMemory::dead_reckon, RequestMemory::graph}) {
        Junction junction(memory);
        ASSERT_FALSE(junction.holds(100.0, {Junction::message(200.0, 100.0)})) << "20 s away";
        junction.road.add({"e", VehicleClass::emergency, eastbound, 1, line_m - 70.0, approach_mps});
        EXPECT_EQ(junction.holds(101.0), memory == RequestMemory::graph) << "somebody sees it 7 s away";
    }
}

TEST(BelievingSignal, goes_on_from_there_by_dead_reckoning_when_the_graph_loses_the_vehicle) {
    Junction junction(RequestMemory::graph);
    ASSERT_FALSE(junction.holds(100.0, {Junction::message(400.0, 100.0)}));
    const core::VehicleKey seen =
        junction.road.add({"e", VehicleClass::emergency, eastbound, 1, line_m - 110.0, approach_mps});
    EXPECT_FALSE(junction.holds(101.0));
    junction.road.remove(seen);
    EXPECT_FALSE(junction.holds(103.5)) << "85 m left";
    EXPECT_TRUE(junction.holds(104.0)) << "80 m left; by the message alone it would be 360 m";
}

std::string refusal(const core::Settings& settings) {
    try {
        policy::make_policy("corridor", {two_crossings()}, settings);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(MemorySettings, are_those_of_the_page_and_nothing_else) {
    EXPECT_EQ(refusal({{"preempt_signals.memory", "graph"}, {"preempt_signals.timeout_s", "4"}}), "accepted");
    EXPECT_THAT(
        refusal({{"preempt_signals.memory", "guess"}}),
        ::testing::AllOf(::testing::HasSubstr("preempt_signals.memory"), ::testing::HasSubstr("guess"),
                         ::testing::HasSubstr("forget, hold_eta, dead_reckon, graph")));
    EXPECT_THAT(
        refusal({{"preempt_signals.window_s", "-1"}}),
        ::testing::AllOf(::testing::HasSubstr("preempt_signals.window_s"), ::testing::HasSubstr("0 to 60")));
    EXPECT_THAT(refusal({{"preempt_signals.longest_memory_s", "1e9"}}), ::testing::HasSubstr("1 to 300"));
}

TEST(RequestMessage, has_the_content_of_an_srm) {
    const PriorityRequest message = Junction::message(150.0, 100.0);
    EXPECT_EQ(message.vehicle, vehicle);
    EXPECT_EQ(message.signal, first_signal);
    EXPECT_EQ(message.importance, traffic::highest_importance);
    EXPECT_EQ(message.edge_in, two_crossings().find_edge("west_A"));
    EXPECT_EQ(message.edge_out, two_crossings().find_edge("A_B"));
    EXPECT_EQ(message.connections, (std::vector<std::uint16_t>{13, 14}));
    EXPECT_NEAR(message.distance_m, 150.0, 0.01);
    EXPECT_NEAR(message.eta.value, 115.0, 0.01);
    EXPECT_EQ(message.window.value, 10.0);
    EXPECT_EQ(message.sent.value, 100.0);
    EXPECT_EQ(message.motion.speed_mps, 10.0F);
}

}  // namespace
}  // namespace clearway::testing
