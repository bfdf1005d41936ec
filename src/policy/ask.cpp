#include "policy/ask.hpp"

#include <algorithm>
#include <cassert>

namespace clearway::policy {
namespace {

/// Rows reached from `start` over links of enough probability, by the number of links; 0: not reached.
std::vector<int> hops_from(const traffic::BelievedGraph& belief, core::VehicleIndex start,
                           const AskSettings& settings) {
    std::vector<int> hops(belief.vehicles.size(), 0);
    std::vector<core::VehicleIndex> senders = {start};
    for (int hop = 1; hop <= settings.ask_hops; ++hop) {
        std::vector<core::VehicleIndex> relays;
        for (const core::VehicleIndex sender : senders) {
            for (const traffic::BelievedLink& link : belief.links_of(sender)) {
                assert(link.neighbour < hops.size());
                const bool is_new = link.neighbour != start && hops[link.neighbour] == 0;
                if (!is_new || link.probability < settings.ask_probability) continue;
                hops[link.neighbour] = hop;
                if (hop < settings.ask_hops &&
                    belief.vehicles[link.neighbour].vehicle_class == traffic::VehicleClass::automated)
                    relays.push_back(link.neighbour);
            }
        }
        senders = std::move(relays);
    }
    return hops;
}

}  // namespace

Audience::Audience(const traffic::BelievedGraph& belief, core::VehicleKey emergency,
                   const AskSettings& settings)
    : ask_(settings.ask), with_humans_(settings.ask_humans != 0) {
    if (ask_ == Ask::everyone) return;
    const traffic::BelievedVehicle* const itself = belief.find(emergency);
    if (itself == nullptr) return;
    assert(itself->vehicle_class == traffic::VehicleClass::emergency);
    const auto start = static_cast<core::VehicleIndex>(itself - belief.vehicles.data());
    const std::vector<int> hops = hops_from(belief, start, settings);
    linked_.reserve(hops.size() - static_cast<std::size_t>(std::ranges::count(hops, 0)));
    for (std::size_t row = 0; row < hops.size(); ++row) {
        if (hops[row] > 0) linked_.push_back(belief.vehicles[row].key);
    }
}

bool Audience::has(const traffic::BelievedVehicle& vehicle) const {
    const bool can_be_asked = vehicle.vehicle_class == traffic::VehicleClass::automated ||
                              (with_humans_ && vehicle.vehicle_class == traffic::VehicleClass::human);
    return can_be_asked && (ask_ == Ask::everyone || std::ranges::binary_search(linked_, vehicle.key));
}

}  // namespace clearway::policy
