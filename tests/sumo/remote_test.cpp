// A SUMO that was started elsewhere.
#include <thread>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "sumo/scene.hpp"
#include "sumo/session.hpp"
#include "sumo/waiting_sumo.hpp"
#include "support/message_of.hpp"

namespace clearway {
namespace {

using sumo::RemoteSumo;
using sumo::Session;
using support::message_of;
using test::Listener;
using test::Scene;
using test::vehicle;
using test::WaitingSumo;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string crossing_traffic() {
    std::string vehicles;
    for (int i = 0; i < 40; ++i) {
        const char* const way = i % 2 == 0 ? "west_in east_out" : "south_in north_out";
        vehicles += vehicle("v" + std::to_string(i), i % 3 == 0 ? "av" : "hv", i, way);
    }
    return vehicles;
}

/// What one step showed and did.
struct Moment {
    truth::Snapshot snapshot;
    std::size_t departed = 0;
    std::size_t arrived = 0;
};

std::vector<Moment> watch(Session& session) {
    std::vector<Moment> moments;
    while (session.expected_vehicles() > 0) {
        session.step();
        moments.push_back(
            {session.snapshot(), session.events().departed.size(), session.events().arrived.size()});
        if (moments.size() == 40) {
            session.apply(std::vector<traffic::Command>{
                traffic::SetSpeed{test::key("v0"), core::MetresPerSecond(3.0)},
                traffic::SetSignalState{core::SignalIndex{0},
                                        std::string(session.snapshot().signals.state[0].size(), 'r')}});
        }
        if (moments.size() == 120)
            session.apply(
                std::vector<traffic::Command>{traffic::RestoreProgram{core::SignalIndex{0}, std::nullopt}});
    }
    session.close();
    return moments;
}

TEST(RemoteSession, ShowsAndDoesExactlyWhatOneInProcessDoes) {
    const Scene scene;
    const sumo::SessionConfig config = scene.config(scene.crossing(), crossing_traffic());
    std::vector<Moment> remote;
    {
        const WaitingSumo waiting(sumo::command_line(config), scene.folder() / "waiting.log");
        Session session(RemoteSumo("localhost", waiting.port()), scene.folder() / "client", config.names);
        remote = watch(session);
        EXPECT_EQ(session.trip_file(), std::filesystem::canonical(scene.folder()) / "run/tripinfo.xml");
    }
    const std::string remote_trips = test::text_without_date(scene.folder() / "run/tripinfo.xml");
    Session session(config);
    const std::vector<Moment> local = watch(session);
    ASSERT_EQ(remote.size(), local.size());
    for (std::size_t step = 0; step < local.size(); ++step) {
        const truth::Snapshot& here = local[step].snapshot;
        const truth::Snapshot& there = remote[step].snapshot;
        ASSERT_EQ(there.key, here.key) << here.time.value;
        EXPECT_EQ(there.x_m, here.x_m);
        EXPECT_EQ(there.y_m, here.y_m);
        EXPECT_EQ(there.heading_rad, here.heading_rad);
        EXPECT_EQ(there.speed_mps, here.speed_mps);
        EXPECT_EQ(there.acceleration_mps2, here.acceleration_mps2);
        EXPECT_EQ(there.lane, here.lane);
        EXPECT_EQ(there.lane_position_m, here.lane_position_m);
        EXPECT_EQ(there.route_edge, here.route_edge);
        EXPECT_EQ(there.signals.state, here.signals.state);
        EXPECT_EQ(remote[step].departed, local[step].departed);
        EXPECT_EQ(remote[step].arrived, local[step].arrived);
    }
    const auto table = [](const std::string& text) { return text.substr(text.find("<tripinfos")); };
    EXPECT_EQ(table(remote_trips), table(test::text_without_date(session.trip_file())));
}

TEST(RemoteSession, TakesOverVehiclesThatAreOnTheirWayAndDeclaredTypes) {
    const Scene scene;
    const sumo::SessionConfig config = scene.config(
        scene.straight_road(), vehicle("a", "hv", 0, "in out") + vehicle("e", "ev", 1, "in out"));
    std::vector<std::string> arguments = sumo::command_line(config);
    const std::string state = scene.folder() / "state.xml";
    std::vector<std::string> saving = arguments;
    saving.insert(saving.end(), {"--save-state.times", "5", "--save-state.files", state, "--end", "6"});
    ASSERT_TRUE(
        core::run({.program = "sumo", .arguments = saving, .output = scene.folder() / "saving.log"}).ok());
    arguments.insert(arguments.end(), {"--load-state", state});
    const WaitingSumo waiting(arguments, scene.folder() / "waiting.log");
    RemoteSumo remote("localhost", waiting.port());
    remote.declare("hv", traffic::VehicleClass::automated);
    EXPECT_THROW(remote.declare("hx", traffic::VehicleClass::automated), core::InputError);
    Session session(std::move(remote), scene.folder() / "client", config.names);
    session.step();
    EXPECT_EQ(session.snapshot().size(), 2U);
    EXPECT_EQ(session.roster().find(test::key("a"))->vehicle_class, traffic::VehicleClass::automated);
    EXPECT_EQ(session.roster().find(test::key("e"))->vehicle_class, traffic::VehicleClass::emergency);
}

TEST(RemoteSession, SaysWhenNobodyListens) {
    EXPECT_THAT(message_of<core::Error>([] { RemoteSumo("localhost", 1); }),
                AllOf(HasSubstr("no SUMO answers at localhost:1"), HasSubstr("--remote-port")));
}

TEST(RemoteSession, SaysWhenWhatListensIsNoSumo) {
    const Listener listener;
    std::thread other([&] { listener.answer_once("no"); });
    EXPECT_THAT(message_of<core::Error>([&] { RemoteSumo("localhost", listener.port()); }),
                HasSubstr("no SUMO answers"));
    other.join();
}

TEST(RemoteSession, RefusesASumoOfAnotherVersion) {
    using namespace std::string_literals;
    const Listener listener;
    const std::string status = "\x07\x00\x00\x00\x00\x00\x00"s;
    const std::string version = "\x15\x00\x00\x00\x00\x16\x00\x00\x00\x0b"s + "SUMO 1.20.0";
    std::thread other([&] { listener.answer_once("\x00\x00\x00\x20"s + status + version); });
    EXPECT_THAT(message_of<core::Error>([&] { RemoteSumo("localhost", listener.port()); }),
                AllOf(HasSubstr("is SUMO 1.20.0"), HasSubstr("Start a SUMO 1.15")));
    other.join();
}

TEST(RemoteSession, SaysWhenTheConnectionBreaks) {
    const Scene scene;
    const sumo::SessionConfig config = scene.config(scene.straight_road(), vehicle("a", "hv", 0, "in out"));
    const WaitingSumo waiting(sumo::command_line(config), scene.folder() / "waiting.log");
    Session session(RemoteSumo("localhost", waiting.port()), scene.folder() / "client", config.names);
    session.step();
    waiting.kill();
    EXPECT_THAT(message_of<core::Error>([&] {
                    for (int steps = 0; steps < 10; ++steps)
                        session.step();
                }),
                HasSubstr("SUMO cannot step at 0.25 s"));
}

}  // namespace
}  // namespace clearway
