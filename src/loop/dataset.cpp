#include "loop/dataset.hpp"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/files.hpp"
#include "loop/detail/plain_run.hpp"
#include "loop/detail/work_folder.hpp"
#include "loop/unit_run.hpp"
#include "prediction/features.hpp"
#include "samples/recorders.hpp"
#include "trace/listeners.hpp"

namespace clearway::loop {
namespace {

void record_published(const experiment::DatasetOrder& order, UnitRun& run, const graph::LinkRules& rules) {
    const prediction::FeatureSchema schema = order.feature_count == 2
                                                 ? prediction::as_published_position_schema()
                                                 : prediction::as_published_attributes_schema();
    samples::PairDatasetRecorder recorder(run.network(), rules, schema, order.pairs);
    run.record(detail::plain_traffic("dataset"), recorder);
    const samples::PairDataset& dataset = recorder.dataset();
    if (dataset.pair_count() == 0) {
        throw core::InputError({order.scenario,
                                "no two vehicles of linkable classes ever came near each other",
                                "at least one link", "Raise the density, or choose another seed"});
    }
    samples::write_pair_dataset(order.output, dataset);
    fmt::print("{}: {} vehicles, {} pairs at {:.2f} s\n", order.output.string(), dataset.vehicle_count(),
               dataset.pair_count(), recorder.time().value);
}

/// The failure as data sets name it.
std::string failure_name(const experiment::DatasetOrder& order, const std::string& failure) {
    return failure + (order.exits == "unknown" ? " exits unknown" : "");
}

/// One recorder for each failure, all watching one run.
void record_samples(const experiment::DatasetOrder& order, UnitRun& run, const graph::LinkRules& rules) {
    std::vector<std::unique_ptr<samples::SampleRecorder>> recorders;
    trace::Listeners all;
    for (const std::string& failure : order.failures) {
        recorders.push_back(samples::make_sample_recorder(
            order.kind, {.network = run.network(),
                         .rules = rules,
                         .origin = {.scenario = order.scenario,
                                    .failure = failure_name(order, failure),
                                    .features = {},
                                    .study_seed = order.study_seed,
                                    .replication = order.replication,
                                    .link_radius_m = rules.radius_m},
                         .sensor = detail::sensor_of(failure, order.exits, detail::random_of(order),
                                                     {.network = run.network(), .rules = rules}),
                         .interval = core::Seconds(order.interval_s)}));
        all.add(*recorders.back());
    }
    run.record(detail::plain_traffic("dataset"), all);
    for (std::size_t i = 0; i < recorders.size(); ++i) {
        const std::filesystem::path file =
            experiment::sample_file(order, order.failures[i], samples::sample_ending(order.kind));
        fmt::print("{}: {}\n", file.string(), recorders[i]->write(file));
    }
}

}  // namespace

core::ExitCode record_dataset(const std::filesystem::path& order_file) {
    const experiment::DatasetOrder order = experiment::read_dataset_order(order_file);
    core::make_folder(order.output);
    const detail::WorkFolder work(order.output /
                                  fmt::format("work-{}-{}", order.scenario, order.replication));
    UnitRun run(detail::unit_of(order), work.path(), work.path());
    const graph::LinkRules rules = detail::link_rules();
    if (order.kind == experiment::DatasetKind::published) {
        record_published(order, run, rules);
    } else {
        record_samples(order, run, rules);
    }
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
