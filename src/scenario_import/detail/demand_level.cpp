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
/// Demands of other replications that a level must bear, too.
constexpr std::uint32_t more_demands = 2;

/// Runs shares of a demand.
class Probe {
  public:
    explicit Probe(Import& import) : import_(import) {}

    LoadFault try_share(const scenario::Prepared& demand, double share) {
        const std::filesystem::path summary = import_.work / "summary.xml";
        std::filesystem::remove(summary);
        std::vector<std::string> arguments = sumo_arguments(demand);
        for (const std::string& word :
             {std::string("--step-length"), std::string("1"), std::string("--scale"),
              fmt::format("{:.4f}", share), std::string("--end"), fmt::format("{}", demand_horizon_s),
              std::string("--summary-output"), summary.string(), std::string("--summary-output.period"),
              std::string("10"), std::string("--no-warnings")})
            arguments.push_back(word);
        LoadWatch watch(summary, free_speed_);
        const Tool tool{"sumo",
                        std::move(arguments),
                        import_.work / "probe.log",
                        "finding the level of demand",
                        "sumo",
                        [&] { return watch.is_decided(); }};
        const bool ran = succeeds(tool, import_.on_progress);
        load_ = watch.load();
        if (!ran) return LoadFault::fails;
        const LoadFault fault = watch.fault();
        load_ = watch.load();
        return fault;
    }
    /// The speed of the last run is that of free flow from now on.
    void take_as_free_flow() { free_speed_ = load_.speed_of_all_time; }
    double free_speed() const { return free_speed_; }
    const Load& load() const { return load_; }

  private:
    Import& import_;
    double free_speed_ = 0.0;
    Load load_;
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

std::string words_of(LoadFault fault, const Import& import) {
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
            return fmt::format("some have not arrived after {:.0f} s", demand_horizon_s);
        case LoadFault::none:
            break;
    }
    return "";
}

[[noreturn]] void refuse_every_level(const Import& import, LoadFault fault, int cars) {
    throw core::InputError(core::Problem{
        import.request.files.front().string(),
        fmt::format("takes no level of demand: of {} cars in {:.0f} s, {}", cars, demand_window_s,
                    words_of(fault, import)),
        "a network that empties under some traffic",
        fault == LoadFault::fails ? "correct what SUMO names, or import another part of the map"
                                  : "look for roads that block each other where cars stand still: open the "
                                    "network in sumo-gui; import "
                                    "another part of the map, or the network with route files of your own"});
}

/// Whether the network also bears the demands of other replications with as many cars.
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
    const Tried tried = try_out(import, config);
    Probe probe(import);
    LoadFault fault = probe.try_share(tried.demand, share_of(lowest_rung));
    if (fault != LoadFault::none) refuse_every_level(import, fault, cars_on(lowest_rung, most));
    probe.take_as_free_flow();
    Load borne = probe.load();
    int best = lowest_rung;
    for (int too_high = -1; best - too_high > 1;) {
        const int middle = (best + too_high) / 2;
        if (probe.try_share(tried.demand, share_of(middle)) == LoadFault::none) {
            best = middle;
            borne = probe.load();
        } else {
            too_high = middle;
        }
    }
    const auto fault_of_best = [&] {
        set_cars(config, cars_on(best, most), import.request.automated_share);
        return fault_of_more(tried.network, config, import.work / "more", probe);
    };
    while ((fault = fault_of_best()) != LoadFault::none) {
        if (++best > lowest_rung) refuse_every_level(import, fault, cars_on(lowest_rung, most));
        probe.try_share(tried.demand, share_of(best));
        borne = probe.load();
    }
    return {cars_on(best, most), borne, probe.free_speed(), cars_on(lowest_rung, most)};
}

}  // namespace clearway::scenario_import::detail
