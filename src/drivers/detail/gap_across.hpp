#pragma once

#include <optional>
#include <vector>

namespace clearway::drivers::detail {

/// A stretch across the road, m: 0 where the emergency vehicle is, positive to the left.
struct Across {
    double right_m = 0.0;
    double left_m = 0.0;

    double width_m() const { return left_m - right_m; }
};

/// The free stretch of `road` between `occupied` that is at least `needed_m` wide and whose place for the
/// vehicle is nearest to where it is; nothing if there is none. O(n log n).
std::optional<Across> nearest_free(const Across& road, std::vector<Across> occupied, double needed_m);

/// How far a vehicle `needed_m` wide has to move sideways to be inside `free`, m, positive to the left.
double shift_into(const Across& free, double needed_m);

}  // namespace clearway::drivers::detail
