#include "policy/agent.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <unistd.h>

#include "core/error.hpp"
#include "policy/detail/agent_sheet.hpp"
#include "policy/way_test.hpp"

namespace clearway::testing {
namespace {

using traffic::VehicleClass;

/// An agent that is offered ways, and an environment that has answered before it is asked.
class AgentWays : public WayTest {
  protected:
    struct Way {
        float time_s, length_m, common_share;
    };

    static float length_m(const char* id) { return short_square().edge(edge(id)).length_m; }

    void SetUp() override { score.any_departed = true; }
    policy::Agent make(std::uint32_t ways) {
        offered = ways;
        return policy::Agent(
            {short_square()}, channel, score, [](python::Bell) { FAIL(); }, ways);
    }
    /// One decision, with this choice of a way and no other action.
    std::vector<traffic::Lease> act(policy::Agent& agent, std::int32_t way = 0) {
        const policy::AgentSizes sizes = policy::agent_sizes(short_square(), offered);
        std::vector<std::int32_t> actions(sizes.signals + sizes.automated, 0);
        if (offered > 0) actions.push_back(way);
        python::Sheet answer(channel.incoming(), policy::detail::agent_answer_columns());
        answer.clear();
        answer.put(0, actions);
        const char bell = static_cast<char>(python::Bell::answer);
        EXPECT_EQ(::write(channel.theirs().write, &bell, 1), 1);
        return WayTest::act(agent);
    }
    template <class Value>
    std::vector<Value> asked(std::string_view name) {
        const auto columns = policy::detail::agent_columns();
        const auto found = std::ranges::find(columns, name, &python::Column::name);
        const python::Sheet sheet(channel.outgoing(), columns);
        const auto values = sheet.read<Value>(static_cast<std::size_t>(found - columns.begin()));
        return {values.begin(), values.end()};
    }
    /// Ways of the last decision.
    std::vector<Way> ways() {
        const std::vector<float> values = asked<float>("ways");
        std::vector<Way> rows;
        for (const std::uint8_t is_one : asked<std::uint8_t>("way_mask")) {
            const std::size_t at = 3 * rows.size();
            if (is_one != 0) rows.push_back({values.at(at), values.at(at + 1), values.at(at + 2)});
        }
        return rows;
    }
    std::vector<std::uint8_t> way_choices() {
        const auto mask = asked<std::uint8_t>("action_mask");
        return {mask.end() - 1 - offered, mask.end()};
    }
    /// The edges that a choice leads to.
    std::vector<core::EdgeIndex> taken(policy::Agent& agent, std::int32_t way) {
        const auto leases = act(agent, way);
        EXPECT_EQ(leases.size(), 1U);
        return leases.empty() ? std::vector<core::EdgeIndex>{}
                              : std::get<traffic::TakeRoute>(leases.front().action).edges;
    }

