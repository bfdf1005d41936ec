#include "loop/unit_run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include <sys/resource.h>

#include "core/files.hpp"
#include "loop/road_layout.hpp"
#include "scenario/sumo_files.hpp"
#include "sensing/failure_config.hpp"
#include "trace/listeners.hpp"
#include "trace/recording.hpp"

namespace clearway::loop {
namespace {

sumo::SessionConfig session_config(const experiment::UnitSpec& unit, const scenario::Prepared& prepared,
                                   const roads::Network& network, const std::filesystem::path& folder) {
    sumo::SessionConfig config;
    config.network = prepared.network_file;
    if (unit.engine != experiment::Engine::solo) config.route_files = prepared.route_files;
    config.additional_files = prepared.additional_files;
    config.folder = folder;
    config.step_length = core::Seconds(prepared.time.step_length_s);
    config.seed = prepared.simulator_seed;
    if (prepared.time.time_to_teleport_s)
        config.time_to_teleport = core::Seconds(*prepared.time.time_to_teleport_s);
    if (unit.engine == experiment::Engine::sublane) {
        config.extra_arguments = {"--lateral-resolution", scenario::sublane_resolution_m};
    }
    config.names = names_of(network);
    return config;
}

long peak_kib() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

/// Writes every step into the file of the run.
class FileRecording : public trace::StepListener {
  public:
    FileRecording(const std::filesystem::path& file, const trace::RecordingInfo& info)
        : writer_(prepared(file), info) {}
    void on_step(const truth::Snapshot&, const traffic::Roster&) override {}
    void on_step_end(const trace::RecordedStep& step) override { writer_.write(step); }
    void finish() { writer_.finish(); }

