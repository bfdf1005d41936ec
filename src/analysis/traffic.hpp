#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/detail/pairing.hpp"
#include "analysis/estimate.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::analysis {

/// What a condition costs on one approach: time lost there a run, summed over vehicles, against the baseline.
struct ApproachCost {
    std::string edge;
    std::optional<double> baseline_s;     ///< Mean over the baseline's runs.
    std::optional<Estimate> difference;   ///< Paired, s a run; all classes together.
    std::optional<Estimate> human;        ///< Of human-driven vehicles alone.
    std::optional<Estimate> automated;    ///< Of automated ones.
    std::optional<Estimate> waiting;      ///< Time stood, all classes.
    std::optional<double> vehicles;       ///< That enter it, mean over the baseline's runs.
    std::optional<double> per_vehicle_s;  ///< Mean difference over mean number of vehicles.
};

/// Vehicles that stand on the other approaches of a signal around an EV's passage, against the passages of
/// the baseline.
struct RecoveryPoint {
    double offset_s = 0.0;  ///< After the EV passed the stop line.
    std::optional<Estimate> difference;
};
/// How long queues must be back to count as recovered, s: assumed, a third of a usual cycle.
inline constexpr double recovered_for_s = 30.0;
struct Recovery {
    std::vector<RecoveryPoint> points;  ///< Ascending.
    /// The first offset from 0 on from which, for `recovered_for_s`, no interval lies above 0: the queues are
    /// back to what they are after an EV of the baseline. Nothing where that is not reached within the
    /// points.
    std::optional<double> recovered_after_s;
};

/// By edge; largest absolute mean difference first. Empty where no pair of runs has approaches. An approach
/// that nobody entered in a run counts 0 there.
std::vector<ApproachCost> approach_costs(const detail::Runs& condition, const detail::Runs& baseline,
                                         double level);

/// Nothing where no pair of runs has passages.
std::optional<Recovery> recovery_after(const detail::Runs& condition, const detail::Runs& baseline,
                                       double level);

}  // namespace clearway::analysis
