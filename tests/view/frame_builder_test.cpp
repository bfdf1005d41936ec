#include "view/frame_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/ascii_scene.hpp"
#include "truth/events.hpp"
#include "view/dark_vehicles.hpp"

namespace clearway::view {
namespace {

using support::Scene;
using ::testing::ElementsAre;
using ::testing::SizeIs;

/// 10 m a cell: e1 at 25 m, a1 at 65 m, h1 at 105 m on one lane, then a signal at 150 m.
constexpr const char* street = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    ..e...a...h....|r.....
)";

class FrameBuilderTest : public ::testing::Test {
  protected:
    FrameBuilderTest() : scene_(street), builder_(origin_of(scene_.network()), graph::LinkRules{}) {}

    trace::RecordedStep step() {
        return {&scene_.snapshot(), &scene_.roster(), &events_, nullptr, nullptr, {}};
    }
    const Frame& frame(const trace::RecordedStep& step) {
        builder_.look(step);
        const Frame& frame = builder_.frame(step);
        names_ = builder_.take_names();
        ids_.insert(ids_.end(), names_.vehicles.begin(), names_.vehicles.end());
        return frame;
    }
    std::string id(Slot slot) const { return ids_.at(slot).id; }
    traffic::Lease hold(std::vector<std::uint16_t> links, double until_s) const {
        return {.target = core::SignalIndex{0},
                .action = traffic::HoldGreen{std::move(links), {}},
                .expiry = core::Seconds(until_s),
                .policy = "green_wave",
                .reason = "the ambulance comes",
                .beneficiary = scene_.key("e1")};
    }
    std::vector<std::pair<std::string, std::string>> ends(const std::vector<Link>& links) const {
        std::vector<std::pair<std::string, std::string>> named;
        for (const Link& link : links)
            named.emplace_back(std::minmax(id(link.one), id(link.other)));
        std::ranges::sort(named);
        return named;
    }

