#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/ids.hpp"
#include "core/spellings.hpp"
#include "core/units.hpp"

namespace clearway::traffic {

// Commands from actuation to the simulator. The sender only issues legal commands; the simulator gateway
// checks them again and throws on a violation, because SUMO would ignore it silently.

/// Drive at most this fast, until ReleaseSpeed.
struct SetSpeed {
    core::VehicleKey vehicle;
    core::MetresPerSecond speed;
};
struct ReleaseSpeed {
    core::VehicleKey vehicle;
};
/// Change to lane `lane_number` of the present edge and stay for `duration`.
struct RequestLane {
    core::VehicleKey vehicle;
    std::uint32_t lane_number = 0;
    core::Seconds duration;
};
/// Ends a RequestLane before its duration is over.
struct ReleaseLane {
    core::VehicleKey vehicle;
};
/// Where a vehicle drives within its lane (sublane model only). `free`: anywhere, also across the line
/// between two lanes.
enum class LateralAlignment : std::uint8_t { usual, right, left, free };
struct SetLateralAlignment {
    core::VehicleKey vehicle;
    LateralAlignment alignment = LateralAlignment::usual;
};
/// Move sideways by `shift` as soon as the vehicle can, positive to the left (sublane model only). A new one
/// replaces the former.
struct SteerSideways {
    core::VehicleKey vehicle;
    core::Metres shift;
};
/// What a vehicle may do at junctions beyond the usual: `pass_red` drives through red slowly and yielding.
enum class JunctionPrivilege : std::uint8_t { none, pass_red };
struct SetJunctionPrivilege {
    core::VehicleKey vehicle;
    JunctionPrivilege privilege = JunctionPrivilege::none;
};
/// How the vehicle itself decides on lane changes (SUMO's laneChangeMode).
enum class LaneChangeFreedom : std::uint8_t { normal, strategic_only, none };
struct SetLaneChangeFreedom {
    core::VehicleKey vehicle;
    LaneChangeFreedom freedom = LaneChangeFreedom::normal;
};
/// Whether vehicles have a lateral position within their lane (SUMO's sublane model). Lateral alignment needs
/// it.
enum class LateralModel : std::uint8_t { lane, sublane };
/// Which of SUMO's safety checks hold (speedMode, laneChangeMode). `off` is for the experiment that shows
/// their effect.
enum class SafetyChecks : std::uint8_t { on, off };
constexpr core::Spellings<SafetyChecks, 2> spellings(SafetyChecks) {
    return {{{SafetyChecks::off, "off"}, {SafetyChecks::on, "on"}}};
}
struct SetSafetyChecks {
    core::VehicleKey vehicle;
    SafetyChecks checks = SafetyChecks::on;
};
/// Where a vehicle stands that stops: in its lane, or beside the road, where it is in nobody's way.
enum class StopPlace : std::uint8_t { on_lane, beside_road };
/// Stop at `position` on the present lane, or as soon after it as the usual deceleration allows. Has no
/// effect, and is counted, if that is beyond the end of the lane.
struct StopOnLane {
    core::VehicleKey vehicle;
    core::Metres position;
    core::Seconds duration;
    StopPlace place = StopPlace::on_lane;
};
/// Ends a StopOnLane, also before it is reached. A vehicle beside the road returns when there is room.
struct ResumeFromStop {
    core::VehicleKey vehicle;
};
/// Show exactly these letters, until RestoreProgram.
struct SetSignalState {
    core::SignalIndex signal;
    std::string state;
};
/// Return to the signal's background plan: to where it would be now, or to the start of `phase`, which then
/// lasts `lasting` or, without it, as long as the plan says.
struct RestoreProgram {
    core::SignalIndex signal;
    std::optional<std::uint32_t> phase = std::nullopt;
    std::optional<core::Seconds> lasting = std::nullopt;
};
/// Drive over these edges: the first is where the vehicle is, the last its destination. Skipped, and counted
/// as a command that was refused, where SUMO knows no such way for the vehicle or it is inside a junction.
struct SetRoute {
    core::VehicleKey vehicle;
    std::vector<core::EdgeIndex> edges;
};

using Command = std::variant<SetSpeed, ReleaseSpeed, RequestLane, SetLaneChangeFreedom, SetSafetyChecks,
                             StopOnLane, ResumeFromStop, SetSignalState, RestoreProgram, ReleaseLane,
                             SetLateralAlignment, SetJunctionPrivilege, SteerSideways, SetRoute>;

}  // namespace clearway::traffic
