#pragma once

#include <set>
#include <utility>

#include "policy/part.hpp"

namespace clearway::policy {

/// Numbers of PreemptSignals.
struct PreemptSignalsConfig {
    double lead_s = 8.0;  ///< Asked for this long before arrival; [0, 60]. 8 s: 20 s buy 2 % and
                          ///< cost others 20 % waiting (prototype).
    double lead_per_halted_s =
        2.0;  ///< And this much more for each vehicle that stands ahead; [0, 10]. Saturation headway.
    double longest_lead_s = 40.0;  ///< [0, 60]. Assumed: leaves 20 s of the longest hold for driving through.
    double slowest_share = 0.5;    ///< Arrival is reckoned with at least this share of the allowed speed, (0,
                                   ///< 1]: a queue that stands will move once it has green.
    double horizon_m = 600.0;      ///< Signals farther away are left alone; (0, 5000].
};

/// Opens the signals on the route of every emergency vehicle: green for its approach, asked for early
/// enough that the queue ahead is gone on its arrival. Yellow, all-red, cap, cool-down and the way back are
/// the work of actuation.
class PreemptSignals : public Part {
  public:
    explicit PreemptSignals(const PartContext& context, PreemptSignalsConfig config = {});

    std::string_view name() const override { return "preempt_signals"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    PartContext context_;
    PreemptSignalsConfig config_;
    /// Whose signals were asked for at the last call: a request stands until its vehicle has passed, for the
    /// queue that begins to move is not gone yet.
    std::set<std::pair<core::VehicleKey, core::SignalIndex>> asked_;
};

}  // namespace clearway::policy
