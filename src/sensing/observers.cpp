#include "sensing/observers.hpp"

#include <algorithm>
#include <cmath>

namespace clearway::sensing {
namespace {

std::vector<Place> unit_places(const roads::Network& network) {
    std::vector<Place> places;
    for (const roads::Signal& signal : network.signals()) {
        if (const auto place = place_of(network, signal)) places.push_back(*place);
    }
    return places;
}

bool has_sensors(traffic::VehicleClass vehicle_class) {
    return vehicle_class != traffic::VehicleClass::human;
}

void see(float sigma_m, float& known_sigma_m) {
    if (known_sigma_m < 0.0F || sigma_m < known_sigma_m) known_sigma_m = sigma_m;
}

}  // namespace

std::optional<Place> place_of(const roads::Network& network, const roads::Signal& signal) {
    double x_m = 0.0;
    double y_m = 0.0;
    int count = 0;
    for (const auto& links : signal.links) {
        for (const roads::SignalLink& link : links) {
            if (!link.from.exists()) continue;
            const roads::Point& end = network.lane(link.from).shape.back();
            x_m += end.x_m;
            y_m += end.y_m;
            ++count;
        }
    }
    if (count == 0) return std::nullopt;
    return Place{static_cast<float>(x_m / count), static_cast<float>(y_m / count)};
}

Observers::Observers(const failures::FailureConfig& config, const roads::Network& network)
    : onboard_range_m_(config.onboard_range_m),
      onboard_sigma_m_(static_cast<float>(config.onboard_sigma_m)),
      emergency_range_m_(config.emergency_sensor_range_m),
      emergency_sigma_m_(static_cast<float>(config.emergency_sensor_sigma_m)),
      roadside_range_m_(static_cast<float>(config.roadside_range_m)),
      roadside_sigma_m_(static_cast<float>(config.roadside_sigma_m)),
      occlusion_(config.occlusion) {
    if (config.roadside_range_m > 0.0) units_ = unit_places(network);
}

void Observers::take(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    boxes_.clear();
    centre_x_m_.clear();
    centre_y_m_.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        const traffic::VehicleInfo& info = *roster.find(snapshot.key[row]);
        boxes_.push_back(box_from({snapshot.x_m[row], snapshot.y_m[row]}, snapshot.heading_rad[row],
                                  info.length_m, info.width_m));
        centre_x_m_.push_back(boxes_.back().centre.x_m);
        centre_y_m_.push_back(boxes_.back().centre.y_m);
    }
}

void Observers::look(const truth::Snapshot& snapshot, std::span<const std::uint8_t> reports,
                     std::vector<float>& sigma_m) {
    sigma_m.resize(snapshot.size());
    for (std::size_t row = 0; row < sigma_m.size(); ++row) {
        sigma_m[row] = reports[row] != 0 ? 0.0F : -1.0F;
    }
    look_from_roadside(snapshot, reports, sigma_m);
    if (onboard_range_m_ > 0.0) look_from_vehicles(snapshot, reports, sigma_m);
    if (emergency_range_m_ > 0.0) look_from_emergency_vehicles(snapshot, reports, sigma_m);
}

void Observers::look_from_roadside(const truth::Snapshot& snapshot, std::span<const std::uint8_t> reports,
                                   std::vector<float>& sigma_m) const {
    if (units_.empty()) return;
    for (std::size_t row = 0; row < snapshot.size(); ++row) {
        if (reports[row] != 0) continue;
        const bool seen = std::ranges::any_of(units_, [&](const Place& unit) {
            return std::hypot(snapshot.x_m[row] - unit.x_m, snapshot.y_m[row] - unit.y_m) < roadside_range_m_;
        });
        if (seen) see(roadside_sigma_m_, sigma_m[row]);
    }
}

void Observers::look_from_vehicles(const truth::Snapshot& snapshot, std::span<const std::uint8_t> reports,
                                   std::vector<float>& sigma_m) {
    builder_.build_all_pairs({centre_x_m_, centre_y_m_, snapshot.vehicle_class}, onboard_range_m_, near_);
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (reports[row] != 0) continue;
        const auto neighbours = near_.neighbours_of(row);
        const bool seen = std::ranges::any_of(neighbours, [&](core::VehicleIndex observer) {
            return reports[observer] != 0 && has_sensors(snapshot.vehicle_class[observer]) &&
                   !(considers_occlusion() && hidden(row, observer, neighbours));
        });
        if (seen) see(onboard_sigma_m_, sigma_m[row]);
    }
}

void Observers::look_from_emergency_vehicles(const truth::Snapshot& snapshot,
                                             std::span<const std::uint8_t> reports,
                                             std::vector<float>& sigma_m) {
    builder_.build_all_pairs({centre_x_m_, centre_y_m_, snapshot.vehicle_class}, emergency_range_m_, near_);
    for (core::VehicleIndex observer = 0; observer < snapshot.size(); ++observer) {
        if (snapshot.vehicle_class[observer] != traffic::VehicleClass::emergency) continue;
        const auto neighbours = near_.neighbours_of(observer);
        for (const core::VehicleIndex row : neighbours) {
            if (reports[row] == 0 && !hidden(observer, row, neighbours))
                see(emergency_sigma_m_, sigma_m[row]);
        }
    }
}

bool Observers::hidden(core::VehicleIndex from, core::VehicleIndex to,
                       std::span<const core::VehicleIndex> near) const {
    return std::ranges::any_of(near, [&](core::VehicleIndex other) {
        return other != from && other != to && blocks(boxes_[other], boxes_[from].centre, boxes_[to].centre);
    });
}

}  // namespace clearway::sensing
