#include "policy/detail/queue_model.hpp"

#include <array>

#include <gtest/gtest.h>

#include "core/files.hpp"
#include "policy/detail/approach.hpp"
#include "policy/detail/hold_planner.hpp"
#include "policy/preempt_signals.hpp"
#include "support/crossing_scene.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::testing {
namespace {

using policy::detail::Arrival;
using policy::detail::HoldPlanner;
using policy::detail::ModelSight;
using policy::detail::ProgramClock;
using policy::detail::QueueModel;
using policy::detail::SignalForecast;
using policy::detail::SignalForecaster;
using policy::detail::View;
using traffic::VehicleClass;

const std::string north_green = "GGGgrrrrGGGgrrrr";
const std::string west_green = "rrrrGGGgrrrrGGGg";

const roads::Signal& crossing_a() {
    return two_crossings().signal(two_crossings().find_signal("A").value());
}

/// The emergency vehicle comes from the west to crossing A.
CrossingScene coming_from_the_west(double before_line_m, double speed_mps = 16.67) {
    CrossingScene scene;
    scene.add({"e", VehicleClass::emergency, eastbound, 1, line_m - before_line_m, speed_mps});
    return scene;
}

void add_queue(CrossingScene& scene, const std::string& name, const std::vector<std::string>& route,
               int count, double speed_mps = 0.0, std::uint32_t lane = 1) {
    const roads::Network& network = two_crossings();
    const double ends_m = network.lane(network.lane_of(network.find_edge(route.front()).value(), 1)).length_m;
    for (int number = 0; number < count; ++number)
        scene.add({name + std::to_string(number), VehicleClass::human, route, lane,
                   ends_m - 1.0 - 7.5 * number, speed_mps});
}
const std::vector<std::string> southbound = {"north_a_A", "A_south_a"};

Arrival first_arrival(const View& view) {
    const traffic::BelievedVehicle emergency = view.emergency_vehicles().front();
    return {emergency, policy::detail::approaches(view, emergency, core::Metres(600.0)).front(), 1, 0.0,
            std::nullopt};
}

QueueModel::Workspace& workspace() {
    static QueueModel::Workspace of_all;
    return of_all;
}

/// Of crossing A, when its program has run `cycle_time_s`.
QueueModel model_of(const View& view, const Arrival& arrival, double cycle_time_s,
                    double emergency_worth = 1.0, ModelSight sight = ModelSight::all,
                    const std::string& shown = {}) {
    return {view,
            arrival,
            {crossing_a(), arrival.approach.links, shown, cycle_time_s},
            {policy::detail::edge_before(view, arrival).value(), 0.0, emergency_worth, sight},
            workspace()};
}

QueueModel::Outcome outcome(CrossingScene& scene, double cycle_time_s, std::optional<double> start_s,
                            ModelSight sight = ModelSight::all, const std::string& shown = {}) {
    const View view(two_crossings(), scene.belief());
    return model_of(view, first_arrival(view), cycle_time_s, 1.0, sight, shown).outcome(start_s);
}

char shown_at(const SignalForecast& forecast, double time_s, std::size_t link) {
    for (const auto& piece : forecast.pieces)
        if (piece.from_s <= time_s && time_s < piece.to_s) return piece.state[link];
    return '?';
}

TEST(ProgramClock, is_in_step_while_the_signal_shows_what_it_should) {
    ProgramClock clock;
    clock.watch(north_green, core::Seconds(100.0));
    EXPECT_DOUBLE_EQ(clock.cycle_time_s(crossing_a(), core::Seconds(100.0)), 10.0) << "the cycle is 90 s";
}

TEST(ProgramClock, follows_a_program_that_is_out_of_step) {
    ProgramClock clock;
    clock.watch(west_green, core::Seconds(100.0));
    EXPECT_DOUBLE_EQ(clock.cycle_time_s(crossing_a(), core::Seconds(100.0)), 45.0);
    clock.watch(west_green, core::Seconds(120.0));
    EXPECT_DOUBLE_EQ(clock.cycle_time_s(crossing_a(), core::Seconds(120.0)), 65.0);
    EXPECT_DOUBLE_EQ(clock.cycle_time_s(crossing_a(), core::Seconds(180.0)), 85.0) << "longer than it lasts";
}

constexpr std::array<std::uint16_t, 2> straight_on{12, 13};
constexpr std::array<std::uint16_t, 4> from_the_west{12, 13, 14, 15};

TEST(SignalForecaster, goes_on_with_the_program) {
    SignalForecast forecast;
    SignalForecaster(crossing_a(), straight_on, "", 10.0).program(180.0, forecast);
    EXPECT_EQ(shown_at(forecast, 30.0, 0), 'G');
    EXPECT_EQ(shown_at(forecast, 32.0, 0), 'y');
    EXPECT_EQ(shown_at(forecast, 36.0, 13), 'G');
    EXPECT_EQ(shown_at(forecast, 36.0 + 90.0, 13), 'G');
    EXPECT_DOUBLE_EQ(forecast.pieces.back().to_s, 180.0);
}

TEST(SignalForecaster, holds_after_a_transition_and_then_is_in_step_again) {
    const SignalForecaster forecaster(crossing_a(), from_the_west, "", 10.0);
    SignalForecast forecast;
    forecaster.hold(8.0, 180.0, forecast);
    EXPECT_EQ(shown_at(forecast, 7.9, 0), 'G');
    EXPECT_EQ(shown_at(forecast, 9.0, 0), 'r');
    EXPECT_EQ(shown_at(forecast, 12.9, 13), 'r');
    EXPECT_EQ(shown_at(forecast, 13.1, 13), 'G');
    EXPECT_EQ(shown_at(forecast, 170.0, 13), 'G') << "until it is released";
    forecaster.release(forecast, 20.0, 180.0);
    EXPECT_EQ(shown_at(forecast, 24.9, 0), 'r');
    EXPECT_EQ(shown_at(forecast, 25.1, 0), 'G') << "35 s into the cycle";
    EXPECT_EQ(shown_at(forecast, 32.0, 0), 'y');
}

TEST(SignalForecaster, needs_no_transition_where_nobody_loses_green) {
    SignalForecast forecast;
    SignalForecaster(crossing_a(), from_the_west, "", 50.0).hold(0.0, 180.0, forecast);
    EXPECT_EQ(shown_at(forecast, 0.1, 13), 'G');
    EXPECT_EQ(shown_at(forecast, 100.0, 13), 'G') << "beyond the program's own green";
}

TEST(QueueModel, lets_an_emergency_vehicle_wait_for_the_program_without_a_hold) {
    CrossingScene scene = coming_from_the_west(166.7);
    EXPECT_NEAR(outcome(scene, 10.0, std::nullopt).passing_s, 35.0 + 2.0, 1e-6)
        << "green after 35 s, and 2 s until it moves";
    EXPECT_NEAR(outcome(scene, 10.0, 0.0).passing_s, 10.0, 0.01) << "it meets a green of 5 s";
    EXPECT_NEAR(outcome(scene, 10.0, 4.0).passing_s, 10.0 + 1.5, 0.01) << "one of 1 s: it has braked";
}

TEST(QueueModel, clears_the_queue_ahead_one_by_one) {
    CrossingScene scene = coming_from_the_west(166.7);
    add_queue(scene, "q", eastbound, 4);
    EXPECT_NEAR(outcome(scene, 10.0, 0.0).passing_s, 10.0, 0.01) << "the other lane is free";
    add_queue(scene, "right", eastbound, 4, 0.0, 0);
    EXPECT_NEAR(outcome(scene, 10.0, 0.0).passing_s, 5.0 + 2.0 + 4 * 2.0, 1e-6);
    EXPECT_NEAR(outcome(scene, 10.0, 6.0).passing_s, 11.0 + 2.0 + 4 * 2.0, 1e-6);
}

TEST(QueueModel, counts_what_the_others_wait) {
    CrossingScene crossing = coming_from_the_west(166.7);
    add_queue(crossing, "x", southbound, 5, 16.0);
    EXPECT_GT(outcome(crossing, 10.0, 0.0).waited_s, outcome(crossing, 10.0, std::nullopt).waited_s + 20.0);
    CrossingScene following = coming_from_the_west(166.7);
    add_queue(following, "q", eastbound, 5);
    EXPECT_LT(outcome(following, 10.0, 0.0).waited_s, outcome(following, 10.0, std::nullopt).waited_s - 20.0);
    EXPECT_DOUBLE_EQ(outcome(following, 10.0, 0.0, ModelSight::none).waited_s, 0.0);
    EXPECT_NEAR(outcome(following, 10.0, 0.0, ModelSight::none).passing_s, 10.0, 0.01);
}

TEST(QueueModel, weighs_other_emergency_vehicles_by_their_worth) {
    CrossingScene scene = coming_from_the_west(166.7);
    scene.add({"other", VehicleClass::emergency, southbound, 1, line_m - 20.0, 16.0});
    const View view(two_crossings(), scene.belief());
    Arrival arrival = first_arrival(view);
    if (arrival.emergency.key != core::vehicle_key("e")) {
        const traffic::BelievedVehicle emergency = view.emergency_vehicles().back();
        arrival = {emergency, policy::detail::approaches(view, emergency, core::Metres(600.0)).front(), 1,
                   0.0, std::nullopt};
    }
    const auto waited_s = [&](double emergency_worth) {
        return model_of(view, arrival, 10.0, emergency_worth).outcome(0.0).waited_s;
    };
    EXPECT_GT(waited_s(0.0), 0.0) << "who is expected behind it";
    EXPECT_GT(waited_s(100.0), waited_s(0.0) + 1000.0);
}

TEST(QueueModel, goes_on_from_what_the_signal_shows) {
    CrossingScene scene = coming_from_the_west(33.0);
    EXPECT_NEAR(outcome(scene, 10.0, 0.0).passing_s, 5.0 + 2.0, 1e-6) << "the program lets others go";
    EXPECT_NEAR(outcome(scene, 10.0, 0.0, ModelSight::all, west_green).passing_s, 2.0, 0.1)
        << "it is held already";
}

TEST(QueueModel, knows_who_comes_to_a_second_signal_from_the_first) {
    CrossingScene scene = coming_from_the_west(90.0);
    const auto passes_b_s = [&] {
        const View view(two_crossings(), scene.belief());
        const traffic::BelievedVehicle emergency = view.emergency_vehicles().front();
        const auto ahead = policy::detail::approaches(view, emergency, core::Metres(600.0));
        const Arrival arrival{emergency, ahead.at(1), 2, 0.0, std::nullopt};
        const roads::Signal& b = two_crossings().signal(arrival.approach.signal);
        return QueueModel(view, arrival, {b, arrival.approach.links, "", 10.0},
                          {policy::detail::edge_before(view, arrival).value(), 40.0}, workspace())
            .outcome(0.0)
            .passing_s;
    };
    EXPECT_NEAR(passes_b_s(), 40.0, 0.1) << "held up at the first signal until then";
    for (const std::uint32_t lane : {0U, 1U}) {
        add_queue(scene, "off" + std::to_string(lane), {"west_A", lane == 0 ? "A_south_a" : "A_north_a"}, 5,
                  0.0, lane);
    }
    EXPECT_NEAR(passes_b_s(), 40.0, 0.1) << "who turns off is no queue at the second";
    for (const std::uint32_t lane : {0U, 1U})
        add_queue(scene, "on" + std::to_string(lane), eastbound, 5, 0.0, lane);
    EXPECT_GT(passes_b_s(), 45.0) << "five a lane come with it";
}

TEST(QueueModel, weighs_an_emergency_vehicle_on_an_earlier_edge) {
    CrossingScene scene = coming_from_the_west(200.0);
    scene.add({"first", VehicleClass::emergency, eastbound, 1, line_m - 100.0, 16.67});
    const View view(two_crossings(), scene.belief());
    const auto emergencies = view.emergency_vehicles();
    const auto second =
        std::ranges::find(emergencies, core::vehicle_key("e"), &traffic::BelievedVehicle::key);
    const auto ahead = policy::detail::approaches(view, *second, core::Metres(600.0));
    const Arrival arrival{*second, ahead.at(1), 2, 0.0, std::nullopt};
    const roads::Signal& b = two_crossings().signal(arrival.approach.signal);
    const auto waited_s = [&](double emergency_worth) {
        return QueueModel(view, arrival, {b, arrival.approach.links, "", 89.0},
                          {policy::detail::edge_before(view, arrival).value(), 0.0, emergency_worth},
                          workspace())
            .outcome(std::nullopt)
            .waited_s;
    };
    EXPECT_GT(waited_s(1.0), 0.0) << "red for it when it comes";
    EXPECT_DOUBLE_EQ(waited_s(100.0), 100.0 * waited_s(1.0));
}

TEST(HoldPlanner, leaves_phases_that_run_side_by_side_to_the_rule) {
    const support::TemporaryFolder folder;
    std::string text = core::read_file(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml");
    const auto is_due_at_a = [&] {
        const roads::Network network = roads::Network::read(folder.write("net.net.xml", text));
        CrossingScene scene(100.0, network);
        scene.add({"e", VehicleClass::emergency, eastbound, 1, line_m - 100.0, 16.67});
        const View view(network, scene.belief());
        HoldPlanner planner({.emergency_worth = 1000.0, .longest_early_s = 20.0});
        planner.begin(view);
        return planner.is_due(view, first_arrival(view), 10.0, false);
    };
    EXPECT_TRUE(is_due_at_a());
    const std::string fixed = "<tlLogic id=\"A\" type=\"static\"";
    text.replace(text.find(fixed), fixed.size(), "<tlLogic id=\"A\" type=\"NEMA\"");
    EXPECT_FALSE(is_due_at_a());
}

TEST(QueueModel, has_no_edge_where_the_way_has_changed) {
    CrossingScene scene = coming_from_the_west(90.0);
    const View view(two_crossings(), scene.belief());
    const Arrival before = first_arrival(view);
    EXPECT_EQ(policy::detail::edge_before(view, before), two_crossings().find_edge("west_A"));
    CrossingScene turned;
    turned.add({"e", VehicleClass::emergency, southbound, 1, 100.0, 10.0});
    const View other(two_crossings(), turned.belief());
    EXPECT_EQ(policy::detail::edge_before(other, before), std::nullopt);
    HoldPlanner planner({.emergency_worth = 1000.0, .longest_early_s = 20.0});
    planner.begin(other);
    EXPECT_FALSE(planner.is_due(other, before, 10.0, false)) << "left to the rule";
}

TEST(HoldPlanner, asks_early_for_a_queue_that_moves) {
    CrossingScene scene = coming_from_the_west(250.0);
    add_queue(scene, "q", eastbound, 12, 2.0);
    add_queue(scene, "right", eastbound, 12, 2.0, 0);
    policy::PreemptSignals lead({two_crossings()}, {.timing = policy::HoldTiming::lead});
    policy::PreemptSignals queues({two_crossings()}, {.timing = policy::HoldTiming::queues});
    policy::PreemptSignals blind({two_crossings()}, {.timing = policy::HoldTiming::no_queue});
    const auto asks = [&](policy::Policy& policy) {
        std::vector<traffic::Lease> leases;
        policy.act(scene.belief(), leases);
        return !leases.empty();
    };
    EXPECT_FALSE(asks(lead)) << "nobody stands";
    EXPECT_TRUE(asks(queues));
    EXPECT_FALSE(asks(blind)) << "it would meet a free road 15 s from now";
}

TEST(HoldPlanner, asks_for_nothing_that_others_pay_for_where_the_emergency_vehicle_is_worth_nothing) {
    CrossingScene scene = coming_from_the_west(100.0);
    add_queue(scene, "x", southbound, 12);
    const traffic::BelievedGraph& belief = scene.belief();
    const View view(two_crossings(), belief);
    const auto is_due = [&](double emergency_worth) {
        HoldPlanner planner({.emergency_worth = emergency_worth, .longest_early_s = 20.0});
        planner.begin(view);
        return planner.is_due(view, first_arrival(view), 10.0, false);
    };
    EXPECT_FALSE(is_due(0.0));
    EXPECT_TRUE(is_due(1000.0));
}

TEST(HoldPlanner, begins_before_the_lead_only_for_a_gain) {
    CrossingScene scene = coming_from_the_west(100.0);
    const traffic::BelievedGraph& belief = scene.belief();
    const View view(two_crossings(), belief);
    const auto is_due = [&](double rule_s, double least_gain_s) {
        HoldPlanner planner({1000.0, least_gain_s, 20.0});
        planner.begin(view);
        return planner.is_due(view, first_arrival(view), rule_s, false);
    };
    EXPECT_TRUE(is_due(4.0, 2.0)) << "6 s to the line: a hold in 4 s opens it 3 s after that";
    EXPECT_FALSE(is_due(4.0, 10.0));
    EXPECT_TRUE(is_due(0.0, 2.0)) << "the lead asks now";
    EXPECT_TRUE(is_due(20.0, 2.0));
    EXPECT_FALSE(is_due(20.5, 2.0)) << "too long before the lead";
}

TEST(HoldPlanner, begins_after_the_lead_only_where_that_costs_less) {
    CrossingScene scene = coming_from_the_west(150.0);
    add_queue(scene, "x", southbound, 12);
    const traffic::BelievedGraph& belief = scene.belief();
    const View view(two_crossings(), belief);
    const auto is_due = [&](double rule_s, double emergency_worth, double longest_late_s) {
        HoldPlanner planner(
            {.emergency_worth = emergency_worth, .longest_early_s = 20.0, .longest_late_s = longest_late_s});
        planner.begin(view);
        return planner.is_due(view, first_arrival(view), rule_s, false);
    };
    EXPECT_TRUE(is_due(-1.0, 1.0, 0.0)) << "the lead has said so";
    EXPECT_FALSE(is_due(-1.0, 1.0, 5.0)) << "twelve others wait for it";
    EXPECT_TRUE(is_due(-5.0, 1.0, 5.0)) << "no later than that";
    EXPECT_TRUE(is_due(-1.0, 10000.0, 5.0)) << "it would lose time";
}

TEST(Pace, is_of_those_who_drive_on_green) {
    policy::detail::Pace pace;
    const core::VehicleKey one = core::vehicle_key("one");
    const core::VehicleKey other = core::vehicle_key("other");
    constexpr core::SignalIndex signal{0};
    EXPECT_EQ(pace.share(), 1.0) << "nobody has driven";
    const auto drive = [&](core::VehicleKey vehicle, double at_half_pace_s, bool counts) {
        for (double at_s = 0.0; at_s <= at_half_pace_s; at_s += 0.5)
            pace.watch({vehicle, signal}, 100.0 - at_s / 2.0, core::Seconds(at_s), counts);
    };
    drive(one, 60.0, false);
    EXPECT_EQ(pace.share(), 1.0) << "it waits";
    drive(other, 20.0, true);
    EXPECT_DOUBLE_EQ(pace.share(), (20.0 + 10.0) / (20.0 + 20.0));
    pace.watch({other, signal}, 10.0, core::Seconds(500.0), true);
    EXPECT_DOUBLE_EQ(pace.share(), 0.75) << "nobody knows what was between";
}

TEST(QueueModel, lets_emergency_vehicles_come_at_the_pace_of_others_before_them) {
    CrossingScene scene = coming_from_the_west(200.0);
    const traffic::BelievedGraph& belief = scene.belief();
    const View view(two_crossings(), belief);
    const Arrival arrival = first_arrival(view);
    const auto passing_s = [&](double pace) {
        const core::SignalIndex signal = arrival.approach.signal;
        return QueueModel(view, arrival, {two_crossings().signal(signal), arrival.approach.links, "", 0.0},
                          {.edge = policy::detail::edge_before(view, arrival).value(), .pace = pace},
                          workspace())
            .outcome(0.0)
            .passing_s;
    };
    EXPECT_NEAR(passing_s(0.5), 2.0 * passing_s(1.0), 0.1);
}

TEST(HoldPlanner, foretells_the_second_signal_from_the_first) {
    CrossingScene scene = coming_from_the_west(90.0, 0.0);
    add_queue(scene, "first", {"west_A", "A_north_a"}, 10);
    add_queue(scene, "right", {"west_A", "A_south_a"}, 10, 0.0, 0);
    add_queue(scene, "second", {"A_B", "B_east"}, 9);
    add_queue(scene, "beside", {"A_B", "B_east"}, 9, 0.0, 0);
    add_queue(scene, "cross", {"north_b_B", "B_south_b"}, 20, 10.0);
    const traffic::BelievedGraph& belief = scene.belief();
    const View view(two_crossings(), belief);
    const traffic::BelievedVehicle emergency = view.emergency_vehicles().front();
    const auto ahead = policy::detail::approaches(view, emergency, core::Metres(600.0));
    ASSERT_EQ(ahead.size(), 2U);
    const auto second_is_due = [&](bool after_the_first) {
        HoldPlanner planner({.emergency_worth = 1000.0, .longest_early_s = 20.0});
        planner.begin(view);
        if (after_the_first) planner.is_due(view, {emergency, ahead[0], 1, 0.0, std::nullopt}, 10.0, true);
        return planner.is_due(view, {emergency, ahead[1], 2, 0.0, std::nullopt}, 10.0, false);
    };
    EXPECT_TRUE(second_is_due(false)) << "a free way of 390 m, and a queue of nine";
    EXPECT_FALSE(second_is_due(true)) << "the queue before the first signal takes longer than the second one";
}

}  // namespace
}  // namespace clearway::testing
