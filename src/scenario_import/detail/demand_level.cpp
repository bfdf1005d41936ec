#include "scenario_import/detail/demand_level.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.hpp"
#include "scenario_import/detail/sumo_trial.hpp"
#include "scenario_import/detail/tool.hpp"

namespace clearway::scenario_import::detail {

namespace {

constexpr double ladder_step = 1.5;
constexpr int most_rungs = 9;
/// Cars of a demand that is hardly one any more.
constexpr double fewest_cars = 4.0;
/// Demands of other replications that the network must also carry at a level.
constexpr std::uint32_t more_demands = 2;

/// Cars a kilometre of lane and hour from which the search goes up or down.
constexpr double usual_density = 20.0;

/// Runs shares of a demand.
class Probe {
  public:
    Probe(Import& import, double horizon_s) : import_(import), horizon_s_(horizon_s) {}

    LoadFault try_share(const scenario::Prepared& demand, double share) {
        const std::filesystem::path summary = import_.work / "summary.xml";
        std::filesystem::remove(summary);
        std::vector<std::string> arguments = sumo_arguments(demand);
        for (const std::string& word :
             {std::string("--step-length"), std::string("1"), std::string("--scale"),
              fmt::format("{:.4f}", share), std::string("--end"), fmt::format("{}", horizon_s_),
              std::string("--summary-output"), summary.string(), std::string("--summary-output.period"),
              std::string("10"), std::string("--no-warnings")})
            arguments.push_back(word);
        LoadWatch watch(summary, {(demand.human + demand.automated) * share, free_speed_});
        const Tool tool{"sumo",
                        std::move(arguments),
                        import_.work / "probe.log",
                        fmt::format("finding the level of demand, try {}, {:.0f} cars", ++tries_,
                                    (demand.human + demand.automated) * share),
                        "sumo",
                        [&] { return watch.is_decided(); }};
        const bool ran = succeeds(tool, import_.on_progress);
        const LoadFault fault = ran ? watch.fault() : LoadFault::fails;
        load_ = watch.load();
        has_room_ = fault == LoadFault::none && watch.has_room();
        return fault;
    }
    /// The speed of the last run is that of free flow from now on.
    void take_as_free_flow() { free_speed_ = load_.speed_of_all_time; }
    double free_speed() const { return free_speed_; }
    const Load& load() const { return load_; }
    /// Of the last run.
    bool has_room() const { return has_room_; }

  private:
    Import& import_;
    double horizon_s_;
    int tries_ = 0;
    double free_speed_ = 0.0;
    Load load_;
    bool has_room_ = false;
};

double share_of(int rung) {
    return std::pow(ladder_step, -rung);
}

int cars_on(int rung, int most) {
    return static_cast<int>(std::lround(most * share_of(rung)));
}

int lowest_rung_of(int most) {
    const double rungs = std::log(most / fewest_cars) / std::log(ladder_step);
    return std::clamp(static_cast<int>(rungs), 0, most_rungs);
}

/// Where the search begins, above the lowest rung.
int first_rung(double lane_km, int most, int lowest_rung) {
    const double hours = demand_window_s / 3600.0;
    const double times_too_many = most / (usual_density * std::max(0.001, lane_km) * hours);
    const double rungs = std::log(std::max(1.0, times_too_many)) / std::log(ladder_step);
    return std::clamp(static_cast<int>(std::lround(rungs)), 0, std::max(0, lowest_rung - 1));
}

/// A rung that the network can carry.
struct Carried {
    int rung = 0;
    Load load;
    bool has_room = false;
};

std::string words_of(LoadFault fault, const Import& import, double horizon_s) {
    switch (fault) {
        case LoadFault::fails:
            return fmt::format("SUMO fails:\n{}", complaint(import.work / "probe.log"));
        case LoadFault::slow:
            return "they drive at less than half of their free speed";
        case LoadFault::queues:
            return "more than 5 % of them wait to enter";
        case LoadFault::teleports:
            return "more than 1 % of them stand for 300 s, and SUMO teleports them";
        case LoadFault::stays:
            return fmt::format("some have not arrived after {:.0f} s", horizon_s);
        case LoadFault::none:
            break;
    }
    return "";
}

[[noreturn]] void refuse_every_level(const Import& import, LoadFault fault, int cars, double horizon_s) {
    throw core::InputError(core::Problem{
        import.request.files.front().string(),
        fmt::format("cannot carry any level of demand: of {} cars in {:.0f} s, {}", cars, demand_window_s,
                    words_of(fault, import, horizon_s)),
        "a network that empties at some level of demand",
        fault == LoadFault::fails
            ? "correct what SUMO names, or import another part of the map"
            : "open the network in sumo-gui and look for roads that block each other, where cars stand "
              "still; or import another part of the map, or the network with your own route files"});
}

/// Whether the network also carries the demands of other replications with as many cars.
LoadFault fault_of_more(const scenario::BuiltNetwork& network, const scenario::ScenarioConfig& config,
                        const std::filesystem::path& folder, Probe& probe) {
    for (std::uint32_t row = 1; row <= more_demands; ++row) {
        const scenario::Prepared demand =
            scenario::prepare(config, network, core::StudySeed{1}, core::Replication{row}, folder);
        if (const LoadFault fault = probe.try_share(demand, 1.0); fault != LoadFault::none) return fault;
    }
    return LoadFault::none;
}

}  // namespace

void set_cars(scenario::ScenarioConfig& config, int cars, double automated_share) {
    config.demand.automated = static_cast<int>(std::lround(cars * automated_share));
    config.demand.human = cars - config.demand.automated;
}

DemandLevel find_level(Import& import, scenario::ScenarioConfig& config, int most) {
    set_cars(config, most, import.request.automated_share);
    const int lowest_rung = lowest_rung_of(most);
    const Tried tried = make_demand(import, config);
    Probe probe(import, config.time.horizon_s);
    LoadFault fault = probe.try_share(tried.demand, share_of(lowest_rung));
    if (fault == LoadFault::fails) require_load(import, tried.demand);
    if (fault != LoadFault::none)
        refuse_every_level(import, fault, cars_on(lowest_rung, most), config.time.horizon_s);
    probe.take_as_free_flow();
    Carried best{lowest_rung, probe.load(), probe.has_room()};
    for (int too_high = -1, rung = first_rung(import.findings.lane_km, most, lowest_rung);
         best.rung - too_high > 1; rung = (best.rung + too_high) / 2) {
        if (probe.try_share(tried.demand, share_of(rung)) == LoadFault::none) {
            best = {rung, probe.load(), probe.has_room()};
        } else {
            too_high = rung;
        }
    }
    // Where more cars were too many, other demands of as many may jam however smoothly the first one drives.
    const auto is_sure = [&] { return best.rung == 0 && best.has_room; };
    const auto fault_of_best = [&] {
        set_cars(config, cars_on(best.rung, most), import.request.automated_share);
        return is_sure() ? LoadFault::none
                         : fault_of_more(tried.network, config, import.work / "more", probe);
    };
    while ((fault = fault_of_best()) != LoadFault::none) {
        if (++best.rung > lowest_rung)
            refuse_every_level(import, fault, cars_on(lowest_rung, most), config.time.horizon_s);
        probe.try_share(tried.demand, share_of(best.rung));
        best.load = probe.load();
    }
    return {cars_on(best.rung, most), best.load, probe.free_speed(), cars_on(lowest_rung, most),
            is_sure() ? 1 : 1 + static_cast<int>(more_demands)};
}

}  // namespace clearway::scenario_import::detail
