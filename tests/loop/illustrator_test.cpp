#include "loop/illustrator.hpp"

#include <algorithm>
#include <map>

#include <gmock/gmock.h>

#include "support/ascii_scene.hpp"
#include "truth/events.hpp"
#include "truth/snapshot.hpp"

namespace clearway::loop {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

/// A road with a signal; everybody reports and is believed where it is, until a test says otherwise.
class IllustratorTest : public testing::Test {
  protected:
    IllustratorTest() {
        observation_.is_report = true;
        belief_.roster = &scene_.roster();
        belief_.first_link = {0};
        for (core::VehicleIndex row = 0; row < scene_.snapshot().size(); ++row) {
            traffic::ObservedVehicle seen;
            seen.key = scene_.snapshot().key[row];
            observation_.vehicles.push_back(seen);
            traffic::BelievedVehicle believed;
            believed.key = seen.key;
            belief_.vehicles.push_back(believed);
        }
    }

    const sumo::Drawing& draw(std::vector<traffic::Command> commands = {}) {
        commands_ = std::move(commands);
        trace::RecordedStep step{&scene_.snapshot(), &scene_.roster(), &events_};
        step.observation = &observation_;
        if (belief_.first_link.size() == belief_.vehicles.size() + 1) step.belief = &belief_;
        step.commands = commands_;
        return illustrator_.draw(step);
    }

    /// Everybody is linked with everybody.
    void link_all() {
        const auto count = static_cast<core::VehicleIndex>(belief_.vehicles.size());
        for (core::VehicleIndex row = 0; row < count; ++row) {
            for (core::VehicleIndex other = 0; other < count; ++other) {
                if (other != row) belief_.links.push_back({.neighbour = other});
            }
            belief_.first_link.push_back(static_cast<std::uint32_t>(belief_.links.size()));
        }
    }

    void silence(const std::string& id) {
        observation_.vehicles[scene_.row(id)].freshness = traffic::Freshness::stale;
    }

    sumo::Colour colour_of(const std::string& id) {
        for (const auto& [key, colour] : draw().vehicles) {
            if (key == scene_.key(id)) return colour;
        }
        return {};
    }

    support::Scene scene_{R"(
        10 m per cell, limit 20 m/s
        ..h..a...|G....h
        ..e...a..|G.....
    )"};
    truth::Events events_;
    traffic::Observation observation_;
    traffic::BelievedGraph belief_;
    std::vector<traffic::Command> commands_;
    Illustrator illustrator_{scene_.network()};
};

TEST_F(IllustratorTest, GivesEachClassAColourAndAnotherToThoseWhoDidNotReport) {
    const sumo::Colour emergency = colour_of("e1");
    const sumo::Colour automated = colour_of("a1");
    EXPECT_NE(emergency, automated);
    EXPECT_NE(automated, colour_of("h1"));
    EXPECT_EQ(colour_of("h1"), colour_of("h2"));
    EXPECT_EQ(colour_of("a1"), colour_of("a2"));
    silence("a1");
    EXPECT_NE(colour_of("a1"), automated);
    EXPECT_EQ(colour_of("a2"), automated);
    observation_.vehicles.erase(observation_.vehicles.begin() + scene_.row("e1"));  // never seen
    EXPECT_NE(colour_of("e1"), emergency);
    observation_.is_report = false;
    observation_.vehicles.clear();
    EXPECT_EQ(colour_of("a2"), automated) << "nobody is silent between two rounds of reports";
}

TEST_F(IllustratorTest, DrawsLinksBetweenTheMiddlesOfVehiclesAndMarksThoseWithADarkEnd) {
    EXPECT_THAT(draw().strokes, IsEmpty());
    link_all();
    const std::vector<sumo::Stroke> all = draw().strokes;
    EXPECT_THAT(all, SizeIs(10)) << "five vehicles, each pair once";
    const core::VehicleIndex row = scene_.row("e1");
    const float length_m = scene_.roster().find(scene_.key("e1"))->length_m;
    const sumo::Spot middle{scene_.snapshot().x_m[row] - length_m / 2.0, scene_.snapshot().y_m[row]};
    EXPECT_EQ(std::ranges::count_if(all,
                                    [&](const sumo::Stroke& stroke) {
                                        return std::ranges::find(stroke.points, middle) !=
                                               stroke.points.end();
                                    }),
              4);
    silence("h1");
    const std::vector<sumo::Stroke> some = draw().strokes;
    EXPECT_EQ(std::ranges::count(some, all.front().colour, &sumo::Stroke::colour), 6);
}

TEST_F(IllustratorTest, DrawsNoLinksWhereNoEmergencyVehicleIs) {
    link_all();
    std::ranges::fill(scene_.snapshot().vehicle_class, traffic::VehicleClass::human);
    EXPECT_THAT(draw().strokes, IsEmpty());
}

TEST_F(IllustratorTest, RingsASignalAsLongAsItIsHeld) {
    const core::SignalIndex signal{0};
    const std::vector<sumo::Stroke> held = draw({traffic::SetSignalState{signal, "GGr"}}).strokes;
    ASSERT_THAT(held, SizeIs(1));
    EXPECT_EQ(held[0].points.front(), held[0].points.back());
    for (const std::vector<roads::SignalLink>& ways : scene_.network().signal(signal).links) {
        const roads::Point stop_line = scene_.network().lane(ways.at(0).from).shape.back();
        const auto [left, right] = std::ranges::minmax(held[0].points, {}, &sumo::Spot::x_m);
        EXPECT_GT(stop_line.x_m, left.x_m);
        EXPECT_LT(stop_line.x_m, right.x_m);
    }
    EXPECT_THAT(draw().strokes, SizeIs(1)) << "nobody gave it back";
    EXPECT_THAT(draw({traffic::RestoreProgram{signal}}).strokes, IsEmpty());
}

TEST_F(IllustratorTest, FollowsOneEmergencyVehicleUntilItHasLeft) {
    EXPECT_EQ(draw().followed, scene_.key("e1"));
    scene_.snapshot().vehicle_class[scene_.row("a1")] = traffic::VehicleClass::emergency;
    EXPECT_EQ(draw().followed, scene_.key("e1"));
    scene_.snapshot().key[scene_.row("e1")].value += 1;  // another one in its place
    EXPECT_NE(draw().followed, scene_.key("e1"));
}

}  // namespace
}  // namespace clearway::loop
