#include <algorithm>
#include <chrono>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/detail/common_options.hpp"
#include "cli/detail/run_plan.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/files.hpp"
#include "experiment/conditions.hpp"

namespace clearway::cli {
namespace {

struct Arguments {
    std::string scenario;
    std::uint64_t seed = 1;
    experiment::RunLimits limits;
    Printing printing = Printing::text;
    scenario::Options options;
};

/// What a finding means for a comparison of policies on the scenario.
enum class Grade : std::uint8_t { ok, note, falls_short, failed };

constexpr const char* word_of(Grade grade) {
    switch (grade) {
        case Grade::ok:
            return "ok";
        case Grade::note:
            return "note";
        case Grade::falls_short:
            return "short";
        case Grade::failed:
            return "FAILED";
    }
    return "";
}

struct Finding {
    std::string name;
    Grade grade = Grade::ok;
    std::string text;
};

double share(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

Finding emergency_finding(const results::RunRecord& record) {
    std::size_t entered = 0;
    std::size_t arrived = 0;
    for (const metrics::VehicleRow& row : record.vehicles) {
        if (row.vehicle_class != traffic::VehicleClass::emergency) continue;
        entered += row.outcome != metrics::VehicleOutcome::not_inserted ? 1 : 0;
        arrived += row.outcome == metrics::VehicleOutcome::arrived ? 1 : 0;
    }
    const std::uint64_t count = record.metrics.emergency_count;
    const Grade grade = count == 0 || entered < count ? Grade::falls_short : Grade::ok;
    return {"emergency", grade,
            fmt::format("{} EVs with a route, {} entered, {} arrived in the time checked", count, entered,
                        arrived)};
}

/// Number of routes that `prepare` wrote, and of those with a single edge.
struct RouteCount {
    std::size_t all = 0;
    std::size_t single = 0;

    void add(const std::string& edges) {
        ++all;
        single += edges.find(' ') == std::string::npos ? 1 : 0;
    }
    bool mostly_single() const { return 2 * single > all; }
};

RouteCount traffic_routes(const std::string& xml) {
    constexpr std::string_view mark = " edges=\"";
    RouteCount count;
    for (std::size_t at = xml.find(mark); at != std::string::npos; at = xml.find(mark, at + 1)) {
        const std::size_t start = at + mark.size();
        count.add(xml.substr(start, xml.find('"', start) - start));
    }
    return count;
}

/// The edges are the last column.
RouteCount emergency_routes(const std::string& csv) {
    RouteCount count;
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line))
        count.add(line.substr(line.rfind(',') + 1));
    return count;
}

/// A vehicle with a single edge passes no junction, so it meets no signal and no crossing traffic.
Finding routes_finding(const std::filesystem::path& demand) {
    const RouteCount traffic = traffic_routes(core::read_file(demand / "traffic.rou.xml"));
    const RouteCount emergency = emergency_routes(core::read_file(demand / "emergency.csv"));
    const bool is_short = traffic.mostly_single() || emergency.mostly_single();
    return {"routes", is_short ? Grade::falls_short : Grade::ok,
            fmt::format("{} of {} vehicles and {} of {} EVs drive a single edge, through no junction",
                        traffic.single, traffic.all, emergency.single, emergency.all)};
}

std::vector<Finding> findings_of(const results::RunRecord& record, const results::RunTiming& timing,
                                 double wall_s) {
    constexpr double most_left_outside = 0.1;  // Share of the vehicles. Above it, queues reach the boundary.
    constexpr double most_teleported = 0.01;
    const metrics::RunMetrics& run = record.metrics;
    const double outside = share(run.not_inserted, run.vehicle_count);
    const double teleported = share(run.teleports, run.vehicle_count);
    return {
        {"loads", Grade::ok, "SUMO loads the network and the demand"},
        {"inserts", outside > most_left_outside ? Grade::falls_short : Grade::ok,
         fmt::format("{} of {} vehicles entered, {:.1f} s late on average",
                     run.vehicle_count - run.not_inserted, run.vehicle_count,
                     run.depart_delay_s.value_or(0.0))},
        emergency_finding(record),
        {"jams", teleported > most_teleported ? Grade::falls_short : Grade::ok,
         fmt::format("{} teleports, {} still on the road at {:.0f} s, {:.1f} s mean time loss", run.teleports,
                     run.unfinished, run.simulated_s, run.others_time_loss_s.value_or(0.0))},
        {"collisions", run.collisions > 0 ? Grade::note : Grade::ok,
         fmt::format("{} in the baseline, {} of them at junctions", run.collisions, run.junction_collisions)},
        {"speed", Grade::ok,
         fmt::format("{:.1f} times real time, including loading", run.simulated_s / wall_s)},
        {"memory", Grade::ok, fmt::format("{} MiB", timing.peak_kib / 1024)}};
}

Finding error_finding(const results::RunError& error, const std::filesystem::path& folder) {
    const bool aborted = error.cause == results::ErrorCause::signal;
    std::string text = error.message;
    if (!error.log_tail.empty()) text += "\n" + error.log_tail;
    text += fmt::format("\nInputs and logs are kept in {}; the command that repeats the run:\n  {}",
                        folder.string(), error.command);
    if (aborted)
        text +=
            "\nSUMO itself aborted. If a teleport came before it, --time-to-teleport -1 avoids it; less "
            "traffic (--density 0.5) may help too";
    return {aborted ? "aborts" : "loads", Grade::failed, text};
}

void print(const std::vector<Finding>& findings, Printing printing) {
    if (printing == Printing::text) {
        for (const Finding& finding : findings)
            fmt::print("{:8} {:11} {}\n", word_of(finding.grade), finding.name, finding.text);
        return;
    }
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const Finding& finding : findings)
        rows.push_back(
            {{"finding", finding.name}, {"grade", word_of(finding.grade)}, {"text", finding.text}});
    fmt::print("{}\n", rows.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

core::ExitCode exit_code_of(const std::vector<Finding>& findings) {
    const auto has = [&](Grade grade) {
        return std::ranges::any_of(findings, [&](const Finding& each) { return each.grade == grade; });
    };
    if (has(Grade::failed)) return core::ExitCode::runs_failed;
    return has(Grade::falls_short) ? core::ExitCode::fell_short : core::ExitCode::ok;
}

core::ExitCode check(const Arguments& arguments, const Invocation& invocation) {
    study::StudyConfig config;
    config.seed = arguments.seed;
    config.replications = 1;
    config.scenarios = {scenario::load(arguments.scenario, arguments.options)};
    scenario::ScenarioConfig& brief = config.scenarios.front();
    constexpr double grace_s = 60.0;  // So that the last to depart can enter too.
    double last_s = brief.time.window_s;
    for (const scenario::EmergencyTrip& trip : brief.emergency_trips)
        last_s = std::max(last_s, trip.depart_s);
    brief.time.horizon_s = std::min(brief.time.horizon_s, last_s + grace_s);
    config.name = brief.name;
    config.conditions = {experiment::built_in_condition("baseline", "check")};
    RunPlanOptions options{std::filesystem::path("runs") / ("check-" + brief.name), 1, arguments.limits,
                           arguments.printing, invocation.command};
    std::filesystem::remove_all(options.folder);
    const study::Plan plan = plan_for(config, options);
    const results::Store store = prepare_run_folder(plan, options);
    const auto started = std::chrono::steady_clock::now();
    const study::StudyResult result = run_missing(plan, store, options);
    if (was_interrupted(result)) return result.exit_code;
    const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();

    const experiment::RunKey key = plan.manifest.runs().front();
    std::vector<Finding> findings;
    if (const auto record = store.read(key)) {
        findings = findings_of(*record, store.read_timing(key).value_or(results::RunTiming{}), wall_s);
        const auto place = std::ranges::find(findings, "emergency", &Finding::name);
        findings.insert(place + 1, routes_finding(store.scenario_folder(brief.name) / "demand" / "0"));
        std::filesystem::remove_all(options.folder);
    } else {
        findings = {error_finding(store.read_error(key).value_or(results::RunError{}), options.folder)};
    }
    print(findings, arguments.printing);
    return exit_code_of(findings);
}

}  // namespace

Action configure_check(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("scenario", arguments->scenario, "Name (clearway list), folder or TOML file")
        ->required()
        ->option_text("SCENARIO (required)");
    add_seed_option(app, arguments->seed);
    add_limit_options(app, arguments->limits);
    add_json_option(app, arguments->printing, "the findings");
    add_scenario_options(app, arguments->options);
    return [arguments](const Invocation& invocation) { return check(*arguments, invocation); };
}

}  // namespace clearway::cli
