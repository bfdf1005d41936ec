#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/units.hpp"
#include "metrics/dispatch_counts.hpp"
#include "metrics/road_layout.hpp"
#include "metrics/run_metrics.hpp"
#include "metrics/true_links.hpp"
#include "traffic/belief.hpp"
#include "traffic/departure.hpp"
#include "traffic/lease.hpp"
#include "traffic/signal_status.hpp"
#include "traffic/vehicle.hpp"
#include "truth/events.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics {

/// A vehicle of the demand.
struct PlannedVehicle {
    std::string id;
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    traffic::VehicleKind kind = traffic::VehicleKind::other;
    double depart_s = 0.0;
};

/// The vehicles of SUMO route files, with class and kind from the parameters of their types (see
/// traffic/departure.hpp), then the emergency vehicles that the run adds. Types may be in any of the files,
/// but must come before their use. Throws core::InputError for a file that is missing or not XML, and for a
/// departure that is not a time.
std::vector<PlannedVehicle> read_planned(std::span<const std::filesystem::path> type_and_route_files,
                                         std::span<const traffic::EmergencyDeparture> emergency);

/// The vehicles of a simulation without a known demand, from its tripinfo file. Class and kind are those of
/// the roster; vehicles that it lacks, because they never entered, count as human. Throws
/// core::SimulatorError.
std::vector<PlannedVehicle> planned_in(const std::filesystem::path& tripinfo, const traffic::Roster& roster);

struct RecorderConfig {
    /// A believed vehicle whose report is older than this was not heard in the newest report round, s.
    float fresh_age_s = 0.01F;

    /// For reports that arrive late: the latency plus rounding.
    static RecorderConfig of_latency(core::Seconds latency) {
        return {static_cast<float>(latency.value) + RecorderConfig{}.fresh_age_s};
    }
};

/// What a simulator is asked about a vehicle that stands without a red ahead. An empty function answers no.
struct StandingReasons {
    std::function<bool(core::VehicleKey)> at_stop;       ///< Planned or commanded.
    std::function<bool(core::LaneIndex)> pedestrian_on;  ///< Whether somebody walks on a crossing.
};

/// What the recorder needs at the end of a run.
struct RunEnd {
    /// Complete files (the session is closed): one, or one per vehicle of a solo run.
    std::vector<std::filesystem::path> tripinfo_files;
    std::vector<PlannedVehicle> planned;
    core::Seconds time;
    /// Maximum duration of a run; an emergency vehicle that did not arrive counts with this travel time. It
    /// must not depend on the condition.
    core::Seconds horizon;
    LeaseTotals leases;
    IncidentCounts incidents = {};
    DispatchCounts dispatch = {};
};

/// Turns a run into numbers. Call `step` for every simulation step, warm-up included; after a fork the copy
/// continues in the child. One recorder, one run, one thread. Steps with a steady number of vehicles do not
/// allocate.
class Recorder {
  public:
    explicit Recorder(RecorderConfig config = {});
    ~Recorder();
    Recorder(Recorder&&) noexcept;
    Recorder& operator=(Recorder&&) noexcept;

    /// Replaces the configuration after the shared warm-up, once the condition is known.
    void configure(RecorderConfig config);

    /// From the next step on, also records where time is lost, how emergency vehicles travel, and safety
    /// measures. `reasons` are asked while the recorder steps.
    void watch(RoadLayout layout, StandingReasons reasons = {});

    /// One step: counts events and adds snapshot and leases to the trace hash. The roster lists every vehicle
    /// of the snapshot.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster, const truth::Events& events,
              std::span<const traffic::Lease> leases);
    /// What signals are doing about requests at the end of the step, by index. Call it in every step of a
    /// condition that could ask for greens, after `step`.
    void signals(const truth::Snapshot& snapshot, std::span<const traffic::SignalStatus> asked);
    /// Compares the believed links with the true ones; `truth` is that of the snapshot. A link counts as
    /// believed when the belief lists it.
    void links(const truth::Snapshot& snapshot, const TrueLinks& truth, const traffic::BelievedGraph& belief);

    /// Reads the tripinfo files and summarises the run. Throws core::SimulatorError when a file is missing,
    /// cut off or lists a vehicle that was not planned.
    RunSummary finish(const RunEnd& end) const;

    const LinkCounts& link_counts() const;
    const LinkCounts& dark_link_counts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::metrics
