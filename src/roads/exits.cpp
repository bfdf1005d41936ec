#include "roads/exits.hpp"

#include <set>

namespace clearway::roads {
namespace {

void add_exits(const Network& network, core::LaneIndex lane, Driver driver,
               std::set<core::EdgeIndex>& exits) {
    for (const Connection& way : network.connections_from(lane)) {
        const core::EdgeIndex to = network.lane(way.to).edge;
        const bool is_open = driver == Driver::car ? way.allows_cars : way.allows_emergency;
        if (is_open && !network.edge(to).internal) exits.insert(to);
    }
}

}  // namespace

std::vector<core::EdgeIndex> exits(const Network& network, core::LaneIndex lane, Driver driver) {
    std::set<core::EdgeIndex> found;
    add_exits(network, lane, driver, found);
    return {found.begin(), found.end()};
}

std::vector<core::EdgeIndex> exits(const Network& network, core::EdgeIndex index, Driver driver) {
    std::set<core::EdgeIndex> found;
    const Edge& edge = network.edge(index);
    for (std::uint32_t row = edge.first_lane; row < edge.first_lane + edge.lane_count; ++row)
        add_exits(network, core::LaneIndex{row}, driver, found);
    return {found.begin(), found.end()};
}

}  // namespace clearway::roads
