#include "sensing/processes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clearway::sensing {
namespace {

/// Correlation of a first-order process from one report to the next.
double correlation(double interval_s, double correlation_s) {
    return correlation_s > 0.0 ? std::exp(-interval_s / correlation_s) : 0.0;
}

}  // namespace

LossProcess::LossProcess(const failures::FailureConfig& config, const core::KeyedRandom& random)
    : random_(random),
      loss_rate_(config.loss_rate),
      outages_(random, core::Purpose::outage,
               {config.report_interval_s, config.dark_share, config.mean_outage_s}) {}

bool LossProcess::in_outage(core::VehicleKey vehicle, ReportNumber report) const {
    return outages_.dark(vehicle.value, report);
}

bool LossProcess::lost(core::VehicleKey vehicle, ReportNumber report) const {
    if (loss_rate_ > 0.0 && random_.uniform(core::Purpose::report_loss, vehicle.value, report) < loss_rate_) {
        return true;
    }
    return in_outage(vehicle, report);
}

EquipmentProcess::EquipmentProcess(const failures::FailureConfig& config, const core::KeyedRandom& random)
    : random_(random), connected_share_(config.connected_share) {}

bool EquipmentProcess::equipped(core::VehicleKey vehicle, traffic::VehicleClass vehicle_class) const {
    return vehicle_class != traffic::VehicleClass::human ||
           random_.uniform(core::Purpose::sensing_share, vehicle.value) < connected_share_;
}

RouteProcess::RouteProcess(const failures::FailureConfig& config, const core::KeyedRandom& random)
    : random_(random), route_share_(config.route_share) {}

bool RouteProcess::known(core::VehicleKey vehicle, traffic::VehicleClass vehicle_class) const {
    return vehicle_class == traffic::VehicleClass::emergency ||
           random_.uniform(core::Purpose::known_route, vehicle.value) < route_share_;
}

NoiseProcess::NoiseProcess(const failures::FailureConfig& config, const core::KeyedRandom& random,
                           const roads::Network& network)
    : random_(random),
      network_(network),
      position_sigma_m_(config.position_sigma_m),
      position_correlation_(correlation(config.report_interval_s, config.position_correlation_s)),
      speed_sigma_mps_(config.speed_sigma_mps),
      speed_correlation_(correlation(config.report_interval_s, config.speed_correlation_s)),
      heading_sigma_rad_(config.heading_sigma_deg * std::numbers::pi / 180.0) {}

void NoiseProcess::apply(core::VehicleKey vehicle, ReportNumber report, traffic::MotionState& state) const {
    if (position_sigma_m_ > 0.0) {
        const auto error_m = [&](std::uint64_t axis) {
            return position_sigma_m_ *
                   core::draw_normal(random_, {core::Purpose::position_noise, 2, axis, position_correlation_},
                                     vehicle.value, report);
        };
        move(error_m(0), error_m(1), state);
    }
    if (speed_sigma_mps_ > 0.0) {
        const double error = core::draw_normal(
            random_, {core::Purpose::speed_noise, 1, 0, speed_correlation_}, vehicle.value, report);
        state.speed_mps = static_cast<float>(std::max(0.0, state.speed_mps + speed_sigma_mps_ * error));
    }
    turn(vehicle, report, state);
}

void NoiseProcess::blur(core::VehicleKey vehicle, ReportNumber report, double sigma_m,
                        traffic::MotionState& state) const {
    if (sigma_m > 0.0) {
        const auto error_m = [&](std::uint64_t axis) {
            return sigma_m *
                   core::draw_normal(random_, {core::Purpose::seen_position, 2, axis}, vehicle.value, report);
        };
        move(error_m(0), error_m(1), state);
    }
    turn(vehicle, report, state);
}

/// After the position has moved, for the error along the lane is that along the true heading.
void NoiseProcess::turn(core::VehicleKey vehicle, ReportNumber report, traffic::MotionState& state) const {
    if (heading_sigma_rad_ == 0.0) return;
    const double error_rad =
        heading_sigma_rad_ * random_.normal(core::Purpose::heading_noise, vehicle.value, report);
    state.heading_rad =
        static_cast<float>(std::remainder(state.heading_rad + error_rad, 2.0 * std::numbers::pi));
}

void NoiseProcess::move(double x_error_m, double y_error_m, traffic::MotionState& state) const {
    state.x_m += static_cast<float>(x_error_m);
    state.y_m += static_cast<float>(y_error_m);
    if (!state.lane.exists()) return;
    const double cosine = std::cos(state.heading_rad);
    const double sine = std::sin(state.heading_rad);
    const double ahead_m = cosine * x_error_m + sine * y_error_m;
    const double left_m = cosine * y_error_m - sine * x_error_m;

    const roads::Lane& lane = network_.lane(state.lane);
    const roads::Edge& edge = network_.edge(lane.edge);
    if (!edge.internal) {
        const double number = lane.number + std::round(left_m / lane.width_m);
        state.lane = network_.lane_of(
            lane.edge, static_cast<std::uint32_t>(std::clamp(number, 0.0, edge.lane_count - 1.0)));
    }
    const double length_m = network_.lane(state.lane).length_m;
    state.lane_position_m = static_cast<float>(std::clamp(state.lane_position_m + ahead_m, 0.0, length_m));
}

DetectionProcess::DetectionProcess(const failures::FailureConfig& config, const core::KeyedRandom& random)
    : random_(random),
      rate_(config.link_detection_rate),
      detection_(config.detection),
      range_sigma_m_(config.range_sigma_m),
      most_m_(config.link_detection_range_m) {}

bool DetectionProcess::detected(core::VehicleKey one, core::VehicleKey other, ReportNumber report) const {
    return rate_ > 0.0 && random_.uniform(core::Purpose::link_detection,
                                          core::pair_subject(one.value, other.value), 2 * report) < rate_;
}

float DetectionProcess::range_m(core::VehicleKey one, core::VehicleKey other, ReportNumber report,
                                float true_distance_m) const {
    if (detection_ == failures::Detection::presence) return -1.0F;
    const double error = random_.normal(core::Purpose::link_detection,
                                        core::pair_subject(one.value, other.value), 2 * report + 1);
    return static_cast<float>(std::max(0.0, true_distance_m + range_sigma_m_ * error));
}

}  // namespace clearway::sensing
