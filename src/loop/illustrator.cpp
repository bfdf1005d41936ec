#include "loop/illustrator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include "view/dark_vehicles.hpp"

namespace clearway::loop {
namespace {

using traffic::VehicleClass;

constexpr sumo::Colour emergency{235, 0, 0};
constexpr sumo::Colour automated{40, 130, 255};
constexpr sumo::Colour human{255, 215, 0};
constexpr sumo::Colour dark_emergency{130, 0, 60};
constexpr sumo::Colour dark_automated{70, 90, 125};
constexpr sumo::Colour dark_human{140, 135, 115};
constexpr sumo::Colour link_colour{0, 170, 80};
constexpr sumo::Colour dark_link_colour{255, 130, 0};
constexpr sumo::Colour held_colour{220, 0, 200};

constexpr double link_width_m = 0.3;
constexpr double ring_width_m = 1.5;
constexpr double ring_margin_m = 4.0;  ///< Beyond the outermost stop line.
constexpr int ring_corners = 32;
/// More would hide the road, and each costs a request of about 60 us per step.
constexpr std::size_t most_links = 80;

sumo::Colour colour_of(VehicleClass vehicle_class, bool dark) {
    switch (vehicle_class) {
        case VehicleClass::emergency:
            return dark ? dark_emergency : emergency;
        case VehicleClass::automated:
            return dark ? dark_automated : automated;
        case VehicleClass::human:
            break;
    }
    return dark ? dark_human : human;
}

/// Centre of a vehicle, whose position in the snapshot is that of its front bumper.
sumo::Spot middle_of(const truth::Snapshot& snapshot, core::VehicleIndex row, const traffic::Roster& roster) {
    const traffic::VehicleInfo* const info = roster.find(snapshot.key[row]);
    const double back_m = info != nullptr ? info->length_m / 2.0 : 0.0;
    return {snapshot.x_m[row] - back_m * std::cos(snapshot.heading_rad[row]),
            snapshot.y_m[row] - back_m * std::sin(snapshot.heading_rad[row])};
}

double distance_m(const sumo::Spot& one, const sumo::Spot& other) {
    return std::hypot(one.x_m - other.x_m, one.y_m - other.y_m);
}

}  // namespace

std::vector<sumo::Spot> ring_around(const roads::Signal& signal, const roads::Network& network) {
    std::vector<sumo::Spot> stop_lines;
    for (const std::vector<roads::SignalLink>& ways : signal.links) {
        for (const roads::SignalLink& way : ways) {
            const roads::Point end = network.lane(way.from).shape.back();
            stop_lines.push_back({end.x_m, end.y_m});
        }
    }
    if (stop_lines.empty()) return {};
    const auto [left, right] = std::ranges::minmax(stop_lines, {}, &sumo::Spot::x_m);
    const auto [low, high] = std::ranges::minmax(stop_lines, {}, &sumo::Spot::y_m);
    const sumo::Spot centre{(left.x_m + right.x_m) / 2.0, (low.y_m + high.y_m) / 2.0};
    double radius_m = 0.0;
    for (const sumo::Spot& stop_line : stop_lines)
        radius_m = std::max(radius_m, distance_m(centre, stop_line));
    radius_m += ring_margin_m;
    std::vector<sumo::Spot> ring;
    for (int corner = 0; corner <= ring_corners; ++corner) {
        const double angle = 2.0 * std::numbers::pi * (corner % ring_corners) / ring_corners;
        ring.push_back({centre.x_m + radius_m * std::cos(angle), centre.y_m + radius_m * std::sin(angle)});
    }
    return ring;
}

const sumo::Drawing& Illustrator::draw(const trace::RecordedStep& step) {
    const truth::Snapshot& snapshot = *step.snapshot;
    if (step.observation != nullptr && step.observation->is_report)
        dark_ = view::dark_vehicles(snapshot, *step.observation);
    if (step.belief != nullptr) take_links(*step.belief);
    take_held(step.commands);
    colour_vehicles(snapshot);
    drawing_.strokes.clear();
    draw_held();
    draw_links(snapshot, *step.roster);
    choose_followed(snapshot);
    return drawing_;
}

bool Illustrator::is_dark(core::VehicleKey vehicle) const {
    return std::ranges::binary_search(dark_, vehicle);
}

void Illustrator::take_links(const traffic::BelievedGraph& belief) {
    links_.clear();
    for (core::VehicleIndex row = 0; row < belief.vehicles.size(); ++row) {
        for (const traffic::BelievedLink& each : belief.links_of(row)) {
            if (row < each.neighbour)
                links_.push_back({belief.vehicles[row].key, belief.vehicles[each.neighbour].key});
        }
    }
}

void Illustrator::take_held(std::span<const traffic::Command> commands) {
    for (const traffic::Command& command : commands) {
        if (const auto* const set = std::get_if<traffic::SetSignalState>(&command))
            held_[set->signal.value] = true;
        if (const auto* const given_back = std::get_if<traffic::RestoreProgram>(&command))
            held_[given_back->signal.value] = false;
    }
}

void Illustrator::colour_vehicles(const truth::Snapshot& snapshot) {
    drawing_.vehicles.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        const core::VehicleKey key = snapshot.key[row];
        drawing_.vehicles.emplace_back(key, colour_of(snapshot.vehicle_class[row], is_dark(key)));
    }
}

void Illustrator::draw_held() {
    for (std::uint32_t signal = 0; signal < held_.size(); ++signal) {
        if (!held_[signal]) continue;
        std::vector<sumo::Spot> ring = ring_around(network_.signal(core::SignalIndex{signal}), network_);
        if (!ring.empty()) drawing_.strokes.push_back({std::move(ring), held_colour, ring_width_m});
    }
}

void Illustrator::draw_links(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    std::vector<sumo::Spot> emergency_at;
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] == VehicleClass::emergency)
            emergency_at.push_back(middle_of(snapshot, row, roster));
    }
    if (emergency_at.empty()) return;
    std::vector<std::pair<double, sumo::Stroke>> near;
    for (const Link& link : links_) {
        const auto one = snapshot.row_of(link.one);
        const auto other = snapshot.row_of(link.other);
        if (!one || !other) continue;
        const sumo::Spot from = middle_of(snapshot, *one, roster);
        const sumo::Spot to = middle_of(snapshot, *other, roster);
        double nearest_m = std::numeric_limits<double>::max();
        for (const sumo::Spot& at : emergency_at)
            nearest_m = std::min(nearest_m, distance_m(at, from) + distance_m(at, to));
        const bool rests_on_belief = is_dark(link.one) || is_dark(link.other);
        near.push_back(
            {nearest_m, {{from, to}, rests_on_belief ? dark_link_colour : link_colour, link_width_m}});
    }
    const std::size_t count = std::min(near.size(), most_links);
    std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(count), {},
                              &std::pair<double, sumo::Stroke>::first);
    for (std::size_t i = 0; i < count; ++i)
        drawing_.strokes.push_back(std::move(near[i].second));
}

void Illustrator::choose_followed(const truth::Snapshot& snapshot) {
    if (drawing_.followed && snapshot.row_of(*drawing_.followed)) return;
    drawing_.followed.reset();
    for (core::VehicleIndex row = 0; row < snapshot.size() && !drawing_.followed; ++row) {
        if (snapshot.vehicle_class[row] == VehicleClass::emergency) drawing_.followed = snapshot.key[row];
    }
}

}  // namespace clearway::loop
