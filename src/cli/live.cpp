#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "campaign/programs.hpp"
#include "campaign/run_plan.hpp"
#include "campaign/shown_run.hpp"
#include "cli/detail/chosen_conditions.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/files.hpp"
#include "core/interruption.hpp"
#include "core/number_range.hpp"
#include "core/process.hpp"
#include "core/process_folder.hpp"
#include "core/temporary_folder.hpp"
#include "experiment/conditions.hpp"
#include "experiment/job.hpp"
#include "experiment/settings.hpp"
#include "server/access.hpp"
#include "server/live_server.hpp"

namespace clearway::cli {
namespace {

/// Folders of this verb: those that a killed process left go when the next one begins.
constexpr const char* work_prefix = "live-";
constexpr const char* socket_prefix = "clearway-live-";

struct Arguments {
    std::string scenario;
    ConditionWords conditions;
    std::string against = "baseline";
    std::uint64_t seed = 1;
    std::string folder;
    scenario::Options options;
    Printing printing = Printing::text;
    report::Tables tables = report::Tables::essential;
    server::LiveConfig server;
};

/// 128 random bits, from the system.
std::string new_token() {
    std::random_device draw;
    std::string token;
    for (int i = 0; i < 4; ++i)
        token += fmt::format("{:08x}", draw());
    return token;
}

void require_traffic(const experiment::ConditionSpec& condition) {
    if (condition.traffic_model != experiment::TrafficModel::free_flow) return;
    throw core::InputError({"live", fmt::format("{} has no traffic to watch", condition.name),
                            "a condition with traffic", "clearway run computes the solo time"});
}

/// The conditions to watch: the other one first, so that it is left.
std::vector<experiment::ConditionSpec> watched(const Arguments& arguments) {
    const experiment::ConditionSpec shown = shown_condition(chosen_conditions(arguments.conditions), "live");
    std::vector<experiment::ConditionSpec> all;
    if (arguments.against == "baseline") {
        if (!shown.policies.empty()) all.push_back(experiment::baseline_for(shown));
    } else if (arguments.against != "none") {
        all.push_back(experiment::built_in_condition(arguments.against, "--against"));
    }
    add_once(all, shown);
    for (const experiment::ConditionSpec& condition : all)
        require_traffic(condition);
    return all;
}

study::StudyConfig study_of(const Arguments& arguments,
                            const std::vector<experiment::ConditionSpec>& watched) {
    study::StudyConfig config;
    config.seed = arguments.seed;
    config.replications = 1;
    config.scenarios = {scenario::load(arguments.scenario, arguments.options)};
    config.name = config.scenarios.front().name;
    for (const experiment::ConditionSpec& condition : watched) {
        if (!condition.policies.empty()) add_once(config.conditions, experiment::baseline_for(condition));
    }
    for (const experiment::ConditionSpec& condition : watched)
        add_once(config.conditions, condition);
    return config;
}

/// The processes that make the runs. Those that still run when it is destroyed are ended.
class Workers {
  public:
    ~Workers() { end(); }
    Workers() = default;
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    void start(const experiment::RunJob& unit, const std::filesystem::path& work) {
        const std::filesystem::path file = work / "job.json";
        core::make_folder(work);
        core::write_atomically(file, experiment::to_json(unit));
        const std::filesystem::path log = work / "worker.log";
        workers_.push_back({core::start({.program = campaign::sister_program("clearway-run"),
                                         .arguments = {file.string()},
                                         .output = log}),
                            unit.conditions.front().name, log});
    }
    /// Whether one has ended and was not well.
    bool has_failed() {
        bool failed = false;
        for (Worker& worker : workers_) {
            if (!worker.exit) worker.exit = core::poll(worker.child);
            failed = failed || (worker.exit && !worker.exit->ok());
        }
        return failed;
    }
    /// Ends those that still run: nobody allows them to go on.
    void end() {
        for (Worker& worker : workers_) {
            if (worker.exit) continue;
            ::kill(worker.child.pid, SIGTERM);
            worker.was_ended = true;
        }
        wait();
    }
    void wait() {
        for (Worker& worker : workers_) {
            if (!worker.exit) worker.exit = core::wait(worker.child);
        }
    }
    /// Says on standard error what failed, and returns the exit code.
    core::ExitCode report() const {
        constexpr int shown_lines = 10;
        core::ExitCode code = core::ExitCode::ok;
        for (const Worker& worker : workers_) {
            if (worker.exit->ok() || worker.was_ended) continue;
            fmt::print(stderr, "clearway: {}: {}\n{}", worker.condition, worker.exit->describe(),
                       core::tail(worker.log, shown_lines));
            const auto own = static_cast<core::ExitCode>(worker.exit->code);
            const bool is_told = own == core::ExitCode::bad_input || own == core::ExitCode::environment ||
                                 own == core::ExitCode::conflict;
            code = worker.exit->signal == 0 && is_told ? own : core::ExitCode::runs_failed;
        }
        return code;
    }

