#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "roads/map_matching.hpp"
#include "sensing/observers.hpp"
#include "sensing/processes.hpp"
#include "sensing/sensor.hpp"

namespace clearway::sensing::detail {

/// Vehicles report in rounds. Reports are lost, delayed and wrong as configured; the last one of each vehicle
/// stays known. If a vehicle does not report but others see it, that counts as its report, with a stated
/// error.
class ReportSensor final : public SensorModel {
  public:
    ReportSensor(const failures::FailureConfig& config, const core::KeyedRandom& random,
                 const SensorContext& context);

    void observe(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                 traffic::Observation& observation) override;
    void log_failures(const truth::Snapshot& snapshot, const graph::ProximityGraph& true_graph,
                      FailureLog& log) const override;
    std::span<const core::VehicleKey> unreachable() const override { return unreachable_; }

  private:
    enum class Source : std::uint8_t {
        itself,  ///< Reports its route as well.
        others,
    };
    struct Report {
        core::VehicleKey key;
        traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
        double measured_s = 0.0;
        float position_sigma_m = 0.0F;
        Source source = Source::itself;
        traffic::MotionState state;
    };
    /// The reports of one round that were not lost, while they are on their way. Ordered by key.
    struct Round {
        double measured_s = 0.0;
        std::vector<Report> reports;
        std::vector<traffic::DetectedLink> detected_links;
    };

    bool round_is_due(double time_s);
    void measure(const truth::Snapshot& snapshot, const traffic::Roster& roster);
    void find_reporting(const truth::Snapshot& snapshot, const traffic::Roster& roster);
    void detect_links(const truth::Snapshot& snapshot, Round& round);
    bool deliver(const traffic::Roster& roster, double time_s);
    void merge(const std::vector<Report>& reports);
    /// Replaces the place on the map by the one that fits what the receiver knows.
    void match(Report& report);
    /// Registers a vehicle that reports, or an emergency vehicle, which knows itself; with its route if it
    /// tells it.
    void register_vehicle(const traffic::Roster& roster, core::VehicleKey key);
    /// Registers a vehicle that others see: what can be seen of it, without a route.
    void register_seen(const traffic::Roster& roster, core::VehicleKey key);
    void drop_gone_and_forgotten(const truth::Snapshot& snapshot);
    void write(const truth::Snapshot& snapshot, const traffic::Roster& roster,
               traffic::Observation& observation);
    bool is_fresh(const Report& report) const { return report.measured_s == newest_measured_s_; }
    const Report* last_report(core::VehicleKey key) const;
    void log_link(core::VehicleKey left, core::VehicleKey right, FailureLog& log) const;
    bool was_detected(core::VehicleKey left, core::VehicleKey right) const;

    failures::FailureConfig config_;
    EquipmentProcess equipment_;
    LossProcess loss_;
    RouteProcess routes_;
    NoiseProcess noise_;
    DetectionProcess detection_;
    Observers observers_;
    graph::LinkRules rules_;
    std::optional<roads::MapMatcher> matcher_;  ///< Only when receivers match to the map.

    std::optional<ReportNumber> report_;  ///< Number of the latest round.
    std::deque<Round> on_their_way_;
    std::vector<Round> spare_rounds_;  ///< Kept for their buffers.
    std::vector<Report> last_reports_, merged_;
    std::vector<traffic::DetectedLink> detected_links_;
    double newest_measured_s_ = -1.0;    ///< When the newest round that arrived was measured.
    std::vector<std::uint8_t> reports_;  ///< By row of a round's snapshot: 1 if the report arrives.
    std::vector<float> seen_sigma_m_;    ///< Likewise: error of the position; negative if nothing arrives.
    std::vector<core::VehicleKey> unreachable_;

    traffic::Roster roster_;  ///< Of the vehicles that reported, and of all emergency vehicles.
    struct KnownRoute {
        core::RouteIndex true_route, own_route;
    };
    std::unordered_map<core::VehicleKey, KnownRoute> known_routes_;

    graph::ProximityBuilder builder_;
    graph::ProximityGraph true_graph_, near_;
};

}  // namespace clearway::sensing::detail
