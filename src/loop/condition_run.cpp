#include "loop/condition_run.hpp"

#include <utility>

#include <sys/resource.h>

namespace clearway::loop {
namespace {

double seconds_of(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

void start_condition(ClosedLoop& loop, metrics::Recorder& recorder,
                     const experiment::ConditionSpec& condition, Stage stage) {
    recorder.watch(std::move(stage.layout), loop.standing_reasons());
    recorder.configure(
        metrics::RecorderConfig::of_latency(core::Seconds(pipeline::observed_failure(condition).latency_s)));
    loop.begin(condition, stage.context);
    loop.tell(stage.listener);
}

metrics::LeaseTotals run_condition(ClosedLoop& loop, metrics::Recorder& recorder,
                                   const experiment::ConditionSpec& condition, Stage stage) {
    const core::Seconds horizon = stage.horizon;
    start_condition(loop, recorder, condition, std::move(stage));
    loop.run(horizon);
    return loop.finish();
}

experiment::Provenance own_provenance() {
    experiment::Provenance provenance;
    provenance.clearway_version = CLEARWAY_VERSION;
    provenance.sumo_version = sumo::version();
    return provenance;
}

results::RunTiming timing_of(const LoopTiming& spent, std::chrono::steady_clock::time_point started) {
    results::RunTiming timing;
    timing.simulator_s = spent.simulator_s;
    timing.coupling_s = spent.phases.sum_s();
    timing.phases = spent.phases;
    timing.steps = spent.steps;
    timing.vehicle_steps = spent.vehicle_steps;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    timing.peak_kib = usage.ru_maxrss;
    timing.processor_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    timing.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return timing;
}

results::RunRecord record_of(const experiment::RunKey& key, const experiment::ConditionSpec& condition,
                             experiment::Provenance provenance, metrics::RunSummary summary) {
    provenance.trace_hash = summary.trace_hash;
    return {.key = key,
            .condition = condition,
            .provenance = std::move(provenance),
            .metrics = summary.metrics,
            .vehicles = std::move(summary.vehicles),
            .traffic = std::move(summary.traffic),
            .leases = std::move(summary.leases),
            .signal_events = std::move(summary.signal_events)};
}

}  // namespace clearway::loop
