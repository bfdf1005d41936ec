#include "links/link_evaluation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "roads/route.hpp"

namespace clearway::links {
namespace {

using Clock = std::chrono::steady_clock;

/// Pairs within this distance along the route count as relevant to the policy; the horizon of
/// policy::ClearLane. (Candidates are always nearer.)
constexpr core::Metres policy_horizon{150.0};
/// Tolerance for step times, which are sums of decimals, s.
constexpr double time_slack_s = 1e-6;

/// Distance from one vehicle to another ahead on its route; empty if either has no place on it.
std::optional<core::Metres> distance_ahead(const roads::Network& network, const traffic::Roster& roster,
                                           core::VehicleKey emergency, const traffic::MotionState& state,
                                           const traffic::MotionState& other) {
    const traffic::VehicleInfo* const info = roster.find(emergency);
    if (info == nullptr || !info->route.exists() || !state.lane.exists() || !other.lane.exists())
        return std::nullopt;
    const roads::Route route = roster.route(info->route);
    if (state.route_edge >= route.size()) return std::nullopt;
    const core::EdgeIndex edge = network.lane(state.lane).edge;
    if (!network.edge(edge).internal && edge != route[state.route_edge]) return std::nullopt;
    return roads::distance_ahead(network, route, state, other, policy_horizon);
}

bool is_emergency(traffic::VehicleClass vehicle_class) {
    return vehicle_class == traffic::VehicleClass::emergency;
}

}  // namespace

LinkTruthView::LinkTruthView(const roads::Network& network, const graph::LinkRules& rules)
    : network_(network), links_(rules) {}

void LinkTruthView::look(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    links_.look(snapshot);
    policy_links_.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (!is_emergency(snapshot.vehicle_class[row])) continue;
        for (const core::VehicleIndex other : links_.graph().neighbours_of(row)) {
            if (distance_ahead(network_, roster, snapshot.key[row], snapshot.motion(row),
                               snapshot.motion(other)))
                policy_links_.push_back({row, other});
        }
    }
    find_next_ahead(snapshot);
}

void LinkTruthView::find_next_ahead(const truth::Snapshot& snapshot) {
    lanes_.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row)
        lanes_.add(row, snapshot.lane[row], snapshot.lane_position_m[row]);
    lanes_.sort();
    next_ahead_.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] == traffic::VehicleClass::human) continue;
        next_ahead_.push_back({row, lanes_.next_ahead(snapshot.lane[row], snapshot.lane_position_m[row])});
    }
}

LinkTrial::LinkTrial(const roads::Network& network, const graph::LinkRules& rules, Setup setup)
    : network_(network),
      rules_(rules),
      failure_(std::move(setup.failure)),
      exits_(setup.exits),
      sensor_(std::move(setup.sensor)) {
    for (auto& predictor : setup.predictors)
        contestants_.emplace_back().predictor = std::move(predictor);
}

void LinkTrial::observe(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    sensor_->observe(snapshot, roster, observation_);
}

void LinkTrial::ask(const truth::Snapshot& snapshot, const LinkTruthView& truth, bool scored) {
    const prediction::Scene* scene = nullptr;
    for (Contestant& contestant : contestants_) {
        const auto started = Clock::now();
        contestant.predictor->predict(observation_, contestant.belief);
        const double spent_s = std::chrono::duration<double>(Clock::now() - started).count();
        if (!scored) continue;
        contestant.predict_s += spent_s;
        const prediction::Scene& own = *contestant.predictor->scores().scene;
        if (scene == nullptr) {
            scene = &own;
            core::match_rows(own.tracks.key, snapshot.key, true_row_);
            describe_candidates(own, truth);
            find_heard(snapshot);
            count_truth(snapshot, own, truth);
        }
        if (own.candidates.rows != scene->candidates.rows) {
            throw std::logic_error(fmt::format("{} scores other candidates than {}",
                                               contestant.predictor->name(),
                                               contestants_.front().predictor->name()));
        }
        score(contestant);
        count_belief(contestant, snapshot, truth);
    }
}

bool LinkTrial::truly_linked(prediction::RowPair pair, const LinkTruthView& truth) const {
    return truth.links().linked(true_row_[pair.left], true_row_[pair.right]);
}

