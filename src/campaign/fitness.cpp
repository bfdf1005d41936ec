#include "campaign/fitness.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <string>

#include <fmt/format.h>

#include "campaign/detail/abort_cure.hpp"
#include "campaign/detail/emergency_trips.hpp"
#include "campaign/detail/lock_findings.hpp"
#include "campaign/detail/run_cost.hpp"
#include "campaign/detail/site_findings.hpp"
#include "campaign/detail/way_findings.hpp"
#include "campaign/printout.hpp"
#include "core/counted.hpp"
#include "core/files.hpp"
#include "core/supervisor.hpp"
#include "core/temporary_folder.hpp"
#include "core/terminal.hpp"
#include "experiment/conditions.hpp"
#include "report/safety.hpp"
#include "scenario/map_age.hpp"
#include "scenario/network.hpp"
#include "scenario/outlook.hpp"
#include "scenario/overrides.hpp"
#include "scenario/prepare.hpp"

namespace clearway::campaign {
namespace {

double share(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

Finding insertion_finding(const metrics::RunMetrics& run, const std::string& less) {
    constexpr double most_left_outside = 0.1;  // Above it, queues reach the boundary.
    const bool is_short = share(run.not_inserted, run.vehicle_count) > most_left_outside;
    return {"inserts", is_short ? Grade::falls_short : Grade::ok,
            fmt::format("{} of {} entered, {:.1f} s late on average",
                        core::grouped(run.vehicle_count - run.not_inserted),
                        core::counted(run.vehicle_count, "vehicle"), run.depart_delay_s.value_or(0.0)),
            is_short ? less : ""};
}

/// `all ambulances, others by --emergency-kinds`, or `7 ambulance, 3 fire_engine`.
std::string kinds_words(const results::RunRecord& record, bool are_drawn) {
    std::map<traffic::VehicleKind, std::size_t> counts;
    for (const metrics::VehicleRow& row : record.vehicles)
        if (row.vehicle_class == traffic::VehicleClass::emergency) ++counts[row.kind];
    if (are_drawn && counts.size() == 1 && counts.contains(traffic::VehicleKind::ambulance))
        return "all ambulances; --emergency-kinds ambulance=1,fire_engine=1 asks for others too";
    std::vector<std::string> words;
    for (const auto& [kind, count] : counts)
        words.push_back(fmt::format("{} {}", count, name(kind)));
    return fmt::format("{}", fmt::join(words, ", "));
}

/// `emergency.2 in replication 8`.
std::string trip_name(const std::string& id, std::uint32_t replication) {
    return fmt::format("{} in replication {}", id, replication);
}

/// `queueing`: the trips that detail::queueing_trips names.
Finding emergency_finding(const results::RunRecord& record, const Checked& checked, const std::string& less,
                          const std::map<std::string, std::string>& queueing) {
    std::size_t entered = 0, arrived = 0, queued = 0;
    for (const metrics::VehicleRow& row : record.vehicles) {
        if (row.vehicle_class != traffic::VehicleClass::emergency) continue;
        if (row.outcome == metrics::VehicleOutcome::not_inserted) continue;
        ++entered;
        if (row.outcome == metrics::VehicleOutcome::arrived)
            ++arrived;
        else if (queueing.contains(trip_name(row.id, 0)))
            ++queued;
    }
    const std::uint64_t count = record.metrics.emergency_count;
    Finding finding{
        "emergency", Grade::ok,
        fmt::format("{} with a route, {} entered, {} arrived", core::counted(count, "EV"), entered, arrived)};
    if (count == 0)
        finding.advice = "set demand.emergency in scenario.toml";
    else
        finding.text += "; " + kinds_words(record, checked.config.emergency_trips.empty());
    if (queued > 0) finding.text += fmt::format("; {} called to a closed road did not arrive", queued);
    if (queued > 0 && arrived + queued == count)
        finding.advice = detail::queueing_cure;
    else if (arrived < count)
        finding.advice = less + ", or a longer --horizon, if EVs cannot enter or do not arrive";
    if (!finding.advice.empty()) finding.grade = Grade::falls_short;
    return finding;
}

/// Number of routes that `prepare` wrote, and of those with a single edge.
struct RouteCount {
    std::size_t all = 0;
    std::size_t single = 0;

    void add(bool has_single_edge) {
        ++all;
        single += has_single_edge ? 1 : 0;
    }
    bool mostly_single() const { return 2 * single > all; }
};

/// A vehicle with a single edge passes no junction, so it meets no signal and no crossing traffic.
Finding routes_finding(const scenario::PlannedRoutes& planned,
                       const std::vector<detail::EmergencyTrip>& trips) {
    const RouteCount traffic{planned.vehicles, planned.single};
    RouteCount emergency, called;
    for (const detail::EmergencyTrip& trip : trips) {
        emergency.add(trip.edges.size() == 1);
        if (trip.id.starts_with(scenario::called_prefix)) called.add(trip.edges.size() == 1);
    }
    const bool is_short = traffic.mostly_single() || emergency.mostly_single();
    const bool are_called = !traffic.mostly_single() && called.single == emergency.single;
    return {"routes", is_short ? Grade::falls_short : Grade::ok,
            fmt::format("on a single edge, through no junction: {} of {}, {} of {}", traffic.single,
                        core::counted(traffic.all, "vehicle"), emergency.single,
                        core::counted(emergency.all, "EV")),
            !is_short    ? ""
            : are_called ? "another edge for the call: its station lies on the same"
                         : "a larger part of the map, or longer trips: trips.minimum_length_m, and "
                           "trips.emergency_minimum_length_m for EVs"};
}

Finding jams_finding(const metrics::RunMetrics& run, const RoadUse& use, const Checked& checked) {
    constexpr const char* words[] = {"fits", "too empty", "too full", "gridlock"};
    const bool is_full = use.state == TrafficState::too_full || use.state == TrafficState::gridlock;
    const bool is_blocked = !checked.config.incidents.empty();
    const bool is_called =
        std::ranges::any_of(checked.config.calls, [](const auto& call) { return call.incident.has_value(); });
    return {
        "jams",
        is_full && !is_blocked                 ? Grade::falls_short
        : is_full                              ? Grade::note
        : use.state == TrafficState::too_empty ? Grade::note
                                               : Grade::ok,
        fmt::format("{}: {}, {} still on the road at {:.0f} s, {:.1f} s mean time loss, {:.1f} "
                    "vehicles per km of lane",
                    words[static_cast<std::size_t>(use.state)], core::counted(run.teleports, "teleport"),
                    run.unfinished, run.simulated_s, run.others_time_loss_s.value_or(0.0), use.per_lane_km),
        use.state == TrafficState::fits ? ""
        : is_full && is_blocked
            ? "the incidents make queues: check it without them, " +
                  std::string(is_called ? "and without the calls to them" : "--incident none")
            : density_advice(checked.config, use.factor)};
}

constexpr const char* signals_name = "signals";

/// `outlook`: scenario::outlook_json.
Finding signals_finding(const core::Json& outlook) {
    const auto count = outlook.at("signals").get<std::size_t>();
    if (count == 0)
        return {
            signals_name, Grade::note,
            "0 in the network: signal policies have no effect here; only policies that make vehicles give "
            "way can help",
            "", outlook};
    const auto passing = outlook.at("trips_passing").get<std::size_t>();
    const bool is_little = outlook.at("prospect") == core::name(scenario::Prospect::little);
    return {signals_name, is_little ? Grade::note : Grade::ok,
            fmt::format("{} in the network; {} of {} {} one", count, passing,
                        core::counted(outlook.at("trips").get<std::size_t>(), "EV"),
                        passing == 1 ? "passes" : "pass"),
            is_little ? "studies/parts.toml with --scenario: corridor also clears lanes and holds crossing "
                        "traffic back where there is no signal, and the study says what each part brings"
                      : "",
            outlook};
}

double lane_km(const roads::Network& network) {
    double sum_m = 0.0;
    for (const roads::Edge& edge : network.edges())
        if (!edge.internal)
            for (const roads::Lane& lane : network.lanes().subspan(edge.first_lane, edge.lane_count))
                if (lane.allows_cars) sum_m += lane.length_m;
    return sum_m / 1000.0;
}

Printout printout_of(const std::string& scenario, const std::vector<Finding>& findings) {
    Table table{
        "",
        {{"grade", "grade"}, {"finding", "finding"}, {"text", "text"}, {"advice", ""}, {"numbers", ""}},
        {}};
    for (const Finding& finding : findings) {
        Row row{{word_of(finding.grade), finding.name, finding.text, finding.advice, finding.numbers}};
        if (!finding.advice.empty()) row.below.push_back("try: " + finding.advice);
        table.rows.push_back(std::move(row));
    }
    std::string text = "\n";
    for (const Finding& finding : findings)
        if (finding.numbers.contains("sentence"))
            text += core::wrapped(finding.numbers.at("sentence").get<std::string>(), 0) + "\n";
    text += core::wrapped(conclusion_of(scenario, findings), 0) + "\n";
    return {.tables = {table}, .text = text};
}

/// Removes the run folder, and the folder of run folders where nothing else is in it.
void remove_runs(const std::filesystem::path& folder) {
    std::error_code not_empty;
    std::filesystem::remove_all(folder);
    std::filesystem::remove(folder.parent_path(), not_empty);
}

core::ExitCode verdict_on(const std::vector<Finding>& findings) {
    const auto has = [&](Grade grade) {
        return std::ranges::any_of(findings, [&](const Finding& each) { return each.grade == grade; });
    };
    if (has(Grade::failed)) return core::ExitCode::runs_failed;
    return has(Grade::falls_short) ? core::ExitCode::fell_short : core::ExitCode::ok;
}

}  // namespace

std::string conclusion_of(const std::string& scenario, const std::vector<Finding>& findings) {
    std::vector<std::string> failed;
    std::vector<std::string> short_of;
    std::vector<std::string> noted;
    bool has_trials = false;
    for (const Finding& finding : findings) {
        if (finding.grade == Grade::failed) failed.push_back(finding.name);
        if (finding.grade == Grade::falls_short) short_of.push_back(finding.name);
        if (finding.grade == Grade::note) noted.push_back(finding.name);
        has_trials = has_trials || finding.name == detail::trials_name;
    }
    if (!failed.empty()) return fmt::format("{} cannot be run: {}.", scenario, core::listed(failed));
    const bool is_of_signals = !core::contains(noted, signals_name);
    const std::string fit =
        scenario +
        (is_of_signals ? " is fit for a study" : " is fit for a study, though signals have little to gain");
    if (short_of.empty() && noted.empty()) return fit + ".";
    if (!short_of.empty())
        return fmt::format("{} is not fit for a study as it is: {}.", scenario, core::listed(short_of));
    if (!has_trials && core::contains(noted, detail::locks_name))
        return fmt::format(
            "{} as far as its one run tells, which locks; others may lock more: --lock-trials 6 tells. "
            "Noted: {}.",
            fit, core::listed(noted));
    return fmt::format("{}, with what is noted: {}.", fit, core::listed(noted));
}

const char* word_of(Grade grade) {
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

RoadUse road_use(const metrics::RunMetrics& run, const scenario::Times& time, double lane_km) {
    constexpr double few = 0.01;
    constexpr double many = 0.1;
    constexpr double least_per_km = 0.5;
    constexpr double usual_per_km = 2.0;
    constexpr double largest_factor = 10.0;
    constexpr double margin = 0.8;
    const double teleported = share(run.teleports, run.vehicle_count);
    const double unfinished = share(run.unfinished, run.vehicle_count);
    const double outside = share(run.not_inserted, run.vehicle_count);
    RoadUse use;
    if (lane_km > 0.0)
        use.per_lane_km =
            static_cast<double>(run.vehicle_steps) * time.step_length_s / time.window_s / lane_km;
    if (unfinished > many || (unfinished > few && teleported > few))
        return {TrafficState::gridlock, use.per_lane_km, 0.5};
    if (const double excess = std::max({teleported, unfinished, outside > many ? outside : 0.0});
        excess > few)
        return {TrafficState::too_full, use.per_lane_km, margin * std::max(0.5, 1.0 - excess)};
    if (use.per_lane_km < least_per_km)
        return {TrafficState::too_empty, use.per_lane_km,
                std::min(largest_factor, usual_per_km / std::max(use.per_lane_km, few))};
    return use;
}

std::string density_advice(const scenario::ScenarioConfig& config, double factor) {
    const double density = config.demand.density;
    if (config.measured && density * factor > 1.0) return "measured demand cannot be made denser";
    const auto text = [&](double number) { return fmt::format("{:.{}f}", number, number < 1.0 ? 2 : 1); };
    return fmt::format("--density {}{} (to keep it: density = {} in [demand] of scenario.toml)",
                       text(config.density_factor * factor),
                       density == config.density_factor ? "" : ", which multiplies the scenario's own",
                       text(density * factor));
}

/// Finest step that a scenario may have.
constexpr double finest_step_s = 0.1;

Finding collisions_finding(const metrics::RunMetrics& run, double step_length_s, const std::string& less) {
    const std::string count =
        fmt::format("{} with {} in the baseline, {} of them at junctions", run.collisions,
                    core::counted(run.vehicle_count, "vehicle"), run.junction_collisions);
    if (run.collisions == 0) return {"collisions", Grade::ok, count};
    if (report::collide_by_model(run.collisions, run.vehicle_count))
        return {"collisions", Grade::note, count,
                "many: this scenario says nothing about safety. Less traffic makes fewer, step by step; no "
                "level is "
                "known to be enough: " +
                    less};
    const std::string compare = "compare conditions, not counts";
    return {"collisions", Grade::note, count,
            step_length_s > finest_step_s
                ? fmt::format("{}; a step of {:g} s makes some: --step-length {:g} shows how many stay",
                              compare, step_length_s, finest_step_s)
                : compare};
}

/// Seeds whose EV trips are held against incidents; only the first of them is run.
constexpr std::uint32_t planned_seeds = 10;

/// The EV trips of `planned_seeds`, each with its replication; none where there is no incident.
std::vector<detail::EmergencyTrip> planned_trips(const scenario::ScenarioConfig& scenario,
                                                 const scenario::BuiltNetwork& built, std::uint64_t seed) {
    std::vector<detail::EmergencyTrip> trips;
    if (scenario.incidents.empty()) return trips;
    for (std::uint32_t replication = 0; replication < planned_seeds; ++replication) {
        const core::TemporaryFolder folder;
        const scenario::Prepared prepared = scenario::prepare(scenario, built, core::StudySeed{seed},
                                                              core::Replication{replication}, folder.path());
        const double delay_s =
            prepared.incidents.front().closed.from.value - scenario.incidents.front().from_s;
        for (const traffic::EmergencyDeparture& departure : prepared.emergency)
            trips.push_back(
                {trip_name(departure.id, replication), departure.edges, departure.depart.value - delay_s});
    }
    return trips;
}

std::vector<Finding> findings_of(const results::RunRecord& record, const Checked& checked,
                                 const std::vector<detail::EmergencyTrip>& of_seeds) {
    const metrics::RunMetrics& run = record.metrics;
    const RoadUse use = road_use(run, checked.config.time, lane_km(checked.network));
    const std::string density = scenario::density_words(checked.config);
    const std::string less = density_advice(checked.config, use.factor < 1.0 ? use.factor : 0.8);
    const auto trips = detail::emergency_trips_in(core::read_file(checked.demand / "emergency.csv"));
    const auto queueing = detail::queueing_trips(checked.config, checked.network, of_seeds);
    std::vector<Finding> findings = {
        {"loads", Grade::ok,
         "SUMO loads the network and the demand" + (density.empty() ? "" : "; " + density)},
        insertion_finding(run, less),
        emergency_finding(record, checked, less, queueing),
        detail::sites_finding(checked.config),
        routes_finding(scenario::planned_routes(checked.demand / "traffic.rou.xml", checked.network), trips),
        jams_finding(run, use, checked),
        detail::locks_finding(record, record.traffic.locks, checked, less),
        signals_finding(checked.outlook)};
    if (const std::string& date = checked.config.network.map_date; !date.empty())
        findings.push_back(detail::map_finding(date, scenario::today()));
    std::ranges::move(detail::way_findings(checked.config, checked.network, trips, of_seeds),
                      std::back_inserter(findings));
    findings.push_back(collisions_finding(run, checked.config.time.step_length_s, less));
    return findings;
}

Finding error_finding(const results::RunError& error, const std::filesystem::path& folder) {
    const bool aborted = error.cause == results::ErrorCause::signal;
    std::string text = error.message;
    if (!error.log_tail.empty()) text += "\n" + error.log_tail;
    text += fmt::format("\nInputs and logs are kept in {}; the command that repeats the run:\n  {}",
                        folder.string(), error.command);
    if (const std::string cure = cure_of_abort(error); !cure.empty()) text += "\n" + cure;
    return {aborted ? "aborts" : "loads", Grade::failed, text};
}

namespace {

/// Makes the runs of detail::LockTrials in a folder of their own, which it removes.
detail::LockTrials try_locks(const scenario::ScenarioConfig& scenario, std::uint64_t seed,
                             std::uint32_t count, RunOptions options) {
    scenario::ScenarioConfig with = scenario;
    scenario::ScenarioConfig without = scenario;
    std::optional<double>& after_s = with.time.ignore_junction_blocker_s;
    if (after_s.value_or(-1.0) < 0.0) after_s = scenario::usual_ignore_junction_blocker_s;
    without.time.ignore_junction_blocker_s.reset();
    without.name += "-off";
    const bool ignores = scenario.time.ignore_junction_blocker_s.value_or(-1.0) >= 0.0;
    detail::LockTrials trials{
        .trials = count, .ignored_after_s = *after_s, .ignores = ignores, .with = {}, .without = {}};
    study::StudyConfig config =
        study_of(with, {experiment::built_in_condition("baseline", "check")}, seed, count);
    config.scenarios.push_back(without);
    options.folder += "-locks";
    options.workers = 0;
    std::filesystem::remove_all(options.folder);
    const study::Plan plan = plan_for(config, options);
    const results::Store store = prepare_run_folder(plan, options);
    const StudyResult result = run_missing(plan, store, options);
    if (result.exit_code != core::ExitCode::ok)
        throw core::Error(result.exit_code,
                          fmt::format("not every trial run ended well; see {}", options.folder.string()));
    for (const experiment::RunKey& key : plan.manifest.runs()) {
        const auto record = store.read(key, results::VehicleRows::emergency);
        if (record)
            detail::count_trial(record->metrics, count,
                                key.scenario == with.name ? trials.with : trials.without);
    }
    remove_runs(options.folder);
    return trials;
}

}  // namespace

core::ExitCode check_scenario(const scenario::ScenarioConfig& scenario, std::uint64_t seed,
                              std::uint32_t lock_trials, RunOptions options) {
    const study::StudyConfig config =
        study_of(scenario, {experiment::built_in_condition("baseline", "check")}, seed, 1);
    options.folder = std::filesystem::path("runs") / ("check-" + scenario.name);
    options.workers = 1;
    options.stays_if_failed = true;
    std::filesystem::remove_all(options.folder);
    const study::Plan plan = plan_for(config, options);
    const results::Store store = prepare_run_folder(plan, options);
    const auto started = std::chrono::steady_clock::now();
    const StudyResult result = run_missing(plan, store, options);
    if (is_interrupted(result.exit_code)) return result.exit_code;
    const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();

    const experiment::RunKey key = plan.manifest.runs().front();
    std::vector<Finding> findings;
    if (auto record = store.read(key)) {
        record->traffic = store.read_traffic(key);
        const std::filesystem::path& roads = plan.units.front().unit.network_folder;
        const scenario::BuiltNetwork built = scenario::open_network(scenario, roads);
        const std::vector<detail::EmergencyTrip> of_seeds = planned_trips(scenario, built, seed);
        const std::filesystem::path home = store.scenario_folder(scenario.name);
        findings = findings_of(*record,
                               {scenario, built.network, home / "demand" / "0",
                                core::parse_object(core::read_file(home / "outlook.json"), "outlook.json")},
                               of_seeds);
        if (!scenario.incidents.empty())
            findings.push_back(detail::passing_finding(scenario, built.network, of_seeds, planned_seeds));
        findings.push_back({"speed", Grade::ok,
                            fmt::format("{:.1f} s a run, {:.1f} times real time, including loading", wall_s,
                                        record->metrics.simulated_s / wall_s)});
        const results::RunTiming timing = store.read_timing(key).value_or(results::RunTiming{});
        findings.push_back({"memory", Grade::ok, fmt::format("{} MiB", timing.peak_kib / 1024)});
        const std::string& hash = plan.manifest.scenarios.front().configuration_hash;
        note_cost(options.folder.parent_path(), scenario, hash,
                  CostBook(options.folder).of(scenario, hash, experiment::TrafficModel::standard));
        remove_runs(options.folder);
        if (lock_trials > 0) {
            const std::size_t trials = 2 * std::size_t{lock_trials};
            const double rounds = static_cast<double>(trials) / static_cast<double>(core::process_count(0));
            fmt::print(stderr, "clearway: {} more to look for locks, about {}\n",
                       core::counted(trials, "run"), clock_words(std::ceil(rounds) * wall_s));
            try {
                findings.push_back(detail::trials_finding(try_locks(scenario, seed, lock_trials, options)));
            } catch (const core::Error&) {
                print(printout_of(scenario.name, findings), options.publish.printing);
                throw;
            }
        }
    } else {
        findings = {error_finding(store.read_error(key).value_or(results::RunError{}), options.folder)};
    }
    print(printout_of(scenario.name, findings), options.publish.printing);
    return verdict_on(findings);
}

}  // namespace clearway::campaign
