// Requests of emergency vehicles to signals as messages, and the answers.
#include "pipeline/signal_radio.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "pipeline/decision_chain.hpp"
#include "pipeline/green_watch.hpp"
#include "support/ascii_scene.hpp"

namespace clearway::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using traffic::RequestStatus;
using traffic::RequestType;

constexpr core::SignalIndex signal_0{0};

/// e1 on its way to the stop line, 195 m ahead, with what it sends given by hand: a decision each half
/// second.
class Air {
  public:
    explicit Air(const std::string& failure)
        : scene("10 m per cell, limit 20 m/s, speed 10 m/s\ne...................|G........\n"),
          radio(scene.network(), failures::failure_from(failure), random) {}

    /// What signals hear at this decision while e1 asks the signal, or no longer does.
    std::vector<traffic::PriorityRequest> decide(bool asks = true) {
        std::vector<traffic::PriorityRequest> wanted;
        if (asks) {
            traffic::PriorityRequest request;
            request.vehicle = scene.key("e1");
            request.signal = signal_0;
            request.sent = scene.snapshot().time;
            wanted.push_back(request);
        }
        radio.exchange(wanted, scene.snapshot());
        return {radio.arrived().begin(), radio.arrived().end()};
    }
    /// The signal answers with this status.
    void answer(RequestStatus status) {
        traffic::SignalStatus signal;
        signal.signal = signal_0;
        signal.calls = {{scene.key("e1"), {0}, status}};
        const std::vector<policy::RequestKey> open = {{scene.key("e1"), signal_0}};
        radio.answer(open, std::vector{signal}, scene.snapshot());
    }
    void pass(double time_s = 0.5) { scene.pass(core::Seconds(time_s)); }
    std::uint64_t told(RequestStatus status) const {
        return radio.counts().told[static_cast<std::size_t>(status)];
    }

    support::Scene scene;
    core::KeyedRandom random{core::StudySeed{5}, core::Replication{1}};
    SignalRadio radio;
};

TEST(SignalRadio, SendsARequestThenUpdatesThenThreeCancellations) {
    Air air("perfect");
    std::vector<RequestType> types;
    for (const bool asks : {true, true, true, false, false, false, false}) {
        for (const traffic::PriorityRequest& message : air.decide(asks)) {
            types.push_back(message.type);
            EXPECT_EQ(message.request_id, 1u);
            EXPECT_EQ(message.sequence, types.size());
        }
        air.pass();
    }
    EXPECT_THAT(types,
                ElementsAre(RequestType::request, RequestType::update, RequestType::update,
                            RequestType::cancellation, RequestType::cancellation, RequestType::cancellation));
    EXPECT_EQ(air.radio.counts().sent, 6u);
    EXPECT_EQ(air.radio.counts().updates, 2u);
    EXPECT_EQ(air.radio.counts().cancellations, 3u);
    ASSERT_THAT(air.decide(), SizeIs(1));
    EXPECT_EQ(air.radio.arrived()[0].request_id, 2u) << "another approach";
}

TEST(SignalRadio, ReachesSignalsWithinTheRangeAlone) {
    Air far("perfect,signal_request_propagation=sharp,signal_request_range_m=150");
    EXPECT_THAT(far.decide(), IsEmpty()) << "195 m to the stop line";
    EXPECT_EQ(far.radio.counts().sent, 1u);
    EXPECT_EQ(far.radio.counts().heard, 0u);
    far.pass(5.0);
    EXPECT_THAT(far.decide(), SizeIs(1)) << "145 m";
}

TEST(SignalRadio, DeliversAfterTheLatencyWhatWasTrueWhenItWasSent) {
    Air air("perfect,range_600m,signal_request_latency_s=1");
    EXPECT_THAT(air.decide(), IsEmpty());
    const double sent_s = air.scene.snapshot().time.value;
    air.pass();
    EXPECT_THAT(air.decide(), IsEmpty());
    air.pass();
    ASSERT_THAT(air.decide(), SizeIs(1));
    EXPECT_EQ(air.radio.arrived()[0].sent.value, sent_s);
}

TEST(SignalRadio, WaitsForTheNextMessage) {
    Air air("perfect,range_600m,signal_request_interval_s=1");
    int heard = 0;
    for (int decision = 0; decision < 8; ++decision) {
        heard += static_cast<int>(air.decide().size());
        air.pass();
    }
    EXPECT_EQ(heard, 4);
}

TEST(SignalRadio, LosesTheShareOfRequestsAndOfAnswers) {
    Air air("perfect,Q50");
    air.scene.set_speed("e1", core::MetresPerSecond(0.0));
    constexpr double messages = 2000.0;
    for (int decision = 0; decision < messages; ++decision) {
        air.decide();
        air.answer(RequestStatus::granted);
        air.pass();
    }
    // Standard error 0.011.
    EXPECT_NEAR(static_cast<double>(air.radio.counts().heard) / messages, 0.5, 0.04);
    EXPECT_NEAR(static_cast<double>(air.radio.counts().answers_heard) / messages, 0.5, 0.04);
}

