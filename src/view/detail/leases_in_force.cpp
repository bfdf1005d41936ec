#include "view/detail/leases_in_force.hpp"

#include <algorithm>

#include "core/units.hpp"

namespace clearway::view::detail {
namespace {

/// Whether a hold has what it asks for: green for the beneficiary's own links, or else for all.
bool is_granted(const traffic::HoldGreen& hold, const std::string& state) {
    const std::vector<std::uint16_t>& wanted = hold.own_links.empty() ? hold.links : hold.own_links;
    return !wanted.empty() && std::ranges::all_of(wanted, [&](std::uint16_t link) {
        return traffic::is_green_for(state, link);
    });
}

}  // namespace

LeasesInForce::Changes LeasesInForce::step(double time_s, std::span<const traffic::Lease> leases,
                                           const traffic::SignalStates& signals) {
    Changes changes;
    std::erase_if(leases_, [&](const auto& entry) {
        return entry.second.expiry_s <= time_s + core::clock_tolerance_s;
    });
    for (const traffic::Lease& lease : leases) {
        const auto [at, is_new] =
            leases_.try_emplace(Key{lease.target, lease.action.index(), lease.policy, lease.beneficiary});
        const bool granted = at->second.granted;
        at->second = {lease.target,      lease.action, lease.expiry.value, lease.policy, lease.reason,
                      lease.beneficiary, granted};
        if (is_new && std::holds_alternative<traffic::HoldGreen>(lease.action))
            changes.requested.push_back({std::get<core::SignalIndex>(lease.target), lease.beneficiary});
    }
    for (auto& [key, lease] : leases_) {
        const auto* const hold = std::get_if<traffic::HoldGreen>(&lease.action);
        const auto* const signal = std::get_if<core::SignalIndex>(&lease.target);
        if (hold == nullptr || signal == nullptr || lease.granted) continue;
        if (signal->value >= signals.state.size() || !is_granted(*hold, signals.state[signal->value]))
            continue;
        lease.granted = true;
        changes.granted.push_back({*signal, lease.beneficiary});
    }
    return changes;
}

}  // namespace clearway::view::detail
