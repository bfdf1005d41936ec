// Part of one of five fixed runs, in this process and without a fork: `loop_fixed_runs NAME`.
// benchmarks/loop_cost.py counts its instructions under valgrind, and takes its times without. Prints
// `simulator_s coupling_s vehicle_steps` of the part that is measured.

#include <cstdio>
#include <exception>
#include <string_view>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#endif

#include "loop/fixed_run.hpp"

namespace {

using namespace clearway;

void measure(loop::ClosedLoop& loop, core::Seconds end) {
    const loop::LoopTiming before = loop.timing();
    CALLGRIND_START_INSTRUMENTATION;
    loop.run(end);
    CALLGRIND_STOP_INSTRUMENTATION;
    const loop::LoopTiming& after = loop.timing();
    std::printf("%.6f %.6f %llu\n", after.simulator_s - before.simulator_s,
                after.phases.sum_s() - before.phases.sum_s(),
                static_cast<unsigned long long>(after.vehicle_steps - before.vehicle_steps));
}

}  // namespace

int main(int count, char** words) {
    try {
        for (const test::FixedRun& run : test::fixed_runs()) {
            if (count == 2 && std::string_view(words[1]) == run.name) {
                test::in_the_middle_of(run, measure);
                return 0;
            }
        }
        std::fprintf(stderr, "give one of these names:");
        for (const test::FixedRun& run : test::fixed_runs())
            std::fprintf(stderr, " %s", run.name);
        std::fprintf(stderr, "\n");
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "loop_fixed_runs: %s\n", error.what());
        return 1;
    }
}
