#pragma once

#include <map>
#include <utility>

#include "core/fields.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/approach.hpp"

namespace clearway::policy {

/// Settings of CheckInOut.
struct CheckInOutConfig {
    double check_in_m = 150.0;
    double check_out_m = 15.0;

    static constexpr void fields(const auto& table) {
        using C = CheckInOutConfig;
        using core::Field;
        table(Field{"check_in_m", "m", &C::check_in_m, 1.0, 2000.0,
                    "The detector that calls the signal lies this far before its stop line",
                    "assumed: 9 s at 60 km/h, as preempt_signals without a queue"},
              Field{"check_out_m", "m", &C::check_out_m, 0.0, 200.0,
                    "The detector that releases it lies this far behind its stop line",
                    "assumed: inside the junction, so that the way is still held"});
    }
};

/// In use today: a detector before the stop line requests green when an emergency vehicle passes it, and
/// one behind cancels the request. Neither knows of queues or of speed. A vehicle that enters between
/// the two calls at once.
class CheckInOut : public ConfiguredPolicy<CheckInOutConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "check_in_out"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    struct Call {
        detail::Approach approach;
        double released_m;  ///< The vehicle's distance to the end of its route at the second detector.
    };

    std::map<std::pair<core::VehicleKey, core::SignalIndex>, Call> calls_;
};

}  // namespace clearway::policy
