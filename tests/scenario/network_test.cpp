#include "scenario/network.hpp"

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <zlib.h>

#include "core/files.hpp"
#include "roads/crossings.hpp"
#include "scenario/detail/library.hpp"
#include "scenario/detail/netconvert.hpp"
#include "scenario/network_document.hpp"
#include "scenario/road_limits.hpp"
#include "scenario/written_files.hpp"
#include "scratch.hpp"

namespace clearway::scenario {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class BuiltNetworks : public ScratchTest {
  protected:
    BuiltNetwork built(const std::string& name, const Options& options = {}) const {
        return build_network(load(name, options), folder() / name);
    }
    static std::size_t signals(const roads::Network& network) { return network.signals().size(); }
    static const roads::Edge& edge(const roads::Network& network, const std::string& id) {
        return network.edge(network.find_edge(id).value());
    }
    static float fastest_lane_mps(const roads::Network& network) {
        float fastest = 0.0F;
        for (const roads::Lane& lane : network.lanes())
            if (!network.edge(lane.edge).internal) fastest = std::max(fastest, lane.speed_limit_mps);
        return fastest;
    }
};

TEST_F(BuiltNetworks, merge_has_two_three_and_two_lanes) {
    const BuiltNetwork built_network = built("merge");
    const roads::Network& network = built_network.network;
    EXPECT_EQ(edge(network, "main_in").lane_count, 2U);
    EXPECT_EQ(edge(network, "merge").lane_count, 3U);
    EXPECT_EQ(edge(network, "main_out").lane_count, 2U);
    EXPECT_EQ(edge(network, "ramp").lane_count, 1U);
    const auto right = network.lane_of(*network.find_edge("merge"), 0);
    EXPECT_TRUE(network.connections_from(right).empty()) << "the right lane of the merge section ends";
    const auto ramp = network.lane_of(*network.find_edge("ramp"), 0);
    ASSERT_EQ(network.connections_from(ramp).size(), 1U);
    EXPECT_EQ(network.connections_from(ramp)[0].to, right);
    EXPECT_NEAR(network.lane(ramp).speed_limit_mps, 100 / 3.6, 0.01);
    EXPECT_NEAR(network.lane(right).speed_limit_mps, 140 / 3.6, 0.01);
}

TEST_F(BuiltNetworks, merge_measures_one_kilometre_a_quarter_and_one_and_a_quarter) {
    const BuiltNetwork built_network = built("merge");
    const roads::Network& network = built_network.network;
    const auto via_m = [&](const char* id) {
        const auto connections = network.connections_from(network.lane_of(*network.find_edge(id), 1));
        return network.lane(connections[0].via).length_m;
    };
    EXPECT_NEAR(edge(network, "main_in").length_m + via_m("main_in"), 1000.0, 1.0);
    EXPECT_NEAR(edge(network, "merge").length_m + via_m("merge"), 250.0, 5.0);
    EXPECT_NEAR(edge(network, "main_out").length_m, 1250.0, 5.0);
}

TEST_F(BuiltNetworks, intersection_signal_runs_40_5_40_5_with_permissive_left_turns) {
    const BuiltNetwork built_network = built("intersection");
    const roads::Network& network = built_network.network;
    ASSERT_EQ(signals(network), 1U);
    const roads::Signal& signal = network.signals()[0];
    ASSERT_EQ(signal.program.size(), 4U);
    for (const auto& [row, duration_s] : {std::pair{0, 40.0}, {1, 5.0}, {2, 40.0}, {3, 5.0}})
        EXPECT_EQ(signal.program[row].duration_s, duration_s);
    EXPECT_EQ(std::count(signal.program[0].state.begin(), signal.program[0].state.end(), 'g'), 2);
    EXPECT_EQ(std::count(signal.program[0].state.begin(), signal.program[0].state.end(), 'G'), 6);
    // The lower-case green of the first phase belongs to left turns from north and south.
    for (std::size_t link = 0; link < signal.links.size(); ++link) {
        if (signal.program[0].state[link] != 'g') continue;
        const std::string from = network.edge(network.lane(signal.links[link].at(0).from).edge).id;
        const std::string to = network.edge(network.lane(signal.links[link].at(0).to).edge).id;
        EXPECT_TRUE((from == "north_in" && to == "east_out") || (from == "south_in" && to == "west_out"))
            << from << " -> " << to;
    }
}

TEST_F(BuiltNetworks, city_is_one_component_and_reports_its_wide_edges) {
    const BuiltNetwork built_network = built("city");
    const roads::Network& network = built_network.network;
    std::size_t car_edges = 0;
    for (const roads::Edge& row : network.edges())
        car_edges += row.internal ? 0 : 1;
    EXPECT_EQ(roads::largest_car_component(network).size(), car_edges);
    EXPECT_EQ(car_edges, 696U) << "740 edges of the source are open to cars, 696 reach each other";
    EXPECT_EQ(signals(network), 13U);
    const auto wide = wide_edges(network);
    EXPECT_FALSE(wide.empty());
    for (const WideEdge& row : wide)
        EXPECT_GE(row.car_lanes, 3);
}

TEST_F(BuiltNetworks, intersection_has_no_wide_edge) {
    EXPECT_TRUE(wide_edges(built("intersection").network).empty());
    EXPECT_EQ(wide_edges(built("merge").network).size(), 1U);
}

TEST_F(BuiltNetworks, road_limit_slows_faster_roads_only_and_keeps_the_signal) {
    Options options;
    options.set("road_limit_kmh", "70");
    const BuiltNetwork slow = built("intersection", options);
    EXPECT_NEAR(fastest_lane_mps(slow.network), 70 / 3.6, 0.01);
    ASSERT_EQ(slow.network.signals().size(), 1U);
    EXPECT_EQ(slow.network.signals()[0].program[0].duration_s, 40.0);
    const BuiltNetwork normal = built("intersection");
    EXPECT_NE(slow.inputs_hash, normal.inputs_hash);
    EXPECT_EQ(slow.network.edges().size(), normal.network.edges().size());
    options.set("road_limit_kmh", "120");
    const BuiltNetwork merge = built("merge", options);
    EXPECT_NEAR(
        merge.network.lane(merge.network.lane_of(*merge.network.find_edge("ramp"), 0)).speed_limit_mps,
        100 / 3.6, 0.01);
}

TEST_F(BuiltNetworks, limits_read_from_the_sources_are_those_of_the_built_network) {
    Options slow;
    slow.set("road_limit_kmh", "70");
    slow.set("road_speed_factor", "0.9");
    for (const char* const name : {"intersection", "merge", "arterial", "grid_signals", "rural", "spider"}) {
        const std::string words = road_limits(load(name)).words();
        EXPECT_EQ(words, roads::limits_of(built(name).network).words()) << name;
        EXPECT_EQ(road_limits(load(name, slow)).words(), roads::limits_of(built(name, slow).network).words());
    }
    EXPECT_EQ(road_limits(load("intersection")).words(), "roads of 140 km/h");
    EXPECT_EQ(road_limits(load("merge")).words(), "roads of 100 to 140 km/h, mostly 140");
    EXPECT_EQ(road_limits(load("bologna")).words(), "roads of 50 km/h") << "read from a network file";
    ScenarioConfig absent = load("merge");
    absent.network.nodes = "absent.nod.xml";
    EXPECT_EQ(road_limits(absent).words(), "");
}

TEST_F(BuiltNetworks, limits_read_from_the_sources_are_those_of_lanes_for_cars) {
    write("line.nod.xml", line_nodes);
    write("line.edg.xml",
          "<edges><edge id=\"road\" from=\"a\" to=\"b\" numLanes=\"2\" speed=\"20\">"
          "<lane index=\"0\" speed=\"10\"/><lane index=\"1\" speed=\"25\"/></edge>"
          "<edge id=\"bus\" from=\"b\" to=\"c\" numLanes=\"2\" speed=\"25\">"
          "<lane index=\"0\" speed=\"30\" allow=\"bus\"/></edge>"
          "<edge id=\"mixed\" from=\"c\" to=\"b\" numLanes=\"2\" speed=\"35\" disallow=\"passenger\">"
          "<lane index=\"1\" speed=\"5\" disallow=\"truck\"/></edge>"
          "<edge id=\"foot\" from=\"d\" to=\"b\" speed=\"2\" allow=\"pedestrian\"/>"
          "<edge id=\"rail\" from=\"b\" to=\"d\" speed=\"50\" disallow=\"all\"/></edges>\n");
    const ScenarioConfig config = load(write("scenario.toml", line_head).string());
    EXPECT_EQ(road_limits(config).words(), "roads of 18 to 90 km/h, mostly 90");
    EXPECT_EQ(road_limits(config).words(),
              roads::limits_of(build_network(config, folder() / "out").network).words());
}

TEST_F(BuiltNetworks, rain_slows_all_roads_and_a_stretch_has_a_factor_of_its_own) {
    ScenarioConfig config = load("merge");
    const BuiltNetwork dry = build_network(config, folder() / "dry");
    config.road.speed_factor = 0.8;
    config.road.stretches = {{"works", 0.5, {"ramp"}}};
    const BuiltNetwork wet = build_network(config, folder() / "wet");
    EXPECT_NE(wet.inputs_hash, dry.inputs_hash);
    ASSERT_EQ(wet.network.lanes().size(), dry.network.lanes().size());
    for (std::size_t row = 0; row < wet.network.lanes().size(); ++row) {
        const roads::Lane& lane = wet.network.lanes()[row];
        const double factor = wet.network.edge(lane.edge).id == "ramp" ? 0.5 : 0.8;
        EXPECT_NEAR(lane.speed_limit_mps, dry.network.lanes()[row].speed_limit_mps * factor, 1e-3) << lane.id;
    }
    config.road = {};
    config.road.friction = 0.5;
    EXPECT_EQ(core::read_file(build_network(config, folder() / "slippery").file), core::read_file(dry.file));
}

TEST_F(BuiltNetworks, pedestrians_bring_the_intersection_four_crossings_with_phases_of_their_own) {
    Options options;
    options.set("pedestrians_per_hour", "100");
    const BuiltNetwork walked = built("intersection", options);
    EXPECT_EQ(roads::crossings(walked.network).size(), 4U);
    const roads::Signal& signal = walked.network.signals()[0];
    EXPECT_EQ(std::count(signal.crossings.begin(), signal.crossings.end(), true), 4);
    ASSERT_EQ(signal.program.size(), 6U);
    EXPECT_EQ(signal.program[0].duration_s + signal.program[1].duration_s, 40.0) << "5 s to clear crossings";
    EXPECT_TRUE(roads::crossings(build_network(load("intersection"), folder() / "plain").network).empty());
}

TEST_F(BuiltNetworks, a_stretch_over_an_unknown_edge_names_the_nearest) {
    write("line.nod.xml", line_nodes);
    write("line.edg.xml", line_edges);
    const std::string road = "[road.stretch.ice]\nspeed_factor = 0.5\nedges = [\"frist\", \"second\"]\n";
    const ScenarioConfig config = load(write("scenario.toml", line_head + road).string());
    const auto problems = problems_of([&] { build_network(config, folder() / "out"); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].where, HasSubstr("scenario.toml:8:1: road.stretch.ice.edges"));
    EXPECT_THAT(problems[0].what, HasSubstr("'frist'"));
    EXPECT_THAT(problems[0].cure, HasSubstr("'first'"));
}

TEST_F(BuiltNetworks, equal_inputs_give_equal_bytes_without_time_or_path) {
    const ScenarioConfig config = load("merge");
    const std::string first = core::read_file(build_network(config, folder() / "first").file);
    const std::string second = core::read_file(build_network(config, folder() / "second").file);
    EXPECT_EQ(first, second);
    EXPECT_THAT(first, Not(HasSubstr("generated on")));
    EXPECT_THAT(first, Not(HasSubstr(folder().string())));
}

TEST_F(BuiltNetworks, what_netconvert_refuses_names_its_reason) {
    write("line.nod.xml", line_nodes);
    write("line.edg.xml",
          "<edges><edge id=\"first\" from=\"a\" to=\"nowhere\" numLanes=\"1\" speed=\"20\"/></edges>");
    const ScenarioConfig config = load(write("scenario.toml", line_head).string());
    const auto problems = problems_of([&] { build_network(config, folder() / "out"); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].where, HasSubstr("scenario.toml:5:1: network.edges"));
    EXPECT_THAT(problems[0].what, HasSubstr("nowhere"));
}

TEST_F(BuiltNetworks, a_network_without_roads_is_refused) {
    write("line.nod.xml", line_nodes);
    write(
        "line.edg.xml",
        "<edges><edge id=\"rail\" from=\"a\" to=\"b\" numLanes=\"1\" speed=\"20\" allow=\"tram\"/></edges>");
    const ScenarioConfig rail = load(write("rail.toml", line_head).string());
    const BuiltNetwork source = build_network(rail, folder() / "rail");
    std::filesystem::copy_file(source.file, folder() / "rail.net.xml");
    const ScenarioConfig config =
        load(write("scenario.toml",
                   "name = \"rail\"\nversion = \"test\"\n[network]\nfile = \"rail.net.xml\"\n"
                   "restrict = \"largest_car_component\"\n")
                 .string());
    const auto problems = problems_of([&] { build_network(config, folder() / "out"); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].what, HasSubstr("no edge that cars may use"));
}

TEST_F(BuiltNetworks, let_sumo_neither_write_nor_include_files) {
    const auto refusal_of = [&](const std::string& content) {
        const auto network = write("w.net.xml", "<net>\n" + content + "</net>");
        const auto additional = write("w.add.xml", "<additional>\n" + content + "</additional>");
        const auto empty = write("empty.xml", "<net/>");
        const auto in_network = problems_of([&] { refuse_written_files(network, {}); });
        const auto in_additional = problems_of([&] { refuse_written_files(empty, {additional}); });
        EXPECT_EQ(in_network.size(), 1U) << content;
        EXPECT_EQ(in_additional.size(), 1U) << content;
        if (in_network.empty() || in_additional.empty()) return std::string("no problem");
        EXPECT_EQ(in_network[0].where, network.string() + ":2");
        EXPECT_EQ(in_additional[0].where, additional.string() + ":2");
        return in_network[0].what;
    };
    for (const char* const element :
         {R"(<e1Detector id="d" lane="a_0" pos="1" period="9" file="diary.txt"/>)",
          R"(<edgeData id="d" file="/home/me/diary.txt"/>)", R"(<edgeData id="d" file="false"/>)",
          R"(<calibrator id="d" edge="a" pos="0" output="diary.txt"/>)",
          R"(<timedEvent type="SaveTLSStates" source="J" dest="diary.txt"/>)",
          R"(<vType id="t"><param key="device.ssm.file" value="diary.txt"/></vType>)",
          R"(<vType id="t"><param key="has.ssm.device" value="true"/></vType>)",
          R"(<tlLogic id="J"><param key="file" value="diary.txt"/></tlLogic>)"})
        EXPECT_THAT(refusal_of(element), HasSubstr("lets SUMO write files"));
    EXPECT_THAT(refusal_of(R"(<include href="more.xml"/>)"), HasSubstr("<include> of \"more.xml\""));
}

TEST_F(BuiltNetworks, may_name_files_that_sumo_does_not_write) {
    const auto file =
        write("w.net.xml", R"(<net><e1Detector id="d" file="NUL"/><rerouter id="r" file="times.xml"/>)"
                           R"(<poi id="p"><param key="file" value="picture.png"/></poi>)"
                           R"(<vType id="t"><param key="has.ssm.device" value="false"/></vType></net>)");
    EXPECT_NO_THROW(refuse_written_files(file, {file}));
}

/// A network file of two edges as a newer netconvert would write it, compressed.
class ImportedNetworks : public BuiltNetworks {
  protected:
    void SetUp() override {
        BuiltNetworks::SetUp();
        write("line.nod.xml", line_nodes);
        write("line.edg.xml", line_edges);
        const ScenarioConfig plain = load(write("line.toml", line_head).string());
        text_ = core::read_file(build_network(plain, folder() / "line").file);
    }
    ScenarioConfig imported(const std::string& file, const std::string& rest = "") const {
        return load(write("scenario.toml",
                          "name = \"x\"\nversion = \"test\"\n[network]\nfile = \"" + file + "\"\n" + rest)
                        .string());
    }
    void write_compressed(const std::string& name, const std::string& bytes) const {
        const gzFile stream = gzopen((folder() / name).c_str(), "wb");
        gzwrite(stream, bytes.data(), static_cast<unsigned>(bytes.size()));
        gzclose(stream);
    }
    std::string text_;
};

TEST_F(ImportedNetworks, a_compressed_file_with_newer_vehicle_classes_becomes_readable) {
    std::string newer = text_;
    const std::string lane = "<lane id=\"side_0\"";
    newer.replace(newer.find(lane), lane.size(), lane + " allow=\"cable_car drone\"");
    const std::string other = "<lane id=\"second_0\"";
    newer.replace(newer.find(other), other.size(), other + " disallow=\"tram aircraft\"");
    write_compressed("newer.net.xml.gz", newer);
    const BuiltNetwork built_network = build_network(imported("newer.net.xml.gz"), folder() / "out");
    const roads::Network& network = built_network.network;
    EXPECT_FALSE(network.lane(network.lane_of(*network.find_edge("side"), 0)).allows_cars)
        << "a lane for cable cars alone is no lane for all";
    EXPECT_TRUE(network.lane(network.lane_of(*network.find_edge("second"), 0)).allows_cars);
    const std::string text = core::read_file(built_network.file);
    EXPECT_THAT(text, Not(HasSubstr("cable_car")));
    EXPECT_THAT(text, HasSubstr("disallow=\"tram\""));
}

TEST_F(ImportedNetworks, lengths_are_those_of_the_file) {
    write("same.net.xml", text_);
    const BuiltNetwork built_network = build_network(imported("same.net.xml"), folder() / "out");
    EXPECT_EQ(core::read_file(built_network.file), text_);
}

TEST_F(ImportedNetworks, signal_programs_write_no_detector_files) {
    const auto junction = text_.find("<junction");
    const std::string program = R"(<tlLogic id="c" type="actuated" programID="0" offset="0">
        <phase duration="30" state="G"/><param key="file" value="diary.txt"/><param key="freq" value="9"/></tlLogic>)";
    write("own.net.xml", std::string(text_).insert(junction, program));
    const NetworkDocument document(folder() / "own.net.xml");
    EXPECT_THAT(document.text(), AllOf(Not(HasSubstr("diary.txt")), HasSubstr("freq")));
}

