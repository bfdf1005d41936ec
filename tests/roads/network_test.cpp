#include "roads/network.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <zlib.h>

#include "core/error.hpp"
#include "crossing_network.hpp"
#include "roads/crossings.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::roads {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class NetworkTest : public ::testing::Test {
  protected:
    Network read(const std::string& text) { return Network::read(folder_.write("test.net.xml", text)); }
    Network crossing() { return read(crossing_network()); }
    /// The crossing with the first `from` replaced.
    std::string altered(const std::string& from, const std::string& to) {
        std::string text = crossing_network();
        const std::size_t place = text.find(from);
        EXPECT_NE(place, std::string::npos) << from;
        return text.replace(place, from.size(), to);
    }
    std::string complaint(const std::string& text) {
        try {
            read(text);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "no complaint";
    }

    support::TemporaryFolder folder_;
};

TEST_F(NetworkTest, street_names_that_netconvert_escapes_twice_are_as_the_map_has_them) {
    EXPECT_EQ(crossing().edge(*crossing().find_edge("west")).name, "High & Low Street");
    const Network network = read(altered("High &amp; Low Street", "Avenue d&amp;apos;Ostende &amp;amp; Co"));
    EXPECT_EQ(network.edge(*network.find_edge("west")).name, "Avenue d'Ostende & Co");
}

TEST(Crossings, JoinSidewalksAndKnowTheirSignal) {
    const Network network = Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/footway.net.xml");
    const std::vector<Crossing> found = crossings(network);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(network.edge(found[0].edge).id, ":J_c0");
    EXPECT_TRUE(found[0].has_signal);
    const auto ends = [&](const std::vector<SidewalkEnd>& side) {
        std::vector<std::string> names;
        for (const SidewalkEnd& each : side)
            names.push_back((each.end == LaneEnd::last ? "end of " : "start of ") +
                            network.lane(each.lane).id);
        return names;
    };
    EXPECT_THAT(ends(found[0].one_side), UnorderedElementsAre("end of in2_0", "start of out2_0"));
    EXPECT_THAT(ends(found[0].other_side), UnorderedElementsAre("end of in_0", "start of out_0"));
    EXPECT_EQ(network.signal(*network.find_signal("J")).crossings, (std::vector<bool>{false, false, true}));
}

TEST_F(NetworkTest, ReadsEdgesAndLanes) {
    const Network network = crossing();
    EXPECT_EQ(network.edges().size(), 10u);
    EXPECT_EQ(network.lanes().size(), 13u);
    const Edge& west = network.edge(*network.find_edge("west"));
    EXPECT_EQ(west.name, "High & Low Street");
    EXPECT_EQ(west.type, "primary");
    EXPECT_EQ(west.from_junction, "W");
    EXPECT_EQ(west.to_junction, "J");
    EXPECT_EQ(west.priority, 3);
    EXPECT_EQ(west.lane_count, 2u);
    EXPECT_FLOAT_EQ(west.length_m, 100.0F);
    EXPECT_FALSE(west.internal);
    EXPECT_TRUE(network.edge(*network.find_edge(":J_0")).internal);
    const Lane& lane = network.lane(*network.find_lane("west_1"));
    EXPECT_EQ(lane.number, 1u);
    EXPECT_FLOAT_EQ(lane.speed_limit_mps, 20.0F);
    EXPECT_FLOAT_EQ(lane.width_m, 3.5F);
    EXPECT_FLOAT_EQ(network.lane(*network.find_lane("west_0")).width_m, 3.2F);
    EXPECT_EQ(network.lane_of(lane.edge, 1), network.find_lane("west_1"));
    EXPECT_FALSE(network.lane_of(lane.edge, 2).exists());
    EXPECT_FALSE(network.find_edge("nowhere").has_value());
    EXPECT_FALSE(network.find_lane("west_2").has_value());
    EXPECT_FALSE(network.find_signal("K").has_value());
}

