#include <gmock/gmock.h>

#include "core/files.hpp"
#include "prepared_demand.hpp"

namespace clearway::scenario {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Demand that a scenario of the test's own states, on the road of scratch.hpp.
class CustomDemand : public PreparedDemand {
  protected:
    void SetUp() override {
        PreparedDemand::SetUp();
        write("line.nod.xml", line_nodes);
        write("line.edg.xml", line_edges);
    }
    std::vector<core::Problem> problems(const std::string& rest) {
        const std::string file = write("scenario.toml", line_head + rest).string();
        return problems_of([&] { prepared(file); });
    }
};

TEST_F(CustomDemand, unknown_edge_is_named_with_its_line_and_the_nearest) {
    const auto found = problems("[[flow]]\nfrom = \"frist\"\nto = \"second\"\n");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0].where, HasSubstr("scenario.toml:7:1: flow[0].from"));
    EXPECT_THAT(found[0].what, HasSubstr("no edge \"frist\""));
    EXPECT_THAT(found[0].cure, HasSubstr("first"));
}

TEST_F(CustomDemand, unreachable_destination_is_named) {
    const auto found = problems("[[flow]]\nfrom = \"second\"\nto = \"first\"\n");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0].where, HasSubstr("scenario.toml:8:1: flow[0].to"));
    EXPECT_THAT(found[0].what, HasSubstr("no car can reach \"first\" from \"second\""));
}

TEST_F(CustomDemand, every_bad_flow_is_reported) {
    EXPECT_EQ(problems("[[flow]]\nfrom = \"x\"\nto = \"y\"\nshare = 0.5\n"
                       "[[flow]]\nfrom = \"second\"\nto = \"side\"\nshare = 0.5\n")
                  .size(),
              3U);
}

TEST_F(CustomDemand, emergency_trip_takes_its_own_route_and_departure) {
    const std::string file =
        write("scenario.toml",
              std::string(line_head) +
                  "[[flow]]\nfrom = \"first\"\nto = \"second\"\n[[emergency_trip]]\nfrom = \"side\"\n"
                  "to = \"second\"\ndepart_s = 75.5\nkind = \"fire_engine\"\n")
            .string();
    const Prepared demand = prepared(file);
    ASSERT_EQ(demand.emergency.size(), 1U);
    EXPECT_EQ(demand.emergency[0].edges, (std::vector<std::string>{"side", "second"}));
    EXPECT_EQ(demand.emergency[0].depart.value, 75.5);
    EXPECT_EQ(demand.emergency[0].type, "emergency_fire_engine");
}

TEST_F(CustomDemand, emergency_trip_may_have_a_route_of_its_own) {
    const std::string flow = "[[flow]]\nfrom = \"first\"\nto = \"second\"\n";
    const auto file = [&](const std::string& trip) {
        return write("scenario.toml", line_head + flow + "[[emergency_trip]]\n" + trip).string();
    };
    const Prepared demand = prepared(file("edges = \"side second\"\ndepart_s = 75.5\n"));
    ASSERT_EQ(demand.emergency.size(), 1U);
    EXPECT_EQ(demand.emergency[0].edges, (std::vector<std::string>{"side", "second"}));

    const auto refused = [&](const std::string& trip) {
        const auto found = problems_of([&] { prepared(file(trip)); });
        return found.empty() ? std::string() : found[0].where + ": " + found[0].what;
    };
    EXPECT_THAT(refused("edges = \"side sekond\"\ndepart_s = 75.5\n"),
                HasSubstr("emergency_trip[0].edges: the network has no edge \"sekond\""));
    EXPECT_THAT(refused("edges = \"second first\"\ndepart_s = 75.5\n"),
                HasSubstr("is no way for an emergency"));
    EXPECT_THAT(refused("edges = \"side second\"\nfrom = \"side\"\ndepart_s = 75.5\n"),
                HasSubstr("has edges, and from or to besides"));
    EXPECT_THAT(refused("from = \"side\"\ndepart_s = 75.5\n"), HasSubstr("has no from or no to"));
}

