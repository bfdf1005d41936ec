#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "sensing/sensor.hpp"
#include "support/ascii_scene.hpp"

namespace clearway::sensing::testing {

inline core::KeyedRandom draws(std::uint64_t seed = 1, std::uint32_t replication = 0) {
    return {core::StudySeed{seed}, core::Replication{replication}};
}

/// A row of `count` vehicles with keys of their own on no road in particular, every tenth an emergency
/// vehicle, for statistics; all stand 30 m apart.
struct Crowd {
    truth::Snapshot snapshot;
    traffic::Roster roster;

    explicit Crowd(std::size_t count, std::size_t first = 0) {
        std::vector<std::pair<core::VehicleKey, std::string>> keys;
        for (std::size_t number = first; number < first + count; ++number) {
            const std::string id = "vehicle" + std::to_string(number);
            keys.emplace_back(core::vehicle_key(id), id);
        }
        std::ranges::sort(keys);
        snapshot.resize(count);
        for (std::size_t row = 0; row < count; ++row) {
            const bool emergency = keys[row].first.value % 10 == 0;
            traffic::VehicleInfo info;
            info.key = keys[row].first;
            info.id = keys[row].second;
            info.vehicle_class =
                emergency ? traffic::VehicleClass::emergency : traffic::VehicleClass::automated;
            roster.add(info);
            snapshot.key[row] = info.key;
            snapshot.vehicle_class[row] = info.vehicle_class;
            snapshot.x_m[row] = 30.0F * static_cast<float>(row);
        }
    }

    void at(double time_s) { snapshot.time = core::Seconds(time_s); }
};

/// The entry of a vehicle, or null.
inline const traffic::ObservedVehicle* find(const traffic::Observation& observation, core::VehicleKey key) {
    const auto found = std::ranges::find(observation.vehicles, key, &traffic::ObservedVehicle::key);
    return found == observation.vehicles.end() ? nullptr : &*found;
}

inline const support::Scene& small_scene() {
    static const support::Scene scene(R"(
        10 m per cell, limit 20 m/s, speed 10 m/s
        ..h..a...+.....h
        ..e......+......
    )");
    return scene;
}

}  // namespace clearway::sensing::testing