TEST(SignalRadio, CountsWhatAVehicleWasToldOnceForEachRequest) {
    Air air("perfect");
    for (const RequestStatus status : {RequestStatus::processing, RequestStatus::processing,
                                       RequestStatus::granted, RequestStatus::granted}) {
        air.decide();
        air.answer(status);
        air.pass();
    }
    EXPECT_EQ(air.radio.counts().answers_heard, 4u);
    EXPECT_EQ(air.told(RequestStatus::processing), 1u);
    EXPECT_EQ(air.told(RequestStatus::granted), 1u);
    EXPECT_EQ(air.told(RequestStatus::rejected), 0u);
    EXPECT_DOUBLE_EQ(air.radio.counts().until_granted_s, 1.0) << "the third decision";
}

TEST(SignalRadio, SaysRequestedWhileNothingIsDone) {
    Air air("perfect");
    air.decide();
    const std::vector<policy::RequestKey> open = {{air.scene.key("e1"), signal_0}};
    air.radio.answer(open, {}, air.scene.snapshot());
    EXPECT_EQ(air.told(RequestStatus::requested), 1u);
}

/// Leases of preempt_signals while e1 drives up to the line.
std::vector<traffic::Lease> leases_of(const std::string& failure, const core::Settings& settings = {}) {
    support::Scene scene("10 m per cell, limit 20 m/s, speed 10 m/s\ne...................|r........\n");
    experiment::ConditionSpec condition;
    condition.failure = failure;
    condition.policies = {"preempt_signals"};
    condition.settings = settings;
    DecisionChain chain(condition, {.network = scene.network()});
    std::vector<traffic::Lease> leases;
    for (int step = 0; step < 40; ++step) {
        chain.observe(scene.snapshot(), scene.roster());
        if (chain.decision_is_due()) chain.decide();
        leases.insert(leases.end(), chain.leases().begin(), chain.leases().end());
        chain.answer({});
        scene.pass(core::Seconds(0.5));
    }
    return leases;
}

TEST(RequestsByMessage, WithoutLossAndLimitAreThePerfectOnes) {
    const auto perfect = leases_of("perfect");
    ASSERT_FALSE(perfect.empty());
    for (const char* const memory : {"forget", "hold_eta", "dead_reckon", "graph"}) {
        const auto by_message = leases_of("perfect,range_10km", {{"preempt_signals.memory", memory}});
        ASSERT_EQ(by_message.size(), perfect.size()) << memory;
        for (std::size_t row = 0; row < perfect.size(); ++row) {
            EXPECT_EQ(by_message[row].expiry, perfect[row].expiry);
            EXPECT_EQ(by_message[row].target, perfect[row].target);
        }
    }
}

TEST(RequestsByMessage, ThatAreAllLostDoNothing) {
    for (const char* const memory : {"forget", "hold_eta", "dead_reckon", "graph"})
        EXPECT_THAT(leases_of("perfect,Q90,signal_request_loss_rate=1", {{"preempt_signals.memory", memory}}),
                    IsEmpty());
}

/// A held green of e1, which drives on meanwhile.
traffic::HeldGreenCounts watched(double before_s, double green_s, double after_s) {
    support::Scene scene("10 m per cell, limit 20 m/s, speed 10 m/s\ne....|G..........\n");
    GreenWatch watch(scene.network());
    traffic::SignalStatus held;
    held.signal = signal_0;
    held.calls = {{scene.key("e1"), {0}, RequestStatus::granted}};
    const auto run = [&](double duration_s, const std::vector<traffic::SignalStatus>& signals) {
        for (double at_s = 0.0; at_s < duration_s; at_s += 0.5) {
            watch.step(signals, scene.snapshot(), scene.roster());
            scene.pass(core::Seconds(0.5));
        }
    };
    run(before_s, {});
    run(green_s, {held});
    run(after_s, {});
    return watch.counts();
}

TEST(GreenWatch, CountsAGreenInWhichTheVehicleDidNotPass) {
    // The stop line is 45 m ahead: 4.5 s.
    EXPECT_EQ(watched(1.0, 6.0, 2.0), (traffic::HeldGreenCounts{1, 0, 0.0}));
    EXPECT_EQ(watched(1.0, 2.0, 2.0), (traffic::HeldGreenCounts{1, 1, 2.0})) << "too early";
    EXPECT_EQ(watched(6.0, 3.0, 2.0), (traffic::HeldGreenCounts{1, 1, 3.0})) << "too late";
    EXPECT_EQ(watched(1.0, 2.0, 0.0), (traffic::HeldGreenCounts{1, 0, 0.0})) << "not judged before its end";
}

}  // namespace
}  // namespace clearway::pipeline
