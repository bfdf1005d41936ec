#include "scenario_import/detail/synthetic_demand.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "scenario/prepare.hpp"
#include "scenario_import/detail/survey.hpp"
#include "scenario_import/detail/tool.hpp"

namespace clearway::scenario_import::detail {

namespace {

constexpr double window_s = 900.0;
// The last minutes of the demand, because a network that fills slowly jams late.
constexpr double probe_begin_s = window_s - 180.0;

/// How full a network is: means over the probe.
struct Level {
    double running = 0.0;
    double relative_speed = 0.0;  ///< Mean ratio of speed to limit.
    double halting = 0.0;
    double waiting = 0.0;
    double loaded = 0.0;
    double teleports = 0.0;  ///< In total, not a mean.

    bool jammed() const {
        if (running < 1.0) return false;
        return relative_speed < 0.45 || halting > 0.4 * running || waiting > 0.05 * loaded ||
               teleports > 0.01 * loaded;
    }
};

/// SUMO's summary gives no speed (-1) when no vehicle is on the road, so speeds are weighted by the number of
/// vehicles.
Level read_level(const std::filesystem::path& summary) {
    Level level;
    double rows = 0.0;
    for_each_element(summary, [&](Element&& step) {
        const auto value = [&](const char* name) { return number(step.text(name)).value_or(0.0); };
        level.teleports = value("teleports");
        level.loaded = value("loaded");
        if (value("time") < probe_begin_s) return;
        ++rows;
        level.running += value("running");
        level.relative_speed += value("running") * std::max(0.0, value("meanSpeedRelative"));
        level.halting += value("halting");
        level.waiting += value("waiting");
    });
    if (level.running > 0.0) level.relative_speed /= level.running;
    if (rows == 0.0) return level;
    for (double* mean : {&level.running, &level.halting, &level.waiting})
        *mean /= rows;
    return level;
}

std::string joined(const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> names;
    for (const std::filesystem::path& file : files)
        names.push_back(file.string());
    return fmt::format("{}", fmt::join(names, ","));
}

/// Arguments for `sumo` to run what was prepared, without its end and its outputs.
std::vector<std::string> arguments_of(const scenario::Prepared& prepared) {
    return {"--net-file",
            prepared.network_file.string(),
            "--route-files",
            joined(prepared.route_files),
            "--additional-files",
            joined(prepared.additional_files),
            "--xml-validation",
            "never",
            "--xml-validation.net",
            "never",
            "--xml-validation.routes",
            "never",
            "--no-step-log",
            "--duration-log.disable",
            "--route-steps",
            "0",
            "--collision.action",
            "warn"};
}

/// Tries shares of one demand, so that the routes are computed only once.
class Probe {
  public:
    Probe(Import& import, scenario::Prepared demand) : import_(import), demand_(std::move(demand)) {}

    /// Nothing when SUMO fails under this share of the demand.
    std::optional<Level> measure(double share) const {
        const std::filesystem::path summary = import_.work / "summary.xml";
        std::vector<std::string> arguments = arguments_of(demand_);
        for (const std::string& word :
             {std::string("--step-length"), std::string("1"), std::string("--scale"),
              fmt::format("{:.4f}", share), std::string("--end"), fmt::format("{}", window_s),
              std::string("--summary-output"), summary.string(), std::string("--summary-output.period"),
              std::string("10"), std::string("--no-warnings")})
            arguments.push_back(word);
        const Tool tool{"sumo", std::move(arguments), import_.work / "probe.log",
                        "finding the level of demand", "sumo"};
        if (!succeeds(tool, import_.on_progress)) return std::nullopt;
        return read_level(summary);
    }

