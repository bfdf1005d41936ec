#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "actuation/actuator_config.hpp"
#include "actuation/detail/lease_queue.hpp"
#include "roads/network.hpp"
#include "traffic/command.hpp"
#include "traffic/incident.hpp"
#include "traffic/vehicle.hpp"
#include "truth/self_knowledge.hpp"
#include "truth/snapshot.hpp"

namespace clearway::actuation::detail {

/// What is needed to judge a vehicle's leases.
struct VehicleContext {
    const roads::Network& network;
    const truth::Snapshot& snapshot;
    const traffic::Roster& roster;
    const truth::SelfKnowledge& self;
    traffic::SafetyChecks safety_checks = traffic::SafetyChecks::on;
    traffic::LateralModel lateral_model = traffic::LateralModel::lane;
    core::Seconds step;                         ///< Time since the last step; 0 at the first.
    std::span<const core::VehicleKey> heeding;  ///< Human drivers who take leases, ordered.
    std::span<const traffic::KnownIncident> incidents;
};

/// A lane that a vehicle is kept on.
struct LaneRequest {
    std::uint32_t lane_number = 0;
    core::Seconds until;
};

/// A place before a junction where a vehicle stands, or is about to.
struct LineStop {
    core::LaneIndex lane;
    double position_m = 0.0;

    bool operator==(const LineStop&) const = default;
};

/// Differences from an uncontrolled vehicle. The default has none.
struct VehicleSettings {
    std::optional<core::MetresPerSecond> speed;
    std::optional<LaneRequest> lane;
    traffic::LaneChangeFreedom freedom = traffic::LaneChangeFreedom::normal;
    traffic::LateralAlignment alignment = traffic::LateralAlignment::usual;
    traffic::JunctionPrivilege privilege = traffic::JunctionPrivilege::none;
    traffic::SafetyChecks checks = traffic::SafetyChecks::on;
    bool beside_road = false;  ///< Stands beside the road, or is about to.
    std::optional<LineStop> line;
    std::vector<core::EdgeIndex> way;  ///< To take now; nothing is left to restore of it.

    bool is_default() const;
};

/// The leases of one vehicle and the settings that they caused. Each step compares wanted and applied
/// settings and sends the difference, so every setting is restored exactly once.
class VehicleControl {
  public:
    explicit VehicleControl(core::VehicleKey vehicle) : vehicle_(vehicle) {}

    void offer(const traffic::Lease& lease, Ledger& ledger);
    void step(const VehicleContext& around, Ledger& ledger, std::vector<traffic::Command>& commands);
    /// Ends the leases for its way.
    void drop_way() { queues_[way].clear(); }
    /// Restores everything, if the vehicle was on the road at the last step. The last call.
    void restore(std::vector<traffic::Command>& commands);

    std::size_t active() const;
    /// Whether there are no leases, and no settings to restore on a vehicle that may come back.
    bool is_idle(core::Seconds now) const;

  private:
    enum Channel : std::size_t { speed, lateral, privilege, way, channel_count };
    struct Place {
        core::VehicleIndex row;
        const traffic::VehicleInfo& info;
    };
    static Channel channel_of(const traffic::Action& action);

    void drop_all(traffic::Refusal reason, Ledger& ledger);
    /// For a vehicle that is not on the road: it may stand beside it because of a lease.
    void wait_off_road(core::Seconds now, Ledger& ledger, std::vector<traffic::Command>& commands);
    VehicleSettings judge(const VehicleContext& around, const Place& place, Ledger& ledger);
    void judge_speed(const VehicleContext& around, const Place& place, VehicleSettings& settings,
                     Ledger& ledger);
    static bool has_left_edge(const VehicleContext& around, const Place& place, HeldLease& held);
    void judge_line(const VehicleContext& around, const Place& place, VehicleSettings& settings,
                    HeldLease& held, Ledger& ledger) const;
    void judge_lateral(const VehicleContext& around, const Place& place, VehicleSettings& settings,
                       Ledger& ledger);
    void judge_aside(const VehicleContext& around, const Place& place, VehicleSettings& settings,
                     HeldLease& held, Ledger& ledger) const;
    std::optional<LaneRequest> judge_lane(const VehicleContext& around, const Place& place, HeldLease& held,
                                          Ledger& ledger) const;
    void judge_way(const VehicleContext& around, const Place& place, VehicleSettings& settings,
                   Ledger& ledger);
    void apply(const VehicleSettings& wanted, core::Seconds now, std::vector<traffic::Command>& commands);
    void apply_stop(const VehicleSettings& wanted, std::vector<traffic::Command>& commands);
    void apply_lane(const VehicleSettings& wanted, core::Seconds now,
                    std::vector<traffic::Command>& commands);

    core::VehicleKey vehicle_;
    std::array<LeaseQueue, channel_count> queues_;
    VehicleSettings applied_;
    /// Since when it is off the road; it may come back with its settings.
    std::optional<core::Seconds> away_since_;
};

}  // namespace clearway::actuation::detail
