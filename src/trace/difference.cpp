#include "trace/difference.hpp"

#include <bit>
#include <concepts>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "truth/snapshot.hpp"

namespace clearway::trace {
namespace {

/// Compares two values member by member and keeps the first difference.
class Comparison {
  public:
    template <class Value>
    void check(const std::string& name, const Value& one, const Value& other) {
        if (found_) return;
        if constexpr (std::same_as<Value, float>) {
            if (std::bit_cast<std::uint32_t>(one) != std::bit_cast<std::uint32_t>(other))
                note(name, one, other);
        } else if constexpr (std::same_as<Value, double>) {
            if (std::bit_cast<std::uint64_t>(one) != std::bit_cast<std::uint64_t>(other))
                note(name, one, other);
        } else if constexpr (std::is_enum_v<Value>) {
            if (one != other) note(name, static_cast<int>(one), static_cast<int>(other));
        } else if constexpr (requires { one.value; }) {
            check(name, one.value, other.value);
        } else {
            if (one != other) note(name, one, other);
        }
    }
    /// Compares elements with `check_element(name, one, other)`.
    template <class List, class CheckElement>
    void list(const std::string& name, const List& one, const List& other,
              const CheckElement& check_element) {
        check(name + ".size", one.size(), other.size());
        for (std::size_t i = 0; i < one.size() && !found_; ++i)
            check_element(fmt::format("{}[{}]", name, i), one[i], other[i]);
    }
    template <class List>
    void values(const std::string& name, const List& one, const List& other) {
        list(name, one, other, [this](const std::string& place, const auto& left, const auto& right) {
            check(place, left, right);
        });
    }
    std::optional<std::string> found() const { return found_; }

