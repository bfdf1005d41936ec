#pragma once

#include <map>

#include "policy/part.hpp"

namespace clearway::policy {

/// Numbers of RecoverSignals.
struct RecoverSignalsConfig {
    double near_m =
        300.0;  ///< A signal counts as taken from when an emergency vehicle is this near; (0, 2000].
    double lasting_s =
        20.0;  ///< And for this long after it has passed; [0, 120]. Longer than the way back to the program.
};

/// Gives time back after a signal was opened for an emergency vehicle: asks that its program resume with the
/// phase that serves most of the vehicles believed to stand at it.
class RecoverSignals : public Part {
  public:
    explicit RecoverSignals(const PartContext& context, RecoverSignalsConfig config = {});

    std::string_view name() const override { return "recover_signals"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    const roads::Network& network_;
    RecoverSignalsConfig config_;
    std::map<core::SignalIndex, double> until_s_;
};

}  // namespace clearway::policy
