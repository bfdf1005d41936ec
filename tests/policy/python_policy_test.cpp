#include "policy/python_policy.hpp"

#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>

#include "policy/navigate.hpp"
#include "policy/way_test.hpp"

namespace clearway::testing {
namespace {

class PythonWays : public WayTest {
  protected:
    static constexpr const char* file = CLEARWAY_SOURCE_DIR "/tests/policy/fastest_way.py";

    void SetUp() override { ::setenv("CLEARWAY_PACKAGE", CLEARWAY_SOURCE_DIR "/python", 1); }
    static policy::PythonPolicy make(const char* object) {
        return policy::PythonPolicy({short_square()}, std::string(file) + ":" + object, {});
    }
    /// The first way that a policy asks for within a minute; empty for none.
    std::vector<core::EdgeIndex> first_way(policy::Policy& policy) {
        for (int decision = 0; decision < 120; ++decision)
            if (const auto leases = act(policy); !leases.empty())
                return std::get<traffic::TakeRoute>(leases.front().action).edges;
        return {};
    }
    /// By edge: what class Told says.
    std::vector<double> told(policy::Policy& policy) {
        std::vector<double> times_s;
        for (const traffic::Lease& lease : act(policy))
            times_s.push_back(std::strtod(lease.reason, nullptr));
        return times_s;
    }
    static double limit_s(const char* id) {
        const roads::Lane& lane = short_square().lane(short_square().lane_of(edge(id), 0));
        return static_cast<double>(lane.length_m) / static_cast<double>(lane.speed_limit_mps);
    }
};

TEST_F(PythonWays, keeps_its_way_while_none_is_faster) {
    policy::PythonPolicy mine = make("FastestWay");
    EXPECT_TRUE(first_way(mine).empty());
}

TEST_F(PythonWays, goes_round_a_queue_as_navigate_does) {
    add_queue();
    policy::Navigate navigate({short_square()}, policy::NavigateConfig{});
    policy::PythonPolicy mine = make("FastestWay");
    const auto expected = first_way(navigate);
    EXPECT_EQ(expected, (std::vector{edge("left0A0"), edge("A0A1"), edge("A1B1"), edge("B1right1")}));
    now_s = 100.0;
    EXPECT_EQ(first_way(mine), expected);
}

TEST_F(PythonWays, goes_round_a_closed_road_as_navigate_does) {
    policy::Navigate navigate({short_square()}, policy::NavigateConfig{});
    policy::PythonPolicy mine = make("FastestWay");
    EXPECT_TRUE(act(navigate).empty());
    EXPECT_TRUE(act(mine).empty());
    scene.belief().incidents = {{edge("B0B1"), true, 0.0F}};
    const auto expected = first_way(navigate);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(first_way(mine), expected);
}

TEST_F(PythonWays, believe_the_limit_and_the_wait_at_the_signal_where_nothing_is_seen) {
    add_queue();
    policy::PythonPolicy mine = make("Told");
    std::vector<double> times_s;
    for (int decision = 0; decision < 60; ++decision)
        times_s = told(mine);
    ASSERT_EQ(times_s.size(), short_square().edges().size());
    // Red for 48 s of 90 s.
    const double wait_s = 48.0 * 48.0 / (2.0 * 90.0);
    for (const char* unseen : {"A0A1", "A1B1", "B0B1", "left0A0"})
        EXPECT_NEAR(times_s[edge(unseen).value], limit_s(unseen) + wait_s, 1e-9) << unseen;
    EXPECT_NEAR(times_s[edge("B1right1").value], limit_s("B1right1"), 1e-9) << "no signal";
    EXPECT_GT(times_s[edge("A0B0").value], limit_s("A0B0") + wait_s + 20.0) << "the queue";
    for (std::uint32_t row = 0; row < times_s.size(); ++row)
        EXPECT_EQ(std::isinf(times_s[row]), short_square().edge(core::EdgeIndex{row}).internal) << row;
}

TEST_F(PythonWays, are_endless_where_an_incident_closes_the_road_and_limited_where_it_leaves_a_lane) {
    policy::PythonPolicy mine = make("Told");
    scene.belief().incidents = {{edge("A0B0"), true, 0.0F}, {edge("B0B1"), false, 1.0F}};
    const std::vector<double> closed_s = told(mine);
    EXPECT_TRUE(std::isinf(closed_s.at(edge("A0B0").value)));
    EXPECT_NEAR(closed_s.at(edge("B0B1").value), short_square().edge(edge("B0B1")).length_m, 1e-4)
        << "at 1 m/s";
    scene.belief().incidents.clear();
    const std::vector<double> open_s = told(mine);
    EXPECT_TRUE(std::isfinite(open_s.at(edge("A0B0").value)));
    EXPECT_LT(open_s.at(edge("B0B1").value), closed_s.at(edge("B0B1").value));
}

}  // namespace
}  // namespace clearway::testing
