// Signals of SUMO under each of its controllers: taken from them for a hold and given back.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "actuation/actuator.hpp"
#include "core/process.hpp"
#include "roads/network.hpp"
#include "roads/own_clearance.hpp"
#include "sumo/session.hpp"
#include "support/temporary_folder.hpp"
#include "traffic/signal.hpp"

namespace clearway::testing {
namespace {

const std::string crossings_file = CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml";

constexpr const char* actuated = R"(<additional><tlLogic id="A" type="actuated" programID="own">
    <phase duration="30" minDur="8" maxDur="40" state="GGGgrrrrGGGgrrrr"/>
    <phase duration="4" state="yyyyrrrryyyyrrrr"/><phase duration="2" state="rrrrrrrrrrrrrrrr"/>
    <phase duration="30" minDur="8" maxDur="40" state="rrrrGGGgrrrrGGGg"/>
    <phase duration="4" state="rrrryyyyrrrryyyy"/><phase duration="2" state="rrrrrrrrrrrrrrrr"/>
</tlLogic></additional>)";

constexpr const char* delay_based = R"(<additional><tlLogic id="A" type="delay_based" programID="own">
    <phase duration="30" minDur="8" maxDur="40" state="GGGgrrrrGGGgrrrr"/>
    <phase duration="4" state="yyyyrrrryyyyrrrr"/>
    <phase duration="30" minDur="8" maxDur="40" state="rrrrGGGgrrrrGGGg"/>
    <phase duration="4" state="rrrryyyyrrrryyyy"/>
</tlLogic></additional>)";

/// Two rings of four phases. Phases 2 and 6 overlap: right turns from the east and the west, links 4 and 12,
/// go with the left turns that cross nobody of theirs (phases 1 and 5).
constexpr const char* dual_ring = R"(<additional><tlLogic id="A" type="NEMA" programID="own">
    <param key="ring1" value="1,2,3,4"/><param key="ring2" value="5,6,7,8"/>
    <param key="barrierPhases" value="4,8"/><param key="barrier2Phases" value="2,6"/>
    <param key="coordinate-mode" value="false"/><param key="minRecall" value="2,6"/>
    <param key="maxRecall" value="4,8"/><param key="fixForceOff" value="false"/>
    <phase duration="99" minDur="6" maxDur="20" vehext="2" yellow="4" red="2" name="1" state="rrrrGrrrrrrGrrrr"/>
    <phase duration="99" minDur="6" maxDur="30" vehext="2" yellow="4" red="2" name="2" state="GGGrrrrrrrrrrrrr"/>
    <phase duration="99" minDur="6" maxDur="20" vehext="2" yellow="4" red="2" name="3" state="rrrrrrrrrrrrrrrG"/>
    <phase duration="99" minDur="6" maxDur="30" vehext="2" yellow="4" red="2" name="4" state="rrrrGGGrrrrrrrrr"/>
    <phase duration="99" minDur="6" maxDur="20" vehext="2" yellow="4" red="2" name="5" state="rrrGrrrrrrrrGrrr"/>
    <phase duration="99" minDur="6" maxDur="30" vehext="2" yellow="4" red="2" name="6" state="rrrrrrrrGGGrrrrr"/>
    <phase duration="99" minDur="6" maxDur="20" vehext="2" yellow="4" red="2" name="7" state="rrrrrrrGrrrrrrrr"/>
    <phase duration="99" minDur="6" maxDur="30" vehext="2" yellow="4" red="2" name="8" state="rrrrrrrrrrrrGGGr"/>
</tlLogic></additional>)";

constexpr const char* flows = R"(<routes>
    <flow id="n" begin="0" end="900" vehsPerHour="300" from="north_a_A" to="A_south_a"/>
    <flow id="s" begin="0" end="900" vehsPerHour="300" from="south_a_A" to="A_north_a"/>
    <flow id="w" begin="0" end="900" vehsPerHour="300" from="west_A" to="B_east"/>
    <flow id="nl" begin="0" end="900" vehsPerHour="90" from="north_a_A" to="B_east"/>
    <flow id="sl" begin="0" end="900" vehsPerHour="90" from="south_a_A" to="A_west"/>
    <flow id="wl" begin="0" end="900" vehsPerHour="90" from="west_A" to="A_north_a"/>
    <flow id="el" begin="0" end="900" vehsPerHour="90" from="B_A" to="A_south_a"/>
