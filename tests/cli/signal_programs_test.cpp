// Runs under signal programs that stand in additional files of SUMO, not in the network.
#include <fmt/format.h>
#include <zlib.h>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

class SignalProgramsTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write("crossings/net.net.xml",
              core::read_file(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml"));
        std::string routes = "<routes>\n<vType id=\"private\"/>\n";
        for (int number = 0; number < 80; ++number) {
            const char* const edges = number % 2 == 0 ? "west_A A_B B_east" : "north_a_A A_south_a";
            routes +=
                fmt::format(R"(<vehicle id="v{}" type="private" depart="{}"><route edges="{}"/></vehicle>)"
                            "\n",
                            number, number * 2, edges);
        }
        write("crossings/rou.xml", routes + "</routes>\n");
    }
    void write_scenario(const std::string& additional) const {
        write("crossings/scenario.toml", fmt::format(R"(name = "crossings"
version = "v1"
title = "Two crossings"
[network]
file = "net.net.xml"
restrict = "none"
[time]
warm_up_s = 40.0
window_s = 120.0
horizon_s = 600.0
[demand]
emergency = 3
[measured]
routes = ["rou.xml"]
additional = ["{}"]
automated_share = 0.35
emergency_minimum_length_m = 500.0
[[measured.type]]
id = "private"
kind = "car"
)",
                                                     additional));
    }
    Ended run(const std::string& out) const {
        return clearway({"run", "./crossings", "--policy", "corridor", "--seeds", "2", "--no-solo",
                         "--record", "--name", "mine", "--out", out});
    }
};

TEST_F(SignalProgramsTest, of_a_packed_file_are_known_to_the_run_and_to_its_replay) {
    const std::string programs = R"(<additional>
    <tlLogic id="A" type="static" programID="measured" offset="0">
        <phase duration="20" state="GGGgrrrrrrrrrrrr"/><phase duration="4" state="yyyyrrrrrrrrrrrr"/>
        <phase duration="20" state="rrrrGGGgrrrrrrrr"/><phase duration="4" state="rrrryyyyrrrrrrrr"/>
        <phase duration="20" state="rrrrrrrrGGGgrrrr"/><phase duration="4" state="rrrrrrrryyyyrrrr"/>
        <phase duration="20" state="rrrrrrrrrrrrGGGg"/><phase duration="4" state="rrrrrrrrrrrryyyy"/>
    </tlLogic>
</additional>)";
    const std::string packed = (folder() / "crossings/tls.add.xml.gz").string();
    gzFile file = gzopen(packed.c_str(), "wb");
    gzwrite(file, programs.data(), static_cast<unsigned>(programs.size()));
    gzclose(file);
    write_scenario("tls.add.xml.gz");
    const Ended ended = run("out");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const Ended replayed = clearway({"replay", "out/recordings/crossings/mine/00000.h5"});
    EXPECT_EQ(replayed.code, 0) << replayed.out << replayed.err;
}

TEST_F(SignalProgramsTest, switched_on_under_way_end_no_run) {
    // The second program has fewer phases and shares states with the first.
    write("crossings/tls.add.xml", R"(<additional>
    <tlLogic id="A" type="static" programID="short" offset="0">
        <phase duration="30" state="GGGgrrrrGGGgrrrr"/><phase duration="4" state="yyyyrrrryyyyrrrr"/>
    </tlLogic>
    <tlLogic id="A" type="static" programID="long" offset="0">
        <phase duration="20" state="GGGgrrrrGGGgrrrr"/><phase duration="4" state="yyyyrrrryyyyrrrr"/>
        <phase duration="20" state="rrrrGGGgrrrrGGGg"/><phase duration="4" state="rrrryyyyrrrryyyy"/>
    </tlLogic>
    <WAUT id="plan" refTime="0" startProg="long"><wautSwitch time="45" to="short"/></WAUT>
    <wautJunction wautID="plan" junctionID="A"/>
</additional>)");
    write_scenario("tls.add.xml");
    const Ended ended = run("out");
    EXPECT_EQ(ended.code, 0) << ended.err;
}

TEST_F(SignalProgramsTest, that_have_changed_make_it_another_run) {
    const auto write_programs = [&](int green_s) {
        write("crossings/tls.add.xml",
              fmt::format(R"(<additional><tlLogic id="A" type="static" programID="measured">
    <phase duration="{}" state="GGGgrrrrGGGgrrrr"/><phase duration="4" state="yyyyrrrryyyyrrrr"/>
    <phase duration="20" state="rrrrGGGgrrrrGGGg"/><phase duration="4" state="rrrryyyyrrrryyyy"/>
</tlLogic></additional>)",
                          green_s));
    };
    write_programs(20);
    write_scenario("tls.add.xml");
    ASSERT_EQ(run("out").code, 0);
    EXPECT_EQ(run("out").code, 0);
    write_programs(25);
    const Ended changed = run("out");
    EXPECT_EQ(changed.code, 3);
    EXPECT_THAT(changed.err, HasSubstr("holds another study: different scenarios (crossings: its files)"));
}

TEST_F(SignalProgramsTest, of_another_network_are_refused_before_anything_runs) {
    write("crossings/tls.add.xml", R"(<additional>
    <tlLogic id="A" programID="measured"><phase duration="20" state="GGG"/></tlLogic>
</additional>)");
    write_scenario("tls.add.xml");
    const Ended ended = run("out");
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("a program of signal \"A\" with 3 letters"));
}

}  // namespace
}  // namespace clearway::cli
