// What becomes of requests on their way to vehicles and signals.
#include "pipeline/requests.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "support/ascii_scene.hpp"

namespace clearway::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr const char* road = R"(
    10 m per cell, limit 10 m/s, speed 5 m/s
    e...a...a...h...a...|r....
)";

traffic::Lease lease(traffic::Target target, traffic::Action action, core::VehicleKey beneficiary) {
    return {target, std::move(action), core::Seconds(200.0), 0, "part", "reason", beneficiary};
}

/// Requests of e1 on the road, with leases given by hand.
class OneRoad {
  public:
    explicit OneRoad(const std::string& failure, const char* drawing = road) : scene(drawing) {
        experiment::ConditionSpec condition;
        condition.failure = failure;
        requests_.emplace(condition, ChainContext{.network = scene.network()});
    }

    /// e1 asks these vehicles to hold their lane, `at_s` seconds after the start.
    void ask(const std::vector<std::string>& vehicles, double at_s = 0.0) {
        std::vector<traffic::Lease> leases;
        for (const std::string& id : vehicles)
            leases.push_back(lease(scene.key(id), traffic::HoldLane{}, scene.key("e1")));
        decide(leases, at_s);
    }
    void decide(const std::vector<traffic::Lease>& leases, double at_s = 0.0) {
        step({leases, unreachable, true, decided_there}, at_s);
    }
    void wait(double at_s) { step({}, at_s); }

    std::vector<std::string> arrived() const { return ids(requests_->arrived()); }
    std::vector<std::string> lost() const { return ids(requests_->lost()); }
    std::vector<std::string> outdated() const { return ids(requests_->outdated()); }
    const traffic::RequestCounts& counts() const { return requests_->counts(); }

    support::Scene scene;
    std::vector<core::VehicleKey> unreachable;
    std::vector<std::string_view> decided_there;

  private:
    void step(const Requests::Decision& decision, double at_s) {
        scene.snapshot().time = core::Seconds(100.0 + at_s);
        requests_->step(decision, scene.snapshot(), scene.roster());
    }
    std::vector<std::string> ids(std::span<const traffic::Lease> leases) const {
        std::vector<std::string> names;
        for (const traffic::Lease& one : leases) {
            const auto* const vehicle = std::get_if<core::VehicleKey>(&one.target);
            names.push_back(vehicle != nullptr ? scene.id(*vehicle) : "signal");
        }
        return names;
    }

    std::optional<Requests> requests_;
};

TEST(Requests, ReachWhoStandsBesideTheRoadAsFarAsTheChannelDoes) {
    const core::VehicleKey parked = core::vehicle_key("parked");
    const auto heard_at = [&](float away_m) {
        OneRoad one("perfect,request_propagation=sharp,request_range_m=50");
        truth::Snapshot& snapshot = one.scene.snapshot();
        const auto sender = *snapshot.row_of(one.scene.key("e1"));
        traffic::MotionState state = snapshot.motion(sender);
        state.x_m += away_m;
        snapshot.beside_road = {{parked, traffic::VehicleClass::automated, state}};
        one.decide({lease(parked, traffic::PullAside{}, one.scene.key("e1"))});
        EXPECT_EQ(one.counts().sent, 1u);
        return one.counts().heard;
    };
    EXPECT_EQ(heard_at(49.0F), 1u);
    EXPECT_EQ(heard_at(51.0F), 0u);
}

TEST(Requests, DoNotReachAVehicleThatIsNeitherOnTheRoadNorBesideIt) {
    OneRoad one("perfect,request_propagation=sharp,request_range_m=50");
    one.decide({lease(core::vehicle_key("gone"), traffic::PullAside{}, one.scene.key("e1"))});
    EXPECT_EQ(one.counts().heard, 0u);
}

TEST(Requests, ThatArePerfectArriveAtOnceInTheirOrder) {
    OneRoad one("perfect");
    one.ask({"a3", "a1", "h1"});
    EXPECT_THAT(one.arrived(), ElementsAre("a3", "a1", "h1"));
    EXPECT_THAT(one.lost(), IsEmpty());
    EXPECT_EQ(one.counts().sent, 3u);
    EXPECT_EQ(one.counts().heard, 3u);
    EXPECT_EQ(one.counts().messages, 1u) << "one message carries all requests of a decision";
    EXPECT_EQ(one.counts().vehicles_asked, 3u);
    one.wait(0.5);
    EXPECT_THAT(one.arrived(), IsEmpty());
}