    Scene scene_;
    truth::Events events_;
    FrameBuilder builder_;
    Names names_;
    std::vector<NamedVehicle> ids_;
};

TEST_F(FrameBuilderTest, vehicles_are_where_they_are_to_five_centimetres) {
    const Origin origin = origin_of(scene_.network());
    const Frame& shown = frame(step());
    ASSERT_THAT(shown.vehicles, SizeIs(3));
    for (const SeenVehicle& vehicle : shown.vehicles) {
        const core::VehicleIndex row = scene_.row(id(vehicle.slot));
        EXPECT_NEAR(origin.x_m + vehicle.x * quantum_m, scene_.snapshot().x_m[row], 0.051);
        EXPECT_NEAR(origin.y_m + vehicle.y * quantum_m, scene_.snapshot().y_m[row], 0.051);
        EXPECT_EQ(vehicle.speed, 150);
        EXPECT_EQ(vehicle.heading, 0);
        EXPECT_FALSE(vehicle.dark);
    }
    EXPECT_EQ(shown.signals.at(0).at(0), 'r');
}

TEST_F(FrameBuilderTest, links_are_those_that_are_true_observed_and_believed) {
    traffic::Observation observation = support::perfect_observation(scene_);
    observation.is_report = true;
    for (traffic::ObservedVehicle& vehicle : observation.vehicles) {
        if (vehicle.key == scene_.key("h1")) vehicle.freshness = traffic::Freshness::stale;
    }
    const traffic::BelievedGraph belief = support::perfect_belief(scene_);
    trace::RecordedStep now = step();
    now.observation = &observation;
    now.belief = &belief;
    const Frame& shown = frame(now);
    using Ends = std::pair<std::string, std::string>;
    EXPECT_THAT(ends(shown.links[0]), ElementsAre(Ends("a1", "e1"), Ends("a1", "h1")));
    EXPECT_THAT(ends(shown.links[1]), ElementsAre(Ends("a1", "e1")));
    EXPECT_THAT(ends(shown.links[2]), ElementsAre(Ends("a1", "e1"), Ends("a1", "h1")));
    ASSERT_THAT(shown.ghosts, SizeIs(1));
    EXPECT_EQ(id(shown.ghosts[0].slot), "h1");
    for (const SeenVehicle& vehicle : shown.vehicles)
        EXPECT_EQ(vehicle.dark, id(vehicle.slot) == "h1");
}

TEST_F(FrameBuilderTest, a_hold_is_marked_when_it_is_asked_for_and_when_it_is_granted) {
    const std::vector<traffic::Lease> leases = {hold({0}, 110.0)};
    trace::RecordedStep now = step();
    now.leases = leases;
    const Frame& asked = frame(now);
    ASSERT_THAT(asked.marks, SizeIs(1));
    EXPECT_EQ(asked.marks[0].kind, MarkKind::request);
    EXPECT_EQ(id(asked.marks[0].vehicle - 1), "e1");
    EXPECT_EQ(asked.marks[0].other, 1U);
    ASSERT_THAT(asked.leases, SizeIs(1));
    EXPECT_EQ(names_.texts.at(asked.leases[0].reason), "the ambulance comes");

    scene_.pass(core::Seconds(1.0));
    EXPECT_THAT(frame(now).marks, SizeIs(0)) << "a renewal is no request";

    scene_.snapshot().signals.state[0][0] = 'G';
    const Frame& granted = frame(now);
    ASSERT_THAT(granted.marks, SizeIs(1));
    EXPECT_EQ(granted.marks[0].kind, MarkKind::grant);

    scene_.pass(core::Seconds(20.0));
    const Frame& over = frame(step());
    EXPECT_THAT(over.leases, SizeIs(0)) << "it ended by itself";
}

TEST_F(FrameBuilderTest, a_lease_for_a_stretch_of_road_is_shown_where_vehicles_are_on_it) {
    const core::VehicleIndex row = scene_.row("a1");
    const float at_m = scene_.snapshot().lane_position_m[row];
    const auto message = [&](float from_m) {
        return traffic::Lease{traffic::Stretch{scene_.snapshot().lane[row], from_m, 2000.0F},
                              traffic::HoldLane{},
                              core::Seconds(scene_.snapshot().time.value + 5.0),
                              0,
                              "geocast",
                              "cleared",
                              scene_.key("e1")};
    };
    // Two messages, as an emergency vehicle on its way sends them.
    const std::vector<traffic::Lease> leases = {message(at_m - 2.0F), message(at_m - 1.0F)};
    trace::RecordedStep now = step();
    now.leases = leases;
    const Frame& asked = frame(now);
    ASSERT_THAT(asked.leases, SizeIs(1)) << "h1 is a human driver, and not addressed";
    EXPECT_FALSE(asked.leases[0].on_signal);
    EXPECT_EQ(id(asked.leases[0].target), "a1");

    scene_.snapshot().lane_position_m[row] = at_m - 5.0F;
    EXPECT_THAT(frame(step()).leases, SizeIs(0)) << "it is not there any more";
}

TEST_F(FrameBuilderTest, marks_between_two_frames_are_kept_for_the_next) {
    events_.emergency_brakings = {{scene_.key("h1"), 8.0F}};
    truth::Collision collision;
    collision.collider = scene_.key("a1");
    collision.victim = scene_.key("h1");
    events_.collisions = {collision};
    builder_.look(step());
    events_.clear();
    scene_.pass(core::Seconds(0.25));
    const Frame& shown = frame(step());
    ASSERT_THAT(shown.marks, SizeIs(2));
    EXPECT_EQ(shown.marks[0].kind, MarkKind::braking);
    EXPECT_EQ(shown.marks[0].time_s, 100.0);
    EXPECT_EQ(shown.marks[1].kind, MarkKind::collision);
    EXPECT_EQ(id(shown.marks[1].vehicle - 1), "a1");
    EXPECT_EQ(id(shown.marks[1].other - 1), "h1");
}

TEST_F(FrameBuilderTest, the_way_of_an_emergency_vehicle_is_shown_and_the_one_that_it_takes_instead) {
    traffic::Roster roster = scene_.roster();
    const std::vector<core::EdgeIndex> planned = roster.route(roster.find(scene_.key("e1"))->route);
    trace::RecordedStep now = step();
    now.roster = &roster;
    const auto edges_of = [](const std::vector<core::EdgeIndex>& way) {
        std::vector<std::uint32_t> edges;
        for (const core::EdgeIndex edge : way)
            edges.push_back(edge.value);
        return edges;
    };
    const Frame& first = frame(now);
    ASSERT_THAT(first.ways, SizeIs(1)) << "those of others are nobody's concern";
    EXPECT_EQ(id(first.ways[0].slot), "e1");
    EXPECT_EQ(first.ways[0].at, scene_.snapshot().route_edge[scene_.row("e1")]);
    EXPECT_EQ(first.ways[0].way, 0U);
    EXPECT_THAT(names_.ways, ElementsAre(edges_of(planned)));

    EXPECT_EQ(frame(now).ways[0].way, 0U);
    EXPECT_THAT(names_.ways, SizeIs(0)) << "a way is named once";

    const std::vector<core::EdgeIndex> other = {planned.front(), core::EdgeIndex{planned.front().value + 7}};
    roster.set_route(scene_.key("e1"), roster.add_route(other));
    EXPECT_EQ(frame(now).ways[0].way, 1U);
    EXPECT_THAT(names_.ways, ElementsAre(edges_of(other)));
}

TEST_F(FrameBuilderTest, a_way_that_was_considered_is_named_once_and_its_lease_tells_the_number) {
    const core::VehicleKey ev = scene_.key("e1");
    const auto considers = [&](std::vector<core::EdgeIndex> way, double for_s) {
        return traffic::Lease{ev,
                              traffic::StandBack{std::move(way)},
                              core::Seconds(scene_.snapshot().time.value + for_s),
                              0,
                              "navigate",
                              "faster",
                              ev};
    };
    const core::EdgeIndex here{0}, next{5}, aside{9}, other{8};
    std::vector<traffic::Lease> leases = {considers({here, next, aside}, 1.0)};
    trace::RecordedStep now = step();
    now.leases = leases;
    const Frame& first = frame(now);
    ASSERT_THAT(first.leases, SizeIs(1));
    EXPECT_EQ(first.leases[0].amount, 2) << "way 1; 0 is its own";
    ASSERT_THAT(names_.ways, SizeIs(2));
    EXPECT_THAT(names_.ways[1], ElementsAre(0, 5, 9));

    leases = {considers({next, aside}, 1.0)};
    now.leases = leases;
    EXPECT_EQ(frame(now).leases[0].amount, 2) << "further on it is the same way";
    EXPECT_THAT(names_.ways, SizeIs(0));

    leases = {considers({next, other}, 1.0)};
    now.leases = leases;
    EXPECT_EQ(frame(now).leases[0].amount, 3);
    leases = {considers({}, 1.0)};
    now.leases = leases;
    EXPECT_EQ(frame(now).leases[0].amount, 0);
    scene_.pass(core::Seconds(2.0));
    EXPECT_THAT(frame(step()).leases, SizeIs(0));
}

TEST_F(FrameBuilderTest, a_blocked_road_is_known_from_the_report_that_knows_it_to_the_one_that_does_not) {
    traffic::Observation observation = support::perfect_observation(scene_);
    observation.is_report = true;
    trace::RecordedStep now = step();
    now.observation = &observation;
    EXPECT_THAT(frame(now).known_blocks, SizeIs(0));
    observation.incidents = {{core::EdgeIndex{4}, true, 0.0F}, {core::EdgeIndex{2}, false, 3.0F}};
    EXPECT_THAT(frame(now).known_blocks, ElementsAre(2, 4));
    EXPECT_THAT(frame(step()).known_blocks, ElementsAre(2, 4)) << "between two reports";
    observation.incidents.clear();
    EXPECT_THAT(frame(now).known_blocks, SizeIs(0));
}

TEST_F(FrameBuilderTest, outside_the_area_only_emergency_vehicles_are_shown) {
    FrameBuilder cut(origin_of(scene_.network()), graph::LinkRules{},
                     [](double x_m, double) { return x_m > 100.0; });
    cut.look(step());
    const Frame& shown = cut.frame(step());
    const Names names = cut.take_names();
    std::vector<std::string> ids;
    for (const SeenVehicle& vehicle : shown.vehicles)
        ids.push_back(names.vehicles.at(vehicle.slot).id);
    EXPECT_THAT(ids, ::testing::UnorderedElementsAre("e1", "h1"));
}

}  // namespace
}  // namespace clearway::view
