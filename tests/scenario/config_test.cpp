#include "scenario/config.hpp"

#include <algorithm>

#include <gmock/gmock.h>

#include "core/files.hpp"
#include "scenario/overrides.hpp"
#include "scratch.hpp"

namespace clearway::scenario {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::Not;

class Config : public ScratchTest {
  protected:
    void SetUp() override {
        ScratchTest::SetUp();
        write("line.nod.xml", line_nodes);
        write("line.edg.xml", line_edges);
    }
    ScenarioConfig load_text(const std::string& rest, const Options& options = {}) const {
        return load(write("scenario.toml", line_head + rest).string(), options);
    }
    core::Problem only_problem(const std::string& rest, const Options& options = {}) const {
        const auto problems = problems_of([&] { load_text(rest, options); });
        EXPECT_EQ(problems.size(), 1U);
        return problems.empty() ? core::Problem{} : problems.front();
    }
};

TEST_F(Config, shipped_scenarios_are_listed_and_load) {
    EXPECT_THAT(
        list(),
        ElementsAre("arterial", "bologna", "bologna_stretch", "bologna_stretch_v2", "bologna_v2", "city",
                    "city_accident", "city_v2", "grid_signals", "grid_signals_v2", "intersection", "merge",
                    "motorway_jam", "motorway_jam_3km", "motorway_jam_three_lanes",
                    "motorway_jam_three_lanes_3km", "random_town", "rural", "short_grid", "short_grid_v2",
                    "short_ring", "short_ring_v2", "short_town", "short_town_v2", "spider"));
    for (const std::string& name : list()) {
        const ScenarioConfig config = load(name);
        EXPECT_EQ(config.name, name);
        EXPECT_EQ(config.version, name.ends_with("_v2") ? "v2" : "v1");
    }
}

TEST_F(Config, v2_is_v1_but_for_vehicles_that_block_a_junction) {
    for (const std::string& name : list()) {
        const ScenarioConfig first = load(name);
        if (first.version != "v1" || name == "city_accident") continue;  // younger than the cure
        EXPECT_FALSE(first.time.ignore_junction_blocker_s) << name;
        if (newest(name) == name) continue;
        ScenarioConfig second = load(newest(name));
        EXPECT_EQ(second.time.ignore_junction_blocker_s, usual_ignore_junction_blocker_s);
        EXPECT_NE(configuration_hash(first), configuration_hash(second));
        second.name = first.name;
        second.version = first.version;
        second.time.ignore_junction_blocker_s.reset();
        EXPECT_EQ(to_toml(first), to_toml(second));
    }
    EXPECT_EQ(newest("city"), "city_v2");
    EXPECT_EQ(newest("merge"), "merge");
}

TEST_F(Config, a_file_with_a_base_changes_only_the_keys_that_it_names) {
    std::filesystem::create_directories(folder() / "road");
    std::filesystem::create_directories(folder() / "road_v2");
    write("road/line.nod.xml", line_nodes);
    write("road/line.edg.xml", line_edges);
    write("road/scenario.toml", std::string(line_head) + "[demand]\nhuman = 7\nautomated = 3\n");
    const auto file =
        write("road_v2/scenario.toml", "base = \"road\"\nversion = \"v2\"\n[demand]\nhuman = 8\n");
    const ScenarioConfig config = load(file.string());
    EXPECT_EQ(config.version, "v2");
    EXPECT_EQ(config.demand.human, 8);
    EXPECT_EQ(config.demand.automated, 3);
    EXPECT_TRUE(std::filesystem::exists(resolve(config, config.network.nodes)));
    init(folder() / "mine", file.string());
    EXPECT_EQ(load((folder() / "mine").string()).demand.human, 8);
    const auto problems = problems_of([&] { load(write("scenario.toml", "base = \"gone\"\n").string()); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].what, HasSubstr("gone/scenario.toml"));
}

TEST_F(Config, a_base_is_a_whole_scenario_in_a_folder_beside) {
    std::filesystem::create_directories(folder() / "one");
    const auto what_is_wrong = [&](const std::string& base) {
        const auto file = write("one/scenario.toml", "base = " + base + "\n");
        const auto problems = problems_of([&] { load(file.string()); });
        return problems.size() == 1 ? problems[0].what : "";
    };
    EXPECT_THAT(what_is_wrong("\"one\""), HasSubstr("scenario one has a base of its own"));
    for (const char* const base : {"3", "\"\"", "\"../one\"", "\"..\"", "\"/one\""})
        EXPECT_THAT(what_is_wrong(base), HasSubstr("is no name of a folder")) << base;
}

TEST_F(Config, a_copy_gets_its_remedy_against_locks_where_the_table_is_a_line) {
    std::filesystem::create_directories(folder() / "road");
    write("road/line.nod.xml", line_nodes);
    write("road/line.edg.xml", line_edges);
    const auto file =
        write("road/scenario.toml", std::string(line_head) + "[time]  # clock\nwarm_up_s = 5.0\n");
    const auto problems = problems_of([&] { init(folder() / "mine", file.string()); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].cure, HasSubstr("time.ignore_junction_blocker_s"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "mine"));
    write("road/scenario.toml", std::string(line_head) + "[time]\nwarm_up_s = 5.0\n");
    init(folder() / "mine", file.string());
    const ScenarioConfig copy = load((folder() / "mine").string());
    EXPECT_EQ(copy.time.warm_up_s, 5.0);
    EXPECT_EQ(copy.time.ignore_junction_blocker_s, usual_ignore_junction_blocker_s);
}

TEST_F(Config, junction_blockers_are_a_key_and_an_override_in_the_hash) {
    Options options;
    options.set("ignore_junction_blocker_s", "5");
    const ScenarioConfig config = load("merge", options);
    EXPECT_EQ(config.time.ignore_junction_blocker_s, 5.0);
    EXPECT_THAT(to_toml(config), HasSubstr("ignore_junction_blocker_s = 5\n"));
    EXPECT_NE(configuration_hash(config), configuration_hash(load("merge")));
    options.set("ignore_junction_blocker_s", "-2");
    EXPECT_EQ(problems_of([&] { load("merge", options); }).size(), 1U);
}

TEST_F(Config, a_scenario_of_ones_own_starts_without_locks) {
    init(folder() / "mine", "intersection");
    EXPECT_EQ(load((folder() / "mine").string()).time.ignore_junction_blocker_s,
              usual_ignore_junction_blocker_s);
    init(folder() / "kept", "city_v2");
    EXPECT_EQ(load((folder() / "kept").string()).time.ignore_junction_blocker_s,
              usual_ignore_junction_blocker_s);
}

TEST_F(Config, counts_and_limits_are_those_of_table_1) {
    struct Row {
        const char* name;
        int human, automated, emergency;
        double fast_kmh, human_kmh, window_s;
    };
    for (const Row& row :
         {Row{"merge", 23, 14, 3, 140, 120, 100}, Row{"intersection", 26, 16, 2, 140, 120, 120},
          Row{"city", 47, 26, 7, 120, 100, 200}}) {
        const ScenarioConfig config = load(row.name);
        EXPECT_EQ(config.demand.human, row.human);
        EXPECT_EQ(config.demand.automated, row.automated);
        EXPECT_EQ(config.demand.emergency, row.emergency);
        EXPECT_EQ(config.limits.emergency_kmh, row.fast_kmh);
        EXPECT_EQ(config.limits.automated_kmh, row.fast_kmh);
        EXPECT_EQ(config.limits.human_kmh, row.human_kmh);
        EXPECT_EQ(config.time.window_s, row.window_s);
    }
}

TEST_F(Config, dense_variant_multiplies_traffic_and_widens_the_window) {
    Options options;
    options.set("variant", "dense");
    const ScenarioConfig config = load("intersection", options);
    EXPECT_EQ(config.demand.density, 7.0);
    EXPECT_EQ(config.demand.emergency, 6);
    EXPECT_EQ(config.time.window_s, 400.0);
    EXPECT_FALSE(config.dense);
}

TEST_F(Config, options_change_the_configuration) {
    Options options;
    options.set("density", "2");
    options.set("automated_share", "0.5");
    options.set("road_limit_kmh", "70");
    options.set("step_length_s", "0.1");
    options.set("idm", "treiber");
    const ScenarioConfig config = load("merge", options);
    EXPECT_EQ(config.demand.density, 2.0);
    EXPECT_EQ(config.demand.human + config.demand.automated, 37);
    EXPECT_EQ(config.demand.automated, 19);
    EXPECT_EQ(config.limits.road_kmh, 70.0);
    EXPECT_EQ(config.time.step_length_s, 0.1);
    EXPECT_EQ(config.drivers.idm, IdmPreset::treiber);
}

TEST_F(Config, unknown_key_is_reported_with_line_column_and_nearest_key) {
    const core::Problem problem = only_problem("[time]\nwarm_up = 10.0\n");
    EXPECT_THAT(problem.where, EndsWith("scenario.toml:7:1: time.warm_up"));
    EXPECT_THAT(problem.what, HasSubstr("unknown key"));
    EXPECT_THAT(problem.allowed, HasSubstr("window_s"));
    EXPECT_THAT(problem.cure, HasSubstr("warm_up_s"));
}

TEST_F(Config, a_misspelt_key_is_told_without_what_its_default_would_break) {
    EXPECT_THAT(only_problem("[time]\nwindw_s = 900.0\nwarm_up_s = 3000.0\n").where,
                EndsWith("time.windw_s"));
}

TEST_F(Config, negative_count_is_refused) {
    const core::Problem problem = only_problem("[demand]\nhuman = -3\n");
    EXPECT_THAT(problem.where, EndsWith("scenario.toml:7:1: demand.human"));
    EXPECT_THAT(problem.what, HasSubstr("-3 is negative"));
    EXPECT_EQ(problem.allowed, "0 to 100000");
}

TEST_F(Config, fractional_count_is_refused) {
    EXPECT_EQ(only_problem("[demand]\nhuman = 1.5\n").allowed, "a whole number from 0 to 100000");
}

TEST_F(Config, step_out_of_range_is_refused_in_file_and_option) {
    EXPECT_THAT(only_problem("[time]\nstep_length_s = 1.5\n"),
                AllOf(Field(&core::Problem::what, HasSubstr("1.5 is out of range")),
                      Field(&core::Problem::allowed, "0.1 to 1")));
    Options options;
    options.set("step_length_s", "0.05");
    EXPECT_EQ(only_problem("", options).where, "--step-length");
}

TEST_F(Config, not_a_number_is_refused) {
    EXPECT_THAT(only_problem("[time]\nstep_length_s = nan\n").what, HasSubstr("nan is out of range"));
}

TEST_F(Config, the_day_of_the_map_is_one_on_which_there_was_data) {
    const auto file_with = [&](const std::string& date) {
        std::string text = line_head;
        text.insert(text.find("[network]\n") + 10, "map_date = \"" + date + "\"\n");
        return write("scenario.toml", text).string();
    };
    for (const char* const date : {"2012-05-03 (newest object)", "2024-02-29"})
        EXPECT_EQ(load(file_with(date)).network.map_date, date);
    for (const char* const date : {"May 2012", "2012-5-3", "2023-02-29", "1970-01-01", "2012-05-0x"}) {
        const auto problems = problems_of([&] { load(file_with(date)); });
        ASSERT_EQ(problems.size(), 1U) << date;
        EXPECT_THAT(problems[0].where, EndsWith("network.map_date"));
        EXPECT_THAT(problems[0].what, HasSubstr("does not begin with a day of map data"));
    }
}

TEST_F(Config, emergency_departure_before_the_warm_up_is_refused) {
    const core::Problem problem = only_problem(
        "[time]\nwarm_up_s = 60.0\n[[emergency_trip]]\nfrom = \"first\"\nto = \"second\"\ndepart_s = 5.0\n");
    EXPECT_THAT(problem.where, EndsWith("scenario.toml:11:1: emergency_trip[0].depart_s"));
    EXPECT_THAT(problem.what, HasSubstr("5 is before the warm-up ends"));
}

TEST_F(Config, warm_up_after_the_window_names_the_option_that_set_it) {
    Options options;
    options.set("warm_up_s", "500");
    const core::Problem problem = only_problem("[demand]\nemergency = 1\n", options);
    EXPECT_EQ(problem.where, "--warm-up");
    EXPECT_THAT(problem.what, HasSubstr("500"));
}

TEST_F(Config, missing_network_file_is_named) {
    std::filesystem::remove(folder() / "line.edg.xml");
    const core::Problem problem = only_problem("");
    EXPECT_THAT(problem.where, EndsWith("scenario.toml:5:1: network.edges"));
    EXPECT_THAT(problem.what, HasSubstr("line.edg.xml"));
}

TEST_F(Config, path_out_of_the_folder_is_refused) {
    const auto problems = problems_of([&] {
        load(write("scenario.toml", "name = \"x\"\nversion = \"1\"\n[network]\nfile = \"../other.net.xml\"\n")
                 .string());
    });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].what, HasSubstr("leaves the scenario's folder"));
}

