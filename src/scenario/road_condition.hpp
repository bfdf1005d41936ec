#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/fields.hpp"

namespace clearway::scenario {

/// Table `[road.stretch.NAME]`: edges with their own speed factor, for example for road works or ice on
/// bridges.
struct Stretch {
    std::string name;
    double speed_factor = 1.0;
    std::vector<std::string> edges;  ///< At least one, each in one stretch only.

    static constexpr void fields(const auto& table) {
        table(core::Field{"speed_factor", "1", &Stretch::speed_factor, 0.05, 1.0,
                          "Factor on the speed limits of its edges, instead of road.speed_factor.",
                          "scenario"});
    }
};

/// Table `[road]`, optional: weather, ice and road works. The same in every condition and in solo runs.
struct RoadCondition {
    double speed_factor = 1.0;
    double friction = 1.0;
    double headway_factor = 1.0;
    std::vector<Stretch> stretches;  ///< By name.

    /// Whether the table has no effect.
    bool is_dry() const {
        return speed_factor == 1.0 && friction == 1.0 && headway_factor == 1.0 && !slows_stretches();
    }
    /// Whether any speed limit differs from that of the network.
    bool changes_limits() const { return speed_factor != 1.0 || slows_stretches(); }

    static constexpr void fields(const auto& table) {
        using S = RoadCondition;
        table(core::Field{"speed_factor", "1", &S::speed_factor, 0.05, 1.0,
                          "Factor on the speed limits of all roads, after limits.road_kmh.",
                          "1: a dry road; FHWA: 0.75 to 0.9 wet, 0.6 to 0.7 snow"},
              core::Field{"friction", "1", &S::friction, 0.1, 1.0,
                          "Share of a dry road's grip: factor on acceleration and on all braking.",
                          "1: a dry road; assumed: about 0.7 wet, 0.2 ice"},
              core::Field{"headway_factor", "1", &S::headway_factor, 1.0, 3.0,
                          "Factor on the time headway that drivers keep.", "1: a dry road"});
    }

  private:
    bool slows_stretches() const {
        return std::ranges::any_of(
            stretches, [this](const Stretch& stretch) { return stretch.speed_factor != speed_factor; });
    }
};

}  // namespace clearway::scenario