/// Netconvert 1.22 and newer write the same index for all lanes of an edge inside a junction.
TEST_F(NetworkTest, TakesTheNumberOfALaneInsideAJunctionFromItsId) {
    const Network network = read(altered(R"(<lane id=":J_0_1" index="1")", R"(<lane id=":J_0_1" index="0")"));
    EXPECT_EQ(network.lane(*network.find_lane(":J_0_1")).number, 1u);
    EXPECT_EQ(network.lane_of(*network.find_edge(":J_0"), 1), network.find_lane(":J_0_1"));
}

TEST_F(NetworkTest, RefusesLanesOutOfOrder) {
    EXPECT_THAT(complaint(altered(R"(<lane id="west_1" index="1")", R"(<lane id="west_1" index="0")")),
                AllOf(HasSubstr(R"(index="0" of lane "west_1" (allowed: 1))"), HasSubstr("netconvert")));
    EXPECT_THAT(complaint(altered(R"(<lane id=":J_0_1" index="1")", R"(<lane id=":J_0_7" index="0")")),
                HasSubstr(R"(index="0" of lane ":J_0_7" (allowed: 1))"));
}

TEST_F(NetworkTest, ReadsThePlaceOnTheGlobe) {
    const Location location = crossing().location();
    EXPECT_DOUBLE_EQ(location.offset_x_m, -10.5);
    EXPECT_DOUBLE_EQ(location.offset_y_m, 20.25);
    EXPECT_EQ(location.projection, "+proj=utm +zone=33");
    EXPECT_DOUBLE_EQ(location.x_maximum_m, 310.0);
    EXPECT_DOUBLE_EQ(location.y_minimum_m, -60.0);
}

TEST_F(NetworkTest, KnowsWhoMayUseALane) {
    struct Case {
        std::string attribute;
        bool cars, emergency;
    };
    for (const Case& each :
         {Case{"", true, true}, Case{R"(allow="all")", true, true},
          Case{R"(allow="bus passenger")", true, false}, Case{R"(allow="emergency authority")", false, true},
          Case{R"(allow="pedestrian")", false, false}, Case{R"(disallow="all")", false, false},
          Case{R"(disallow="passenger")", false, true}, Case{R"(disallow="tram emergency")", true, false},
          Case{R"(allow="passenger" disallow="all")", true, false}}) {
        const Network network = read(altered(R"(allow="pedestrian")", each.attribute));
        const Lane& lane = network.lane(*network.find_lane("path_0"));
        EXPECT_EQ(lane.allows_cars, each.cars) << each.attribute;
        EXPECT_EQ(lane.allows_emergency, each.emergency) << each.attribute;
    }
}

TEST_F(NetworkTest, ListsConnectionsByLaneInTheOrderOfTheFile) {
    const Network network = crossing();
    const auto ways = network.connections_from(*network.find_lane("south_0"));
    ASSERT_EQ(ways.size(), 2u);
    EXPECT_EQ(network.lane(ways[0].to).id, "east_0");
    EXPECT_EQ(network.lane(ways[1].to).id, "north_0");
    EXPECT_EQ(network.lane(ways[1].via).id, ":J_3_0");
    EXPECT_EQ(ways[1].signal, network.find_signal("J"));
    EXPECT_EQ(ways[1].signal_link, 3);
    EXPECT_EQ(ways[0].direction, 'r');
    EXPECT_TRUE(ways[0].allows_cars);
    const auto emergency_way = network.connections_from(*network.find_lane("west_1"));
    ASSERT_EQ(emergency_way.size(), 1u);
    EXPECT_FALSE(emergency_way[0].allows_cars);
    EXPECT_TRUE(emergency_way[0].allows_emergency);
    const auto unsignalled = network.connections_from(*network.find_lane("back_0"));
    EXPECT_FALSE(unsignalled[0].signal.exists());
    EXPECT_FALSE(unsignalled[0].via.exists());
}

TEST_F(NetworkTest, AConnectionWithoutDirectionGoesStraightOn) {
    const Network network = read(altered(R"(dir="r")", R"(dir="")"));
    EXPECT_EQ(network.connections_from(*network.find_lane("south_0"))[0].direction, 's');
}

