#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "experiment/attach_job.hpp"
#include "experiment/dataset_job.hpp"
#include "experiment/link_job.hpp"
#include "experiment/run_job.hpp"

namespace clearway::experiment {

/// What one worker process does: `clearway-run FILE`.
using Job = std::variant<RunJob, DatasetJob, LinkJob, AttachJob>;

/// The job as JSON; the key `kind` (`run`, `dataset`, `links`, `attach`) names the alternative.
std::string to_json(const Job& job);

/// Throws core::InputError with every problem: a key that is missing, unknown or of the wrong type, a number
/// out of range.
Job read_job(const std::filesystem::path& file);

}  // namespace clearway::experiment