  private:
    struct Worker {
        core::Child child;
        std::string condition;
        std::filesystem::path log;
        std::optional<core::Exit> exit = std::nullopt;
        bool was_ended = false;  ///< By this program.
    };
    std::vector<Worker> workers_;
};

/// The surest address is the first line of the output: a program that starts this one reads it.
void say_addresses(const server::LiveConfig& config, std::uint16_t port) {
    const std::vector<std::string> pages = server::pages_of(config.host, port, config.token);
    fmt::print("{}\n", pages.front());
    std::fflush(stdout);
    fmt::print(stderr, "clearway: open this address in a browser; {}\n",
               config.allow_control ? "whoever has it may pause the runs and set their speed"
                                    : "it shows and takes no orders");
    for (std::size_t row = 1; row < pages.size(); ++row)
        fmt::print(stderr, "clearway: or {}\n", pages[row]);
}

/// Makes the runs while `server` shows them. Returns ok, or why they did not finish.
core::ExitCode show(const std::vector<experiment::RunJob>& units, server::LiveServer& server,
                    const std::filesystem::path& sockets, const server::LiveConfig& config) {
    const core::InterruptionWatch interruption;
    const core::TemporaryFolder work(core::process_folder(units.front().output / "work", work_prefix));
    Workers workers;
    std::size_t run = 0;
    for (experiment::RunJob unit : units) {
        unit.live = experiment::LiveSpec{server::socket_of(sockets, run++)};
        workers.start(unit, work.path() / unit.conditions.front().name);
    }
    say_addresses(config, server.port());
    server.run([&] { return interruption.signal() != 0 || workers.has_failed(); });
    const server::LiveCounts counts = server.counts();
    fmt::print(stderr, "clearway: {} viewers, {} refused; {} frames sent, {} left out for slow viewers\n",
               counts.clients, counts.refused, counts.frames_sent, counts.frames_dropped);
    if (interruption.signal() != 0) return interruption.exit_code(core::ExitCode::ok);
    if (workers.has_failed()) workers.end();
    workers.wait();
    return workers.report();
}

core::ExitCode live(Arguments arguments, const Invocation& invocation) {
    if (!server::is_loopback(arguments.server.host, "--host") && arguments.server.token.empty())
        arguments.server.token = new_token();
    const std::vector<experiment::ConditionSpec> conditions = watched(arguments);
    campaign::RunPlanOptions options{.folder = arguments.folder,
                                     .limits = {},
                                     .printing = arguments.printing,
                                     .command = invocation.command,
                                     .tables = arguments.tables};
    const study::Plan plan = campaign::plan_for(study_of(arguments, conditions), options);
    std::vector<experiment::RunJob> units;
    arguments.server.title = plan.manifest.study + ":";
    for (const experiment::ConditionSpec& condition : conditions) {
        units.push_back(campaign::unit_of(plan, condition));
        arguments.server.title += " " + condition.name;
    }
    arguments.server.runs = units.size();
    const core::TemporaryFolder sockets(core::process_folder(core::temporary_place(), socket_prefix));
    // Before the run folder: an address that cannot be served leaves none.
    server::LiveServer server(arguments.server, sockets.path());
    const results::Store store = campaign::prepare_run_folder(plan, options);
    const core::ExitCode code = show(units, server, sockets.path(), arguments.server);
    std::error_code ignored;
    std::filesystem::remove(store.folder() / "work", ignored);  // if it is empty
    if (code != core::ExitCode::ok) return code;
    const study::StudyResult result = campaign::run_missing(plan, store, options);
    return campaign::was_interrupted(result) ? result.exit_code
                                             : campaign::publish(store, campaign::how_to_publish(options));
}

void add_server_options(CLI::App& app, const std::shared_ptr<Arguments>& arguments) {
    const char* const group = "The server";
    server::LiveConfig& server = arguments->server;
    app.add_option("--host", server.host,
                   "Address or name to listen at; beyond this machine a token is needed")
        ->option_text(fmt::format("ADDRESS [{}]", server.host))
        ->group(group);
    app.add_option("--port", server.port, "Port to listen at; 0: any that is free")
        ->check(core::NumberRange{0.0, 65535.0})
        ->option_text(fmt::format("PORT, 0 to 65535 [{}]", server.port))
        ->group(group);
    app.add_option("--token", server.token,
                   "What viewers must know beyond this machine; at this machine only if given")
        ->option_text("TEXT, 16 to 128 letters [random beyond this machine]")
        ->group(group);
    app.add_flag("--allow-control", server.allow_control, "Let viewers pause, step and set the speed [off]")
        ->group(group);
    constexpr double fastest = 1000.0;
    app.add_option("--speed", server.speed, "Times real time; 0: as fast as possible")
        ->check(core::NumberRange{0.0, fastest})
        ->option_text(fmt::format("NUMBER, 0 to {:g} [{:g}]", fastest, server.speed))
        ->group(group);
}

}  // namespace

Action configure_live(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("scenario", arguments->scenario, "Name (clearway list), folder or TOML file")
        ->required()
        ->option_text("SCENARIO (required)");
    add_condition_words(app, arguments->conditions);
    app.add_option("--against", arguments->against, "What is shown beside it: a built-in condition, or none")
        ->option_text("NAME|none [baseline]");
    add_seed_option(app, arguments->seed);
    app.add_option("--out", arguments->folder, "Run folder")
        ->option_text("DIR [runs/SCENARIO-xxxxxx, a hash of what is run]");
    add_json_option(app, arguments->printing, "the tables");
    add_tables_option(app, arguments->tables);
    add_own_condition_options(app, arguments->conditions.own);
    add_scenario_options(app, arguments->options);
    add_server_options(app, arguments);
    return [arguments](const Invocation& invocation) { return live(*arguments, invocation); };
}

}  // namespace clearway::cli
