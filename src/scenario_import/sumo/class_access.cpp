#include "scenario_import/sumo/class_access.hpp"

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

ClassAccess::ClassAccess(const std::filesystem::path& file, const roads::Network& network)
    : network_(network), rules_(network.lanes().size(), nullptr) {
    for_each_element(file, [&](Element&& edge) {
        if (edge.name != "edge") return;
        for (const Element& lane : edge.children) {
            const auto found = network_.find_lane(lane.text("id"));
            if (!found || (!lane.has("allow") && !lane.has("disallow"))) continue;
            const auto [entry, is_new] =
                different_rules_.try_emplace({lane.text("allow"), lane.text("disallow")});
            Rule& rule = entry->second;
            if (is_new) {
                rule.allows = !lane.text("allow").empty();
                for (std::string& name : words(lane.text(rule.allows ? "allow" : "disallow")))
                    rule.classes.insert(std::move(name));
            }
            rules_[found->value] = &rule;
        }
    });
}

bool ClassAccess::opens_lane(core::LaneIndex lane, const std::string& vehicle_class) const {
    const Rule* const rule = rules_[lane.value];
    if (rule == nullptr || vehicle_class == "ignoring") return true;
    const std::string wanted = vehicle_class.empty() ? "passenger" : vehicle_class;
    return rule->allows == (rule->classes.contains("all") || rule->classes.contains(wanted));
}

bool ClassAccess::opens(core::EdgeIndex edge, const std::string& vehicle_class) const {
    for (std::uint32_t number = 0; number < network_.edge(edge).lane_count; ++number)
        if (opens_lane(network_.lane_of(edge, number), vehicle_class)) return true;
    return false;
}

bool ClassAccess::joins(core::EdgeIndex from, core::EdgeIndex to, const std::string& vehicle_class) const {
    for (std::uint32_t number = 0; number < network_.edge(from).lane_count; ++number) {
        const core::LaneIndex lane = network_.lane_of(from, number);
        if (!opens_lane(lane, vehicle_class)) continue;
        for (const roads::Connection& way : network_.connections_from(lane))
            if (network_.lane(way.to).edge == to && opens_lane(way.to, vehicle_class) &&
                (!way.via.exists() || opens_lane(way.via, vehicle_class)))
                return true;
    }
    return false;
}

bool ClassAccess::opens_way(const std::vector<core::EdgeIndex>& route,
                            const std::string& vehicle_class) const {
    for (std::size_t row = 0; row < route.size(); ++row)
        if (!opens(route[row], vehicle_class) ||
            (row > 0 && !joins(route[row - 1], route[row], vehicle_class)))
            return false;
    return true;
}

}  // namespace clearway::scenario_import::detail
