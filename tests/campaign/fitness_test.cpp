// What verbs say: what `clearway scenario check` thinks of a baseline run, cures, pages that were written.
#include "campaign/fitness.hpp"

#include <csignal>

#include <gmock/gmock.h>

#include "campaign/detail/abort_cure.hpp"
#include "campaign/detail/lock_findings.hpp"
#include "campaign/detail/site_findings.hpp"
#include "campaign/replay_page.hpp"

namespace clearway::campaign {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// 400 vehicles, each 100 s on 10 km of lane, over 200 s: 20 on each km.
metrics::RunMetrics busy_run() {
    metrics::RunMetrics run;
    run.vehicle_count = 400;
    run.vehicle_steps = 400 * 400;
    run.simulated_s = 400.0;
    return run;
}

RoadUse use_of(const metrics::RunMetrics& run) {
    scenario::Times time;
    time.window_s = 200.0;
    time.step_length_s = 0.25;
    return road_use(run, time, 10.0);
}

TEST(RoadUse, counts_the_vehicles_on_a_kilometre_of_lane) {
    const RoadUse use = use_of(busy_run());
    EXPECT_DOUBLE_EQ(use.per_lane_km, 20.0);
    EXPECT_EQ(use.state, TrafficState::fits);
    EXPECT_EQ(use.factor, 1.0);
}

TEST(RoadUse, tells_empty_full_and_gridlocked_roads_apart) {
    metrics::RunMetrics run = busy_run();
    run.vehicle_steps = 1600;  // 0.2 on a kilometre
    EXPECT_EQ(use_of(run).state, TrafficState::too_empty);
    EXPECT_NEAR(use_of(run).factor, 10.0, 1e-9);
    run = busy_run();
    run.teleports = 8;
    EXPECT_EQ(use_of(run).state, TrafficState::too_full);
    EXPECT_NEAR(use_of(run).factor, 0.8 * 0.98, 1e-9);
    run.unfinished = 3;
    EXPECT_EQ(use_of(run).state, TrafficState::too_full);
    run.unfinished = 5;
    EXPECT_EQ(use_of(run).state, TrafficState::gridlock);
    EXPECT_EQ(use_of(run).factor, 0.5);
    run.teleports = 0;
    EXPECT_EQ(use_of(run).state, TrafficState::too_full);
    run.unfinished = 41;
    EXPECT_EQ(use_of(run).state, TrafficState::gridlock);
}

TEST(RoadUse, where_vehicles_do_not_get_in_is_too_full) {
    metrics::RunMetrics run = busy_run();
    run.not_inserted = 40;
    EXPECT_EQ(use_of(run).state, TrafficState::fits);
    run.not_inserted = 80;
    EXPECT_EQ(use_of(run).state, TrafficState::too_full);
    EXPECT_NEAR(use_of(run).factor, 0.8 * 0.8, 1e-9);
}

TEST(LockFinding, weighs_what_stands_in_locks_and_not_how_many_runs_lock) {
    detail::LockTrials trials{.trials = 6,
                              .ignored_after_s = 10.0,
                              .ignores = true,
                              .with = {.locked = 5, .held_up = 0, .stood_s = 0.15, .collisions = 43.0},
                              .without = {.locked = 3, .held_up = 2, .stood_s = 8.8, .collisions = 11.0}};
    EXPECT_EQ(
        detail::trials_finding(trials).text,
        "with time.ignore_junction_blocker_s = 10, as here, 5 of 6 runs lock, none held up by it; 0.15 s "
        "in locks a vehicle; 43 collisions a run. Without, 3 of 6 runs lock, 2 held up by it; 8.8 s in "
        "locks a vehicle; 11 collisions a run");
    EXPECT_EQ(detail::trials_finding(trials).grade, Grade::note);
    EXPECT_EQ(
        detail::trials_finding(trials).advice,
        "these locks hold no run up; less traffic makes fewer: 0.8 times the present --density, or less")
        << "what the scenario has is the better choice, and most runs lock all the same";
    trials.with.locked = 3;
    EXPECT_EQ(detail::trials_finding(trials).advice, "");

    trials.ignores = false;
    EXPECT_EQ(detail::trials_finding(trials).grade, Grade::falls_short);
    EXPECT_THAT(detail::trials_finding(trials).advice,
                AllOf(StartsWith("time.ignore_junction_blocker_s = 10 in scenario.toml; "),
                      HasSubstr("less traffic")));

    trials.ignores = true;
    trials.with.stood_s = 9.0;
    EXPECT_EQ(detail::trials_finding(trials).advice,
              "take time.ignore_junction_blocker_s = 10 out of scenario.toml");
}

TEST(LockFinding, is_ok_where_no_run_locks) {
    const Finding finding = detail::trials_finding(
        {.trials = 6, .ignored_after_s = 10.0, .ignores = false, .with = {}, .without = {}});
    EXPECT_EQ(
        finding.text,
        "without time.ignore_junction_blocker_s = 10, as here, none of 6 runs locks; 0 collisions a run. "
        "With it, none of 6 runs locks; 0 collisions a run");
    EXPECT_EQ(finding.grade, Grade::ok);
}

TEST(LockFinding, counts_a_run_that_holds_up_an_emergency_vehicle_or_many_others) {
    metrics::RunMetrics run = busy_run();
    detail::LockTrial trial;
    detail::count_trial(run, 2, trial);
    EXPECT_EQ(trial.locked, 0U);
    run.locks = 1;
    run.locked_vehicles = 1;
    run.locked_vehicle_s = 100.0 * static_cast<double>(run.vehicle_count);
    detail::count_trial(run, 2, trial);
    EXPECT_EQ(trial.locked, 1U);
    EXPECT_EQ(trial.held_up, 0U);
    EXPECT_DOUBLE_EQ(trial.stood_s, 50.0);
    run.locked_emergency_vehicles = 1;
    detail::count_trial(run, 2, trial);
    EXPECT_EQ(trial.held_up, 1U);
}

TEST(Conclusion, knows_nothing_of_a_scenario_whose_one_run_locks) {
    std::vector<Finding> findings = {{detail::locks_name, Grade::note, "1 lock in this run"},
                                     {"collisions", Grade::note, "2"}};
    EXPECT_EQ(conclusion_of("town", findings),
              "town is fit for a study as far as its one run tells, which locks; others may lock more: "
              "--lock-trials 6 tells. Noted: locks, collisions.");
    findings.push_back({detail::trials_name, Grade::ok, "none of 6 runs locks"});
    EXPECT_EQ(conclusion_of("town", findings),
              "town is fit for a study, with what is noted: locks, collisions.");
    findings.back() = {detail::trials_name, Grade::note, "5 of 6 runs lock", "less traffic first"};
    EXPECT_EQ(conclusion_of("town", findings),
              "town is fit for a study, with what is noted: locks, collisions, trials.")
        << "a note makes no scenario unfit";
    findings.push_back({"signals", Grade::note, "4 in the network; 1 of 6 EVs passes one"});
    EXPECT_EQ(conclusion_of("town", findings),
              "town is fit for a study, though signals have little to gain, with what is noted: locks, "
              "collisions, trials, signals.");
    findings.pop_back();
    findings.back().grade = Grade::falls_short;
    EXPECT_EQ(conclusion_of("town", findings), "town is not fit for a study as it is: trials.");
}

TEST(DensityAdvice, says_that_the_option_multiplies_what_the_scenario_has) {
    scenario::ScenarioConfig config;
    EXPECT_EQ(density_advice(config, 0.8),
              "--density 0.80 (to keep it: density = 0.80 in [demand] of scenario.toml)");
    config.demand.density = 0.8;
    EXPECT_EQ(
        density_advice(config, 0.8),
        "--density 0.80, which multiplies the scenario's own (to keep it: density = 0.64 in [demand] of "
        "scenario.toml)");
    config.density_factor = 0.5;
    config.demand.density = 0.4;
    EXPECT_THAT(density_advice(config, 0.8),
                AllOf(StartsWith("--density 0.40, "), HasSubstr("density = 0.32")));
}

TEST(CollisionsFinding, tells_many_from_few) {
    metrics::RunMetrics run = busy_run();
    run.collisions = 4;
    EXPECT_THAT(collisions_finding(run, 0.25, "--density 0.80").advice, HasSubstr("compare conditions"));
    run.collisions = 5;
    EXPECT_THAT(collisions_finding(run, 0.25, "--density 0.80").advice,
                HasSubstr("no level is known to be enough: --density 0.80"));
}

TEST(SitesFinding, says_what_stands_in_for_a_kind_that_is_missing) {
    scenario::ScenarioConfig config;
    EXPECT_THAT(detail::sites_finding(config).text, HasSubstr("random places"));
    config.emergency_sites.resize(2);
    config.demand.emergency = 6;
    EXPECT_EQ(
        detail::sites_finding(config).text,
        "2 hospitals; EVs drive half from hospitals (no ambulance station is known) to random places and "
        "half from random places to hospitals, on routes of at least 1000 m");
    config.emergency_kinds = {.ambulance = 0.0, .fire_engine = 1.0};
    EXPECT_THAT(
        detail::sites_finding(config).text,
        HasSubstr("2 hospitals; fire engines drive from hospitals (no fire station is known) to random "
                  "places, on"));
    EXPECT_EQ(detail::sites_finding(config).grade, Grade::note);
    config.emergency_sites.emplace_back().kind = scenario::SiteKind::ambulance_station;
    config.emergency_kinds.police_car = 1.0;
    EXPECT_THAT(
        detail::sites_finding(config).text,
        HasSubstr("2 hospitals, 1 ambulance station; EVs other than fire engines drive half from ambulance "
                  "stations to random places and half from random places to hospitals, fire engines from "
                  "ambulance stations (no fire station is known) to random places"));
    config.emergency_sites.emplace_back().kind = scenario::SiteKind::fire_station;
    EXPECT_THAT(detail::sites_finding(config).text, HasSubstr("half from ambulance and fire stations to"));
    EXPECT_EQ(detail::sites_finding(config).grade, Grade::ok);
    config.emergency_trips.resize(1);
    EXPECT_THAT(detail::sites_finding(config).text, HasSubstr("stand in the scenario"));
}

TEST(MapFinding, notes_data_that_is_old_on_a_day) {
    using std::chrono::sys_days;
    using namespace std::chrono_literals;
    const std::string date = "2012-05-03 (newest object)";
    const Finding recent = detail::map_finding(date, sys_days(2017y / 5 / 1));
    EXPECT_EQ(recent.grade, Grade::ok);
    EXPECT_EQ(recent.text, "data of 2012-05-03 (newest object)");
    const Finding old = detail::map_finding(date, sys_days(2026y / 5 / 4));
    EXPECT_EQ(old.grade, Grade::note);
    EXPECT_THAT(old.text, HasSubstr("data of 2012-05-03 (newest object), 14 years old, in which roads"));
    EXPECT_THAT(detail::map_finding(date, sys_days(2026y / 5 / 2)).text, HasSubstr("13 years"));
}

TEST(AbortCure, goes_by_the_assertion) {
    results::RunError error;
    error.cause = results::ErrorCause::signal;
    error.log_tail = "MSLane.cpp:4258: MSLane* MSLane::getBidiLane() const: Assertion failed";
    EXPECT_THAT(cure_of_abort(error), HasSubstr("largest_car_component"));
    error.log_tail = "Assertion `myVehicles.size() > 0' failed";
    EXPECT_THAT(cure_of_abort(error), HasSubstr("--time-to-teleport -1"));
    for (const char* ours : {"/usr/include/c++/12/bits/stl_algo.h:3623: clamp: Assertion failed",
                             "queue.cpp:9: void clearway::policy::act(): Assertion `is_open' failed"}) {
        error.log_tail = ours;
        EXPECT_THAT(cure_of_abort(error), HasSubstr("of Clearway")) << ours;
    }
    error.signal = SIGKILL;
    EXPECT_EQ(cure_of_abort(error), "") << "somebody else ended it";
    error.signal = SIGABRT;
    error.cause = results::ErrorCause::simulator;
    EXPECT_EQ(cure_of_abort(error), "");
}

TEST(ReplayPage, says_how_large_it_is_and_how_a_large_one_gets_smaller) {
    EXPECT_EQ(written_words("a.html", 450'000), "written: a.html, 0.5 MB; open it in a browser");
    EXPECT_THAT(written_words("a.html", 18'200'000),
                testing::AllOf(HasSubstr("a.html, 18.2 MB"), HasSubstr("--from SECONDS --to SECONDS")));
}

}  // namespace
}  // namespace clearway::campaign
