#include "campaign/mean_times.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "campaign/printout.hpp"
#include "campaign/worker_jobs.hpp"
#include "core/counted.hpp"
#include "core/own_output.hpp"
#include "core/temporary_folder.hpp"
#include "experiment/dataset_job.hpp"
#include "samples/dataset_plan.hpp"
#include "samples/edge_times.hpp"
#include "scenario/mean_times.hpp"
#include "scenario/network.hpp"

namespace clearway::campaign {
namespace {

/// Slower traffic counts as this fast, m/s: somebody who parked on an edge says nothing of its time.
constexpr double least_mps = 0.1;

/// The sums of all runs.
samples::EdgeUses sum_of(const std::vector<experiment::DatasetJob>& jobs) {
    samples::EdgeUses sum;
    for (const experiment::DatasetJob& job : jobs) {
        for (const auto& [edge, use] : samples::read_edge_uses(samples::files_of(job).front())) {
            samples::EdgeUse& all = sum[edge];
            all.vehicles += use.vehicles;
            all.time_s += use.time_s;
            all.distance_m += use.distance_m;
        }
    }
    return sum;
}

std::vector<scenario::EdgeMean> means_of(const samples::EdgeUses& uses, const roads::Network& network) {
    std::vector<scenario::EdgeMean> means;
    for (const auto& [edge, use] : uses) {
        if (use.vehicles < least_vehicles_of_mean || use.time_s <= 0.0) continue;
        const double length_m = network.edge(network.find_edge(edge).value()).length_m;
        const double speed_mps = std::max(least_mps, use.distance_m / use.time_s);
        means.push_back({edge, use.vehicles, std::max(0.01, length_m / speed_mps)});
    }
    return means;
}

}  // namespace

core::ExitCode write_mean_times(scenario::ScenarioConfig config, const MeanTimesOrder& order) {
    if (std::filesystem::exists(order.file))
        throw core::InputError({"--out", fmt::format("{} is there already", order.file.string()),
                                "a new file", "Choose another name, or remove it"});
    config.incidents.clear();
    config.calls.clear();  // they may be to incidents, and EVs do not count
    config.network.mean_times.clear();
    const core::TemporaryFolder folder;
    experiment::DatasetJob shared;
    shared.output = folder.path();
    shared.dataset = experiment::DatasetKind::edge_times;
    shared.study_seed = order.study_seed;
    shared.failures = {"perfect"};
    const std::vector<experiment::DatasetJob> jobs =
        samples::dataset_jobs(shared, config.name, {.first = 0, .count = order.runs});
    scenario::store(config, jobs.front().scenario_file.parent_path());
    const scenario::BuiltNetwork built = scenario::build_network(config, jobs.front().network_folder);
    const WorkerResult result = record_jobs(jobs, order.jobs);
    if (result.exit_code != core::ExitCode::ok) return result.exit_code;

    const scenario::MeanTimes times{built.inputs_hash, order.study_seed, order.runs,
                                    means_of(sum_of(jobs), built.network)};
    core::write_new(order.file, scenario::mean_times_csv(times));
    const auto outside = std::ranges::count(built.network.edges(), false, &roads::Edge::internal);
    print({{{"scenario", config.name},
            {"file", order.file.string()},
            {"study_seed", order.study_seed},
            {"runs", order.runs},
            {"edges", outside},
            {"edges_with_times", times.edges.size()}},
           {},
           fmt::format(
               "{}: mean times of {} of {} edges, from {} with study seed {}\nTo use them, put the file "
               "beside scenario.toml and name it there:\n  [network]\n  mean_times = \"{}\"\nand set "
               "navigate.prior=mean_times\n",
               order.file.string(), times.edges.size(), outside, core::counted(order.runs, "run"),
               order.study_seed, order.file.filename().string())},
          order.printing);
    return core::ExitCode::ok;
}

}  // namespace clearway::campaign
