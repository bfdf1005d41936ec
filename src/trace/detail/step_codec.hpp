#pragma once

#include "trace/detail/belief_codec.hpp"
#include "trace/detail/observation_codec.hpp"
#include "trace/detail/roster_codec.hpp"
#include "trace/detail/snapshot_codec.hpp"

namespace clearway::trace::detail {

// One description of a recorded step for both ways: `Stream` is a NumberWriter, and the structs are const, or
// a NumberReader that fills them. What a reader can foresee comes from the step before: a vehicle moves on
// as it did, at the speed that it has now; a report says what the snapshot says; a belief says what was
// reported. All of it is arithmetic that IEEE 754 defines to the bit; functions of the mathematical library
// are not used, for their last bit differs between machines.

/// Does not compile when one of the structs gets or loses a member: it must be coded below, and
/// `recording_format` raised.
inline void every_member_is_coded(const traffic::Lease& lease, const truth::Events& events,
                                  const truth::Snapshot& snapshot, const traffic::Observation& observation,
                                  const traffic::BelievedGraph& belief) {
    [[maybe_unused]] const auto& [l1, l2, l3, l4, l5, l6, l7] = lease;
    [[maybe_unused]] const auto& [g1, g2] = traffic::HoldGreen{};
    [[maybe_unused]] const auto& [e1, e2, e3, e4, e5, e6, e7] = events;
    [[maybe_unused]] const auto& [c1, c2, c3, c4, c5] = truth::Collision{};
    [[maybe_unused]] const auto& [k1, k2] = truth::EmergencyBraking{};
    [[maybe_unused]] const auto& [s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12] = snapshot;
    [[maybe_unused]] const auto& [o1, o2, o3, o4, o5, o6, o7, o8, o9] = observation;
    [[maybe_unused]] const auto& [v1, v2, v3, v4, v5, v6] = traffic::ObservedVehicle{};
    [[maybe_unused]] const auto& [d1, d2, d3, d4] = traffic::DetectedLink{};
    [[maybe_unused]] const auto& [m1, m2, m3, m4, m5, m6, m7] = traffic::MotionState{};
    [[maybe_unused]] const auto& [b1, b2, b3, b4, b5, b6, b7] = belief;
    [[maybe_unused]] const auto& [w1, w2, w3, w4, w5] = traffic::BelievedVehicle{};
    [[maybe_unused]] const auto& [n1, n2, n3] = traffic::BelievedLink{};
    [[maybe_unused]] const auto& [i1, i2, i3, i4, i5, i6, i7, i8, i9, i10, i11, i12] = traffic::VehicleInfo{};
}

}  // namespace clearway::trace::detail
