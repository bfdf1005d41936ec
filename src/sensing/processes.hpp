#pragma once

#include <cstdint>

#include "core/ids.hpp"
#include "core/keyed_series.hpp"
#include "core/random.hpp"
#include "failures/failure_config.hpp"
#include "roads/network.hpp"
#include "traffic/observation.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::sensing {

/// Number of a report round: round k takes place at the first step at or after k x interval since time 0 of
/// the simulation. All draws are keyed by it, so they depend neither on the step length nor on when sensing
/// started.
using ReportNumber = std::uint64_t;

/// Which reports are lost: a pure function of (vehicle, report number). Bursts are a Gilbert-Elliott chain
/// with one step a report.
class LossProcess {
  public:
    LossProcess(const failures::FailureConfig& config, const core::KeyedRandom& random);
    /// Whether this report is lost, for either reason.
    bool lost(core::VehicleKey vehicle, ReportNumber report) const;
    /// Whether the vehicle is in an outage.
    bool in_outage(core::VehicleKey vehicle, ReportNumber report) const;

  private:
    core::KeyedRandom random_;
    double loss_rate_;
    core::GilbertElliott outages_;
};

/// Which vehicles report at all: a pure function of the vehicle. A human-driven vehicle is equipped with
/// probability `connected_share`; the draw is one number per vehicle, so a larger share equips the same
/// vehicles and more.
class EquipmentProcess {
  public:
    EquipmentProcess(const failures::FailureConfig& config, const core::KeyedRandom& random);
    bool equipped(core::VehicleKey vehicle, traffic::VehicleClass vehicle_class) const;

  private:
    core::KeyedRandom random_;
    double connected_share_;
};

/// Which vehicles report their route: a pure function of the vehicle. One draw a vehicle, so that a larger
/// share has the same vehicles and more. Emergency vehicles always do.
class RouteProcess {
  public:
    RouteProcess(const failures::FailureConfig& config, const core::KeyedRandom& random);
    bool known(core::VehicleKey vehicle, traffic::VehicleClass vehicle_class) const;

  private:
    core::KeyedRandom random_;
    double route_share_;
};

/// Errors of reports: a pure function of (vehicle, report number).
///
/// Position and, with separate noise, speed: white noise on each axis or, with a correlation time tau, the
/// stationary first-order process with correlation exp(-interval / tau) between reports
/// (core::draw_normal). A speed stays at least 0. The place on the
/// map moves with the position: the lane position by the error along the heading, the lane by whole lane
/// widths of the error across it, so that nothing in the report is more exact than the position. Heading:
/// white noise, which does not move the place.
class NoiseProcess {
  public:
    NoiseProcess(const failures::FailureConfig& config, const core::KeyedRandom& random,
                 const roads::Network& network);
    bool none() const {
        return position_sigma_m_ == 0.0 && speed_sigma_mps_ == 0.0 && heading_sigma_rad_ == 0.0;
    }
    void apply(core::VehicleKey vehicle, ReportNumber report, traffic::MotionState& state) const;
    /// Adds the error of a position that another observer saw: white, with standard deviation `sigma_m` along
    /// each axis. The heading has the error of reports.
    void blur(core::VehicleKey vehicle, ReportNumber report, double sigma_m,
              traffic::MotionState& state) const;

  private:
    void move(double x_error_m, double y_error_m, traffic::MotionState& state) const;
    void turn(core::VehicleKey vehicle, ReportNumber report, traffic::MotionState& state) const;

    core::KeyedRandom random_;
    const roads::Network& network_;
    double position_sigma_m_;
    double position_correlation_;  ///< From one report to the next.
    double speed_sigma_mps_;
    double speed_correlation_;
    double heading_sigma_rad_;
};

/// Which links of dark vehicles are still detected: a pure function of (unordered pair, report number).
class DetectionProcess {
  public:
    DetectionProcess(const failures::FailureConfig& config, const core::KeyedRandom& random);
    bool none() const { return rate_ == 0.0; }
    /// Whether the vehicles are near enough for a detection.
    bool in_range(float true_distance_m) const { return true_distance_m < most_m_; }
    bool detected(core::VehicleKey one, core::VehicleKey other, ReportNumber report) const;
    /// The range that a detection reports, or a negative number when it only reports presence.
    float range_m(core::VehicleKey one, core::VehicleKey other, ReportNumber report,
                  float true_distance_m) const;
    float range_sigma_m() const { return static_cast<float>(range_sigma_m_); }

  private:
    core::KeyedRandom random_;
    double rate_;
    failures::Detection detection_;
    double range_sigma_m_;
    double most_m_;
};

}  // namespace clearway::sensing
