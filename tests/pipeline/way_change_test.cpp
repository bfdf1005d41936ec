// What signals are asked when an emergency vehicle takes another way.
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/decision_chain.hpp"
#include "support/crossing_scene.hpp"

namespace clearway::testing {
namespace {

/// navigate and corridor; an EV before A0 on its way over B0 of short_square, where a queue stands. It stays
/// where it is put, and drives the ways that it is told.
class WayChange : public ::testing::TestWithParam<const char*> {
  protected:
    WayChange() {
        for (int number = 0; number < 12; ++number)
            scene_.add({"q" + std::to_string(number),
                        traffic::VehicleClass::human,
                        {"A0B0", "B0B1"},
                        0,
                        94.0 - 7.5 * number,
                        0.0});
        experiment::ConditionSpec condition;
        condition.policies = {"navigate", "corridor"};
        condition.failure = GetParam();
        chain_.emplace(condition, pipeline::ChainContext{.network = short_square()});
    }
    /// One decision, 0.5 s after the last one: whether it takes another way.
    bool decides_for_another_way() {
        snapshot_.time = core::Seconds(snapshot_.time.value + 0.5);
        show();
        chain_->observe(snapshot_, scene_.roster());
        chain_->decide();
        held_.clear();
        bool changes = false;
        for (const traffic::Lease& lease : chain_->leases()) {
            if (const auto* const way = std::get_if<traffic::TakeRoute>(&lease.action)) {
                traffic::Roster& roster = scene_.roster();
                roster.set_route(ev_, roster.add_route(way->edges));
                changes = true;
            } else if (std::holds_alternative<traffic::HoldGreen>(lease.action)) {
                held_.insert(short_square().signal(std::get<core::SignalIndex>(lease.target)).id);
            }
        }
        return changes;
    }
    void put(const char* edge, double position_m) {
        traffic::MotionState& state = scene_.belief().own_states.front().state;
        state.lane = short_square().lane_of(short_square().find_edge(edge).value(), 0);
        state.lane_position_m = static_cast<float>(position_m);
        ++state.route_edge;
    }
    /// Requests that were not sent before.
    std::uint64_t requested() const {
        const traffic::SignalRequestCounts& counts = chain_->signal_requests();
        return counts.sent - counts.updates - counts.cancellations;
    }
    std::uint64_t cancelled() const { return chain_->signal_requests().cancellations; }

    std::set<std::string> held_;  ///< Signals that are to hold green by the last decision.

  private:
    void show() {
        const traffic::BelievedGraph& belief = scene_.belief();
        snapshot_.signals = belief.signals;
        snapshot_.resize(0);
        for (traffic::BelievedVehicle vehicle : belief.vehicles) {
            if (vehicle.key == ev_) vehicle.state = belief.own_states.front().state;
            const roads::Point place =
                short_square().point_at(vehicle.state.lane, core::Metres(vehicle.state.lane_position_m));
            snapshot_.key.push_back(vehicle.key);
            snapshot_.vehicle_class.push_back(vehicle.vehicle_class);
            snapshot_.x_m.push_back(place.x_m);
            snapshot_.y_m.push_back(place.y_m);
            snapshot_.heading_rad.push_back(vehicle.state.heading_rad);
            snapshot_.speed_mps.push_back(vehicle.state.speed_mps);
            snapshot_.acceleration_mps2.push_back(0.0F);
            snapshot_.lane.push_back(vehicle.state.lane);
            snapshot_.lane_position_m.push_back(vehicle.state.lane_position_m);
            snapshot_.route_edge.push_back(vehicle.state.route_edge);
        }
    }

    CrossingScene scene_{100.0, short_square()};
    core::VehicleKey ev_ = scene_.add(
        {"e", traffic::VehicleClass::emergency, {"left0A0", "A0B0", "B0B1", "B1right1"}, 0, 20.0, 10.0});
    truth::Snapshot snapshot_;
    std::optional<pipeline::DecisionChain> chain_;
};

TEST_P(WayChange, withdraws_the_request_at_the_signal_that_is_left_and_asks_the_new_one) {
    int decisions = 1;
    while (!decides_for_another_way() && decisions < 120)
        ++decisions;
    ASSERT_LT(decisions, 120);
    EXPECT_EQ(requested(), 3U) << "A0, B0 and B1";
    EXPECT_EQ(cancelled(), 0U);
    EXPECT_TRUE(held_.contains("B0")) << "its queue has to leave";

    EXPECT_FALSE(decides_for_another_way());
    EXPECT_EQ(requested(), 4U) << "A1";
    EXPECT_EQ(cancelled(), 1U) << "B0; A0 and B1 are on both ways";
    EXPECT_FALSE(held_.contains("B0"));
    for (int decision = 0; decision < 4; ++decision)
        decides_for_another_way();
    EXPECT_EQ(cancelled(), 3U) << "a message is repeated twice";
    EXPECT_EQ(requested(), 4U);
    EXPECT_FALSE(held_.contains("B0"));

    put("A0A1", 30.0);
    decides_for_another_way();
    EXPECT_EQ(held_, (std::set<std::string>{"A1"})) << "65 m at 10 m/s: under the lead of 8 s";
}

INSTANTIATE_TEST_SUITE_P(
    Channels, WayChange,
    ::testing::Values("perfect", "perfect,signal_request_propagation=sharp,signal_request_range_m=1000"));

}  // namespace
}  // namespace clearway::testing