TEST(Requests, ReachOnlyThoseWithinTheRange) {
    OneRoad one("perfect,request_propagation=sharp,request_range_m=50");
    one.ask({"a1", "a2", "a3"});
    EXPECT_THAT(one.arrived(), ElementsAre("a1"));
    EXPECT_THAT(one.lost(), ElementsAre("a2", "a3"));
    EXPECT_EQ(one.counts().sent, 3u);
    EXPECT_EQ(one.counts().heard, 1u);
}

TEST(Requests, AreSentOnByAutomatedVehiclesAlone) {
    OneRoad two("perfect,request_propagation=sharp,request_range_m=50,request_hops=2");
    two.ask({"a1", "a2", "a3"});
    EXPECT_THAT(two.arrived(), ElementsAre("a1", "a2"));
    EXPECT_EQ(two.counts().relayed, 1u);
    EXPECT_EQ(two.counts().messages, 2u) << "e1 and a1";
    OneRoad five("perfect,request_propagation=sharp,request_range_m=50,request_hops=5");
    five.ask({"a2", "h1", "a3"});
    EXPECT_THAT(five.arrived(), ElementsAre("a2", "h1"));
    EXPECT_THAT(five.lost(), ElementsAre("a3")) << "h1, a human driver, sends nothing on";
}

TEST(Requests, LoseTheShareOfWaysThatIsSetAndNothingElse) {
    const auto lost_of = [](const std::string& failure, const traffic::Action& action) {
        OneRoad one(failure);
        std::size_t lost = 0;
        for (int decision = 0; decision < 200; ++decision) {
            one.decide({lease(one.scene.key("e1"), action, one.scene.key("e1"))}, decision);
            EXPECT_EQ(one.lost().size() + one.arrived().size(), 1u);
            lost += one.lost().size();
        }
        return lost;
    };
    EXPECT_EQ(lost_of("perfect", traffic::TakeRoute{}), 0u);
    EXPECT_EQ(lost_of("perfect,way_loss_rate=1", traffic::TakeRoute{}), 200u);
    EXPECT_NEAR(static_cast<double>(lost_of("perfect,way_loss_rate=0.3", traffic::TakeRoute{})), 60.0, 20.0);
    EXPECT_EQ(lost_of("perfect,way_loss_rate=1", traffic::HoldLane{}), 0u);
}

TEST(Requests, NeedNoMessageForWhatAVehicleDecidesItself) {
    OneRoad deaf("perfect,request_propagation=sharp,request_loss_rate=1");
    deaf.decide({lease(deaf.scene.key("e1"), traffic::ChangeLane{1}, deaf.scene.key("e1")),
                 lease(deaf.scene.key("a1"), traffic::DriveAt{core::MetresPerSecond(5.0)}, {}),
                 lease(deaf.scene.key("a2"), traffic::HoldLane{}, deaf.scene.key("e1"))});
    EXPECT_THAT(deaf.arrived(), ElementsAre("e1", "a1"));
    EXPECT_THAT(deaf.lost(), ElementsAre("a2"));
    EXPECT_EQ(deaf.counts().sent, 1u);
}

TEST(Requests, ArriveAfterTheLatencyOfEachHop) {
    OneRoad late("perfect,request_propagation=sharp,request_range_m=50,request_hops=2,request_latency_s=0.5");
    late.ask({"a1", "a2"});
    EXPECT_THAT(late.arrived(), IsEmpty());
    late.wait(0.5);
    EXPECT_THAT(late.arrived(), ElementsAre("a1"));
    late.wait(1.0);
    EXPECT_THAT(late.arrived(), ElementsAre("a2"));
    late.wait(1.5);
    EXPECT_THAT(late.arrived(), IsEmpty());
}

