#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/files.hpp"
#include "core/process.hpp"
#include "sumo/scene.hpp"
#include "sumo/session.hpp"

namespace clearway {
namespace {

using sumo::Session;
using test::Scene;

constexpr double fork_s = 180.0;
constexpr double end_s = 400.0;

std::filesystem::path city() {
    const char* home = std::getenv("SUMO_HOME");
    return std::filesystem::path(home == nullptr ? "/usr/share/sumo" : home) / "tools/game/DRT/osm.net.xml";
}

/// 400 trips between random edges that are connected, routed by duarouter.
std::filesystem::path random_routes(const Scene& scene) {
    const sumo::Names names = test::read_names(city());
    std::vector<std::string> edges;
    for (const std::string& edge : names.edges) {
        if (!edge.starts_with(':')) edges.push_back(edge);
    }
    std::mt19937 generator(7);
    std::uniform_int_distribution<std::size_t> any(0, edges.size() - 1);
    std::string trips = "<routes>";
    for (int i = 0; i < 700; ++i) {
        trips += fmt::format(R"(<trip id="t{}" depart="{}" from="{}" to="{}" departLane="best"/>)", i,
                             i * 0.5, edges[any(generator)], edges[any(generator)]);
    }
    const auto trip_file = scene.write("trips.xml", trips + "</routes>");
    const auto route_file = scene.folder() / "city.rou.xml";
    const core::Exit exit =
        core::run({.program = "duarouter",
                   .arguments = {"-n", city(), "-r", trip_file, "-o", route_file, "--ignore-errors",
                                 "--no-warnings", "--xml-validation", "never"},
                   .environment = {},
                   .output = scene.folder() / "duarouter.log"});
    EXPECT_TRUE(exit.ok()) << core::tail(scene.folder() / "duarouter.log", 5);
    return route_file;
}

/// One line per vehicle and step, exact.
void write_state(const Session& session, std::ostream& trace) {
    const truth::Snapshot& now = session.snapshot();
    for (core::VehicleIndex row = 0; row < now.size(); ++row) {
        trace << std::hexfloat << now.time.value << ' ' << now.key[row].value << ' ' << now.x_m[row] << ' '
              << now.y_m[row] << ' ' << now.speed_mps[row] << ' ' << now.lane[row].value << ' '
              << now.route_edge[row] << '\n';
    }
}

/// What a condition does after the fork: an emergency vehicle, and a few commands.
void drive_to_the_end(Session& session, const std::string& route_file, bool interfere,
                      const std::filesystem::path& trace_file) {
    std::ostringstream trace;
    (void)route_file;
    while (session.time().value < end_s) {
        if (interfere && session.snapshot().size() > 0) {
            const traffic::Command command =
                traffic::SetSpeed{session.snapshot().key[0], core::MetresPerSecond(3.0)};
            session.apply(std::span(&command, 1));
        }
        session.step();
        write_state(session, trace);
    }
    session.close();
    core::write_atomically(trace_file, trace.str());
}

/// Runs `work` in a child and waits; true when it returned normally.
bool in_child(const std::function<void()>& work) {
    const pid_t child = ::fork();
    if (child == 0) {
        try {
            work();
        } catch (const std::exception& error) {
            (void)!::write(STDERR_FILENO, error.what(), std::string(error.what()).size());
            ::_exit(1);
        }
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

class Fork : public ::testing::Test {
  protected:
    Fork() : routes_(random_routes(scene_)) {
        config_.network = city();
        config_.route_files = {routes_};
        config_.names = test::read_names(city());
        config_.extra_arguments = {"--vehroute-output", "PLACE", "--vehroute-output.exit-times"};
    }

    /// Every run writes to the same path and is moved away afterwards, because SUMO quotes its arguments.
    sumo::SessionConfig config_in(const std::filesystem::path& folder) const {
        sumo::SessionConfig config = config_;
        config.folder = folder;
        config.extra_arguments[1] = (folder / "vehroutes.xml").string();
        return config;
    }

    Scene scene_;
    std::filesystem::path routes_;
    sumo::SessionConfig config_;
};

TEST_F(Fork, EachChildEqualsAnUnforkedRunByteForByte) {
    const std::filesystem::path folder = scene_.folder() / "run";
    const auto unforked = [&](bool interfere, const char* name) {
        ASSERT_TRUE(in_child([&] {
            Session session(config_in(folder));
            test::step_until(session, fork_s);
            drive_to_the_end(session, routes_, interfere, folder / "trace.txt");
        }));
        std::filesystem::rename(folder, scene_.folder() / name);
    };
    unforked(false, "plain");
    unforked(true, "slowed");

    {
        Session parent(config_in(folder));
        test::step_until(parent, fork_s);
        for (const bool interfere : {true, false, false}) {
            const std::filesystem::path child =
                scene_.folder() / (interfere ? "child_slowed" : "child_plain");
            ASSERT_TRUE(in_child([&] {
                parent.continue_in(child);
                drive_to_the_end(parent, routes_, interfere, child / "trace.txt");
            }));
        }
    }
    for (const char* kind : {"plain", "slowed"}) {
        for (const char* file : {"tripinfo.xml", "vehroutes.xml", "sumo.log", "trace.txt"}) {
            const std::string alone = test::text_without_date(scene_.folder() / kind / file);
            EXPECT_TRUE(alone ==
                        test::text_without_date(scene_.folder() / (std::string("child_") + kind) / file))
                << kind << ' ' << file;
            EXPECT_EQ(alone.size() > 2000, std::string(file) != "sumo.log") << kind << ' ' << file;
        }
    }
    EXPECT_NE(core::read_file(scene_.folder() / "plain/trace.txt"),
              core::read_file(scene_.folder() / "slowed/trace.txt"));
}

}  // namespace
}  // namespace clearway
