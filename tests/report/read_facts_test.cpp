#include "report/read_facts.hpp"

#include <sstream>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "experiment/conditions.hpp"
#include "report/console.hpp"
#include "report/detail/aspects.hpp"
#include "report/figure_files.hpp"
#include "report/page.hpp"
#include "results/synthetic.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

metrics::VehicleRow vehicle(const std::string& id, traffic::VehicleClass vehicle_class,
                            double travel_time_s) {
    metrics::VehicleRow row;
    row.id = id;
    row.key = core::vehicle_key(id);
    row.vehicle_class = vehicle_class;
    row.travel_time_s = travel_time_s;
    row.time_loss_s = travel_time_s / 4.0;
    row.waiting_time_s = travel_time_s / 8.0;
    row.depart_delay_s = 0.0;
    row.depart_s = 60.0;
    row.arrival_s = 60.0 + travel_time_s;
    return row;
}

/// The baseline takes 100, 102, 104 s; a helpful condition 20 s less, one second apart.
results::RunRecord run(const experiment::ConditionSpec& condition, std::uint32_t replication,
                       double travel_time_s) {
    results::RunRecord record;
    record.key = {"merge", condition.name, replication};
    record.condition = condition;
    record.vehicles = {vehicle("ev<script>", traffic::VehicleClass::emergency, travel_time_s),
                       vehicle("ev1", traffic::VehicleClass::emergency, travel_time_s),
                       vehicle("hv0", traffic::VehicleClass::human, 120.0)};
    metrics::RunMetrics& numbers = record.metrics;
    numbers.emergency_travel_time_s = numbers.emergency_restricted_travel_time_s = travel_time_s;
    numbers.emergency_time_loss_s = travel_time_s / 4.0;
    numbers.emergency_waiting_time_s = travel_time_s / 8.0;
    numbers.emergency_depart_delay_s = numbers.depart_delay_s = 0.0;
    numbers.waiting_time_s = 12.0;
    numbers.others_time_loss_s = 30.0;
    numbers.emergency_count = numbers.emergency_arrived = 2;
    numbers.vehicle_count = numbers.arrived = 3;
    numbers.unfinished = replication;
    numbers.not_inserted = 1;
    return record;
}

/// A small study: three replications; condition `broken` failed once and is missing twice.
class RunFolder : public ::testing::Test {
  protected:
    void SetUp() override {
        results::Manifest manifest;
        manifest.study = "frozen";
        manifest.clearway_version = "0.1.0";
        manifest.sumo_version = "1.15.0";
        manifest.replications = 3;
        manifest.scenarios = {{"merge", "v1", "Merge", "name = \"merge\"\n", "abc", "Map data: somebody"}};
        experiment::ConditionSpec baseline{.name = "baseline", .policies = {}};
        experiment::ConditionSpec helpful{.name = "graph_simulation", .policies = {"dissertation"}};
        helpful.safety_checks = traffic::SafetyChecks::off;
        experiment::ConditionSpec broken{.name = "broken", .policies = {"dissertation"}};
        experiment::ConditionSpec solo{
            .name = "solo", .policies = {}, .traffic_model = experiment::TrafficModel::free_flow};
        manifest.conditions = {baseline, helpful, broken, solo};
        const results::Store store = results::Store::create(folder.path() / "study", manifest);
        for (std::uint32_t replication = 0; replication < 3; ++replication) {
            results::synthetic::write(store, run(baseline, replication, 100.0 + 2.0 * replication));
            results::synthetic::write(store, run(helpful, replication, 80.0 + 1.0 * replication));
            results::synthetic::write(store, run(solo, replication, 60.0));
        }
        results::RunError failure;
        failure.key = {"merge", "broken", 1};
        failure.cause = results::ErrorCause::signal;
        failure.message = "SUMO aborted <b>";
        failure.signal = 6;
        failure.attempts = 3;
        store.write(failure);
    }

    std::filesystem::path study() const { return folder.path() / "study"; }
    void write(const std::string& name, const std::string& content) const {
        const std::filesystem::path file = study() / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << content;
    }

    support::TemporaryFolder folder;
};

