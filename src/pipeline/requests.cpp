#include "pipeline/requests.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <variant>

#include "sensing/observers.hpp"

namespace clearway::pipeline {
namespace {

/// The same policies and settings with sensors that never fail, and nothing to repair.
experiment::ConditionSpec informed(experiment::ConditionSpec condition) {
    const experiment::ConditionSpec usual;
    condition.failure = usual.failure;
    condition.predictor = usual.predictor;
    condition.model_file.clear();
    return condition;
}

/// Whether the policies can be asked a second time about the truth, and would say anything else.
bool needs_second_opinion(const experiment::ConditionSpec& condition, const failures::FailureConfig& failure,
                          const ChainContext& context) {
    const bool knows_everything =
        condition.predictor == experiment::ConditionSpec{}.predictor && failure.report_interval_s == 0.0;
    experiment::ConditionSpec policies_alone = condition;
    policies_alone.predictor.clear();
    return !condition.policies.empty() && !knows_everything && !has_foreign_code(policies_alone, context);
}

double distance_m(const truth::Snapshot& snapshot, core::VehicleIndex row, float x_m, float y_m) {
    return std::hypot(snapshot.x_m[row] - x_m, snapshot.y_m[row] - y_m);
}

/// Somebody with a radio: on the road, or standing beside it.
struct Radio {
    core::VehicleKey key;
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    traffic::MotionState state;
};

std::size_t radio_count(const truth::Snapshot& snapshot) {
    return snapshot.size() + snapshot.beside_road.size();
}

/// Numbered by row, and behind the rows those beside the road.
Radio radio(const truth::Snapshot& snapshot, std::size_t number) {
    assert(number < radio_count(snapshot));
    if (number >= snapshot.size()) {
        const truth::BesideRoad& beside = snapshot.beside_road[number - snapshot.size()];
        return {beside.key, beside.vehicle_class, beside.state};
    }
    const auto row = static_cast<core::VehicleIndex>(number);
    return {snapshot.key[row], snapshot.vehicle_class[row], snapshot.motion(row)};
}

std::optional<std::size_t> radio_of(const truth::Snapshot& snapshot, core::VehicleKey vehicle) {
    if (const auto row = snapshot.row_of(vehicle)) return *row;
    const auto beside = std::ranges::lower_bound(snapshot.beside_road, vehicle, {}, &truth::BesideRoad::key);
    if (beside == snapshot.beside_road.end() || beside->key != vehicle) return std::nullopt;
    return snapshot.size() + static_cast<std::size_t>(beside - snapshot.beside_road.begin());
}

/// The vehicles that a request asks in truth; none for one to a signal.
std::vector<core::VehicleKey> meant_by(const traffic::Lease& lease, const truth::Snapshot& snapshot) {
    if (const auto* const vehicle = std::get_if<core::VehicleKey>(&lease.target)) return {*vehicle};
    std::vector<core::VehicleKey> there;
    if (const auto* const stretch = std::get_if<traffic::Stretch>(&lease.target)) {
        for (std::size_t number = 0; number < radio_count(snapshot); ++number) {
            const Radio one = radio(snapshot, number);
            if (stretch->has(one.vehicle_class, one.state)) there.push_back(one.key);
        }
    }
    return there;
}

template <class Element>
void sort_unique(std::vector<Element>& elements) {
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
}

template <class Element>
std::uint64_t count_missing(const std::vector<Element>& wanted, const std::vector<Element>& there) {
    return static_cast<std::uint64_t>(std::ranges::count_if(
        wanted, [&](const Element& element) { return !std::ranges::binary_search(there, element); }));
}

}  // namespace

Requests::Requests(const experiment::ConditionSpec& condition, const ChainContext& context)
    : Requests(condition, context, failures::failure_from(condition.failure)) {}

Requests::Requests(const experiment::ConditionSpec& condition, const ChainContext& context,
                   const failures::FailureConfig& failure)
    : vehicles_(failure, context.random, sensing::Channel::Receivers::vehicles),
      signals_(failure, context.random, sensing::Channel::Receivers::signals),
      random_(context.random),
      way_loss_rate_(failure.way_loss_rate),
      equipment_(failure, context.random) {
    for (const roads::Signal& signal : context.network.signals())
        signal_places_.push_back(sensing::place_of(context.network, signal));
    if (!needs_second_opinion(condition, failure, context)) return;
    ChainContext own = context;
    own.readers = ChainContext::Readers::policies;
    informed_ = std::make_unique<DecisionChain>(informed(condition), own);
}

bool Requests::is_request(const traffic::Lease& lease, std::span<const std::string_view> decided_there) {
    if (lease.beneficiary == core::VehicleKey{}) return false;
    if (core::contains(decided_there, lease.policy)) return false;
    const auto* const vehicle = std::get_if<core::VehicleKey>(&lease.target);
    return vehicle == nullptr || *vehicle != lease.beneficiary;
}

void Requests::Turns::begin_decision(const sensing::Channel& channel, core::Seconds now) {
    const sensing::MessageNumber number = channel.message_at(now);
    is_new_interval_ = channel.is_perfect() || !number_ || *number_ < number;
    number_ = number;
    if (is_new_interval_) {
        earlier_senders_.clear();
    } else {
        earlier_senders_.merge(senders_);
    }
    senders_.clear();
}

bool Requests::Turns::take(core::VehicleKey sender) {
    if (earlier_senders_.contains(sender)) return false;
    senders_.insert(sender);
    return true;
}

void Requests::step(const Decision& decision, const truth::Snapshot& snapshot,
                    const traffic::Roster& roster) {
    arrived_.clear();
    lost_.clear();
    outdated_.clear();
    receive(snapshot.time);
    if (decision.is_new) send({decision, snapshot, roster});
}

void Requests::receive(core::Seconds now) {
    const auto is_here = [&](const OnItsWay& message) {
        return message.arrives_s <= now.value + core::clock_tolerance_s;
    };
    for (const OnItsWay& message : on_their_way_) {
        if (!is_here(message)) continue;
        const traffic::Lease& lease = message.lease;
        core::Seconds& newest =
            newest_sent_.try_emplace({lease.policy, lease.beneficiary, lease.target}, message.sent)
                .first->second;
        (message.sent < newest ? outdated_ : arrived_).push_back(lease);
        newest = std::max(newest, message.sent);
    }
    std::erase_if(on_their_way_, is_here);
}

void Requests::send(const Moment& moment) {
    const core::Seconds now = moment.snapshot.time;
    vehicle_turns_.begin_decision(vehicles_, now);
    signal_turns_.begin_decision(signals_, now);
    hearings_.clear();
    signal_senders_.clear();
    wanted_.clear();
    sent_.clear();
    heard_.clear();
    for (const traffic::Lease& lease : moment.decision.leases) {
        if (!is_request(lease, moment.decision.decided_there)) {
            (is_lost_way(lease, now) ? lost_ : arrived_).push_back(lease);
        } else if (const auto* const vehicle = std::get_if<core::VehicleKey>(&lease.target)) {
            ask_vehicle(lease, *vehicle, moment);
        } else if (std::holds_alternative<traffic::Stretch>(lease.target)) {
            ask_stretch(lease, moment);
        } else {
            ask_signal(lease, std::get<core::SignalIndex>(lease.target), moment);
        }
    }
    if (vehicle_turns_.is_new_interval() || !hearings_.empty()) judge(moment);
}

bool Requests::is_lost_way(const traffic::Lease& lease, core::Seconds now) const {
    const auto* const vehicle = std::get_if<core::VehicleKey>(&lease.target);
    if (way_loss_rate_ == 0.0 || vehicle == nullptr ||
        !std::holds_alternative<traffic::TakeRoute>(lease.action))
        return false;
    const auto decision = static_cast<std::uint64_t>(std::llround(now.value * 1000.0));
    // Nobody sends a request to itself, so these draws are no other ones.
    return random_.uniform(core::Purpose::request_loss, core::pair_subject(vehicle->value, vehicle->value),
                           decision) < way_loss_rate_;
}

void Requests::ask_vehicle(const traffic::Lease& lease, core::VehicleKey vehicle, const Moment& moment) {
    if (!vehicle_turns_.take(lease.beneficiary)) return;
    const Asked asked{lease.beneficiary, vehicle, lease.action.index()};
    wanted_.push_back(asked);
    const Hearing& hearing = hearing_of(lease.beneficiary, moment);
    if (hearing.empty() && !vehicles_.is_perfect()) return;
    ++counts_.sent;
    sent_.push_back(asked);
    const auto number = radio_of(moment.snapshot, vehicle);
    const int hops = number && !is_unreachable(vehicle, moment) ? hearing[*number] : 0;
    if (hops > 0) {
        ++counts_.heard;
        if (hops > 1) ++counts_.relayed;
        heard_.push_back(asked);
        asked_.insert(vehicle);
        counts_.vehicles_asked = asked_.size();
    }
    // Perfect channels leave it to actuation to refuse what does not arrive, for its reasons are known there.
    if (hops > 0 || vehicles_.is_perfect()) {
        deliver(lease, vehicles_.config().latency_s * hops, moment.snapshot.time);
    } else {
        lost_.push_back(lease);
    }
}

void Requests::ask_stretch(const traffic::Lease& lease, const Moment& moment) {
    if (!vehicle_turns_.take(lease.beneficiary)) return;
    hearing_of(lease.beneficiary, moment);  // The message goes out even where nobody is.
    for (const core::VehicleKey vehicle : meant_by(lease, moment.snapshot)) {
        traffic::Lease own = lease;
        own.target = vehicle;
        ask_vehicle(own, vehicle, moment);
    }
}

const Requests::Hearing& Requests::hearing_of(core::VehicleKey sender, const Moment& moment) {
    const auto [found, is_first] = hearings_.try_emplace(sender);
    if (is_first) found->second = spread(sender, moment);
    return found->second;
}

Requests::Hearing Requests::spread(core::VehicleKey sender, const Moment& moment) {
    if (vehicles_.is_perfect()) {
        ++counts_.messages;
        return Hearing(radio_count(moment.snapshot), 1);
    }
    const auto row = moment.snapshot.row_of(sender);
    if (!row || vehicles_.is_silent(sender.value, vehicles_.message_at(moment.snapshot.time))) return {};
    Hearing hearing(radio_count(moment.snapshot), 0);
    transmit(*row, 1, moment.snapshot, hearing);
    for (int hop = 2; hop <= vehicles_.config().hops; ++hop) {
        for (core::VehicleIndex relay = 0; relay < moment.snapshot.size(); ++relay) {
            const bool relays = hearing[relay] == hop - 1 &&
                                moment.snapshot.vehicle_class[relay] == traffic::VehicleClass::automated &&
                                !is_unreachable(moment.snapshot.key[relay], moment);
            if (relays) transmit(relay, hop, moment.snapshot, hearing);
        }
    }
    return hearing;
}

void Requests::transmit(core::VehicleIndex from, int hop, const truth::Snapshot& snapshot, Hearing& hearing) {
    assert(from < snapshot.size() && hop > 0);
    assert(hearing.size() == radio_count(snapshot));
    ++counts_.messages;
    const sensing::MessageNumber number = vehicles_.message_at(snapshot.time);
    for (std::size_t listener = 0; listener < hearing.size(); ++listener) {
        if (listener == from || hearing[listener] != 0) continue;
        const Radio there = radio(snapshot, listener);
        const double apart_m = distance_m(snapshot, from, there.state.x_m, there.state.y_m);
        if (equipment_.equipped(there.key, there.vehicle_class) &&
            vehicles_.hears(snapshot.key[from].value, there.key.value, number, apart_m))
            hearing[listener] = hop;
    }
}

bool Requests::is_unreachable(core::VehicleKey vehicle, const Moment& moment) {
    assert(std::ranges::is_sorted(moment.decision.unreachable));
    return std::ranges::binary_search(moment.decision.unreachable, vehicle);
}

void Requests::ask_signal(const traffic::Lease& lease, core::SignalIndex signal, const Moment& moment) {
    if (!signal_turns_.take(lease.beneficiary)) return;
    const auto sender = moment.snapshot.row_of(lease.beneficiary);
    const sensing::MessageNumber number = signals_.message_at(moment.snapshot.time);
    const bool speaks =
        signals_.is_perfect() || (sender && !signals_.is_silent(lease.beneficiary.value, number));
    if (!speaks) return;
    ++counts_.signal_sent;
    if (signal_senders_.insert(lease.beneficiary).second) ++counts_.signal_messages;
    const bool exists = signal.value < signal_places_.size();  // If not, the actuator refuses it.
    const auto place = exists ? signal_places_[signal.value] : std::nullopt;
    const bool hears =
        !exists || signals_.is_perfect() ||
        (place && signals_.hears(lease.beneficiary.value, signal.value, number,
                                 distance_m(moment.snapshot, *sender, place->x_m, place->y_m)));
    if (hears) {
        ++counts_.signal_heard;
        deliver(lease, signals_.config().latency_s, moment.snapshot.time);
    } else {
        lost_.push_back(lease);
    }
}

void Requests::deliver(const traffic::Lease& lease, double latency_s, core::Seconds now) {
    assert(latency_s >= 0.0 && lease.beneficiary != core::VehicleKey{});
    if (latency_s > 0.0) {
        on_their_way_.push_back({now, now.value + latency_s, lease});
    } else {
        arrived_.push_back(lease);
    }
}

void Requests::judge(const Moment& moment) {
    sort_unique(sent_);
    sort_unique(heard_);
    needed_ = wanted_;
    if (informed_) {
        needed_.clear();
        informed_->observe(moment.snapshot, moment.roster);
        informed_->decide(prediction::Want::places);
        for (const traffic::Lease& lease : informed_->leases()) {
            if (!is_request(lease, moment.decision.decided_there)) continue;
            // Who sends nothing is judged once an interval.
            if (!vehicle_turns_.is_new_interval() && !hearings_.contains(lease.beneficiary)) continue;
            for (const core::VehicleKey vehicle : meant_by(lease, moment.snapshot))
                needed_.push_back({lease.beneficiary, vehicle, lease.action.index()});
        }
    }
    sort_unique(needed_);
    counts_.needed += needed_.size();
    assert(heard_.size() <= sent_.size());
    counts_.useless += count_missing(sent_, needed_);
    counts_.missed += count_missing(needed_, heard_);
}

}  // namespace clearway::pipeline
