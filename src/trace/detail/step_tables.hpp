#pragma once

#include "trace/detail/belief_tables.hpp"
#include "trace/detail/event_tables.hpp"
#include "trace/detail/lease_tables.hpp"
#include "trace/detail/observation_tables.hpp"
#include "trace/detail/roster_tables.hpp"
#include "trace/detail/snapshot_tables.hpp"

namespace clearway::trace::detail {

/// Does not compile when one of the structs gains or loses a member: then the columns and `recording_format`
/// must change. Not recorded: vehicles parked beside the road, because a replay sends no requests,
/// and commanded stops, because it measures no time lost.
inline void every_member_has_a_column(const traffic::Lease& lease, const truth::Events& events,
                                      const truth::Snapshot& snapshot,
                                      const traffic::Observation& observation,
                                      const traffic::BelievedGraph& belief) {
    [[maybe_unused]] const auto& [l1, l2, l3, l4, l5, l6, l7] = lease;
    [[maybe_unused]] const auto& [g1, g2] = traffic::HoldGreen{};
    [[maybe_unused]] const auto& [t1, t2, t3, t4, t5] = traffic::Stretch{};
    [[maybe_unused]] const auto& [x1, x2, x3] = traffic::KnownIncident{};
    [[maybe_unused]] const auto& [e1, e2, e3, e4, e5, e6, e7] = events;
    [[maybe_unused]] const auto& [c1, c2, c3, c4, c5] = truth::Collision{};
    [[maybe_unused]] const auto& [k1, k2] = truth::EmergencyBraking{};
    [[maybe_unused]] const auto& [s1, s2, s3, s4, s5, s6, s7, s8, s9, s10, s11, s12, s13, s14] = snapshot;
    [[maybe_unused]] const auto& [o1, o2, o3, o4, o5, o6, o7, o8, o9, o10] = observation;
    [[maybe_unused]] const auto& [v1, v2, v3, v4, v5, v6] = traffic::ObservedVehicle{};
    [[maybe_unused]] const auto& [d1, d2, d3, d4] = traffic::DetectedLink{};
    [[maybe_unused]] const auto& [m1, m2, m3, m4, m5, m6, m7] = traffic::MotionState{};
    [[maybe_unused]] const auto& [b1, b2, b3, b4, b5, b6, b7, b8] = belief;
    [[maybe_unused]] const auto& [w1, w2, w3, w4, w5] = traffic::BelievedVehicle{};
    [[maybe_unused]] const auto& [n1, n2, n3] = traffic::BelievedLink{};
    [[maybe_unused]] const auto& [i1, i2, i3, i4, i5, i6, i7, i8, i9, i10, i11, i12] = traffic::VehicleInfo{};
}

/// All tables of a recording.
template <class File>
struct StepTables {
    explicit StepTables(File& tables) : file(tables) {}

    File& file;
    Names names;
    KnownStates known;
    SnapshotTables<File> snapshot{file, names};
    EventTables<File> events{file, names};
    RosterTables<File> roster{file, "", names};
    ObservationTables<File> observation{file, names};
    BeliefTables<File> belief{file, names};
    LeaseTables<File> leases{file, names};
};

}  // namespace clearway::trace::detail
