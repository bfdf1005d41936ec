// Part of one of five fixed runs, in this process and without a fork: `loop_fixed_runs NAME`.
// benchmarks/loop_cost.py counts its instructions under valgrind, and takes its times without. Prints
// `simulator_s coupling_s vehicle_steps` of the part that is measured.

#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#endif

#include "loop/study_folder.hpp"
#include "loop/unit_run.hpp"

namespace {

using namespace clearway;

/// Measured from 60 s after the first emergency vehicle departs: by then it drives, and policies act.
constexpr double lead_s = 60.0;

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

const std::vector<FixedRun>& fixed_runs() {
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

void measure(const FixedRun& fixed) {
    experiment::ConditionSpec condition;
    condition.name = fixed.name;
    condition.failure = fixed.failure;
    condition.predictor = fixed.predictor;
    condition.policies = fixed.policies;
    condition.settings = fixed.settings;
    scenario::Options options;
    options.set("variant", fixed.variant);
    const test::StudyFolder folder(fixed.scenario, options, {condition});

    loop::UnitRun run(folder.unit(0), folder.path() / "demand", folder.path() / "work");
    loop::ClosedLoop& loop = run.start(condition);
    const double from_s = run.first_emergency().value + lead_s;
    loop.run(core::Seconds(from_s));
    const loop::LoopTiming before = loop.timing();
    CALLGRIND_START_INSTRUMENTATION;
    loop.run(core::Seconds(from_s + fixed.lasts_s));
    CALLGRIND_STOP_INSTRUMENTATION;
    const loop::LoopTiming& after = loop.timing();
    std::printf("%.6f %.6f %llu\n", after.simulator_s - before.simulator_s,
                after.coupling_s - before.coupling_s,
                static_cast<unsigned long long>(after.vehicle_steps - before.vehicle_steps));
}

}  // namespace

int main(int count, char** words) {
    try {
        for (const FixedRun& run : fixed_runs()) {
            if (count == 2 && std::string_view(words[1]) == run.name) {
                measure(run);
                return 0;
            }
        }
        std::fprintf(stderr, "give one of these names:");
        for (const FixedRun& run : fixed_runs())
            std::fprintf(stderr, " %s", run.name);
        std::fprintf(stderr, "\n");
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "loop_fixed_runs: %s\n", error.what());
        return 1;
    }
}
