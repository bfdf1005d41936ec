#pragma once

#include "core/fields.hpp"
#include "policy/configured_policy.hpp"

namespace clearway::policy {

/// Settings of LineOfSight.
struct LineOfSightConfig {
    double range_m = 300.0;
    double half_angle_deg = 20.0;

    static constexpr void fields(const auto& table) {
        using C = LineOfSightConfig;
        using core::Field;
        table(
            Field{"range_m", "m", &C::range_m, 1.0, 2000.0,
                  "The receiver at the signal detects the emitter within this straight-line distance of its "
                  "stop line",
                  "assumed: receivers of infrared emitters reach 760 m at most and are set to less in towns"},
            Field{"half_angle_deg", "deg", &C::half_angle_deg, 1.0, 90.0,
                  "And while the stop line lies within this angle of the vehicle's heading",
                  "assumed: the emitter's beam"});
    }
};

/// In use today: an optical emitter on the emergency vehicle requests green from a signal on its route while
/// that lies in its beam. It knows neither speed nor queues; vehicles and buildings do not block it, and a
/// signal beside the route does not answer.
class LineOfSight : public ConfiguredPolicy<LineOfSightConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "line_of_sight"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;
};

}  // namespace clearway::policy