TEST(Requests, WaitForTheNextMessage) {
    OneRoad slow("perfect,request_propagation=sharp,request_interval_s=2");
    slow.ask({"a1"});
    EXPECT_THAT(slow.arrived(), ElementsAre("a1"));
    slow.ask({"a1"}, 0.5);
    EXPECT_THAT(slow.arrived(), IsEmpty());
    EXPECT_EQ(slow.counts().sent, 1u);
    EXPECT_EQ(slow.counts().missed, 0u) << "no message was due";
    slow.ask({"a1"}, 2.0);
    EXPECT_THAT(slow.arrived(), ElementsAre("a1"));
    EXPECT_EQ(slow.counts().sent, 2u);
    EXPECT_EQ(slow.counts().vehicles_asked, 1u) << "the same vehicle twice";
}

TEST(Requests, ThatArriveAfterANewerOneAreOutdated) {
    OneRoad late("perfect,request_propagation=sharp,request_range_m=50,request_hops=2,request_latency_s=1");
    late.ask({"a2"});  // 80 m away: a1 sends it on
    late.scene.snapshot().x_m[late.scene.row("e1")] += 40.0F;
    late.ask({"a2"}, 0.5);
    late.wait(1.5);
    EXPECT_THAT(late.arrived(), ElementsAre("a2")) << "the second, without a relay";
    late.wait(2.0);
    EXPECT_THAT(late.arrived(), IsEmpty());
    EXPECT_THAT(late.outdated(), ElementsAre("a2")) << "the first";
    late.wait(2.5);
    EXPECT_THAT(late.outdated(), IsEmpty());
}

TEST(Requests, ThatArriveAfterANewerOneOfAnotherPolicyAreNot) {
    OneRoad late("perfect,request_propagation=sharp,request_range_m=50,request_hops=2,request_latency_s=1");
    late.ask({"a2"});
    late.scene.snapshot().x_m[late.scene.row("e1")] += 40.0F;
    traffic::Lease other = lease(late.scene.key("a2"), traffic::HoldLane{}, late.scene.key("e1"));
    other.policy = "other part";
    late.decide({other}, 0.5);
    late.wait(1.5);
    EXPECT_THAT(late.arrived(), ElementsAre("a2"));
    late.wait(2.0);
    EXPECT_THAT(late.arrived(), ElementsAre("a2"));
    EXPECT_THAT(late.outdated(), IsEmpty());
}

TEST(Requests, UseUpTheMessageOfAnIntervalWhenThereIsSomethingToSend) {
    OneRoad slow("perfect,request_propagation=sharp,request_interval_s=2");
    slow.decide({}, 0.0);
    slow.ask({"a1"}, 0.5);
    EXPECT_THAT(slow.arrived(), ElementsAre("a1")) << "nothing was sent before";
    EXPECT_EQ(slow.counts().needed, 1u);
    slow.ask({"a1"}, 1.0);
    EXPECT_THAT(slow.arrived(), IsEmpty());
    slow.ask({"a1"}, 2.0);
    EXPECT_THAT(slow.arrived(), ElementsAre("a1"));
    EXPECT_EQ(slow.counts().messages, 2u);
}

TEST(Requests, OfTwoEmergencyVehiclesHaveAMessageEach) {
    OneRoad slow("perfect,request_propagation=sharp,request_interval_s=2", R"(
        10 m per cell, limit 10 m/s, speed 5 m/s
        e...a...e...
    )");
    const auto of = [&](const char* sender) {
        return lease(slow.scene.key("a1"), traffic::HoldLane{}, slow.scene.key(sender));
    };
    slow.decide({of("e1")}, 0.0);
    EXPECT_EQ(slow.counts().sent, 1u);
    slow.decide({of("e1"), of("e2")}, 0.5);
    EXPECT_EQ(slow.counts().sent, 2u) << "that of e2";
    slow.decide({of("e1"), of("e2")}, 1.0);
    EXPECT_EQ(slow.counts().sent, 2u);
    slow.decide({of("e1"), of("e2")}, 2.0);
    EXPECT_EQ(slow.counts().sent, 4u);
}

