#include "metrics/detail/trace_hash.hpp"

#include <cstdint>
#include <type_traits>
#include <variant>
#include <vector>

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace clearway::metrics::detail {

struct TraceHash::State {
    State() { XXH3_128bits_reset(&hash); }

    template <class Value>
    void value(Value number) {
        static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
        XXH3_128bits_update(&hash, &number, sizeof(number));
    }

    /// For element types without padding. The length is hashed first, so that the boundary between two arrays
    /// counts.
    template <class Element>
    void array(const std::vector<Element>& elements) {
        static_assert(std::is_floating_point_v<Element> || std::has_unique_object_representations_v<Element>);
        value(static_cast<std::uint64_t>(elements.size()));
        XXH3_128bits_update(&hash, elements.data(), elements.size() * sizeof(Element));
    }

    void text(std::string_view characters) {
        value(static_cast<std::uint64_t>(characters.size()));
        XXH3_128bits_update(&hash, characters.data(), characters.size());
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
    void operator()(core::VehicleKey vehicle) { value(vehicle.value); }
    void operator()(core::SignalIndex signal) { value(signal.value); }
    void operator()(const traffic::Stretch& stretch) {
        value(stretch.lane.value);
        value(stretch.from_m);
        value(stretch.to_m);
        value(stretch.below_mps);
        value(stretch.addressed);
    }

    XXH3_state_t hash{};
};

TraceHash::TraceHash() : state_(std::make_unique<State>()) {}
TraceHash::~TraceHash() = default;
TraceHash::TraceHash(TraceHash&&) noexcept = default;
TraceHash& TraceHash::operator=(TraceHash&&) noexcept = default;

void TraceHash::add(const truth::Snapshot& snapshot) {
    State& state = *state_;
    state.value(snapshot.time.value);
    state.array(snapshot.key);
    state.array(snapshot.vehicle_class);
    state.array(snapshot.x_m);
    state.array(snapshot.y_m);
    state.array(snapshot.heading_rad);
    state.array(snapshot.speed_mps);
    state.array(snapshot.acceleration_mps2);
    state.array(snapshot.lane);
    state.array(snapshot.lane_position_m);
    state.array(snapshot.route_edge);
    for (const std::string& signal : snapshot.signals.state)
        state.text(signal);
}

void TraceHash::add(std::span<const traffic::Lease> leases) {
    State& state = *state_;
    state.value(static_cast<std::uint64_t>(leases.size()));
    for (const traffic::Lease& lease : leases) {
        state.value(static_cast<std::uint64_t>(lease.target.index()));
        std::visit(state, lease.target);
        state.text(traffic::name(lease.action));
        std::visit(state, lease.action);
        state.value(lease.expiry.value);
        state.value(lease.priority);
        state.text(lease.policy);
        state.text(lease.reason);
        state.value(lease.beneficiary.value);
    }
}

std::string TraceHash::digest() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_->hash);
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace clearway::metrics::detail
