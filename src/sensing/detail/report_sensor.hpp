#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

#include "sensing/processes.hpp"
#include "sensing/sensor.hpp"

namespace clearway::sensing::detail {

/// Vehicles report in rounds; reports get lost, delayed and wrong as the configuration says; the last one of
/// each vehicle stays known.
class ReportSensor final : public SensorModel {
  public:
    ReportSensor(const FailureConfig& config, const core::KeyedRandom& random, const SensorContext& context);

    void observe(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                 traffic::Observation& observation) override;
    void log_failures(const truth::Snapshot& snapshot, const graph::ProximityGraph& true_graph,
                      FailureLog& log) const override;

  private:
    struct Report {
        core::VehicleKey key;
        traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
        double measured_s = 0.0;
        traffic::MotionState state;
    };
    /// The reports of one round that were not lost, on their way. Ordered by key.
    struct Round {
        double measured_s = 0.0;
        std::vector<Report> reports;
        std::vector<traffic::DetectedLink> detected_links;
    };

    bool round_is_due(double time_s);
    void measure(const truth::Snapshot& snapshot);
    void detect_links(const truth::Snapshot& snapshot, Round& round);
    bool deliver(const traffic::Roster& roster, double time_s);
    void merge(const std::vector<Report>& reports);
    void register_vehicle(const traffic::Roster& roster, core::VehicleKey key);
    void drop_gone_and_forgotten(const truth::Snapshot& snapshot);
    void write(const truth::Snapshot& snapshot, const traffic::Roster& roster,
               traffic::Observation& observation);
    bool is_fresh(const Report& report) const { return report.measured_s == newest_measured_s_; }
    const Report* last_report(core::VehicleKey key) const;
    void log_link(core::VehicleKey left, core::VehicleKey right, FailureLog& log) const;
    bool was_detected(core::VehicleKey left, core::VehicleKey right) const;

    FailureConfig config_;
    LossProcess loss_;
    NoiseProcess noise_;
    DetectionProcess detection_;
    graph::LinkRules rules_;

    std::optional<ReportNumber> report_;  ///< Number of the latest round.
    std::deque<Round> on_their_way_;
    std::vector<Round> spare_rounds_;  ///< Their buffers are used again.
    std::vector<Report> last_reports_, merged_;
    std::vector<traffic::DetectedLink> detected_links_;
    double newest_measured_s_ = -1.0;  ///< When the newest round that arrived was measured.
    std::vector<std::uint8_t> lost_;   ///< By row of the snapshot of a round.

    traffic::Roster roster_;  ///< Of those that reported, and of all emergency vehicles.
    struct KnownRoute {
        core::RouteIndex true_route, own_route;
    };
    std::unordered_map<core::VehicleKey, KnownRoute> known_routes_;

    graph::ProximityBuilder builder_;
    graph::ProximityGraph true_graph_;
};

}  // namespace clearway::sensing::detail