TEST_F(ImportedNetworks, without_its_hash_a_built_network_is_not_taken_for_whole) {
    const auto folder = this->folder() / "line";
    EXPECT_NO_THROW(require_unchanged_network(folder));
    std::filesystem::remove(folder / "network.hash");
    const auto problems = problems_of([&] { require_unchanged_network(folder); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].where, HasSubstr("network.hash"));
    EXPECT_THAT(problems[0].cure, HasSubstr("remove " + this->folder().string() + ":"));
    EXPECT_NO_THROW(require_unchanged_network(this->folder() / "none"));
}

TEST_F(ImportedNetworks, a_file_cut_short_is_refused) {
    write("short.net.xml", text_.substr(0, text_.size() / 2));
    const auto problems = problems_of([&] { build_network(imported("short.net.xml"), folder() / "out"); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].where, HasSubstr("short.net.xml"));
    EXPECT_THAT(problems[0].what, HasSubstr("not XML"));
}

TEST_F(ImportedNetworks, another_kind_of_xml_is_refused) {
    write("other.net.xml", "<routes/>");
    const auto problems = problems_of([&] { build_network(imported("other.net.xml"), folder() / "out"); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].what, HasSubstr("<routes>"));
}

TEST_F(BuiltNetworks, missing_netconvert_is_said_so) {
    const std::string path = std::getenv("PATH");
    setenv("PATH", folder().c_str(), 1);
    try {
        built("merge");
        ADD_FAILURE() << "no error without netconvert";
    } catch (const core::EnvironmentError& error) {
        EXPECT_THAT(error.what(), HasSubstr("netconvert"));
    }
    setenv("PATH", path.c_str(), 1);
}