TEST_F(NetworkTest, SuccessorsAreOpenToCarsAndAscending) {
    const Network network = crossing();
    EXPECT_THAT(network.successors(*network.find_edge("south")),
                ElementsAre(*network.find_edge("east"), *network.find_edge("north")));
    EXPECT_THAT(network.successors(*network.find_edge("back")), ElementsAre(*network.find_edge("west")));
    EXPECT_THAT(network.successors(*network.find_edge("north")), ElementsAre());
    // With its car lane closed, west leads nowhere for cars.
    const Network closed = read(altered(R"(disallow="pedestrian tram")", R"(disallow="passenger")"));
    EXPECT_THAT(closed.successors(*closed.find_edge("west")), ElementsAre());
}

TEST_F(NetworkTest, TakesTheLastProgramOfASignal) {
    const Network network = crossing();
    ASSERT_EQ(network.signals().size(), 1u);
    const Signal& signal = network.signal(*network.find_signal("J"));
    ASSERT_EQ(signal.program.size(), 2u);
    EXPECT_DOUBLE_EQ(signal.program[1].duration_s, 9.5);
    EXPECT_EQ(signal.program[0].state, "GGgr");
    ASSERT_EQ(signal.links.size(), 4u);
    ASSERT_EQ(signal.links[3].size(), 1u);
    EXPECT_EQ(network.lane(signal.links[3][0].from).id, "south_0");
    EXPECT_EQ(network.lane(signal.links[3][0].to).id, "north_0");
    EXPECT_EQ(network.lane(signal.links[3][0].via).id, ":J_3_0");
}

std::string foes_of(const Signal& signal) {
    std::string rows;
    for (const auto& row : signal.foes) {
        for (const bool foe : row) {
            rows += foe ? '1' : '0';
        }
        rows += ' ';
    }
    return rows;
}

TEST_F(NetworkTest, ProgramsOfAdditionalFilesReplaceThoseOfTheNetwork) {
    const auto file = folder_.write("test.net.xml", crossing_network());
    EXPECT_TRUE(Network::read(file).signals()[0].fixed_time);
    const auto programs = folder_.write("tls.add.xml", R"(<additional>
    <busStop id="stop" lane="west_0"/>
    <tlLogic id="elsewhere" type="static" programID="0"><phase duration="5" state="G"/></tlLogic>
    <tlLogic id="J" type="static" programID="measured" offset="7">
        <phase duration="20" state="GGrr"/>
        <phase duration="3" state="yyrr"/>
        <phase duration="30" state="rrGG"/>
    </tlLogic>
</additional>)");
    const Network network = Network::read(file, {programs});
    ASSERT_EQ(network.signals().size(), 1U);
    const Signal& signal = network.signals()[0];
    ASSERT_EQ(signal.program.size(), 3U);
    EXPECT_EQ(signal.program[2].state, "rrGG");
    EXPECT_DOUBLE_EQ(signal.offset_s, 7.0);
    EXPECT_EQ(foes_of(signal), foes_of(crossing().signals()[0])) << "ways are those of the network";

    const auto later = folder_.write("later.add.xml", R"(<additional>
    <tlLogic id="J" type="actuated" programID="other" offset="5"/>
    <tlLogic id="J" programID="measured" offset="9"/>
</additional>)");
    const Network moved = Network::read(file, {programs, later});
    EXPECT_EQ(moved.signals()[0].program.size(), 3U) << "another offset, the same phases";
    EXPECT_DOUBLE_EQ(moved.signals()[0].offset_s, 9.0);
    EXPECT_TRUE(moved.signals()[0].fixed_time);
    EXPECT_EQ(moved.signals()[0].program_id, "measured");
}

