#include <chrono>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/files.hpp"
#include "core/random.hpp"
#include "experiment/settings.hpp"
#include "loop/condition_run.hpp"
#include "loop/jobs.hpp"
#include "loop/road_layout.hpp"
#include "results/store.hpp"

namespace clearway::loop {
namespace {

constexpr const char* scenario_name = "attached";

/// A file that SUMO names in an option. SUMO runs in an unknown folder, perhaps on another machine.
std::filesystem::path file_of(const sumo::RemoteSumo& sumo, const std::string& option,
                              const std::string& cure) {
    const std::filesystem::path file = sumo.option(option);
    if (file.empty())
        throw core::InputError({fmt::format("--{} of that SUMO", option), "is not set", "a file", cure});
    if (std::filesystem::is_regular_file(file)) return std::filesystem::absolute(file);
    throw core::InputError({fmt::format("--{} of that SUMO", option),
                            fmt::format("names {}, which is not a file here", file.string()),
                            "a file that this machine can read, as an absolute path", cure});
}

/// The additional files that this machine can read; they may hold signal programs. A signal whose program is
/// in none of them returns to it by way of all red.
std::vector<std::filesystem::path> additional_files_of(const sumo::RemoteSumo& sumo) {
    std::vector<std::filesystem::path> files;
    std::istringstream names(sumo.option("additional-files"));
    for (std::string name; std::getline(names >> std::ws, name, ',');)
        if (std::filesystem::is_regular_file(name)) files.emplace_back(name);
    return files;
}

core::Seconds end_of(const sumo::RemoteSumo& sumo) {
    const double end_s = std::strtod(sumo.option("end").c_str(), nullptr);
    return core::Seconds(end_s > 0.0 ? end_s : std::numeric_limits<double>::max());
}

bool has_sublanes(const sumo::RemoteSumo& sumo) {
    return std::strtod(sumo.option("lateral-resolution").c_str(), nullptr) > 0.0;
}

results::Manifest manifest_of(const experiment::AttachJob& job, const std::filesystem::path& network) {
    results::ScenarioEntry entry{
        .name = scenario_name,
        .version = "as it ran",
        .title = fmt::format("the simulation at {}:{}", job.host, job.port),
        .configuration = fmt::format("network = \"{}\"\nnetwork_hash = \"{}\"\n", network.string(),
                                     core::content_hash(core::read_file(network))),
        .configuration_hash = {},
        .attribution = {}};
    entry.configuration_hash = core::content_hash(entry.configuration);
    results::Manifest manifest;
    manifest.study = scenario_name;
    manifest.clearway_version = CLEARWAY_VERSION;
    manifest.sumo_version = sumo::version();
    manifest.study_seed = job.study_seed;
    manifest.replications = 1;
    manifest.scenarios = {std::move(entry)};
    manifest.conditions = {job.condition};
    return manifest;
}

/// Files and end of a simulation, found before anything in it is changed.
struct Ground {
    std::filesystem::path network_file;
    std::vector<std::filesystem::path> additional_files;  ///< Those that this machine can read.
    std::filesystem::path trip_file;
    core::Seconds end;
};

Ground ground_of(const sumo::RemoteSumo& sumo, const experiment::AttachJob& job) {
    Ground ground;
    ground.network_file =
        job.network.empty() ? file_of(sumo, "net-file", "Give the file with --network") : job.network;
    ground.additional_files = additional_files_of(sumo);
    ground.trip_file = file_of(sumo, "tripinfo-output",
                               "Start SUMO with --tripinfo-output FILE: times and losses come from it");
    ground.end = end_of(sumo);
    return ground;
}

Stage stage_of(const experiment::AttachJob& job, const roads::Network& network, const Ground& ground) {
    metrics::RoadLayout layout = road_layout(network, {});
    layout.demand_until_s = ground.end.value;
    return {.context = {.network = network,
                        .random = core::KeyedRandom(core::StudySeed{job.study_seed}, core::Replication{0}),
                        .loop = experiment::loop_config(job.condition),
                        .siren = {}},
            .layout = std::move(layout),
            .horizon = ground.end};
}

}  // namespace

core::ExitCode run_attached(experiment::AttachJob job) {
    const auto started = std::chrono::steady_clock::now();
    sumo::RemoteSumo sumo(job.host, job.port);
    const Ground ground = ground_of(sumo, job);
    for (const std::string& type : job.automated)
        sumo.declare(type, traffic::VehicleClass::automated);
    for (const std::string& type : job.emergency)
        sumo.declare(type, traffic::VehicleClass::emergency);
    if (has_sublanes(sumo)) job.condition.traffic_model = experiment::TrafficModel::sublane;
    const roads::Network network = roads::Network::read(ground.network_file, ground.additional_files);
    const results::Store store = results::Store::create(job.output, manifest_of(job, ground.network_file));

    sumo::Session session(std::move(sumo), job.output / "logs", names_of(network));
    metrics::Recorder recorder;
    ClosedLoop loop(session, recorder);
    const metrics::LeaseTotals leases =
        run_condition(loop, recorder, job.condition, stage_of(job, network, ground));

    metrics::RunEnd end{.tripinfo_files = {ground.trip_file},
                        .planned = {},
                        .time = session.time(),
                        .horizon = std::max(session.time(), ground.end),
                        .leases = leases};
    session.close();
    end.planned = metrics::planned_in(ground.trip_file, session.roster());
    const results::ScenarioEntry& entry = store.manifest().scenarios.front();
    experiment::Provenance provenance = own_provenance();
    provenance.configuration_hash = entry.configuration_hash;
    provenance.study_seed = job.study_seed;
    const results::RunTiming timing = timing_of(loop.timing(), started);
    store.write(record_of({entry.name, job.condition.name, 0}, job.condition, std::move(provenance),
                          recorder.finish(end)),
                timing);
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