TEST_F(BuiltNetworks, a_netconvert_that_does_not_end_is_ended) {
    std::filesystem::permissions(write("netconvert", "#!/bin/sh\nexec /bin/sleep 100\n"),
                                 std::filesystem::perms::owner_all);
    const std::string path = std::getenv("PATH");
    setenv("PATH", folder().c_str(), 1);
    const auto problems = problems_of([&] {
        detail::run_netconvert(load("merge"), {"--output-file", "out"}, folder(),
                               std::chrono::milliseconds(200));
    });
    setenv("PATH", path.c_str(), 1);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].where, HasSubstr("network"));
    EXPECT_EQ(problems[0].what, "netconvert does not end within 0.2 s");
}

TEST_F(BuiltNetworks, a_folder_that_cannot_be_made_is_an_environment_error) {
    write("blocked", "a file where a folder should be");
    EXPECT_THROW(build_network(load("merge"), folder() / "blocked" / "net"), core::EnvironmentError);
}

/// A copy of the intersection, which is made of plain XML, to be damaged.
class PlainNetworks : public BuiltNetworks {
  protected:
    void SetUp() override {
        const std::filesystem::path file = detail::scenario_file("intersection");
        std::filesystem::copy(file.parent_path(), folder() / "mine");
    }
    std::string refusal_of(const std::string& name, const std::string& old, const std::string& now) const {
        const std::filesystem::path file = folder() / "mine" / name;
        const std::string text = core::read_file(file);
        core::write_atomically(file, std::string(text).replace(text.find(old), old.size(), now));
        std::string refusal;
        try {
            build_network(load((folder() / "mine").string()), folder() / "built");
        } catch (const core::InputError& error) {
            refusal = error.what();
        }
        core::write_atomically(file, text);
        EXPECT_THAT(refusal, Not(HasSubstr((folder() / "built").string()))) << "which does not stay";
        return refusal;
    }
};

