#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenario/config.hpp"

namespace clearway::scenario_import {

/// On which side of the road traffic drives; `by_country` looks at the map.
enum class DrivingSide : std::uint8_t { by_country, right, left };

/// What to do with vehicles that cannot drive, or persons who cannot walk, as a route file says: an unknown
/// edge, edges that do not join, an edge that is closed to pedestrians.
enum class BadVehicles : std::uint8_t { refuse, leave_out };

/// What the emergency vehicles of a SUMO scenario are: ordinary traffic beside Clearway's, or those measured.
enum class OwnEmergency : std::uint8_t { traffic, measure };

struct ImportRequest {
    /// One map (.osm, .osm.gz, .osm.bz2, .osm.pbf; several are merged), one network (.net.xml or .net.xml.gz)
    /// with any number of route and additional files, or one configuration (.sumocfg).
    std::vector<std::filesystem::path> files;
    std::filesystem::path folder;  ///< Of the scenario, which gets its name. Must not exist.
    DrivingSide side = DrivingSide::by_country;
    BadVehicles bad_vehicles = BadVehicles::refuse;
    OwnEmergency own_emergency = OwnEmergency::traffic;
    double automated_share = 0.35;                                       ///< 0 to 1.
    scenario::CarFollowing car_following = scenario::CarFollowing::own;  ///< Of vehicles with own types.
    /// At each crossing; 0 to 2000. Above 0, the roads of a map get sidewalks and crossings; networks keep
    /// those that they have.
    double pedestrians_per_hour = 0.0;
    std::optional<double> begin_s;  ///< Time in the route files at which the scenario begins.
    /// For each program that an import starts, s of wall time. A demand of 30,000 vehicles runs within it.
    double program_limit_s = 1800.0;
};

/// What a map, network or scenario holds, what was changed, and what could not be used. Texts may hold names
/// from the files.
struct Findings {
    std::string name;
    std::size_t edges = 0;      ///< Outside junctions.
    std::size_t car_edges = 0;  ///< Of these, those open to cars.
    std::size_t lanes = 0;      ///< Of edges open to cars.
    double road_km = 0.0;       ///< Length of the edges open to cars.
    double lane_km = 0.0;
    std::size_t signals = 0;      ///< Of the network.
    std::size_t map_signals = 0;  ///< Nodes of the map that they stand for; a junction may have several.
    /// Share of the car edges that are in the largest set whose edges reach each other.
    double connected_share = 0.0;
    bool left_hand = false;
    std::string side_reason;              ///< Why traffic drives on that side.
    std::map<std::string, int> sites;     ///< Hospitals and stations by kind.
    std::vector<std::string> site_names;  ///< In the order of the map.
    std::string emergency_trips;          ///< How EVs' trips are drawn, in words; empty for given ones.
    /// Of a map's data, `2012-05-03 (newest object)`; empty where it has no dates. Nothing without a map.
    std::optional<std::string> map_date;
    double vehicles_per_hour = 0.0;       ///< Human and automated vehicles, over the departure window.
    std::map<std::string, int> vehicles;  ///< By kind, in the window.
    std::size_t routed_trips = 0;         ///< Vehicles whose files give only ends.
    std::size_t routed_at_departure = 0;  ///< Of these, those that SUMO routes by the traffic of the moment.
    /// Share of the vehicles in the files that cannot drive their route and were left out, 0 to 1.
    double bad_vehicles_share = 0.0;
    /// What SUMO says of a trial run of the scenario that failed; empty where none did.
    std::string trial_failure;
    std::size_t persons = 0;  ///< Persons of the scenario's own files, in the window.
    std::string demand;       ///< Where the demand comes from and how busy it is, in words.
    std::vector<std::string> changes;
    std::vector<std::string> left_out;
};

/// Called often while an import works: what it is doing, and for how long. May throw, which ends the import
/// and leaves nothing behind.
using OnProgress = std::function<void(const std::string& stage, double elapsed_s)>;

/// With a larger share of bad vehicles the traffic is not that of the files any more.
inline constexpr double most_bad_vehicles = 0.1;

/// Makes a scenario folder that `scenario::load` reads: scenario.toml, network.net.xml, network.svg,
/// import.json with the findings, preemption.csv where there are signals and, for SUMO scenarios, their
/// demand. The folder is made elsewhere and renamed when complete. Netconvert, osmium, duarouter and sumo run
/// in child processes. Equal inputs give equal bytes. Throws core::InputError for what cannot be imported,
/// core::EnvironmentError when a program is missing.
Findings import(const ImportRequest& request, const OnProgress& on_progress);

/// The findings as lines of text, and as JSON with units in the names.
std::string to_text(const Findings& findings);
std::string to_json(const Findings& findings);

}  // namespace clearway::scenario_import