TEST_F(Config, name_out_of_the_folder_is_refused) {
    for (const char* const name : {"../../../OUTSIDE", "/tmp/OUTSIDE", "..", "a/b", "two words"}) {
        std::string text = line_head;
        text.replace(text.find("name = \"") + 8, text.find('"', text.find("name = \"") + 8) - 8, name);
        const auto problems = problems_of([&] { load(write("scenario.toml", text).string()); });
        ASSERT_EQ(problems.size(), 1U) << name;
        EXPECT_THAT(problems[0].where, EndsWith("scenario.toml:1:1: name"));
        EXPECT_THAT(problems[0].what, HasSubstr(std::string(name) + "\" cannot be the name of a folder"));
        EXPECT_THAT(problems[0].allowed, HasSubstr("letters, digits"));
    }
}

TEST_F(Config, shares_must_add_up) {
    const core::Problem problem = only_problem("[[flow]]\nfrom = \"first\"\nto = \"second\"\nshare = 0.9\n");
    EXPECT_THAT(problem.where, HasSubstr(":9:1: flow[0].share"));
    EXPECT_THAT(problem.what, HasSubstr("0.9"));
}

TEST_F(Config, every_problem_is_reported_at_once) {
    const auto problems = problems_of([&] {
        load_text("[demand]\nhuman = -1\nautomated = \"ten\"\n[drivers]\nidm = \"wiedemann\"\nspeed = 3\n");
    });
    ASSERT_EQ(problems.size(), 4U);
    EXPECT_THAT(problems[2].what, HasSubstr("\"wiedemann\""));
    EXPECT_EQ(problems[2].allowed, "sumo, treiber");
}