</routes>)";

sumo::Names names_of(const roads::Network& network) {
    sumo::Names names;
    for (const roads::Lane& lane : network.lanes())
        names.lanes.push_back(lane.id);
    for (const roads::Edge& edge : network.edges())
        names.edges.push_back(edge.id);
    for (const roads::Signal& signal : network.signals())
        names.signals.push_back(signal.id);
    return names;
}

/// Letters of one link, run by run.
struct Colour {
    char kind;
    double from_s;
    double to_s;
};

/// SUMO with an actuator that holds a signal.
class Street {
  public:
    Street(const std::filesystem::path& map, const std::vector<std::string>& additional,
           const std::string& routes, const actuation::ActuatorConfig& config = {})
        : files_(written(additional)),
          network(roads::Network::read(map, files_)),
          session_({.network = map,
                    .route_files = {folder_.write("rou.xml", routes)},
                    .additional_files = files_,
                    .folder = folder_.path(),
                    .extra_arguments = {},
                    .names = names_of(network)}),
          actuator(network, config) {}

    /// Steps until `end_s` and lets `act` offer leases before each.
    template <class Act>
    void run(double end_s, const Act& act) {
        while (now_s() < end_s) {
            act(*this);
            session_.step();
            history.emplace_back(now_s(), session_.snapshot().signals.state.at(0));
            std::vector<traffic::Command> commands;
            actuator.step(session_.snapshot(), session_.roster(), session_, commands);
            session_.apply(commands);
        }
    }
    void ask(traffic::Action action) {
        const core::Seconds now = session_.time();
        actuator.accept(std::vector{traffic::Lease{core::SignalIndex{0},
                                                   std::move(action),
                                                   now + core::Seconds(1.0),
                                                   0,
                                                   "policy",
                                                   "a test",
                                                   {}}},
                        now);
    }
    double now_s() const { return session_.time().value; }
    std::string program() const { return session_.running_program(core::SignalIndex{0}); }
    const roads::Signal& signal() const { return network.signals()[0]; }

    std::vector<Colour> runs_of(std::size_t link) const {
        std::vector<Colour> runs;
        for (const auto& [time_s, state] : history) {
            const char letter = state.at(link);
            const char kind = traffic::is_green(letter) ? 'G' : traffic::is_yellow(letter) ? 'y' : 'r';
            if (!runs.empty()) runs.back().to_s = time_s;
            if (runs.empty() || runs.back().kind != kind) runs.push_back({kind, time_s, time_s});
        }
        return runs;
    }
    /// Whether the link is green at some time in [from_s, to_s].
    bool was_green(std::size_t link, double from_s, double to_s) const {
        return std::ranges::any_of(history, [&](const auto& shown) {
            return shown.first >= from_s && shown.first <= to_s && traffic::is_green(shown.second.at(link));
        });
    }

  private:
    std::vector<std::filesystem::path> written(const std::vector<std::string>& texts) const {
        std::vector<std::filesystem::path> files;
        for (const std::string& text : texts)
            files.push_back(folder_.write(fmt::format("{}.add.xml", files.size()), text));
        return files;
    }
    support::TemporaryFolder folder_;
    std::vector<std::filesystem::path> files_;

  public:
    roads::Network network;

  private:
    sumo::Session session_;

  public:
    actuation::Actuator actuator;
    std::vector<std::pair<double, std::string>> history;
};

const std::vector<std::uint16_t> west = {12, 13, 14, 15};

/// No yellow of the whole run is shorter than the link's own, and no link that conflicts opens sooner than
/// the program's own red clearance.
void expect_own_clearance(const Street& street) {
    const roads::Signal& signal = street.signal();
    const auto own = roads::own_clearances(signal);
    int yellows = 0;
    for (std::size_t link = 0; link < signal.links.size(); ++link) {
        const std::vector<Colour> runs = street.runs_of(link);
        for (std::size_t row = 1; row + 1 < runs.size(); ++row) {
            if (runs[row].kind != 'y' || runs[row - 1].kind != 'G') continue;  // it may resume in a yellow
            ++yellows;
            EXPECT_GE(runs[row].to_s - runs[row].from_s, own[link].yellow_s - 0.01)
                << "link " << link << " at " << runs[row].from_s;
            if (runs[row + 1].kind != 'r') continue;
            for (std::size_t other = 0; other < signal.links.size(); ++other) {
                if (!signal.foes[link][other]) continue;
                for (const Colour& foe : street.runs_of(other)) {
                    if (foe.kind != 'G' || foe.from_s < runs[row].to_s - 0.01) continue;
                    EXPECT_GE(foe.from_s - runs[row].to_s, own[link].red_s - 0.01)
                        << "link " << other << " after " << link << " at " << foe.from_s;
                    break;
                }
            }
        }
    }
    EXPECT_GT(yellows, 10);
}

