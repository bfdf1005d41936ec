#include "trace/trajectories.hpp"

#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "campaign/run_name.hpp"
#include "cli/detail/app.hpp"
#include "cli/verb.hpp"
#include "core/counted.hpp"
#include "core/files.hpp"
#include "core/own_output.hpp"
#include "scenario/sumo_files.hpp"

namespace clearway::cli {
namespace {

struct TrajectoriesArguments {
    std::string run;
    std::string folder;
    double every_s = 1.0;
    double reach_m = 50.0;
};

core::ExitCode write(const TrajectoriesArguments& arguments) {
    const campaign::NamedRecording named = campaign::recording_named(arguments.run, "RUN");
    trace::RecordingReader& recording = *named.reader;
    const experiment::RunKey key = recording.info().key;
    const experiment::ConditionSpec condition = recording.info().condition;
    const scenario::SumoRun run{.seed = core::StudySeed{recording.info().provenance.study_seed},
                                .replication = core::Replication{key.replication},
                                .lateral_model = condition.traffic_model == experiment::TrafficModel::sublane
                                                     ? traffic::LateralModel::sublane
                                                     : traffic::LateralModel::lane,
                                .bluelight = condition.bluelight,
                                .rerouting_s = condition.rerouting_s};
    const std::filesystem::path run_folder =
        named.file.parent_path().parent_path().parent_path().parent_path();
    const std::filesystem::path scenario_folder =
        results::Store::open(run_folder).scenario_folder(key.scenario);
    const scenario::ScenarioConfig config = scenario::load((scenario_folder / "scenario.toml").string());
    const scenario::BuiltNetwork network = scenario::open_network(config, scenario_folder / "network");

    const std::filesystem::path folder =
        arguments.folder.empty()
            ? fmt::format("trajectories-{}-{}-{}", key.scenario, key.condition, key.replication)
            : arguments.folder;
    core::claim(folder, {"clearway export trajectories", {".clearway-trajectories"}});
    core::make_folder(folder / "sumo");
    const trace::TrajectoryCounts counts = trace::write_trajectories(
        recording, network.network, {core::Seconds(arguments.every_s), core::Metres(arguments.reach_m)},
        folder);
    scenario::write_sumo_files(config, network, run, folder / "sumo");
    fmt::print("{}: {} and {} at {}\n", campaign::run_name(std::filesystem::proximate(run_folder), key),
               core::counted(counts.emergency_vehicles, "EV"), core::counted(counts.neighbours, "neighbour"),
               core::counted(counts.places, "place"));
    fmt::print("  {0}/trajectories.csv\n{1}  {0}/sumo/run.sumocfg, {2}\n", folder.string(),
               counts.has_coordinates ? fmt::format("  {}/trajectories.geojson\n", folder.string()) : "",
               condition.policies.empty()
                   ? "this run for any SUMO"
                   : "its demand, traffic model and devices for any SUMO; what the policy did is not in it");
    if (!counts.has_coordinates)
        fmt::print(stderr,
                   "clearway: this network has no known map projection, so there is no GeoJSON and there "
                   "are only x and y\n");
    return core::ExitCode::ok;
}

}  // namespace

Action configure_trajectories(App& app) {
    const auto arguments = std::make_shared<TrajectoriesArguments>();
    app.add_option("run", arguments->run,
                   fmt::format("{} of a recorded run, or a recording", campaign::run_name_form))
        .required()
        .option_text("RUN (required)");
    app.add_option("--out", arguments->folder, "Folder to write into")
        .option_text("DIR [trajectories-SCENARIO-CONDITION-N]");
    app.add_option("--every", arguments->every_s, "Time between two positions of a vehicle, s")
        .range(0.01, 3600.0)
        .option_text("SECONDS, 0.01 to 3600 [1]");
    app.add_option("--reach", arguments->reach_m, "Vehicles nearer than this to an EV are its neighbours, m")
        .range(0.0, 10000.0)
        .option_text("METRES, 0 to 10000 [50]");
    return [arguments](const Invocation&) { return write(*arguments); };
}

}  // namespace clearway::cli
