#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "experiment/condition.hpp"
#include "results/store.hpp"
#include "scenario/config.hpp"

namespace clearway::campaign {

/// What an estimate rests on, the weakest first.
enum class CostBasis : std::uint8_t {
    rough,       ///< Vehicles and steps.
    same_roads,  ///< A run on the same roads with other traffic, incidents or steps.
    measured,    ///< Runs of this scenario on this disk.
};

/// What a run costs, shared warm-up excluded.
struct RunCost {
    std::optional<double> wall_s;  ///< Nothing when it cannot be estimated.
    double disk_bytes = 0.0;
    CostBasis basis = CostBasis::rough;
};

/// What is said of it, in brackets behind a time.
const char* words(CostBasis basis);

/// `4:58 (m:s)`, `1:02:03 (h:m:s)`: a time that a forecast names.
std::string clock_words(double seconds);

/// The cost of a run before any was made, accurate to a factor of about three where traffic flows: 10 us per
/// vehicle and step for 120 s on the road plus 0.2 s (no time if measured demand cannot be read), and on the
/// disk 12 KiB plus 160 bytes per vehicle.
RunCost rough_cost(const scenario::ScenarioConfig& config, experiment::TrafficModel traffic_model);

/// Notes in a folder of run folders what a run of a scenario in traffic cost, so that forecasts of studies
/// beside it, and of others on the same roads, need not guess. The run itself need not stay: its seed would
/// count as used.
void note_cost(const std::filesystem::path& runs, const scenario::ScenarioConfig& config,
               const std::string& hash, const RunCost& cost);

/// Notes in a run folder how long processes took for all its complete runs. That is more than the runs name,
/// because loading, warm-up and writing are no run's own.
void note_pace(const results::Store& store, double processes_s);

/// Costs of runs, estimated from those in a run folder and its neighbours.
class CostBook {
  public:
    /// `folder` need not exist. Neighbours are the run folders beside it.
    explicit CostBook(const std::filesystem::path& folder);

    /// Mean over the first ten runs of this scenario (by its hash in the manifest) with this traffic model,
    /// at the pace noted in their folder.
    /// Without such runs, what `note_cost` noted; without that, what it noted of the same network file, in
    /// proportion to `rough_cost`; without that, `rough_cost`.
    RunCost of(const scenario::ScenarioConfig& config, const std::string& hash,
               experiment::TrafficModel traffic_model) const;

  private:
    std::vector<results::Store> stores_;
    core::Json noted_;
};

}  // namespace clearway::campaign
