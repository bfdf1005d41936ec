// A SUMO that the user has started, from the command line.
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "sumo/waiting_sumo.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

using test::WaitingSumo;

/// A user with a simulation of SUMO: the shipped crossing with cars on all arms, and an ambulance of vClass
/// emergency.
class AttachTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        const std::filesystem::path source = CLEARWAY_SOURCE_DIR "/scenarios/intersection";
        std::vector<std::string> arguments = {"--output-file", network(), "--no-turnarounds"};
        for (const auto& [option, ending] :
             {std::pair{"--node-files", ".nod.xml"}, std::pair{"--edge-files", ".edg.xml"},
              std::pair{"--tllogic-files", ".tll.xml"}, std::pair{"--connection-files", ".con.xml"}}) {
            for (const auto& entry : std::filesystem::directory_iterator(source))
                if (entry.path().string().ends_with(ending))
                    arguments.insert(arguments.end(), {option, entry.path()});
        }
        ASSERT_TRUE(core::run({"netconvert", arguments, {}, folder() / "netconvert.log"}).ok())
            << read("netconvert.log");
        std::string vehicles = R"(<vType id="car"/><vType id="robot" carFollowModel="IDM"/>)"
                               R"(<vType id="ambulance" vClass="emergency"/>)";
        for (int i = 0; i < 60; ++i) {
            const bool is_ambulance = i == 30;
            const char* const type = is_ambulance ? "ambulance" : i % 2 == 0 ? "car" : "robot";
            const char* const way = i % 3 == 0 ? "south_in north_out" : "west_in east_out";
            vehicles += "<vehicle id=\"" + std::to_string(i) + "\" type=\"" + type + "\" depart=\"" +
                        std::to_string(i) + "\"><route edges=\"" + way + "\"/></vehicle>";
        }
        write("routes.rou.xml", "<routes>" + vehicles + "</routes>");
        // Its user's own, which Clearway lets alone.
        write("own.add.xml", "<additional><edgeData id=\"flow\" file=\"flow.xml\"/></additional>");
    }

    std::string network() const { return folder() / "net.net.xml"; }
    std::vector<std::string> arguments() const {
        return {"-a",
                folder() / "own.add.xml",
                "-n",
                network(),
                "-r",
                folder() / "routes.rou.xml",
                "--step-length",
                "0.25",
                "--xml-validation",
                "never",
                "--tripinfo-output",
                folder() / "trips.xml"};
    }
    static std::string place(int port) { return "localhost:" + std::to_string(port); }
};

TEST_F(AttachTest, a_simulation_goes_on_under_a_policy_and_becomes_a_run_folder) {
    const WaitingSumo sumo(arguments(), folder() / "sumo.log");
    const Ended ended = clearway(
        {"attach", place(sumo.port()), "--policy", "corridor", "--automated", "robot", "--out", "out"});
    ASSERT_EQ(ended.code, 0) << ended.err << read("sumo.log");
    EXPECT_THAT(ended.out, HasSubstr("attached"));
    const Ended runs = clearway({"export", "results", "out", "runs", "--json"});
    const auto run = nlohmann::json::parse(runs.out).at(0);
    EXPECT_EQ(run.at("vehicle_count"), 60) << run;
    EXPECT_EQ(run.at("emergency_count"), 1);
    EXPECT_EQ(run.at("emergency_arrived"), 1);
    EXPECT_GT(run.at("leases_issued"), 0);
    const Ended vehicles = clearway({"export", "results", "out", "vehicles", "--csv"});
    EXPECT_THAT(vehicles.out, AllOf(HasSubstr("automated"), HasSubstr("human"), HasSubstr("emergency")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out.job"));
    EXPECT_EQ(clearway({"attach", place(sumo.port()), "--out", "out"}).code, 3) << "the folder exists";
}

TEST_F(AttachTest, what_cannot_work_is_told_and_leaves_no_run_folder) {
    const auto refused = [&](const std::vector<std::string>& words, int code, const char* said) {
        std::vector<std::string> all = {"attach"};
        all.insert(all.end(), words.begin(), words.end());
        const Ended ended = clearway(all);
        EXPECT_EQ(ended.code, code) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(said));
        EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
        EXPECT_FALSE(std::filesystem::exists(folder() / "out.job"));
    };
    refused({"localhost:99999", "--out", "out"}, 3, "1 to 65535");
    refused({"localhost:8813", "--policy", "coridor", "--out", "out"}, 3, "corridor");
    refused({"localhost:1", "--out", "out"}, 4, "no SUMO answers");
    for (const std::string& answer :
         {std::string(16, '\0'), std::string(16, '\xff'), std::string("HTTP/1.1 400 Bad Request"),
          std::string("\0\0\0\x04\0\0\0\0", 8), std::string("\0\0\0\x08\x01\x02\x03\x04", 8)}) {
        const test::Listener listener;
        std::thread other([&] { listener.answer_once(answer); });
        refused({place(listener.port()), "--out", "out"}, 4, "no SUMO answers at localhost:");
        other.join();
    }
    {
        const WaitingSumo silent({"-n", network(), "-r", folder() / "routes.rou.xml"}, folder() / "sumo.log");
        refused({place(silent.port()), "--out", "out"}, 3, "--tripinfo-output");
    }
    {
        const WaitingSumo other(arguments(), folder() / "sumo.log");
        refused({place(other.port()), "--automated", "robt", "--out", "out"}, 3, "robot");
    }
    EXPECT_EQ(clearway({"attach", "localhost:1"}).code, 4);
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs"));
    const WaitingSumo broken(arguments(), folder() / "sumo.log");
    const core::Child attached = start({"attach", place(broken.port()), "--out", "out"});
    while (!std::filesystem::exists(folder() / "out/manifest.json"))
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    broken.kill();
    const Ended ended = finish(attached);
    EXPECT_EQ(ended.code, 1) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("SUMO cannot"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

}  // namespace
}  // namespace clearway::cli