void LinkTrial::describe_candidates(const prediction::Scene& scene, const LinkTruthView& truth) {
    const prediction::PairList& pairs = scene.candidates;
    const auto radius_m = static_cast<float>(rules_.radius_m);
    label_.resize(pairs.size());
    traits_.resize(pairs.size());
    for (std::size_t at = 0; at < pairs.size(); ++at) {
        const prediction::RowPair rows = pairs.rows[at];
        label_[at] = truly_linked(rows, truth) ? 1 : 0;
        const float age_s = std::max(scene.tracks.age_s[rows.left], scene.tracks.age_s[rows.right]);
        traits_[at] = {age_class_of(age_s),
                       is_hard(pairs.last_seen_m[at], pairs.dead_reckoned_m[at], radius_m),
                       is_ahead_of_emergency(scene.tracks, rows)};
    }
}

bool LinkTrial::is_ahead_of_emergency(const prediction::Tracks& tracks, prediction::RowPair pair) const {
    const auto is_ahead = [&](std::uint32_t from, std::uint32_t to) {
        if (!is_emergency(tracks.vehicle_class[from])) return false;
        const traffic::Roster& roster = *observation_.roster;
        return distance_ahead(network_, roster, tracks.key[from], tracks.state[from], tracks.state[to]) ||
               distance_ahead(network_, roster, tracks.key[from], tracks.last[from], tracks.last[to]);
    };
    return is_ahead(pair.left, pair.right) || is_ahead(pair.right, pair.left);
}

void LinkTrial::count_truth(const truth::Snapshot& snapshot, const prediction::Scene& scene,
                            const LinkTruthView& truth) {
    sensor_->log_failures(snapshot, truth.links().graph(), log_);
    const auto never_seen = static_cast<std::uint64_t>(std::ranges::count(
        log_.lost_links, sensing::FailureLog::Cause::never_seen, &sensing::FailureLog::LostLink::cause));
    auto in_reach = static_cast<std::uint64_t>(std::ranges::count(label_, 1));
    for (const prediction::PairList* const pairs : {&scene.known, &scene.detected}) {
        for (const prediction::RowPair rows : pairs->rows)
            in_reach += truly_linked(rows, truth) ? 1 : 0;
    }
    ++truth_.reports;
    truth_.vehicles += snapshot.size();
    truth_.true_links += truth.links().link_count();
    truth_.never_seen += never_seen;
    truth_.outside += truth.links().link_count() - never_seen - in_reach;
    truth_.policy_links += truth.policy_links().size();
    truth_.dark_vehicles += static_cast<std::uint64_t>(std::ranges::count(heard_, core::no_row));
    truth_.unseen_vehicles += log_.never_seen.size();
    observed_vehicles_ += observation_.vehicles.size();
}

void LinkTrial::score(Contestant& contestant) const {
    const std::span<const float> probability = contestant.predictor->scores().probability;
    for (std::size_t at = 0; at < probability.size(); ++at) {
        const float value = probability[at];
        if (!(value >= 0.0F && value <= 1.0F)) {
            throw std::logic_error(
                fmt::format("{} gave a probability of {}", contestant.predictor->name(), value));
        }
        contestant.scores.add(value, label_[at] != 0, traits_[at]);
    }
}

void LinkTrial::count_belief(Contestant& contestant, const truth::Snapshot& snapshot,
                             const LinkTruthView& truth) {
    const traffic::BelievedGraph& belief = contestant.belief;
    LinkBelief& counts = contestant.counts;
    match_.match(snapshot, belief);
    counts.believed_vehicles += belief.vehicles.size();
    counts.ghosts += static_cast<std::uint64_t>(std::ranges::count(match_.true_rows(), core::no_row));
    match_.for_each_link(belief, truth.links(), [&](core::VehicleIndex, core::VehicleIndex, bool is_true) {
        ++(is_true ? counts.listed_true : counts.listed_false);
    });
    for (const prediction::RowPair pair : truth.policy_links()) {
        const core::VehicleIndex emergency = match_.believed_rows()[pair.left];
        const core::VehicleIndex other = match_.believed_rows()[pair.right];
        if (emergency == core::no_row || other == core::no_row) continue;
        const auto links = belief.links_of(emergency);
        if (std::ranges::binary_search(links, other, {}, &traffic::BelievedLink::neighbour))
            ++counts.policy_found;
    }
    count_dark(contestant, snapshot);
    count_next_ahead(contestant, truth);
}