TEST_F(CustomDemand, trips_longer_than_the_network_are_refused) {
    init(folder() / "far", "city");
    const std::filesystem::path file = folder() / "far" / "scenario.toml";
    std::string text = core::read_file(file);
    const std::string from = "emergency_minimum_length_m = 1000.0";
    core::write_atomically(
        file, text.replace(text.find(from), from.size(), "emergency_minimum_length_m = 900000.0"));
    const auto found = problems_of([&] { prepared(file.string()); });
    ASSERT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0].where, HasSubstr("trips.emergency_minimum_length_m"));
}

TEST_F(CustomDemand, only_options_that_are_kept_may_be_set_and_only_to_numbers) {
    write("measured.rou.xml",
          "<routes><vehicle id=\"a\" depart=\"0\"><route edges=\"first second\"/></vehicle></routes>");
    const auto found = problems(
        "[measured]\nroutes = [\"measured.rou.xml\"]\n"
        "options = [\"tls.actuated.jam-treshold=30\", \"seed=4\", \"weights.random-factor=high\", "
        "\"weights.random-factor\", \"weights.priority-factor=2\"]\n");
    ASSERT_EQ(found.size(), 4U);
    EXPECT_THAT(found[0].where, HasSubstr("measured.options"));
    EXPECT_THAT(found[0].cure, HasSubstr("tls.actuated.jam-threshold"));
    EXPECT_THAT(found[1].what, HasSubstr("\"seed\" is not known"));
    EXPECT_THAT(found[2].what, HasSubstr("has no number"));
    EXPECT_THAT(found[3].what, HasSubstr("has no number"));
}

TEST_F(CustomDemand, measured_vehicles_and_persons_let_sumo_write_nothing) {
    const std::string writes =
        "<param key=\"has.ssm.device\" value=\"true\"/><param key=\"device.toc.file\" value=\"diary.txt\"/>"
        "<param key=\"device.ssm.file\" value=\"diary.txt\"/><param key=\"mine\" value=\"1\"/>";
    write("cars.rou.xml",
          "<routes><vehicle id=\"a\" type=\"car\" depart=\"0\"><route edges=\"first second\"/>" + writes +
              "</vehicle></routes>");
    write("walkers.rou.xml", "<routes><vType id=\"w\" vClass=\"pedestrian\">" + writes +
                                 "</vType><person id=\"b\" type=\"w\" depart=\"2\"><walk edges=\"first\"/>"
                                 "</person></routes>");
    const Prepared made =
        prepared(write("scenario.toml", line_head + std::string("[measured]\nroutes = [\"cars.rou.xml\"]\n"
                                                                "persons = [\"walkers.rou.xml\"]\n"
                                                                "[[measured.type]]\nid = \"car\"\n"))
                     .string());
    ASSERT_EQ(made.route_files.size(), 2U);
    for (const std::filesystem::path& file : made.route_files) {
        const std::string text = core::read_file(file);
        EXPECT_THAT(text, AllOf(Not(HasSubstr("diary.txt")), Not(HasSubstr("ssm"))));
        EXPECT_THAT(text, HasSubstr("mine"));
    }
}

TEST_F(CustomDemand, measured_types_must_be_listed) {
    write("measured.rou.xml",
          "<routes><vehicle id=\"a\" type=\"lorry\" depart=\"0\"><route edges=\"first second\"/></vehicle>"
          "<vehicle id=\"b\" type=\"known\" depart=\"1\"><route edges=\"first third\"/></vehicle></routes>");
    const auto found =
        problems("[measured]\nroutes = [\"measured.rou.xml\"]\n[[measured.type]]\nid = \"known\"\n");
    ASSERT_EQ(found.size(), 2U);
    EXPECT_THAT(found[0].what, HasSubstr("type \"lorry\" is not listed"));
    EXPECT_THAT(found[1].what, HasSubstr("no edge \"third\""));
}