TEST_F(NetworkTest, ReadsWhatAControllerOwesItsPhases) {
    const auto file = folder_.write("test.net.xml", crossing_network());
    const auto programs = folder_.write("tls.add.xml", R"(<additional>
    <tlLogic id="J" type="NEMA" programID="p">
        <phase duration="99" minDur="5" maxDur="30" yellow="3.5" red="2" state="GGrr"/>
        <phase duration="99" state="rrGG"/>
    </tlLogic>
</additional>)");
    const Network network = Network::read(file, {programs});
    const auto& program = network.signals()[0].program;
    EXPECT_DOUBLE_EQ(program[0].least_s, 5.0);
    EXPECT_DOUBLE_EQ(program[0].yellow_s, 3.5);
    EXPECT_DOUBLE_EQ(program[0].red_s, 2.0);
    EXPECT_DOUBLE_EQ(program[1].least_s, 0.0);
    const auto fixed = folder_.write("fixed.add.xml", R"(<additional>
    <tlLogic id="J" type="static" programID="p"><phase duration="9" minDur="5" state="GGrr"/></tlLogic>
</additional>)");
    EXPECT_DOUBLE_EQ(Network::read(file, {fixed}).signals()[0].program[0].least_s, 0.0)
        << "SUMO looks at minDur only where vehicles actuate the program";
}

TEST_F(NetworkTest, KnowsTheControllersOfSumoAndRefusesOthersWithTheNearest) {
    const auto file = folder_.write("test.net.xml", crossing_network());
    const auto controller_of = [&](const std::string& type) {
        const auto programs = folder_.write(
            "tls.add.xml", "<additional>\n    <tlLogic id=\"J\" type=\"" + type +
                               R"(" programID="p"><phase duration="9" name="one" state="GGrr"/></tlLogic>
</additional>)");
        const Network network = Network::read(file, {programs});
        EXPECT_EQ(network.signals()[0].program[0].name, "one");
        return network.signals()[0].controller;
    };
    EXPECT_EQ(Network::read(file).signals()[0].controller, "static");
    for (const char* type : {"actuated", "delay_based", "NEMA"})
        EXPECT_EQ(controller_of(type), type);
    try {
        controller_of("actuatd");
        FAIL() << "no InputError";
    } catch (const core::InputError& error) {
        EXPECT_THAT(core::format_problem(error.problems().front()),
                    AllOf(HasSubstr("tls.add.xml:2"), HasSubstr("type=\"actuatd\" of signal \"J\""),
                          HasSubstr("static, actuated, delay_based, NEMA, sotl_phase"),
                          HasSubstr("Did you mean 'actuated'?")));
    }
}

TEST_F(NetworkTest, RefusesControllersThatSumoReadsButCannotRun) {
    const auto file = folder_.write("test.net.xml", crossing_network());
    const auto read_with = [&](const std::string& type, const std::string& phase) {
        const auto programs =
            folder_.write("tls.add.xml", "<additional>\n    <tlLogic id=\"J\" " + type + R"( programID="p">
    <phase duration="9" )" + phase + R"(state="GGrr"/></tlLogic></additional>)");
        return Network::read(file, {programs}).signals()[0].controller;
    };
    const auto refusal = [&](const std::string& type, const std::string& phase = "") -> std::string {
        try {
            read_with(type, phase);
            return "";
        } catch (const core::InputError& error) {
            return error.what();
        }
    };
    EXPECT_EQ(read_with(R"(type="sotl_platoon")", R"(type="target" targetLanes="west_0" )"), "sotl_platoon");
    EXPECT_THAT(refusal(R"(type="sotl_platoon")"),
                AllOf(HasSubstr("tls.add.xml:2: type=\"sotl_platoon\" of signal \"J\" has no phase with"),
                      HasSubstr("write type=\"static\"")));
    EXPECT_THAT(refusal(R"(type="sotl_platoon")", R"(type="target" )"), HasSubstr("targetLanes"));
    EXPECT_THAT(refusal(R"(type="off")"),
                AllOf(HasSubstr("tls.add.xml:2: type=\"off\" of signal \"J\" cannot be"),
                      HasSubstr("--tls.unset J")));
    EXPECT_THAT(refusal(""),
                AllOf(HasSubstr("tls.add.xml:2: a program of signal \"J\" lacks the attribute type"),
                      HasSubstr("Write type=\"static\"")))
        << "SUMO takes it for another offset of a known program";
}

