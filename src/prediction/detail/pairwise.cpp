#include "prediction/detail/pairwise.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::prediction::detail {
namespace {

traffic::BelievedVehicle own_belief(const traffic::ObservedVehicle& own) {
    return {own.key, own.vehicle_class, own.state, own.position_sigma_m, own.age_s};
}

}  // namespace

PairwisePredictor::PairwisePredictor(const PredictorContext& context, Needs needs)
    : network_(context.network),
      rules_(context.rules),
      threshold_(static_cast<float>(context.config.link_threshold)),
      builder_(needs == Needs::twins || context.config.reach() == CandidateReach::twins
                   ? SceneBuilder(context.network, context.rules, context.config.reach())
                   : SceneBuilder(context.network, context.rules)) {}

void PairwisePredictor::predict(const traffic::Observation& observation, traffic::BelievedGraph& belief,
                                Want want) {
    builder_.build(observation, scene_, want);
    observation_ = &observation;
    beliefs_.assign(scene_.tracks.size(), RowBelief{});
    believe(scene_, beliefs_);
    probabilities_.assign(scene_.candidates.size(), 0.0F);
    if (want == Want::links) score(scene_, beliefs_, probabilities_);
    check_probabilities();

    belief.time = observation.time;
    belief.signals = observation.signals;
    belief.roster = observation.roster;
    belief.own_states.clear();
    for (const traffic::ObservedVehicle& own : observation.own_states) {
        belief.own_states.push_back(own_belief(own));
    }
    place_vehicles(belief);
    links_.clear();
    if (want == Want::links) collect_links();
    write_links(belief);
}

void PairwisePredictor::check_probabilities() const {
    const auto fit = [](float probability) { return probability >= 0.0F && probability <= 1.0F; };
    const auto unfit = std::ranges::find_if_not(probabilities_, fit);
    if (unfit == probabilities_.end()) return;
    throw core::InputError({fmt::format("model of {}", name()), fmt::format("a probability of {}", *unfit),
                            "0 to 1", "Its numbers are damaged: use another file"});
}

CandidateScores PairwisePredictor::scores() const {
    return {&scene_, probabilities_};
}

void PairwisePredictor::score_by_place(const Scene& scene, const std::vector<RowBelief>& beliefs,
                                       std::vector<float>& probabilities) const {
    score_present(scene, beliefs, probabilities, [&](std::size_t at) {
        const RowBelief& left = beliefs[scene.candidates.rows[at].left];
        const RowBelief& right = beliefs[scene.candidates.rows[at].right];
        const float distance_m =
            std::hypot(left.state.x_m - right.state.x_m, left.state.y_m - right.state.y_m);
        return probability_within(static_cast<float>(rules_.radius_m), distance_m,
                                  std::hypot(left.sigma_m, right.sigma_m));
    });
}

void PairwisePredictor::score_by_distance(const Scene& scene, const std::vector<RowBelief>& beliefs,
                                          const std::vector<float>& distances_m,
                                          std::vector<float>& probabilities) const {
    score_present(scene, beliefs, probabilities, [&](std::size_t at) {
        const RowPair pair = scene.candidates.rows[at];
        return probability_within(static_cast<float>(rules_.radius_m), distances_m[at],
                                  std::hypot(beliefs[pair.left].sigma_m, beliefs[pair.right].sigma_m));
    });
}

void PairwisePredictor::place_vehicles(traffic::BelievedGraph& belief) {
    const Tracks& tracks = scene_.tracks;
    belief.vehicles.clear();
    believed_row_.resize(tracks.size());
    for (std::size_t row = 0; row < tracks.size(); ++row) {
        believed_row_[row] = static_cast<core::VehicleIndex>(belief.vehicles.size());
        const RowBelief& believed = beliefs_[row];
        if (!believed.present) continue;
        belief.vehicles.push_back({tracks.key[row], tracks.vehicle_class[row], believed.state,
                                   believed.sigma_m, tracks.age_s[row]});
    }
}

float PairwisePredictor::believed_distance_m(RowPair pair) const {
    const traffic::MotionState& left = beliefs_[pair.left].state;
    const traffic::MotionState& right = beliefs_[pair.right].state;
    const float across_m = left.x_m - right.x_m;
    const float along_m = left.y_m - right.y_m;
    return std::sqrt(across_m * across_m + along_m * along_m);
}

bool PairwisePredictor::both_present(RowPair pair) const {
    return beliefs_[pair.left].present && beliefs_[pair.right].present;
}

void PairwisePredictor::collect_links() {
    const auto radius_m = static_cast<float>(rules_.radius_m);
    for (const RowPair pair : scene_.known.rows) {
        const float distance_m = believed_distance_m(pair);
        if (distance_m < radius_m && both_present(pair)) links_.push_back({pair, distance_m, 1.0F});
    }
    group_.clear();
    for (std::size_t at = 0; at < scene_.candidates.size(); ++at) {
        const RowPair pair = scene_.candidates.rows[at];
        if (probabilities_[at] < threshold_ || probabilities_[at] <= 0.0F || !both_present(pair)) continue;
        group_.push_back({pair, believed_distance_m(pair), probabilities_[at]});
    }
    merge_group();
    collect_detected();
    merge_group();
}

void PairwisePredictor::collect_detected() {
    group_.clear();
    const auto below_radius_m = std::nextafter(static_cast<float>(rules_.radius_m), 0.0F);
    for (std::size_t at = 0; at < scene_.detected.size(); ++at) {
        const RowPair pair = scene_.detected.rows[at];
        if (!both_present(pair)) continue;
        const float range_m = scene_.detected_range_m[at];
        const float distance_m = range_m >= 0.0F ? range_m : believed_distance_m(pair);
        group_.push_back({pair, std::min(distance_m, below_radius_m), 1.0F});
    }
}

/// Merges `group_` into `links_`; both are ordered by rows.
void PairwisePredictor::merge_group() {
    if (group_.empty()) return;
    merged_.resize(links_.size() + group_.size());
    std::ranges::merge(links_, group_, merged_.begin(), {}, &Link::rows, &Link::rows);
    std::swap(links_, merged_);
}

void PairwisePredictor::write_links(traffic::BelievedGraph& belief) {
    const std::size_t rows = belief.vehicles.size();
    belief.first_link.assign(rows + 1, 0);
    for (Link& link : links_) {
        link.rows = {believed_row_[link.rows.left], believed_row_[link.rows.right]};
        ++belief.first_link[link.rows.left + 1];
        ++belief.first_link[link.rows.right + 1];
    }
    for (std::size_t row = 0; row < rows; ++row) {
        belief.first_link[row + 1] += belief.first_link[row];
    }
    belief.links.resize(2 * links_.size());
    // Pairs are ordered by (left, right): each row first meets its lower neighbours, then its higher ones,
    // ascending.
    for (const Link& link : links_) {
        belief.links[belief.first_link[link.rows.left]++] = {link.rows.right, link.distance_m,
                                                             link.probability};
        belief.links[belief.first_link[link.rows.right]++] = {link.rows.left, link.distance_m,
                                                              link.probability};
    }
    for (std::size_t row = rows; row > 0; --row) {
        belief.first_link[row] = belief.first_link[row - 1];
    }
    belief.first_link[0] = 0;
}

}  // namespace clearway::prediction::detail