TEST_F(Config, broken_toml_is_reported_with_its_line) {
    const core::Problem problem = only_problem("[time\n");
    EXPECT_THAT(problem.where, HasSubstr("scenario.toml:6:"));
}

TEST_F(Config, unknown_scenario_suggests_the_nearest) {
    const auto problems = problems_of([] { load("intersecton"); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].cure, HasSubstr("intersection"));
}

TEST_F(Config, a_negative_zero_is_written_as_zero) {
    Options options;
    options.set("density", "-0.0");
    options.set("warm_up_s", "-0.0");
    const std::string text = to_toml(load("merge", options));
    EXPECT_THAT(text, AllOf(HasSubstr("density = 0\n"), Not(HasSubstr("= -0\n"))));
}

TEST_F(Config, says_what_a_density_multiplies) {
    const std::string text = "[demand]\ndensity = 0.8\n";
    EXPECT_EQ(density_words(load_text(text)), "");
    Options options;
    options.set("density", "0.5");
    EXPECT_EQ(density_words(load_text(text, options)), "density 0.8 x 0.5 = 0.4");
}

TEST_F(Config, density_above_one_is_refused_for_measured_demand) {
    Options options;
    options.set("density", "2");
    const auto problems = problems_of([&] { load("bologna", options); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].where, "--density");
}

