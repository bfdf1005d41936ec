#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.hpp"
#include "core/spellings.hpp"
#include "scenario/call.hpp"
#include "scenario/incident.hpp"
#include "scenario/pedestrians.hpp"
#include "scenario/road_condition.hpp"
#include "scenario/site.hpp"
#include "traffic/privilege.hpp"
#include "traffic/siren.hpp"

namespace clearway::scenario {

/// Named parameter sets of the Intelligent Driver Model; vehicle_types.cpp has the numbers.
enum class IdmPreset { sumo, treiber };
/// Whether an imported network is cut down to its largest set of edges that all reach each other by car.
enum class Restriction { none, largest_car_component };
/// Which lanes a measured vehicle may use: those of its kind, or all (SUMO's class `ignoring`).
enum class Access { own, unrestricted };
/// How the vehicles of an imported demand follow each other: with the model of their own type, or with the
/// model of the scenario (`[drivers]` and `[car_following]`).
enum class CarFollowing { own, idm };
/// The car-following model of a scenario's vehicles: the Intelligent Driver Model, or SUMO's own model after
/// Krauss 1998 with its defaults.
enum class FollowingModel { idm, krauss };
enum class Variant { standard, dense };
/// Edges between which the trips of `[trips]` are drawn: `connected` means the largest set whose edges all
/// reach each other by car; `reachable` means any edge and one that can be reached from it, for networks with
/// through traffic (a single intersection, a motorway).
enum class TripEnds { connected, reachable };
/// Where the demand of a scenario comes from.
enum class DemandKind { flows, trips, measured };

/// Spelling of each enumerator in files and on the command line.
constexpr core::Spellings<IdmPreset, 2> spellings(IdmPreset) {
    return {{{IdmPreset::sumo, "sumo"}, {IdmPreset::treiber, "treiber"}}};
}
constexpr core::Spellings<Variant, 2> spellings(Variant) {
    return {{{Variant::standard, "standard"}, {Variant::dense, "dense"}}};
}
constexpr core::Spellings<Restriction, 2> spellings(Restriction) {
    return {{{Restriction::none, "none"}, {Restriction::largest_car_component, "largest_car_component"}}};
}
constexpr core::Spellings<TripEnds, 2> spellings(TripEnds) {
    return {{{TripEnds::connected, "connected"}, {TripEnds::reachable, "reachable"}}};
}
constexpr core::Spellings<Access, 2> spellings(Access) {
    return {{{Access::own, "own"}, {Access::unrestricted, "unrestricted"}}};
}
constexpr core::Spellings<CarFollowing, 2> spellings(CarFollowing) {
    return {{{CarFollowing::own, "own"}, {CarFollowing::idm, "idm"}}};
}
constexpr core::Spellings<FollowingModel, 2> spellings(FollowingModel) {
    return {{{FollowingModel::idm, "idm"}, {FollowingModel::krauss, "krauss"}}};
}
constexpr core::Spellings<Crossings, 2> spellings(Crossings) {
    return {{{Crossings::signals, "signals"}, {Crossings::all, "all"}}};
}

/// Table `[network]`: plain XML files for netconvert, or a network file to import. Paths are relative to the
/// scenario's folder unless they are absolute or start with `$SUMO_HOME`.
struct NetworkSource {
    std::string nodes;
    std::string edges;
    std::string connections;
    std::string signals;
    std::string file;
    Restriction restrict = Restriction::none;
    std::string attribution;
    std::string map_date;
    std::string preemption;
    std::string mean_times;
    std::vector<std::string> additional;  ///< SUMO's additional files that belong to the network.

