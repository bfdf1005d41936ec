#include "experiment/dataset_job.hpp"

#include <fmt/format.h>

namespace clearway::experiment {

std::filesystem::path sample_file(const DatasetJob& job, const std::string& failure,
                                  std::string_view ending) {
    return job.output / fmt::format("{}-{}{}-{:04}{}", job.scenario, failure,
                                    job.exits == sensing::Exits::unknown ? "-exits-unknown" : "",
                                    job.replication, ending);
}

}  // namespace clearway::experiment
