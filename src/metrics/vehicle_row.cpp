#include "metrics/vehicle_row.hpp"

namespace clearway::metrics {

std::string_view name(VehicleOutcome outcome) {
    switch (outcome) {
        case VehicleOutcome::arrived:
            return "arrived";
        case VehicleOutcome::running_at_end:
            return "running_at_end";
        case VehicleOutcome::teleported:
            return "teleported";
        case VehicleOutcome::not_inserted:
            return "not_inserted";
        case VehicleOutcome::removed:
            return "removed";
    }
    return "";
}

std::optional<VehicleOutcome> vehicle_outcome_from(std::string_view word) {
    for (const VehicleOutcome outcome : vehicle_outcomes) {
        if (name(outcome) == word) return outcome;
    }
    return std::nullopt;
}

}  // namespace clearway::metrics
