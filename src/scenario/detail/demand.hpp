#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/random.hpp"
#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "traffic/departure.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::scenario::detail {

/// A human or automated vehicle for a route file.
struct PlannedVehicle {
    std::string id;
    traffic::VehicleClass vehicle_class = traffic::VehicleClass::human;
    double depart_s = 0.0;
    std::string xml;  ///< The whole element, indented, with a line end.
    /// The SUMO type that the driver's own one is made from; empty when the driver has none
    /// (driver_types.hpp).
    std::string own_type_of = {};
};

/// All vehicles of one replication.
struct PlannedDemand {
    std::vector<PlannedVehicle> vehicles;                ///< By departure, then by id.
    std::vector<traffic::EmergencyDeparture> emergency;  ///< By departure, then by id.
};

/// The inputs of a demand generator.
struct DemandContext {
    const ScenarioConfig& config;
    const roads::Network& network;
    core::KeyedRandom random{core::StudySeed{}, core::Replication{}};
};

/// Flows and trips: vehicles `human.0`, `automated.0`, ... counted by the configuration.
/// Throws core::InputError with every unknown edge and unreachable destination.
PlannedDemand generate(const DemandContext& context);

/// Measured route files: departures and routes as measured, a share of the cars automated. Throws
/// core::InputError for files that are not route files, and for types that the configuration does not list.
PlannedDemand read_measured(const DemandContext& context);

/// How much later than at its time in the file something comes, by the seed: up to `spread_s`, to 0.01 s.
core::Seconds drawn_delay(const core::KeyedRandom& random, std::string_view what, double spread_s);

/// Likewise all events of a scenario: incidents, calls and `[[emergency_trip]]`.
core::Seconds events_delay(const DemandContext& context);

/// Emergency vehicles of `[[emergency_trip]]`, appended to `demand`. Throws core::InputError as `generate`
/// does.
void add_emergency_trips(const DemandContext& context, PlannedDemand& demand);

/// The vehicles that calls send, as they are sent by free flow. `calls` are those of the scenario.
void add_calls(const DemandContext& context, const Calls& calls, PlannedDemand& demand);

/// Departure of emergency vehicle `id`: uniform in [warm_up_s, window_s], to 0.01 s.
double emergency_departure_s(const DemandContext& context, const std::string& id);

/// Kind of emergency vehicle `id`, by the weights of `[kinds.emergency]`.
traffic::VehicleKind emergency_kind(const DemandContext& context, const std::string& id);

/// Individual speed factor of a driver: 1 if automated, else from the truncated normal distribution of
/// `[drivers]`, to 0.0001. A driver spread larger than the deviation there takes its place.
double speed_factor(const DemandContext& context, const std::string& id, traffic::VehicleClass vehicle_class);

/// Edge ids of a route.
std::vector<std::string> edge_ids(const roads::Network& network, const std::vector<core::EdgeIndex>& route);

/// By departure, then by id.
void sort_by_departure(PlannedDemand& demand);

}  // namespace clearway::scenario::detail