TEST_F(NetworkTest, RefusesAProgramWithTheIdOfTheOneBeforeAsSumoDoes) {
    const auto file = folder_.write("test.net.xml", crossing_network());
    const auto with_id = [&](const std::string& id) {
        return folder_.write("tls.add.xml",
                             "<additional>\n    <tlLogic id=\"J\" type=\"static\" programID=\"" + id +
                                 "\"><phase duration=\"9\" state=\"GGrr\"/></tlLogic></additional>");
    };
    const std::string before = Network::read(file).signals()[0].program_id;
    EXPECT_EQ(Network::read(file, {with_id("mine")}).signals()[0].program_id, "mine");
    try {
        Network::read(file, {with_id(before)});
        FAIL() << "SUMO loads no second program of an id";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr("tls.add.xml:2: a program of signal \"J\" has the programID of the one "
                              "before, \"" +
                              before + "\""));
    }
}

TEST_F(NetworkTest, TakesAProgramWithIdleLettersAsSumoDoes) {
    const auto file = folder_.write("test.net.xml", crossing_network());
    const auto programs = folder_.write("tls.add.xml", R"(<additional>
    <tlLogic id="J" type="static" programID="p"><phase duration="20" state="GGrrGG"/></tlLogic>
</additional>)");
    const Network network = Network::read(file, {programs});
    EXPECT_EQ(network.signals()[0].program[0].state, "GGrrGG");
    EXPECT_EQ(network.signals()[0].links.size(), 6U);
}

TEST_F(NetworkTest, RefusesAProgramOfAnotherNetwork) {
    const auto file = folder_.write("test.net.xml", crossing_network());
    const auto programs = folder_.write("tls.add.xml", R"(<additional>
    <tlLogic id="J" type="static" programID="p"><phase duration="20" state="GGG"/></tlLogic>
</additional>)");
    try {
        Network::read(file, {programs});
        FAIL() << "three letters for four links";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("tls.add.xml:2: a program of signal \"J\" with 3 letters"));
        EXPECT_THAT(error.what(), HasSubstr("at least 4, the links of the network"));
    }
    EXPECT_THROW(Network::read(file, {folder_.path() / "missing.add.xml"}), core::InputError);
}

TEST_F(NetworkTest, MapsRightOfWayToSignalLinks) {
    // 0 and 1 run side by side; 2 merges with 0; 3 crosses both; 2 and 3 share a stop line.
    EXPECT_EQ(foes_of(crossing().signals()[0]), "0011 0001 1000 1100 ");
}

TEST_F(NetworkTest, MapsRightOfWayWhenLinkNumbersDifferFromRequests) {
    // Swap the link numbers of west_0 -> east_0 and south_0 -> north_0.
    std::string text = altered(R"(tl="J" linkIndex="3")", R"(tl="J" linkIndex="X")");
    text.replace(text.find(R"(tl="J" linkIndex="0")"), 20, R"(tl="J" linkIndex="3")");
    text.replace(text.find(R"(linkIndex="X")"), 13, R"(linkIndex="0")");
    EXPECT_EQ(foes_of(read(text).signals()[0]), "0101 1000 0001 1010 ");
}

TEST_F(NetworkTest, MapsRightOfWayWithoutInternalLanes) {
    std::string text = altered(R"(intLanes=":J_0_0 :J_0_1 :J_2_0 :J_4_0")", R"(intLanes="")");
    EXPECT_EQ(foes_of(read(text).signals()[0]), "0011 0001 1000 1100 ");
}

TEST_F(NetworkTest, LinksThatShareANumberShareTheirFoes) {
    // Both lanes of west get number 1; number 0 is left without a connection.
    const std::string text = altered(R"(tl="J" linkIndex="0")", R"(tl="J" linkIndex="1")");
    const Network network = read(text);
    EXPECT_EQ(network.signals()[0].links[0].size(), 0u);
    EXPECT_EQ(network.signals()[0].links[1].size(), 2u);
    EXPECT_EQ(foes_of(network.signals()[0]), "0000 0011 0100 0100 ");
}

