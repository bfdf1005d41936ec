#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/files.hpp"
#include "core/temporary_folder.hpp"
#include "loop/detail/plain_run.hpp"
#include "loop/jobs.hpp"
#include "loop/unit_run.hpp"
#include "prediction/comparison/features.hpp"
#include "samples/dataset_plan.hpp"
#include "samples/edge_times.hpp"
#include "samples/recorders.hpp"
#include "trace/step_listener.hpp"

namespace clearway::loop {
namespace {

void record_published(const experiment::DatasetJob& job, UnitRun& run, const graph::LinkRules& rules) {
    const prediction::FeatureSchema schema = job.feature_count == 2
                                                 ? prediction::as_published_position_schema()
                                                 : prediction::as_published_attributes_schema();
    samples::PairDatasetRecorder recorder(run.network(), rules, schema, job.pairs);
    run.record(detail::plain_traffic("dataset"), recorder);
    const samples::PairDataset& dataset = recorder.dataset();
    if (dataset.pair_count() == 0) {
        throw core::InputError({job.scenario,
                                "no two vehicles of classes that can be linked ever came near each other",
                                "at least one link", "Raise the density, or choose another seed"});
    }
    samples::write_pair_dataset(job.output, dataset);
    fmt::print("{}: {}, {} at {:.2f} s\n", job.output.string(),
               core::counted(dataset.vehicle_count(), "vehicle"), core::counted(dataset.pair_count(), "pair"),
               recorder.time().value);
}

/// Name of the failure in data sets.
std::string failure_name(const experiment::DatasetJob& job, const std::string& failure) {
    return failure + (job.exits == failures::Exits::unknown ? " exits unknown" : "");
}

/// The policies act on the truth, whatever the sensors of the samples miss.
experiment::ConditionSpec condition_of(const experiment::DatasetJob& job) {
    experiment::ConditionSpec condition = detail::plain_traffic("dataset");
    condition.policies = job.policies;
    condition.settings = job.settings;
    return condition;
}

/// How the traffic differs from the usual one: see samples::SampleOrigin.
std::string traffic_text(const experiment::DatasetJob& job, const scenario::Following& following) {
    std::vector<std::string> parts;
    if (!job.policies.empty()) parts.push_back("under " + experiment::joined_policies(job));
    for (const auto& [name, value] : job.settings)
        parts.push_back(fmt::format("{}={}", name, value));
    if (following.model != scenario::FollowingModel::idm) parts.emplace_back(core::name(following.model));
    if (following.driver_spread > 0.0)
        parts.push_back(fmt::format("driver spread {}", following.driver_spread));
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// One recorder per failure, all watching the same run.
void record_samples(const experiment::DatasetJob& job, UnitRun& run, const graph::LinkRules& rules) {
    std::vector<std::unique_ptr<samples::SampleRecorder>> recorders;
    trace::Listeners all;
    for (const std::string& failure : job.failures) {
        recorders.push_back(samples::make_sample_recorder(
            job.dataset, {.network = run.network(),
                          .rules = rules,
                          .origin = {.scenario = job.scenario,
                                     .failure = failure_name(job, failure),
                                     .features = {},
                                     .study_seed = job.study_seed,
                                     .replication = job.replication,
                                     .link_radius_m = rules.radius_m,
                                     .traffic = traffic_text(job, run.scenario().following)},
                          .sensor = detail::sensor_of(failure, job.exits, detail::random_of(job),
                                                      {.network = run.network(), .rules = rules}),
                          .interval = core::Seconds(job.interval_s)}));
        all.add(*recorders.back());
    }
    run.record(condition_of(job), all);
    for (std::size_t i = 0; i < recorders.size(); ++i) {
        const std::filesystem::path file =
            experiment::sample_file(job, job.failures[i], samples::sample_ending(job.dataset));
        fmt::print("{}: {}\n", file.string(), recorders[i]->write(file));
    }
}

void record_edge_times(const experiment::DatasetJob& job, UnitRun& run) {
    samples::EdgeUseRecorder recorder(run.network());
    run.record(detail::plain_traffic("dataset"), recorder);
    samples::write_edge_uses(recorder.uses(), samples::files_of(job).front());
}

}  // namespace

core::ExitCode record_dataset(const experiment::DatasetJob& job) {
    core::make_folder(job.output);
    const core::TemporaryFolder work(samples::work_folder(job));
    UnitRun run(job, work.path());
    const graph::LinkRules rules = job.rules();
    if (job.dataset == experiment::DatasetKind::published) {
        record_published(job, run, rules);
    } else if (job.dataset == experiment::DatasetKind::edge_times) {
        record_edge_times(job, run);
    } else {
        record_samples(job, run, rules);
    }
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
