// The dispatching of units to workers on a machine that is no machine: its clock moves only when the
// supervisor pauses, and its workers are events on that clock. Each order of events is drawn from a number.
// CLEARWAY_ORDERS says how many are tried: 100 otherwise, 100000 in scripts/nightly; CLEARWAY_FIRST_ORDER
// from which number on, so that several calls can share them.
#include <csignal>
#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>

#include "campaign/workers.hpp"
#include "core/files.hpp"
#include "experiment/job.hpp"
#include "results/synthetic.hpp"
#include "study/merge.hpp"
#include "study/shard.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::campaign {
namespace {

namespace fs = std::filesystem;
using core::Machine;
using experiment::RunKey;
using results::ErrorCause;

/// What becomes of one run of a worker.
enum class Fate : std::uint8_t {
    finishes,
    finishes_twice,  ///< Another worker has stored the same run.
    refused,
    told_crash,
    dies,
    hangs,
    finishes_late,  ///< After SIGTERM, when it counts as ended by its limit.
    ignores_sigterm,
    hogs,
    bad_input,
    forgets,
    machine_fails,
};

/// Draws of one order of events.
class Luck {
  public:
    explicit Luck(std::uint64_t order) : random_(order) {}
    bool one_in(unsigned count) { return random_() % count == 0; }
    double seconds(double most) { return std::uniform_real_distribution<double>(0.0, most)(random_); }
    std::size_t below(std::size_t count) { return random_() % count; }
    Fate fate() {
        if (!one_in(3)) return Fate::finishes;
        return static_cast<Fate>(below(static_cast<std::size_t>(Fate::machine_fails) + 1));
    }

  private:
    std::mt19937_64 random_;
};

/// Throws std::logic_error for whatever a sound dispatch never does.
void require(bool holds, const char* what) {
    if (!holds) throw std::logic_error(what);
}

class FakeMachine : public Machine {
  public:
    enum class Mood : std::uint8_t { any, only_success };
    FakeMachine(std::uint64_t order, Mood mood) : luck_(order), mood_(mood) {}

    Clock::time_point now() override { return now_; }

    void pause() override {
        // No order needs more: each unit ends within three attempts, each within its limits.
        require(++pauses_ < 20000, "the dispatch hangs");
        move(luck_.one_in(20) ? luck_.seconds(30.0) : 0.01);
        if (mood_ == Mood::any && luck_.one_in(400)) std::raise(SIGINT);
    }

    core::Child start(const core::Command& command) override {
        Worker worker;
        worker.unit = std::get<experiment::RunJob>(experiment::read_job(command.arguments.at(0)));
        const results::Store store = results::Store::open(worker.unit.output);
        require(!worker.unit.conditions.empty(), "a worker without work");
        for (const experiment::ConditionSpec& condition : worker.unit.conditions)
            require(!store.complete({worker.unit.scenario, condition.name, worker.unit.replication}),
                    "a complete run is made again");
        for (const auto& [pid, other] : workers_)
            require(other.ended || other.unit.scenario != worker.unit.scenario ||
                        other.unit.replication != worker.unit.replication ||
                        other.unit.traffic_model != worker.unit.traffic_model,
                    "two workers for one unit");
        worker.next = now_ + span(luck_.seconds(20.0));
        workers_[++last_pid_] = worker;
        return {last_pid_, now_};
    }

    std::optional<core::Exit> poll(const core::Child& child) override {
        Worker& worker = workers_.at(child.pid);
        while (!worker.ended && worker.next <= now_)
            work(worker);
        if (!worker.ended) return std::nullopt;
        const core::Exit exit = *worker.ended;
        workers_.erase(child.pid);
        return exit;
    }

    std::optional<long> resident_kib(const core::Child& child) override { return workers_.at(child.pid).kib; }

    void kill(const core::Child& child, int signal) override {
        Worker& worker = workers_.at(child.pid);
        if (worker.ended) return;
        if (signal == SIGTERM && worker.fate == Fate::ignores_sigterm) return;
        if (signal == SIGTERM && worker.fate == Fate::finishes_late) store(worker);
        worker.ended = core::Exit{.signal = signal};
    }

