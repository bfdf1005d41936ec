#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/process.hpp"
#include "scenario_import/import.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::scenario_import {

/// A map as text: five by five crossings, `spacing` degrees apart, joined by streets of class `highway`, with
/// a hospital and a fire station beside crossings. `longitude` is that of the western edge.
inline std::string town_map(double longitude = 13.0, double latitude = 51.0,
                            const char* highway = "secondary", double spacing = 0.002) {
    constexpr int side = 5;
    std::string xml = "<?xml version='1.0' encoding='UTF-8'?>\n<osm version='0.6'>\n";
    const auto node = [&](int row, int column) { return 1 + row * side + column; };
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            xml += fmt::format("<node id='{}' version='1' lat='{:.6f}' lon='{:.6f}'>{}</node>\n",
                               node(row, column), latitude + row * spacing, longitude + column * spacing,
                               row == 2 && column == 2 ? "<tag k='highway' v='traffic_signals'/>" : "");
    xml += fmt::format(
        "<node id='100' version='1' lat='{:.6f}' lon='{:.6f}'><tag k='amenity' v='hospital'/>"
        "<tag k='name' v='St. &quot;Anna&quot; &lt;Klinik&gt;'/></node>\n",
        latitude + 0.0001, longitude + 0.0001);
    xml += fmt::format("<node id='101' version='1' lat='{:.6f}' lon='{:.6f}'/>\n", latitude + 4 * spacing,
                       longitude + 4 * spacing + 0.0002);
    int id = 1000;
    const auto way = [&](const std::string& nodes, const std::string& tags) {
        xml += fmt::format("<way id='{}' version='1'>{}{}</way>\n", id++, nodes, tags);
    };
    for (int line = 0; line < side; ++line) {
        std::string row, column;
        for (int at = 0; at < side; ++at) {
            row += fmt::format("<nd ref='{}'/>", node(line, at));
            column += fmt::format("<nd ref='{}'/>", node(at, line));
        }
        const std::string tags =
            fmt::format("<tag k='highway' v='{}'/><tag k='name' v='Straße {}'/>", highway, line);
        way(row, tags);
        way(column, tags);
    }
    way("<nd ref='101'/><nd ref='25'/>", "<tag k='amenity' v='fire_station'/>");
    return xml + "</osm>\n";
}

/// A straight road of two edges of 600 m, `first` and `second`, and `side`, to which nothing leads.
inline std::string line_nodes() {
    return "<nodes><node id='a' x='0' y='0'/><node id='b' x='600' y='0'/><node id='c' x='1200' y='0'/>"
           "<node id='d' x='600' y='300'/></nodes>\n";
}
inline std::string line_edges() {
    return "<edges><edge id='first' from='a' to='b' numLanes='2' speed='20'/>"
           "<edge id='second' from='b' to='c' numLanes='2' speed='20'/>"
           "<edge id='side' from='d' to='b' numLanes='1' speed='20'/></edges>\n";
}

/// A test in a folder of its own. Every import is expected to leave nothing behind but what it makes.
class ImportTest : public testing::Test {
  protected:
    void SetUp() override {
        setenv("SUMO_HOME", "/usr/share/sumo", 0);
        setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1);
        std::filesystem::create_directories(out());
    }

    std::filesystem::path out() const { return folder_.path() / "out"; }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((folder_.path() / name).parent_path());
        return folder_.write(name, text);
    }
    const std::filesystem::path& folder() const { return folder_.path(); }

    ImportRequest request(std::vector<std::filesystem::path> files, const std::string& name = "town") const {
        ImportRequest made;
        made.files = std::move(files);
        made.folder = out() / name;
        return made;
    }
    static Findings run(const ImportRequest& made) {
        return import(made, [](const std::string&, double) {});
    }

    /// The message with which an import is refused; nothing is left behind.
    std::string refusal(const ImportRequest& made) const {
        std::string message;
        try {
            run(made);
            ADD_FAILURE() << "was imported";
        } catch (const core::InputError& error) {
            message = error.what();
        }
        EXPECT_TRUE(std::filesystem::is_empty(out())) << "something is left behind after: " << message;
        return message;
    }

    /// `line.net.xml`, made by netconvert.
    std::filesystem::path line_network() const {
        const auto nodes = write("line.nod.xml", line_nodes());
        const auto edges = write("line.edg.xml", line_edges());
        run_tool("netconvert", {"--node-files", nodes.string(), "--edge-files", edges.string(),
                                "--output-file", (folder() / "line.net.xml").string()});
        return folder() / "line.net.xml";
    }
    void run_tool(const std::string& program, std::vector<std::string> arguments) const {
        core::Command command;
        command.program = program;
        command.arguments = std::move(arguments);
        command.output = folder() / "tool.log";
        ASSERT_TRUE(core::run(command).ok()) << core::read_file(command.output);
    }

  private:
    support::TemporaryFolder folder_;
};

}  // namespace clearway::scenario_import
