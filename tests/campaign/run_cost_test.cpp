#include "campaign/detail/run_cost.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "results/synthetic.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::campaign {
namespace {

TEST(RunCost, counts_the_departures_of_measured_demand_within_the_window) {
    const support::TemporaryFolder folder;
    const auto routes = folder.write("a.rou.xml",
                                     "<routes>\n<vType id=\"car\" depart=\"1\"/>\n"
                                     "<vehicle id=\"a\" depart=\"0.00\"><route edges=\"e\"/></vehicle>\n"
                                     "<trip type=\"car\" depart=\"600\" from=\"e\" to=\"f\" id=\"b\"/>\n"
                                     "<vehicle depart=\"600.5\" id=\"late\"/>\n</routes>\n");
    scenario::ScenarioConfig config;
    config.time.window_s = 600.0;
    config.time.step_length_s = 0.5;
    config.demand.density = 0.5;
    config.demand.emergency = 3;
    config.measured.emplace().routes = {routes.string()};
    // 0.2 s, and four vehicles for 240 steps of 10 us.
    EXPECT_NEAR(rough_cost(config, experiment::TrafficModel::standard).wall_s.value(), 0.2 + 4 * 240 * 10e-6,
                1e-9);
    EXPECT_NEAR(rough_cost(config, experiment::TrafficModel::free_flow).wall_s.value(), 0.2 + 3 * 240 * 10e-6,
                1e-9);
    config.measured->routes.push_back((folder.path() / "missing.rou.xml").string());
    EXPECT_FALSE(rough_cost(config, experiment::TrafficModel::standard).wall_s);
}

TEST(RunCost, that_was_noted_is_used_beside_it_for_runs_in_traffic) {
    const support::TemporaryFolder folder;
    const scenario::ScenarioConfig config;
    using experiment::TrafficModel;
    const auto cost = [&](const std::string& hash, TrafficModel model) {
        return CostBook(folder.path() / "mine").of(config, hash, model);
    };
    note_cost(folder.path(), config, "a", {.wall_s = 4.5, .disk_bytes = 7.0});
    note_cost(folder.path(), config, "b", {.wall_s = 90.0, .disk_bytes = 8.0});
    note_cost(folder.path(), config, "b", {.wall_s = 9.0, .disk_bytes = 8.0});
    EXPECT_EQ(cost("a", TrafficModel::standard).wall_s, 4.5);
    EXPECT_EQ(cost("b", TrafficModel::sublane).wall_s, 9.0);
    EXPECT_EQ(cost("b", TrafficModel::standard).basis, CostBasis::measured);
    EXPECT_EQ(cost("b", TrafficModel::free_flow).basis, CostBasis::rough);
    EXPECT_EQ(cost("c", TrafficModel::standard).basis, CostBasis::rough);
    for (const char* const damaged : {"[", "[]", R"({"a": 3})", R"({"a": ["x", 1]})"}) {
        folder.write("run-costs.json", damaged);
        EXPECT_EQ(cost("a", TrafficModel::standard).basis, CostBasis::rough) << damaged;
    }
    note_cost(folder.path(), config, "a", {.wall_s = 1.5, .disk_bytes = 7.0});
    EXPECT_EQ(cost("a", TrafficModel::standard).wall_s, 1.5);
}

TEST(RunCost, of_a_copy_with_other_traffic_follows_from_a_run_on_the_same_roads) {
    const support::TemporaryFolder folder;
    scenario::ScenarioConfig checked;
    checked.network.file = folder.write("town.net.xml", "<net/>").string();
    note_cost(folder.path(), checked, "checked", {.wall_s = 12.0, .disk_bytes = 7.0});
    const double rough_s = rough_cost(checked, experiment::TrafficModel::standard).wall_s.value();

    scenario::ScenarioConfig copy = checked;
    copy.network.file = folder.write("copy.net.xml", "<net/>").string();
    copy.demand.density *= 0.5;
    const auto cost = [&](const scenario::ScenarioConfig& config, experiment::TrafficModel model) {
        return CostBook(folder.path() / "mine").of(config, "other", model);
    };
    const RunCost found = cost(copy, experiment::TrafficModel::standard);
    EXPECT_EQ(found.basis, CostBasis::same_roads);
    EXPECT_NEAR(found.wall_s.value(),
                12.0 / rough_s * rough_cost(copy, experiment::TrafficModel::standard).wall_s.value(), 1e-9);
    EXPECT_EQ(cost(copy, experiment::TrafficModel::free_flow).basis, CostBasis::rough);

    copy.network.file = folder.write("other.net.xml", "<net></net>").string();
    EXPECT_EQ(cost(copy, experiment::TrafficModel::standard).basis, CostBasis::rough);
    copy.network.file = (folder.path() / "missing.net.xml").string();
    EXPECT_EQ(cost(copy, experiment::TrafficModel::standard).basis, CostBasis::rough);
}

TEST(RunCost, of_a_run_is_what_it_took_at_the_pace_of_its_folder) {
    const support::TemporaryFolder folder;
    const auto store = results::Store::create(folder.path() / "study", results::synthetic::manifest());
    const experiment::RunKey key{"alpha", "baseline", 0};
    results::RunTiming timing;
    timing.wall_s = 4.0;
    const auto wall_s = [&] {
        return CostBook(store.folder())
            .of({}, std::string(32, 'a'), experiment::TrafficModel::standard)
            .wall_s.value();
    };
    note_pace(store, 7.0);
    EXPECT_FALSE(std::filesystem::exists(store.folder() / "run-costs.json")) << "it has no run";
    store.write(results::synthetic::record(key), timing);
    EXPECT_EQ(wall_s(), 4.0);
    note_pace(store, 6.0);
    EXPECT_EQ(wall_s(), 6.0) << "loading takes half as long again";
    note_cost(store.folder(), {}, "of a study below it", {.wall_s = 1.0, .disk_bytes = 2.0});
    note_pace(store, 5.0);
    EXPECT_EQ(wall_s(), 5.0);
    EXPECT_EQ(CostBook(store.folder() / "below")
                  .of({}, "of a study below it", experiment::TrafficModel::standard)
                  .wall_s,
              1.0)
        << "other notes stay";
    note_pace(store, 3.0);
    EXPECT_EQ(wall_s(), 4.0) << "never less than what the runs name";
}

TEST(ClockWords, name_the_units_that_they_show) {
    EXPECT_EQ(clock_words(298.0), "4:58 (m:s)");
    EXPECT_EQ(clock_words(3599.7), "1:00:00 (h:m:s)");
}

}  // namespace
}  // namespace clearway::campaign