/// Edges into and out of a junction, of those who go first.
std::vector<std::string> prior_to(const Network& network, const std::string& from, const std::string& to) {
    std::vector<std::string> ways;
    for (const Connection& way : network.connections_from(*network.find_lane(from))) {
        if (network.lane(way.to).id != to) continue;
        for (const std::uint32_t row : network.prior_to(way)) {
            const Connection& prior = network.connection(row);
            ways.push_back(network.lane(prior.from).id + " " + network.lane(prior.to).id);
        }
    }
    return ways;
}

TEST_F(NetworkTest, KnowsWhoGoesFirstWhereThereIsNoSignal) {
    const Network network = read(crossing_without_signal());
    EXPECT_THAT(prior_to(network, "south_0", "east_0"), ElementsAre("west_0 east_0"));
    EXPECT_THAT(prior_to(network, "south_0", "north_0"), ElementsAre("west_0 east_0"))
        << "cars may not use the other lane";
    EXPECT_TRUE(prior_to(network, "west_0", "east_0").empty());
    EXPECT_TRUE(prior_to(crossing(), "south_0", "east_0").empty()) << "at a signal";
}

TEST_F(NetworkTest, ATableThatDoesNotFitSaysNothingOfAJunctionWithoutSignal) {
    std::string text = crossing_without_signal();
    const std::size_t start = text.find(R"(        <request index="3")");
    text.erase(start, text.find('\n', start) + 1 - start);
    EXPECT_TRUE(prior_to(read(text), "south_0", "east_0").empty());
}

TEST_F(NetworkTest, KnowsTheEdgesOfRoundabouts) {
    const Network network =
        read(altered("</net>", R"(<roundabout nodes="J K W" edges="east back unknown"/></net>)"));
    EXPECT_TRUE(network.edge(*network.find_edge("east")).roundabout);
    EXPECT_TRUE(network.edge(*network.find_edge("back")).roundabout);
    EXPECT_FALSE(network.edge(*network.find_edge("west")).roundabout);
}

TEST_F(NetworkTest, LeavesOutSignalsOfRailways) {
    std::string text = altered(R"(type="traffic_light")", R"(type="rail_crossing")");
    const std::size_t first = text.find("    <tlLogic");
    text.erase(first, text.find("    <junction") - first);
    const Network network = read(text);
    EXPECT_TRUE(network.signals().empty());
    EXPECT_FALSE(network.connections_from(*network.find_lane("west_0"))[0].signal.exists());
}

TEST_F(NetworkTest, StretchesPositionsToTheShape) {
    const Network network = crossing();
    // back_0 is stated as 300 m and drawn with 310 m, to the left.
    const Point half = network.point_at(*network.find_lane("back_0"), core::Metres(150.0));
    EXPECT_NEAR(half.x_m, 155.0, 1e-3);
    EXPECT_NEAR(network.heading_at(*network.find_lane("back_0"), core::Metres(1.0)), std::numbers::pi, 1e-6);
    const core::LaneIndex north = *network.find_lane("north_0");
    EXPECT_NEAR(network.heading_at(north, core::Metres(10.0)), std::numbers::pi / 2, 1e-6);
    EXPECT_NEAR(network.heading_at(north, core::Metres(30.0)), 0.0, 1e-6);
    EXPECT_NEAR(network.point_at(north, core::Metres(50.0)).x_m, 135.0, 1e-3);
    EXPECT_NEAR(network.point_at(north, core::Metres(-5.0)).y_m, 0.0, 1e-3);
    EXPECT_NEAR(network.point_at(north, core::Metres(500.0)).x_m, 145.0, 1e-3);
}