TEST_F(CustomDemand, measured_persons_go_by_departure_within_the_window_under_ids_of_their_own) {
    write("cars.rou.xml",
          "<routes><vehicle id=\"person.b\" type=\"car\" depart=\"0\"><route edges=\"first "
          "second\"/></vehicle></routes>");
    write("walkers.rou.xml",
          "<routes><vType id=\"car\" vClass=\"pedestrian\"/>"
          "<person id=\"b\" type=\"car\" depart=\"9.5\"><walk edges=\"first side\"/></person>"
          "<person id=\"a\" type=\"car\" depart=\"2\"><walk edges=\"first\"/><stop edge=\"first\" "
          "duration=\"1\"/></person>"
          "<person id=\"late\" type=\"car\" depart=\"99\"><walk edges=\"first\"/></person></routes>");
    const std::string measured =
        "[time]\nwindow_s = 10.0\nwarm_up_s = 0.0\n[measured]\n"
        "routes = [\"cars.rou.xml\"]\n[[measured.type]]\nid = \"car\"\n";
    const auto made = [&](const std::string& text) {
        return prepared(write("scenario.toml", line_head + text).string());
    };
    const Prepared alone = made(measured);
    std::string walked = measured;
    walked.insert(walked.find("[[measured.type]]"), "persons = [\"walkers.rou.xml\"]\n");
    const Prepared among = made(walked);
    EXPECT_EQ(alone.route_files.size(), 1U);
    ASSERT_EQ(among.route_files.size(), 2U);
    EXPECT_EQ(core::read_file(among.route_files[0]), core::read_file(alone.route_files[0]));
    EXPECT_NE(among.demand_hash, alone.demand_hash);
    const std::string text = core::read_file(among.route_files[1]);
    EXPECT_THAT(text, HasSubstr("<vType id=\"person.car\" vClass=\"pedestrian\""));
    const std::size_t first = text.find("<person id=\"person.a\" type=\"person.car\" depart=\"2\"");
    EXPECT_LT(first, text.find("<person id=\"person.person.b\" type=\"person.car\" depart=\"9.5\""));
    EXPECT_EQ(text.find("late"), std::string::npos);
}

TEST_F(CustomDemand, measured_persons_who_cannot_walk_are_refused_together) {
    write("cars.rou.xml",
          "<routes><vehicle id=\"c\" type=\"car\" depart=\"0\"><route edges=\"first "
          "second\"/></vehicle></routes>");
    const auto person = [](const std::string& id, const std::string& plan, const std::string& rest) {
        return "<person id=\"" + id + "\" type=\"" + rest + ">" + plan + "</person>";
    };
    const std::string walk = "<walk edges=\"first\"/>";
    const std::string now = "t\" depart=\"0\"";
    write("walkers.rou.xml",
          "<routes><vType id=\"t\" vClass=\"pedestrian\"/>" + person("a", walk, "t\" depart=\"soon\"") +
              person("b", walk, now) + person("b", walk, now) + person("c", walk, "x\" depart=\"0\"") +
              person("d", "<ride lines=\"x\"/>" + walk, now) + person("e", "<walk from=\"first\"/>", now) +
              person("f", "<walk edges=\"third\"/>", now) +
              person("g", "<walk edges=\"first side second first\"/>", now) + person("h", "", now) +
              "<personFlow id=\"i\"/></routes>");
    const auto found = problems(
        "[measured]\nroutes = [\"cars.rou.xml\"]\npersons = [\"walkers.rou.xml\"]\n"
        "[[measured.type]]\nid = \"car\"\n");
    std::string text;
    for (const core::Problem& problem : found)
        text += problem.where.substr(problem.where.rfind(": ") + 2) + " " + problem.what + "\n";
    EXPECT_EQ(text,
              "person \"a\" depart is \"soon\"\nperson \"b\" occurs twice\n"
              "person \"c\" type \"x\" is not defined\nperson \"d\" the network has no edge \"\"\n"
              "person \"e\" has a walk without edges\n"
              "person \"f\" the network has no edge \"third\"\n"
              "person \"g\" its walk has a gap: nobody gets from edge \"side\" to \"second\" on foot\n"
              "person \"h\" neither walks nor rides\npersonFlow \"i\" is a <personFlow>\n");
}

TEST_F(CustomDemand, a_comma_in_the_folder_is_refused_before_sumo_splits_it) {
    const ScenarioConfig config = load("merge");
    const BuiltNetwork network = build_network(config, folder() / "merge");
    const auto found = problems_of(
        [&] { prepare(config, network, core::StudySeed{1}, core::Replication{0}, folder() / "a,b"); });
    ASSERT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0].what, HasSubstr("comma"));
}

TEST_F(CustomDemand, a_folder_that_is_not_utf8_is_refused_before_netconvert_blames_its_input) {
    const auto found = problems_of([&] { build_network(load("merge"), folder() / "caf\xe9"); });
    ASSERT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0].what, HasSubstr("not UTF-8"));
}

}  // namespace
}  // namespace clearway::scenario