    bool plain() const { return file.empty(); }
    static constexpr void fields(const auto& table) {
        using S = NetworkSource;
        table(
            core::Field{"nodes", "", &S::nodes, 0, 0, "Plain XML nodes for netconvert.", "scenario"},
            core::Field{"edges", "", &S::edges, 0, 0, "Plain XML edges for netconvert.", "scenario"},
            core::Field{"connections", "", &S::connections, 0, 0, "Plain XML connections; optional.",
                        "scenario"},
            core::Field{"signals", "", &S::signals, 0, 0, "Plain XML signal programs; optional.", "scenario"},
            core::Field{"file", "", &S::file, 0, 0, "A .net.xml or .net.xml.gz to import instead.",
                        "scenario"},
            core::Field{"restrict", "", &S::restrict, 0, 0, "none or largest_car_component (imports only).",
                        "none: the network as it is"},
            core::Field{"attribution", "", &S::attribution, 0, 0,
                        "Attribution that users of the map data must give.", "licence"},
            core::Field{"map_date", "", &S::map_date, 0, 0,
                        "Day of the map data, first YYYY-MM-DD; optional.", "the map's timestamps"},
            core::Field{
                "preemption", "", &S::preemption, 0, 0,
                "CSV of the signals' preemption parameters (clearway scenario signals writes it); optional.",
                "none: the settings of the condition"},
            core::Field{"mean_times", "", &S::mean_times, 0, 0,
                        "Mean times of edges on other days (clearway scenario mean-times writes them), for "
                        "navigate.prior; beside the scenario; optional.",
                        "none"});
    }
};

/// Table `[time]`.
struct Times {
    double warm_up_s = 60.0;
    double window_s = 120.0;
    double horizon_s = 1800.0;
    double step_length_s = 0.25;
    std::optional<double> time_to_teleport_s;
    std::optional<double> ignore_junction_blocker_s;
    std::optional<double> events_spread_s;

    static constexpr void fields(const auto& table) {
        using S = Times;
        table(
            core::Field{"warm_up_s", "s", &S::warm_up_s, 0.0, 86400.0,
                        "Emergency vehicles depart at this time or later.",
                        "60 s: the first vehicles have passed most of the road"},
            core::Field{"window_s", "s", &S::window_s, 1.0, 86400.0, "All vehicles depart in [0, window_s].",
                        "assumed: 100 to 200 s for the counts of TABLE I"},
            core::Field{
                "horizon_s", "s", &S::horizon_s, 1.0, 604800.0,
                "A run that is not over by then is cut off, and its vehicles count as running at end.",
                "assumed: several times the longest free trip"},
            core::Field{"step_length_s", "s", &S::step_length_s, 0.1, 1.0,
                        "Simulation step; above 0.25 s results are marked.",
                        "docs/decisions/0001-step-length.md"},
            core::Field{"time_to_teleport_s", "s", &S::time_to_teleport_s, -1.0, 86400.0,
                        "SUMO teleports a vehicle that has stood this long past the jam; -1: never.",
                        "none: SUMO's 300 s"},
            core::Field{"ignore_junction_blocker_s", "s", &S::ignore_junction_blocker_s, -1.0, 86400.0,
                        "A vehicle that has stood inside a junction for this long no longer blocks those who "
                        "cross its way; -1: it always does.",
                        "none: -1. New scenarios and imports are written with 10 s: "
                        "docs/decisions/0016-locks.md"},
            core::Field{"events_spread_s", "s", &S::events_spread_s, 0.0, 86400.0,
                        "Incidents, calls and [[emergency_trip]] come, together, up to this much later, by "
                        "the seed.",
                        "none: 0. At fixed times each meets signals in the same phase in every run"});
    }

    /// The latest that an event of the file can come, for one that it has at `at_s`.
    double latest_s(double at_s) const { return at_s + events_spread_s.value_or(0.0); }
};

/// What new scenarios and imports are written with, s: docs/decisions/0016-locks.md.
inline constexpr double usual_ignore_junction_blocker_s = 10.0;

/// Table `[demand]`. It sets the numbers of human and automated vehicles unless the demand is measured.
struct Demand {
    int human = 0;
    int automated = 0;
    int emergency = 0;
    double density = 1.0;
    std::string counts;

    static constexpr void fields(const auto& table) {
        using S = Demand;
        table(core::Field{"human", "1", &S::human, 0.0, 100000.0, "Human-driven vehicles.",
                          "dissertation TABLE I"},
              core::Field{"automated", "1", &S::automated, 0.0, 100000.0, "Automated vehicles.",
                          "dissertation TABLE I"},
              core::Field{"emergency", "1", &S::emergency, 0.0, 1000.0, "Emergency vehicles.",
                          "dissertation TABLE I"},
              core::Field{"density", "1", &S::density, 0.0, 20.0,
                          "Factor on the human and automated vehicles; at most 1 for measured demand.",
                          "1: as counted"},
              core::Field{"counts", "", &S::counts, 0, 0,
                          "CSV of counted flows (edge, vehicles_per_hour) to compare the demand with.",
                          "none"});
    }
};

/// Table `[dense]`, optional: what the dense variant changes.
struct Dense {
    double factor = 1.0;
    int emergency = 0;
    double warm_up_s = 0.0;
    double window_s = 1.0;