  private:
    template <class Value>
    void note(const std::string& name, const Value& one, const Value& other) {
        found_ = fmt::format("{}: {}, then {}", name, one, other);
    }
    std::optional<std::string> found_;
};

void compare_motion(Comparison& comparison, const std::string& name, const traffic::MotionState& one,
                    const traffic::MotionState& other) {
    comparison.check(name + ".x_m", one.x_m, other.x_m);
    comparison.check(name + ".y_m", one.y_m, other.y_m);
    comparison.check(name + ".heading_rad", one.heading_rad, other.heading_rad);
    comparison.check(name + ".speed_mps", one.speed_mps, other.speed_mps);
    comparison.check(name + ".lane", one.lane, other.lane);
    comparison.check(name + ".lane_position_m", one.lane_position_m, other.lane_position_m);
    comparison.check(name + ".route_edge", one.route_edge, other.route_edge);
}

void compare_reports(Comparison& comparison, const std::string& name,
                     const std::vector<traffic::ObservedVehicle>& one,
                     const std::vector<traffic::ObservedVehicle>& other) {
    comparison.list(name, one, other, [&](const std::string& place, const auto& left, const auto& right) {
        comparison.check(place + ".key", left.key, right.key);
        comparison.check(place + ".vehicle_class", left.vehicle_class, right.vehicle_class);
        comparison.check(place + ".freshness", left.freshness, right.freshness);
        comparison.check(place + ".age_s", left.age_s, right.age_s);
        comparison.check(place + ".position_sigma_m", left.position_sigma_m, right.position_sigma_m);
        compare_motion(comparison, place + ".state", left.state, right.state);
    });
}

void compare_believed(Comparison& comparison, const std::string& name,
                      const std::vector<traffic::BelievedVehicle>& one,
                      const std::vector<traffic::BelievedVehicle>& other) {
    comparison.list(name, one, other, [&](const std::string& place, const auto& left, const auto& right) {
        comparison.check(place + ".key", left.key, right.key);
        comparison.check(place + ".vehicle_class", left.vehicle_class, right.vehicle_class);
        compare_motion(comparison, place + ".state", left.state, right.state);
        comparison.check(place + ".sigma_m", left.sigma_m, right.sigma_m);
        comparison.check(place + ".age_s", left.age_s, right.age_s);
    });
}

/// What both rosters say of a vehicle.
void compare_registration(Comparison& comparison, core::VehicleKey key, const traffic::Roster& one,
                          const traffic::Roster& other) {
    const traffic::VehicleInfo* const left = one.find(key);
    const traffic::VehicleInfo* const right = other.find(key);
    comparison.check("roster: vehicle is known", left != nullptr, right != nullptr);
    if (left == nullptr || right == nullptr) return;
    const std::string name = "roster: " + left->id;
    comparison.check(name + ".id", left->id, right->id);
    comparison.check(name + ".vehicle_class", left->vehicle_class, right->vehicle_class);
    comparison.check(name + ".kind", left->kind, right->kind);
    comparison.check(name + ".length_m", left->length_m, right->length_m);
    comparison.check(name + ".width_m", left->width_m, right->width_m);
    comparison.check(name + ".minimum_gap_m", left->minimum_gap_m, right->minimum_gap_m);
    comparison.check(name + ".maximum_speed_mps", left->maximum_speed_mps, right->maximum_speed_mps);
    comparison.check(name + ".acceleration_mps2", left->acceleration_mps2, right->acceleration_mps2);
    comparison.check(name + ".deceleration_mps2", left->deceleration_mps2, right->deceleration_mps2);
    comparison.check(name + ".speed_factor", left->speed_factor, right->speed_factor);
    comparison.check(name + ".route", left->route, right->route);
    if (left->route.exists() && left->route == right->route)
        comparison.values(name + ".route", one.route(left->route), other.route(right->route));
}

template <class Target>
void compare_target(Comparison& comparison, const std::string& name, const Target& one, const Target& other) {
    comparison.check(name, one, other);
}
void compare_target(Comparison& comparison, const std::string& name, const traffic::Stretch& one,
                    const traffic::Stretch& other) {
    comparison.check(name + ".lane", one.lane, other.lane);
    comparison.check(name + ".from_m", one.from_m, other.from_m);
    comparison.check(name + ".to_m", one.to_m, other.to_m);
    comparison.check(name + ".below_mps", one.below_mps, other.below_mps);
    comparison.check(name + ".addressed", one.addressed, other.addressed);
}

/// Compares kind and fields of two actions.
void compare_action(Comparison& comparison, const std::string& name, const traffic::Action& one,
                    const traffic::Action& other) {
    comparison.check(name, traffic::name(one), traffic::name(other));
    if (one.index() != other.index()) return;
    std::visit(
        [&](const auto& left) {
            const auto& right = std::get<std::decay_t<decltype(left)>>(other);
            if constexpr (requires { left.speed; })
                comparison.check(name + ".speed", left.speed, right.speed);
            if constexpr (requires { left.lane_number; })
                comparison.check(name + ".lane_number", left.lane_number, right.lane_number);
            if constexpr (requires { left.side; }) comparison.check(name + ".side", left.side, right.side);
            if constexpr (requires { left.links; })
                comparison.values(name + ".links", left.links, right.links);
            if constexpr (requires { left.own_links; })
                comparison.values(name + ".own_links", left.own_links, right.own_links);
            if constexpr (requires { left.edges; })
                comparison.values(name + ".edges", left.edges, right.edges);
            if constexpr (requires { left.way; }) comparison.values(name + ".way", left.way, right.way);
        },
        one);
}

}  // namespace

std::optional<std::string> difference(const truth::Snapshot& one, const truth::Snapshot& other) {
    Comparison comparison;
    comparison.check("time", one.time, other.time);
    comparison.values("key", one.key, other.key);
    comparison.values("vehicle_class", one.vehicle_class, other.vehicle_class);
    comparison.values("x_m", one.x_m, other.x_m);
    comparison.values("y_m", one.y_m, other.y_m);
    comparison.values("heading_rad", one.heading_rad, other.heading_rad);
    comparison.values("speed_mps", one.speed_mps, other.speed_mps);
    comparison.values("acceleration_mps2", one.acceleration_mps2, other.acceleration_mps2);
    comparison.values("lane", one.lane, other.lane);
    comparison.values("lane_position_m", one.lane_position_m, other.lane_position_m);
    comparison.values("route_edge", one.route_edge, other.route_edge);
    comparison.values("signals", one.signals.state, other.signals.state);
    return comparison.found();
}

std::optional<std::string> difference(const traffic::Observation& one, const traffic::Observation& other) {
    Comparison comparison;
    comparison.check("time", one.time, other.time);
    comparison.check("report_time", one.report_time, other.report_time);
    comparison.check("is_report", one.is_report, other.is_report);
    comparison.check("exits_known", one.exits_known, other.exits_known);
    compare_reports(comparison, "vehicles", one.vehicles, other.vehicles);
    compare_reports(comparison, "own_states", one.own_states, other.own_states);
    comparison.list("detected_links", one.detected_links, other.detected_links,
                    [&](const std::string& place, const auto& left, const auto& right) {
                        comparison.check(place + ".from", left.from, right.from);
                        comparison.check(place + ".to", left.to, right.to);
                        comparison.check(place + ".range_m", left.range_m, right.range_m);
                        comparison.check(place + ".range_sigma_m", left.range_sigma_m, right.range_sigma_m);
                    });
    comparison.values("signals", one.signals.state, other.signals.state);
    comparison.list("incidents", one.incidents, other.incidents,
                    [&](const std::string& place, const auto& left, const auto& right) {
                        comparison.check(place + ".edge", left.edge.value, right.edge.value);
                        comparison.check(place + ".closed_to_emergency", left.closed_to_emergency,
                                         right.closed_to_emergency);
                        comparison.check(place + ".speed_past_mps", left.speed_past_mps,
                                         right.speed_past_mps);
                    });
    if (comparison.found()) return comparison.found();
    for (const auto* const list : {&one.vehicles, &one.own_states}) {
        for (const traffic::ObservedVehicle& vehicle : *list)
            compare_registration(comparison, vehicle.key, *one.roster, *other.roster);
    }
    return comparison.found();
}

std::optional<std::string> difference(const traffic::BelievedGraph& one,
                                      const traffic::BelievedGraph& other) {
    Comparison comparison;
    comparison.check("time", one.time, other.time);
    compare_believed(comparison, "vehicles", one.vehicles, other.vehicles);
    comparison.values("first_link", one.first_link, other.first_link);
    comparison.list("links", one.links, other.links,
                    [&](const std::string& place, const auto& left, const auto& right) {
                        comparison.check(place + ".neighbour", left.neighbour, right.neighbour);
                        comparison.check(place + ".distance_m", left.distance_m, right.distance_m);
                        comparison.check(place + ".probability", left.probability, right.probability);
                    });
    compare_believed(comparison, "own_states", one.own_states, other.own_states);
    comparison.values("signals", one.signals.state, other.signals.state);
    return comparison.found();
}

std::optional<std::string> difference(std::span<const traffic::Lease> one,
                                      std::span<const traffic::Lease> other) {
    Comparison comparison;
    comparison.list("leases", one, other, [&](const std::string& place, const auto& left, const auto& right) {
        comparison.check(place + ".target is vehicle, signal or stretch", left.target.index(),
                         right.target.index());
        std::visit(
            [&](const auto& target) {
                if (const auto* const same = std::get_if<std::decay_t<decltype(target)>>(&right.target))
                    compare_target(comparison, place + ".target", target, *same);
            },
            left.target);
        compare_action(comparison, place + ".action", left.action, right.action);
        comparison.check(place + ".expiry_s", left.expiry, right.expiry);
        comparison.check(place + ".priority", left.priority, right.priority);
        comparison.check(place + ".policy", std::string_view(left.policy), std::string_view(right.policy));
        comparison.check(place + ".reason", std::string_view(left.reason), std::string_view(right.reason));
        comparison.check(place + ".beneficiary", left.beneficiary, right.beneficiary);
    });
    return comparison.found();
}

}  // namespace clearway::trace
