#include "metrics/detail/conflict_watch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace clearway::metrics::detail {

void ConflictWatch::step(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    find_near(snapshot);
    std::ranges::sort(near_, [&](core::VehicleIndex left, core::VehicleIndex right) {
        if (snapshot.lane[left] != snapshot.lane[right]) return snapshot.lane[left] < snapshot.lane[right];
        return snapshot.lane_position_m[left] < snapshot.lane_position_m[right];
    });
    in_conflict_.clear();
    for (std::size_t place = 1; place < near_.size(); ++place) {
        if (snapshot.lane[near_[place - 1]] == snapshot.lane[near_[place]])
            judge(snapshot, roster, near_[place - 1], near_[place]);
    }
    count_begun();
}

void ConflictWatch::find_near(const truth::Snapshot& snapshot) {
    near_.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] != traffic::VehicleClass::emergency) continue;
        const float x_m = snapshot.x_m[row];
        const float y_m = snapshot.y_m[row];
        for (core::VehicleIndex other = 0; other < snapshot.size(); ++other) {
            if (std::abs(snapshot.x_m[other] - x_m) < near_m &&
                std::abs(snapshot.y_m[other] - y_m) < near_m && snapshot.lane[other].exists())
                near_.push_back(other);
        }
    }
    std::ranges::sort(near_);
    near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
}

void ConflictWatch::judge(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                          core::VehicleIndex follower, core::VehicleIndex leader) {
    assert(snapshot.lane_position_m[follower] <= snapshot.lane_position_m[leader]);
    const double closing_mps = snapshot.speed_mps[follower] - snapshot.speed_mps[leader];
    if (closing_mps <= 0.0) return;
    const traffic::VehicleInfo* info = roster.find(snapshot.key[leader]);
    if (info == nullptr) return;
    const double gap_m =
        snapshot.lane_position_m[leader] - info->length_m - snapshot.lane_position_m[follower];
    if (gap_m <= 0.0) return;
    const double ttc_s = gap_m / closing_mps;
    least_ttc_s_ = std::min(least_ttc_s_.value_or(ttc_s), ttc_s);
    const double drac_mps2 = closing_mps * closing_mps / (2.0 * gap_m);
    greatest_drac_mps2_ = std::max(greatest_drac_mps2_.value_or(drac_mps2), drac_mps2);
    if (ttc_s < conflict_s) in_conflict_.push_back(snapshot.key[follower]);
}

void ConflictWatch::count_begun() {
    std::ranges::sort(in_conflict_);
    for (const core::VehicleKey vehicle : in_conflict_) {
        if (!std::ranges::binary_search(were_in_conflict_, vehicle)) ++conflicts_;
    }
    were_in_conflict_.swap(in_conflict_);
}

}  // namespace clearway::metrics::detail
