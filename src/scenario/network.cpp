#include "scenario/network.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "core/open_file.hpp"
#include "core/running_hash.hpp"
#include "core/units.hpp"
#include "scenario/detail/netconvert.hpp"
#include "scenario/detail/network_sources.hpp"
#include "scenario/mean_times.hpp"
#include "scenario/network_document.hpp"
#include "scenario/preemption.hpp"

namespace clearway::scenario {

namespace {

constexpr const char* network_name = "network.net.xml";
constexpr const char* network_hash_name = "network.hash";

/// The key that messages about the network's sources point to.
std::string source_place(const ScenarioConfig& config) {
    return config.where(config.network.plain() ? "network.edges" : "network.file");
}

std::vector<std::string> plain_arguments(const ScenarioConfig& config) {
    const NetworkSource& source = config.network;
    std::vector<std::string> arguments = {"--no-turnarounds", "true"};
    // Sidewalks at roads of any speed, because crossings at signals need them. Netconvert builds no crossings
    // over fast roads without a signal, and it adds the pedestrian phases to the programs.
    if (config.pedestrians.walk())
        arguments.insert(arguments.end(), {"--sidewalks.guess", "true", "--sidewalks.guess.max-speed", "1000",
                                           "--crossings.guess", "true"});
    for (const auto& [option, file] :
         {std::pair{"--node-files", &source.nodes}, std::pair{"--edge-files", &source.edges},
          std::pair{"--connection-files", &source.connections},
          std::pair{"--tllogic-files", &source.signals}}) {
        if (file->empty()) continue;
        arguments.insert(arguments.end(), {option, resolve(config, *file).string()});
    }
    return arguments;
}

std::string kept_edges(const ScenarioConfig& config, const roads::Network& network) {
    std::string text;
    for (const core::EdgeIndex edge : roads::largest_car_component(network))
        text += network.edge(edge).id + "\n";
    if (text.empty())
        throw core::InputError(core::Problem{source_place(config), "has no edge that cars may use",
                                             "a network with roads", "choose another network"});
    return text;
}

/// Lets netconvert reduce the network in `raw` to its largest car-connected component.
void restrict_network(const ScenarioConfig& config, const std::filesystem::path& folder,
                      const std::filesystem::path& raw) {
    const std::filesystem::path kept = folder / "kept_edges.txt";
    const std::filesystem::path whole = folder / "whole.net.xml";
    std::filesystem::rename(raw, whole);
    core::write_atomically(kept, kept_edges(config, detail::read_made(config, whole)));
    detail::run_netconvert(config,
                           {"--sumo-net-file", whole.string(), "--keep-edges.input-file", kept.string(),
                            "--output-file", raw.string()},
                           folder);
    std::filesystem::remove(whole);
}

/// Multiplies the speed limits of the lanes by the factor of their edge; edges inside junctions get the
/// factor of all roads. Throws core::InputError for stretches over edges that the network does not have.
void slow_down(const ScenarioConfig& config, NetworkDocument& document) {
    const RoadCondition& road = config.road;
    std::map<std::string, double> own;
    std::vector<core::Problem> problems;
    const std::set<std::string> known = document.edges();
    for (const Stretch& stretch : road.stretches) {
        for (const std::string& edge : stretch.edges) {
            own[edge] = stretch.speed_factor;
            if (known.contains(edge)) continue;
            problems.push_back({config.where(fmt::format("road.stretch.{}.edges", stretch.name)),
                                fmt::format("the network has no edge '{}'", edge), "ids of its edges",
                                core::did_you_mean(edge, {known.begin(), known.end()})});
        }
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    document.scale_speeds([&](const std::string& edge) {
        const auto found = own.find(edge);
        return found == own.end() ? road.speed_factor : found->second;
    });
}

std::string hash_of_inputs(const ScenarioConfig& config) {
    const NetworkSource& source = config.network;
    std::string bytes =
        fmt::format("restrict={} road_kmh={}\n", static_cast<int>(source.restrict), config.limits.road_kmh);
    if (config.road.changes_limits()) {
        bytes += fmt::format("road {}\n", config.road.speed_factor);
        for (const Stretch& stretch : config.road.stretches)
            bytes += fmt::format("{} {}\n", stretch.speed_factor, fmt::join(stretch.edges, " "));
    }
    if (config.pedestrians.walk()) bytes += "pedestrians\n";
    for (const std::string& file :
         {source.nodes, source.edges, source.connections, source.signals, source.file})
        if (!file.empty()) bytes += core::read_file(resolve(config, file)) + "\n";
    return core::content_hash(bytes);
}

/// Netconvert and SUMO read names in UTF-8 alone.
void require_utf8(const std::filesystem::path& folder) try {
    (void)core::Json(std::filesystem::absolute(folder).string()).dump();
} catch (const core::Json::exception&) {
    throw core::InputError({folder.string(),
                            "has letters in its path that are not UTF-8, which SUMO cannot read",
                            "a path in UTF-8", "Choose another folder"});
}

}  // namespace

BuiltNetwork build_network(const ScenarioConfig& config, const std::filesystem::path& folder) {
    require_utf8(folder);
    core::make_folder(folder);
    const std::filesystem::path raw = folder / "raw.net.xml";
    const bool is_taken_whole = !config.network.plain() && config.network.restrict == Restriction::none;
    if (config.network.plain()) {
        detail::check_sources(config);
        std::vector<std::string> arguments = plain_arguments(config);
        arguments.insert(arguments.end(), {"--output-file", raw.string()});
        detail::run_netconvert(config, arguments, folder);
    } else if (!is_taken_whole) {
        core::write_atomically(
            raw, NetworkDocument(resolve(config, config.network.file)).without_newer_classes().text());
        restrict_network(config, folder, raw);
    }
    // Large networks are parsed once where that is enough.
    NetworkDocument document(is_taken_whole ? resolve(config, config.network.file) : raw);
    if (is_taken_whole) document.without_newer_classes();
    document.name_controllers();
    if (config.limits.road_kmh > 0.0) document.limit_speed(core::from_kmh(config.limits.road_kmh));
    if (config.road.changes_limits()) slow_down(config, document);
    const std::string text = document.text();
    core::write_atomically(folder / network_hash_name, core::content_hash(text));
    core::write_atomically(folder / network_name, text);
    std::filesystem::remove(raw);
    return open_network(config, folder);
}

void require_unchanged_network(const std::filesystem::path& folder) {
    const std::filesystem::path made = folder / network_hash_name;
    const std::filesystem::path file = folder / network_name;
    if (!std::filesystem::exists(folder)) return;
    if (!std::filesystem::exists(made))
        throw core::InputError(
            {made.string(), "is missing, so that nobody can tell whether the network is whole", "",
             fmt::format("Put it back, or remove {}: it is made again", folder.parent_path().string())});
    core::RunningHash hash;
    core::OpenFile(file).read([&](std::string_view piece) { hash.add(piece); });
    if (hash.digest() == core::read_file(made)) return;
    throw core::InputError(
        {file.string(), "was changed since it was built", "",
         fmt::format("Put it back, or remove {}: it is made again", folder.parent_path().string())});
}

BuiltNetwork open_network(const ScenarioConfig& config, const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / network_name;
    BuiltNetwork built{file, detail::read_made(config, file, additional_files(config)),
                       hash_of_inputs(config)};
    std::vector<core::Problem> problems;
    if (!config.network.preemption.empty()) {
        const std::filesystem::path parameters = resolve(config, config.network.preemption);
        const PreemptionRows rows = read_preemption_rows(parameters, problems);
        if (problems.empty()) built.preemption = preemption_of(rows, parameters, built.network);
    }
    if (!config.network.mean_times.empty()) {
        const std::filesystem::path times = resolve(config, config.network.mean_times);
        const MeanTimes read = read_mean_times(times, problems);
        if (problems.empty())
            built.mean_times_s = mean_times_of(read, times, built.network, built.inputs_hash);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return built;
}

std::vector<WideEdge> wide_edges(const roads::Network& network, int lanes) {
    std::vector<WideEdge> result;
    for (const roads::Edge& edge : network.edges()) {
        if (edge.internal) continue;
        const auto row = network.lanes().subspan(edge.first_lane, edge.lane_count);
        const auto count =
            std::count_if(row.begin(), row.end(), [](const roads::Lane& lane) { return lane.allows_cars; });
        if (count >= lanes) result.push_back({edge.id, edge.name, static_cast<int>(count)});
    }
    std::sort(result.begin(), result.end(), [](const WideEdge& a, const WideEdge& b) { return a.id < b.id; });
    return result;
}

}  // namespace clearway::scenario