TEST_F(Config, variant_without_a_table_is_refused) {
    Options options;
    options.set("variant", "dense");
    EXPECT_EQ(only_problem("", options).where, "--dense");
}

TEST_F(Config, kinds_from_the_command_line_replace_those_of_the_file) {
    Options options;
    options.set("traffic_kinds", "van=3,bus=1");
    options.set("emergency_kinds", "police_car=1");
    const ScenarioConfig config = load("merge", options);
    EXPECT_EQ(config.traffic_kinds.car, 0.0);
    EXPECT_EQ(config.traffic_kinds.van, 3.0);
    EXPECT_EQ(config.traffic_kinds.bus, 1.0);
    EXPECT_EQ(config.emergency_kinds.ambulance, 0.0);
    EXPECT_EQ(config.emergency_kinds.police_car, 1.0);
}

TEST_F(Config, bad_kinds_from_the_command_line_are_each_reported) {
    Options options;
    options.set("traffic_kinds", "car=1,trcuk=2,van=-1,bus");
    const auto problems = problems_of([&] { load("merge", options); });
    ASSERT_EQ(problems.size(), 3U);
    const std::vector<std::string> wheres = {problems[0].where, problems[1].where, problems[2].where};
    EXPECT_THAT(wheres, testing::UnorderedElementsAre("--kinds trcuk", "--kinds van", "--kinds bus"));
    const auto unknown = std::ranges::find(problems, "--kinds trcuk", &core::Problem::where);
    EXPECT_THAT(unknown->cure, HasSubstr("truck"));
}