    static constexpr void fields(const auto& table) {
        using S = Dense;
        table(core::Field{"factor", "1", &S::factor, 0.0, 100.0, "Factor on human and automated vehicles.",
                          "assumed: 7 to 10 times the counts of TABLE I"},
              core::Field{"emergency", "1", &S::emergency, 0.0, 1000.0, "Emergency vehicles.",
                          "assumed: twice as many as usual, or more"},
              core::Field{"warm_up_s", "s", &S::warm_up_s, 0.0, 86400.0, "See time.warm_up_s.", "scenario"},
              core::Field{"window_s", "s", &S::window_s, 1.0, 86400.0, "See time.window_s.",
                          "assumed: 400 to 600 s, so that the dense demand can enter"});
    }
};

/// Table `[limits]`. A vehicle's limit is the lower of its class limit and the road limit.
struct SpeedLimits {
    double human_kmh = 120.0;
    double automated_kmh = 140.0;
    double emergency_kmh = 140.0;
    double road_kmh = 0.0;

    static constexpr void fields(const auto& table) {
        using S = SpeedLimits;
        table(core::Field{"human_kmh", "km/h", &S::human_kmh, 1.0, 400.0,
                          "Highest speed of human drivers, also where the road allows more.",
                          "dissertation TABLE I"},
              core::Field{"automated_kmh", "km/h", &S::automated_kmh, 1.0, 400.0,
                          "Highest speed of automated vehicles.", "dissertation TABLE I"},
              core::Field{"emergency_kmh", "km/h", &S::emergency_kmh, 1.0, 400.0,
                          "Highest speed of emergency vehicles.", "dissertation TABLE I"},
              core::Field{"road_kmh", "km/h", &S::road_kmh, 0.0, 400.0,
                          "Roads with a higher limit are limited to this; 0 leaves the roads as they are.",
                          "0: the network's own limits"});
    }
};

/// Table `[drivers]`. Desired speed of a human driver = factor x road limit, at most the class limit.
struct Drivers {
    IdmPreset idm = IdmPreset::sumo;
    double speed_factor_mean = 1.0;
    double speed_factor_deviation = 0.1;
    double speed_factor_minimum = 0.75;
    double speed_factor_maximum = 1.25;

    static constexpr void fields(const auto& table) {
        using S = Drivers;
        table(core::Field{"idm", "", &S::idm, 0, 0, "Parameters of the car-following model: sumo or treiber.",
                          "docs/decisions/0001-step-length.md"},
              core::Field{"speed_factor_mean", "1", &S::speed_factor_mean, 0.1, 3.0,
                          "Human drivers: mean ratio of desired speed to road limit.",
                          "assumed: N(1, 0.1), SUMO's usual spread of passenger cars"},
              core::Field{"speed_factor_deviation", "1", &S::speed_factor_deviation, 0.0, 1.0,
                          "Its standard deviation before truncation.",
                          "assumed: N(1, 0.1), SUMO's usual spread of passenger cars"},
              core::Field{"speed_factor_minimum", "1", &S::speed_factor_minimum, 0.1, 3.0,
                          "Lower bound of the truncation.", "assumed: 2.5 standard deviations"},
              core::Field{"speed_factor_maximum", "1", &S::speed_factor_maximum, 0.1, 3.0,
                          "Upper bound of the truncation.", "assumed: 2.5 standard deviations"});
    }
};

/// Table `[car_following]`, optional: other drivers than usual.
struct Following {
    FollowingModel model = FollowingModel::idm;
    double driver_spread = 0.0;

    bool operator==(const Following&) const = default;
    static constexpr void fields(const auto& table) {
        using S = Following;
        table(
            core::Field{"model", "", &S::model, 0, 0,
                        "idm: parameters of [drivers]; krauss: SUMO's own model with its defaults.",
                        "idm: docs/decisions/0001-step-length.md"},
            core::Field{"driver_spread", "1", &S::driver_spread, 0.0, 1.0,
                        "Relative standard deviation of headway, acceleration, deceleration and speed factor "
                        "between human drivers.",
                        "0: drivers differ in their speed factor alone"});
    }
};

/// Table `[slow]`, optional: vehicles that drive slower than the rest, such as tractors and laden trucks.
struct Slow {
    double share = 0.0;
    double speed_factor = 0.7;

