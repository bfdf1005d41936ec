#include "scenario/detail/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include <fmt/format.h>

#include "core/folder_name.hpp"
#include "scenario/detail/road_place.hpp"
#include "scenario/map_age.hpp"
#include "scenario/mean_times.hpp"
#include "scenario/preemption.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::scenario::detail {

namespace {

using core::Problem;
using Problems = std::vector<Problem>;

void require_text(const ScenarioConfig& config, const char* key, const std::string& value,
                  Problems& problems) {
    if (value.empty()) problems.push_back({config.where(key), "is missing or empty", "text", "set it"});
}

void check_file(const ScenarioConfig& config, const std::string& key, const std::string& path,
                Problems& problems) {
    if (path.empty()) return;
    for (const std::filesystem::path& part : std::filesystem::path(path)) {
        if (part != "..") continue;
        problems.push_back({config.where(key), fmt::format("\"{}\" leaves the scenario's folder", path),
                            "a path inside it, an absolute path, or $SUMO_HOME/...",
                            "copy the file beside scenario.toml"});
        return;
    }
    const std::filesystem::path file = resolve(config, path);
    if (std::filesystem::is_regular_file(file)) return;
    const bool of_sumo = path.rfind("$SUMO_HOME", 0) == 0;
    problems.push_back(
        {config.where(key), fmt::format("no file {}", file.string()), "an existing file",
         of_sumo ? "install package sumo-tools" : "correct the path, relative to this scenario's folder"});
}

/// What needs no network; `build_network` checks the rest.
void check_preemption(const ScenarioConfig& config, Problems& problems) {
    const std::string& path = config.network.preemption;
    const std::size_t before = problems.size();
    check_file(config, "network.preemption", path, problems);
    if (!path.empty() && problems.size() == before) read_preemption_rows(resolve(config, path), problems);
}

void check_mean_times(const ScenarioConfig& config, Problems& problems) {
    const std::string& path = config.network.mean_times;
    if (path.empty()) return;
    const std::size_t before = problems.size();
    // Only files in the scenario's folder are in its hash.
    if (path.front() == '$' || std::filesystem::path(path).is_absolute())
        problems.push_back({config.where("network.mean_times"),
                            fmt::format("\"{}\" is not in the scenario's folder", path), "a path inside it",
                            "copy the file beside scenario.toml"});
    else
        check_file(config, "network.mean_times", path, problems);
    if (problems.size() == before) read_mean_times(resolve(config, path), problems);
}

void check_network(const ScenarioConfig& config, Problems& problems) {
    const NetworkSource& network = config.network;
    const bool has_plain = !network.nodes.empty() || !network.edges.empty() || !network.connections.empty() ||
                           !network.signals.empty();
    if (!network.file.empty() && has_plain)
        problems.push_back({config.where("network.file"), "is given together with plain XML files",
                            "one of the two", "remove file, or nodes, edges, connections and signals"});
    if (network.file.empty() && (network.nodes.empty() || network.edges.empty()))
        problems.push_back(
            {config.where("network"), "names no network", "file, or nodes and edges", "add them"});
    if (network.plain() && network.restrict != Restriction::none)
        problems.push_back(
            {config.where("network.restrict"), "applies to imported networks only", "none", ""});
    check_file(config, "demand.counts", config.demand.counts, problems);
    check_file(config, "network.nodes", network.nodes, problems);
    check_file(config, "network.edges", network.edges, problems);
    check_file(config, "network.connections", network.connections, problems);
    check_file(config, "network.signals", network.signals, problems);
    check_file(config, "network.file", network.file, problems);
    for (const std::string& path : network.additional)
        check_file(config, "network.additional", path, problems);
    if (!network.map_date.empty() && !begins_with_map_date(network.map_date))
        problems.push_back({config.where("network.map_date"),
                            fmt::format("\"{}\" does not begin with a day of map data", network.map_date),
                            "YYYY-MM-DD, from 2004 on", "correct it, or leave it out"});
    check_preemption(config, problems);
    check_mean_times(config, problems);
}

void check_time(const ScenarioConfig& config, Problems& problems) {
    const Times& time = config.time;
    if (time.warm_up_s > time.window_s && config.demand.emergency > 0)
        problems.push_back({config.where("time.warm_up_s"),
                            fmt::format("{} is after the last departure", time.warm_up_s),
                            fmt::format("0 to {} (time.window_s)", time.window_s),
                            "emergency vehicles depart in [warm_up_s, window_s]"});
    if (time.horizon_s < time.window_s)
        problems.push_back({config.where("time.horizon_s"),
                            fmt::format("{} is before the last departure", time.horizon_s),
                            fmt::format("{} (time.window_s) or more", time.window_s), ""});
    if (config.dense && config.dense->warm_up_s > config.dense->window_s)
        problems.push_back({config.where("dense.warm_up_s"),
                            fmt::format("{} is after the last departure", config.dense->warm_up_s),
                            fmt::format("0 to {} (dense.window_s)", config.dense->window_s), ""});
}

void check_emergency_trips(const ScenarioConfig& config, Problems& problems) {
    for (std::size_t row = 0; row < config.emergency_trips.size(); ++row) {
        const EmergencyTrip& trip = config.emergency_trips[row];
        const std::string key = fmt::format("emergency_trip[{}]", row);
        if (trip.depart_s < config.time.warm_up_s ||
            config.time.latest_s(trip.depart_s) > config.time.horizon_s)
            problems.push_back(
                {config.where(key + ".depart_s"),
                 fmt::format(
                     "{} is {}", trip.depart_s,
                     trip.depart_s < config.time.warm_up_s ? "before the warm-up ends" : "after the horizon"),
                 fmt::format("{} (time.warm_up_s) to {} (time.horizon_s{})", config.time.warm_up_s,
                             config.time.horizon_s - config.time.latest_s(0.0),
                             config.time.events_spread_s ? " less time.events_spread_s" : ""),
                 "change the departure or the warm-up"});
        bool known = false;
        core::for_each_field<EmergencyKinds>([&](const auto& field) { known |= trip.kind == field.name; });
        if (!known)
            problems.push_back({config.where(key + ".kind"), fmt::format("\"{}\" is not known", trip.kind),
                                "ambulance, fire_engine, police_car", ""});
        const bool has_ends = !trip.from.empty() && !trip.to.empty();
        if (trip.edges.empty() ? !has_ends : !trip.from.empty() || !trip.to.empty())
            problems.push_back(
                {config.where(key),
                 trip.edges.empty() ? "has no from or no to" : "has edges, and from or to besides",
                 "from and to, or edges", "give one of the two"});
    }
}

void check_flows(const ScenarioConfig& config, Problems& problems) {
    double sum = 0.0;
    for (std::size_t row = 0; row < config.flows.size(); ++row) {
        const Flow& flow = config.flows[row];
        sum += flow.share;
        if (flow.from.empty() || flow.to.empty())
            problems.push_back({config.where(fmt::format("flow[{}]", row)), "has no from or no to",
                                "ids of edges", "set both"});
    }
    constexpr double rounding = 1e-6;
    if (!config.flows.empty() && std::abs(sum - 1.0) > rounding)
        problems.push_back({config.where("flow[0].share"), fmt::format("the shares add up to {:.6g}", sum),
                            "1", "correct the shares of the flows"});
}

void check_density(const ScenarioConfig& config, Problems& problems) {
    // As in the field table; the factors of the dense variant and of --density multiply.
    constexpr double largest = 100.0;
    if (config.demand.density > largest)
        problems.push_back({config.where("demand.density"),
                            fmt::format("all factors together are {}", config.demand.density),
                            fmt::format("0 to {}", largest), "lower --density"});
}

void check_option(const ScenarioConfig& config, const std::string& option, Problems& problems) {
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string name = option.substr(0, equals);
    const std::vector<std::string> known(kept_options.begin(), kept_options.end());
    char* end = nullptr;
    const char* const value = option.c_str() + std::min(equals + 1, option.size());
    const bool is_number = std::isfinite(std::strtod(value, &end)) && end != value && *end == '\0';
    if (!core::contains(known, name))
        problems.push_back({config.where("measured.options"), fmt::format("\"{}\" is not known", name),
                            core::listed(known), core::did_you_mean(name, known)});
    else if (!is_number)
        problems.push_back({config.where("measured.options"), fmt::format("\"{}\" has no number", option),
                            name + "=NUMBER", ""});
}

void check_measured(const ScenarioConfig& config, Problems& problems) {
    if (!config.measured) return;
    const Measured& measured = *config.measured;
    if (!config.flows.empty())
        problems.push_back(
            {config.where("flow[0]"), "is given together with [measured]", "one of the two", "remove one"});
    if (config.demand.human + config.demand.automated > 0)
        problems.push_back(
            {config.where("demand.human"), "counts vehicles together with [measured]", "0",
             "measured demand brings its own vehicles; use density and measured.automated_share"});
    if (config.demand.density > 1.0)
        problems.push_back({config.where("demand.density"),
                            fmt::format("{} multiplies measured vehicles", config.demand.density), "0 to 1",
                            "measured demand can be thinned, not multiplied"});
    if (measured.routes.empty())
        problems.push_back({config.where("measured.routes"), "is missing or empty", "route files", "set it"});
    for (const std::string& path : measured.routes)
        check_file(config, "measured.routes", path, problems);
    for (const std::string& path : measured.additional)
        check_file(config, "measured.additional", path, problems);
    for (const std::string& path : measured.persons)
        check_file(config, "measured.persons", path, problems);
    for (const std::string& option : measured.options)
        check_option(config, option, problems);
    if (measured.own_types) {
        require_text(config, "measured.own_types.file", measured.own_types->file, problems);
        check_file(config, "measured.own_types.file", measured.own_types->file, problems);
    }
    for (std::size_t row = 0; row < measured.types.size(); ++row) {
        bool known = measured.own_types && measured.types[row].kind == "other";
        core::for_each_field<TrafficKinds>(
            [&](const auto& field) { known |= measured.types[row].kind == field.name; });
        if (!known)
            problems.push_back({config.where(fmt::format("measured.type[{}].kind", row)),
                                fmt::format("\"{}\" is not known", measured.types[row].kind),
                                measured.own_types ? "car, van, truck, bus, other" : "car, van, truck, bus",
                                ""});
    }
}

void check_sites(const ScenarioConfig& config, Problems& problems) {
    if (!config.emergency_sites.empty() && config.calls.empty() && config.demand_kind() == DemandKind::flows)
        problems.push_back({config.where("emergency_site[0]"), "is given together with [[flow]]",
                            "trips or measured, or a scenario with [[call]]",
                            "remove one; [[emergency_trip]] adds single emergency vehicles"});
    for (std::size_t row = 0; row < config.emergency_sites.size(); ++row)
        check_edge_or_coordinates(config.emergency_sites[row], config, fmt::format("emergency_site[{}]", row),
                                  problems);
}

void check_road(const ScenarioConfig& config, Problems& problems) {
    std::map<std::string, std::string> owner;
    for (const Stretch& stretch : config.road.stretches) {
        const std::string key = fmt::format("road.stretch.{}", stretch.name);
        if (stretch.edges.empty())
            problems.push_back({config.where(key), "has no edges", "edges = [\"id\", ...]", "name them"});
        for (const std::string& edge : stretch.edges) {
            const auto [first, is_new] = owner.emplace(edge, stretch.name);
            if (!is_new)
                problems.push_back(
                    {config.where(key + ".edges"),
                     fmt::format("names edge '{}', which is already in '{}'", edge, first->second),
                     "each edge once", "remove one"});
        }
    }
}

template <class Struct>
double sum_of_weights(const Struct& weights) {
    double sum = 0.0;
    core::for_each_field<Struct>([&](const auto& field) { sum += weights.*field.member; });
    return sum;
}

void check_drivers(const ScenarioConfig& config, Problems& problems) {
    const Drivers& drivers = config.drivers;
    if (drivers.speed_factor_minimum > drivers.speed_factor_mean ||
        drivers.speed_factor_mean > drivers.speed_factor_maximum)
        problems.push_back({config.where("drivers.speed_factor_mean"),
                            fmt::format("{} is outside [{}, {}]", drivers.speed_factor_mean,
                                        drivers.speed_factor_minimum, drivers.speed_factor_maximum),
                            "minimum <= mean <= maximum", ""});
    if (config.following.model == FollowingModel::krauss && drivers.idm != IdmPreset::sumo)
        problems.push_back(
            {config.where("drivers.idm"),
             fmt::format("{} sets the parameters of idm, but the model is krauss", core::name(drivers.idm)),
             "sumo with krauss", "choose the model idm, or leave this key out"});
    if (sum_of_weights(config.traffic_kinds) <= 0.0)
        problems.push_back({config.where("kinds.traffic"), "all weights are 0", "one above 0", ""});
    if (sum_of_weights(config.emergency_kinds) <= 0.0)
        problems.push_back({config.where("kinds.emergency"), "all weights are 0", "one above 0", ""});
}

}  // namespace

void check(const ScenarioConfig& config, Problems& problems) {
    require_text(config, "name", config.name, problems);
    if (!config.name.empty()) core::check_folder_name(config.where("name"), config.name, problems);
    require_text(config, "version", config.version, problems);
    check_network(config, problems);
    check_time(config, problems);
    check_flows(config, problems);
    check_emergency_trips(config, problems);
    check_density(config, problems);
    check_measured(config, problems);
    check_sites(config, problems);
    check_road(config, problems);
    check_drivers(config, problems);
    check_incidents(config, problems);
    check_calls(config, problems);
}

}  // namespace clearway::scenario::detail
