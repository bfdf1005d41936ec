#include "loop/attached_run.hpp"

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
#include "experiment/attach_order.hpp"
#include "loop/closed_loop.hpp"
#include "loop/machinery.hpp"
#include "loop/road_layout.hpp"
#include "results/store.hpp"
#include "sensing/failure_config.hpp"

namespace clearway::loop {
namespace {

constexpr const char* scenario_name = "attached";

/// A file that SUMO names in an option. It runs in a folder that nobody knows, perhaps on another machine.
std::filesystem::path file_of(const sumo::RemoteSumo& sumo, const std::string& option,
                              const std::string& cure) {
    const std::filesystem::path file = sumo.option(option);
    if (file.empty())
        throw core::InputError({fmt::format("--{} of that SUMO", option), "is not set", "a file", cure});
    if (std::filesystem::is_regular_file(file)) return std::filesystem::absolute(file);
    throw core::InputError({fmt::format("--{} of that SUMO", option),
                            fmt::format("names {}, which is no file here", file.string()),
                            "a file that this machine sees, by its whole path", cure});
}

/// Signal programs stand in them. A signal whose program is in none of those that this machine
/// sees is given back to it by way of all red.
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

results::Manifest manifest_of(const experiment::AttachOrder& order, const std::filesystem::path& network) {
    results::ScenarioEntry entry{
        .name = scenario_name,
        .version = "as it ran",
        .title = fmt::format("the simulation at {}:{}", order.host, order.port),
        .configuration = fmt::format("network = \"{}\"\nnetwork_hash = \"{}\"\n", network.string(),
                                     core::content_hash(core::read_file(network))),
        .configuration_hash = {},
        .attribution = {}};
    entry.configuration_hash = core::content_hash(entry.configuration);
    results::Manifest manifest;
    manifest.study = scenario_name;
    manifest.clearway_version = CLEARWAY_VERSION;
    manifest.sumo_version = sumo::version();
    manifest.study_seed = order.study_seed;
    manifest.replications = 1;
    manifest.scenarios = {std::move(entry)};
    manifest.conditions = {order.condition};
    return manifest;
}

/// The files of a simulation, found before anything in it is touched.
struct Ground {
    std::filesystem::path network_file;
    std::vector<std::filesystem::path> additional_files;  ///< That this machine sees.
    std::filesystem::path trip_file;
    core::Seconds end;
};

Ground ground_of(const sumo::RemoteSumo& sumo, const experiment::AttachOrder& order) {
    Ground ground;
    ground.network_file =
        order.network.empty() ? file_of(sumo, "net-file", "Give the file with --network") : order.network;
    ground.additional_files = additional_files_of(sumo);
    ground.trip_file = file_of(sumo, "tripinfo-output",
                               "Start SUMO with --tripinfo-output FILE: times and losses come from it");
    ground.end = end_of(sumo);
    return ground;
}

}  // namespace

core::ExitCode run_attached(const std::filesystem::path& order_file) {
    experiment::AttachOrder order = experiment::read_attach_order(order_file);
    const auto started = std::chrono::steady_clock::now();
    sumo::RemoteSumo sumo(order.host, order.port);
    const Ground ground = ground_of(sumo, order);
    for (const std::string& type : order.automated)
        sumo.declare(type, traffic::VehicleClass::automated);
    for (const std::string& type : order.emergency)
        sumo.declare(type, traffic::VehicleClass::emergency);
    if (has_sublanes(sumo)) order.condition.engine = experiment::Engine::sublane;
    const roads::Network network = roads::Network::read(ground.network_file, ground.additional_files);
    const results::Store store =
        results::Store::create(order.output, manifest_of(order, ground.network_file));

    sumo::Session session(std::move(sumo), order.output / "logs", names_of(network));
    metrics::Recorder recorder(metrics::RecorderConfig::of_latency(
        core::Seconds(sensing::failure_from(order.condition.failure).latency_s)));
    metrics::RoadLayout layout = road_layout(network, {});
    layout.demand_until_s = ground.end.value;
    recorder.watch(std::move(layout));
    const Surroundings surroundings{
        .network = network,
        .random = core::KeyedRandom(core::StudySeed{order.study_seed}, core::Replication{0}),
        .loop = loop_config_of(order.condition),
        .siren = {}};
    ClosedLoop loop(session, make_machinery(order.condition, surroundings), surroundings.loop, recorder);
    loop.run(ground.end);

    metrics::RunEnd end{.tripinfo_files = {ground.trip_file},
                        .planned = {},
                        .time = session.time(),
                        .horizon = std::max(session.time(), ground.end),
                        .leases = totals_of(loop.actuator())};
    session.close();
    end.planned = metrics::planned_in(ground.trip_file, session.roster());
    metrics::RunSummary summary = recorder.finish(end);
    const results::ScenarioEntry& entry = store.manifest().scenarios.front();
    results::RunTiming timing;
    timing.simulator_s = loop.timing().simulator_s;
    timing.coupling_s = loop.timing().coupling_s;
    timing.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    store.write({.key = {entry.name, order.condition.name, 0},
                 .condition = order.condition,
                 .provenance = {.clearway_version = CLEARWAY_VERSION,
                                .sumo_version = sumo::version(),
                                .configuration_hash = entry.configuration_hash,
                                .demand_hash = {},
                                .study_seed = order.study_seed,
                                .simulator_seed = 0,
                                .trace_hash = summary.trace_hash},
                 .metrics = summary.metrics,
                 .vehicles = std::move(summary.vehicles),
                 .traffic = std::move(summary.traffic),
                 .leases = std::move(summary.leases)},
                timing);
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
