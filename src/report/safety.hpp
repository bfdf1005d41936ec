#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "report/facts.hpp"

namespace clearway::report {

/// One row of a condition's table of safety, comfort and flow.
struct SafetyRow {
    const analysis::MetricSummary* metric = nullptr;  ///< Of the condition.
    const char* title = "";                           ///< With the unit; static storage.
    std::optional<double> per_1000_km;  ///< Of counts: over all runs, per 1,000 vehicle-kilometres.

    /// Paired, to the baseline; nothing if nothing is compared.
    MaybeEstimate difference() const {
        return metric->comparison ? metric->comparison->difference : std::nullopt;
    }
};

/// Whether collisions are so many for so many vehicles that the model of drivers makes them, not a policy:
/// more than one to a hundred.
bool collide_by_model(std::uint64_t collisions, std::uint64_t vehicles);

/// Safety, comfort and flow of a condition, which outlives the rows; more of them if signals were asked for
/// green, and if there are pedestrians. Empty without a complete run.
std::vector<SafetyRow> safety_rows(const analysis::ConditionSummary& summary);

}  // namespace clearway::report