  private:
    Import& import_;
    scenario::Prepared demand_;
};

void set_cars(scenario::ScenarioConfig& config, double cars, double automated_share) {
    const auto count = static_cast<int>(std::lround(cars));
    config.demand.automated = static_cast<int>(std::lround(cars * automated_share));
    config.demand.human = count - config.demand.automated;
}

/// No tested network could take more than this.
double most_cars(const Findings& findings) {
    constexpr double per_lane_km_hour = 70.0;
    constexpr double fewest = 20.0;
    constexpr double most = 3000.0;  // Routing and probing them takes seconds.
    return std::clamp(per_lane_km_hour * findings.lane_km * window_s / 3600.0, fewest, most);
}

struct FoundLevel {
    double cars = 0.0;
    Level level;
};

/// Goes down the ladder from `most` to the first number of cars that does not jam the network, or to its end.
FoundLevel find_level(const Probe& probe, double most) {
    constexpr double step = 1.5;
    constexpr int most_steps = 8;
    double share = 1.0;
    for (int row = 0; row < most_steps; ++row, share /= step) {
        const std::optional<Level> level = probe.measure(share);
        if (level && !level->jammed()) return {std::round(most * share), *level};
    }
    return {std::round(most * share), {}};
}

std::string describe(const scenario::ScenarioConfig& config, const Level& level, const Findings& findings) {
    const char* const places =
        config.trips.ends == scenario::TripEnds::reachable
            ? "from where roads enter, or places drawn by road length, to where they lead"
            : "between places drawn by road length";
    const std::string speed =
        level.running > 0.0 ? fmt::format("mean speed {:.0f} % of the limits, {:.0f} % halting",
                                          100.0 * level.relative_speed, 100.0 * level.halting / level.running)
                            : "no speed known";
    return fmt::format(
        "synthetic: {} cars in {:.0f} s {}; after 12 to 15 minutes {:.{}f} on the road, {:.1f} per km of "
        "lane, {}, {:.0f} waiting to enter",
        config.demand.human + config.demand.automated, window_s, places, level.running,
        level.running < 1.0 ? 1 : 0, level.running / std::max(0.001, findings.lane_km), speed, level.waiting);
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
    if (!trip_edges(network, config.trips).empty()) return;
    throw core::InputError(core::Problem{
        import.request.files.front().string(),
        fmt::format("has no road of {:g} m between two junctions, on which a trip could start or end",
                    config.trips.minimum_edge_m),
        "roads for cars that reach each other", "choose another or a larger extract"});
}

void add_synthetic_demand(Import& import, scenario::ScenarioConfig& config, const roads::Network& network) {
    const double diagonal = diagonal_m(network);
    config.time.warm_up_s = 300.0;
    config.time.window_s = window_s;
    config.time.horizon_s = 3600.0;
    config.demand.emergency = 6;
    config.trips.minimum_length_m = std::floor(std::min(500.0, 0.25 * diagonal));
    config.trips.emergency_minimum_length_m = std::floor(std::min(1000.0, 0.4 * diagonal));
    // Most city trips are shorter, and longer ones take long to find.
    constexpr std::size_t large = 3000;
    if (import.findings.car_edges > large)
        config.trips.maximum_distance_m = std::floor(std::clamp(0.25 * diagonal, 3000.0, 6000.0));

    const double most = most_cars(import.findings);
    const double share = import.request.automated_share;
    set_cars(config, most, share);
    const Probe probe(import, try_out(import, config));
    const auto [cars, level] = find_level(probe, most);
    set_cars(config, cars, share);
    Findings& findings = import.findings;
    findings.vehicles_per_hour = cars * 3600.0 / window_s;
    findings.vehicles = {{"car", config.demand.human + config.demand.automated}};
    findings.demand = describe(config, level, findings);
}

scenario::Prepared try_out(Import& import, scenario::ScenarioConfig& config) {
    double& least_m = config.measured ? config.measured->emergency_minimum_length_m
                                      : config.trips.emergency_minimum_length_m;
    const scenario::BuiltNetwork network = scenario::build_network(config, import.work / "network");
    std::optional<scenario::Prepared> prepared;
    constexpr int most_tries = 6;
    for (int row = 0; !prepared; ++row) {
        try {
            prepared = scenario::prepare(config, network, core::StudySeed{1}, core::Replication{0},
                                         import.work / "demand");
        } catch (const core::InputError& error) {
            if (row == most_tries) throw;
            least_m = std::floor(least_m / 2.0);
            config.trips.minimum_length_m = std::min(config.trips.minimum_length_m, least_m);
        }
    }
    std::vector<std::string> arguments = arguments_of(*prepared);
    arguments.insert(arguments.end(), {"--end", "1"});
    const Tool tool{"sumo", std::move(arguments), import.work / "sumo.log", "loading it in SUMO", "sumo"};
    if (!succeeds(tool, import.on_progress))
        throw core::InputError(
            core::Problem{import.request.files.front().string(),
                          fmt::format("SUMO does not load the imported scenario:\n{}", complaint(tool.log)),
                          "files that SUMO 1.15 loads", "correct what it names"});
    return *std::move(prepared);
}

}  // namespace clearway::scenario_import::detail
