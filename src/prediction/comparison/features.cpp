#include "prediction/comparison/features.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace clearway::prediction {

FeatureSchema as_published_position_schema() {
    return {"as_published_position", 1, 2};
}
FeatureSchema as_published_attributes_schema() {
    return {"as_published_attributes", 1, 5};
}
FeatureSchema corrected_schema() {
    return {"corrected", 2, 5};
}

float class_code(traffic::VehicleClass vehicle_class) {
    switch (vehicle_class) {
        case traffic::VehicleClass::human:
            return 0.0F;
        case traffic::VehicleClass::automated:
            return 1.0F;
        case traffic::VehicleClass::emergency:
            return 2.0F;
    }
    assert(false);
    return 0.0F;
}

void as_published_row(const traffic::MotionState& state, traffic::VehicleClass vehicle_class,
                      const roads::Network& network, std::span<float> row) {
    assert(row.size() == 2 || row.size() == 5);
    row[0] = state.x_m;
    row[1] = state.y_m;
    if (row.size() == 2) return;
    row[2] = state.speed_mps;
    row[3] = state.lane.exists() ? static_cast<float>(network.lane(state.lane).number) : 0.0F;
    row[4] = class_code(vehicle_class);
}

void as_published_features(const Tracks& tracks, const FeatureSchema& schema, const roads::Network& network,
                           std::vector<float>& features) {
    features.resize(tracks.size() * schema.width);
    for (std::size_t row = 0; row < tracks.size(); ++row) {
        as_published_row(tracks.last[row], tracks.vehicle_class[row], network,
                         std::span(features).subspan(row * schema.width, schema.width));
    }
}

void corrected_features(const Tracks& tracks, std::vector<float>& features) {
    constexpr float wave_number = 2.0F * std::numbers::pi_v<float> / corrected_wavelength_m;
    features.resize(tracks.size() * 5);
    for (std::size_t row = 0; row < tracks.size(); ++row) {
        float* const out = &features[row * 5];
        out[0] = corrected_amplitude * std::cos(wave_number * tracks.x_m[row]);
        out[1] = corrected_amplitude * std::sin(wave_number * tracks.x_m[row]);
        out[2] = corrected_amplitude * std::cos(wave_number * tracks.y_m[row]);
        out[3] = corrected_amplitude * std::sin(wave_number * tracks.y_m[row]);
        out[4] = std::exp(-tracks.age_s[row] / corrected_age_scale_s);
    }
}

}  // namespace clearway::prediction
