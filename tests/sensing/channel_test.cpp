// Who hears the requests of an emergency vehicle.
#include "sensing/channel.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sensing/traffic_fixture.hpp"

namespace clearway::sensing {

using namespace failures;

namespace {

using testing::draws;

constexpr std::uint64_t ambulance = 7;
constexpr std::uint64_t receivers = 4000;

Channel channel(const std::string& failure, Channel::Receivers kind = Channel::Receivers::vehicles) {
    return {failure_from(failure), draws(), kind};
}

/// Share of receivers, each other vehicles, that hear one message at a distance.
double share_at(const Channel& channel, double distance_m, MessageNumber message = 50) {
    int heard = 0;
    for (std::uint64_t receiver = 100; receiver < 100 + receivers; ++receiver)
        heard += channel.hears(ambulance, receiver, message, distance_m) ? 1 : 0;
    return static_cast<double>(heard) / receivers;
}

double normal_below(double score) {
    return 0.5 * std::erfc(-score / std::numbers::sqrt2);
}

TEST(Channel, ThatIsPerfectIsHeardEverywhere) {
    const Channel perfect = channel("B10");
    EXPECT_TRUE(perfect.is_perfect());
    EXPECT_EQ(share_at(perfect, 1e6), 1.0);
}

TEST(Channel, WithASharpRangeEndsThere) {
    const Channel sharp = channel("request_propagation=sharp,request_range_m=80");
    EXPECT_EQ(share_at(sharp, 79.9), 1.0);
    EXPECT_EQ(share_at(sharp, 80.0), 0.0);
}

TEST(Channel, FadesByTheExponentsAndDeviationsOf3gpp) {
    // P(heard) = Phi(10 n log10(R / d) / s): table 6.2.1-1 of TR 37.885 by hand.
    const Channel los = channel("request_propagation=los,request_range_m=100");
    const Channel nlos = channel("request_propagation=nlos,request_range_m=100");
    for (const double distance_m : {70.0, 90.0, 100.0, 120.0, 150.0}) {
        const double nearer = std::log10(100.0 / distance_m);
        EXPECT_NEAR(share_at(los, distance_m), normal_below(20.0 * nearer / 3.0), 0.025) << distance_m;
        EXPECT_NEAR(share_at(nlos, distance_m), normal_below(30.0 * nearer / 4.0), 0.025) << distance_m;
    }
    EXPECT_EQ(share_at(los, 0.0), 1.0) << "two fronts in one place";
    EXPECT_EQ(share_at(los, 900.0), 0.0);
}

TEST(Channel, IsShadowedAlikeBothWays) {
    const Channel los = channel("request_propagation=los,request_range_m=100");
    for (std::uint64_t other = 100; other < 400; ++other)
        EXPECT_EQ(los.hears(ambulance, other, 9, 100.0), los.hears(other, ambulance, 9, 100.0));
}

TEST(Channel, BringsAnswersOverTheSameShadowWithLossesOfTheirOwn) {
    const Channel shadowed = channel("range_150m", Channel::Receivers::signals);
    const Channel lossy = channel("Q50", Channel::Receivers::signals);
    int both = 0;
    int answers = 0;
    for (std::uint64_t signal = 0; signal < receivers; ++signal) {
        EXPECT_EQ(shadowed.hears_answer(ambulance, signal, 9, 150.0),
                  shadowed.hears(ambulance, signal, 9, 150.0));
        const bool is_answered = lossy.hears_answer(ambulance, signal, 9, 150.0);
        answers += is_answered ? 1 : 0;
        both += is_answered && lossy.hears(ambulance, signal, 9, 150.0) ? 1 : 0;
    }
    // Standard errors 0.008 and 0.007.
    EXPECT_NEAR(static_cast<double>(answers) / receivers, 0.5, 0.03);
    EXPECT_NEAR(static_cast<double>(both) / receivers, 0.25, 0.03) << "independent of the request";
    EXPECT_TRUE(channel("B10", Channel::Receivers::signals).hears_answer(ambulance, 3, 9, 1e6));
}

TEST(Channel, KeepsItsShadowFromOneMessageToTheNextAndLosesItInTime) {
    // At the range, two messages agree with probability 1/2 + asin(correlation) / pi.
    const Channel los = channel("request_propagation=los,request_range_m=100,request_interval_s=0.1");
    const auto agreement = [&](MessageNumber later) {
        int agree = 0;
        for (std::uint64_t other = 100; other < 100 + receivers; ++other)
            agree += los.hears(ambulance, other, 500, 100.0) == los.hears(ambulance, other, later, 100.0);
        return static_cast<double>(agree) / receivers;
    };
    const double correlation = std::exp(-(50.0 / 3.6) * 0.1 / 10.0);
    EXPECT_NEAR(agreement(501), 0.5 + std::asin(correlation) / std::numbers::pi, 0.025);
    EXPECT_NEAR(agreement(600), 0.5, 0.025);
}

TEST(Channel, LosesTheConfiguredShareOfMessages) {
    const Channel lossy = channel("request_propagation=sharp,request_range_m=100,request_loss_rate=0.3");
    EXPECT_NEAR(share_at(lossy, 10.0), 0.7, 0.025);
    const Channel deaf = channel("request_propagation=sharp,request_loss_rate=1");
    EXPECT_EQ(share_at(deaf, 10.0), 0.0);
}

TEST(Channel, HasReceiversInOutageAndSenders) {
    const std::string bursts =
        "request_propagation=sharp,request_range_m=100,request_dark_share=0.4,request_mean_outage_s=20";
    const Channel dark = channel(bursts);
    EXPECT_NEAR(share_at(dark, 10.0), 0.6, 0.03);
    int silent = 0;
    int changes = 0;
    for (MessageNumber message = 1; message <= 20000; ++message) {
        silent += dark.is_silent(ambulance, message) ? 1 : 0;
        changes += dark.is_silent(ambulance, message) != dark.is_silent(ambulance, message - 1) ? 1 : 0;
    }
    EXPECT_NEAR(silent / 20000.0, 0.4, 0.08);
    // Two changes a cycle; a cycle of outage and rest lasts 20 s / 0.4 = 100 messages of 0.5 s.
    EXPECT_NEAR(changes / 20000.0, 2.0 / 100.0, 0.006);
    const Channel loud = channel(bursts + ",emergency_dark=no");
    for (MessageNumber message = 0; message < 200; ++message)
        EXPECT_FALSE(loud.is_silent(ambulance, message));
}

TEST(Channel, CountsMessagesFromTimeZeroWhateverTheStep) {
    const Channel sharp = channel("request_propagation=sharp,request_interval_s=0.5");
    EXPECT_EQ(sharp.message_at(core::Seconds(0.0)), 0u);
    EXPECT_EQ(sharp.message_at(core::Seconds(0.4)), 0u);
    EXPECT_EQ(sharp.message_at(core::Seconds(0.1 * 5)), 1u);
    EXPECT_EQ(sharp.message_at(core::Seconds(99.75)), 199u);
}

TEST(Channel, ToSignalsFailsIndependentlyOfTheOneToVehicles) {
    const std::string both =
        "request_propagation=sharp,request_loss_rate=0.5,signal_request_propagation=sharp,"
        "signal_request_loss_rate=0.5";
    const Channel to_vehicles = channel(both);
    const Channel to_signals = channel(both, Channel::Receivers::signals);
    int agree = 0;
    for (std::uint64_t receiver = 0; receiver < receivers; ++receiver)
        agree +=
            to_vehicles.hears(ambulance, receiver, 5, 10.0) == to_signals.hears(ambulance, receiver, 5, 10.0)
                ? 1
                : 0;
    EXPECT_NEAR(static_cast<double>(agree) / receivers, 0.5, 0.03);
}

}  // namespace
}  // namespace clearway::sensing
