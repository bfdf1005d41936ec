#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "actuation/actuator_config.hpp"
#include "roads/network.hpp"
#include "roads/own_clearance.hpp"

namespace clearway::actuation::detail {

/// Yellow for an approach with this speed limit, s.
/// `ite`: t + v / (2 a), t = 1 s, a = 3.05 m/s2, level road (ITE, "Guidelines for Determining Traffic Signal
/// Change and Clearance Intervals", 2020), from 3 to 7 s.
/// `rilsa`: 3, 4, 5 s up to 50, 60, 70 km/h and above (FGSV, RiLSA 2015, section 2.5).
double yellow_of_rule_s(ClearanceRule rule, double speed_limit_mps);

/// Where a way crosses another: distances from the stop lines, m.
struct Crossing {
    double leaving_m = 0.0;   ///< Of the way that lost green: to the last point that both share.
    double entering_m = 0.0;  ///< Of the way that gets green: to the first such point.
};

/// What a red clearance depends on besides the crossing.
struct LeavingTraffic {
    double speed_mps = 0.0;  ///< Speed limit on the way through the junction.
    bool turns = false;
    bool on_foot = false;
};

/// Red clearance between two ways that conflict, s, never negative.
/// `ite`: (W + L) / v, where W is the way to the far side of the crossing and L = 6.1 m a vehicle (source as
/// above; no credit for the time that the next vehicle needs to get there).
/// `rilsa`: the intergreen t_overrun + (s_leaving + 6 m) / v_leaving - s_entering / 11.1 m/s less the yellow:
/// straight 3 s and 10 m/s, turning 2 s and 7 m/s (RiLSA 2015, section 2.6).
/// People on foot: the length of their crossing at 1.07 m/s (MUTCD 2009, 4E.06) or 1.2 m/s (RiLSA).
double red_of_rule_s(ClearanceRule rule, const Crossing& crossing, const LeavingTraffic& leaving,
                     double yellow_s);

/// Yellow on a road with this share of a dry road's grip, s. It lets a driver react and then brake, which
/// takes longer on a slippery road (ITE's rule: 1 s of reaction + speed / (2 deceleration)); at most 10 s.
double yellow_on_road_s(double dry_s, double friction);

/// Yellow and red clearance of one signal: what its own program shows of a link, and where that shows none,
/// what the rule gives for the geometry of the crossing; with the rule `fixed`, the times of the
/// configuration for every link. A yellow is longer on a slippery road, whatever its source; red is not,
/// because a vehicle that leaves the junction does not brake.
class Clearance {
  public:
    /// `on_foot_s`: red of a crossing that the controller has set, instead of the rule's; never less than the
    /// program's.
    Clearance(const ActuatorConfig& config, const roads::Signal& signal, const roads::Network& network,
              std::optional<double> on_foot_s = std::nullopt);

    /// For a link that loses green, s; 0 for crossings on foot, which have no yellow.
    double yellow_s(std::uint16_t link) const { return yellow_s_[link]; }
    /// From the red of `leaving` to the green of `entering`, s; 0 for links that do not conflict.
    double red_s(std::uint16_t leaving, std::uint16_t entering) const { return red_s_[leaving][entering]; }

  private:
    std::vector<double> yellow_s_;            ///< By link.
    std::vector<std::vector<double>> red_s_;  ///< By leaving and entering link.
};

}  // namespace clearway::actuation::detail