    bool operator==(const Slow&) const = default;
    static constexpr void fields(const auto& table) {
        using S = Slow;
        table(core::Field{"share", "1", &S::share, 0.0, 1.0,
                          "Share of the human and automated vehicles that drive slowly.", "0: none"},
              core::Field{"speed_factor", "1", &S::speed_factor, 0.1, 1.0,
                          "Their desired speed divided by the road limit.",
                          "assumed: a laden truck on a road of 100 km/h"});
    }
};

/// Table `[privilege]`, optional: what the law allows emergency vehicles, in every condition and the
/// baseline.
struct Privilege : traffic::PrivilegeConfig {
    int oncoming_lane = 0;

    bool none() const { return traffic::PrivilegeConfig::none() && oncoming_lane == 0; }
    static constexpr void fields(const auto& table) {
        table(core::Field{"oncoming_lane", "1", &Privilege::oncoming_lane, 0, 1,
                          "1: emergency vehicles alone overtake on the lane of oncoming "
                          "traffic, where the network joins "
                          "the two; otherwise all do",
                          "0: earlier scenarios leave it out"});
        traffic::PrivilegeConfig::fields(table);
    }
};

/// Table `[kinds.traffic]`: relative frequency of each kind among the human and automated vehicles of
/// generated demand.
struct TrafficKinds {
    double car = 1.0;
    double van = 0.0;
    double truck = 0.0;
    double bus = 0.0;

    static constexpr void fields(const auto& table) {
        using S = TrafficKinds;
        table(
            core::Field{"car", "1", &S::car, 0.0, 1e6, "Weight of cars.", "dissertation: all vehicles alike"},
            core::Field{"van", "1", &S::van, 0.0, 1e6, "Weight of vans.", "0"},
            core::Field{"truck", "1", &S::truck, 0.0, 1e6, "Weight of trucks.", "0"},
            core::Field{"bus", "1", &S::bus, 0.0, 1e6, "Weight of buses.", "0"});
    }
};

/// Table `[kinds.emergency]`.
struct EmergencyKinds {
    double ambulance = 1.0;
    double fire_engine = 0.0;
    double police_car = 0.0;

    static constexpr void fields(const auto& table) {
        using S = EmergencyKinds;
        table(core::Field{"ambulance", "1", &S::ambulance, 0.0, 1e6, "Weight of ambulances.", "all alike"},
              core::Field{"fire_engine", "1", &S::fire_engine, 0.0, 1e6, "Weight of fire engines.", "0"},
              core::Field{"police_car", "1", &S::police_car, 0.0, 1e6, "Weight of police cars.", "0"});
    }
};

/// Table `[trips]`: origins and destinations are drawn over the whole network, weighted by edge length.
struct Trips {
    double minimum_length_m = 500.0;
    double emergency_minimum_length_m = 1000.0;
    double minimum_edge_m = 20.0;
    std::optional<double> maximum_distance_m;
    TripEnds ends = TripEnds::connected;

    static constexpr void fields(const auto& table) {
        using S = Trips;
        table(core::Field{"minimum_length_m", "m", &S::minimum_length_m, 0.0, 1e6,
                          "Shortest trip of a human or automated vehicle.", "assumed: several junctions"},
              core::Field{"emergency_minimum_length_m", "m", &S::emergency_minimum_length_m, 0.0, 1e6,
                          "Shortest trip of an emergency vehicle.", "assumed: twice that of other vehicles"},
              core::Field{"minimum_edge_m", "m", &S::minimum_edge_m, 0.0, 1000.0,
                          "Trips start and end on edges at least this long.",
                          "assumed: the longest vehicle, a bus of 12 m, fits"},
              core::Field{"maximum_distance_m", "m", &S::maximum_distance_m, 1.0, 1e6,
                          "Longest straight-line distance between the ends of a trip.", "none: no limit"},
              core::Field{"ends", "", &S::ends, 0, 0,
                          "connected: in the largest set of edges that all reach each other; reachable: any "
                          "edge and one that it leads to.",
                          "connected"});
    }
};

/// One of `[[flow]]`: a share of all vehicles drives the fastest route from one edge to another.
struct Flow {
    std::string from;
    std::string to;
    double share = 1.0;

