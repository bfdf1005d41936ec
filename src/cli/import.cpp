#include "scenario_import/import.hpp"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/verb.hpp"
#include "core/interruption.hpp"
#include "core/process.hpp"
#include "core/progress.hpp"
#include "core/terminal.hpp"

namespace clearway::cli {
namespace {

struct ImportArguments {
    scenario_import::ImportRequest request;
    std::vector<std::string> files;
    std::string name;
    Printing printing = Printing::text;
};

/// Shows the current stage of an import on standard error: a line that is redrawn on a terminal, otherwise
/// one every 10 s, however long a stage takes.
class Stages {
  public:
    void show(const std::string& stage) {
        const std::lock_guard lock(mutex_);
        stage_ = stage;
    }
    Stages() = default;
    ~Stages() {
        thread_.request_stop();
        thread_.join();
        core::clear_drawn_line();
    }
    Stages(const Stages&) = delete;
    Stages& operator=(const Stages&) = delete;

  private:
    void watch(const std::stop_token& stop) {
        const auto started = std::chrono::steady_clock::now();
        const bool is_terminal = core::can_redraw();
        const auto interval = is_terminal ? std::chrono::milliseconds(200) : std::chrono::seconds(10);
        std::unique_lock lock(mutex_);
        while (!changed_.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
            const std::string line =
                fmt::format("import: {}, {} elapsed", stage_, core::clock_text(elapsed.count()));
            is_terminal ? core::draw_line(line) : core::print_message(line + "\n");
        }
    }

    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::string stage_ = "reading";
    std::jthread thread_{[this](const std::stop_token& stop) { watch(stop); }};
};

/// Imports and shows the stages; a signal interrupts it.
scenario_import::Findings import_watched(const scenario_import::ImportRequest& request) {
    const core::InterruptionWatch interruption;
    Stages stages;
    return scenario_import::import(request, [&](const std::string& stage, double) {
        if (interruption.signal() != 0)
            throw core::Error(interruption.exit_code(core::ExitCode::ok),
                              "interrupted; nothing is left behind");
        stages.show(stage);
    });
}

core::ExitCode import(ImportArguments& arguments) {
    arguments.request.files.assign(arguments.files.begin(), arguments.files.end());
    arguments.request.folder = arguments.name;
    const scenario_import::Findings findings = import_watched(arguments.request);
    if (arguments.printing == Printing::json) {
        fmt::print("{}", scenario_import::to_json(findings));
    } else {
        // A bare name could be that of a scenario shipped with Clearway.
        const std::filesystem::path& folder = arguments.request.folder;
        const std::string scenario = folder.is_absolute() ? folder.string() : "./" + folder.string();
        fmt::print(
            "{}picture: {}/network.svg\nNext: {}\n(--lock-trials 6 looks for locks too, with 12 more "
            "runs)\n",
            scenario_import::to_text(findings), folder.string(),
            core::shell_text({"clearway", "scenario", "check", scenario}));
    }
    const bool falls_short =
        findings.bad_vehicles_share > scenario_import::most_bad_vehicles || !findings.trial_failure.empty();
    return falls_short ? core::ExitCode::fell_short : core::ExitCode::ok;
}

}  // namespace

Action configure_import(App& app) {
    const auto arguments = std::make_shared<ImportArguments>();
    scenario_import::ImportRequest& request = arguments->request;
    app.add_option("files", arguments->files,
                   "A map (.osm, .gz, .bz2, .pbf), a .sumocfg, or a .net.xml with its files")
        .required()
        .option_text("FILE ... (required)");
    app.add_option("--name", arguments->name, "Name of the scenario and of its new folder")
        .required()
        .option_text("NAME (required)");
    app.add_choice("--driving-side", request.side,
                   {{"auto", scenario_import::DrivingSide::by_country},
                    {"right", scenario_import::DrivingSide::right},
                    {"left", scenario_import::DrivingSide::left}},
                   "For a map: side on which traffic drives; auto: by country")
        .option_text("auto|right|left [auto]");
    app.add_option("--av-share", request.automated_share, "Share of automated cars, drawn by vehicle id")
        .range(0.0, 1.0)
        .option_text("SHARE, 0 to 1 [0.35]");
    app.add_option("--pedestrians", request.pedestrians_per_hour,
                   "Pedestrians per hour at each crossing with signals; a map's roads get sidewalks")
        .range(0.0, 2000.0)
        .option_text("NUMBER, 0 to 2000 [0]");
    app.add_choice("--car-following", request.car_following,
                   "For a SUMO scenario's vehicles: their own model, or IDM")
        .option_text("own|idm [own]");
    app.add_choice("--own-emergency", request.own_emergency,
                   {{"traffic", scenario_import::OwnEmergency::traffic},
                    {"measure", scenario_import::OwnEmergency::measure}},
                   "For a SUMO scenario: its emergency vehicles are traffic beside ours, or those measured")
        .option_text("traffic|measure [traffic]");
    app.add_option("--begin", request.begin_s,
                   "For a SUMO scenario: the time in it at which the new scenario begins, s")
        .option_text("SECONDS [its begin; after two hours of demand the busiest time]");
    app.add_option("--program-limit", request.program_limit_s,
                   "Wall time after which a program is ended that the import starts, such as a trial run, s")
        .range(1.0, 1e7)
        .option_text(fmt::format("SECONDS, 1 to 1e7 [{:g}]", request.program_limit_s));
    app.add_flag_callback(
        "--leave-out-bad-vehicles",
        [&request] { request.bad_vehicles = scenario_import::BadVehicles::leave_out; },
        "Leave out vehicles and persons with unknown edges or gaps in the route [refuse]");
    add_json_option(app, arguments->printing, "the findings");
    return [arguments](const Invocation&) { return import(*arguments); };
}

}  // namespace clearway::cli
