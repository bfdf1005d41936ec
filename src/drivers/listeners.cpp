#include "drivers/listeners.hpp"

#include <algorithm>
#include <cmath>

namespace clearway::drivers {
namespace {

/// Numbers of the random draws made for one driver; 0 and 1 are those of siren.cpp.
constexpr std::uint64_t compliance_draw = 2;
constexpr std::uint64_t reaction_draw = 3;

}  // namespace

bool Listeners::complies(core::VehicleKey driver) const {
    return random_.uniform(core::Purpose::siren_reaction, driver.value, compliance_draw) < config_.compliance;
}

double Listeners::reaction_s(core::VehicleKey driver) const {
    const double deviation = random_.normal(core::Purpose::siren_reaction, driver.value, reaction_draw);
    return std::max(config_.fastest_reaction_s,
                    config_.reaction_mean_s + config_.reaction_deviation_s * deviation);
}

std::span<const core::VehicleKey> Listeners::step(const truth::Snapshot& snapshot) {
    ready_.clear();
    if (config_.compliance <= 0.0) return ready_;
    for (core::VehicleIndex emergency = 0; emergency < snapshot.size(); ++emergency) {
        if (snapshot.vehicle_class[emergency] != traffic::VehicleClass::emergency) continue;
        for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
            if (snapshot.vehicle_class[row] != traffic::VehicleClass::human) continue;
            const double distance_m = std::hypot(snapshot.x_m[row] - snapshot.x_m[emergency],
                                                 snapshot.y_m[row] - snapshot.y_m[emergency]);
            if (distance_m > config_.hearing_m || !complies(snapshot.key[row])) continue;
            heard_.try_emplace(snapshot.key[row], Hearing{snapshot.time, snapshot.time}).first->second.last =
                snapshot.time;
        }
    }
    std::erase_if(heard_, [&](const auto& entry) {
        return (snapshot.time - entry.second.last).value > config_.memory_s;
    });
    for (const auto& [key, hearing] : heard_) {
        if ((snapshot.time - hearing.since).value >= reaction_s(key)) ready_.push_back(key);
    }
    return ready_;
}

}  // namespace clearway::drivers
