// Other ways, driven to their ends in copies of a run.

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "loop/copy_of_run.hpp"
#include "loop/study_folder.hpp"
#include "loop/unit_run.hpp"

namespace clearway {
namespace {

using experiment::ConditionSpec;

ConditionSpec condition(const std::string& name, core::Settings settings = {}) {
    ConditionSpec spec;
    spec.name = name;
    spec.settings = std::move(settings);
    return spec;
}

metrics::RunMetrics metrics_of(const test::StudyFolder& folder, const std::string& name) {
    const auto record = folder.store().read({"city", name, 0});
    EXPECT_TRUE(record.has_value()) << name << ": " << core::tail(folder.log(), 20);
    return record.value_or(results::RunRecord{}).metrics;
}

TEST(WayTrials, DoNotChangeTheRunAndGiveItsRegret) {
    const core::Settings tried = {{"loop.ways_tried", "3"}};
    ConditionSpec chooses = condition("chooses", tried);
    chooses.policies = {"navigate"};
    const test::StudyFolder folder("city", {}, {condition("plain"), condition("tried", tried), chooses});
    ASSERT_TRUE(folder.run(folder.unit(0)).ok()) << core::tail(folder.log(), 20);
    const auto trace = [&](const char* name) {
        return folder.store().read({"city", name, 0}).value().provenance.trace_hash;
    };
    EXPECT_EQ(trace("plain"), trace("tried"));
    EXPECT_EQ(metrics_of(folder, "plain").way_decisions, 0U);
    EXPECT_FALSE(metrics_of(folder, "plain").way_regret_s.has_value());
    for (const char* const name : {"tried", "chooses"}) {
        const metrics::RunMetrics found = metrics_of(folder, name);
        EXPECT_GE(found.way_decisions, found.emergency_count) << name << ": each when it departs";
        EXPECT_GE(found.ways_tried, 2 * found.way_decisions) << name;
        EXPECT_LE(found.way_decisions_best, found.way_decisions) << name;
        EXPECT_GE(found.way_regret_s.value(), 0.0) << name;
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "work" / "unit-0-standard"));
}

TEST(WayTrials, WhoTakesTheBestWayIsNoLaterAndRegretsNothing) {
    core::Settings settings = {{"loop.ways_tried", "3"}, {"loop.ways_every_s", "3600"}};
    const ConditionSpec plain = condition("plain", settings);
    settings["loop.best_way_taken"] = "1";
    const test::StudyFolder folder("city", {}, {plain, condition("clairvoyant", settings)});
    ASSERT_TRUE(folder.run(folder.unit(0)).ok()) << core::tail(folder.log(), 20);
    const metrics::RunMetrics before = metrics_of(folder, "plain");
    const metrics::RunMetrics found = metrics_of(folder, "clairvoyant");
    ASSERT_GT(before.way_regret_s.value(), 1.0) << "nothing to gain, nothing shown";
    EXPECT_LT(found.way_regret_s.value(), 0.5 * before.way_regret_s.value());
    EXPECT_LT(found.emergency_restricted_travel_time_s.value(),
              before.emergency_restricted_travel_time_s.value());
}

/// Notes when vehicles arrive.
class Arrivals : public trace::StepListener {
  public:
    void on_step(const truth::Snapshot&, const traffic::Roster&) override {}
    void on_step_end(const trace::RecordedStep& step) override {
        for (const core::VehicleKey key : step.events->arrived)
            at_s.emplace(key, step.events->time.value);
    }
    std::map<core::VehicleKey, double> at_s;
};

TEST(WayTrials, TheWayThatIsDrivenAnywayArrivesWhenTheRunDoes) {
    const test::StudyFolder folder("city", {}, {condition("plain")});
    loop::UnitRun run(folder.unit(0), folder.path(), folder.path() / "sumo");
    loop::ClosedLoop& loop = run.start(condition("plain"));
    Arrivals arrivals;
    loop.tell(&arrivals);
    const auto first_emergency = [&] {
        const auto& classes = loop.snapshot().vehicle_class;
        return static_cast<std::size_t>(std::ranges::find(classes, traffic::VehicleClass::emergency) -
                                        classes.begin());
    };
    double until_s = run.session().time().value;
    while (first_emergency() == loop.snapshot().size())
        loop.run(core::Seconds(until_s += 1.0));
    const std::size_t row = first_emergency();
    const core::VehicleKey vehicle = loop.snapshot().key[row];
    const std::vector<core::EdgeIndex>& route = loop.roster().route(loop.roster().find(vehicle)->route);
    const traffic::SetRoute way{vehicle, {route.begin() + loop.snapshot().route_edge[row], route.end()}};
    const std::filesystem::path copy = folder.path() / "copy";
    const double arrival_s =
        loop::in_copy(copy, [&] {
            return loop.end_after([&] { return loop.keep_to(way); }, vehicle, run.horizon(), copy);
        }).arrival.value;
    loop.run(run.horizon());
    ASSERT_TRUE(arrivals.at_s.contains(vehicle));
    EXPECT_DOUBLE_EQ(arrival_s, arrivals.at_s.at(vehicle));
    EXPECT_GT(arrival_s, until_s + 30.0);
}

}  // namespace
}  // namespace clearway
