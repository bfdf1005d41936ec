#pragma once

#include <map>
#include <vector>

#include "core/ids.hpp"
#include "policy/detail/queue_model.hpp"
#include "policy/detail/request_table.hpp"
#include "policy/detail/signal_forecast.hpp"
#include "policy/detail/view.hpp"

namespace clearway::policy::detail {

/// How fast emergency vehicles that have green drive: slower than a free road allows where traffic is dense.
/// Learnt from those of this run.
class Pace {
  public:
    /// At each decision: a vehicle would reach the stop line `free_s` from now on a free road. What it covers
    /// until the next one counts if `drives_on_green` there.
    void watch(const RequestKey& request, double free_s, core::Seconds now, bool drives_on_green);
    /// Of the speed on a free road, above 0, at most 1.
    double share() const;

  private:
    struct Moment {
        double free_s = 0.0;
        core::Seconds time;
    };
    std::map<RequestKey, Moment> last_;
    double covered_s_ = 0.0;  ///< On a free road.
    double spent_s_ = 0.0;
};

/// Decides whether signals are held earlier or later than a rule would hold them, by a model of what the hold
/// does (QueueModel): once every later beginning costs more, and not to hold too. The cost is the time of the
/// emergency vehicle, times its worth, plus that of the others. A hold begins earlier only for a gain, and
/// not long before the rule: the longer the forecast, the more a hold that comes too early costs. It leaves
/// signals of the controller NEMA to the rule.
class HoldPlanner {
  public:
    struct Settings {
        double emergency_worth = 0.0;  ///< How many vehicle-seconds a second of an emergency vehicle counts.
        double least_gain_s = 0.0;     ///< Less is not worth an early hold.
        double longest_early_s = 0.0;  ///< How much earlier than the rule at most.
        double longest_late_s = 0.0;   ///< How much later, as `rule_s` of `is_due` tells.
        ModelSight sight = ModelSight::all;
    };
    explicit HoldPlanner(Settings settings) : settings_(settings) {}

    /// Starts a decision, in which arrivals are asked about in the order in which the vehicles meet them.
    void begin(const View& view);
    /// Whether a hold should begin now; true while it `is_held`. `rule_s`: when the rule would begin it, from
    /// now; negative if it would have.
    bool is_due(const View& view, const Arrival& arrival, double rule_s, bool is_held);

  private:
    /// Where an emergency vehicle is foretold to pass a stop line.
    struct Reached {
        double free_s = 0.0;  ///< On a free road, from now on.
        double time_s = 0.0;  ///< From now on.
    };

    Settings settings_;
    std::vector<ProgramClock> clocks_;  ///< By signal.
    Pace pace_;
    std::map<core::VehicleKey, Reached> reached_;  ///< The last one of each, in this decision.
    QueueModel::Workspace workspace_;
};

}  // namespace clearway::policy::detail
