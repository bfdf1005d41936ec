#include "scenario_import/detail/synthetic_demand.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"
#include "scenario_import/detail/demand_level.hpp"
#include "scenario_import/detail/survey.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// No tested network could take more than this.
int most_cars(const Findings& findings) {
    constexpr double per_lane_km_hour = 70.0;
    constexpr double fewest = 20.0;
    constexpr double most = 3000.0;  // Routing and probing them takes seconds.
    return static_cast<int>(std::lround(
        std::clamp(per_lane_km_hour * findings.lane_km * demand_window_s / 3600.0, fewest, most)));
}

/// Time for a trip between places `distance_m` apart, with a detour of a half and half of the mean limit.
double longest_trip_s(const roads::Network& network, double distance_m) {
    double metres = 0.0;
    double seconds = 0.0;
    for (const roads::Lane& lane : network.lanes()) {
        if (!lane.allows_cars || network.edge(lane.edge).internal) continue;
        metres += lane.length_m;
        seconds += lane.length_m / lane.speed_limit_mps;
    }
    return 3.0 * distance_m * seconds / metres;
}

std::string describe(const scenario::ScenarioConfig& config, const DemandLevel& level, double lane_km) {
    const char* const places =
        config.trips.ends == scenario::TripEnds::reachable
            ? "from roads that enter the map, or places drawn by road length, to places they lead to"
            : "between places drawn by road length";
    const Load& load = level.load;
    const std::string speed =
        load.running > 0.0 && level.free_speed > 0.0
            ? fmt::format(
                  "mean speed {:.0f} % of that with only {} cars at the same signals, {:.0f} % halting",
                  100.0 * load.relative_speed / level.free_speed, level.fewest_cars,
                  100.0 * load.halting / load.running)
            : "speed unknown";
    return fmt::format(
        "synthetic: {} cars in {:.0f} s {}; after 12 to 15 minutes {:.{}f} on the road, {:.1f} per km of "
        "lane, {}, {:.0f} waiting to enter; all have arrived after {:.0f} minutes; carried {}; locks were "
        "not "
        "looked for, which clearway scenario check --lock-trials 6 does",
        level.cars, demand_window_s, places, load.running, load.running < 10.0 ? 1 : 0,
        load.running / std::max(0.001, lane_km), speed, load.waiting, std::ceil(load.end_s / 60.0),
        level.demands > 1 ? fmt::format("in {} demands", level.demands)
                          : std::string("with room to spare in the one demand that was tried"));
}

}  // namespace

void choose_trips(Import& import, scenario::ScenarioConfig& config, const roads::Network& network) {
    constexpr double most_of_the_network = 0.5;
    const double share = import.findings.connected_share;
    if (share <= most_of_the_network) {
        config.trips.ends = scenario::TripEnds::reachable;
        import.findings.changes.push_back(
            fmt::format("only {:.1f} % of the car edges reach each other, so trips go from any edge to one "
                        "that it leads to (trips.ends = \"reachable\")",
                        100.0 * share));
    }
    if (!scenario::trip_edges(network, config.trips).empty()) return;
    throw core::InputError(core::Problem{
        import.request.files.front().string(),
        fmt::format("has no road of {:g} m between two junctions, on which a trip could start or end",
                    config.trips.minimum_edge_m),
        "roads for cars that reach each other", "choose another or a larger extract"});
}

void add_synthetic_demand(Import& import, scenario::ScenarioConfig& config, const roads::Network& network) {
    const double diagonal = diagonal_m(network);
    config.time.warm_up_s = 300.0;
    config.time.window_s = demand_window_s;
    config.demand.emergency = 6;
    config.trips.minimum_length_m = std::floor(std::min(500.0, 0.25 * diagonal));
    config.trips.emergency_minimum_length_m = std::floor(std::min(1000.0, 0.4 * diagonal));
    // Most city trips are shorter, and longer ones take long to find.
    constexpr std::size_t large = 3000;
    if (import.findings.car_edges > large)
        config.trips.maximum_distance_m = std::floor(std::clamp(0.25 * diagonal, 3000.0, 6000.0));
    const double longest_m = config.trips.maximum_distance_m.value_or(diagonal);
    config.time.horizon_s =
        std::max(demand_horizon_s, std::ceil(demand_window_s + longest_trip_s(network, longest_m)));

    Findings& findings = import.findings;
    const DemandLevel level = find_level(import, config, most_cars(findings));
    set_cars(config, level.cars, import.request.automated_share);
    findings.vehicles_per_hour = level.cars * 3600.0 / demand_window_s;
    findings.vehicles = {{"car", level.cars}};
    findings.demand = describe(config, level, findings.lane_km);
}

}  // namespace clearway::scenario_import::detail
