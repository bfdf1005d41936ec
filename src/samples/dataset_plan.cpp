#include "samples/dataset_plan.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "experiment/job.hpp"
#include "samples/dataset_files.hpp"
#include "samples/recorders.hpp"

namespace clearway::samples {
namespace {

bool holds(const std::filesystem::path& file, const std::string& text) {
    return std::filesystem::exists(file) && core::read_file(file) == text;
}

}  // namespace

std::vector<experiment::DatasetJob> dataset_jobs(const experiment::DatasetJob& shared,
                                                 const std::string& scenario, const DatasetSeeds& seeds) {
    experiment::DatasetJob job = shared;
    job.scenario = scenario;
    const std::filesystem::path origin = job.output / "origin" / scenario;
    job.scenario_file = origin / "scenario.toml";
    job.network_folder = origin / "network";
    std::vector<experiment::DatasetJob> jobs;
    for (std::uint32_t i = 0; i < seeds.count; ++i) {
        job.replication = seeds.first + i;
        jobs.push_back(job);
    }
    return jobs;
}

std::filesystem::path job_file(const experiment::DatasetJob& job) {
    return job.scenario_file.parent_path() / "jobs" /
           fmt::format("{:04}{}.json", job.replication, experiment::under_policies(job));
}

std::filesystem::path work_folder(const experiment::DatasetJob& job) {
    return job.scenario_file.parent_path() / "work" / job_file(job).stem();
}

std::vector<std::filesystem::path> files_of(const experiment::DatasetJob& job) {
    if (job.dataset == experiment::DatasetKind::published) {
        return {job.output / edge_list_file, job.output / vehicle_features_file, job.output / target_file};
    }
    std::vector<std::filesystem::path> files;
    for (const std::string& failure : job.failures)
        files.push_back(experiment::sample_file(job, failure, sample_ending(job.dataset)));
    return files;
}

void check_folder(const std::vector<experiment::DatasetJob>& jobs, const std::string& scenario) {
    const char* const cure = "Record into another --out, or remove what is there";
    const std::filesystem::path& scenario_file = jobs.front().scenario_file;
    if (std::filesystem::exists(scenario_file) && !holds(scenario_file, scenario)) {
        throw core::InputError(
            {scenario_file.string(),
             fmt::format("another configuration of {} was recorded here", jobs.front().scenario),
             "one configuration per scenario of a data set", cure});
    }
    std::vector<std::string> taken;
    for (const experiment::DatasetJob& job : jobs) {
        if (holds(job_file(job), experiment::to_json(job))) continue;
        for (const std::filesystem::path& file : files_of(job)) {
            if (std::filesystem::exists(file)) taken.push_back(file.string());
        }
    }
    if (taken.empty()) return;
    const std::string more = taken.size() == 1 ? "" : fmt::format(", and {} more", taken.size() - 1);
    throw core::InputError({taken.front(), "already exists, from another recording" + more, "", cure});
}

}  // namespace clearway::samples