TEST_F(RunFolder, gives_means_paired_differences_and_outcomes) {
    const StudyFacts facts = read_facts(study());
    ASSERT_EQ(facts.scenarios.size(), 1u);
    const ScenarioFacts& merge = facts.scenarios[0];
    ASSERT_EQ(merge.conditions.size(), 4u);
    const ConditionFacts& helpful = merge.conditions[1];
    EXPECT_EQ(helpful.title, "Graph made by simulation attributes");
    EXPECT_EQ(helpful.baseline, "baseline");
    EXPECT_TRUE(helpful.is_unchecked());
    // Differences -20, -21, -22: mean -21, standard deviation 1, t(2) = 4.3027, half width 4.3027 / sqrt(3).
    const analysis::Estimate difference = helpful.difference(Measure::emergency_travel_time).value();
    EXPECT_DOUBLE_EQ(difference.mean, -21.0);
    EXPECT_NEAR(difference.interval->low, -21.0 - 2.4842, 1e-3);
    EXPECT_NEAR(difference.interval->high, -21.0 + 2.4842, 1e-3);
    EXPECT_DOUBLE_EQ(helpful.value(Measure::gap_closed)->mean, 63.0 / 126.0);
    EXPECT_DOUBLE_EQ(helpful.value(Measure::unfinished)->mean, 2.0);
    EXPECT_EQ(helpful.emergency.arrived, 6u);
    EXPECT_FALSE(merge.conditions[0].is_compared());
    EXPECT_FALSE(merge.conditions[3].is_compared());
}

TEST(Titles, of_conditions_made_by_factors_are_words_or_those_of_the_study_file) {
    const auto made = [](const std::string& name, std::vector<std::string> policies, core::Settings factors) {
        ConditionFacts facts;
        facts.condition = {.name = name, .policies = std::move(policies), .factors = std::move(factors)};
        return facts;
    };
    const auto titles_with = [&](const core::Settings& given) {
        std::vector<ConditionFacts> conditions = {
            made("baseline", {}, {}),
            made("own+failure=perfect+policy=soft.py_Green",
                 {"/home/soft.py:Green@0123456789abcdef0123456789abcdef"},
                 {{"condition.failure", "perfect"}, {"condition.policy", "soft.py:Green"}}),
            made("own+failure=B10+policy=corridor.clear_lane", {"corridor", "clear_lane"},
                 {{"condition.failure", "B10"}, {"condition.policy", "corridor.clear_lane"}}),
            made("corridor+lead_s=4", {"corridor"}, {{"preempt_signals.lead_s", "4"}}),
            made("graph_graphsage+dark_share=0.1", {"corridor"}, {{"failure.dark_share", "0.1"}}),
            made("one+policy=corridor", {"corridor"}, {{"condition.policy", "corridor"}}),
            made("two+policy=corridor", {"corridor"}, {{"condition.policy", "corridor"}})};
        detail::give_titles(experiment::ConditionTitles(given), conditions);
        const std::string of_part = given.empty() ? "Green" : "Ours";
        EXPECT_EQ(conditions[1].factor_titles,
                  (core::Settings{{"condition.failure", "perfect sensors"}, {"condition.policy", of_part}}));
        EXPECT_EQ(conditions[1].aspects.at("policy"), of_part);
        EXPECT_EQ(conditions[2].aspects.at("failure"), given.empty() ? "B10" : "outages");
        EXPECT_EQ(conditions[3].aspects.at("policy"), given.empty() ? "corridor" : "Corridor");
        EXPECT_EQ(conditions[4].aspects.at("failure.dark_share"), "dark share 0.1");
        EXPECT_EQ(conditions[4].aspects.at("failure"), "") << "the factor says it";
        return core::texts_of(conditions, &ConditionFacts::title);
    };
    const std::string net = "no repair";
    EXPECT_THAT(titles_with({}),
                ::testing::ElementsAre("Baseline", "Green, own, perfect sensors",
                                       "corridor + clear_lane, own, B10", "corridor, lead 4 s",
                                       net + ", dark share 0.1", "corridor, one", "corridor, two"))
        << "the policies of several conditions are varied";
    EXPECT_THAT(
        titles_with({{"baseline", "Today"},
                     {"B10", "outages"},
                     {"soft.py:Green", "Ours"},
                     {"corridor", "Corridor"},
                     {"two+policy=corridor", "Second"}}),
        ::testing::ElementsAre("Today", "Ours, own, perfect sensors", "corridor + clear_lane, own, outages",
                               "Corridor, lead 4 s", net + ", dark share 0.1", "Corridor, one", "Second"));
    std::vector<ConditionFacts> alike = {
        made("one+policy=corridor", {"corridor"}, {{"condition.policy", "corridor"}}),
        made("two+policy=corridor", {"corridor"}, {{"condition.policy", "corridor"}})};
    detail::give_titles(experiment::ConditionTitles({{"one", "Both"}, {"two", "Both"}}), alike);
    EXPECT_THAT(core::texts_of(alike, &ConditionFacts::title),
                ::testing::ElementsAre("one+policy=corridor", "two+policy=corridor"));
    EXPECT_EQ(alike[0].base_title, "Both");
    alike = {alike[0]};
    detail::give_titles(experiment::ConditionTitles({}), alike);
    EXPECT_EQ(alike[0].title, "corridor") << "alone, the policy says enough";
}

