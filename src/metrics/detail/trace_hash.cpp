#include "metrics/detail/trace_hash.hpp"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <variant>
#include <vector>

namespace clearway::metrics::detail {
namespace {

/// Adds values to a hash.
struct Adder {
    template <class Value>
    void value(Value number) {
        static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
        hash.add({reinterpret_cast<const char*>(&number), sizeof(number)});
    }

    /// For element types without padding. The length is hashed first, so that the boundary between two arrays
    /// counts.
    template <class Element>
    void array(const std::vector<Element>& elements) {
        static_assert(std::is_floating_point_v<Element> || std::has_unique_object_representations_v<Element>);
        value(static_cast<std::uint64_t>(elements.size()));
        hash.add({reinterpret_cast<const char*>(elements.data()), elements.size() * sizeof(Element)});
    }

    void text(std::string_view characters) {
        value(static_cast<std::uint64_t>(characters.size()));
        hash.add(characters);
    }

    void operator()(const traffic::DriveAt& action) { value(action.speed.value); }
    void operator()(const traffic::ChangeLane& action) { value(action.lane_number); }
    void operator()(const traffic::HoldLane&) {}
    void operator()(const traffic::PullAside& action) { value(action.side); }
    void operator()(const traffic::StopAtLine&) {}
    void operator()(const traffic::HoldGreen& action) {
        array(action.links);
        array(action.own_links);
    }
    void operator()(const traffic::AdjustGreen& action) { array(action.links); }
    void operator()(const traffic::PassRed&) {}
    void operator()(const traffic::StandBack&) {}
    void operator()(const traffic::TakeRoute& action) { array(action.edges); }
    void operator()(core::VehicleKey vehicle) { value(vehicle.value); }
    void operator()(core::SignalIndex signal) { value(signal.value); }
    void operator()(const traffic::Stretch& stretch) {
        value(stretch.lane.value);
        value(stretch.from_m);
        value(stretch.to_m);
        value(stretch.below_mps);
        value(stretch.addressed);
    }

    core::RunningHash& hash;
};

}  // namespace

void TraceHash::add(const truth::Snapshot& snapshot) {
    Adder adder{hash_};
    adder.value(snapshot.time.value);
    adder.array(snapshot.key);
    adder.array(snapshot.vehicle_class);
    adder.array(snapshot.x_m);
    adder.array(snapshot.y_m);
    adder.array(snapshot.heading_rad);
    adder.array(snapshot.speed_mps);
    adder.array(snapshot.acceleration_mps2);
    adder.array(snapshot.lane);
    adder.array(snapshot.lane_position_m);
    adder.array(snapshot.route_edge);
    for (const std::string& signal : snapshot.signals.state)
        adder.text(signal);
}

void TraceHash::add(std::span<const traffic::Lease> leases) {
    Adder adder{hash_};
    const auto counts = [](const traffic::Lease& lease) {
        return kind_of(lease) != traffic::LeaseKind::consider_way;
    };
    adder.value(static_cast<std::uint64_t>(std::ranges::count_if(leases, counts)));
    for (const traffic::Lease& lease : leases) {
        if (!counts(lease)) continue;
        adder.value(static_cast<std::uint64_t>(lease.target.index()));
        std::visit(adder, lease.target);
        adder.text(traffic::name(lease.action));
        std::visit(adder, lease.action);
        adder.value(lease.expiry.value);
        adder.value(lease.priority);
        adder.text(lease.policy);
        adder.text(lease.reason);
        adder.value(lease.beneficiary.value);
    }
}

}  // namespace clearway::metrics::detail