TEST_F(Config, kinds_without_any_weight_are_refused) {
    Options options;
    options.set("emergency_kinds", "ambulance=0");
    const auto problems = problems_of([&] { load("merge", options); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].where, "--emergency-kinds");
}

TEST_F(Config, kinds_of_emergency_vehicles_are_refused_where_all_are_trips_of_their_own) {
    Options options;
    options.set("emergency_kinds", "fire_engine=1");
    const auto problems = problems_of([&] { load("motorway_jam", options); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].where, "--emergency-kinds");
    EXPECT_THAT(problems[0].cure, HasSubstr("[[emergency_trip]]"));
}

TEST_F(Config, dense_times_density_stays_readable) {
    Options options;
    options.set("variant", "dense");
    options.set("density", "20");
    const auto problems = problems_of([&] { load("merge", options); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].where, "--density");
    EXPECT_THAT(problems[0].what, HasSubstr("200"));
}

TEST_F(Config, privileges_and_slow_vehicles_enter_the_effective_configuration_where_there_are_any) {
    const std::string plain = to_toml(load("merge"));
    EXPECT_EQ(plain.find("[privilege]"), std::string::npos);
    EXPECT_EQ(plain.find("[slow]"), std::string::npos);
    const std::string rural = to_toml(load("rural"));
    EXPECT_NE(rural.find("[privilege]\noncoming_lane = 1\n"), std::string::npos);
    EXPECT_NE(rural.find("[slow]\nshare = 0.3\n"), std::string::npos);
    EXPECT_EQ(load("arterial").privilege.pass_red, 1);
}

TEST_F(Config, a_share_of_slow_vehicles_outside_zero_to_one_is_refused) {
    EXPECT_THAT(only_problem("[slow]\nshare = 1.5\n").what, HasSubstr("1.5 is out of range"));
}

TEST_F(Config, a_siren_enters_the_effective_configuration_where_somebody_heeds_it) {
    EXPECT_EQ(to_toml(load("merge")).find("[siren]"), std::string::npos);
    Options options;
    options.set("siren_compliance", "0.8");
    const ScenarioConfig heard = load("merge", options);
    EXPECT_EQ(heard.siren.compliance, 0.8);
    EXPECT_NE(to_toml(heard).find("[siren]\ncompliance = 0.8\n"), std::string::npos);
    options.set("siren_compliance", "1.5");
    EXPECT_THROW(load("merge", options), core::InputError);
}

