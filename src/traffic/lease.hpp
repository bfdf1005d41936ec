#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"

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

using Action =
    std::variant<DriveAt, ChangeLane, HoldLane, PullAside, StopAtLine, HoldGreen, AdjustGreen, PassRed>;

/// What a lease controls.
using Target = std::variant<core::VehicleKey, core::SignalIndex>;

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

/// `drive_at`, `change_lane`, ...
std::string_view name(const Action& action);

}  // namespace clearway::traffic