struct Controller {
    const char* name;
    const char* program;
};

std::ostream& operator<<(std::ostream& out, const Controller& controller) {
    return out << controller.name;
}

class SignalUnder : public ::testing::TestWithParam<Controller> {};

TEST_P(SignalUnder, its_controller_is_held_and_given_back) {
    Street street(crossings_file, {GetParam().program}, flows);
    ASSERT_EQ(street.signal().controller, GetParam().name);
    street.run(240.0, [](Street&) {});
    for (std::size_t link = 0; link < 16; ++link)
        EXPECT_TRUE(street.was_green(link, 0.0, 240.0)) << "link " << link << " before";
    street.run(270.0, [](Street& each) {
        each.ask(traffic::HoldGreen{west});
        if (each.now_s() > 262.0) {
            for (const std::uint16_t link : west)
                EXPECT_TRUE(traffic::is_green(each.history.back().second[link])) << link << each.now_s();
        }
    });
    street.run(290.0, [](Street& each) { each.ask(traffic::AdjustGreen{{0, 1, 2, 8, 9, 10}}); });
    street.run(600.0, [](Street&) {});
    EXPECT_EQ(street.program(), "own");
    EXPECT_EQ(street.actuator.active(), 0U);
    for (std::size_t link = 0; link < 16; ++link)
        EXPECT_TRUE(street.was_green(link, 295.0, 600.0)) << "link " << link << " afterwards";
    expect_own_clearance(street);
}

INSTANTIATE_TEST_SUITE_P(
    Controllers, SignalUnder,
    ::testing::Values(Controller{"static",
                                 R"(<additional><tlLogic id="A" type="static" programID="own">
    <phase duration="26" state="GGGgrrrrGGGgrrrr"/><phase duration="4" state="yyyyrrrryyyyrrrr"/>
    <phase duration="2" state="rrrrrrrrrrrrrrrr"/>
    <phase duration="26" state="rrrrGGGgrrrrGGGg"/><phase duration="4" state="rrrryyyyrrrryyyy"/>
    <phase duration="2" state="rrrrrrrrrrrrrrrr"/></tlLogic></additional>)"},
                      Controller{"actuated", actuated}, Controller{"delay_based", delay_based},
                      Controller{"NEMA", dual_ring}),
    [](const auto& controller) { return std::string(controller.param.name); });

/// SUMO leaves the next switch of such a program where it was when it is led to another phase.
TEST(SignalThatVehiclesActuate, keeps_least_greens_and_yellows_whenever_it_is_led_to_a_phase) {
    Street street(crossings_file, {actuated}, flows);
    street.run(900.0, [](Street& each) {
        const double round_s = std::fmod(each.now_s(), 61.0);
        if (round_s > 30.0 && round_s < 36.0) each.ask(traffic::HoldGreen{west});
        each.ask(traffic::AdjustGreen{
            std::fmod(each.now_s(), 122.0) < 61.0 ? west : std::vector<std::uint16_t>{0, 1, 2}});
    });
    int greens = 0;
    for (std::size_t link = 0; link < 16; ++link) {
        const std::vector<Colour> runs = street.runs_of(link);
        for (std::size_t row = 1; row + 1 < runs.size(); ++row) {
            const double lasted_s = runs[row].to_s - runs[row].from_s;
            if (runs[row].kind == 'r') continue;
            const bool is_green = runs[row].kind == 'G';
            greens += is_green ? 1 : 0;
            EXPECT_GE(lasted_s, is_green ? 7.99 : 3.99) << "link " << link << " at " << runs[row].from_s;
        }
    }
    EXPECT_GT(greens, 100);
}

