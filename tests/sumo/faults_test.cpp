#include <csignal>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "sumo/scene.hpp"
#include "sumo/session.hpp"
#include "support/message_of.hpp"

namespace clearway {
namespace {

using sumo::Session;
using support::message_of;
using test::Scene;
using test::vehicle;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Fault, MissingNetworkIsNamedByTheLog) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), "");
    config.network = scene.folder() / "missing.net.xml";
    EXPECT_THAT(message_of<core::SimulatorError>([&] { Session{config}; }),
                AllOf(HasSubstr("cannot load"), HasSubstr("missing.net.xml"), HasSubstr("not accessible")));
    EXPECT_THAT(core::read_file(config.folder / "sumo.log"), HasSubstr("not accessible"));
}

/// How loading ends in a process of its own whose descriptors are below `limit`: 0, or its error's exit code.
int loads_with(const sumo::SessionConfig& config, rlim_t limit) {
    const pid_t child = fork();
    if (child == 0) {
        const rlimit few{limit, limit};
        ::setrlimit(RLIMIT_NOFILE, &few);
        try {
            const Session session(config);
            _exit(0);
        } catch (const core::Error& error) {
            _exit(static_cast<int>(error.exit_code()));
        }
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(Fault, TooFewDescriptorsAreTheMachinesFaultAndNotTheScenarios) {
    const Scene scene;
    const auto config = scene.config(scene.straight_road(), vehicle("a", "hv", 0, "in out"));
    constexpr int environment = static_cast<int>(core::ExitCode::environment);
    for (rlim_t limit = 3; limit < 16; ++limit)
        EXPECT_THAT(loads_with(config, limit), testing::AnyOf(0, environment)) << limit;
    EXPECT_EQ(loads_with(config, 3), environment) << "nothing can be opened";
    EXPECT_EQ(loads_with(config, 100), 0);
}

TEST(Fault, AfterOneTheProcessTakesNoFurtherSession) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), "");
    auto broken = config;
    broken.network = scene.folder() / "missing.net.xml";
    EXPECT_THROW(Session{broken}, core::SimulatorError);
    EXPECT_THAT(message_of<core::SimulatorError>([&] { Session{config}; }), HasSubstr("new process"));
}

TEST(Fault, MalformedNetworkIsAnError) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), "");
    config.network = scene.write("broken.net.xml", "<net><edge id=");
    EXPECT_THROW(Session{config}, core::SimulatorError);
}

TEST(Fault, MissingRouteFileIsAnError) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), "");
    config.route_files = {scene.folder() / "missing.rou.xml"};
    EXPECT_THAT(message_of<core::SimulatorError>([&] { Session{config}; }), HasSubstr("missing.rou.xml"));
}

TEST(Fault, UnknownEdgeInARouteIsAnError) {
    const Scene scene;
    const auto config = scene.config(scene.straight_road(), vehicle("a", "hv", 0, "in nowhere"));
    EXPECT_THAT(message_of<core::SimulatorError>([&] {
                    Session session(config);
                    test::step_until(session, 2.0);
                }),
                HasSubstr("nowhere"));
}

TEST(Fault, UnconnectedRouteIsAnErrorWithItsTime) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), vehicle("a", "hv", 5, "out in"));
    const std::string message = message_of<core::SimulatorError>([&] {
        Session session(config);
        session.add({.id = "x", .type = "ev", .edges = {"out", "in"}, .depart = core::Seconds(3.0)});
        test::step_until(session, 20.0);
    });
    EXPECT_THAT(message, AllOf(HasSubstr(" s: "), HasSubstr("No connection")));
}

TEST(Fault, FailedSessionIsOnlyGoodForDestruction) {
    const Scene scene;
    Session session(scene.config(scene.straight_road(), ""));
    session.step();
    const traffic::EmergencyDeparture departure{
        .id = "x", .type = "ev", .edges = {"out", "in"}, .depart = core::Seconds(3.0)};
    EXPECT_THROW(
        {
            session.add(departure);
            test::step_until(session, 20.0);
        },
        core::SimulatorError);
    EXPECT_THROW(session.step(), std::logic_error);
    EXPECT_NO_THROW(session.close());
}

