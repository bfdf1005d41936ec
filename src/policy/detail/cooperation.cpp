#include "policy/detail/cooperation.hpp"

#include <algorithm>
#include <cassert>

namespace clearway::policy::detail {

void AsideMemory::keep_only(const std::vector<traffic::BelievedVehicle>& emergencies) {
    assert(std::ranges::is_sorted(emergencies, {}, &traffic::BelievedVehicle::key));
    std::erase_if(asked_, [&](const auto& entry) {
        return !std::ranges::binary_search(emergencies, entry.first, {}, &traffic::BelievedVehicle::key);
    });
}

void AsideMemory::note(const traffic::BelievedVehicle& emergency, const traffic::BelievedVehicle& asked) {
    asked_[emergency.key][asked.key] = asked.state;
}

void AsideMemory::renew(const View& view, const traffic::BelievedVehicle& emergency,
                        const std::function<bool(const traffic::MotionState&)>& in_the_way,
                        LeaseWriter& write) {
    const auto mine = asked_.find(emergency.key);
    if (mine == asked_.end()) return;
    std::erase_if(mine->second, [&](const auto& entry) {
        if (view.belief().find(entry.first) != nullptr || !in_the_way(entry.second)) return true;
        write.add(entry.first, traffic::PullAside{}, "stays aside until the emergency vehicle has passed",
                  emergency.key);
        return false;
    });
}

}  // namespace clearway::policy::detail
