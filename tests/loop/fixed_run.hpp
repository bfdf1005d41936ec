#pragma once

#include <string>
#include <vector>

#include "loop/study_folder.hpp"
#include "loop/unit_run.hpp"

namespace clearway::test {

/// A short run in this process and without a fork, whose middle is measured.
struct FixedRun {
    const char* name;
    const char* scenario;
    const char* variant;
    double lasts_s;  ///< Long enough for 0.2 to 0.5 G instructions.
    const char* failure;
    const char* predictor;
    std::vector<std::string> policies;
    core::Settings settings;
};

inline const std::vector<FixedRun>& fixed_runs() {
    static const std::vector<FixedRun> runs = {
        {"intersection_baseline", "intersection", "dense", 40.0, "perfect", "none", {}, {}},
        {"city_baseline", "city", "dense", 10.0, "perfect", "none", {}, {}},
        {"city_corridor", "city", "dense", 10.0, "perfect", "none", {"corridor"}, {}},
        {"city_corridor_repaired", "city", "dense", 10.0, "B10", "graphsage", {"corridor"}, {}},
        {"arterial_linked",
         "arterial",
         "standard",
         20.0,
         "B10",
         "graphsage",
         {"vacate_lane", "pull_aside"},
         {{"loop.link_radius_m", "150"}, {"vacate_lane.ask", "linked"}, {"pull_aside.ask", "linked"}}}};
    return runs;
}

/// Calls `measure(loop, end)` 60 s after the first emergency vehicle departs: by then it drives, and policies
/// act. It runs the loop to `end`.
template <class Measure>
void in_the_middle_of(const FixedRun& fixed, Measure&& measure) {
    constexpr double lead_s = 60.0;
    experiment::ConditionSpec condition;
    condition.name = fixed.name;
    condition.failure = fixed.failure;
    condition.predictor = fixed.predictor;
    condition.policies = fixed.policies;
    condition.settings = fixed.settings;
    scenario::Options options;
    options.set("variant", fixed.variant);
    const StudyFolder folder(fixed.scenario, options, {condition});

    loop::UnitRun run(folder.unit(0), folder.path() / "demand", folder.path() / "work");
    loop::ClosedLoop& loop = run.start(condition);
    const core::Seconds from = run.first_emergency() + core::Seconds(lead_s);
    loop.run(from);
    measure(loop, from + core::Seconds(fixed.lasts_s));
}

}  // namespace clearway::test