    python::Channel channel;
    policy::AgentScore score;
    std::uint32_t offered = 0;
};

TEST_F(AgentWays, are_the_fastest_with_time_length_and_what_they_share) {
    policy::Agent agent = make(4);
    EXPECT_TRUE(act(agent).empty()) << "0 keeps the way";
    const std::vector<Way> found = ways();
    ASSERT_GE(found.size(), 2U);
    EXPECT_TRUE(std::ranges::is_sorted(found, {}, &Way::time_s));
    const auto present = std::ranges::find(found, 1.0F, &Way::common_share);
    ASSERT_NE(present, found.end());
    const std::vector<core::EdgeIndex> route = edges({"left0A0", "A0B0", "B0B1", "B1right1"});
    EXPECT_NEAR(present->length_m, roads::route_length(short_square(), route).value - 20.0, 0.1);
    const std::int32_t number = 1 + static_cast<std::int32_t>(present - found.begin());
    EXPECT_EQ(taken(agent, number), route);
}

TEST_F(AgentWays, make_a_lease_for_the_one_that_is_chosen) {
    policy::Agent agent = make(2);
    act(agent);
    const std::vector<Way> found = ways();
    ASSERT_EQ(found.size(), 2U);
    const std::int32_t other = found[0].common_share < 1.0F ? 1 : 2;
    const float left_m = length_m("left0A0") - 20.0F;
    const float common_m = left_m + length_m("B1right1");
    EXPECT_NEAR(found[static_cast<std::size_t>(other) - 1].common_share,
                common_m / (common_m + length_m("A0A1") + length_m("A1B1")), 1e-4);
    const auto leases = act(agent, other);
    ASSERT_EQ(leases.size(), 1U);
    EXPECT_EQ(std::get<core::VehicleKey>(leases.front().target), ev);
    EXPECT_EQ(leases.front().beneficiary, ev);
    EXPECT_STREQ(leases.front().policy, "agent");
    EXPECT_EQ(std::get<traffic::TakeRoute>(leases.front().action).edges,
              edges({"left0A0", "A0A1", "A1B1", "B1right1"}));
}

TEST_F(AgentWays, lead_round_a_queue_that_is_seen_and_round_a_closed_road) {
    add_queue();
    policy::Agent agent = make(2);
    for (int decision = 0; decision < 60; ++decision)
        act(agent);
    EXPECT_EQ(taken(agent, 1), edges({"left0A0", "A0A1", "A1B1", "B1right1"}));
    EXPECT_LT(ways().at(0).common_share, 1.0F);
    scene.belief().incidents = {{edge("A1B1"), true, 0.0F}};
    act(agent);
    ASSERT_FALSE(ways().empty());
    const auto count = static_cast<std::int32_t>(ways().size());
    for (std::int32_t number = 1; number <= count; ++number)
        EXPECT_THAT(taken(agent, number), ::testing::Not(::testing::Contains(edge("A1B1"))));
}

TEST_F(AgentWays, begin_at_the_last_turn_that_can_be_made) {
    scene.belief().own_states.front().state.lane_position_m = 185.0F;
    policy::Agent agent = make(3);
    act(agent);
    const auto count = static_cast<std::int32_t>(ways().size());
    ASSERT_GE(count, 1);
    for (std::int32_t number = 1; number <= count; ++number)
        EXPECT_EQ(taken(agent, number)[1], edge("A0B0"));
}

TEST_F(AgentWays, that_are_not_there_do_nothing_and_are_counted) {
    scene.remove(ev);
    ev = scene.add({"r", VehicleClass::emergency, {"B1right1"}, 0, 20.0, 10.0});
    policy::Agent agent = make(2);
    for (const std::int32_t wrong : {1, 2, 3, -1}) {
        EXPECT_TRUE(act(agent, wrong).empty()) << wrong;
        EXPECT_THAT(way_choices(), ::testing::ElementsAre(1, 0, 0)) << "no turn is left";
        act(agent);
        EXPECT_EQ(asked<std::uint32_t>("flags")[1], 1U) << wrong;
    }
    EXPECT_THAT(asked<float>("ways"), ::testing::Each(0.0F));
}

TEST_F(AgentWays, are_left_out_where_none_are_wanted) {
    policy::Agent without = make(0);
    act(without);
    EXPECT_TRUE(asked<float>("ways").empty());
    EXPECT_TRUE(asked<std::uint8_t>("way_mask").empty());
    const auto mask = asked<std::uint8_t>("action_mask");
    policy::Agent with = make(2);
    act(with);
    EXPECT_EQ(asked<std::uint8_t>("action_mask").size(), mask.size() + 3);
}

TEST_F(AgentWays, of_more_than_eight_are_refused) {
    EXPECT_EQ(policy::agent_sizes(short_square(), 8).ways, 8U);
    try {
        policy::agent_sizes(short_square(), 9);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("0 to 8"));
    }
}

}  // namespace
}  // namespace clearway::testing
