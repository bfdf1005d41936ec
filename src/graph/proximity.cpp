#include "graph/proximity.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "graph/detail/near_scan.hpp"

namespace clearway::graph {
namespace {

/// Of links, and 70 m beyond, where candidates for links are looked for.
constexpr double largest_radius_m = 1070.0;
/// Cells are this much wider than the radius, so that rounding never puts a near pair two cells apart.
constexpr double cell_slack = 1.0 + 1e-6;

void check(const Places& places, double radius_m) {
    if (places.y_m.size() != places.x_m.size() || places.vehicle_class.size() != places.x_m.size()) {
        throw std::invalid_argument("columns of different lengths");
    }
    if (!(radius_m > 0.0 && radius_m <= largest_radius_m)) {
        throw std::invalid_argument("radius outside (0, 1070] m");
    }
}

struct Range {
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
};

/// Smallest and largest value. Throws std::invalid_argument when a value is not finite.
Range range_of(std::span<const float> values) {
    Range range;
    bool finite = true;
    for (const float value : values) {
        finite &= std::isfinite(value);
        range.low = std::min(range.low, value);
        range.high = std::max(range.high, value);
    }
    if (!finite) throw std::invalid_argument("a position is not a finite number");
    return range;
}

/// The smallest float whose square root is at least `radius`: a squared distance below it means a distance
/// below `radius`.
float squared_limit(float radius) {
    float limit = radius * radius;
    while (std::sqrt(limit) >= radius) {
        limit = std::nextafter(limit, 0.0F);
    }
    while (std::sqrt(limit) < radius) {
        limit = std::nextafter(limit, std::numeric_limits<float>::max());
    }
    return limit;
}

/// A range of cells that only moves forward as the middle cell grows: O(n) in total.
struct Window {
    std::size_t first = 0;
    std::size_t last = 0;

