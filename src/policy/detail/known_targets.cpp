#include "policy/detail/known_targets.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "core/error.hpp"
#include "python/channel.hpp"
#include "roads/exits.hpp"

namespace clearway::policy::detail {
namespace {

/// The links that a lease asks of a signal.
std::span<const std::uint16_t> links_of(const traffic::Action& action) {
    if (const auto* hold = std::get_if<traffic::HoldGreen>(&action)) return hold->links;
    if (const auto* adjust = std::get_if<traffic::AdjustGreen>(&action)) return adjust->links;
    return {};
}

}  // namespace

void KnownTargets::see(const traffic::BelievedGraph& belief) {
    for (const traffic::BelievedVehicle& vehicle : belief.vehicles)
        vehicles_.insert(vehicle.key.value);
    for (const traffic::BelievedVehicle& emergency : belief.own_states)
        vehicles_.insert(emergency.key.value);
}

void KnownTargets::check(const traffic::Lease& lease) const {
    if (const auto* vehicle = std::get_if<core::VehicleKey>(&lease.target)) check(*vehicle);
    if (const auto* signal = std::get_if<core::SignalIndex>(&lease.target)) check(*signal, lease.action);
    if (const auto* way = std::get_if<traffic::TakeRoute>(&lease.action)) check(*way);
}

void KnownTargets::check(core::VehicleKey vehicle) const {
    if (vehicles_.contains(vehicle.value)) return;
    throw python::PartError(fmt::format(
        "a lease is for vehicle {}, which was never in a belief (allowed: belief.vehicles.key[row], "
        "or an EmergencyVehicle; a row is no key)",
        vehicle.value));
}

void KnownTargets::check(core::SignalIndex signal, const traffic::Action& action) const {
    const std::size_t signals = network_.signals().size();
    if (signal.value >= signals)
        throw python::PartError(fmt::format(
            "a lease is for signal {} (allowed: {})", signal.value,
            signals == 0 ? "none, the network has no signals" : fmt::format("0 to {}", signals - 1)));
    const std::size_t links = network_.signal(signal).links.size();
    for (const std::uint16_t link : links_of(action)) {
        if (link >= links)
            throw python::PartError(fmt::format("a lease asks for link {} of signal {} (allowed: 0 to {})",
                                                link, signal.value, links - 1));
    }
}

void KnownTargets::check(const traffic::TakeRoute& way) const {
    const std::size_t edges = network_.edges().size();
    for (const core::EdgeIndex edge : way.edges) {
        if (edge.value >= edges)
            throw python::PartError(
                fmt::format("a lease takes a way over edge {} (allowed: 0 to {}, rows of "
                            "belief.network.edge_ids)",
                            edge.value, edges - 1));
    }
    for (std::size_t at = 0; at + 1 < way.edges.size(); ++at)
        check_turn(way.edges[at], way.edges[at + 1]);
}

void KnownTargets::check_turn(core::EdgeIndex from, core::EdgeIndex to) const {
    const std::vector<core::EdgeIndex> exits = roads::exits(network_, from, roads::Driver::emergency);
    if (std::ranges::binary_search(exits, to)) return;
    const auto ids = core::texts_of(exits, [&](core::EdgeIndex edge) { return network_.edge(edge).id; });
    throw python::PartError(fmt::format(
        "a lease takes a way with a gap: no emergency vehicle gets from edge \"{}\" to edge \"{}\" "
        "(allowed next: {}; belief.network.onward has them for every edge)",
        network_.edge(from).id, network_.edge(to).id, ids.empty() ? "none" : core::listed(ids)));
}

}  // namespace clearway::policy::detail
