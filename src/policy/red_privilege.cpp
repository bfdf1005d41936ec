#include "policy/red_privilege.hpp"

#include <algorithm>

#include "policy/detail/approach.hpp"
#include "traffic/signal.hpp"

namespace clearway::policy {
namespace {

constexpr char part_name[] = "red_privilege";

}  // namespace

RedPrivilege::RedPrivilege(const PartContext& context, RedPrivilegeConfig config)
    : network_(context.network), config_(config) {}

void RedPrivilege::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(network_, belief);
    detail::LeaseWriter write(part_name, belief.time, leases);
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        const auto ahead = detail::approaches(view, emergency, core::Metres(config_.near_m));
        const bool stands_before_red = std::ranges::any_of(ahead, [&](const detail::Approach& approach) {
            const std::string& shown = belief.signals.state[approach.signal.value];
            return std::ranges::any_of(approach.own_links, [&](std::uint16_t link) {
                return link >= shown.size() || !traffic::is_green(shown[link]);
            });
        });
        if (stands_before_red)
            write.add(emergency.key, traffic::PassRed{}, "a red signal ahead", emergency.key);
    }
}

}  // namespace clearway::policy
