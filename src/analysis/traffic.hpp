#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/detail/pairing.hpp"
#include "analysis/estimate.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::analysis {

/// What a condition costs on one approach: time lost there per run, summed over vehicles, against the
/// baseline.
struct ApproachCost {
    std::string edge;
    std::optional<double> baseline_s;     ///< Mean over the baseline's runs.
    MaybeEstimate difference;             ///< Paired, s per run; all classes together.
    MaybeEstimate human;                  ///< Of human-driven vehicles alone.
    MaybeEstimate automated;              ///< Of automated ones.
    MaybeEstimate waiting;                ///< Waiting time, all classes.
    std::optional<double> vehicles;       ///< Vehicles that enter it, mean over the baseline's runs.
    std::optional<double> per_vehicle_s;  ///< Mean difference per vehicle.
    std::optional<double> t_p = {};       ///< Of the paired t test of `difference`.
    /// Adjusted for all approaches and conditions of a scenario (Holm); nothing before they are compared.
    std::optional<double> holm_p = {};
};

/// Halted vehicles on the other approaches of a signal around an EV's passage, compared with the passages of
/// the baseline.
struct RecoveryPoint {
    double offset_s = 0.0;  ///< After the EV passed the stop line.
    MaybeEstimate difference;
};
/// How long queues must stay back at the baseline's level to count as recovered, s. Assumed: a third of a
/// usual cycle.
inline constexpr double recovered_for_s = 30.0;
/// Fewer halted vehicles more than in the baseline count as its level. Assumed: one more vehicle is the least
/// that a queue can be longer by.
inline constexpr double recovered_within_vehicles = 1.0;
/// Whether queues recovered is told by what intervals exclude, so that fewer pairs never tell more.
struct Recovery {
    std::vector<RecoveryPoint> points;  ///< Ascending.
    /// The first offset >= 0 from which intervals stay below `recovered_within_vehicles` for
    /// `recovered_for_s`. Nothing if that is not reached within the points, and where points have no
    /// interval.
    std::optional<double> recovered_by_s;
    /// Whether an interval lies above `recovered_within_vehicles` in every such stretch of time: queues are
    /// shown not to recover.
    bool stays_longer = false;
    /// Pairs with which some stretch would be told to be recovered, at its means and deviations. Nothing
    /// where it is told, and where means stay above in every stretch.
    std::optional<std::size_t> pairs_to_tell;
};

/// One entry per edge, the largest absolute mean difference first. Empty if no pair of runs has approaches.
/// An approach that no vehicle entered in a run counts 0 in it.
std::vector<ApproachCost> approach_costs(const detail::Runs& condition, const detail::Runs& baseline,
                                         double level);

/// Nothing if no pair of runs has passages.
std::optional<Recovery> recovery_after(const detail::Runs& condition, const detail::Runs& baseline,
                                       double level);

}  // namespace clearway::analysis
