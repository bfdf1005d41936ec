#include "drivers/detail/gap_across.hpp"

#include <algorithm>
#include <cmath>

namespace clearway::drivers::detail {

double shift_into(const Across& free, double needed_m) {
    return std::clamp(0.0, free.right_m + needed_m / 2.0, free.left_m - needed_m / 2.0);
}

std::optional<Across> nearest_free(const Across& road, std::vector<Across> occupied, double needed_m) {
    std::ranges::sort(occupied, {}, &Across::right_m);
    std::optional<Across> best;
    const auto offer = [&](const Across& free) {
        if (free.width_m() < needed_m) return;
        if (!best || std::abs(shift_into(free, needed_m)) < std::abs(shift_into(*best, needed_m)))
            best = free;
    };
    double from_m = road.right_m;
    for (const Across& body : occupied) {
        offer({from_m, std::min(body.right_m, road.left_m)});
        from_m = std::max(from_m, body.left_m);
    }
    offer({from_m, road.left_m});
    return best;
}

}  // namespace clearway::drivers::detail