TEST_F(Config, a_dry_road_leaves_the_effective_configuration_as_it_was) {
    const ScenarioConfig plain = load_text("");
    const ScenarioConfig dry =
        load_text("[road]\nfriction = 1.0\n[road.stretch.works]\nedges = [\"first\"]\n");
    EXPECT_EQ(to_toml(dry), to_toml(plain));
    EXPECT_EQ(to_toml(load("merge")).find("[road"), std::string::npos);
}

TEST_F(Config, road_conditions_come_from_table_options_and_factors_and_read_back) {
    Options options;
    options.set("road_speed_factor", "0.8");
    options.set("friction", "0.7");
    options.settings = {{"road.stretch.works.speed_factor", "0.3"}};
    const ScenarioConfig config = load_text(
        "[road]\nheadway_factor = 1.2\n[road.stretch.\"works\"]\nspeed_factor = 0.5\nedges = [\"first\"]\n",
        options);
    EXPECT_EQ(config.road.speed_factor, 0.8);
    EXPECT_EQ(config.road.friction, 0.7);
    EXPECT_EQ(config.road.headway_factor, 1.2);
    ASSERT_EQ(config.road.stretches.size(), 1U);
    EXPECT_EQ(config.road.stretches[0].speed_factor, 0.3);
    EXPECT_THAT(config.road.stretches[0].edges, ElementsAre("first"));
    store(config, folder() / "stored");
    EXPECT_EQ(to_toml(load((folder() / "stored").string())), to_toml(config));
}

TEST_F(Config, bad_road_conditions_say_where_and_what) {
    EXPECT_THAT(only_problem("[road]\nspeed_factor = 1.5\n"),
                AllOf(Field(&core::Problem::where, HasSubstr("scenario.toml:7:1: road.speed_factor")),
                      Field(&core::Problem::allowed, "0.05 to 1")));
    EXPECT_THAT(only_problem("[road]\nfrcition = 0.5\n").cure, HasSubstr("friction"));
    EXPECT_THAT(only_problem("[road.stretch.ice]\nspeed_factor = 0.5\n").what, HasSubstr("has no edges"));
    EXPECT_THAT(only_problem("[road.stretch]\nice = 0.5\n").allowed, "a table");
    EXPECT_THAT(only_problem("[road.stretch.ice]\nedges = [\"first\"]\n"
                             "[road.stretch.works]\nedges = [\"second\", \"first\"]\n"),
                AllOf(Field(&core::Problem::where, HasSubstr("road.stretch.works.edges")),
                      Field(&core::Problem::what, HasSubstr("is already in 'ice'"))));
    Options options;
    options.set("friction", "0");
    EXPECT_EQ(only_problem("", options).where, "--friction");
}

TEST_F(Config, crossings_that_nobody_uses_leave_the_effective_configuration_as_it_was) {
    EXPECT_EQ(to_toml(load_text("[pedestrians]\nper_hour = 0\ncrossings = \"all\"\n")),
              to_toml(load_text("")));
    EXPECT_EQ(to_toml(load("city")).find("[pedestrians"), std::string::npos);
}

TEST_F(Config, pedestrians_come_from_table_option_and_factor_and_read_back) {
    Options options;
    options.set("pedestrians_per_hour", "120");
    options.settings = {{"pedestrians.speed_mean_mps", "1.2"}};
    const ScenarioConfig config =
        load_text("[pedestrians]\nper_hour = 5\ncrossings = \"all\"\nspeed_deviation_mps = 0\n", options);
    EXPECT_EQ(config.pedestrians.per_hour, 120.0);
    EXPECT_EQ(config.pedestrians.crossings, Crossings::all);
    EXPECT_EQ(config.pedestrians.speed_mean_mps, 1.2);
    EXPECT_EQ(config.pedestrians.speed_deviation_mps, 0.0);
    store(config, folder() / "stored");
    EXPECT_EQ(to_toml(load((folder() / "stored").string())), to_toml(config));
}

