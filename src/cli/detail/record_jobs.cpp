#include "cli/detail/record_jobs.hpp"

#include <fmt/format.h>

#include "samples/dataset_plan.hpp"

namespace clearway::cli {

WorkerResult record_jobs(const std::vector<experiment::DatasetJob>& jobs, unsigned processes) {
    std::vector<WorkerJob> work;
    for (const experiment::DatasetJob& job : jobs) {
        const std::filesystem::path file = samples::job_file(job);
        work.push_back({.label = fmt::format("{} replication {}", job.scenario, job.replication),
                        .job = job,
                        .file = file,
                        .log = std::filesystem::path(file).replace_extension(".log"),
                        .work = job.output / fmt::format("work-{}-{}", job.scenario, job.replication)});
    }
    return work_on(work, processes, "recordings");
}

}  // namespace clearway::cli
