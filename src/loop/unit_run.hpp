#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "experiment/run_job.hpp"
#include "loop/condition_run.hpp"
#include "metrics/recorder.hpp"
#include "results/store.hpp"
#include "scenario/prepare.hpp"
#include "sumo/session.hpp"

namespace clearway::loop {

/// Conditions are forked this long before the first emergency vehicle departs, so that sensors have history
/// by then. Nothing before the fork depends on the condition.
inline constexpr core::Seconds lead_before_emergency{60.0};

/// Starts a simulation: in this process or in a child.
using StartSession = std::function<std::unique_ptr<sumo::Session>(sumo::SessionConfig)>;
std::unique_ptr<sumo::Session> in_this_process(sumo::SessionConfig config);

/// A replication of a scenario, loaded and warmed up, from which conditions start.
class UnitRun {
  public:
    /// Prepares the demand, loads SUMO and steps to `lead_before_emergency` before the first emergency
    /// vehicle. Outputs go to `folder`, the demand to `demand_folder`.
    UnitRun(const experiment::RunJob& unit, const std::filesystem::path& demand_folder,
            const std::filesystem::path& folder, const StartSession& start = in_this_process);
    /// A simulation outside a study, to record data from; all files go to `folder`.
    UnitRun(const experiment::Simulation& simulation, const std::filesystem::path& folder);

    /// Runs one condition to its end in this process, which was forked for it. Outputs go to `folder` from
    /// here on.
    results::RunRecord finish_in(const std::filesystem::path& folder,
                                 const experiment::ConditionSpec& condition, results::RunTiming& timing);
    /// Runs one condition to its end without a fork; `audience` may be null.
    results::RunRecord finish_here(const experiment::ConditionSpec& condition, results::RunTiming& timing,
                                   trace::StepListener* audience = nullptr);
    /// The same with a listener but without results, for recording data.
    void record(const experiment::ConditionSpec& condition, trace::StepListener& listener);

    /// Starts a condition whose steps the caller makes, for measuring them.
    ClosedLoop& start(const experiment::ConditionSpec& condition);

    /// Lets `guest` act after the policies of the condition that runs next.
    void invite(policy::GuestMaker guest) { guest_ = std::move(guest); }

    const roads::Network& network() const { return network_.network; }
    sumo::Session& session() { return *session_; }
    /// When the first emergency vehicle departs; without one, the end of the warm-up.
    core::Seconds first_emergency() const;
    core::Seconds horizon() const { return core::Seconds(prepared_.time.horizon_s); }
    std::size_t emergency_count() const { return prepared_.emergency.size(); }
    const std::string& scenario_hash() const { return scenario_hash_; }
    const scenario::ScenarioConfig& scenario() const { return config_; }
    std::vector<traffic::Incident> incidents() const;

  private:
    core::KeyedRandom random() const;
    void warm_up();
    /// Those that are called are left to a dispatcher.
    void add_emergency_vehicles(const experiment::ConditionSpec& condition);
    metrics::RoadLayout layout() const;
    /// Each emergency vehicle alone, one after the other, with every signal open.
    void run_alone(trace::StepListener* audience);
    void open_all_signals();
    void start_together(const experiment::ConditionSpec& condition, trace::StepListener* listener);
    metrics::LeaseTotals run_together(const experiment::ConditionSpec& condition,
                                      trace::StepListener* listener);
    /// The same, with a recording if the job asks for one.
    metrics::LeaseTotals run_recorded(const experiment::ConditionSpec& condition,
                                      trace::StepListener* audience);
    trace::RecordingInfo recording_info(const experiment::ConditionSpec& condition) const;
    experiment::Provenance provenance() const;

    experiment::RunJob unit_;
    scenario::ScenarioConfig config_;
    std::string scenario_hash_;
    scenario::BuiltNetwork network_;
    scenario::Prepared prepared_;
    std::unique_ptr<sumo::Session> session_;
    metrics::Recorder recorder_;
    ClosedLoop loop_;
    policy::GuestMaker guest_;
    std::optional<Dispatcher> dispatcher_;
};

}  // namespace clearway::loop
