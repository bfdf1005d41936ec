#include "drivers/listeners.hpp"

#include <cmath>

namespace clearway::drivers {

Listeners::Listeners(const core::KeyedRandom& random, const RequestConfig& config)
    : config_(config),
      reactions_(random,
                 {.compliance = config.compliance,
                  .mean_s = config.reaction_mean_s,
                  .deviation_s = config.reaction_deviation_s},
                 detail::request_draws) {}

std::span<const core::VehicleKey> Listeners::step(const truth::Snapshot& snapshot) {
    ready_.clear();
    if (config_.compliance <= 0.0) return ready_;
    for (core::VehicleIndex emergency = 0; emergency < snapshot.size(); ++emergency) {
        if (snapshot.vehicle_class[emergency] != traffic::VehicleClass::emergency) continue;
        for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
            if (snapshot.vehicle_class[row] != traffic::VehicleClass::human) continue;
            const double distance_m = std::hypot(snapshot.x_m[row] - snapshot.x_m[emergency],
                                                 snapshot.y_m[row] - snapshot.y_m[emergency]);
            if (distance_m > config_.hearing_m || !reactions_.complies(snapshot.key[row])) continue;
            heard_.try_emplace(snapshot.key[row], Hearing{snapshot.time, snapshot.time}).first->second.last =
                snapshot.time;
        }
    }
    std::erase_if(heard_, [&](const auto& entry) {
        return (snapshot.time - entry.second.last).value > detail::memory_s;
    });
    for (const auto& [key, hearing] : heard_) {
        if ((snapshot.time - hearing.since).value >= reactions_.reaction_s(key)) ready_.push_back(key);
    }
    return ready_;
}

}  // namespace clearway::drivers