TEST_F(RunFolder, takes_titles_from_the_study) {
    write("titles.json", R"({"graph_simulation": "Helpful"})");
    EXPECT_EQ(read_facts(study()).scenarios[0].conditions[1].title, "Helpful");
    write("titles.json", "[1]");
    EXPECT_THROW(static_cast<void>(read_facts(study())), core::InputError);
}

TEST_F(RunFolder, takes_controls_from_the_study) {
    write("controls.json", R"({"graph_simulation": "baseline", "gone": "baseline"})");
    EXPECT_EQ(read_facts(study()).scenarios[0].conditions[1].control_of, "baseline");
    write("controls.json", "{\"graph_simulation\": 1}");
    EXPECT_THROW(static_cast<void>(read_facts(study())), core::InputError);
}

TEST(GapClosed, is_a_dash_for_a_condition_that_lost_emergency_vehicles) {
    const support::TemporaryFolder folder;
    results::Manifest manifest;
    manifest.study = "lossy";
    manifest.clearway_version = "0.1.0";
    manifest.sumo_version = "1.15.0";
    manifest.replications = 3;
    manifest.scenarios = {{"merge", "v1", "Merge", "name = \"merge\"\n", "abc", ""}};
    const experiment::ConditionSpec baseline{.name = "baseline", .policies = {}};
    const experiment::ConditionSpec lossy{.name = "lossy", .policies = {"dissertation"}};
    const experiment::ConditionSpec solo{
        .name = "solo", .policies = {}, .traffic_model = experiment::TrafficModel::free_flow};
    manifest.conditions = {baseline, lossy, solo};
    {
        const results::Store store = results::Store::create(folder.path() / "study", manifest);
        for (std::uint32_t replication = 0; replication < 3; ++replication) {
            results::synthetic::write(store, run(baseline, replication, 100.0 + replication));
            results::RunRecord record = run(lossy, replication, 1900.0);
            record.vehicles[0].outcome = metrics::VehicleOutcome::running_at_end;
            results::synthetic::write(store, record);
            results::synthetic::write(store, run(solo, replication, 60.0));
        }
    }
    const StudyFacts facts = read_facts(folder.path() / "study");
    const ConditionFacts& lost = facts.scenarios.at(0).conditions.at(1);
    ASSERT_TRUE(lost.objections.loses_emergency());
    EXPECT_FALSE(lost.value(Measure::gap_closed));
    EXPECT_THAT(json_tables(facts), testing::ContainsRegex("\"gap_closed\": .\n *\"mean\": null"));
    EXPECT_THAT(console_tables(facts, Tables::all),
                testing::ContainsRegex("Gap closed, %\n.*\n  lossy +- +lost EVs\n"));
    std::ostringstream page;
    write_html(facts, page);
    EXPECT_THAT(page.str(), HasSubstr("<span class=\"delta worse\">lost EVs</span>"));
}