TEST(Requests, ToSignalsUseUpTheMessageOfAnIntervalWhenThereIsSomethingToSend) {
    OneRoad slow(
        "perfect,signal_request_propagation=sharp,signal_request_range_m=300,signal_request_interval_s=2");
    const std::vector<traffic::Lease> green = {
        lease(core::SignalIndex(0), traffic::HoldGreen{{0}}, slow.scene.key("e1"))};
    slow.decide({}, 0.0);
    slow.decide(green, 0.5);
    EXPECT_EQ(slow.counts().signal_sent, 1u);
    slow.decide(green, 1.0);
    EXPECT_EQ(slow.counts().signal_sent, 1u);
    slow.decide(green, 2.0);
    EXPECT_EQ(slow.counts().signal_sent, 2u);
}

TEST(Requests, OfDriversWithoutEquipmentAreLost) {
    OneRoad unequipped("connected_share=0,request_propagation=sharp,request_range_m=200");
    unequipped.ask({"a1", "h1"});
    EXPECT_THAT(unequipped.arrived(), ElementsAre("a1"));
    EXPECT_THAT(unequipped.lost(), ElementsAre("h1"));
}

TEST(Requests, ForVehiclesThatNothingReachesAreLost) {
    OneRoad with_channel("perfect,request_propagation=sharp,request_hops=2,request_range_m=50");
    with_channel.unreachable = {with_channel.scene.key("a1")};
    with_channel.ask({"a1", "a2"});
    EXPECT_THAT(with_channel.lost(), ElementsAre("a1", "a2")) << "what a1 does not hear, it cannot send on";
    // Without a channel, actuation refuses them, with its own reason.
    OneRoad without("perfect");
    without.unreachable = {without.scene.key("a1")};
    without.ask({"a1"});
    EXPECT_THAT(without.arrived(), ElementsAre("a1"));
    EXPECT_EQ(without.counts().heard, 0u);
}

TEST(Requests, AreNotSentByAnEmergencyVehicleWhoseRadioIsSilent) {
    const std::string bursts = "perfect,request_propagation=sharp,request_dark_share=0.9";
    OneRoad dark(bursts);
    OneRoad loud(bursts + ",emergency_dark=no");
    for (int message = 0; message < 400; ++message) {
        dark.ask({"a1"}, 0.5 * message);
        loud.ask({"a1"}, 0.5 * message);
    }
    EXPECT_EQ(loud.counts().sent, 400u);
    EXPECT_LT(dark.counts().sent, 200u);
    EXPECT_EQ(dark.counts().missed, 400u - dark.counts().heard) << "it needed them all the same";
}

TEST(Requests, ToSignalsHaveAChannelOfTheirOwn) {
    OneRoad far("perfect,signal_request_propagation=sharp,signal_request_range_m=150");
    const traffic::Lease green = lease(core::SignalIndex(0), traffic::HoldGreen{{0}}, far.scene.key("e1"));
    const traffic::Lease recovery = lease(core::SignalIndex(0), traffic::AdjustGreen{{0}}, {});
    far.decide({green, recovery});
    EXPECT_THAT(far.lost(), ElementsAre("signal")) << "195 m to the stop line";
    EXPECT_THAT(far.arrived(), ElementsAre("signal")) << "a signal needs no message for itself";
    OneRoad near(
        "perfect,signal_request_propagation=sharp,signal_request_range_m=250,"
        "signal_request_latency_s=1");
    near.decide({lease(core::SignalIndex(0), traffic::HoldGreen{{0}}, near.scene.key("e1"))});
    EXPECT_THAT(near.arrived(), IsEmpty());
    near.wait(1.0);
    EXPECT_THAT(near.arrived(), ElementsAre("signal"));
    EXPECT_EQ(near.counts().signal_heard, 1u);
    EXPECT_EQ(near.counts().sent, 0u);
}

TEST(Requests, ToASignalThatDoesNotExistAreLeftToTheActuatorToRefuse) {
    for (const char* const channel : {"perfect", "perfect,signal_request_propagation=sharp"}) {
        OneRoad one(channel);
        one.decide({lease(core::SignalIndex(77), traffic::HoldGreen{{99}}, one.scene.key("e1"))});
        EXPECT_THAT(one.arrived(), ElementsAre("signal")) << channel;
    }
}