    static constexpr void fields(const auto& table) {
        using S = Flow;
        table(core::Field{"from", "", &S::from, 0, 0, "First edge.", "scenario"},
              core::Field{"to", "", &S::to, 0, 0, "Last edge.", "scenario"},
              core::Field{"share", "1", &S::share, 0.0, 1.0,
                          "Share of the vehicles; the shares of all flows add up to 1.", "scenario"});
    }
};

/// One of `[[emergency_trip]]`: an emergency vehicle with its own trip, in addition to those that
/// `demand.emergency` counts.
struct EmergencyTrip {
    std::string from;
    std::string to;
    std::string edges;
    double depart_s = 0.0;
    std::string kind = "ambulance";

    static constexpr void fields(const auto& table) {
        using S = EmergencyTrip;
        table(
            core::Field{"from", "", &S::from, 0, 0, "First edge.", "scenario"},
            core::Field{"to", "", &S::to, 0, 0, "Last edge.", "scenario"},
            core::Field{
                "edges", "", &S::edges, 0, 0,
                "Its whole route, edges with blanks between, instead of from and to, between which it takes "
                "the fastest.",
                "none"},
            core::Field{"depart_s", "s", &S::depart_s, 0.0, 604800.0,
                        "Departure, not before the end of the warm-up.", "scenario"},
            core::Field{"kind", "", &S::kind, 0, 0, "ambulance, fire_engine or police_car.", "ambulance"});
    }
};

/// One of `[[measured.type]]`: what a vehicle type of the measured demand becomes.
struct MeasuredType {
    std::string id;
    std::string kind = "car";
    Access access = Access::own;

    static constexpr void fields(const auto& table) {
        using S = MeasuredType;
        table(core::Field{"id", "", &S::id, 0, 0, "Type in the route files.", "scenario"},
              core::Field{"kind", "", &S::kind, 0, 0, "car, van, truck, bus, or other (needs own_types).",
                          "car"},
              core::Field{"access", "", &S::access, 0, 0,
                          "own: the lanes of its kind; unrestricted: all lanes.", "own"});
    }
};

/// Table `[measured.own_types]`: the vehicles keep the size, dynamics and permissions of their own types,
/// which a SUMO file defines. Without this table they get those of their kind. Automated vehicles always use
/// the Intelligent Driver Model.
struct OwnTypes {
    std::string file;
    CarFollowing car_following = CarFollowing::own;

    static constexpr void fields(const auto& table) {
        using S = OwnTypes;
        table(core::Field{"file", "", &S::file, 0, 0,
                          "Additional file with a <vType> for each measured.type.", "scenario"},
              core::Field{"car_following", "", &S::car_following, 0, 0,
                          "own: as in the types; idm: the model of the scenario, parameters of [drivers].",
                          "own"});
    }
};

/// What a SUMO configuration may set beyond Clearway's own keys, with numbers as values: how actuated signals
/// and rerouting vehicles see the traffic.
inline constexpr std::array<std::string_view, 7> kept_options = {"tls.actuated.jam-threshold",
                                                                 "tls.actuated.detector-length",
                                                                 "device.rerouting.adaptation-weight",
                                                                 "device.rerouting.adaptation-steps",
                                                                 "device.rerouting.adaptation-interval",
                                                                 "weights.random-factor",
                                                                 "weights.priority-factor"};

/// Table `[measured]`: route files with measured departures and routes. A share of the cars, chosen by
/// vehicle id, is automated; nothing else about them changes.
struct Measured {
    double automated_share = 0.35;
    double emergency_minimum_length_m = 1000.0;
    std::vector<std::string> routes;
    std::vector<std::string> additional;
    /// Route files of walking `<person>`s, with their types. They are the same in every condition.
    std::vector<std::string> persons;
    /// SUMO's options that the demand was made for, `tls.actuated.jam-threshold=30`; of `kept_options`.
    std::vector<std::string> options;
    std::vector<MeasuredType> types;
    std::optional<OwnTypes> own_types;

