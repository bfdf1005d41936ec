#include "policy/navigate.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "policy/way_test.hpp"

namespace clearway::testing {
namespace {

using policy::NavigateConfig;
using traffic::VehicleClass;

class Navigation : public WayTest {
  protected:
    /// Decisions every 0.5 s; the leases of all.
    std::vector<traffic::Lease> act_for(policy::Navigate& navigate, double duration_s) {
        std::vector<traffic::Lease> leases;
        for (double at_s = 0.0; at_s < duration_s - 1e-9; at_s += 0.5)
            for (traffic::Lease& lease : act(navigate))
                leases.push_back(std::move(lease));
        return leases;
    }
    static policy::Navigate make(const NavigateConfig& config = {}) {
        return policy::Navigate({short_square()}, config);
    }
};

TEST_F(Navigation, stays_on_its_way_while_none_is_faster) {
    policy::Navigate navigate({short_square()}, NavigateConfig{});
    EXPECT_TRUE(act_for(navigate, 60.0).empty());
}

TEST_F(Navigation, goes_round_a_queue_that_is_seen) {
    add_queue();
    policy::Navigate navigate({short_square()}, NavigateConfig{});
    const auto leases = act_for(navigate, 60.0);
    ASSERT_FALSE(leases.empty());
    EXPECT_EQ(std::get<core::VehicleKey>(leases.front().target), ev);
    EXPECT_EQ(leases.front().beneficiary, ev);
    EXPECT_STREQ(leases.front().reason, "another way is faster");
    EXPECT_EQ(std::get<traffic::TakeRoute>(leases.front().action).edges,
              edges({"left0A0", "A0A1", "A1B1", "B1right1"}));
}

TEST_F(Navigation, does_not_look_at_traffic_without_observes) {
    add_queue();
    policy::Navigate navigate({short_square()}, {.observes = 0});
    EXPECT_TRUE(act_for(navigate, 60.0).empty());
}

TEST_F(Navigation, goes_round_no_queue_that_it_takes_for_another_road_s) {
    add_queue();
    policy::Navigate navigate({short_square()}, {.observes = 2});
    for (const traffic::Lease& lease : act_for(navigate, 60.0))
        EXPECT_NE(std::get<traffic::TakeRoute>(lease.action).edges,
                  edges({"left0A0", "A0A1", "A1B1", "B1right1"}));
}

TEST_F(Navigation, takes_the_way_that_is_faster_on_other_days) {
    std::vector<double> mean_s(short_square().edges().size(), 0.0);
    mean_s[edge("A0B0").value] = 60.0;
    const auto departs = [&](const NavigateConfig& config) {
        policy::Navigate navigate({.network = short_square(), .mean_times_s = mean_s}, config);
        return act_for(navigate, 20.0);
    };
    EXPECT_TRUE(departs({}).empty());
    const auto leases = departs({.replan_s = 86400.0, .observes = 0, .prior = policy::Prior::mean_times});
    ASSERT_EQ(leases.size(), 1U) << "at departure alone";
    EXPECT_EQ(std::get<traffic::TakeRoute>(leases.front().action).edges,
              edges({"left0A0", "A0A1", "A1B1", "B1right1"}));
    EXPECT_LE(leases.front().expiry.value, now_s) << "later the crew may have turned";
}

TEST_F(Navigation, considers_a_way_that_gains_too_little_and_none_that_is_level) {
    const auto asked_with = [&](double longer_s) {
        std::vector<double> mean_s(short_square().edges().size(), 0.0);
        for (const char* const each : {"A0B0", "B0B1", "A0A1", "A1B1"})
            mean_s[edge(each).value] = 20.0;
        mean_s[edge("A0B0").value] += longer_s;
        policy::Navigate navigate({.network = short_square(), .mean_times_s = mean_s},
                                  {.observes = 0, .prior = policy::Prior::mean_times});
        return act_for(navigate, 2.0);
    };
    EXPECT_TRUE(asked_with(0.05).empty());
    const auto below = asked_with(9.5);
    ASSERT_EQ(below.size(), 1U) << "where it plans";
    EXPECT_TRUE(std::holds_alternative<traffic::StandBack>(below.front().action));
    const auto above = asked_with(10.5);
    ASSERT_EQ(above.size(), 1U);
    EXPECT_TRUE(std::holds_alternative<traffic::TakeRoute>(above.front().action));
}

TEST_F(Navigation, takes_free_flow_where_other_days_know_nothing) {
    const std::vector<double> mean_s(short_square().edges().size(), 0.0);
    add_queue();
    policy::Navigate with({.network = short_square(), .mean_times_s = mean_s},
                          {.prior = policy::Prior::mean_times});
    policy::Navigate without({short_square()}, NavigateConfig{});
    const double begin_s = now_s;
    const auto one = act_for(with, 60.0);
    now_s = begin_s;
    const auto other = act_for(without, 60.0);
    ASSERT_EQ(one.size(), other.size());
    ASSERT_FALSE(one.empty());
    EXPECT_EQ(std::get<traffic::TakeRoute>(one.front().action).edges,
              std::get<traffic::TakeRoute>(other.front().action).edges);
}

TEST_F(Navigation, refuses_to_assume_other_days_that_the_scenario_does_not_have) {
    try {
        policy::Navigate navigate({short_square()}, {.prior = policy::Prior::mean_times});
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("clearway scenario mean-times"));
    }
}

TEST_F(Navigation, changes_for_no_less_than_the_gain_that_it_asks_and_says_which_way_it_considered) {
    add_queue();
    policy::Navigate navigate({short_square()}, {.replan_s = 5.0, .gain_s = 1e6});
    const auto leases = act_for(navigate, 60.0);
    ASSERT_FALSE(leases.empty());
    EXPECT_LE(leases.size(), 12U) << "where it plans, not at every decision";
    for (const traffic::Lease& lease : leases) {
        EXPECT_EQ(std::get<core::VehicleKey>(lease.target), ev);
        EXPECT_EQ(lease.beneficiary, ev);
        EXPECT_STREQ(lease.reason, "another way is faster, but not by enough");
        EXPECT_EQ(std::get<traffic::StandBack>(lease.action).way,
                  edges({"left0A0", "A0A1", "A1B1", "B1right1"}));
    }
}

TEST_F(Navigation, considers_no_way_once_it_is_on_the_fastest) {
    add_queue();
    scene.roster().set_route(ev, scene.roster().add_route(edges({"left0A0", "A0A1", "A1B1", "B1right1"})));
    policy::Navigate navigate({short_square()}, {.gain_s = 1e6});
    EXPECT_TRUE(act_for(navigate, 60.0).empty());
}

TEST_F(Navigation, leaves_a_way_that_is_known_to_be_closed_at_once) {
    policy::Navigate navigate({short_square()}, NavigateConfig{});
    EXPECT_TRUE(act_for(navigate, 2.0).empty());
    scene.belief().incidents = {{edge("B0B1"), true, 0.0F}};
    const auto leases = act_for(navigate, 0.5);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_STREQ(leases.front().reason, "its way is closed");
    EXPECT_EQ(std::get<traffic::TakeRoute>(leases.front().action).edges,
              edges({"left0A0", "A0A1", "A1B1", "B1right1"}));
}

TEST_F(Navigation, leaves_a_round_alone_that_passes_its_end) {
    scene.remove(ev);
    ev = scene.add({"r", VehicleClass::emergency, {"A0B0", "B0B1", "B1A1", "A1A0", "A0B0"}, 0, 5.0, 8.0});
    policy::Navigate navigate({short_square()}, {.gain_s = 0.0, .gain_share = 0.0});
    EXPECT_TRUE(act_for(navigate, 30.0).empty());
}

TEST_F(Navigation, turns_at_the_line_where_the_next_road_is_closed) {
    scene.belief().own_states.front().state.lane_position_m = 185.0F;
    scene.belief().own_states.front().state.speed_mps = 0.0F;
    policy::Navigate navigate({short_square()}, NavigateConfig{});
    scene.belief().incidents = {{edge("A0B0"), true, 0.0F}};
    const auto leases = act_for(navigate, 0.5);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<traffic::TakeRoute>(leases.front().action).edges[1], edge("A0A1"));
}

