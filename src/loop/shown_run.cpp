#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "core/files.hpp"
#include "loop/illustrator.hpp"
#include "loop/jobs.hpp"
#include "loop/unit_run.hpp"
#include "results/store.hpp"
#include "sumo/child_sumo.hpp"

namespace clearway::loop {
namespace {

/// View settings of the window unless the user has their own: vehicles as plain boxes in the colour they are
/// given (vehicleMode 2; 0 would paint every ambulance white), on grey roads.
constexpr const char* own_settings = R"(<viewsettings>
    <scheme name="clearway">
        <background backgroundColor="245,245,240" showGrid="0"/>
        <edges laneEdgeMode="0" laneShowBorders="1">
            <colorScheme name="uniform"><entry color="95,95,95" name="road"/></colorScheme>
        </edges>
        <junctions junctionMode="0">
            <colorScheme name="uniform"><entry color="95,95,95" name=""/></colorScheme>
        </junctions>
        <vehicles vehicleMode="2" vehicleQuality="1" vehicle_exaggeration="1.6"/>
    </scheme>
    <delay value="0"/>
</viewsettings>
)";

/// Width and height, pixels.
constexpr const char* window_size = "1200,800";

std::vector<std::string> window_arguments(const experiment::WindowSpec& window,
                                          const std::filesystem::path& folder) {
    if (window.program == "sumo") return {};
    std::filesystem::path settings = window.settings_file;
    if (settings.empty()) {
        settings = folder / "view.xml";
        core::write_atomically(settings, own_settings);
    }
    return {"--start",       "true",      "--quit-on-end",       "true",
            "--window-size", window_size, "--gui-settings-file", settings.string()};
}

/// Draws every step into the SUMO that drives the run, at a pace that a person can follow.
class Show : public trace::StepListener {
  public:
    /// Both outlive the object. A step takes at least `delay` of wall time.
    Show(sumo::Session& session, const roads::Network& network, core::Seconds delay)
        : session_(session), illustrator_(network), delay_(delay.value) {}

    void on_step(const truth::Snapshot&, const traffic::Roster&) override {}
    void on_step_end(const trace::RecordedStep& step) override {
        session_.draw(illustrator_.draw(step));
        std::this_thread::sleep_until(next_);
        next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(delay_);
    }

  private:
    using Clock = std::chrono::steady_clock;

    sumo::Session& session_;
    Illustrator illustrator_;
    std::chrono::duration<double> delay_;
    Clock::time_point next_;
};

/// The error for a simulation that broke off. Closing the window makes SUMO exit normally.
core::Error reason(const core::SimulatorError& fault, sumo::ChildSumo& child) {
    constexpr core::Seconds patience{5.0};
    const auto end = child.wait_for_end(patience);
    if (end && end->ok())
        return {core::ExitCode::incomplete,
                "the window was closed before the end of the run; its results are discarded"};
    return fault.with_context(end ? fmt::format("SUMO: {}\n{}", end->describe(), child.last_words())
                                  : "SUMO does not answer");
}

}  // namespace

core::ExitCode run_shown(const experiment::RunJob& unit, const std::filesystem::path& work) {
    const experiment::WindowSpec window = unit.window.value_or(experiment::WindowSpec{});
    const results::Store store = results::Store::open(unit.output);
    const std::filesystem::path demand = work / "demand";
    core::make_folder(demand);
    std::optional<sumo::ChildSumo> child;
    const auto start = [&](const sumo::SessionConfig& config) {
        child.emplace(window.program, config, window_arguments(window, work), work / "window.log");
        return std::make_unique<sumo::Session>(child->connect(), work / "client", config.names);
    };
    try {
        UnitRun run(unit, demand, work / "sumo", start);
        Show show(run.session(), run.network(), core::Seconds(window.delay_s));
        results::RunTiming timing;
        const results::RunRecord record = run.finish_here(unit.conditions.at(0), timing, &show);
        store.write(record, timing);
    } catch (const core::SimulatorError& fault) {
        if (!child) throw;
        throw reason(fault, *child);
    }
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
