#include "policy/navigate.hpp"

#include <algorithm>
#include <utility>

namespace clearway::policy {
namespace {

/// A way is asked for so long at most, s: enough to leave a junction. Later the crew may have turned.
constexpr double longest_lease_s = 5.0;
/// Ways that differ by less are level, s.
constexpr double level_s = 0.1;

}  // namespace

Navigate::Navigate(const PolicyContext& context, const NavigateConfig& config)
    : ConfiguredPolicy(context, config), ways_(context, config) {}

void Navigate::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const bool has_news = ways_.see(belief);
    const detail::View view(context_.network, belief);
    detail::LeaseWriter write("navigate", context_.period, belief.time, leases,
                              std::min(config_.replan_s, longest_lease_s));
    for (const traffic::BelievedVehicle& emergency : view.emergency_vehicles()) {
        const auto [planned, is_new] = planned_at_.try_emplace(emergency.key, belief.time.value);
        const double age_s = belief.time.value - planned->second;
        if (!is_new && !has_news && age_s + core::clock_tolerance_s < config_.replan_s) continue;
        planned->second = belief.time.value;
        plan(view, emergency, write);
    }
}

void Navigate::plan(const detail::View& view, const traffic::BelievedVehicle& emergency,
                    detail::LeaseWriter& write) {
    const auto choice = ways_.choice_of(view, emergency);
    if (!choice) return;
    const auto edge_s = ways_.edge_times_of(choice->trip);
    const double found_s = ways_.search().search(choice->trip, edge_s, way_);
    if (found_s == roads::no_way_s) return;
    const double present_s = ways_.search().time_of(choice->present, choice->trip.leaving_s, edge_s);
    const double least_gain_s = std::max(config_.gain_s, config_.gain_share * present_s);
    const bool is_blocked = present_s == roads::no_way_s;
    if (std::ranges::equal(way_, choice->present)) return;
    std::vector<core::EdgeIndex> way = detail::BelievedWays::whole(*choice, way_);
    if (is_blocked || present_s - found_s > least_gain_s)
        write.add(emergency.key, traffic::TakeRoute{std::move(way)},
                  is_blocked ? "its way is closed" : "another way is faster", emergency.key);
    else if (present_s - found_s >= level_s)
        write.add(emergency.key, traffic::StandBack{std::move(way)},
                  "another way is faster, but not by enough", emergency.key);
}

}  // namespace clearway::policy
