#include "metrics/detail/considered_watch.hpp"

#include <algorithm>

namespace clearway::metrics::detail {

void ConsideredWatch::step(const traffic::Roster& roster, std::span<const traffic::Lease> leases) {
    for (const traffic::Lease& lease : leases) {
        const auto* const back = std::get_if<traffic::StandBack>(&lease.action);
        const auto* const vehicle = std::get_if<core::VehicleKey>(&lease.target);
        const traffic::VehicleInfo* const info =
            back == nullptr || vehicle == nullptr ? nullptr : roster.find(*vehicle);
        if (info == nullptr || !info->route.exists()) continue;
        const auto& own = roster.route(info->route);
        for (const core::EdgeIndex edge : back->way)
            if (std::ranges::find(own, edge) == own.end()) ++decisions_[{info->id, edge}];
    }
}

std::vector<ConsideredRow> ConsideredWatch::rows() const {
    std::vector<ConsideredRow> rows;
    for (const auto& [place, decisions] : decisions_)
        rows.push_back({place.first, layout_.chain.edge_ids.at(place.second.value), decisions});
    return rows;
}

}  // namespace clearway::metrics::detail