/// Two junctions 40 m apart under one signal, and the plain XML of their network.
std::filesystem::path joined_junction(const support::TemporaryFolder& folder) {
    const auto nodes = folder.write("j.nod.xml", R"(<nodes>
    <node id="l" x="0" y="0" type="traffic_light" tl="J"/><node id="r" x="40" y="0" type="traffic_light" tl="J"/>
    <node id="w" x="-200" y="0"/><node id="e" x="240" y="0"/>
    <node id="ls" x="0" y="-200"/><node id="rn" x="40" y="200"/></nodes>)");
    std::string edges;
    for (const auto& [from, to] : {std::pair{"w", "l"}, {"l", "r"}, {"r", "e"}, {"ls", "l"}, {"rn", "r"}}) {
        edges +=
            fmt::format(R"(<edge id="{0}_{1}" from="{0}" to="{1}" numLanes="1" speed="13.9"/>)", from, to);
        edges +=
            fmt::format(R"(<edge id="{1}_{0}" from="{1}" to="{0}" numLanes="1" speed="13.9"/>)", from, to);
    }
    const auto network = folder.path() / "j.net.xml";
    const core::Exit exit = core::run(
        {.program = "netconvert",
         .arguments = {"--node-files", nodes.string(), "--edge-files",
                       folder.write("j.edg.xml", "<edges>" + edges + "</edges>").string(), "--output-file",
                       network.string(), "--no-turnarounds", "--xml-validation", "never"},
         .environment = {},
         .output = folder.path() / "netconvert.log"});
    if (!exit.ok()) throw std::runtime_error("netconvert: " + exit.describe());
    return network;
}

TEST(SignalOfAJoinedJunction, is_held_and_given_back) {
    const support::TemporaryFolder folder;
    Street street(joined_junction(folder), {}, R"(<routes>
    <flow id="a" begin="0" end="600" vehsPerHour="200" from="w_l" to="r_e"/>
    <flow id="b" begin="0" end="600" vehsPerHour="200" from="rn_r" to="l_ls"/></routes>)");
    std::vector<std::uint16_t> links;
    for (std::size_t link = 0; link < street.signal().links.size(); ++link) {
        for (const roads::SignalLink& way : street.signal().links[link]) {
            if (street.network.lane(way.from).id == "rn_r_0")
                links.push_back(static_cast<std::uint16_t>(link));
        }
    }
    ASSERT_FALSE(links.empty());
    street.run(130.0, [](Street&) {});
    street.run(165.0, [&](Street& each) {
        each.ask(traffic::HoldGreen{links});
        for (const std::uint16_t link : links) {
            if (each.now_s() <= 157.0) continue;
            EXPECT_TRUE(traffic::is_green(each.history.back().second[link]));
        }
    });
    street.run(400.0, [](Street&) {});
    for (std::size_t link = 0; link < street.signal().links.size(); ++link)
        EXPECT_TRUE(street.was_green(link, 180.0, 400.0)) << "link " << link;
    expect_own_clearance(street);
}

TEST(CoordinatedArterial, is_in_step_again_some_time_after_a_hold) {
    Street street(crossings_file, {}, flows);
    double out_of_step_s = 0.0;
    street.run(600.0, [&](Street& each) {
        if (each.now_s() >= 100.0 && each.now_s() < 130.0) each.ask(traffic::HoldGreen{west});
        if (each.now_s() >= 100.0 && each.now_s() < 150.0) each.ask(traffic::AdjustGreen{{0, 1, 2, 3}});
        for (const traffic::SignalStatus& status : each.actuator.signals())
            if (status.coordination == traffic::Coordination::out_of_step) out_of_step_s += 0.25;
    });
    double cycle_began_s = 0.0;
    for (const Colour& run : street.runs_of(1))
        if (run.kind == 'G' && run.from_s > 400.0) cycle_began_s = run.from_s;
    EXPECT_GT(cycle_began_s, 400.0);
    EXPECT_NEAR(std::remainder(cycle_began_s, 90.0), 0.0, 1.3) << "cycles begin at multiples of 90 s";
    EXPECT_GT(out_of_step_s, 30.0) << "at least the hold";
    EXPECT_LT(out_of_step_s, 30.0 + 3.0 * 90.0);
}

}  // namespace
}  // namespace clearway::testing