void LinkTrial::find_heard(const truth::Snapshot& snapshot) {
    heard_keys_.clear();
    for (const traffic::ObservedVehicle& vehicle : observation_.vehicles) {
        if (vehicle.freshness == traffic::Freshness::fresh) heard_keys_.push_back(vehicle.key);
    }
    core::match_rows(snapshot.key, heard_keys_, heard_);
}

bool LinkTrial::was_heard(core::VehicleKey key) const {
    return std::ranges::binary_search(heard_keys_, key);
}

void LinkTrial::count_dark(Contestant& contestant, const truth::Snapshot& snapshot) const {
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        const core::VehicleIndex believed = match_.believed_rows()[row];
        if (heard_[row] != core::no_row || believed == core::no_row) continue;
        const traffic::MotionState& state = contestant.belief.vehicles[believed].state;
        ++contestant.counts.dark_believed;
        contestant.places.add(std::hypot(static_cast<double>(state.x_m) - snapshot.x_m[row],
                                         static_cast<double>(state.y_m) - snapshot.y_m[row]));
    }
}

void LinkTrial::count_next_ahead(Contestant& contestant, const LinkTruthView& truth) {
    const std::vector<traffic::BelievedVehicle>& vehicles = contestant.belief.vehicles;
    believed_lanes_.clear();
    for (core::VehicleIndex row = 0; row < vehicles.size(); ++row)
        believed_lanes_.add(row, vehicles[row].state.lane, vehicles[row].state.lane_position_m);
    believed_lanes_.sort();
    for (const LinkTruthView::NextAhead& asked : truth.next_ahead()) {
        core::VehicleIndex believed = match_.believed_rows()[asked.row];
        if (believed != core::no_row) {
            const traffic::MotionState& state = vehicles[believed].state;
            believed = believed_lanes_.next_ahead(state.lane, state.lane_position_m);
        }
        const bool none_believed = believed == core::no_row;
        const bool true_one_dark = asked.next != core::no_row && heard_[asked.next] == core::no_row;
        const bool believed_one_dark = !none_believed && !was_heard(vehicles[believed].key);
        if (!true_one_dark && !believed_one_dark) continue;
        const bool right = none_believed
                               ? asked.next == core::no_row
                               : asked.next != core::no_row && match_.true_rows()[believed] == asked.next;
        ++contestant.counts.next_cases;
        contestant.counts.next_right += right ? 1 : 0;
    }
}

LinkCase LinkTrial::result(std::size_t predictor) const {
    const Contestant& contestant = contestants_[predictor];
    return {
        failure_, exits_, truth_, contestant.counts, contestant.scores.summary(), contestant.places.errors()};
}

LinkTiming::Case LinkTrial::timing(std::size_t predictor) const {
    return {failure_, exits_, truth_.reports, observed_vehicles_, contestants_[predictor].predict_s};
}

LinkEvaluator::LinkEvaluator(const roads::Network& network, const graph::LinkRules& rules,
                             core::Seconds score_from)
    : network_(network), rules_(rules), truth_(network, rules), score_from_s_(score_from.value) {}

void LinkEvaluator::add(LinkTrial::Setup setup) {
    trials_.emplace_back(network_, rules_, std::move(setup));
    next_s_.push_back(0.0);
}

void LinkEvaluator::on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    constexpr double interval_s = 1.0;
    const double now_s = snapshot.time.value + time_slack_s;
    bool looked = false;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
        trials_[i].observe(snapshot, roster);
        if (!trials_[i].has_report() || now_s < next_s_[i]) continue;
        if (!looked) truth_.look(snapshot, roster);
        looked = true;
        trials_[i].ask(snapshot, truth_, now_s >= score_from_s_);
        next_s_[i] = snapshot.time.value + interval_s;
    }
}

}  // namespace clearway::links
