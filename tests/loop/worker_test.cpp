#include <csignal>
#include <cstdlib>

#include <gmock/gmock.h>

#include "core/process.hpp"
#include "loop/study_folder.hpp"
#include "loop/unit_run.hpp"

namespace clearway {
namespace {

using results::ConditionSpec;
using results::Engine;

ConditionSpec condition(const std::string& name, const std::string& failure, const std::string& predictor,
                        std::vector<std::string> parts, Engine engine = Engine::standard) {
    ConditionSpec spec;
    spec.name = name;
    spec.failure = failure;
    spec.predictor = predictor;
    spec.parts = std::move(parts);
    spec.engine = engine;
    return spec;
}

const ConditionSpec baseline = condition("baseline", "perfect", "none", {});
const ConditionSpec perfect = condition("perfect", "perfect", "none", {"dissertation"});
const ConditionSpec repaired = condition("repaired", "B10", "dead_reckoning", {"dissertation"});
const ConditionSpec solo = condition("solo", "perfect", "none", {}, Engine::solo);

core::Exit run_worker(const test::StudyFolder& folder, const results::UnitSpec& unit) {
    const std::filesystem::path file = folder.write(unit);
    return core::run({.program = CLEARWAY_BINARY_DIR "/bin/clearway-run",
                      .arguments = {"--unit", file.string()},
                      .environment = {},
                      .output = folder.path() / "worker.log"});
}

results::RunRecord record_of(const test::StudyFolder& folder, const std::string& scenario,
                             const std::string& name) {
    const auto record = folder.store().read({scenario, name, 0});
    EXPECT_TRUE(record.has_value()) << name << ": " << core::tail(folder.path() / "worker.log", 20);
    return record.value_or(results::RunRecord{});
}

TEST(Worker, StoresARecordForEveryConditionOfAUnit) {
    const test::StudyFolder folder("intersection", {}, {baseline, perfect, repaired});
    const core::Exit exit = run_worker(folder, folder.unit(0));
    EXPECT_TRUE(exit.ok()) << exit.describe() << core::tail(folder.path() / "worker.log", 20);
    for (const char* const name : {"baseline", "perfect", "repaired"}) {
        const results::RunRecord record = record_of(folder, "intersection", name);
        EXPECT_EQ(record.metrics.vehicle_count, 44U) << name;
        EXPECT_EQ(record.metrics.emergency_count, 2U) << name;
        EXPECT_EQ(record.metrics.emergency_arrived, 2U) << name;
        EXPECT_EQ(record.metrics.not_inserted + record.metrics.unfinished, 0U) << name;
    }
    EXPECT_EQ(record_of(folder, "intersection", "baseline").metrics.leases_issued, 0U);
    EXPECT_GT(record_of(folder, "intersection", "perfect").metrics.leases_issued, 0U);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "work" / "unit-0-standard"));
}

TEST(Worker, BelievesTheTrueGraphUnderPerfectSensing) {
    const test::StudyFolder folder("intersection", {}, {perfect});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    const results::RunRecord record = record_of(folder, "intersection", "perfect");
    EXPECT_GT(record.metrics.links_true_positive, 0U);
    EXPECT_EQ(record.metrics.links_false_positive, 0U);
    EXPECT_EQ(record.metrics.links_false_negative, 0U);
}

TEST(Worker, GivesTheSameRecordWhetherAConditionIsForkedFirstLastOrAlone) {
    const test::StudyFolder together("city", {}, {baseline, repaired});
    const test::StudyFolder reversed("city", {}, {repaired, baseline});
    const test::StudyFolder alone("city", {}, {repaired});
    for (const test::StudyFolder* const folder : {&together, &reversed, &alone}) {
        ASSERT_TRUE(run_worker(*folder, folder->unit(0)).ok());
    }
    EXPECT_EQ(record_of(together, "city", "repaired"), record_of(reversed, "city", "repaired"));
    EXPECT_EQ(record_of(together, "city", "repaired"), record_of(alone, "city", "repaired"));
    EXPECT_EQ(record_of(together, "city", "baseline"), record_of(reversed, "city", "baseline"));
}

TEST(Worker, EqualsARunWithoutFork) {
    const test::StudyFolder folder("city", {}, {repaired});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    const results::UnitSpec unit = folder.unit(0);
    loop::UnitRun unforked(unit, folder.path() / "scenarios" / "city" / "demand" / "0",
                           folder.path() / "unforked");
    results::RunTiming timing;
    results::RunRecord record = unforked.finish_here(repaired, timing);
    EXPECT_FALSE(record.traffic.approaches.empty());
    EXPECT_FALSE(record.traffic.recovery.empty());
    EXPECT_FALSE(record.traffic.journeys.empty());
    EXPECT_EQ(record.traffic.journeys, folder.store().read_journeys({"city", "repaired", 0}));
    record.traffic.journeys.clear();  // they are not read back with the rest
    EXPECT_EQ(record, record_of(folder, "city", "repaired"));
}

TEST(Worker, RunsEmergencyVehiclesAloneForTheSoloTime) {
    scenario::Options dense;
    dense.variant = scenario::Variant::dense;
    const test::StudyFolder folder("intersection", dense, {baseline, solo});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    ASSERT_TRUE(run_worker(folder, folder.unit(0, Engine::solo)).ok());
    const results::RunRecord alone = record_of(folder, "intersection", "solo");
    EXPECT_EQ(alone.metrics.vehicle_count, 6U);
    EXPECT_EQ(alone.metrics.emergency_arrived, 6U);
    EXPECT_EQ(alone.metrics.emergency_waiting_time_s, 0.0);
    EXPECT_LT(alone.metrics.emergency_travel_time_s,
              record_of(folder, "intersection", "baseline").metrics.emergency_travel_time_s);
}

TEST(Worker, SkipsWhatIsCompleteAndChangesNothing) {
    const test::StudyFolder folder("intersection", {}, {baseline, perfect});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    const auto file = folder.store().run_folder({"intersection", "baseline", 0}) / "run.json";
    const auto written = std::filesystem::last_write_time(file);
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    EXPECT_EQ(std::filesystem::last_write_time(file), written);
}

TEST(Worker, RecordsAFailureOfTheSimulatorWithItsLog) {
    const test::StudyFolder folder("intersection", {}, {baseline});
    // A vehicle class of newer networks: our reader skips it, SUMO 1.15 refuses the file.
    const std::filesystem::path network = folder.store().scenario_folder("intersection") / "network.net.xml";
    std::string text = core::read_file(network);
    const std::string lane = "<lane ";
    text.replace(text.find(lane), lane.size(), "<lane disallow=\"cable_car\" ");
    core::write_atomically(network, text);
    EXPECT_TRUE(run_worker(folder, folder.unit(0)).ok());
    EXPECT_FALSE(folder.store().complete({"intersection", "baseline", 0}));
    const auto failure = folder.store().read_failure({"intersection", "baseline", 0});
    ASSERT_TRUE(failure.has_value());
    EXPECT_EQ(failure->cause, results::FailureCause::simulator);
    EXPECT_THAT(failure->message + failure->log_tail, testing::HasSubstr("cable_car"));
}

}  // namespace
}  // namespace clearway
