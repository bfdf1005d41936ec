#include "loop/unit_run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/files.hpp"
#include "experiment/code_parts.hpp"
#include "experiment/equipped_signals.hpp"
#include "experiment/settings.hpp"
#include "loop/hold_trials.hpp"
#include "loop/road_layout.hpp"
#include "loop/way_trials.hpp"
#include "scenario/sumo_files.hpp"
#include "trace/recording.hpp"
#include "trace/step_listener.hpp"

namespace clearway::loop {
namespace {

sumo::SessionConfig session_config(const experiment::RunJob& unit, const scenario::Prepared& prepared,
                                   const roads::Network& network, const std::filesystem::path& folder) {
    sumo::SessionConfig config;
    config.network = prepared.network_file;
    if (unit.traffic_model != experiment::TrafficModel::free_flow) config.route_files = prepared.route_files;
    config.additional_files = prepared.additional_files;
    config.folder = folder;
    config.step_length = core::Seconds(prepared.time.step_length_s);
    config.seed = prepared.simulator_seed;
    if (prepared.time.time_to_teleport_s)
        config.time_to_teleport = core::Seconds(*prepared.time.time_to_teleport_s);
    if (prepared.time.ignore_junction_blocker_s)
        config.ignore_junction_blocker = core::Seconds(*prepared.time.ignore_junction_blocker_s);
    if (unit.traffic_model == experiment::TrafficModel::sublane) {
        config.extra_arguments = {"--lateral-resolution", scenario::sublane_resolution_m};
    }
    if (!unit.conditions.empty()) {
        const double penalty = experiment::process_of(unit.conditions.front()).signal_penalty;
        if (penalty > 0.0)
            config.extra_arguments.insert(config.extra_arguments.end(),
                                          {"--weights.tls-penalty", fmt::format("{:g}", penalty)});
    }
    // A vehicle whose way is closed when it departs waits at the block, instead of being an error.
    const auto closes_lanes = [](const scenario::PlacedIncident& each) {
        return each.closed.emergency_passes;
    };
    if (std::ranges::any_of(prepared.incidents, closes_lanes))
        config.extra_arguments.insert(config.extra_arguments.end(), {"--ignore-route-errors", "true"});
    for (const std::string& option : prepared.options)
        config.extra_arguments.push_back("--" + option);
    config.names = names_of(network);
    return config;
}

/// A condition begins this long before a call, so that it has seen the traffic, s.
constexpr double before_call_s = 120.0;

/// A run job with only the simulation set.
experiment::RunJob plain_job(const experiment::Simulation& simulation) {
    experiment::RunJob job;
    static_cast<experiment::Simulation&>(job) = simulation;
    return job;
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

UnitRun::UnitRun(const experiment::RunJob& unit, const std::filesystem::path& demand_folder,
                 const std::filesystem::path& folder, const StartSession& start)
    : unit_(unit),
      config_(scenario::load(unit.scenario_file.string())),
      scenario_hash_(scenario::scenario_hash(config_)),
      network_(scenario::open_network(config_, unit.network_folder)),
      prepared_(scenario::prepare(config_, network_, core::StudySeed{unit.study_seed},
                                  core::Replication{unit.replication}, demand_folder)),
      session_(start(session_config(unit, prepared_, network_.network, folder))),
      loop_(*session_, recorder_) {
    if (unit_.traffic_model == experiment::TrafficModel::free_flow) return;
    if (!prepared_.incidents.empty()) loop_.block({network_.network, prepared_.incidents, random()});
    warm_up();
}

UnitRun::UnitRun(const experiment::Simulation& simulation, const std::filesystem::path& folder)
    : UnitRun(plain_job(simulation), folder, folder) {}

core::Seconds UnitRun::first_emergency() const {
    if (prepared_.emergency.empty()) return core::Seconds(prepared_.time.warm_up_s);
    double first_s = prepared_.time.horizon_s;
    for (const traffic::EmergencyDeparture& departure : prepared_.emergency) {
        if (!departure.is_called) first_s = std::min(first_s, departure.depart.value);
    }
    for (const scenario::PlacedCall& call : prepared_.calls.calls)
        first_s = std::min(first_s, std::max(prepared_.time.warm_up_s, call.at.value - before_call_s));
    return core::Seconds(first_s);
}

core::KeyedRandom UnitRun::random() const {
    return {core::StudySeed{unit_.study_seed}, core::Replication{unit_.replication}};
}

std::vector<traffic::Incident> UnitRun::incidents() const {
    std::vector<traffic::Incident> closed;
    for (const scenario::PlacedIncident& incident : prepared_.incidents)
        closed.push_back(incident.closed);
    return closed;
}

void UnitRun::warm_up() {
    loop_.warm_up(core::Seconds(first_emergency().value - lead_before_emergency.value),
                  core::Seconds(prepared_.time.step_length_s));
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
    metrics::RunEnd end;
    if (condition.traffic_model == experiment::TrafficModel::free_flow) {
        run_alone(audience);
        end.planned = metrics::read_planned({}, prepared_.emergency);
    } else {
        end.leases = run_recorded(condition, audience);
        std::vector<std::filesystem::path> files = {prepared_.additional_files.front()};  // vehicle types
        files.insert(files.end(), prepared_.route_files.begin(), prepared_.route_files.end());
        end.planned = metrics::read_planned(files, prepared_.emergency);
    }
    end.incidents = loop_.incident_counts();
    if (dispatcher_) end.dispatch = dispatcher_->result(horizon());
    end.time = session_->time();
    end.horizon = core::Seconds(prepared_.time.horizon_s);
    session_->close();
    end.tripinfo_files = {session_->trip_file()};
    metrics::RunSummary summary = recorder_.finish(end);
    timing = timing_of(loop_.timing(), started);
    return record_of({unit_.scenario, condition.name, unit_.replication}, condition, provenance(),
                     std::move(summary));
}

metrics::LeaseTotals UnitRun::run_recorded(const experiment::ConditionSpec& condition,
                                           trace::StepListener* audience) {
    trace::Listeners listeners;
    if (audience != nullptr) listeners.add(*audience);
    std::unique_ptr<FileRecording> recording;
    if (unit_.recording == experiment::StepRecording::on) {
        const trace::RecordingInfo info = recording_info(condition);
        recording = std::make_unique<FileRecording>(trace::recording_file(unit_.output, info.key), info);
        listeners.add(*recording);
    }
    const metrics::LeaseTotals leases = run_together(condition, listeners.empty() ? nullptr : &listeners);
    if (recording) recording->finish();
    return leases;
}

void UnitRun::record(const experiment::ConditionSpec& condition, trace::StepListener& listener) {
    run_together(condition, &listener);
    session_->close();
}

void UnitRun::start_together(const experiment::ConditionSpec& condition, trace::StepListener* listener) {
    add_emergency_vehicles(condition);
    const ControllerContext context{
        .network = network_.network,
        .random = random(),
        .loop = experiment::loop_config(condition),
        .siren = config_.siren,
        .privilege = static_cast<const traffic::PrivilegeConfig&>(config_.privilege),
        .friction = config_.road.friction,
        .has_pedestrians = config_.has_pedestrians(),
        .preemption = network_.preemption,
        .guest = guest_,
        .incidents = incidents(),
        .is_read = dispatcher_ && dispatcher_->reads_belief(),
        .mean_times_s = network_.mean_times_s};
    // Its code may have been edited since the study began.
    start_condition(loop_, recorder_, experiment::with_kept_code(condition, unit_.output),
                    {.context = context, .layout = layout(), .horizon = horizon(), .listener = listener});
}

metrics::LeaseTotals UnitRun::run_together(const experiment::ConditionSpec& condition,
                                           trace::StepListener* listener) {
    start_together(condition, listener);
    const LoopConfig config = experiment::loop_config(condition);
    const std::filesystem::path folder = session_->trip_file().parent_path();
    std::optional<WayTrials> ways;
    std::optional<HoldTrials> holds;
    std::vector<TriedAtSteps*> trials;
    if (config.ways_tried > 0) trials.push_back(&ways.emplace(network_.network, config, folder / "way"));
    if (config.holds_tried > 0)
        trials.push_back(&holds.emplace(network_.network, config,
                                        experiment::equipped_signals(condition, network_.network),
                                        folder / "hold"));
    loop_.try_choices(std::move(trials));
    loop_.run(horizon());
    loop_.try_choices({});
    metrics::LeaseTotals totals = loop_.finish();
    if (ways) totals.ways = ways->result(horizon());
    if (holds) totals.holds = holds->result(horizon());
    return totals;
}

ClosedLoop& UnitRun::start(const experiment::ConditionSpec& condition) {
    start_together(condition, nullptr);
    return loop_;
}

void UnitRun::add_emergency_vehicles(const experiment::ConditionSpec& condition) {
    const LoopConfig loop = experiment::loop_config(condition);
    DispatchOrders orders{.by = condition.dispatch,
                          .calls = prepared_.calls,
                          .incidents = prepared_.incidents,
                          .period = core::Seconds(loop.policy_period_s),
                          .units_tried = loop.units_tried,
                          .folder = session_->trip_file().parent_path() / "unit"};
    for (traffic::EmergencyDeparture departure : prepared_.emergency) {
        departure.bluelight = condition.bluelight;
        departure.rerouting_s = condition.rerouting_s;
        if (departure.is_called)
            orders.vehicles.push_back(std::move(departure));
        else
            session_->add(departure);
    }
    if (prepared_.calls.calls.empty()) return;
    dispatcher_.emplace(network_.network, std::move(orders));
    loop_.answer_calls(&*dispatcher_);
}

metrics::RoadLayout UnitRun::layout() const {
    std::vector<metrics::EdgeCount> counts;
    if (!config_.demand.counts.empty())
        counts = metrics::read_counts(scenario::resolve(config_, config_.demand.counts));
    metrics::RoadLayout layout = road_layout(network_.network, prepared_.emergency, counts);
    layout.demand_until_s = prepared_.time.window_s;
    layout.keep_journeys = unit_.replication < metrics::journeys_kept;
    return layout;
}

void UnitRun::run_alone(trace::StepListener* audience) {
    open_all_signals();
    loop_.tell(audience);
    for (traffic::EmergencyDeparture departure : prepared_.emergency) {
        departure.depart = session_->time();
        session_->add(departure);
        loop_.run(core::Seconds(session_->time().value + prepared_.time.horizon_s));
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
    const LoopConfig loop = experiment::loop_config(condition);
    return {.key = {unit_.scenario, condition.name, unit_.replication},
            .condition = condition,
            .provenance = provenance(),
            .settings = {.step_length_s = prepared_.time.step_length_s,
                         .policy_period_s = loop.policy_period_s,
                         .link_radius_m = loop.link_radius_m,
                         .network_hash = core::content_hash(core::read_file(network_.file))},
            .incidents = trace::incidents_text(incidents())};
}

experiment::Provenance UnitRun::provenance() const {
    experiment::Provenance provenance = own_provenance();
    provenance.configuration_hash = scenario_hash_;
    provenance.demand_hash = prepared_.demand_hash;
    provenance.study_seed = unit_.study_seed;
    provenance.simulator_seed = prepared_.simulator_seed;
    return provenance;
}

}  // namespace clearway::loop