TEST_F(Navigation, counts_the_limit_past_an_incident_that_leaves_a_lane_open) {
    policy::Navigate navigate({short_square()}, NavigateConfig{});
    scene.belief().incidents = {{edge("B0B1"), false, 10.0F}};
    EXPECT_TRUE(act_for(navigate, 2.0).empty()) << "nearly the usual limit";
    scene.belief().incidents = {{edge("B0B1"), false, 1.0F}};
    const auto leases = act_for(navigate, 0.5);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_STREQ(leases.front().reason, "another way is faster");
}

TEST_F(Navigation, does_not_hear_of_incidents_without_heeds_incidents) {
    policy::Navigate navigate({short_square()}, {.heeds_incidents = 0});
    scene.belief().incidents = {{edge("B0B1"), true, 0.0F}};
    EXPECT_TRUE(act_for(navigate, 30.0).empty());
}

TEST_F(Navigation, keeps_the_next_edge_where_a_turn_is_too_near) {
    add_queue(3);
    scene.belief().own_states.front().state.lane_position_m = 185.0F;
    policy::Navigate navigate({short_square()}, {.gain_s = 1.0, .gain_share = 0.0});
    scene.belief().incidents = {{edge("B0B1"), true, 0.0F}};
    const auto leases = act_for(navigate, 0.5);
    for (const traffic::Lease& lease : leases)
        EXPECT_EQ(std::get<traffic::TakeRoute>(lease.action).edges[1], edge("A0B0"));
}

TEST_F(Navigation, goes_back_and_forth_between_ways_that_are_level_only_without_a_least_gain) {
    add_queue(3);
    const std::vector<traffic::BelievedVehicle> begin = scene.belief().vehicles;
    /// The queue is seen on one way for ten seconds, then on the other.
    const auto changes_with = [&](const NavigateConfig& config) {
        scene.belief().vehicles = begin;
        policy::Navigate navigate({short_square()}, config);
        int changes = 0;
        for (int decision = 0; decision < 60; ++decision) {
            for (const traffic::Lease& lease : act_for(navigate, 5.0)) {
                const auto* const way = std::get_if<traffic::TakeRoute>(&lease.action);
                if (way == nullptr) continue;  // considered alone
                traffic::Roster& roster = scene.roster();
                roster.set_route(ev, roster.add_route(way->edges));
                ++changes;
            }
            const core::EdgeIndex seen = edge(decision / 2 % 2 == 0 ? "A1B1" : "A0B0");
            for (traffic::BelievedVehicle& vehicle : scene.belief().vehicles)
                if (vehicle.vehicle_class == VehicleClass::human)
                    vehicle.state.lane = short_square().lane_of(seen, 0);
        }
        return changes;
    };
    EXPECT_GE(changes_with({.gain_s = 0.0, .gain_share = 0.0}), 10);
    EXPECT_LE(changes_with({}), 3);
}

}  // namespace
}  // namespace clearway::testing
