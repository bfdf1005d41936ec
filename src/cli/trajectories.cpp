#include "trace/trajectories.hpp"

#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/verb.hpp"
#include "core/files.hpp"
#include "core/number_range.hpp"
#include "results/store.hpp"
#include "scenario/sumo_files.hpp"

namespace clearway::cli {
namespace {

struct Arguments {
    std::string run;
    std::string folder;
    double every_s = 1.0;
    double reach_m = 50.0;
};

/// The recording of a run, given as itself or as FOLDER/SCENARIO/CONDITION/REPLICATION.
std::filesystem::path recording_of(const std::filesystem::path& run) {
    if (std::filesystem::is_regular_file(run)) return std::filesystem::absolute(run).lexically_normal();
    const std::filesystem::path whole = std::filesystem::absolute(run).lexically_normal();
    const std::string number = whole.filename().string();
    const bool is_number =
        !number.empty() && number.size() <= 5 && number.find_first_not_of("0123456789") == std::string::npos;
    const std::filesystem::path folder = whole.parent_path().parent_path().parent_path();
    if (!is_number || !std::filesystem::exists(folder / "manifest.json"))
        throw core::InputError({run.string(), "is no run",
                                "a recording, or FOLDER/SCENARIO/CONDITION/REPLICATION",
                                "for example runs/city-1a2b3c/city/corridor/0"});
    const experiment::RunKey key{whole.parent_path().parent_path().filename().string(),
                                 whole.parent_path().filename().string(),
                                 static_cast<std::uint32_t>(std::stoul(number))};
    const std::filesystem::path recording = trace::recording_file(folder, key);
    if (!std::filesystem::exists(recording))
        throw core::InputError({run.string(), fmt::format("has no recording {}", recording.string()),
                                "a recorded run",
                                "give the command that made it again, with --record and another --out"});
    return recording;
}

core::ExitCode write(const Arguments& arguments) {
    const std::filesystem::path file = recording_of(arguments.run);
    trace::RecordingReader recording(file);
    const experiment::RunKey key = recording.info().key;
    const std::uint64_t seed = recording.info().provenance.study_seed;
    const std::filesystem::path run_folder = file.parent_path().parent_path().parent_path().parent_path();
    const std::filesystem::path scenario_folder =
        results::Store::open(run_folder).scenario_folder(key.scenario);
    const scenario::ScenarioConfig config = scenario::load((scenario_folder / "scenario.toml").string());
    const scenario::BuiltNetwork network = scenario::open_network(config, scenario_folder / "network");

    const std::filesystem::path folder =
        arguments.folder.empty()
            ? fmt::format("trajectories-{}-{}-{}", key.scenario, key.condition, key.replication)
            : arguments.folder;
    core::make_folder(folder / "sumo");
    const trace::TrajectoryCounts counts = trace::write_trajectories(
        recording, network.network, {core::Seconds(arguments.every_s), core::Metres(arguments.reach_m)},
        folder);
    scenario::write_sumo_files(config, network, core::StudySeed{seed}, core::Replication{key.replication},
                               folder / "sumo");
    fmt::print("{}: {} EVs and {} neighbours in {} places\n", experiment::to_text(key),
               counts.emergency_vehicles, counts.neighbours, counts.places);
    fmt::print("  {0}/trajectories.csv\n{1}  {0}/sumo/run.sumocfg, the baseline for any SUMO\n",
               folder.string(),
               counts.has_coordinates ? fmt::format("  {}/trajectories.geojson\n", folder.string()) : "");
    if (!counts.has_coordinates)
        fmt::print(stderr,
                   "clearway: this network has no map projection that is known, so no GeoJSON and no "
                   "coordinates; x and y are there\n");
    return core::ExitCode::ok;
}

}  // namespace

Action configure_trajectories(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("run", arguments->run,
                   "FOLDER/SCENARIO/CONDITION/REPLICATION of a recorded run, or a recording")
        ->required()
        ->option_text("RUN (required)");
    app.add_option("--out", arguments->folder, "Folder to write into")
        ->option_text("DIR [trajectories-SCENARIO-CONDITION-N]");
    app.add_option("--every", arguments->every_s, "Time between two places of a vehicle, s")
        ->check(core::NumberRange{0.01, 3600.0})
        ->option_text("SECONDS, 0.01 to 3600 [1]");
    app.add_option("--reach", arguments->reach_m, "Vehicles nearer than this to an EV are its neighbours, m")
        ->check(core::NumberRange{0.0, 10000.0})
        ->option_text("METRES, 0 to 10000 [50]");
    return [arguments](const Invocation&) { return write(*arguments); };
}

}  // namespace clearway::cli