    static constexpr void fields(const auto& table) {
        using S = Measured;
        table(core::Field{"automated_share", "1", &S::automated_share, 0.0, 1.0,
                          "Share of the cars that are automated.", "dissertation TABLE I, city: 26 of 73"},
              core::Field{"emergency_minimum_length_m", "m", &S::emergency_minimum_length_m, 0.0, 1e6,
                          "Emergency vehicles take measured routes of cars at least this long.",
                          "assumed: as trips.emergency_minimum_length_m"});
    }
};

/// A scenario, complete and checked. Apart from it, demand and drivers depend only on study seed and
/// replication.
struct ScenarioConfig {
    std::string name;
    std::string version;
    std::string title;
    NetworkSource network;
    Times time;
    Demand demand;
    std::optional<Dense> dense;
    SpeedLimits limits;
    Drivers drivers;
    Following following;         ///< Table `[car_following]`.
    traffic::SirenConfig siren;  ///< Table `[siren]`, optional: without it nobody yields.
    Slow slow;
    Privilege privilege;
    RoadCondition road;
    Pedestrians pedestrians;
    TrafficKinds traffic_kinds;
    EmergencyKinds emergency_kinds;
    Trips trips;
    std::vector<Flow> flows;
    std::vector<EmergencyTrip> emergency_trips;
    std::vector<EmergencySite> emergency_sites;
    std::vector<Incident> incidents;
    std::vector<Call> calls;
    std::optional<Measured> measured;

    Variant variant = Variant::standard;  ///< Already in the rest. Not part of the configuration.
    double density_factor = 1.0;          ///< Of an override, contained in demand.density. Likewise.
    std::filesystem::path folder;         ///< Relative paths start here. Not part of the configuration.
    /// Where each key was set: `time.window_s` -> `merge/scenario.toml:14:1: time.window_s`.
    std::map<std::string, std::string> origins;

    DemandKind demand_kind() const;
    /// Whether there are pedestrians, measured or drawn. Solo runs have none.
    bool has_pedestrians() const;
    /// Where a key was set, for messages: file, line and column, or the option, or only the key.
    std::string where(const std::string& key) const;
};

/// A value as text, and where it was given: an option, or file, line and column.
struct Given {
    std::string text;
    std::string where;
};

/// What a user changes of a scenario.
struct Options {
    /// By name, as overrides.hpp lists them: `friction` -> `0.7`. What is not there stays as the file says.
    std::map<std::string, Given> overrides = {};
    /// Keys that replace those of scenario.toml before it is checked: `demand.human` -> `40`, the value as
    /// TOML text. Arrays of tables cannot be set.
    std::map<std::string, std::string> settings = {};

    /// Sets an override; `where` is its option unless another place is given. Name and value are checked when
    /// a scenario is loaded.
    Options& set(const std::string& name, const std::string& text, const std::string& where = "");
    /// The number of an override; `otherwise` if it is not set.
    double number(const std::string& name, double otherwise) const;
};

/// Reads a scenario by name (one of `list()`), folder or TOML file, applies `options` and checks everything.
/// Strict: throws core::InputError with every problem found, each with file, line, column, value, what is
/// allowed and the nearest valid key. `prepare` checks the edges later, when there is a network. Throws
/// core::EnvironmentError when SUMO_HOME is needed and not set.
ScenarioConfig load(const std::string& name_or_path, const Options& options = {});

/// The effective configuration as a TOML file, every key written out. Reading it gives the same
/// configuration.
std::string to_toml(const ScenarioConfig& config);

/// Content hash of `to_toml` (32 hex digits): configurations with the same hash mean the same.
std::string configuration_hash(const ScenarioConfig& config);

/// Content hash of `to_toml` and of those files that exist among the ones it names relative to its folder.
std::string scenario_hash(const ScenarioConfig& config);

/// Writes the effective `scenario.toml` and copies the files that it names relative to its folder, so that
/// `folder` is a complete scenario.
void store(const ScenarioConfig& config, const std::filesystem::path& folder);

/// Names of the scenarios that come with Clearway, sorted.
std::vector<std::string> list();

/// The scenario that a new study should use in place of `name`: `city_v2` for `city`; `name` if there is
/// none.
std::string newest(const std::string& name);

/// Makes `folder` a copy of scenario `from` (name, folder or file) for the user to edit; it is named after
/// the folder, and gets `usual_ignore_junction_blocker_s` unless it has a value. Throws core::InputError when
/// the folder exists and is not empty.
void init(const std::filesystem::path& folder, const std::string& from);

/// A path of a scenario: `$SUMO_HOME` replaced, relative ones below `config.folder`.
/// Throws core::EnvironmentError when SUMO_HOME is needed and not set.
std::filesystem::path resolve(const ScenarioConfig& config, const std::string& path);

/// SUMO's additional files of the network and of the measured demand, resolved: signal programs, stops.
std::vector<std::filesystem::path> additional_files(const ScenarioConfig& config);

}  // namespace clearway::scenario
