#include "sensing/channel.hpp"

#include <algorithm>
#include <cmath>

namespace clearway::sensing {
namespace {

/// Path loss by distance, 3GPP TR 37.885, table 6.2.1-1.
struct PathLoss {
    double decibel_per_decade = 0.0;
    double shadowing_db = 0.0;
};

constexpr PathLoss path_loss(failures::Propagation propagation) {
    return propagation == failures::Propagation::nlos ? PathLoss{30.0, 4.0} : PathLoss{20.0, 3.0};
}

/// The formulas hold from about here.
constexpr double least_distance_m = 1.0;

const failures::ChannelConfig& channel_of(const failures::FailureConfig& config,
                                          Channel::Receivers receivers) {
    if (receivers == Channel::Receivers::vehicles)
        return static_cast<const failures::RequestChannel&>(config);
    return static_cast<const failures::SignalRequestChannel&>(config);
}

double shadowing_correlation(double interval_s) {
    constexpr double decorrelation_m = 10.0;
    constexpr double speed_mps = 50.0 / 3.6;
    return std::exp(-speed_mps * interval_s / decorrelation_m);
}

}  // namespace

Channel::Channel(const failures::FailureConfig& config, const core::KeyedRandom& random, Receivers receivers)
    : Channel(channel_of(config, receivers), config.emergency_dark, random, receivers) {}

Channel::Channel(const failures::ChannelConfig& config, failures::EmergencyDark sender_dark,
                 const core::KeyedRandom& random, Receivers receivers)
    : config_(config),
      sender_dark_(sender_dark),
      random_(random),
      loss_(receivers == Receivers::vehicles ? core::Purpose::request_loss
                                             : core::Purpose::signal_request_loss),
      outages_(random,
               receivers == Receivers::vehicles ? core::Purpose::request_outage
                                                : core::Purpose::signal_request_outage,
               {config.interval_s, config.dark_share, config.mean_outage_s}),
      shadowing_{receivers == Receivers::vehicles ? core::Purpose::request_shadowing
                                                  : core::Purpose::signal_request_shadowing,
                 1, 0, shadowing_correlation(config.interval_s)} {}

MessageNumber Channel::message_at(core::Seconds time) const {
    return static_cast<MessageNumber>(
        std::floor((time.value + core::clock_tolerance_s) / config_.interval_s));
}

bool Channel::is_silent(std::uint64_t sender, MessageNumber message) const {
    return sender_dark_ == failures::EmergencyDark::yes && outages_.dark(sender, message);
}

bool Channel::hears(std::uint64_t sender, std::uint64_t receiver, MessageNumber message,
                    double distance_m) const {
    if (is_perfect()) return true;
    if (!is_in_reach(sender, receiver, message, distance_m)) return false;
    return !is_lost(sender, receiver, message) && !outages_.dark(receiver, message);
}

bool Channel::hears_answer(std::uint64_t sender, std::uint64_t receiver, MessageNumber message,
                           double distance_m) const {
    if (is_perfect()) return true;
    return is_in_reach(sender, receiver, message, distance_m) && !is_lost(receiver, sender, message) &&
           !outages_.dark(receiver, message) && !is_silent(sender, message);
}

bool Channel::is_lost(std::uint64_t from, std::uint64_t to, MessageNumber message) const {
    return config_.loss_rate > 0.0 &&
           random_.uniform(loss_, core::mix64(from) ^ to, message) < config_.loss_rate;
}

bool Channel::is_in_reach(std::uint64_t sender, std::uint64_t receiver, MessageNumber message,
                          double distance_m) const {
    if (config_.propagation == failures::Propagation::sharp) return distance_m < config_.range_m;
    const PathLoss loss = path_loss(config_.propagation);
    const double beyond_db =
        loss.decibel_per_decade * std::log10(std::max(distance_m, least_distance_m) / config_.range_m);
    // Farther than five standard deviations, one draw in millions decides otherwise.
    if (std::abs(beyond_db) > 5.0 * loss.shadowing_db) return beyond_db < 0.0;
    const double shadow =
        core::draw_normal(random_, shadowing_, core::pair_subject(sender, receiver), message);
    return beyond_db + loss.shadowing_db * shadow < 0.0;
}

}  // namespace clearway::sensing
