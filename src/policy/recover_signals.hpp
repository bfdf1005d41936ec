#pragma once

#include <map>

#include "policy/part.hpp"

namespace clearway::policy {

/// Numbers of RecoverSignals.
struct RecoverSignalsConfig {
    double near_m =
        300.0;  ///< A signal counts as taken from when an emergency vehicle is this near; (0, 2000].
    /// And for this long after it has passed; [0, 600]. 60 s: at the dense intersection 20 s left the others
    /// with 5 % more time loss than the baseline, 60 s with 3 %; 120 s with 1 %, and the
    /// emergency vehicles with less.
    double lasting_s = 60.0;
    double close_m = 50.0;    ///< Moving vehicles nearer to the stop line are wanted, too; [0, 300]. Assumed.
    int change_vehicles = 4;  ///< Vehicles that a change of phase must serve more; [0, 50]. Assumed: those
                              ///< that pass a lane during yellow and all-red.
};

/// Gives time back after a signal was opened for an emergency vehicle: asks that its program resume with the
/// phase that serves most of the vehicles believed to wait at it, and that greens which serve fewer end
/// early for a while.
class RecoverSignals : public Part {
  public:
    explicit RecoverSignals(const PartContext& context, RecoverSignalsConfig config = {});

    std::string_view name() const override { return "recover_signals"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    PartContext context_;
    RecoverSignalsConfig config_;
    std::map<core::SignalIndex, double> until_s_;
};

}  // namespace clearway::policy
