#include "policy/timed_holds.hpp"

#include <algorithm>
#include <iterator>

#include "policy/detail/approach.hpp"

namespace clearway::policy {

std::span<const traffic::Lease> TimedHolds::in_place_of(std::span<const traffic::Lease> leases,
                                                        const traffic::BelievedGraph& belief,
                                                        bool is_decision) {
    if (from_.empty()) return leases;
    leases_.clear();
    std::ranges::copy_if(leases, std::back_inserter(leases_), [&](const traffic::Lease& lease) {
        const auto* const signal = std::get_if<core::SignalIndex>(&lease.target);
        return signal == nullptr || !std::holds_alternative<traffic::HoldGreen>(lease.action) ||
               !from_.contains({lease.beneficiary, *signal});
    });
    if (is_decision) add(belief);
    return leases_;
}

void TimedHolds::add(const traffic::BelievedGraph& belief) {
    constexpr core::Metres horizon(1000.0);  // farther than where times are set
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("timed_holds", context_.period, belief.time, leases_);
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        for (detail::Approach& approach : detail::approaches(view, emergency, horizon)) {
            const auto set = from_.find({emergency.key, approach.signal});
            if (set == from_.end() || belief.time < set->second) continue;
            write.add(approach.signal, traffic::HoldGreen{approach.links, approach.own_links},
                      "from a time that was set", emergency.key);
        }
    }
}

}  // namespace clearway::policy