TEST(Titles, of_the_dissertations_conditions_name_the_predictor_and_its_weights) {
    using Conditions = std::vector<experiment::ConditionSpec>;
    experiment::ConditionSpec own;
    own.name = "mine";
    own.predictor = "graphsage";
    experiment::ConditionSpec trained;
    trained.name = "graph_graphsage";
    trained.predictor = "graphsage_as_published";
    trained.model_file = "/somewhere/mine.weights";
    const auto titles = [](const Conditions& conditions) {
        const support::TemporaryFolder folder;
        results::Manifest manifest;
        manifest.study = "dissertation";
        manifest.replications = 1;
        manifest.scenarios = {{"merge_dense", "v1", "Merge", "name = \"merge\"\n", "abc", ""}};
        manifest.conditions = conditions;
        const results::Store store = results::Store::create(folder.path() / "study", manifest);
        const ScenarioFacts facts = read_facts(folder.path() / "study").scenarios.at(0);
        EXPECT_EQ(facts.published_as, "merge");
        std::vector<std::string> all;
        for (const ConditionFacts& condition : facts.conditions)
            all.push_back(condition.title);
        return all;
    };
    Conditions shipped;
    for (const experiment::BuiltInCondition& known : experiment::built_in_conditions())
        shipped.push_back(known.condition);
    EXPECT_THAT(titles(shipped), testing::UnorderedElementsAre(
                                     "Baseline", "corridor", "Graph made by simulation attributes",
                                     "GraphSAGE, corrected inputs", "GraphSAGE, improved",
                                     "GraphSAGE, as published", "Same failures, no repair",
                                     "Same failures, dead reckoning", "Alone on the road, signals open"));
    EXPECT_THAT(titles({shipped.front(), own, trained}),
                testing::ElementsAre("Baseline", "mine", "GraphSAGE, as published, other weights"));
}

TEST_F(RunFolder, gives_the_distribution_over_all_emergency_vehicles) {
    const StudyFacts facts = read_facts(study());
    const Distribution& distribution = facts.scenarios[0].conditions[0].distribution;
    EXPECT_EQ(distribution.all, 6u);
    ASSERT_EQ(distribution.points.size(), 6u);
    EXPECT_DOUBLE_EQ(distribution.points.front().seconds, 100.0);
    EXPECT_DOUBLE_EQ(distribution.points.back().seconds, 104.0);
    EXPECT_DOUBLE_EQ(distribution.points.back().share, 1.0);
}

TEST_F(RunFolder, gives_failed_and_missing_runs_with_their_cause) {
    const ConditionFacts broken = read_facts(study()).scenarios[0].conditions[2];
    EXPECT_EQ(broken.complete_runs, 0u);
    ASSERT_EQ(broken.failed.size(), 1u);
    EXPECT_EQ(broken.failed[0].replication, 1u);
    EXPECT_EQ(broken.failed[0].cause, "signal: SUMO aborted <b> (signal 6), 3 attempts");
    EXPECT_EQ(broken.missing_runs, 2u);
    EXPECT_FALSE(broken.value(Measure::emergency_travel_time));
}

TEST_F(RunFolder, becomes_tables_and_a_page) {
    write("scenarios/merge/network.svg",
          "<?xml version=\"1.0\"?>\n<svg class=\"network\" viewBox=\"0 0 9 9\"></svg>\n");
    write("training/true_links/losses.csv", "epoch,train_loss_nat,test_loss_nat\n0,0.7,0.6\n1,0.1,0.2\n");
    write("command.txt", "./clearway study studies/dissertation.toml\n");
    const StudyFacts facts = read_facts(study());
    const std::string page = tests::without_script(tests::page_of(facts));
    EXPECT_THAT(page, HasSubstr("Clearway: frozen"));
    EXPECT_THAT(page, HasSubstr("<svg class=\"network\" viewBox=\"0 0 9 9\"></svg>"));
    EXPECT_THAT(page, HasSubstr("Map data: somebody"));
    EXPECT_THAT(page, HasSubstr("./clearway study studies/dissertation.toml"));
    EXPECT_THAT(page, HasSubstr("id=\"training\""));
    EXPECT_THAT(page, HasSubstr("SUMO aborted &lt;b&gt;"));
    EXPECT_THAT(page, Not(HasSubstr("<script")));
    EXPECT_THAT(page, Not(HasSubstr("nan")));
    const std::string tables = console_tables(facts);
    EXPECT_THAT(tables, HasSubstr("ran without safety checks: EV travel\n    time -21.0 s"));
    EXPECT_THAT(tables, HasSubstr("too few seeds: fewer than 5"));
    EXPECT_THAT(tables, Not(HasSubstr("[-23.5, -18.5]")));
}