    std::size_t firsts(const RunKey& key) const { return firsts_.contains(key) ? firsts_.at(key) : 0; }
    std::size_t running() const { return workers_.size(); }

  private:
    struct Worker {
        experiment::RunJob unit;
        std::size_t done = 0;  ///< Conditions.
        Clock::time_point next;
        Fate fate = Fate::finishes;
        long kib = 1000;
        std::optional<core::Exit> ended = {};
    };

    static Clock::duration span(double seconds) {
        return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }
    void move(double seconds) { now_ += span(seconds); }

    static RunKey key_of(const Worker& worker) {
        return {worker.unit.scenario, worker.unit.conditions[worker.done].name, worker.unit.replication};
    }

    void store(const Worker& worker) {
        const RunKey key = key_of(worker);
        const auto store = results::Store::open(worker.unit.output);
        const auto written =
            results::synthetic::write(store, results::synthetic::record(key, 40.0 + key.replication));
        if (written == results::Store::Written::first) ++firsts_[key];
    }

    void tell(const Worker& worker, ErrorCause cause) {
        results::RunError error;
        error.key = key_of(worker);
        error.cause = cause;
        error.message = "told";
        results::Store::open(worker.unit.output).write(error);
    }

    /// The end of one run, or of the worker.
    void work(Worker& worker) {
        if (worker.done == worker.unit.conditions.size()) {
            worker.ended = core::Exit{};
            return;
        }
        worker.fate = mood_ == Mood::any ? luck_.fate() : Fate::finishes;
        constexpr auto for_ever = std::chrono::hours(1000);
        switch (worker.fate) {
            case Fate::finishes_twice:
                store(worker);
                [[fallthrough]];
            case Fate::finishes:
                store(worker);
                break;
            case Fate::refused:
                tell(worker, ErrorCause::simulator);
                break;
            case Fate::told_crash:
                tell(worker, ErrorCause::signal);
                break;
            case Fate::dies:
                worker.ended = core::Exit{.signal = SIGSEGV};
                return;
            case Fate::hogs:
                worker.kib = 1 << 30;
                [[fallthrough]];
            case Fate::hangs:
            case Fate::finishes_late:
            case Fate::ignores_sigterm:
                worker.next += for_ever;
                return;
            case Fate::bad_input:
                worker.ended = core::Exit{.code = static_cast<int>(core::ExitCode::bad_input)};
                return;
            case Fate::forgets:
                break;
            case Fate::machine_fails:
                worker.ended = core::Exit{.code = static_cast<int>(core::ExitCode::environment)};
                return;
        }
        ++worker.done;
        worker.next += span(luck_.seconds(10.0));
    }

    Luck luck_;
    Mood mood_;
    Clock::time_point now_{};
    std::map<pid_t, Worker> workers_;
    std::map<RunKey, std::size_t> firsts_;
    pid_t last_pid_ = 0;
    std::size_t pauses_ = 0;
};

class Dispatch : public testing::Test {
  protected:
    Dispatch() {
        study::StudyConfig config;
        config.name = "fake";
        config.replications = 2;
        for (const char* name : {"alpha", "beta"})
            config.scenarios.emplace_back().name = name;
        for (const char* name : {"baseline", "treated"})
            config.conditions.emplace_back().name = name;
        config_ = config;
    }

    study::Plan plan_in(const std::string& folder, const study::Shard& shard = {}) const {
        study::Plan plan = study::make_plan(config_, {"0.1.0", "1.15.0"}, folder_.path() / folder);
        study::keep_shard(plan, shard);
        return plan;
    }

    static StudyResult run_once(const study::Plan& plan, const results::Store& store, FakeMachine& machine,
                                RetriedRuns retried) {
        WorkersOptions options;
        options.workers = 2;
        options.worker_program = "fake";
        options.limits = {.wall_s = 60.0, .memory_mib = 100};
        options.retried = retried;
        options.machine = &machine;
        return run_units(plan, store, options, {});
    }

