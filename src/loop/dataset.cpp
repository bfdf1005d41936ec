#include "loop/dataset.hpp"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/files.hpp"
#include "core/temporary_folder.hpp"
#include "loop/unit_run.hpp"
#include "samples/recorders.hpp"
#include "trace/listeners.hpp"

namespace clearway::loop {
namespace {

/// Car-following alone: data sets show traffic that no policy has touched.
experiment::ConditionSpec plain_traffic() {
    experiment::ConditionSpec condition;
    condition.name = "dataset";
    return condition;
}

void record_published(const experiment::DatasetJob& job, UnitRun& run, const graph::LinkRules& rules) {
    const prediction::FeatureSchema schema = job.feature_count == 2
                                                 ? prediction::as_published_position_schema()
                                                 : prediction::as_published_attributes_schema();
    samples::PairDatasetRecorder recorder(run.network(), rules, schema, job.pairs);
    run.record(plain_traffic(), recorder);
    const samples::PairDataset& dataset = recorder.dataset();
    if (dataset.pair_count() == 0) {
        throw core::InputError({job.scenario, "no two vehicles of linkable classes ever came near each other",
                                "at least one link", "Raise the density, or choose another seed"});
    }
    samples::write_pair_dataset(job.output, dataset);
    fmt::print("{}: {} vehicles, {} pairs at {:.2f} s\n", job.output.string(), dataset.vehicle_count(),
               dataset.pair_count(), recorder.time().value);
}

bool exits_unknown(const experiment::DatasetJob& job) {
    return job.exits == "unknown";
}

/// The failure as data sets name it.
std::string failure_name(const experiment::DatasetJob& job, const std::string& failure) {
    return failure + (exits_unknown(job) ? " exits unknown" : "");
}

std::unique_ptr<sensing::SensorModel> sensor_for(const experiment::DatasetJob& job,
                                                 const std::string& failure, const UnitRun& run,
                                                 const graph::LinkRules& rules) {
    sensing::FailureConfig config = sensing::failure_from(failure);
    if (exits_unknown(job)) config.exits = sensing::Exits::unknown;
    const core::KeyedRandom random(core::StudySeed{job.study_seed}, core::Replication{job.replication});
    return sensing::make_sensor(config, random, {.network = run.network(), .rules = rules});
}

/// One recorder of a kind for each failure, all watching one run.
template <class Recorder>
void record_samples(const experiment::DatasetJob& job, UnitRun& run, const graph::LinkRules& rules,
                    const prediction::FeatureSchema& features) {
    std::vector<std::unique_ptr<Recorder>> recorders;
    trace::Listeners all;
    for (const std::string& failure : job.failures) {
        const samples::GraphSampleOrigin origin{.scenario = job.scenario,
                                                .failure = failure_name(job, failure),
                                                .features = features,
                                                .study_seed = job.study_seed,
                                                .replication = job.replication,
                                                .link_radius_m = rules.radius_m};
        recorders.push_back(std::make_unique<Recorder>(run.network(), rules, origin,
                                                       sensor_for(job, failure, run, rules),
                                                       core::Seconds(job.interval_s)));
        all.add(*recorders.back());
    }
    run.record(plain_traffic(), all);
    for (std::size_t i = 0; i < recorders.size(); ++i) {
        const std::filesystem::path file =
            experiment::sample_file(job, job.failures[i], samples::graph_sample_extension);
        recorders[i]->writer().write(file);
        fmt::print("{}: {} samples\n", file.string(), recorders[i]->writer().sample_count());
    }
}

void record_pair_samples(const experiment::DatasetJob& job, UnitRun& run, const graph::LinkRules& rules) {
    std::vector<std::unique_ptr<samples::PairSampleRecorder>> recorders;
    trace::Listeners all;
    for (const std::string& failure : job.failures) {
        const samples::PairSampleOrigin origin{.scenario = job.scenario,
                                               .failure = failure_name(job, failure),
                                               .study_seed = job.study_seed,
                                               .replication = job.replication,
                                               .link_radius_m = rules.radius_m};
        recorders.push_back(std::make_unique<samples::PairSampleRecorder>(
            run.network(), rules, origin, sensor_for(job, failure, run, rules),
            core::Seconds(job.interval_s)));
        all.add(*recorders.back());
    }
    run.record(plain_traffic(), all);
    for (std::size_t i = 0; i < recorders.size(); ++i) {
        const std::filesystem::path file =
            experiment::sample_file(job, job.failures[i], samples::pair_sample_ending);
        samples::write_pair_samples(file, recorders[i]->samples());
        fmt::print("{}: {} pairs\n", file.string(), recorders[i]->samples().linked.size());
    }
}

}  // namespace

core::ExitCode record_dataset(const experiment::DatasetJob& job) {
    core::make_folder(job.output);
    const core::TemporaryFolder work(job.output / fmt::format("work-{}-{}", job.scenario, job.replication));
    UnitRun run(job, work.path());
    graph::LinkRules rules;
    rules.radius_m = LoopConfig{}.link_radius_m;
    switch (job.dataset) {
        case experiment::DatasetKind::published:
            record_published(job, run, rules);
            break;
        case experiment::DatasetKind::samples:
            record_samples<samples::SampleRecorder>(job, run, rules, prediction::corrected_schema());
            break;
        case experiment::DatasetKind::repair:
            record_samples<samples::RepairSampleRecorder>(job, run, rules, prediction::repair_schema());
            break;
        case experiment::DatasetKind::pair_samples:
            record_pair_samples(job, run, rules);
            break;
    }
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
