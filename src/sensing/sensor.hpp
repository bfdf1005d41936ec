#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "core/units.hpp"
#include "failures/failure_config.hpp"
#include "graph/proximity.hpp"
#include "roads/network.hpp"
#include "traffic/observation.hpp"
#include "truth/snapshot.hpp"

namespace clearway::sensing {

/// What was missing at one step, among the vehicles and links that are on the road now. Only for scoring.
struct FailureLog {
    enum class Cause {
        dark,        ///< An end did not report in the newest round, but is known from before.
        never_seen,  ///< An end has not reported yet, or was forgotten.
    };
    struct LostLink {
        core::VehicleKey left;
        core::VehicleKey right;
        Cause cause = Cause::dark;
    };

    core::Seconds time;
    /// Known from before, but not heard in the newest round. Ordered by key.
    std::vector<core::VehicleKey> dark;
    std::vector<core::VehicleKey> never_seen;  ///< Ordered by key.
    /// True links with an end of either list that no neighbour detected. Ordered by (left, right), left <
    /// right.
    std::vector<LostLink> lost_links;
};

/// Turns the true state into what was reported. Failures are drawn per report (1 Hz by default, whatever the
/// step length) and keyed by vehicle and report number, so that every condition of a replication has the same
/// ones. A model keeps state between steps (the last report of each vehicle) and is single-threaded.
class SensorModel {
  public:
    SensorModel() = default;
    SensorModel(const SensorModel&) = delete;
    SensorModel& operator=(const SensorModel&) = delete;
    virtual ~SensorModel() = default;

    /// Called once per simulation step with the present truth; writes what is known into `observation`, whose
    /// buffers are reused. `roster` is the true one; the observation refers to a roster of those that
    /// reported.
    virtual void observe(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                         traffic::Observation& observation) = 0;

    /// What the last observation lacks compared to the truth. `snapshot` is that of the last call of
    /// `observe`, and `true_graph` has its links.
    virtual void log_failures(const truth::Snapshot& snapshot, const graph::ProximityGraph& true_graph,
                              FailureLog& log) const = 0;

    /// Vehicles that commands do not reach since the newest round, ordered by key; valid until the next call
    /// of `observe`. Empty unless `dark_commands` is `lost`.
    virtual std::span<const core::VehicleKey> unreachable() const { return {}; }
};

/// What a sensor needs besides its configuration. `network` outlives the sensor.
struct SensorContext {
    const roads::Network& network;
    graph::LinkRules rules;  ///< Which links a neighbour can detect.
};

/// The sensor of a configuration. Rounds count from time 0 of the simulation, so a sensor made in the middle
/// of a run has the failures of that time; its first call is a report round. With a latency, a vehicle is
/// fresh when it is in the newest round that has arrived, and `report_time` is the time at which that round
/// was measured. Throws core::InputError with all problems of the configuration.
std::unique_ptr<SensorModel> make_sensor(const failures::FailureConfig& config,
                                         const core::KeyedRandom& random, const SensorContext& context);

}  // namespace clearway::sensing
