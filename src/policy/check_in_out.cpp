#include "policy/check_in_out.hpp"

#include <algorithm>

namespace clearway::policy {

void CheckInOut::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("check_in_out", context_.period, belief.time, leases);
    std::map<core::VehicleKey, double> left_m;
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        const double to_end_m =
            roads::distance_to_end(context_.network, view.route_of(emergency.key), emergency.state).value;
        left_m.emplace(emergency.key, to_end_m);
        for (detail::Approach& approach :
             detail::approaches(view, emergency, core::Metres(config_.check_in_m))) {
            const double released_m = to_end_m - approach.distance_m - config_.check_out_m;
            const core::SignalIndex signal = approach.signal;
            calls_.insert_or_assign({emergency.key, signal}, Call{std::move(approach), released_m});
        }
    }
    std::erase_if(calls_, [&](const auto& entry) {
        const auto vehicle = left_m.find(entry.first.first);
        return vehicle == left_m.end() || vehicle->second <= entry.second.released_m;
    });
    for (const auto& [request, call] : calls_) {
        write.add(request.second, traffic::HoldGreen{call.approach.links, call.approach.own_links},
                  "between the detectors", request.first);
    }
}

}  // namespace clearway::policy
