#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/fields.hpp"
#include "core/ids.hpp"
#include "core/spellings.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::metrics {

/// How a vehicle's trip ended. Only `arrived` trips have a travel time that can be compared.
enum class VehicleOutcome : std::uint8_t {
    arrived,
    running_at_end,  ///< Still on the road at the end of the run.
    teleported,      ///< Taken out of a jam by SUMO, even when it arrived later.
    not_inserted,    ///< Never found room to depart.
    removed,         ///< Removed before it arrived.
};
constexpr core::Spellings<VehicleOutcome, 5> spellings(VehicleOutcome) {
    return {{{VehicleOutcome::arrived, "arrived"},
             {VehicleOutcome::running_at_end, "running_at_end"},
             {VehicleOutcome::teleported, "teleported"},
             {VehicleOutcome::not_inserted, "not_inserted"},
             {VehicleOutcome::removed, "removed"}}};
}
using core::name;

/// One vehicle of a run, from SUMO's tripinfo. For a vehicle that did not arrive, times run to its last
/// moment on the road and are lower bounds; a vehicle that was not inserted has none.
struct VehicleRow {
    std::string id;  ///< SUMO's id; text from a file, so printers escape it.
    core::VehicleKey key;
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    traffic::VehicleKind kind = traffic::VehicleKind::other;
    VehicleOutcome outcome = VehicleOutcome::arrived;
    std::uint32_t teleports = 0;
    double planned_depart_s = 0.0;
    std::optional<double> depart_s;
    std::optional<double> depart_delay_s;
    std::optional<double> arrival_s;
    std::optional<double> travel_time_s;
    std::optional<double> time_loss_s;
    std::optional<double> waiting_time_s;
    std::optional<std::uint32_t> waiting_count;
    std::optional<double> route_length_m;
    std::optional<double> incident_met_s;

    bool operator==(const VehicleRow&) const = default;

    /// The numeric columns. In every table, id, class, kind and outcome come before them.
    static constexpr void fields(const auto& table) {
        using R = VehicleRow;
        using core::Field;
        table(Field{"planned_depart_s", "s", &R::planned_depart_s, 0.0, 1e9, "Departure as the demand says",
                    ""},
              Field{"depart_s", "s", &R::depart_s, 0.0, 1e9, "Time of insertion", "tripinfo depart"},
              Field{"depart_delay_s", "s", &R::depart_delay_s, 0.0, 1e9, "Time spent waiting to be inserted",
                    "tripinfo departDelay"},
              Field{"arrival_s", "s", &R::arrival_s, 0.0, 1e9, "Time of arrival", "tripinfo arrival"},
              Field{"travel_time_s", "s", &R::travel_time_s, 0.0, 1e9,
                    "Time from insertion to the end of the trip", "tripinfo duration"},
              Field{"time_loss_s", "s", &R::time_loss_s, 0.0, 1e9,
                    "Time lost compared with driving at the desired speed",
                    "tripinfo timeLoss, and stops that a policy commanded"},
              Field{"waiting_time_s", "s", &R::waiting_time_s, 0.0, 1e9,
                    "Time below 0.1 m/s; planned stops excluded, those that a policy commanded not",
                    "tripinfo waitingTime, and stops that a policy commanded"},
              Field{"waiting_count", "1", &R::waiting_count, 0.0, 1e9, "How often it came to a halt",
                    "tripinfo waitingCount"},
              Field{"route_length_m", "m", &R::route_length_m, 0.0, 1e9, "Distance driven",
                    "tripinfo routeLength"},
              Field{"teleports", "1", &R::teleports, 0.0, 1e9, "Teleports of this vehicle", "events"},
              Field{"incident_met_s", "s", &R::incident_met_s, 0.0, 1e9,
                    "When an emergency vehicle first came to a road that an incident closed to it",
                    "incidents of the scenario"});
    }
};

}  // namespace clearway::metrics
