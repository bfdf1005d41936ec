#include "pipeline/signal_radio.hpp"

#include <cassert>
#include <cmath>
#include <set>

#include "sensing/observers.hpp"

namespace clearway::pipeline {
namespace {

/// How often a cancellation is sent.
constexpr int cancellations = 3;

}  // namespace

SignalRadio::SignalRadio(const roads::Network& network, const failures::FailureConfig& failure,
                         const core::KeyedRandom& random)
    : channel_(failure, random, sensing::Channel::Receivers::signals) {
    for (const roads::Signal& signal : network.signals())
        places_.push_back(sensing::place_of(network, signal));
}

bool SignalRadio::is_due(core::Seconds now) {
    const sensing::MessageNumber number = channel_.message_at(now);
    if (!channel_.is_perfect() && last_message_ && *last_message_ >= number) return false;
    last_message_ = number;
    return true;
}

void SignalRadio::exchange(std::span<const traffic::PriorityRequest> wanted,
                           const truth::Snapshot& snapshot) {
    const double now_s = snapshot.time.value + core::clock_tolerance_s;
    arrived_.clear();
    for (const OnItsWay& one : on_their_way_) {
        if (one.arrives_s <= now_s) arrived_.push_back(one.message);
    }
    std::erase_if(on_their_way_, [&](const OnItsWay& one) { return one.arrives_s <= now_s; });
    is_due_ = is_due(snapshot.time);
    if (!is_due_) return;
    for (auto& [key, approach] : approaches_)
        approach.is_wanted = false;
    std::set<core::VehicleKey> senders;
    for (const traffic::PriorityRequest& request : wanted)
        want(request);
    for (const auto& [key, approach] : approaches_) {
        if (approach.is_wanted || approach.cancellations_left > 0) senders.insert(key.first);
    }
    for (const core::VehicleKey vehicle : senders)
        send(vehicle, snapshot);
}

void SignalRadio::want(const traffic::PriorityRequest& request) {
    assert(request.signal.value < places_.size());
    const auto [found, is_new] = approaches_.try_emplace({request.vehicle, request.signal});
    Approach& approach = found->second;
    if (is_new || approach.cancellations_left < cancellations) {
        approach = Approach{};
        approach.last.request_id = ++request_ids_[request.vehicle];
    }
    const std::uint32_t id = approach.last.request_id;
    approach.last = request;
    approach.last.request_id = id;
    approach.last.type = approach.first_sent ? traffic::RequestType::update : traffic::RequestType::request;
    approach.is_wanted = true;
    approach.cancellations_left = cancellations;
}

void SignalRadio::send(core::VehicleKey vehicle, const truth::Snapshot& snapshot) {
    const auto sender = snapshot.row_of(vehicle);
    const bool speaks =
        sender && (is_perfect() || !channel_.is_silent(vehicle.value, channel_.message_at(snapshot.time)));
    if (speaks) ++counts_.messages;
    const std::uint32_t sequence = speaks ? ++sequences_[vehicle] : 0;
    for (auto at = approaches_.lower_bound({vehicle, core::SignalIndex{0}});
         at != approaches_.end() && at->first.first == vehicle; ++at) {
        Approach& approach = at->second;
        if (!approach.is_wanted && approach.cancellations_left == 0) continue;
        if (!approach.is_wanted) {
            --approach.cancellations_left;
            approach.last.type = traffic::RequestType::cancellation;
            approach.last.sent = snapshot.time;
            if (speaks) approach.last.motion = snapshot.motion(*sender);
        }
        if (!speaks) continue;
        approach.last.sequence = sequence;
        if (!approach.first_sent) approach.first_sent = snapshot.time;
        transmit(approach.last, *sender, snapshot);
    }
}

void SignalRadio::transmit(const traffic::PriorityRequest& message, core::VehicleIndex sender,
                           const truth::Snapshot& snapshot) {
    assert(snapshot.key[sender] == message.vehicle);
    ++counts_.sent;
    if (message.type == traffic::RequestType::update) ++counts_.updates;
    if (message.type == traffic::RequestType::cancellation) ++counts_.cancellations;
    const bool is_heard = is_perfect() || (places_.at(message.signal.value) &&
                                           channel_.hears(message.vehicle.value, message.signal.value,
                                                          channel_.message_at(snapshot.time),
                                                          apart_m(sender, message.signal, snapshot)));
    if (!is_heard) return;
    ++counts_.heard;
    const double latency_s = channel_.config().latency_s;
    if (latency_s > 0.0) {
        on_their_way_.push_back({snapshot.time.value + latency_s, message});
    } else {
        arrived_.push_back(message);
    }
}

double SignalRadio::apart_m(core::VehicleIndex vehicle, core::SignalIndex signal,
                            const truth::Snapshot& snapshot) const {
    assert(places_[signal.value].has_value());
    const sensing::Place& place = *places_[signal.value];
    return std::hypot(snapshot.x_m[vehicle] - place.x_m, snapshot.y_m[vehicle] - place.y_m);
}

void SignalRadio::answer(std::span<const policy::RequestKey> open,
                         std::span<const traffic::SignalStatus> signals, const truth::Snapshot& snapshot) {
    std::map<Key, traffic::RequestStatus> statuses;
    for (const traffic::SignalStatus& signal : signals) {
        for (const traffic::SignalCall& call : signal.calls)
            statuses.try_emplace({call.emergency, signal.signal}, call.status);
    }
    const sensing::MessageNumber number = channel_.message_at(snapshot.time);
    for (const Key& key : open) {
        const auto approach = approaches_.find(key);
        if (!is_due_ || approach == approaches_.end()) continue;
        ++counts_.answers_sent;
        const auto vehicle = snapshot.row_of(key.first);
        const bool is_heard =
            vehicle && (is_perfect() || (places_.at(key.second.value) &&
                                         channel_.hears_answer(key.first.value, key.second.value, number,
                                                               apart_m(*vehicle, key.second, snapshot))));
        if (!is_heard) continue;
        const auto status = statuses.find(key);
        answers_.push_back({snapshot.time.value + channel_.config().latency_s, key,
                            approach->second.last.request_id,
                            status == statuses.end() ? traffic::RequestStatus::requested : status->second});
    }
    receive_answers(snapshot.time);
}

void SignalRadio::receive_answers(core::Seconds now) {
    const auto is_here = [&](const Answer& answer) {
        return answer.arrives_s <= now.value + core::clock_tolerance_s;
    };
    for (const Answer& answer : answers_) {
        if (!is_here(answer)) continue;
        ++counts_.answers_heard;
        Approach& approach = approaches_.at(answer.key);
        const auto status = static_cast<std::size_t>(answer.status);
        assert(status < approach.told.size());
        if (approach.last.request_id != answer.request_id || approach.told[status] || !approach.first_sent)
            continue;
        approach.told[status] = true;
        ++counts_.told[status];
        if (answer.status == traffic::RequestStatus::granted)
            counts_.until_granted_s += (now - *approach.first_sent).value;
    }
    std::erase_if(answers_, is_here);
}

}  // namespace clearway::pipeline