TEST(Requests, ThatSignalsDecidedOnThemselvesNeedNoMessage) {
    OneRoad one("perfect,signal_request_propagation=sharp,signal_request_range_m=10");
    const traffic::Lease green = lease(core::SignalIndex(0), traffic::HoldGreen{{0}}, one.scene.key("e1"));
    one.decide({green});
    EXPECT_THAT(one.arrived(), IsEmpty());
    one.decided_there = {"part"};
    one.decide({green});
    EXPECT_THAT(one.arrived(), ElementsAre("signal"));
    EXPECT_EQ(one.counts().signal_sent, 1u) << "the first";
}

/// A message of e1 to whoever is on its lane from here to there, `at_s` seconds after the start.
traffic::Lease geocast(const OneRoad& one, float from_m, float to_m,
                       traffic::Addressed addressed = traffic::Addressed::automated) {
    const core::LaneIndex lane = one.scene.snapshot().lane[one.scene.row("e1")];
    return lease(traffic::Stretch{.lane = lane, .from_m = from_m, .to_m = to_m, .addressed = addressed},
                 traffic::HoldLane{}, one.scene.key("e1"));
}

TEST(Requests, ToAStretchReachWhoeverIsThereAndHearsThem) {
    OneRoad one("perfect,request_propagation=sharp,request_range_m=100");
    one.decide({geocast(one, 50.0F, 1000.0F)});  // a1 is at 45 m, a2 at 85 m, h1 at 125 m, a3 at 165 m
    EXPECT_THAT(one.arrived(), ElementsAre("a2")) << "a1 is not on the stretch, h1 not addressed";
    EXPECT_THAT(one.lost(), ElementsAre("a3")) << "out of range";
    EXPECT_EQ(one.counts().sent, 2u);
    EXPECT_EQ(one.counts().heard, 1u);
    EXPECT_EQ(one.counts().missed, 1u);
    EXPECT_EQ(one.counts().messages, 1u);
    one.scene.snapshot().speed_mps[one.scene.row("a2")] = 0.0F;
    traffic::Lease to_slow = geocast(one, 0.0F, 1000.0F, traffic::Addressed::drivers);
    std::get<traffic::Stretch>(to_slow.target).below_mps = 2.0F;
    one.decide({to_slow}, 0.5);
    EXPECT_THAT(one.arrived(), ElementsAre("a2")) << "the others drive";
    one.decide({geocast(one, 0.0F, 1000.0F, traffic::Addressed::drivers)}, 1.0);
    EXPECT_THAT(one.arrived(), ElementsAre("a1", "a2"));
    EXPECT_THAT(one.lost(), ElementsAre("h1", "a3"));
}

TEST(Requests, ToAStretchReachWhoStandsBesideIt) {
    OneRoad one("perfect,request_propagation=sharp,request_range_m=100");
    truth::Snapshot& snapshot = one.scene.snapshot();
    traffic::MotionState state = snapshot.motion(one.scene.row("a1"));
    state.speed_mps = 0.0F;
    snapshot.beside_road = {{core::vehicle_key("parked"), traffic::VehicleClass::automated, state}};
    one.decide({geocast(one, 0.0F, 50.0F)});
    EXPECT_EQ(one.counts().heard, 2u) << "a1, and who stands beside it";
    one.decide({geocast(one, 50.0F, 90.0F)}, 0.5);
    EXPECT_EQ(one.counts().heard, 3u) << "a2 alone";
}

TEST(Requests, ToAStretchNeedNobodyThere) {
    OneRoad one("perfect,request_propagation=sharp,request_interval_s=2");
    one.decide({geocast(one, 500.0F, 600.0F)});
    EXPECT_THAT(one.arrived(), IsEmpty());
    EXPECT_EQ(one.counts().messages, 1u) << "it went out all the same";
    EXPECT_EQ(one.counts().sent, 0u);
    one.decide({geocast(one, 0.0F, 600.0F)}, 0.5);
    EXPECT_EQ(one.counts().messages, 1u) << "no message was due";
    one.decide({geocast(one, 0.0F, 600.0F)}, 2.0);
    EXPECT_EQ(one.counts().heard, 3u);
}

TEST(Requests, ToAStretchAreSentOnByThoseWhoHearThem) {
    OneRoad two("perfect,request_propagation=sharp,request_range_m=50,request_hops=2");
    two.decide({geocast(two, 60.0F, 1000.0F)});
    EXPECT_THAT(two.arrived(), ElementsAre("a2")) << "by a1, which is not meant itself";
    EXPECT_EQ(two.counts().relayed, 1u);
}