    void move_to(const std::vector<std::uint64_t>& cells, std::uint64_t low, std::uint64_t high) {
        while (first < cells.size() && cells[first] < low) {
            ++first;
        }
        last = std::max(last, first);
        while (last < cells.size() && cells[last] <= high) {
            ++last;
        }
    }
};

}  // namespace

ProximityBuilder::ProximityBuilder(Kernel kernel) : kernel_(kernel) {}

void ProximityBuilder::build(const Places& places, const LinkRules& rules, ProximityGraph& graph) {
    AllowedClasses allowed{};
    for (const traffic::VehicleClass left : traffic::vehicle_classes) {
        for (const traffic::VehicleClass right : traffic::vehicle_classes) {
            if (!rules.allows(left, right)) continue;
            allowed[static_cast<std::size_t>(left)] |= 1U << static_cast<unsigned>(right);
        }
    }
    build_with(places, rules.radius_m, allowed, graph);
}

void ProximityBuilder::build_all_pairs(const Places& places, double radius_m, ProximityGraph& graph) {
    AllowedClasses allowed{};
    allowed.fill((1U << allowed.size()) - 1U);
    build_with(places, radius_m, allowed, graph);
}

void ProximityBuilder::build_with(const Places& places, double radius_m, const AllowedClasses& allowed,
                                  ProximityGraph& graph) {
    check(places, radius_m);
    find_cells(places, radius_m);
    sort_by_cell();
    copy_in_cell_order(places);
    collect_links(radius_m, allowed);
    write_rows(graph);
}

void ProximityBuilder::find_cells(const Places& places, double radius_m) {
    const std::size_t count = places.x_m.size();
    cell_.resize(count);
    order_.resize(count + detail::scan_margin);
    last_cell_ = 0;
    if (count == 0) return;
    const Range x_range = range_of(places.x_m);
    const Range y_range = range_of(places.y_m);
    const double per_metre = 1.0 / (static_cast<float>(radius_m) * cell_slack);
    const auto cell_along = [per_metre](float value, float low) {
        return static_cast<std::uint64_t>((static_cast<double>(value) - low) * per_metre) + 1;
    };
    const double most = std::max(static_cast<double>(x_range.high) - x_range.low,
                                 static_cast<double>(y_range.high) - y_range.low);
    if (most * per_metre > 1e9) throw std::invalid_argument("positions too far apart for this radius");
    columns_ = cell_along(x_range.high, x_range.low) + 2;
    for (std::size_t row = 0; row < count; ++row) {
        cell_[row] =
            cell_along(places.y_m[row], y_range.low) * columns_ + cell_along(places.x_m[row], x_range.low);
        order_[row] = static_cast<core::VehicleIndex>(row);
        last_cell_ = std::max(last_cell_, cell_[row]);
    }
}

/// Radix sort, lowest digit first: stable, with as many passes as the largest cell number needs.
void ProximityBuilder::sort_by_cell() {
    constexpr unsigned digit_bits = 11;
    constexpr std::uint64_t digit_mask = (1U << digit_bits) - 1U;
    spare_cell_.resize(cell_.size());
    spare_order_.resize(order_.size());
    for (unsigned shift = 0; (last_cell_ >> shift) != 0; shift += digit_bits) {
        std::array<std::uint32_t, digit_mask + 1> next{};
        for (const std::uint64_t cell : cell_) {
            ++next[cell >> shift & digit_mask];
        }
        std::uint32_t sum = 0;
        for (std::uint32_t& entry : next) {
            sum += std::exchange(entry, sum);
        }
        for (std::size_t place = 0; place < cell_.size(); ++place) {
            const std::uint32_t target = next[cell_[place] >> shift & digit_mask]++;
            spare_cell_[target] = cell_[place];
            spare_order_[target] = order_[place];
        }
        cell_.swap(spare_cell_);
        order_.swap(spare_order_);
        if (shift + digit_bits >= std::numeric_limits<std::uint64_t>::digits) break;
    }
}

void ProximityBuilder::copy_in_cell_order(const Places& places) {
    const std::size_t count = cell_.size();
    sorted_x_.resize(count + detail::scan_margin);
    sorted_y_.resize(count + detail::scan_margin);
    sorted_class_.resize(count + detail::scan_margin);
    place_of_.resize(count);
    for (std::size_t place = 0; place < count; ++place) {
        const core::VehicleIndex row = order_[place];
        sorted_x_[place] = places.x_m[row];
        sorted_y_[place] = places.y_m[row];
        sorted_class_[place] = 1U << static_cast<unsigned>(places.vehicle_class[row]);
        place_of_[row] = static_cast<std::uint32_t>(place);
    }
}

void ProximityBuilder::collect_links(double radius_m, const AllowedClasses& allowed) {
    const detail::NearScan scan = kernel_ == Kernel::scalar ? &detail::scan_scalar : detail::fastest_scan();
    const detail::ScanColumns columns{sorted_x_.data(), sorted_y_.data(), sorted_class_.data(),
                                      order_.data()};
    const float limit_m2 = squared_limit(static_cast<float>(radius_m));
    const std::size_t count = cell_.size();
    found_first_.resize(count + 1);
    std::size_t found = 0;
    const auto scan_range = [&](const detail::ScanTarget& target, std::size_t first, std::size_t last) {
        const std::size_t room = found + (last - first) + detail::scan_margin;
        if (found_neighbour_.size() < room) {
            found_neighbour_.resize(2 * room);
            found_squared_m2_.resize(2 * room);
        }
        found += scan(columns, first, last, target, found_neighbour_.data() + found,
                      found_squared_m2_.data() + found);
    };
    Window below, level, above;
    for (std::size_t place = 0; place < count; ++place) {
        const std::uint64_t cell = cell_[place];
        found_first_[place] = static_cast<std::uint32_t>(found);
        below.move_to(cell_, cell - columns_ - 1, cell - columns_ + 1);
        level.move_to(cell_, cell - 1, cell + 1);
        above.move_to(cell_, cell + columns_ - 1, cell + columns_ + 1);
        const auto own_class = static_cast<std::size_t>(std::countr_zero(sorted_class_[place]));
        const detail::ScanTarget target{sorted_x_[place], sorted_y_[place], limit_m2, allowed[own_class]};
        scan_range(target, below.first, below.last);
        scan_range(target, level.first, place);
        scan_range(target, place + 1, level.last);
        scan_range(target, above.first, above.last);
    }
    found_first_[count] = static_cast<std::uint32_t>(found);
}

/// Every link was found from both ends. Going through the vehicles by row and writing each into the rows of
/// its neighbours leaves every row in ascending order, without sorting.
void ProximityBuilder::write_rows(ProximityGraph& graph) {
    const std::size_t count = cell_.size();
    graph.first.resize(count + 1);
    next_free_.resize(count);
    std::uint32_t sum = 0;
    for (std::size_t row = 0; row < count; ++row) {
        graph.first[row] = next_free_[row] = sum;
        sum += found_first_[place_of_[row] + 1] - found_first_[place_of_[row]];
    }
    graph.first[count] = sum;
    graph.neighbour.resize(sum);
    graph.distance_m.resize(sum);
    for (std::size_t row = 0; row < count; ++row) {
        const std::uint32_t last = found_first_[place_of_[row] + 1];
        for (std::uint32_t link = found_first_[place_of_[row]]; link < last; ++link) {
            const std::uint32_t slot = next_free_[found_neighbour_[link]]++;
            graph.neighbour[slot] = static_cast<core::VehicleIndex>(row);
            graph.distance_m[slot] = std::sqrt(found_squared_m2_[link]);
        }
    }
}

}  // namespace clearway::graph
