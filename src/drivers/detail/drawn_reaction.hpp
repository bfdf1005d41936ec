#pragma once

#include <algorithm>
#include <cstdint>

#include "core/ids.hpp"
#include "core/random.hpp"

namespace clearway::drivers::detail {

/// Shortest reaction time of any driver, s: a simple reaction.
inline constexpr double fastest_reaction_s = 0.3;
/// An emergency vehicle that was not heard for this long is forgotten, s: assumed.
inline constexpr double memory_s = 3.0;

/// Reaction times of drivers, s, normal but never below the fastest, and the share that complies.
struct ReactionLaw {
    double compliance = 0.0;
    double mean_s = 0.0;
    double deviation_s = 0.0;
};

/// Whether a driver complies and how fast, drawn by driver, so that it is the same in every condition.
class DrawnReaction {
  public:
    /// Uses the draws `first_draw` and the next one of each driver.
    DrawnReaction(const core::KeyedRandom& random, const ReactionLaw& law, std::uint64_t first_draw)
        : random_(random), law_(law), first_draw_(first_draw) {}

    bool complies(core::VehicleKey driver) const {
        return random_.uniform(core::Purpose::siren_reaction, driver.value, first_draw_) < law_.compliance;
    }
    double reaction_s(core::VehicleKey driver) const {
        const double deviation = random_.normal(core::Purpose::siren_reaction, driver.value, first_draw_ + 1);
        return std::max(fastest_reaction_s, law_.mean_s + law_.deviation_s * deviation);
    }

  private:
    core::KeyedRandom random_;
    ReactionLaw law_;
    std::uint64_t first_draw_;
};

/// First draws of those who react to a driver's ears: each of them uses two.
inline constexpr std::uint64_t siren_draws = 0;
inline constexpr std::uint64_t request_draws = 2;

}  // namespace clearway::drivers::detail
