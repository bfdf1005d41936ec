#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <thread>

#include <gmock/gmock.h>

#include "core/process.hpp"
#include "loop/closed_loop.hpp"
#include "loop/study_folder.hpp"
#include "loop/unit_run.hpp"
#include "loop/walked_scenario.hpp"
#include "sumo/waiting_sumo.hpp"

namespace clearway {
namespace {

using experiment::ConditionSpec;
using experiment::TrafficModel;

ConditionSpec condition(const std::string& name, const std::string& failure, const std::string& predictor,
                        std::vector<std::string> parts, TrafficModel traffic_model = TrafficModel::standard) {
    ConditionSpec spec;
    spec.name = name;
    spec.failure = failure;
    spec.predictor = predictor;
    spec.policies = std::move(parts);
    spec.traffic_model = traffic_model;
    return spec;
}

const ConditionSpec baseline = condition("baseline", "perfect", "none", {});
const ConditionSpec perfect = condition("perfect", "perfect", "none", {"dissertation"});
const ConditionSpec repaired = condition("repaired", "B10", "dead_reckoning", {"dissertation"});
const ConditionSpec solo = condition("solo", "perfect", "none", {}, TrafficModel::free_flow);

core::Exit run_worker(const test::StudyFolder& folder, const experiment::RunJob& unit) {
    return folder.run(unit);
}

results::RunRecord record_of(const test::StudyFolder& folder, const std::string& scenario,
                             const std::string& name) {
    const auto record = folder.store().read({scenario, name, 0});
    EXPECT_TRUE(record.has_value()) << name << ": " << core::tail(folder.log(), 20);
    return record.value_or(results::RunRecord{});
}

TEST(Worker, StoresARecordForEveryConditionOfAUnit) {
    const test::StudyFolder folder("intersection", {}, {baseline, perfect, repaired});
    const core::Exit exit = run_worker(folder, folder.unit(0));
    EXPECT_TRUE(exit.ok()) << exit.describe() << core::tail(folder.log(), 20);
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

TEST(Worker, RunsSumosBluelightAndDriversWhoYield) {
    ConditionSpec light = baseline;
    light.name = "light";
    light.bluelight = traffic::BlueLight::on;
    scenario::Options dense;
    dense.set("variant", "dense");
    const test::StudyFolder plain("merge", dense, {baseline, light});
    ASSERT_TRUE(run_worker(plain, plain.unit(0)).ok());
    dense.set("siren_compliance", "1");
    const test::StudyFolder heard("merge", dense, {baseline});
    ASSERT_TRUE(run_worker(heard, heard.unit(0)).ok());
    const auto trace = [](const test::StudyFolder& folder, const char* name) {
        return record_of(folder, "merge", name).provenance.trace_hash;
    };
    EXPECT_NE(trace(plain, "light"), trace(plain, "baseline"));
    EXPECT_NE(trace(heard, "baseline"), trace(plain, "baseline"));
}

TEST(Worker, DrivesInRainAndOnIceInEveryConditionAndAlone) {
    const auto travel_times = [](const scenario::Options& options) {
        const test::StudyFolder folder("intersection", options, {baseline, perfect, solo});
        EXPECT_TRUE(run_worker(folder, folder.unit(0)).ok());
        EXPECT_TRUE(run_worker(folder, folder.unit(0, TrafficModel::free_flow)).ok());
        std::map<std::string, double> times;
        for (const char* const name : {"baseline", "perfect", "solo"}) {
            const metrics::RunMetrics run = record_of(folder, "intersection", name).metrics;
            EXPECT_EQ(run.emergency_arrived, 2U) << name;
            times[name] = run.emergency_travel_time_s.value_or(0.0);
        }
        return times;
    };
    const auto dry = travel_times({});
    scenario::Options rain;
    rain.set("road_speed_factor", "0.5");
    scenario::Options ice;
    ice.set("friction", "0.2");
    const auto wet = travel_times(rain);
    for (const auto& [name, time_s] : dry)
        EXPECT_GT(wet.at(name), time_s * 1.05) << name;
    const auto icy = travel_times(ice);
    for (const char* const name : {"baseline", "perfect"})
        EXPECT_GT(icy.at(name), dry.at(name) * 1.05) << name << "; alone they meet no one to brake for";
}

const ConditionSpec clearing = condition("corridor", "perfect", "none", {"corridor"});

TEST(Worker, LetsEmergencyVehiclesInWhereThereIsNoSignalAndOnlyWhereVehiclesHearIt) {
    const ConditionSpec asking = condition("asking", "perfect", "none", {"give_way"});
    const ConditionSpec deaf =
        condition("deaf", "perfect,request_propagation=sharp,request_loss_rate=1", "none", {"give_way"});
    scenario::Options dense;
    dense.set("variant", "dense");
    const test::StudyFolder folder("city", dense, {baseline, asking, deaf});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    std::uint64_t stops = 0;
    const results::RunRecord asked = record_of(folder, "city", "asking");
    for (const metrics::LeaseRow& row : asked.leases) {
        if (row.action == traffic::LeaseKind::stop_at_line) stops += row.acted;
    }
    EXPECT_GT(stops, 0U);
    EXPECT_EQ(asked.metrics.emergency_arrived, asked.metrics.emergency_count);
    const auto trace = [&](const char* name) {
        return record_of(folder, "city", name).provenance.trace_hash;
    };
    EXPECT_NE(trace("asking"), trace("baseline"));
    const results::RunRecord unheard = record_of(folder, "city", "deaf");
    for (const metrics::LeaseRow& row : unheard.leases)
        EXPECT_EQ(row.acted, 0U) << name(row.action);
}

TEST(Worker, MeetsPedestriansAlikeInEveryConditionAndHitsNoMoreOfThem) {
    scenario::Options walked;
    walked.set("variant", "dense");
    walked.set("road_limit_kmh", "70");
    walked.set("pedestrians_per_hour", "300");
    walked.set("step_length_s", "0.1");
    const test::StudyFolder folder("intersection", walked, {baseline, clearing, solo});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    ASSERT_TRUE(run_worker(folder, folder.unit(0, TrafficModel::free_flow)).ok());
    const metrics::RunMetrics before = record_of(folder, "intersection", "baseline").metrics;
    const metrics::RunMetrics after = record_of(folder, "intersection", "corridor").metrics;
    EXPECT_EQ(before.pedestrian_count, 133U) << "300 an hour at 4 crossings, for 400 s";
    EXPECT_EQ(after.pedestrian_count, before.pedestrian_count);
    EXPECT_GT(before.pedestrian_time_loss_s.value_or(0.0), 5.0);
    for (const metrics::RunMetrics& run : {before, after}) {
        EXPECT_EQ(run.pedestrians_unfinished, 0U);
        EXPECT_EQ(run.emergency_pedestrian_collisions, 0U);
        EXPECT_EQ(run.emergency_arrived, 6U);
    }
    EXPECT_LE(after.pedestrian_collisions, before.pedestrian_collisions) << "SUMO's right-turners hit some";
    EXPECT_LT(after.emergency_time_loss_s, before.emergency_time_loss_s);
    EXPECT_EQ(record_of(folder, "intersection", "solo").metrics.pedestrian_count, 0U);
}

TEST(Worker, MeetsThePersonsOfAScenarioAlikeInEveryConditionAndNotAlone) {
    const test::WalkedScenario scenario;
    const test::StudyFolder folder(scenario.folder(), {}, {baseline, clearing, solo});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    ASSERT_TRUE(run_worker(folder, folder.unit(0, TrafficModel::free_flow)).ok());
    for (const char* const name : {"baseline", "corridor"}) {
        const metrics::RunMetrics run = record_of(folder, "walked", name).metrics;
        EXPECT_EQ(run.pedestrian_count, static_cast<std::uint64_t>(test::WalkedScenario::persons)) << name;
        EXPECT_EQ(run.pedestrians_unfinished, 0U) << name;
        EXPECT_GT(run.pedestrian_time_loss_s.value_or(0.0), 5.0) << name;
        EXPECT_EQ(run.emergency_pedestrian_collisions, 0U) << name;
        EXPECT_EQ(run.emergency_arrived, 3U) << name;
    }
    EXPECT_EQ(record_of(folder, "walked", "solo").metrics.pedestrian_count, 0U);
}

/// Counts letters that turn green, in states that Clearway set, while somebody walks on a crossing in the
/// way.
class CrossingWatch : public trace::StepListener {
  public:
    CrossingWatch(const roads::Network& network, const sumo::Session& session)
        : network_(network), session_(session) {}

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster&) override {
        for (std::size_t row = 0; row < before_.size(); ++row)
            look(network_.signals()[row], before_[row], snapshot.signals.state[row]);
        before_ = snapshot.signals.state;
    }
    int greens = 0;
    int greens_with_pedestrians = 0;

  private:
    void look(const roads::Signal& signal, const std::string& before, const std::string& now) {
        if (std::ranges::count(signal.program, now, &roads::Phase::state) > 0) return;
        for (std::size_t link = 0; link < now.size(); ++link) {
            if (!traffic::is_green(now[link]) || traffic::is_green(before[link])) continue;
            ++greens;
            for (std::size_t crossing = 0; crossing < now.size(); ++crossing) {
                if (!signal.crossings[crossing] || !signal.foes[link][crossing]) continue;
                // Where a phase of the program gives green to both, whoever turns yields to people.
                const bool yields =
                    now[link] == 'g' && traffic::is_green(now[crossing]) &&
                    std::ranges::any_of(signal.program, [&](const roads::Phase& phase) {
                        return phase.state[link] == 'g' && traffic::is_green(phase.state[crossing]);
                    });
                if (yields) continue;
                if (session_.has_pedestrian(signal.links[crossing].front().to)) ++greens_with_pedestrians;
            }
        }
    }

    const roads::Network& network_;
    const sumo::Session& session_;
    std::vector<std::string> before_;
};

/// libsumo holds one simulation a process, so each scenario has a process of its own: a test.
void expect_no_green_across_people(const std::string& scenario, const scenario::Options& options) {
    const test::StudyFolder folder(scenario, options, {clearing});
    const sumo::Session* session = nullptr;
    loop::UnitRun run(folder.unit(0), folder.path() / "demand", folder.path() / "here",
                      [&](sumo::SessionConfig config) {
                          auto started = loop::in_this_process(std::move(config));
                          session = started.get();
                          return started;
                      });
    CrossingWatch watch(run.network(), *session);
    run.record(clearing, watch);
    EXPECT_GT(watch.greens, 5);
    EXPECT_EQ(watch.greens_with_pedestrians, 0);
}

TEST(Worker, GivesNoGreenAcrossACrossingThatSomebodyIsStillOn) {
    scenario::Options slow;
    slow.set("variant", "dense");
    slow.set("road_limit_kmh", "70");
    slow.set("pedestrians_per_hour", "600");
    slow.settings = {{"pedestrians.speed_mean_mps", "0.8"}};
    expect_no_green_across_people("intersection", slow);
}

TEST(Worker, GivesNoGreenAcrossACrossingThatAPersonOfTheScenarioIsStillOn) {
    const test::WalkedScenario scenario;
    expect_no_green_across_people(scenario.folder(), {});
}

TEST(Worker, BelievesTheTrueGraphUnderPerfectSensing) {
    const test::StudyFolder folder("intersection", {}, {perfect});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    const results::RunRecord record = record_of(folder, "intersection", "perfect");
    EXPECT_GT(record.metrics.links_true_positive, 0U);
    EXPECT_EQ(record.metrics.links_false_positive, 0U);
    EXPECT_EQ(record.metrics.links_false_negative, 0U);
}

TEST(Worker, ReportsThatAreOnlyLateMakeNoVehicleDark) {
    const ConditionSpec late = condition("late", "DL2", "dead_reckoning", {"dissertation"});
    const ConditionSpec lost = condition("lost", "DL2,loss_rate=0.5", "dead_reckoning", {"dissertation"});
    const test::StudyFolder folder("intersection", {}, {late, lost});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    const auto dark_share = [&](const char* name) {
        const metrics::RunMetrics run = record_of(folder, "intersection", name).metrics;
        return static_cast<double>(run.dark_links_true_positive + run.dark_links_false_negative) /
               static_cast<double>(run.links_true_positive + run.links_false_negative);
    };
    EXPECT_LT(dark_share("late"), 0.1) << "only those who entered in the last two seconds";
    EXPECT_GT(dark_share("lost"), 2.0 * dark_share("late"));
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

/// The bytes that a run left in a folder.
std::map<std::string, std::string> stored_bytes(const results::Store& store, const experiment::RunKey& key) {
    std::map<std::string, std::string> files;
    for (const char* const name : {"run.json", "vehicles.csv"})
        files[name] = core::read_file(store.run_folder(key) / name);
    return files;
}

/// libsumo holds one simulation a process, so each scenario without a fork has a process of its own: a test.
void expect_equal_without_fork(const std::string& scenario, const scenario::Options& options) {
    const test::StudyFolder forked(scenario, options, {baseline, repaired});
    ASSERT_TRUE(run_worker(forked, forked.unit(0)).ok());
    const test::StudyFolder alone(scenario, options, {baseline, repaired});
    loop::UnitRun unforked(alone.unit(0), alone.path() / "demand", alone.path() / "unforked");
    results::RunTiming timing;
    const results::RunRecord record = unforked.finish_here(repaired, timing);
    EXPECT_FALSE(record.traffic.approaches.empty());
    EXPECT_FALSE(record.traffic.recovery.empty());
    EXPECT_FALSE(record.traffic.journeys.empty());
    EXPECT_FALSE(record.traffic.edge_times.empty());
    const experiment::RunKey key{alone.unit(0).scenario, "repaired", 0};
    EXPECT_EQ(record.traffic, forked.store().read_traffic(key));
    alone.store().write(record, timing);
    EXPECT_GT(alone.store().read(key)->metrics.leases_issued, 0U);
    EXPECT_EQ(stored_bytes(alone.store(), key), stored_bytes(forked.store(), key));
}

TEST(Worker, EqualsARunWithoutForkInTheCity) {
    expect_equal_without_fork("city", {});
}

TEST(Worker, EqualsARunWithoutForkAmongPedestrians) {
    scenario::Options walked;
    walked.set("pedestrians_per_hour", "300");
    expect_equal_without_fork("city", walked);
}

TEST(Worker, EqualsARunWithoutForkAmongThePersonsOfAScenario) {
    const test::WalkedScenario scenario;
    expect_equal_without_fork(scenario.folder(), {});
}

TEST(Worker, EqualsARunWithoutForkInBologna) {
    scenario::Options shortened;
    shortened.set("density", "0.2");  // of the measured demand; the whole takes minutes
    shortened.set("horizon_s", "1200");
    expect_equal_without_fork("bologna", shortened);
}

TEST(Worker, EqualsARunInASumoThatWasStartedElsewhere) {
    const ConditionSpec corridor = condition("corridor", "B10", "dead_reckoning", {"corridor"});
    const test::StudyFolder local("intersection", {}, {baseline, corridor});
    ASSERT_TRUE(run_worker(local, local.unit(0)).ok());
    const test::StudyFolder remote("intersection", {}, {baseline, corridor});
    std::optional<test::WaitingSumo> waiting;
    loop::UnitRun run(remote.unit(0), remote.path() / "demand", remote.path() / "remote",
                      [&](const sumo::SessionConfig& config) {
                          waiting.emplace(sumo::command_line(config), remote.path() / "waiting.log");
                          return std::make_unique<sumo::Session>(
                              sumo::RemoteSumo("localhost", waiting->port()), remote.path() / "client",
                              config.names);
                      });
    results::RunTiming timing;
    remote.store().write(run.finish_here(corridor, timing), timing);
    const experiment::RunKey key{"intersection", "corridor", 0};
    EXPECT_GT(remote.store().read(key)->metrics.leases_issued, 0U);
    EXPECT_EQ(stored_bytes(remote.store(), key), stored_bytes(local.store(), key));
}

/// A run with a window, but for the window: the simulation in a child, over a connection, with all drawing.
core::Exit show_without_window(const test::StudyFolder& folder, experiment::RunJob unit,
                               const ConditionSpec& shown) {
    unit.conditions = {shown};
    unit.window = experiment::WindowSpec{.delay_s = 0.0, .settings_file = {}, .program = "sumo"};
    return core::run({.program = CLEARWAY_BINARY_DIR "/bin/clearway-run",
                      .arguments = {folder.write(unit).string()},
                      .environment = {},
                      .output = folder.log()});
}

TEST(Worker, EqualsARunThatIsShown) {
    const ConditionSpec corridor = condition("corridor", "B10", "dead_reckoning", {"corridor"});
    const test::StudyFolder usual("intersection", {}, {baseline, corridor, solo});
    ASSERT_TRUE(run_worker(usual, usual.unit(0)).ok());
    ASSERT_TRUE(run_worker(usual, usual.unit(0, TrafficModel::free_flow)).ok());
    const test::StudyFolder watched("intersection", {}, {baseline, corridor, solo});
    for (const ConditionSpec& shown : {corridor, solo}) {
        const core::Exit exit = show_without_window(watched, watched.unit(0, shown.traffic_model), shown);
        ASSERT_TRUE(exit.ok()) << exit.describe() << core::tail(watched.path() / "worker.log", 20);
        const experiment::RunKey key{"intersection", shown.name, 0};
        EXPECT_EQ(stored_bytes(watched.store(), key), stored_bytes(usual.store(), key)) << shown.name;
    }
}

TEST(Worker, RunsEmergencyVehiclesAloneForTheSoloTime) {
    scenario::Options dense;
    dense.set("variant", "dense");
    const test::StudyFolder folder("intersection", dense, {baseline, solo});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    ASSERT_TRUE(run_worker(folder, folder.unit(0, TrafficModel::free_flow)).ok());
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
    const std::filesystem::path network =
        folder.store().scenario_folder("intersection") / "network/network.net.xml";
    std::string text = core::read_file(network);
    const std::string lane = "<lane ";
    text.replace(text.find(lane), lane.size(), "<lane disallow=\"cable_car\" ");
    core::write_atomically(network, text);
    EXPECT_TRUE(run_worker(folder, folder.unit(0)).ok());
    EXPECT_FALSE(folder.store().complete({"intersection", "baseline", 0}));
    const auto failure = folder.store().read_error({"intersection", "baseline", 0});
    ASSERT_TRUE(failure.has_value());
    EXPECT_EQ(failure->cause, results::ErrorCause::simulator);
    EXPECT_THAT(failure->message + failure->log_tail, testing::HasSubstr("cable_car"));
}

/// The first child of a process, once it has one.
pid_t child_of(pid_t process) {
    const std::string file = fmt::format("/proc/{0}/task/{0}/children", process);
    for (pid_t child = 0;; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
        std::ifstream stream(file);
        if (stream >> child) return child;
    }
}

/// Whether a process stands still after SIGSTOP; false when it ended before. A signal that ends a process
/// overtakes one that stops it, so whoever sends both must wait in between.
bool stands_still(pid_t process) {
    for (;; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
        std::string id, name, state;
        std::ifstream(fmt::format("/proc/{}/stat", process)) >> id >> name >> state;
        if (state == "T") return true;
        if (state.empty() || state == "Z") return false;
    }
}

/// Stops the run that a worker is making, the next one if the first has ended meanwhile.
pid_t stop_run_of(pid_t worker) {
    for (;;) {
        const pid_t run = child_of(worker);
        ::kill(run, SIGSTOP);
        if (stands_still(run)) return run;
    }
}

TEST(Worker, RecordsACrashWithItsSignalAndTheCommandThatMakesTheRunAgain) {
    const test::StudyFolder folder("city", {}, {repaired, baseline});
    const std::filesystem::path file = folder.write(folder.unit(0));
    const core::Child worker = core::start({.program = CLEARWAY_BINARY_DIR "/bin/clearway-run",
                                            .arguments = {file.string()},
                                            .environment = {},
                                            .output = folder.log()});
    kill(child_of(worker.pid), SIGSEGV);
    EXPECT_TRUE(core::wait(worker).ok());
    const experiment::RunKey key{"city", "repaired", 0};
    const auto failure = folder.store().read_error(key);
    ASSERT_TRUE(failure.has_value());
    EXPECT_EQ(failure->cause, results::ErrorCause::signal);
    EXPECT_EQ(failure->signal, SIGSEGV);
    EXPECT_TRUE(folder.store().complete({"city", "baseline", 0})) << "the other condition goes on";
    EXPECT_EQ(std::system(failure->command.c_str()), 0);
    EXPECT_TRUE(folder.store().complete(key));
    EXPECT_FALSE(folder.store().read_error(key));
}

TEST(Worker, EndsAnInterruptedRunBeforeItselfSoThatNothingIsWrittenAfterwards) {
    const test::StudyFolder folder("city", {}, {baseline, perfect});
    const core::Child worker = core::start({.program = CLEARWAY_BINARY_DIR "/bin/clearway-run",
                                            .arguments = {folder.write(folder.unit(0)).string()},
                                            .environment = {},
                                            .output = folder.log()});
    const pid_t run = stop_run_of(worker.pid);
    ::kill(worker.pid, SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    ASSERT_FALSE(core::poll(worker)) << "the worker is gone while its run may still write";
    ::kill(run, SIGCONT);
    EXPECT_EQ(core::wait(worker).signal, SIGTERM);
    EXPECT_NE(::kill(run, 0), 0);
    EXPECT_TRUE(folder.store().complete_runs().empty());
}

TEST(Worker, EndsARunThatTakesTooLongOrTooMuchMemory) {
    const test::StudyFolder folder("city", {}, {baseline});
    const experiment::RunKey key{"city", "baseline", 0};
    experiment::RunJob unit = folder.unit(0);
    unit.limits.wall_s = 0.01;
    ASSERT_TRUE(run_worker(folder, unit).ok());
    EXPECT_EQ(folder.store().read_error(key)->cause, results::ErrorCause::time_limit);
    EXPECT_THAT(folder.store().read_error(key)->message, testing::HasSubstr("0.01 s"));
    unit.limits = {.wall_s = 60.0, .memory_mib = 5};
    ASSERT_TRUE(run_worker(folder, unit).ok());
    EXPECT_EQ(folder.store().read_error(key)->cause, results::ErrorCause::memory);
    EXPECT_THAT(folder.store().read_error(key)->message, testing::HasSubstr("5 MiB"));
    unit.limits.memory_mib = 1000;
    ASSERT_TRUE(run_worker(folder, unit).ok());
    EXPECT_TRUE(folder.store().complete(key));
}

TEST(Worker, GivesParametersOfFailureAndLoopToACondition) {
    ConditionSpec often = perfect;
    often.name = "often";
    often.settings = {{"loop.policy_period_s", "0.25"}};
    ConditionSpec dark = repaired;
    dark.name = "dark";
    dark.failure += ",dark_share=0.9";
    const test::StudyFolder folder("intersection", {}, {perfect, often, repaired, dark});
    ASSERT_TRUE(run_worker(folder, folder.unit(0)).ok());
    EXPECT_GT(record_of(folder, "intersection", "often").metrics.leases_renewed,
              record_of(folder, "intersection", "perfect").metrics.leases_renewed);
    EXPECT_NE(record_of(folder, "intersection", "dark").provenance.trace_hash,
              record_of(folder, "intersection", "repaired").provenance.trace_hash);
}

}  // namespace
}  // namespace clearway