    /// Repeats the command, as its user would, until it ends by itself.
    static void run_to_its_end(const study::Plan& plan, const results::Store& store, FakeMachine& machine) {
        for (int call = 0; call < 200; ++call) {
            try {
                const StudyResult result = run_once(plan, store, machine, RetriedRuns::ended_by_machine);
                require(machine.running() == 0, "a worker outlives its study");
                if (result.exit_code != core::ExitCode::interrupted) return;
            } catch (const core::EnvironmentError&) {
                require(machine.running() == 0, "a worker outlives its study");
            }
        }
        throw std::logic_error("the study does not come to its end");
    }

    static void check_all_settled(const study::Plan& plan, const results::Store& store,
                                  const FakeMachine& machine) {
        for (const study::PlannedUnit& planned : plan.units) {
            for (const experiment::ConditionSpec& condition : planned.unit.conditions) {
                const RunKey key{planned.unit.scenario, condition.name, planned.unit.replication};
                require(store.complete(key) != store.read_error(key).has_value(),
                        "a run is neither complete nor failed, or both");
                require(machine.firsts(key) == (store.complete(key) ? 1U : 0U), "a run was not stored once");
            }
        }
    }

    void try_study(std::uint64_t order) const {
        const study::Plan plan = plan_in("out");
        const results::Store store = results::Store::create(folder_.path() / "out", plan.manifest);
        FakeMachine machine(order, FakeMachine::Mood::any);
        run_to_its_end(plan, store, machine);
        check_all_settled(plan, store, machine);
        FakeMachine sound(order, FakeMachine::Mood::only_success);
        const StudyResult result = run_once(plan, store, sound, RetriedRuns::all_failed);
        require(result.progress.done == 8, "--retry-failed leaves a run");
        fs::remove_all(folder_.path() / "out");
    }

    void try_merge(std::uint64_t order) const {
        Luck luck(order);
        std::vector<fs::path> shards;
        for (const std::uint32_t index : {1U, 2U}) {
            const std::string name = "shard-" + std::to_string(index);
            const study::Plan plan = plan_in(name, {index, 2});
            study::claim(folder_.path() / name, {index, 2});
            const results::Store store = results::Store::create(folder_.path() / name, plan.manifest);
            FakeMachine machine(order + index, FakeMachine::Mood::any);
            run_to_its_end(plan, store, machine);
            FakeMachine sound(order, FakeMachine::Mood::only_success);
            run_once(plan, store, sound, RetriedRuns::all_failed);
            shards.push_back(store.folder());
        }
        const fs::path out = folder_.path() / "merged";
        struct Cut {};
        const std::size_t cut = luck.below(3);
        try {
            study::merge(shards, out, [&](std::size_t folder) {
                if (folder == cut) throw Cut{};
            });
        } catch (const Cut&) {
        }
        const study::MergeResult merged = study::merge(shards, out, [](std::size_t) {});
        require(merged.counts.complete == 8 && merged.counts.failed == 0 && merged.missing.empty(),
                "a merge that was interrupted loses runs");
        for (const fs::path& folder : {shards[0], shards[1], out})
            fs::remove_all(folder);
    }

    /// In memory where there is such a place: nothing here asks for the disk, and flushing takes most of the
    /// time.
    static bool prefer_memory() {
        if (fs::is_directory("/dev/shm")) ::setenv("TMPDIR", "/dev/shm", 1);
        return true;
    }

    const bool is_in_memory_ = prefer_memory();  // before the folder
    support::TemporaryFolder folder_;
    study::StudyConfig config_;
};

std::uint64_t asked_number(const char* variable, std::uint64_t otherwise) {
    const char* const asked = std::getenv(variable);
    return asked == nullptr ? otherwise : std::stoull(asked);
}

TEST_F(Dispatch, MakesEachUnitOnceInAnyOrderOfDeathsDelaysAndDuplicates) {
    const std::uint64_t first = asked_number("CLEARWAY_FIRST_ORDER", 0);
    const std::uint64_t last = first + asked_number("CLEARWAY_ORDERS", 100);
    for (std::uint64_t order = first; order < last; ++order) {
        try {
            try_study(order);
            if (order % 10 == 0) try_merge(order);
        } catch (const std::exception& error) {
            FAIL() << "order " << order << ": " << error.what();
        }
    }
}

}  // namespace
}  // namespace clearway::campaign
