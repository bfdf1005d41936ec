#pragma once

#include <filesystem>

#include "experiment/run_job.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

/// The job that makes a stored run again, from the scenario and network of its run folder, into the run
/// folder `output`. The run is one of the manifest.
experiment::RunJob stored_job(const results::Store& store, const experiment::RunKey& key,
                              const std::filesystem::path& output);

}  // namespace clearway::campaign
