#pragma once

#include <map>
#include <vector>

#include "policy/part.hpp"

namespace clearway::policy {

/// Numbers of GreenWave.
struct GreenWaveConfig {
    double before_s = 8.0;  ///< Green is asked for this long before the planned arrival; as PreemptSignals.
    double after_s = 15.0;  ///< And kept this long after it. Assumed: two stops of a vehicle behind plan.
};

/// An opponent: every signal of an emergency vehicle's route is opened around the time at which it would get
/// there at its allowed speed, planned once when it appears and never corrected.
class GreenWave : public Part {
  public:
    explicit GreenWave(const PartContext& context, GreenWaveConfig config = {});

    std::string_view name() const override { return "green_wave"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    struct Window {
        core::SignalIndex signal;
        std::vector<std::uint16_t> links;
        double from_s;
        double until_s;
    };

    PartContext context_;
    GreenWaveConfig config_;
    std::map<core::VehicleKey, std::vector<Window>> plans_;
};

}  // namespace clearway::policy
