#include "scenario/network.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/process.hpp"
#include "core/units.hpp"

namespace clearway::scenario {

namespace {

constexpr const char* network_name = "network.net.xml";
constexpr int shown_log_lines = 8;

/// Where the messages of a problem with the network's sources point to.
std::string source_place(const ScenarioConfig& config) {
    return config.where(config.network.plain() ? "network.edges" : "network.file");
}

void run_netconvert(const ScenarioConfig& config, std::vector<std::string> arguments,
                    const std::filesystem::path& folder) {
    arguments.insert(arguments.end(), {"--xml-validation", "never"});
    core::Command command;
    command.program = "netconvert";
    command.arguments = std::move(arguments);
    command.output = folder / "netconvert.log";
    const core::Exit exit = core::run(command);
    constexpr int not_found = 127;
    if (exit.code == not_found)
        throw core::EnvironmentError("netconvert does not start. Install package sumo");
    if (!exit.ok())
        throw core::InputError(core::Problem{
            source_place(config),
            fmt::format("netconvert refuses this network ({}):\n{}", exit.describe(),
                        core::tail(command.output, shown_log_lines)),
            "", fmt::format("correct the file that it names; the whole log is {}", command.output.string())});
}

std::vector<std::string> plain_arguments(const ScenarioConfig& config) {
    const NetworkSource& source = config.network;
    std::vector<std::string> arguments = {"--no-turnarounds", "true"};
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

std::vector<std::string> import_arguments(const ScenarioConfig& config, const std::filesystem::path& folder) {
    const std::filesystem::path source = resolve(config, config.network.file);
    std::vector<std::string> arguments = {"--sumo-net-file", source.string()};
    if (config.network.restrict == Restriction::largest_car_component) {
        const std::filesystem::path kept = folder / "kept_edges.txt";
        core::write_atomically(kept, kept_edges(config, roads::Network::read(source)));
        arguments.insert(arguments.end(), {"--keep-edges.input-file", kept.string()});
    }
    return arguments;
}

/// A patch for netconvert that limits every faster lane, or empty when no lane is faster.
std::string limit_patch(const roads::Network& network, core::MetresPerSecond limit) {
    std::string xml;
    for (const roads::Edge& edge : network.edges()) {
        if (edge.internal) continue;
        const auto lanes = network.lanes().subspan(edge.first_lane, edge.lane_count);
        const auto faster = [&](const roads::Lane& lane) { return lane.speed_limit_mps > limit.value; };
        if (std::none_of(lanes.begin(), lanes.end(), faster)) continue;
        xml += fmt::format("    <edge id=\"{}\">\n", edge.id);
        for (const roads::Lane& lane : lanes)
            xml += fmt::format("        <lane index=\"{}\" speed=\"{:.2f}\"/>\n", lane.number,
                               std::min<double>(lane.speed_limit_mps, limit.value));
        xml += "    </edge>\n";
    }
    return xml.empty() ? xml : "<edges>\n" + xml + "</edges>\n";
}

/// Without the comment in which netconvert notes time, options and paths.
std::string without_comment(const std::string& xml) {
    const std::size_t start = xml.find("<!--");
    const std::size_t end = xml.find("-->");
    if (start == std::string::npos || end == std::string::npos) return xml;
    return xml.substr(0, start) + xml.substr(xml.find_first_not_of("\n", end + 3));
}

std::string hash_of_inputs(const ScenarioConfig& config) {
    const NetworkSource& source = config.network;
    std::string bytes =
        fmt::format("restrict={} road_kmh={}\n", static_cast<int>(source.restrict), config.limits.road_kmh);
    for (const std::string& file :
         {source.nodes, source.edges, source.connections, source.signals, source.file})
        if (!file.empty()) bytes += core::read_file(resolve(config, file)) + "\n";
    return core::content_hash(bytes);
}

void limit_roads(const ScenarioConfig& config, const std::filesystem::path& folder,
                 const std::filesystem::path& raw) {
    const std::string patch = limit_patch(roads::Network::read(raw), core::from_kmh(config.limits.road_kmh));
    if (patch.empty()) return;
    const std::filesystem::path patch_file = folder / "road_limit.edg.xml";
    const std::filesystem::path limited = folder / "limited.net.xml";
    core::write_atomically(patch_file, patch);
    run_netconvert(config,
                   {"--sumo-net-file", raw.string(), "--edge-files", patch_file.string(), "--output-file",
                    limited.string()},
                   folder);
    std::filesystem::rename(limited, raw);
}

}  // namespace

BuiltNetwork build_network(const ScenarioConfig& config, const std::filesystem::path& folder) {
    core::make_folder(folder);
    const std::filesystem::path raw = folder / "raw.net.xml";
    std::vector<std::string> arguments =
        config.network.plain() ? plain_arguments(config) : import_arguments(config, folder);
    arguments.insert(arguments.end(), {"--output-file", raw.string()});
    run_netconvert(config, arguments, folder);
    if (config.limits.road_kmh > 0.0) limit_roads(config, folder, raw);
    core::write_atomically(folder / network_name, without_comment(core::read_file(raw)));
    std::filesystem::remove(raw);
    return open_network(config, folder);
}

BuiltNetwork open_network(const ScenarioConfig& config, const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / network_name;
    return {file, roads::Network::read(file), hash_of_inputs(config)};
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