TEST_F(NetworkTest, ReadsGzip) {
    const std::string text = crossing_network();
    const auto file = folder_.path() / "test.net.xml.gz";
    gzFile out = gzopen(file.c_str(), "wb");
    gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
    gzclose(out);
    EXPECT_EQ(Network::read(file).lanes().size(), 13u);
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    EXPECT_THROW(Network::read(file), core::InputError);
}

TEST_F(NetworkTest, LargestComponentIsTheRoundTrip) {
    const Network network = crossing();
    EXPECT_THAT(
        largest_car_component(network),
        ElementsAre(*network.find_edge("west"), *network.find_edge("east"), *network.find_edge("back")));
}

TEST_F(NetworkTest, NamesFileAndLineOfWhatIsWrong) {
    EXPECT_THAT(complaint("<routes/>"), HasSubstr("test.net.xml:1: is not a SUMO network"));
    EXPECT_THAT(complaint("<net version=\"1.9\"></net>"), HasSubstr("has no edges"));
    EXPECT_THAT(complaint(""), HasSubstr("is not valid XML"));
    EXPECT_THAT(complaint("<net>\n<edge id=\"a\">\n"), HasSubstr("test.net.xml:3: is not valid XML"));
    EXPECT_THAT(complaint(altered(R"(length="200.00")", R"(length="long")")),
                HasSubstr("test.net.xml:22: length=\"long\" (allowed: a number from 0"));
    EXPECT_THAT(complaint(altered(R"(length="200.00")", R"(length="nan")")), HasSubstr("length=\"nan\""));
    EXPECT_THAT(complaint(altered(R"(linkIndex="3")", R"(linkIndex="4")")),
                HasSubstr("linkIndex=\"4\" of signal \"J\" (allowed: 0 to 3"));
    EXPECT_THAT(complaint(altered(R"(to="north" fromLane)", R"(to="moon" fromLane)")),
                HasSubstr("to=\"moon\" is not an edge defined above this line"));
    EXPECT_THAT(complaint(altered(R"(toLane="1")", R"(toLane="7")")),
                HasSubstr("toLane=\"7\" of edge \"east\" (allowed: 0 to 1)"));
    EXPECT_THAT(complaint(altered(R"(via=":J_3_0")", R"(via=":J_9_0")")), HasSubstr("via=\":J_9_0\""));
    EXPECT_THAT(complaint(altered(R"(<edge id="south")", R"(<edge id="west")")),
                HasSubstr("edge \"west\" occurs twice"));
    EXPECT_THAT(complaint(altered(R"(state="rrGG")", R"(state="rrG")")), HasSubstr("4 letters"));
    EXPECT_THAT(complaint(altered(R"(tl="J")", R"(tl="Q")")), HasSubstr("tl=\"Q\" is not a signal"));
    EXPECT_THAT(complaint(altered(R"(shape="0.00,-4.80 100.00,-4.80")", R"(shape="0.00,-4.80")")),
                HasSubstr("two or more points"));
    EXPECT_THAT(complaint(altered(R"( :J_4_0")", R"(")")), HasSubstr("junction has 4 requests"));
    EXPECT_THROW(Network::read(folder_.path() / "missing.net.xml"), core::InputError);
    EXPECT_THROW(Network::read(folder_.path()), core::InputError);
}

TEST_F(NetworkTest, CollectsAllProblemsUpToALimit) {
    std::string text = altered(R"(speed="5.00")", R"(speed="-5")");
    text.replace(text.find(R"(speed="2.00")"), 12, R"(speed="two")");
    const std::string both = complaint(text);
    EXPECT_THAT(both, HasSubstr("speed=\"-5\""));
    EXPECT_THAT(both, HasSubstr("speed=\"two\""));
    std::string many = "<net>\n";
    for (int edge = 0; edge < 100; ++edge) {
        many += "<edge id=\"a\" from=\"x\" to=\"y\"/>\n";
    }
    const std::string limited = complaint(many + "</net>");
    EXPECT_EQ(std::count(limited.begin(), limited.end(), '\n'), 20);
    EXPECT_THAT(limited, HasSubstr("has more problems"));
}

}  // namespace
}  // namespace clearway::roads
