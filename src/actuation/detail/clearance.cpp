#include "actuation/detail/clearance.hpp"

#include <algorithm>
#include <cassert>

#include "actuation/detail/ways.hpp"

namespace clearway::actuation::detail {
namespace {

constexpr double kmh_per_mps = 3.6;

double overrun_s(const LeavingTraffic& leaving) {
    return leaving.turns ? 2.0 : 3.0;
}

double turning_speed_mps(const LeavingTraffic& leaving) {
    return leaving.turns ? 7.0 : 10.0;
}

double limit_mps(const std::vector<roads::SignalLink>& ways, const roads::Network& network) {
    double highest_mps = 0.0;
    for (const roads::SignalLink& way : ways)
        highest_mps = std::max<double>(highest_mps, network.lane(way.from).speed_limit_mps);
    return highest_mps;
}

/// A link that loses green.
struct Leaving {
    const roads::Network& network;
    const std::vector<roads::SignalLink>& ways;
    bool on_foot;
    double yellow_s;
};

/// Of the rule, for the slowest of all ways of both links.
double least_red_s(ClearanceRule rule, const Leaving& leaving,
                   const std::vector<roads::SignalLink>& entering) {
    double longest_s = 0.0;
    for (const roads::SignalLink& first : leaving.ways) {
        const roads::Lane& inside = leaving.network.lane(lanes_of_way(leaving.network, first).front());
        const bool is_turn = !leaving.on_foot && turns(leaving.network, first);
        const LeavingTraffic traffic{inside.speed_limit_mps, is_turn, leaving.on_foot};
        for (const roads::SignalLink& second : entering) {
            const SharedArea area = shared_area(leaving.network, first, second);
            // Whoever walks must reach the other side, not only leave the lane that is opened.
            const double left_m =
                leaving.on_foot ? length_of_way(leaving.network, first) : area.last_on_first_m;
            const Crossing crossing{left_m, area.first_on_second_m};
            longest_s = std::max(longest_s, red_of_rule_s(rule, crossing, traffic, leaving.yellow_s));
        }
    }
    return longest_s;
}

}  // namespace

double yellow_of_rule_s(ClearanceRule rule, double speed_limit_mps) {
    assert(rule != ClearanceRule::fixed && speed_limit_mps >= 0.0);
    const double speed_kmh = speed_limit_mps * kmh_per_mps;
    if (rule == ClearanceRule::rilsa) {
        constexpr double rounding_kmh = 0.1;
        return speed_kmh <= 50.0 + rounding_kmh ? 3.0 : speed_kmh <= 60.0 + rounding_kmh ? 4.0 : 5.0;
    }
    constexpr double reaction_s = 1.0;
    constexpr double deceleration_mps2 = 3.05;
    return std::clamp(reaction_s + speed_limit_mps / (2.0 * deceleration_mps2), 3.0, 7.0);
}

double red_of_rule_s(ClearanceRule rule, const Crossing& crossing, const LeavingTraffic& leaving,
                     double yellow_s) {
    assert(rule != ClearanceRule::fixed);
    if (leaving.on_foot) return crossing.leaving_m / (rule == ClearanceRule::ite ? 1.07 : 1.2);
    if (rule == ClearanceRule::ite) {
        constexpr double vehicle_m = 6.1;
        return (crossing.leaving_m + vehicle_m) / std::max(leaving.speed_mps, 1.0);
    }
    constexpr double vehicle_m = 6.0;
    constexpr double entering_mps = 40.0 / kmh_per_mps;
    const double intergreen_s = overrun_s(leaving) +
                                (crossing.leaving_m + vehicle_m) / turning_speed_mps(leaving) -
                                crossing.entering_m / entering_mps;
    return std::max(0.0, intergreen_s - yellow_s);
}

double yellow_on_road_s(double dry_s, double friction) {
    assert(friction > 0.0 && friction <= 1.0);
    constexpr double reaction_s = 1.0;
    constexpr double longest_s = 10.0;
    if (dry_s <= reaction_s) return dry_s;
    return std::max(dry_s, std::min(longest_s, reaction_s + (dry_s - reaction_s) / friction));
}

Clearance::Clearance(const ActuatorConfig& config, const roads::Signal& signal, const roads::Network& network,
                     std::optional<double> on_foot_s) {
    const ClearanceRule rule = config.clearance;
    const bool is_fixed = rule == ClearanceRule::fixed;
    const std::vector<roads::OwnClearance> own = roads::own_clearances(signal);
    const std::size_t count = signal.links.size();
    red_s_.assign(count, std::vector<double>(count, 0.0));
    for (std::size_t link = 0; link < count; ++link) {
        const bool on_foot = signal.crossings[link];
        const double shown_s = own[link].yellow_s;
        const double ruled_s = is_fixed ? config.yellow_s
                               : shown_s > 0.0
                                   ? shown_s
                                   : yellow_of_rule_s(rule, limit_mps(signal.links[link], network));
        yellow_s_.push_back(on_foot ? 0.0
                                    : yellow_on_road_s(std::max(config.yellow_s, ruled_s), config.friction));
        for (std::size_t other = 0; other < count; ++other) {
            if (!signal.foes[link][other]) continue;
            const Leaving leaving{network, signal.links[link], on_foot, ruled_s};
            red_s_[link][other] = is_fixed                ? config.all_red_s
                                  : on_foot && on_foot_s  ? std::max(*on_foot_s, own[link].red_s)
                                  : own[link].red_s > 0.0 ? own[link].red_s
                                                          : least_red_s(rule, leaving, signal.links[other]);
        }
    }
}

}  // namespace clearway::actuation::detail
