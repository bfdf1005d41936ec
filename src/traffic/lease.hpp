#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <string_view>
#include <variant>
#include <vector>

#include "core/ids.hpp"
#include "core/spellings.hpp"
#include "core/units.hpp"
#include "traffic/observation.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::traffic {

/// Drive at `speed` as far as safety allows.
struct DriveAt {
    core::MetresPerSecond speed;
};
/// Move to the lane with this number on the present edge (0 is the outermost: right where traffic drives on
/// the right) and stay there while the lease lasts.
struct ChangeLane {
    std::uint32_t lane_number = 0;
};
/// Do not change lanes except where the route demands it.
struct HoldLane {};
/// Make room at the side: in the sublane model drive at the right or the left edge of the lane; without it
/// stop beside the road, until the lease ends.
enum class Side : std::uint8_t { right, left };
struct PullAside {
    Side side = Side::right;
};
/// Give way at the stop line of the present lane: stop there although the signal may be green.
struct StopAtLine {};
/// Show green for these links of a signal and red for those that conflict, with yellow and all-red between.
struct HoldGreen {
    std::vector<std::uint16_t> links;  ///< Link numbers of the signal, ascending.
    /// Those that the beneficiary itself may take, ascending; empty means all. The others may yield when
    /// another hold is served at the same time.
    std::vector<std::uint16_t> own_links = {};
};
/// Lead a signal's background plan to these links sooner, by ending greens that serve none of them: this
/// gives time back to the approaches that waited.
struct AdjustGreen {
    std::vector<std::uint16_t> links;
};
/// Pass red signals slowly and yielding, as the law of many countries allows emergency vehicles.
struct PassRed {};
/// Nothing: the policy would act, but stands back, because the situation is not one that it is for. For the
/// emergency vehicle that it does not serve; refused as `stood_back`, so that every table counts it.
struct StandBack {
    std::vector<core::EdgeIndex> way = {};  ///< Another way that it considered, as TakeRoute has it.
};
/// Take another way to the same destination. For emergency vehicles. A way that was taken stays when the
/// lease ends.
struct TakeRoute {
    /// In driving order, from the edge where the vehicle is, or one that it was on since, to the last one of
    /// its present route.
    std::vector<core::EdgeIndex> edges;
};

using Action = std::variant<DriveAt, ChangeLane, HoldLane, PullAside, StopAtLine, HoldGreen, AdjustGreen,
                            PassRed, StandBack, TakeRoute>;

/// Which vehicles a message to a stretch of road addresses.
enum class Addressed : std::uint8_t { automated, drivers };
/// A stretch of a lane, for a message to the vehicles there (geocast): those whose front is between `from_m`
/// and `to_m`, and which are slower than `below_mps`. The sender need not know which they are. Each vehicle
/// that receives the message knows its own place and speed.
struct Stretch {
    core::LaneIndex lane;
    float from_m = 0.0F;  ///< From the start of the lane.
    float to_m = 0.0F;
    float below_mps = std::numeric_limits<float>::max();
    Addressed addressed = Addressed::automated;  ///< `drivers`: automated vehicles and human drivers.

    /// Never an emergency vehicle.
    bool has(VehicleClass vehicle_class, const MotionState& state) const;
    auto operator<=>(const Stretch&) const = default;
};

/// What a lease controls, or who is asked for it.
using Target = std::variant<core::VehicleKey, core::SignalIndex, Stretch>;

/// One action of a policy. It ends by itself at `expiry`: a policy renews it or lets it lapse, but never
/// releases it.
struct Lease {
    Target target;
    Action action;
    core::Seconds expiry;  ///< Simulation time; later than now.
    /// When two leases for one target conflict, the higher priority wins; at equal priority, a hold that is
    /// already being served; then the earlier lease.
    int priority = 0;
    const char* policy = "";       ///< Name of the policy that issued it (static storage).
    const char* reason = "";       ///< Why, in a few words (static storage).
    core::VehicleKey beneficiary;  ///< The emergency vehicle it serves; value 0 for none.
};

/// What leases are counted by, by the alphabet, as in tables: the kinds of actions, and changes of lane that
/// an emergency vehicle makes for itself. What others do for it is one thing, which lane it chooses another.
/// To consider a way is to stand back from another one.
enum class LeaseKind : std::uint8_t {
    adjust_green,
    change_lane,
    consider_way,
    drive_at,
    hold_green,
    hold_lane,
    own_change_lane,
    pass_red,
    pull_aside,
    stand_back,
    stop_at_line,
    take_route,
};
constexpr core::Spellings<LeaseKind, 12> spellings(LeaseKind) {
    return {{{LeaseKind::adjust_green, "adjust_green"},
             {LeaseKind::change_lane, "change_lane"},
             {LeaseKind::consider_way, "consider_way"},
             {LeaseKind::drive_at, "drive_at"},
             {LeaseKind::hold_green, "hold_green"},
             {LeaseKind::hold_lane, "hold_lane"},
             {LeaseKind::own_change_lane, "own_change_lane"},
             {LeaseKind::pass_red, "pass_red"},
             {LeaseKind::pull_aside, "pull_aside"},
             {LeaseKind::stand_back, "stand_back"},
             {LeaseKind::stop_at_line, "stop_at_line"},
             {LeaseKind::take_route, "take_route"}}};
}
using core::name;
LeaseKind kind_of(const Lease& lease);

/// `drive_at`, `change_lane`, ...
std::string_view name(const Action& action);

}  // namespace clearway::traffic
