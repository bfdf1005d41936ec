#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "experiment/unit.hpp"
#include "loop/closed_loop.hpp"
#include "loop/machinery.hpp"
#include "metrics/recorder.hpp"
#include "results/store.hpp"
#include "scenario/prepare.hpp"
#include "sumo/session.hpp"

namespace clearway::loop {

/// Time before the first emergency vehicle at which conditions part: sensors fill, and nothing depends on the
/// condition before it.
inline constexpr core::Seconds lead_before_emergency{60.0};

/// How a simulation comes to run.
using StartSession = std::function<std::unique_ptr<sumo::Session>(sumo::SessionConfig)>;
std::unique_ptr<sumo::Session> in_this_process(sumo::SessionConfig config);

/// A scenario and replication, loaded and warmed up, from which conditions start.
class UnitRun {
  public:
    /// Prepares the demand, loads SUMO and steps to `lead_before_emergency` before the first emergency
    /// vehicle. Outputs go to `folder`, the demand to `demand_folder`.
    UnitRun(const experiment::UnitSpec& unit, const std::filesystem::path& demand_folder,
            const std::filesystem::path& folder, const StartSession& start = in_this_process);

    /// Runs one condition to its end in this process, which was forked for it: outputs first move to
    /// `folder`.
    results::RunRecord finish_in(const std::filesystem::path& folder,
                                 const experiment::ConditionSpec& condition, results::RunTiming& timing);
    /// Runs one condition to its end without a fork; `audience` may be null.
    results::RunRecord finish_here(const experiment::ConditionSpec& condition, results::RunTiming& timing,
                                   trace::StepListener* audience = nullptr);
    /// The same with a listener and without results: for recording data.
    void record(const experiment::ConditionSpec& condition, trace::StepListener& listener);

    const roads::Network& network() const { return network_.network; }
    sumo::Session& session() { return *session_; }
    /// When the first emergency vehicle departs; the end of the warm-up without any.
    core::Seconds first_emergency() const;
    const std::string& scenario_hash() const { return scenario_hash_; }

  private:
    void warm_up();
    void add_emergency_vehicles(traffic::BlueLight bluelight);
    /// Has the recorder say where time is lost, from now on.
    void watch_roads();
    /// Each emergency vehicle alone, one after the other, with every signal open.
    void run_solo(trace::StepListener* audience);
    void open_all_signals();
    LoopTiming run_condition(const experiment::ConditionSpec& condition, trace::StepListener* listener,
                             metrics::LeaseTotals& leases);
    trace::RecordingInfo recording_info(const experiment::ConditionSpec& condition) const;
    experiment::Provenance provenance(const std::string& trace_hash) const;

    experiment::UnitSpec unit_;
    scenario::ScenarioConfig config_;
    std::string scenario_hash_;
    scenario::BuiltNetwork network_;
    scenario::Prepared prepared_;
    std::unique_ptr<sumo::Session> session_;
    metrics::Recorder recorder_;
};

}  // namespace clearway::loop
