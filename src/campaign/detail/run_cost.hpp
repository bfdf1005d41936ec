#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "experiment/condition.hpp"
#include "results/store.hpp"
#include "scenario/config.hpp"

namespace clearway::campaign {

/// What a run costs, shared warm-up excluded.
struct RunCost {
    std::optional<double> wall_s;  ///< Nothing when it cannot be estimated.
    double disk_bytes = 0.0;
    bool measured = false;  ///< From runs of this scenario on this disk; else rough.
};

/// What is said of it.
inline constexpr const char* rough_words =
    "rough: to a factor of three, more where traffic jams; clearway scenario check times a run";

/// `4:58 (m:s)`, `1:02:03 (h:m:s)`: a time that a forecast names.
std::string clock_words(double seconds);

/// The cost of a run before any was made, accurate to a factor of about three where traffic flows: 10 us per
/// vehicle and step for 120 s on the road plus 0.2 s (no time if measured demand cannot be read), and on the
/// disk 12 KiB plus 160 bytes per vehicle.
RunCost rough_cost(const scenario::ScenarioConfig& config, experiment::TrafficModel traffic_model);

/// Notes in a folder of run folders what a run of a scenario in traffic cost, so that forecasts of studies
/// beside it need not guess. The run itself need not stay: its seed would count as used.
void note_cost(const std::filesystem::path& runs, const std::string& hash, const RunCost& cost);

/// Costs of runs, estimated from those in a run folder and its neighbours.
class CostBook {
  public:
    /// `folder` need not exist. Neighbours are the run folders beside it.
    explicit CostBook(const std::filesystem::path& folder);

    /// Mean over the first ten runs of this scenario (by its hash in the manifest) with this traffic model.
    /// Without such runs, what `note_cost` noted; without that, `rough_cost`.
    RunCost of(const scenario::ScenarioConfig& config, const std::string& hash,
               experiment::TrafficModel traffic_model) const;

  private:
    std::vector<results::Store> stores_;
    core::Json noted_;
};

}  // namespace clearway::campaign
