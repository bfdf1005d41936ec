#include "metrics/link_comparison.hpp"

#include <cassert>
#include <utility>

namespace clearway::metrics {

void BeliefMatch::match(const truth::Snapshot& snapshot, const traffic::BelievedGraph& belief) {
    believed_key_.clear();
    for (const traffic::BelievedVehicle& vehicle : belief.vehicles)
        believed_key_.push_back(vehicle.key);
    core::match_rows(believed_key_, snapshot.key, true_row_);
    core::match_rows(snapshot.key, believed_key_, believed_row_);
}

void LinkComparison::find_dark(const traffic::BelievedGraph& belief, float fresh_age_s) {
    believed_is_dark_.clear();
    for (const traffic::BelievedVehicle& vehicle : belief.vehicles)
        believed_is_dark_.push_back(vehicle.age_s <= fresh_age_s ? 0 : 1);
    row_is_dark_.clear();
    for (const core::VehicleIndex believed : match_.believed_rows())
        row_is_dark_.push_back(believed == core::no_row ? 1 : believed_is_dark_[believed]);
}

void LinkComparison::add(const truth::Snapshot& snapshot, const TrueLinks& truth,
                         const traffic::BelievedGraph& belief, float fresh_age_s) {
    match_.match(snapshot, belief);
    find_dark(belief, fresh_age_s);
    LinkCounts now;
    LinkCounts now_dark;
    match_.for_each_link(belief, truth, [&](core::VehicleIndex left, core::VehicleIndex right, bool is_true) {
        const bool is_dark = (believed_is_dark_[left] | believed_is_dark_[right]) != 0;
        ++(is_true ? now.true_positive : now.false_positive);
        if (is_dark) ++(is_true ? now_dark.true_positive : now_dark.false_positive);
    });
    std::uint64_t dark_links = 0;
    for (core::VehicleIndex left = 0; left < truth.graph().vehicle_count(); ++left) {
        for (const core::VehicleIndex right : truth.graph().neighbours_of(left)) {
            if (right > left && (row_is_dark_[left] | row_is_dark_[right]) != 0) ++dark_links;
        }
    }
    now.false_negative = truth.link_count() - now.true_positive;
    assert(now.true_positive <= truth.link_count() && now_dark.true_positive <= dark_links);
    now_dark.false_negative = dark_links - now_dark.true_positive;
    for (auto [total, part] : {std::pair(&all, &now), std::pair(&dark, &now_dark)}) {
        total->true_positive += part->true_positive;
        total->false_positive += part->false_positive;
        total->false_negative += part->false_negative;
    }
}

}  // namespace clearway::metrics
