#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "experiment/condition.hpp"
#include "results/store.hpp"
#include "scenario/config.hpp"

namespace clearway::cli {

/// What a run costs, shared warm-up excluded.
struct RunCost {
    std::optional<double> wall_s;  ///< Nothing where nobody can tell.
    double disk_bytes = 0.0;
    bool measured = false;  ///< From runs of this scenario on this disk; else rough.
};

/// Costs of runs, from those that are in a run folder and in its neighbours.
class CostBook {
  public:
    /// `folder` need not exist. Neighbours are the run folders beside it.
    explicit CostBook(const std::filesystem::path& folder);

    /// Mean over the first ten runs of this scenario (by its hash in the manifest) with this traffic model.
    /// Without any: 10 us a vehicle and step over 120 s on the road and 0.2 s for the rest, nothing where the
    /// demand is measured; 12 KiB and 160 bytes a vehicle on the disk. Right within a factor of about three.
    RunCost of(const scenario::ScenarioConfig& config, const std::string& hash,
               experiment::TrafficModel traffic_model) const;

  private:
    std::vector<results::Store> stores_;
};

}  // namespace clearway::cli