TEST_F(Config, bad_pedestrians_say_where_and_what) {
    EXPECT_THAT(only_problem("[pedestrians]\nper_hour = -1\n"),
                AllOf(Field(&core::Problem::where, HasSubstr("scenario.toml:7:1: pedestrians.per_hour")),
                      Field(&core::Problem::allowed, "0 to 2000")));
    EXPECT_THAT(only_problem("[pedestrians]\nper_hour = nan\n").allowed, "0 to 2000");
    EXPECT_THAT(only_problem("[pedestrians]\nper_huor = 5\n").cure, HasSubstr("per_hour"));
    EXPECT_THAT(only_problem("[pedestrians]\ncrossings = \"some\"\n").allowed, HasSubstr("signals"));
    EXPECT_THAT(only_problem("[pedestrians]\nspeed_mean_mps = 0\n").allowed, "0.5 to 3");
    Options options;
    options.set("pedestrians_per_hour", "1000000");
    EXPECT_EQ(only_problem("", options).where, "--pedestrians");
}

constexpr const char* measured_line =
    "[measured]\nroutes = [\"line.nod.xml\"]\npersons = [\"walkers.rou.xml\"]\n";

TEST_F(Config, measured_persons_are_pedestrians_and_part_of_the_scenario) {
    write("walkers.rou.xml", "<routes/>");
    const ScenarioConfig config = load_text(measured_line);
    EXPECT_TRUE(config.has_pedestrians());
    EXPECT_FALSE(config.pedestrians.walk()) << "no crossings are built for them";
    const std::string before = scenario_hash(config);
    write("walkers.rou.xml", "<routes></routes>");
    EXPECT_NE(scenario_hash(config), before);
    store(config, folder() / "stored");
    EXPECT_EQ(to_toml(load((folder() / "stored").string())), to_toml(config));
}

TEST_F(Config, without_measured_persons_the_effective_configuration_is_as_it_was) {
    const ScenarioConfig config = load_text("[measured]\nroutes = [\"line.nod.xml\"]\npersons = []\n");
    EXPECT_FALSE(config.has_pedestrians());
    EXPECT_EQ(to_toml(config).find("persons"), std::string::npos);
    EXPECT_FALSE(load("bologna").has_pedestrians());
}

TEST_F(Config, a_missing_file_of_persons_is_named_with_its_key_and_cure) {
    const core::Problem problem = only_problem(measured_line);
    EXPECT_THAT(problem.where, EndsWith("scenario.toml:8:1: measured.persons"));
    EXPECT_THAT(problem.what, AllOf(HasSubstr("no file"), EndsWith("walkers.rou.xml")));
    EXPECT_EQ(problem.allowed, "an existing file");
    EXPECT_THAT(problem.cure, HasSubstr("relative to this scenario's folder"));
    EXPECT_THAT(only_problem("[measured]\nperson = []\nroutes = [\"line.nod.xml\"]\n").cure,
                HasSubstr("persons"));
}

TEST_F(Config, usual_drivers_leave_the_effective_configuration_as_it_was) {
    Options usual;
    usual.set("car_following", "idm");
    usual.set("driver_spread", "0");
    for (const char* const name : {"merge", "bologna"}) {
        EXPECT_EQ(configuration_hash(load(name, usual)), configuration_hash(load(name)));
        EXPECT_EQ(to_toml(load(name)).find("car_following]"), std::string::npos);
    }
}

TEST_F(Config, other_drivers_come_from_table_options_and_factors_and_read_back) {
    Options options;
    options.set("car_following", "krauss");
    options.set("driver_spread", "0.2");
    const ScenarioConfig config = load("merge", options);
    EXPECT_EQ(config.following, (Following{FollowingModel::krauss, 0.2}));
    EXPECT_NE(configuration_hash(config), configuration_hash(load("merge")));
    store(config, folder() / "stored");
    const ScenarioConfig stored = load((folder() / "stored").string());
    EXPECT_EQ(stored.following, config.following);
    EXPECT_EQ(configuration_hash(stored), configuration_hash(config));
    Options factor;
    factor.settings = {{"car_following.driver_spread", "0.3"}};
    EXPECT_EQ(load("merge", factor).following.driver_spread, 0.3);
}

