// Cities from the command line: import, check, run, trajectories.
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "scenario_import/town.hpp"
#include "user.hpp"

namespace clearway::cli {
namespace {

class CityTest : public UserTest {};

TEST_F(CityTest, an_imported_town_is_checked_run_and_written_as_geojson) {
    write("town.osm", scenario_import::town_map());
    const Ended import = clearway({"scenario", "import", "town.osm", "--name", "town"});
    ASSERT_EQ(import.code, 0) << import.err;
    EXPECT_THAT(import.out, testing::ContainsRegex("All\\s+EVs\\s+are\\s+ambulances:\\s+--emergency-kinds"));
    EXPECT_THAT(import.out, AllOf(HasSubstr("76 open to cars"), HasSubstr("1 fire station, 1 hospital"),
                                  HasSubstr("town/network.svg")));
    const Ended check = clearway({"scenario", "check", "./town", "--density", "0.3", "--json"});
    EXPECT_EQ(check.code, 0) << check.out << check.err;
    EXPECT_EQ(nlohmann::json::parse(check.out).at(0).at("finding"), "loads");
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs/check-town"));

    const Ended run =
        clearway({"run", "./town", "--density", "0.3", "--seeds", "1", "--no-solo", "--policy", "corridor",
                  "--failure", "B10", "--predictor", "dead_reckoning", "--record", "--out", "out"});
    ASSERT_EQ(run.code, 0) << run.err;
    const Ended written =
        clearway({"export", "trajectories", "out/town/corridor_B10_dead_reckoning/0", "--out", "ways"});
    ASSERT_EQ(written.code, 0) << written.err;
    const auto json = nlohmann::json::parse(read("ways/trajectories.geojson"));
    ASSERT_FALSE(json.at("features").empty());
    for (const auto& place : json["features"][0]["geometry"]["coordinates"]) {
        EXPECT_NEAR(place[0].get<double>(), 13.004, 0.006);
        EXPECT_NEAR(place[1].get<double>(), 51.004, 0.006);
    }
    EXPECT_THAT(read("ways/trajectories.csv"),
                AllOf(HasSubstr("time_s,vehicle,class,near"), HasSubstr(",emergency,,")));
    core::Command sumo{"sumo",
                       {"-c", (folder() / "ways/sumo/run.sumocfg").string(), "--end", "60"},
                       {},
                       folder() / "sumo.log"};
    EXPECT_TRUE(core::run(sumo).ok()) << read("sumo.log");
}

TEST_F(CityTest, a_scenario_of_sumo_is_imported_checked_and_run_with_its_persons) {
    const core::Command netgenerate{
        "netgenerate",
        {"--grid", "--grid.number", "3", "--grid.length", "200", "--default-junction-type", "traffic_light",
         "--sidewalks.guess", "--crossings.guess", "-o", (folder() / "grid.net.xml").string()},
        {},
        folder() / "netgenerate.log"};
    ASSERT_TRUE(core::run(netgenerate).ok());
    std::string routes = "<routes>";
    for (int number = 0; number < 20; ++number)
        routes += fmt::format(
            "<vehicle id='{0}' depart='{1}'><route edges='A0A1 A1A2 A2B2'/></vehicle><person id='{0}' "
            "depart='{1}'><walk from='A0A1' to='B1B2'/></person>",
            number, 3 * number);
    write("town.rou.xml", routes +
                              "<person id='rider' depart='9'><ride lines='ANY' from='A0A1' to='A1A2'/>"
                              "</person></routes>");
    write(
        "run.sumocfg",
        "<configuration><net-file value='grid.net.xml'/><route-files value='town.rou.xml'/></configuration>");
    const Ended import = clearway({"scenario", "import", "run.sumocfg", "--name", "town"});
    ASSERT_EQ(import.code, 0) << import.err;
    EXPECT_THAT(import.out, AllOf(HasSubstr("persons          20 walk"),
                                  HasSubstr("does not come in that time (rider)")));
    EXPECT_EQ(nlohmann::json::parse(read("town/import.json")).at("persons"), 20);
    const Ended check = clearway({"scenario", "check", "./town"});
    EXPECT_EQ(check.code, 0) << check.out << check.err;
    const Ended run = clearway(
        {"run", "./town", "--seeds", "1", "--no-solo", "--policy", "corridor", "--record", "--out", "out"});
    ASSERT_EQ(run.code, 0) << run.err;
    for (const char* const name : {"baseline", "corridor"})
        EXPECT_EQ(nlohmann::json::parse(read(fmt::format("out/runs/town/{}/00000/run.json", name)))
                      .at("metrics")
                      .at("pedestrian_count"),
                  20)
            << name;
    ASSERT_EQ(clearway({"export", "trajectories", "out/town/corridor/0", "--out", "ways"}).code, 0);
    EXPECT_THAT(read("ways/sumo/run.sumocfg"), HasSubstr("emergency.rou.xml,persons.rou.xml"));
}

/// A netconvert that begins late holds up the import for longer than the lines are apart.
TEST_F(CityTest, an_import_says_every_ten_seconds_that_it_works) {
    write("town.osm", scenario_import::town_map());
    const std::filesystem::path slow =
        write("slow/netconvert", "#!/bin/sh\nsleep 10.5\necho late >&2\nexit 1\n");
    std::filesystem::permissions(slow, std::filesystem::perms::owner_all);
    const Ended import =
        clearway({"scenario", "import", "town.osm", "--name", "town"},
                 {.environment = {{"PATH", (folder() / "slow").string() + ":/usr/bin:/bin"}}});
    EXPECT_EQ(import.code, 3);
    EXPECT_THAT(import.err,
                AllOf(testing::ContainsRegex("import: [a-z ]+, 0:1[0-9] elapsed"), HasSubstr("late")));
}

TEST_F(CityTest, emergency_vehicles_go_round_a_road_that_is_closed_to_them) {
    const core::Command netgenerate{
        "netgenerate",
        {"--grid", "--grid.number", "4", "--grid.length", "200", "-o", (folder() / "grid.net.xml").string()},
        {},
        folder() / "netgenerate.log"};
    ASSERT_TRUE(core::run(netgenerate).ok());
    write("town.rou.xml",
          "<routes><flow id='t' begin='0' end='100' number='20' from='A0A1' to='A2A3'/></routes>");
    write("works.add.xml",
          "<additional><rerouter id='r' edges='A0A1'><interval begin='0' end='3600'><closingReroute "
          "id='A1A2' allow='authority'/></interval></rerouter></additional>");
    ASSERT_EQ(
        clearway({"scenario", "import", "grid.net.xml", "town.rou.xml", "works.add.xml", "--name", "town"})
            .code,
        0);
    const Ended run = clearway(
        {"run", "./town", "--seeds", "1", "--no-solo", "--policy", "corridor", "--record", "--out", "out"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(nlohmann::json::parse(read("out/runs/town/corridor/00000/run.json"))
                  .at("metrics")
                  .at("emergency_arrived"),
              6);
}

// It fills slowly: judged after seven minutes it took half as many cars again, and jammed after twelve.
TEST_F(CityTest, the_demand_of_an_import_does_not_jam_a_town_that_fills_slowly) {
    const std::string sumo_home =
        std::getenv("SUMO_HOME") != nullptr ? std::getenv("SUMO_HOME") : "/usr/share/sumo";
    const Ended import =
        clearway({"scenario", "import", sumo_home + "/tools/game/DRT/osm.net.xml", "--name", "town"});
    ASSERT_EQ(import.code, 0) << import.err;
    EXPECT_THAT(import.out, HasSubstr("after 12 to 15 minutes"));
    const Ended check = clearway({"scenario", "check", "./town"});
    EXPECT_EQ(check.code, 0) << check.out << check.err;
    EXPECT_THAT(check.out, testing::ContainsRegex("ok +jams"));
}

TEST_F(CityTest, the_files_of_sumo_are_those_of_the_condition) {
    write_line_scenario();
    ASSERT_EQ(clearway({"run", "line", "--seeds", "1", "--no-solo", "--traffic-model", "sublane",
                        "--bluelight", "on", "--name", "blue", "--record", "--out", "out"})
                  .code,
              0);
    ASSERT_EQ(clearway({"export", "trajectories", "out/line/blue/0", "--out", "blue"}).code, 0);
    EXPECT_THAT(read("blue/sumo/run.sumocfg"), HasSubstr("<lateral-resolution value=\"0.5\"/>"));
    EXPECT_THAT(read("blue/sumo/emergency.rou.xml"), HasSubstr("has.bluelight.device"));
    ASSERT_EQ(clearway({"export", "trajectories", "out/line/baseline_sublane/0", "--out", "plain"}).code, 0);
    EXPECT_THAT(read("plain/sumo/run.sumocfg"), HasSubstr("lateral-resolution"));
    EXPECT_THAT(read("plain/sumo/emergency.rou.xml"), Not(HasSubstr("bluelight")));
    const core::Command sumo{
        "sumo", {"-c", (folder() / "blue/sumo/run.sumocfg").string()}, {}, folder() / "sumo.log"};
    EXPECT_TRUE(core::run(sumo).ok()) << read("sumo.log");
}

TEST_F(CityTest, a_network_without_projection_gives_csv_alone) {
    write_line_scenario();
    ASSERT_EQ(clearway({"run", "line", "--seeds", "1", "--no-solo", "--condition", "baseline", "--record",
                        "--out", "out"})
                  .code,
              0);
    const Ended written = clearway({"export", "trajectories", "out/line/baseline/0", "--out", "ways"});
    EXPECT_EQ(written.code, 0) << written.err;
    EXPECT_THAT(written.err, HasSubstr("no known map projection"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "ways/trajectories.geojson"));
    const Ended missing = clearway({"export", "trajectories", "out/line/baseline/7"});
    EXPECT_EQ(missing.code, 3);
    EXPECT_THAT(missing.err, HasSubstr("`7` is not in this study"));
    std::filesystem::remove_all(folder() / "out/recordings");
    const Ended unrecorded = clearway({"export", "trajectories", "out/line/baseline/0"});
    EXPECT_EQ(unrecorded.code, 3);
    EXPECT_THAT(unrecorded.err, HasSubstr("--record"));
    EXPECT_EQ(clearway({"export", "trajectories", "nowhere"}).code, 3);
}

TEST_F(CityTest, check_says_how_many_emergency_vehicles_pass_a_signal) {
    EXPECT_THAT(
        clearway({"scenario", "check", "intersection"}).out,
        AllOf(testing::ContainsRegex("ok +signals +1 in the network; ([0-9]+) of [0-9]+ EVs pass one"),
              Not(HasSubstr("parts.toml"))));
    const Ended city = clearway({"scenario", "check", "city_v2", "--json"});
    const auto findings = nlohmann::json::parse(city.out);
    const auto signals =
        std::ranges::find(findings, "signals", [](const auto& each) { return each["finding"]; });
    ASSERT_NE(signals, findings.end());
    EXPECT_THAT(signals->at("text").get<std::string>(), HasSubstr("EVs pass one"));
    EXPECT_EQ(signals->at("numbers").at("prospect"), "helps");
}

TEST_F(CityTest, check_says_whether_there_are_emergency_vehicles) {
    write_line_scenario();
    const Ended fit = clearway({"scenario", "check", "line"});
    EXPECT_EQ(fit.code, 0) << fit.out << fit.err;
    EXPECT_THAT(fit.err, HasSubstr("clearway: 1 run into"));
    EXPECT_THAT(fit.out,
                HasSubstr("\nBy programs and trips alone, preemption has little to gain: the network"));
    EXPECT_THAT(fit.out, HasSubstr("\nline is fit for a study, "));
    for (const auto& left : std::filesystem::directory_iterator(folder() / "runs"))
        EXPECT_EQ(left.path().filename(), "run-costs.json");
    EXPECT_THAT(clearway({"run", "line", "--dry-run", "--seeds", "2"}).out, HasSubstr("(from runs of"));
    std::istringstream lines(fit.out);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 80U) << line;
    EXPECT_THAT(fit.out, testing::ContainsRegex("1 arrived;\\s+all\\s+ambulances;\\s+--emergency-kinds"));
    EXPECT_THAT(fit.out, AllOf(HasSubstr("1 EV with a route, 1 entered, 1 arrived"),
                               testing::ContainsRegex("note +signals +0 in the network: signal policies have "
                                                      "no effect here"),
                               Not(HasSubstr("try:"))));
    write_line_scenario("emergency = 1", "emergency = 0");
    const Ended none = clearway({"scenario", "check", "line"});
    EXPECT_EQ(none.code, 6);
    EXPECT_THAT(none.out, AllOf(HasSubstr("0 EVs with a route"), HasSubstr("try: set demand.emergency"),
                                HasSubstr("line is not fit for a study as it is: emergency.")));
}

TEST_F(CityTest, check_tries_whether_a_scenario_locks) {
    write_line_scenario();
    const Ended tried = clearway({"scenario", "check", "line", "--seed", "7", "--lock-trials", "2"});
    EXPECT_THAT(tried.err,
                testing::ContainsRegex("4 runs more to look for locks, about [0-9]+:[0-9]+ \\(m:s\\)"));
    EXPECT_EQ(tried.code, 0) << tried.out << tried.err;
    EXPECT_THAT(tried.out, testing::ContainsRegex(
                               "ok +trials +without time.ignore_junction_blocker_s = 10, as here, none of"));
    EXPECT_THAT(tried.out, testing::ContainsRegex("ok +locks +none in this run of seed 7, [0-9]+ s"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs/check-line-locks"));
}

TEST_F(CityTest, check_prints_what_it_found_before_its_lock_trials_were_interrupted) {
    write_line_scenario();
    const core::Child child = start({"scenario", "check", "line", "--lock-trials", "500"});
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!std::filesystem::exists(folder() / "runs/check-line-locks/runs") &&
           std::chrono::steady_clock::now() < patience)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ::kill(child.pid, SIGINT);
    const Ended interrupted = finish(child);
    EXPECT_EQ(interrupted.code, 130) << interrupted.err;
    EXPECT_THAT(interrupted.out, AllOf(HasSubstr("SUMO loads the network"), Not(HasSubstr(" trials "))));
}

TEST_F(CityTest, check_says_when_vehicles_drive_one_edge_alone) {
    write_line_scenario();
    EXPECT_THAT(clearway({"scenario", "check", "line"}).out,
                testing::ContainsRegex("ok +routes +on a single edge, through no junction: 0 of"));
    write_line_scenario("to = \"second\"", "to = \"first\"");
    const Ended ended = clearway({"scenario", "check", "line"});
    EXPECT_EQ(ended.code, 6) << ended.out << ended.err;
    EXPECT_THAT(ended.out,
                AllOf(testing::ContainsRegex("short +routes"), testing::ContainsRegex("1 of\\s+1 EV")));
}

TEST_F(CityTest, check_does_not_blame_density_where_evs_are_called_to_a_closed_road) {
    ASSERT_EQ(clearway({"scenario", "init", "grid", "--from", "grid_signals_v2"}).code, 0);
    const std::string drawn = read("grid/scenario.toml");
    const std::size_t emergency = drawn.find("emergency = 4");
    ASSERT_NE(emergency, std::string::npos);
    std::string text = drawn;
    text.replace(emergency, 13, "emergency = 0");
    text += "[[emergency_site]]\nkind = \"ambulance_station\"\nedge = \"A1A0\"\nunits = 6\n";
    write("grid/scenario.toml", text +
                                    "[[incident]]\nedge = \"B1C1\"\nfrom_s = 100\nto_s = 900\n"
                                    "known_after_s = 30\n[[call]]\nincident = 0\nunits = 4\n");
    const std::string queue = clearway({"scenario", "check", "./grid"}).out;
    EXPECT_THAT(queue,
                AllOf(testing::ContainsRegex("called\\s+to\\s+a\\s+closed\\s+road\\s+did\\s+not\\s+arrive"),
                      testing::ContainsRegex("try: leave a lane open"), Not(HasSubstr("--density")),
                      testing::ContainsRegex("closed\\s+until\\s+900"), Not(HasSubstr("--incident none"))));
    // On the station's own edge.
    write("grid/scenario.toml", text + "[[call]]\nedge = \"A1A0\"\nat_s = 100\n");
    EXPECT_THAT(clearway({"scenario", "check", "./grid"}).out,
                AllOf(HasSubstr("try: another edge for the call"), Not(HasSubstr("minimum_length_m"))));
}

TEST_F(CityTest, check_of_a_run_that_fails_exits_with_1_and_keeps_the_inputs) {
    const Ended failed = clearway({"scenario", "check", "city", "--run-time-limit", "0.001"});
    EXPECT_EQ(failed.code, 1) << failed.out << failed.err;
    EXPECT_THAT(failed.out,
                AllOf(HasSubstr("FAILED"), HasSubstr("runs/check-city"), HasSubstr("clearway-run")));
    EXPECT_TRUE(std::filesystem::exists(folder() / "runs/check-city/manifest.json"));
    EXPECT_EQ(clearway({"scenario", "check", "city"}).code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder() / "runs/check-city"));
}

TEST_F(CityTest, an_import_that_leaves_out_many_vehicles_falls_short) {
    const core::Command netgenerate{
        "netgenerate",
        {"--grid", "--grid.number", "3", "--grid.length", "200", "-o", (folder() / "grid.net.xml").string()},
        {},
        folder() / "netgenerate.log"};
    ASSERT_TRUE(core::run(netgenerate).ok());
    const auto vehicles = [](int bad) {
        std::string routes = "<routes>";
        for (int number = 0; number < 20; ++number)
            routes += fmt::format("<vehicle id='{0}' depart='{1}'><route edges='{2}'/></vehicle>", number,
                                  3 * number, number < bad ? "A0A1 C2B2" : "A0A1 A1A2 A2B2");
        return routes + "</routes>";
    };
    write("few.rou.xml", vehicles(2));
    write("many.rou.xml", vehicles(3));
    const auto import = [&](const std::string& name) {
        return clearway({"scenario", "import", "grid.net.xml", name + ".rou.xml", "--name", name,
                         "--leave-out-bad-vehicles"});
    };
    const Ended few = import("few");
    EXPECT_EQ(few.code, 0) << few.err;
    EXPECT_THAT(few.out, Not(HasSubstr("short")));
    const Ended many = import("many");
    EXPECT_EQ(many.code, 6) << many.err;
    EXPECT_THAT(many.out, HasSubstr("short            15 % of the vehicles cannot drive their route"));
}

TEST_F(CityTest, steps_of_a_second_are_marked) {
    write_line_scenario();
    const Ended run =
        clearway({"run", "line", "--seeds", "1", "--no-solo", "--step-length", "1", "--out", "out"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("steps of 1 s: use them only to compare"));
    EXPECT_THAT(read("out/report.html"), HasSubstr("(!) steps of 1 s: use them only to compare"));
    const Ended usual = clearway({"run", "line", "--seeds", "1", "--no-solo", "--out", "usual"});
    EXPECT_THAT(usual.out + read("usual/report.html"), Not(HasSubstr("use them only to compare")));
}

TEST_F(CityTest, an_import_says_what_to_type_next_in_words_for_a_shell) {
    write("town.osm", scenario_import::town_map());
    const Ended relative = clearway({"scenario", "import", "town.osm", "--name", "my folder/town"});
    ASSERT_EQ(relative.code, 0) << relative.err;
    EXPECT_THAT(relative.out,
                HasSubstr("Next: clearway scenario check './my folder/town'\n(--lock-trials 6 looks"));
    const std::string absolute = (folder() / "other").string();
    EXPECT_THAT(clearway({"scenario", "import", "town.osm", "--name", absolute}).out,
                HasSubstr("Next: clearway scenario check " + absolute + "\n"));
}

TEST_F(CityTest, what_cannot_be_imported_is_bad_input_and_leaves_nothing) {
    write("page.osm", "<!DOCTYPE html><html></html>");
    const Ended ended = clearway({"scenario", "import", "page.osm", "--name", "page"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("web page"));
    for (const auto& entry : std::filesystem::directory_iterator(folder()))
        EXPECT_THAT(entry.path().filename().string(), AllOf(Not("page"), Not(HasSubstr("importing"))));
}

TEST_F(CityTest, an_interrupted_import_leaves_nothing) {
    write("town.osm", scenario_import::town_map());
    const core::Child child = start({"scenario", "import", "town.osm", "--name", "town"});
    while (!std::filesystem::exists(folder() / fmt::format(".town.clearway-import-{}", child.pid)) &&
           !std::filesystem::exists(folder() / "town")) {
    }
    ::kill(child.pid, SIGINT);
    const Ended ended = finish(child);
    EXPECT_EQ(ended.code, 130) << ended.err;
    for (const auto& entry : std::filesystem::directory_iterator(folder()))
        EXPECT_THAT(entry.path().filename().string(), AllOf(Not("town"), Not(HasSubstr("importing"))));
}

}  // namespace
}  // namespace clearway::cli
