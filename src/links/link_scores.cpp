#include "links/link_scores.hpp"

#include <algorithm>

namespace clearway::links {
namespace {

std::size_t cell_of(std::size_t age_class, bool hard) {
    return 2 * age_class + (hard ? 1 : 0);
}

}  // namespace

std::string_view name(LinkSubset subset) {
    switch (subset) {
        case LinkSubset::all:
            return "all";
        case LinkSubset::hard:
            return "hard";
        case LinkSubset::policy:
            return "policy";
    }
    return "";
}

bool is_hard(float last_seen_m, float dead_reckoned_m, float radius_m) {
    const bool near_the_radius = dead_reckoned_m >= 0.5F * radius_m && dead_reckoned_m < 1.5F * radius_m;
    return near_the_radius || (last_seen_m < radius_m) != (dead_reckoned_m < radius_m);
}

std::size_t age_class_of(float age_s) {
    return static_cast<std::size_t>(std::ranges::lower_bound(age_ends_s, age_s) - age_ends_s.begin());
}

LinkSummary LinkScoreSummary::of(LinkSubset subset) const {
    if (subset == LinkSubset::policy) return policy;
    LinkSummary sum;
    for (std::size_t age_class = 0; age_class < age_classes; ++age_class) {
        if (subset == LinkSubset::all) sum.add(cells[cell_of(age_class, false)]);
        sum.add(cells[cell_of(age_class, true)]);
    }
    return sum;
}

LinkSummary LinkScoreSummary::of_age(std::size_t age_class) const {
    LinkSummary sum = cells[cell_of(age_class, false)];
    sum.add(cells[cell_of(age_class, true)]);
    return sum;
}

void LinkScoreSummary::add(const LinkScoreSummary& other) {
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
        cells[cell].add(other.cells[cell]);
    policy.add(other.policy);
}

void LinkScores::add(float probability, bool linked, const PairTraits& traits) {
    cells_[cell_of(traits.age_class, traits.hard)].add(probability, linked);
    if (traits.ahead_of_emergency) policy_.add(probability, linked);
}

LinkScoreSummary LinkScores::summary() const {
    LinkScoreSummary summary;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell)
        summary.cells[cell] = cells_[cell].summary();
    summary.policy = policy_.summary();
    return summary;
}

}  // namespace clearway::links