  private:
    static const std::filesystem::path& prepared(const std::filesystem::path& file) {
        core::make_folder(file.parent_path());
        return file;
    }
    trace::RecordingWriter writer_;
};

}  // namespace

std::unique_ptr<sumo::Session> in_this_process(sumo::SessionConfig config) {
    return std::make_unique<sumo::Session>(std::move(config));
}

UnitRun::UnitRun(const experiment::UnitSpec& unit, const std::filesystem::path& demand_folder,
                 const std::filesystem::path& folder, const StartSession& start)
    : unit_(unit),
      config_(scenario::load(unit.scenario_file.string())),
      scenario_hash_(scenario::scenario_hash(config_)),
      network_(scenario::open_network(config_, unit.network_folder)),
      prepared_(scenario::prepare(config_, network_, core::StudySeed{unit.study_seed},
                                  core::Replication{unit.replication}, demand_folder)),
      session_(start(session_config(unit, prepared_, network_.network, folder))) {
    if (unit_.engine != experiment::Engine::solo) warm_up();
}

core::Seconds UnitRun::first_emergency() const {
    if (prepared_.emergency.empty()) return core::Seconds(prepared_.time.warm_up_s);
    double first_s = prepared_.time.horizon_s;
    for (const traffic::EmergencyDeparture& departure : prepared_.emergency) {
        first_s = std::min(first_s, departure.depart.value);
    }
    return core::Seconds(first_s);
}

void UnitRun::warm_up() {
    const double first = first_emergency().value;
    while (session_->time().value + prepared_.time.step_length_s <= first - lead_before_emergency.value) {
        session_->step();
        recorder_.step(session_->snapshot(), session_->roster(), session_->events(), {});
    }
}

results::RunRecord UnitRun::finish_in(const std::filesystem::path& folder,
                                      const experiment::ConditionSpec& condition,
                                      results::RunTiming& timing) {
    session_->continue_in(folder);
    return finish_here(condition, timing);
}

results::RunRecord UnitRun::finish_here(const experiment::ConditionSpec& condition,
                                        results::RunTiming& timing, trace::StepListener* audience) {
    const auto started = std::chrono::steady_clock::now();
    LoopTiming spent;
    metrics::RunEnd end;
    if (condition.engine == experiment::Engine::solo) {
        run_solo(audience);
        end.planned = metrics::read_planned({}, prepared_.emergency);
    } else {
        trace::Listeners listeners;
        if (audience != nullptr) listeners.add(*audience);
        std::unique_ptr<FileRecording> recording;
        if (unit_.recording == experiment::StepRecording::on) {
            const trace::RecordingInfo info = recording_info(condition);
            recording = std::make_unique<FileRecording>(trace::recording_file(unit_.output, info.key), info);
            listeners.add(*recording);
        }
        spent = run_condition(condition, listeners.empty() ? nullptr : &listeners, end.leases);
        if (recording) recording->finish();
        std::vector<std::filesystem::path> files = {prepared_.additional_files.front()};  // vehicle types
        files.insert(files.end(), prepared_.route_files.begin(), prepared_.route_files.end());
        end.planned = metrics::read_planned(files, prepared_.emergency);
    }
    end.time = session_->time();
    session_->close();
    end.tripinfo_files = {session_->trip_file()};
    metrics::RunSummary summary = recorder_.finish(end);

    timing.simulator_s = spent.simulator_s;
    timing.coupling_s = spent.coupling_s;
    timing.peak_kib = peak_kib();
    timing.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return {.key = {unit_.scenario, condition.name, unit_.replication},
            .condition = condition,
            .provenance = provenance(summary.trace_hash),
            .metrics = summary.metrics,
            .vehicles = std::move(summary.vehicles),
            .traffic = std::move(summary.traffic)};
}

void UnitRun::record(const experiment::ConditionSpec& condition, trace::StepListener& listener) {
    metrics::LeaseTotals leases;
    run_condition(condition, &listener, leases);
    session_->close();
}

LoopTiming UnitRun::run_condition(const experiment::ConditionSpec& condition, trace::StepListener* listener,
                                  metrics::LeaseTotals& leases) {
    add_emergency_vehicles(condition.bluelight);
    watch_roads();
    recorder_.configure(metrics::RecorderConfig::of_latency(
        core::Seconds(sensing::failure_from(condition.failure).latency_s)));
    const Surroundings surroundings{
        .network = network_.network,
        .random = core::KeyedRandom(core::StudySeed{unit_.study_seed}, core::Replication{unit_.replication}),
        .loop = loop_config_of(condition),
        .siren = config_.siren,
        .friction = config_.road.friction,
        .has_pedestrians = config_.has_pedestrians()};
    ClosedLoop loop(*session_, make_machinery(condition, surroundings), surroundings.loop, recorder_,
                    listener);
    loop.run(core::Seconds(prepared_.time.horizon_s));
    leases = totals_of(loop.actuator());
    return loop.timing();
}

void UnitRun::add_emergency_vehicles(traffic::BlueLight bluelight) {
    for (traffic::EmergencyDeparture departure : prepared_.emergency) {
        departure.bluelight = bluelight;
        session_->add(departure);
    }
}

void UnitRun::watch_roads() {
    std::vector<metrics::EdgeCount> counts;
    if (!config_.demand.counts.empty())
        counts = metrics::read_counts(scenario::resolve(config_, config_.demand.counts));
    metrics::RoadLayout layout = road_layout(network_.network, prepared_.emergency, counts);
    layout.demand_until_s = prepared_.time.window_s;
    layout.keep_journeys = unit_.replication < journeys_kept;
    recorder_.watch(std::move(layout));
}

void UnitRun::run_solo(trace::StepListener* audience) {
    open_all_signals();
    for (traffic::EmergencyDeparture departure : prepared_.emergency) {
        departure.depart = session_->time();
        session_->add(departure);
        const double limit_s = session_->time().value + prepared_.time.horizon_s;
        while (session_->expected_vehicles() > 0 && session_->time().value < limit_s) {
            session_->step();
            recorder_.step(session_->snapshot(), session_->roster(), session_->events(), {});
            if (audience != nullptr)
                audience->on_step_end({&session_->snapshot(), &session_->roster(), &session_->events()});
        }
    }
}

void UnitRun::open_all_signals() {
    std::vector<traffic::Command> commands;
    for (std::uint32_t signal = 0; signal < network_.network.signals().size(); ++signal) {
        const std::size_t links =
            network_.network.signal(core::SignalIndex{signal}).program.front().state.size();
        commands.emplace_back(traffic::SetSignalState{core::SignalIndex{signal}, std::string(links, 'G')});
    }
    session_->apply(commands);
}

trace::RecordingInfo UnitRun::recording_info(const experiment::ConditionSpec& condition) const {
    const LoopConfig loop = loop_config_of(condition);
    return {.key = {unit_.scenario, condition.name, unit_.replication},
            .condition = condition,
            .provenance = provenance(""),
            .settings = {.step_length_s = prepared_.time.step_length_s,
                         .policy_period_s = loop.policy_period_s,
                         .link_radius_m = loop.link_radius_m,
                         .network_hash = core::content_hash(core::read_file(network_.file))}};
}

experiment::Provenance UnitRun::provenance(const std::string& trace_hash) const {
    return {.clearway_version = CLEARWAY_VERSION,
            .sumo_version = sumo::version(),
            .configuration_hash = scenario_hash_,
            .demand_hash = prepared_.demand_hash,
            .study_seed = unit_.study_seed,
            .simulator_seed = prepared_.simulator_seed,
            .trace_hash = trace_hash};
}

}  // namespace clearway::loop