TEST_F(PlainNetworks, with_programs_that_sumo_cannot_run_are_refused_with_file_and_line) {
    const std::string name = "intersection.tll.xml";
    const std::string place = (folder() / "mine" / name).string() + ":4: ";
    EXPECT_THAT(refusal_of(name, "static", "fancy"),
                AllOf(HasSubstr(place + "type=\"fancy\" of signal \"center\""),
                      HasSubstr("allowed: static, actuated, delay_based, NEMA, ")));
    EXPECT_THAT(refusal_of(name, "static", "sotl_wave"),
                AllOf(HasSubstr(place + "type=\"sotl_wave\""), HasSubstr("netconvert does not keep"),
                      HasSubstr("allowed: static, actuated, delay_based, NEMA, railCrossing)")));
    EXPECT_THAT(refusal_of(name, "static", "off"), HasSubstr(place + "type=\"off\""));
    EXPECT_EQ(refusal_of(name, " type=\"static\"", ""), "") << "netconvert makes it static";
}

TEST_F(PlainNetworks, nested_so_deep_that_netconvert_never_ends_are_refused) {
    std::string deep;
    for (const char* const tag : {"<a>", "</a>"})
        for (int level = 0; level < 300; ++level)
            deep += tag;
    for (const auto& [name, end] :
         {std::pair{"intersection.nod.xml", "</nodes>"}, std::pair{"intersection.edg.xml", "</edges>"},
          std::pair{"intersection.con.xml", "</connections>"}})
        EXPECT_THAT(refusal_of(name, end, deep + end), AllOf(HasSubstr(name), HasSubstr("levels")));
    EXPECT_THAT(refusal_of("intersection.nod.xml", "<nodes", "<!DOCTYPE nodes [<!ENTITY a \"b\">]>\n<nodes"),
                AllOf(HasSubstr("intersection.nod.xml"), HasSubstr("document type \"nodes\"")));
}

TEST_F(PlainNetworks, that_netconvert_refuses_are_told_with_its_words_and_the_key_at_fault) {
    EXPECT_THAT(refusal_of("intersection.tll.xml", "GGGgrrrr", "GGG"),
                AllOf(HasSubstr("scenario.toml:10:1: network.signals: netconvert refuses this network"),
                      HasSubstr("state length of"), HasSubstr("Correct"), HasSubstr("intersection.tll.xml"),
                      Not(HasSubstr("Quitting")), Not(HasSubstr("Warning"))));
    EXPECT_THAT(refusal_of("intersection.edg.xml", "<edge ", "<edge <"),
                AllOf(HasSubstr("network.edges: "), HasSubstr("intersection.edg.xml")));
    EXPECT_THAT(refusal_of("intersection.nod.xml", "id=\"center\"", ""), HasSubstr("network.nodes: "));
}

}  // namespace
}  // namespace clearway::scenario