TEST_F(Config, bad_drivers_say_where_and_what) {
    Options options;
    options.set("driver_spread", "1.5");
    const auto wide = problems_of([&] { load("merge", options); });
    ASSERT_EQ(wide.size(), 1U);
    EXPECT_EQ(wide[0].where, "--driver-spread");
    EXPECT_THAT(wide[0].allowed, HasSubstr("0 to 1"));
    Options both;
    both.set("car_following", "krauss");
    both.set("idm", "treiber");
    const auto mixed = problems_of([&] { load("merge", both); });
    ASSERT_EQ(mixed.size(), 1U);
    EXPECT_EQ(mixed[0].where, "--idm");
    EXPECT_THAT(mixed[0].what, HasSubstr("the model is krauss"));
    EXPECT_THAT(only_problem("[car_following]\nmodel = \"gipps\"\n").allowed, HasSubstr("idm, krauss"));
}

TEST_F(Config, effective_configuration_reads_back_as_itself) {
    for (const std::string& name : list()) {
        Options options;
        options.set("horizon_s", "4321.5");
        const ScenarioConfig config = load(name, options);
        store(config, folder() / name);
        const ScenarioConfig again = load((folder() / name).string());
        EXPECT_EQ(to_toml(again), to_toml(config));
        EXPECT_EQ(configuration_hash(again), configuration_hash(config));
        EXPECT_EQ(again.time.horizon_s, 4321.5);
    }
    EXPECT_NE(configuration_hash(load("merge")), configuration_hash(load("city")));
}

TEST_F(Config, text_of_the_file_survives_quoting) {
    ScenarioConfig config = load_text("");
    config.title = "a \"b\" \\ \n\x01 ü";
    write("again.toml", to_toml(config));
    EXPECT_EQ(load((folder() / "again.toml").string()).title, config.title);
}

TEST_F(Config, init_makes_a_scenario_to_edit) {
    init(folder() / "mine", "intersection");
    const ScenarioConfig config = load((folder() / "mine").string());
    EXPECT_EQ(config.name, "mine");
    EXPECT_EQ(config.demand.human, 26);
    EXPECT_THAT(core::read_file(folder() / "mine" / "scenario.toml"), HasSubstr("# Arms alike"));
    EXPECT_THROW(init(folder() / "mine", "merge"), core::InputError);
}

TEST_F(Config, sumo_home_is_needed_only_by_scenarios_that_refer_to_it) {
    unsetenv("SUMO_HOME");
    EXPECT_NO_THROW(load("merge"));
    EXPECT_THROW(load("city"), core::EnvironmentError);
}

TEST_F(Config, keys_that_may_be_absent_are_written_when_they_are_there) {
    write("line.nod.xml", line_nodes);
    write("line.edg.xml", line_edges);
    const std::string demand = "[demand]\nhuman = 1\n";
    const ScenarioConfig plain = load(write("plain.toml", line_head + demand).string());
    for (const char* const key : {"time_to_teleport_s", "maximum_distance_m", "emergency_site", "own_types"})
        EXPECT_THAT(to_toml(plain), Not(HasSubstr(key)));
    const ScenarioConfig config =
        load(write("full.toml", line_head + demand +
                                    "[time]\ntime_to_teleport_s = -1\n[trips]\nmaximum_distance_m = 900.0\n"
                                    "[[emergency_site]]\nkind = \"fire_station\"\nedge = \"first\"\n")
                 .string());
    EXPECT_EQ(config.time.time_to_teleport_s, -1.0);
    EXPECT_EQ(config.trips.maximum_distance_m, 900.0);
    EXPECT_EQ(config.emergency_sites.at(0).kind, SiteKind::fire_station);
    const ScenarioConfig again = load(write("again.toml", to_toml(config)).string());
    EXPECT_EQ(to_toml(again), to_toml(config));
}

}  // namespace
}  // namespace clearway::scenario