TEST(Fault, FolderThatIsAFileIsAnEnvironmentError) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), "");
    config.folder = scene.write("file", "");
    EXPECT_THAT(message_of<core::EnvironmentError>([&] { Session{config}; }), HasSubstr("file"));
}

TEST(Fault, OutputThatCannotBeWrittenIsAnEnvironmentError) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), "");
    std::filesystem::create_directories(config.folder / "tripinfo.xml");
    EXPECT_THAT(message_of<core::EnvironmentError>([&] { Session{config}; }), HasSubstr("tripinfo.xml"));
    std::filesystem::remove_all(config.folder);
    Session session(config);
    session.step();
}

TEST(Fault, FullDiskIsNoticedAtTheEnd) {
    const Scene scene;
    std::string vehicles;
    for (int i = 0; i < 40; ++i) {
        vehicles += vehicle("v" + std::to_string(i), "hv", i, "in");
    }
    Session session(scene.config(scene.straight_road(), vehicles));
    test::step_until(session, 30.0);
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    test::step_until(session, 120.0);
    EXPECT_THAT(message_of<core::EnvironmentError>([&] { session.close(); }),
                HasSubstr("Files are limited to 4 KiB"));
}

TEST(Fault, ConfigurationProblemsAreCollected) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), "");
    config.step_length = core::Seconds(1.5);
    config.begin = core::Seconds(-1.0);
    config.time_to_teleport = core::Seconds(std::numeric_limits<double>::quiet_NaN());
    config.extra_arguments = {"--seed", "5", "-e", "100", "--step-length=0.5", "--max-depart-delay", "10"};
    try {
        Session session(config);
        FAIL() << "was accepted";
    } catch (const core::InputError& error) {
        EXPECT_EQ(error.problems().size(), 7U) << error.what();
    }
    config = scene.config(scene.straight_road(), "");
    config.step_length = core::Seconds(0.0333333);
    EXPECT_THAT(message_of<core::InputError>([&] { Session{config}; }), HasSubstr("milliseconds"));
}

TEST(Fault, OutputOutsideTheFolderIsRefused) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), "");
    config.extra_arguments = {"--vehroute-output", (scene.folder() / "elsewhere.xml").string()};
    EXPECT_THAT(message_of<core::InputError>([&] { Session{config}; }), HasSubstr("elsewhere.xml"));
}

TEST(Fault, ArgumentThatSumoDoesNotKnowIsAnErrorThatNamesIt) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), "");
    config.extra_arguments = {"--no-such-option", "1"};
    EXPECT_THAT(message_of<core::SimulatorError>([&] { Session{config}; }), HasSubstr("no-such-option"));
}

TEST(Fault, NamesOfAnotherNetworkAreRefused) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), vehicle("a", "hv", 0, "in"));
    config.names.signals = {"nowhere"};
    EXPECT_THAT(message_of<std::invalid_argument>([&] { Session{config}; }), HasSubstr("nowhere"));
    config.names.signals = {};
    config.names.edges = {"out"};
    Session session(config);
    EXPECT_THAT(message_of<std::invalid_argument>([&] { session.step(); }), HasSubstr("'in'"));
}

TEST(Fault, ClassThatDoesNotExistIsAnInputError) {
    const Scene scene;
    auto config = scene.config(scene.straight_road(), vehicle("a", "odd", 0, "in"));
    config.additional_files.push_back(scene.write(
        "odd.add.xml", R"(<additional><vType id="odd"><param key="clearway.class" value="humna"/>)"
                       R"(<param key="clearway.kind" value="tram"/></vType></additional>)"));
    Session session(config);
    const std::string message = message_of<core::InputError>([&] { session.step(); });
    EXPECT_THAT(message, AllOf(HasSubstr("humna"), HasSubstr("tram"), HasSubstr("'odd'")));
}

}  // namespace
}  // namespace clearway
