#include "experiment/dataset_job.hpp"

#include <fmt/format.h>

namespace clearway::experiment {

std::string joined_policies(const DatasetJob& job) {
    return fmt::format("{}", fmt::join(job.policies, "+"));
}

std::filesystem::path sample_file(const DatasetJob& job, const std::string& failure,
                                  std::string_view ending) {
    const std::string under = job.policies.empty() ? "" : "-under-" + joined_policies(job);
    return job.output / fmt::format("{}-{}{}{}-{:04}{}", job.scenario, failure,
                                    job.exits == sensing::Exits::unknown ? "-exits-unknown" : "", under,
                                    job.replication, ending);
}

}  // namespace clearway::experiment