constexpr const char* queue = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    ..e..a........a....................
    ...................................
)";

/// Requests of a condition's own policy at one moment.
traffic::RequestCounts counts_of(const experiment::ConditionSpec& condition) {
    const support::Scene scene(queue);
    const ChainContext context{.network = scene.network()};
    DecisionChain chain(condition, context);
    Requests requests(condition, context);
    chain.observe(scene.snapshot(), scene.roster());
    chain.decide();
    requests.step({chain.leases(), chain.unreachable(), true}, scene.snapshot(), scene.roster());
    return requests.counts();
}

TEST(Requests, AreComparedWithWhatTheTruthWouldAskFor) {
    experiment::ConditionSpec condition;
    condition.policies = {"clear_lane"};
    const traffic::RequestCounts known = counts_of(condition);
    EXPECT_EQ(known.sent, 2u) << "a1 and a2 leave the lane";
    EXPECT_EQ(known.needed, 2u);
    EXPECT_EQ(known.useless + known.missed, 0u);

    condition.failure = "loss_rate=1";  // Nobody is known, so nobody is asked.
    const traffic::RequestCounts unknown = counts_of(condition);
    EXPECT_EQ(unknown.sent, 0u);
    EXPECT_EQ(unknown.needed, 2u);
    EXPECT_EQ(unknown.missed, 2u);

    condition.failure = "perfect,request_propagation=sharp,request_range_m=50";
    const traffic::RequestCounts unheard = counts_of(condition);
    EXPECT_EQ(unheard.sent, 2u);
    EXPECT_EQ(unheard.heard, 1u) << "a2 is 120 m away";
    EXPECT_EQ(unheard.missed, 1u);

    condition.failure = "perfect";
    condition.predictor = "oracle";
    condition.settings = {{"clear_lane.ask", "linked"}, {"oracle.false_links", "0.9"}};
    const traffic::RequestCounts false_links = counts_of(condition);
    EXPECT_EQ(false_links.needed, 1u) << "in truth a1 alone is linked";
    EXPECT_EQ(false_links.useless, false_links.sent - 1u);
}

TEST(Requests, OfThoseWhoSendNothingAreMissedOnceAnInterval) {
    experiment::ConditionSpec condition;
    condition.policies = {"clear_lane"};
    condition.failure = "loss_rate=1,request_propagation=sharp,request_interval_s=2";
    support::Scene scene(queue);
    const ChainContext context{.network = scene.network()};
    Requests requests(condition, context);
    for (const double at_s : {0.0, 0.5, 1.0, 1.5}) {
        scene.snapshot().time = core::Seconds(100.0 + at_s);
        requests.step({.leases = {}, .unreachable = {}, .is_new = true}, scene.snapshot(), scene.roster());
    }
    EXPECT_EQ(requests.counts().needed, 2u) << "a1 and a2";
    EXPECT_EQ(requests.counts().missed, 2u);
}

TEST(Requests, OfAGeocastNeedNobodyToBeKnown) {
    experiment::ConditionSpec condition;
    condition.policies = {"geocast"};
    condition.failure = "loss_rate=1,request_propagation=sharp,request_range_m=100";
    const traffic::RequestCounts counts = counts_of(condition);
    EXPECT_EQ(counts.sent, 2u) << "a1 and a2 are on the left lane";
    EXPECT_EQ(counts.heard, 1u) << "a2 is 120 m away";
    EXPECT_EQ(counts.needed, 2u);
    EXPECT_EQ(counts.useless, 0u);
    EXPECT_EQ(counts.messages, 1u);
}

TEST(Requests, OfADarkEmergencyVehicleThatAsksTheLinkedAreNone) {
    experiment::ConditionSpec condition;
    condition.policies = {"clear_lane"};
    condition.settings = {{"clear_lane.ask", "linked"}};
    condition.failure = "loss_rate=1,connected_share=1";
    EXPECT_EQ(counts_of(condition).sent, 0u);
    condition.failure = "loss_rate=1,emergency_dark=no";
    EXPECT_EQ(counts_of(condition).sent, 0u) << "it is heard, but the others are not";
}

}  // namespace
}  // namespace clearway::pipeline
