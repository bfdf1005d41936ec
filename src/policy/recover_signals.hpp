#pragma once

#include <map>
#include <vector>

#include "core/fields.hpp"
#include "policy/configured_policy.hpp"
#include "roads/short_loops.hpp"

namespace clearway::policy {

/// Settings of RecoverSignals.
struct RecoverSignalsConfig {
    double near_m = 300.0;
    double lasting_s = 60.0;
    double close_m = 50.0;
    int change_vehicles = 4;
    double halted_mps = 0.5;
    double lease_s = 2.0;
    double exit_room_m = 0.0;
    double short_block_m = roads::usual_short_block_m;

    static constexpr void fields(const auto& table) {
        using C = RecoverSignalsConfig;
        using core::Field;
        table(
            Field{"near_m", "m", &C::near_m, 1.0, 2000.0,
                  "A signal counts as disturbed once an emergency vehicle is this near", "assumed"},
            Field{"lasting_s", "s", &C::lasting_s, 0.0, 600.0, "And for this long after it has passed",
                  "trials at the dense intersection: others lose more at 20 s, emergency vehicles gain less "
                  "at 120 s"},
            Field{"close_m", "m", &C::close_m, 0.0, 300.0,
                  "Moving vehicles closer than this to the stop line count as waiting, too", "assumed"},
            Field{"change_vehicles", "1", &C::change_vehicles, 0.0, 50.0,
                  "How many more vehicles a phase change must serve",
                  "assumed: as many as pass on a lane during yellow and all-red"},
            Field{"halted_mps", "m/s", &C::halted_mps, 0.0, 5.0, "A slower vehicle counts as standing",
                  "assumed: walking pace is 1.4 m/s"},
            detail::lifetime_field<C>(),
            Field{"exit_room_m", "m", &C::exit_room_m, 0.0, 200.0,
                  "A vehicle does not count while standing vehicles leave less than this free on its way "
                  "behind the signal; 0: every vehicle counts",
                  "0: however full, as in all results that do not name it"},
            Field{"short_block_m", "m", &C::short_block_m, 0.0, 1000.0,
                  "Signals on closed loops of blocks shorter than this keep their cycle; 0: none does",
                  "docs/findings/short-blocks.md; no scenario of the other findings has such loops"});
    }
};

/// Gives time back after a signal was preempted: asks that its background plan resume with the phase that
/// serves the most vehicles believed to wait there, and that, for a while, greens which serve fewer end
/// early. It stands back where short blocks form closed loops: a signal that leaves the cycle of its
/// neighbours fills the block between them.
class RecoverSignals : public ConfiguredPolicy<RecoverSignalsConfig> {
  public:
    explicit RecoverSignals(const PolicyContext& context, RecoverSignalsConfig config = {});

    std::string_view name() const override { return "recover_signals"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    std::map<core::SignalIndex, double> until_s_;
    std::vector<bool> keeps_cycle_;  ///< By signal; empty if none does.
};

}  // namespace clearway::policy