TEST_F(RunFolder, does_not_take_in_a_picture_that_acts) {
    write("scenarios/merge/network.svg", "<svg onload=\"alert(1)\"></svg>");
    EXPECT_EQ(read_facts(study()).scenarios[0].network_svg, "");
}

TEST_F(RunFolder, tells_which_edges_have_three_or_more_lanes) {
    EXPECT_FALSE(read_facts(study()).scenarios[0].wide_edges.has_value());
    EXPECT_THAT(console_tables(read_facts(study())), Not(HasSubstr("lanes for cars")));
    write("scenarios/merge/wide_edges.json", R"([{"edge":"a1","street":"<b>","car_lanes":3},
                                                 {"edge":"a2","street":"","car_lanes":4}])");
    const StudyFacts facts = read_facts(study());
    EXPECT_THAT(console_tables(facts), HasSubstr("2 edges with three or more lanes for cars, 4 at most"));
    EXPECT_THAT(json_tables(facts), HasSubstr("\"car_lanes\": 4"));
    write("scenarios/merge/wide_edges.json", "[]");
    EXPECT_THAT(console_tables(read_facts(study())), HasSubstr("No edge has three or more lanes for cars."));
    write("scenarios/merge/wide_edges.json", "[{}]");
    EXPECT_THROW(static_cast<void>(read_facts(study())), core::InputError);
}

TEST_F(RunFolder, says_what_to_expect_of_preemption) {
    write("scenarios/merge/outlook.json", R"({"signals": 4, "sentence": "Preemption may help <b>."})");
    const StudyFacts facts = read_facts(study());
    EXPECT_THAT(console_tables(facts), HasSubstr("\nPreemption may help <b>.\n"));
    std::ostringstream page;
    write_html(facts, page);
    EXPECT_THAT(page.str(), HasSubstr("<p class=\"note\">Preemption may help &lt;b&gt;.</p>"));
    write("scenarios/merge/outlook.json", R"({"signals": 0, "sentence": "No signal."})");
    EXPECT_THAT(console_tables(read_facts(study())), Not(HasSubstr("No signal.")));
    write("scenarios/merge/outlook.json", "{}");
    EXPECT_THROW(static_cast<void>(read_facts(study())), core::InputError);
}

TEST_F(RunFolder, tells_how_many_signals_the_network_has) {
    EXPECT_FALSE(read_facts(study()).scenarios[0].roads);
    write("scenarios/merge/roads.json", R"({"edges": [], "signals": [], "stations": []})");
    EXPECT_TRUE(read_facts(study()).scenarios[0].roads->signals.empty());
    write("scenarios/merge/roads.json", "{}");
    EXPECT_THROW(static_cast<void>(read_facts(study())), core::InputError);
}

TEST_F(RunFolder, lists_the_edges_of_the_network_for_its_figure) {
    EXPECT_FALSE(read_facts(study()).scenarios[0].roads);
    write("scenarios/merge/network.svg", "<svg class=\"network\" viewBox=\"0 0 1 1\"></svg>");
    write("scenarios/merge/streets.json", R"({"a1": "Long Street"})");
    write("scenarios/merge/wide_edges.json", R"([{"edge":"a2","street":"","car_lanes":4}])");
    write("scenarios/merge/roads.json", R"({"edges": [
        {"id": "a1", "to": [1], "signal": true, "length_m": 120.25, "limit_mps": 13.89, "shape_m": []},
        {"id": "a2", "to": [], "signal": false, "length_m": 80.0, "limit_mps": 8.3333, "shape_m": []}],
        "signals": [], "stations": []})");
    write_figures(read_facts(study()), folder.path() / "figures");
    EXPECT_EQ(core::read_file(folder.path() / "figures" / "network-merge.csv"),
              "edge,street,\"length, m\",\"limit, km/h\",ends at a signal,lanes for cars\n"
              "a1,Long Street,120.2,50,yes,1 or 2\n"
              "a2,,80.0,30,no,4\n");
}

TEST(ReadFacts, refuses_what_is_no_run_folder) {
    const support::TemporaryFolder folder;
    EXPECT_THROW(static_cast<void>(read_facts(folder.path())), core::InputError);
}

}  // namespace
}  // namespace clearway::report
