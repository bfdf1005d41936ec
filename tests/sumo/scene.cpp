#include "sumo/scene.hpp"

#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/files.hpp"
#include "core/process.hpp"

namespace clearway::test {
namespace {

void netconvert(const std::filesystem::path& nodes, const std::filesystem::path& edges,
                const std::filesystem::path& network) {
    const core::Exit exit =
        core::run({.program = "netconvert",
                   .arguments = {"--node-files", nodes, "--edge-files", edges, "--output-file", network,
                                 "--no-turnarounds", "--xml-validation", "never"},
                   .environment = {},
                   .output = network.string() + ".log"});
    if (!exit.ok()) throw std::runtime_error("netconvert: " + exit.describe());
}

std::string edge(const std::string& id, const std::string& from, const std::string& to) {
    return fmt::format(R"(<edge id="{}" from="{}" to="{}" numLanes="2" speed="13.89"/>)", id, from, to);
}

}  // namespace

std::filesystem::path Scene::write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text);
}

std::filesystem::path Scene::straight_road() const {
    const auto nodes =
        write("road.nod.xml", R"(<nodes><node id="w" x="0" y="0"/><node id="m" x="500" y="0"/>)"
                              R"(<node id="e" x="1000" y="0"/></nodes>)");
    const auto edges =
        write("road.edg.xml", "<edges>" + edge("in", "w", "m") + edge("out", "m", "e") + "</edges>");
    netconvert(nodes, edges, folder() / "road.net.xml");
    return folder() / "road.net.xml";
}

std::filesystem::path Scene::two_way_road() const {
    const auto nodes =
        write("two_way.nod.xml", R"(<nodes><node id="w" x="0" y="0"/><node id="e" x="2000" y="0"/></nodes>)");
    const auto one_lane = [](const char* id, const char* from, const char* to, const char* beside) {
        return fmt::format(
            R"(<edge id="{}" from="{}" to="{}" numLanes="1" speed="27.78"><lane index="0"><neigh lane="{}_0"/></lane></edge>)",
            id, from, to, beside);
    };
    const auto edges = write("two_way.edg.xml", "<edges>" + one_lane("east", "w", "e", "west") +
                                                    one_lane("west", "e", "w", "east") + "</edges>");
    netconvert(nodes, edges, folder() / "two_way.net.xml");
    return folder() / "two_way.net.xml";
}

std::filesystem::path Scene::crossing() const {
    const auto nodes = write("crossing.nod.xml",
                             R"(<nodes><node id="c" x="0" y="0" type="traffic_light"/>)"
                             R"(<node id="west" x="-200" y="0"/><node id="east" x="200" y="0"/>)"
                             R"(<node id="south" x="0" y="-200"/><node id="north" x="0" y="200"/></nodes>)");
    std::string edges;
    for (const std::string arm : {"west", "east", "south", "north"}) {
        edges += edge(arm + "_in", arm, "c") + edge(arm + "_out", "c", arm);
    }
    netconvert(nodes, write("crossing.edg.xml", "<edges>" + edges + "</edges>"),
               folder() / "crossing.net.xml");
    return folder() / "crossing.net.xml";
}

std::filesystem::path Scene::types() const {
    return write("types.add.xml", R"(<additional>
<vType id="hv" length="5" width="1.8" minGap="2.5" maxSpeed="50" accel="2.6" decel="4.5" emergencyDecel="9"
       carFollowModel="Krauss" sigma="0" speedDev="0"/>
<vType id="av" length="4.5" minGap="2" maxSpeed="40" carFollowModel="IDM" speedDev="0" speedFactor="1.1">
    <param key="clearway.class" value="automated"/><param key="clearway.kind" value="van"/></vType>
<vType id="ev" length="6.5" vClass="emergency" carFollowModel="IDM" speedDev="0" jmDriveRedSpeed="5">
    <param key="clearway.class" value="emergency"/><param key="clearway.kind" value="ambulance"/></vType>
</additional>)");
}

std::filesystem::path Scene::routes(const std::string& vehicles) const {
    return write("routes.rou.xml", "<routes>" + vehicles + "</routes>");
}

sumo::SessionConfig Scene::config(const std::filesystem::path& network, const std::string& vehicles) const {
    sumo::SessionConfig config;
    config.network = network;
    config.additional_files = {types()};
    config.route_files = {routes(vehicles)};
    config.folder = folder() / "run";
    config.names = read_names(network);
    return config;
}

std::string vehicle(const std::string& id, const std::string& type, double depart_s, const std::string& edges,
                    const std::string& attributes) {
    return fmt::format(R"(<vehicle id="{}" type="{}" depart="{}" {}><route edges="{}"/></vehicle>)", id, type,
                       depart_s, attributes, edges);
}

void step_until(sumo::Session& session, double time_s) {
    while (session.time().value < time_s - 1e-9) {
        session.step();
    }
}

std::string text_without_date(const std::filesystem::path& file) {
    constexpr std::string_view before = "generated on ";
    constexpr std::string_view form = "2000-01-01 00:00:00";
    std::string text = core::read_file(file);
    if (const std::size_t at = text.find(before); at != std::string::npos)
        text.erase(at + before.size(), form.size());
    return text;
}

}  // namespace clearway::test
