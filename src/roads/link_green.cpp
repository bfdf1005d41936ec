#include "roads/link_green.hpp"

#include <algorithm>

#include "traffic/signal.hpp"

namespace clearway::roads {
namespace {

LinkGreen green_of(double green_s, double cycle_s, double squares_s2) {
    if (green_s <= 0.0) return {};
    return {green_s / cycle_s, squares_s2 / (2.0 * cycle_s)};
}

/// Of phases side by side, which serve a link one after the other at most.
LinkGreen green_in_rings(const Signal& signal, std::size_t link) {
    constexpr double rings = 2.0;
    double green_s = 0.0;
    double all_s = 0.0;
    for (const Phase& phase : signal.program) {
        all_s += phase.duration_s + phase.yellow_s + phase.red_s;
        if (gives_green(phase, link)) green_s += phase.duration_s;
    }
    const double red_s = std::max(all_s / rings - green_s, 0.0);
    return green_of(green_s, green_s + red_s, red_s * red_s);
}

}  // namespace

bool gives_green(const Phase& phase, std::size_t link) {
    return traffic::is_green_for(phase.state, link);
}

LinkGreen link_green(const Signal& signal, std::size_t link) {
    const std::vector<Phase>& program = signal.program;
    if (signal.controller == "NEMA") return green_in_rings(signal, link);
    const auto first =
        std::ranges::find_if(program, [&](const Phase& phase) { return gives_green(phase, link); });
    double green_s = 0.0;
    double cycle_s = 0.0;
    double red_s = 0.0;  // since the last green
    double squares_s2 = 0.0;
    const auto play = [&](const Phase& phase) {
        cycle_s += phase.duration_s;
        if (!gives_green(phase, link)) {
            red_s += phase.duration_s;
            return;
        }
        green_s += phase.duration_s;
        squares_s2 += red_s * red_s;
        red_s = 0.0;
    };
    std::for_each(first, program.end(), play);
    std::for_each(program.begin(), first, play);
    return green_of(green_s, cycle_s, squares_s2 + red_s * red_s);
}

}  // namespace clearway::roads
