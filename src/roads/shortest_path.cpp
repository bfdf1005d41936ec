#include <algorithm>
#include <cassert>
#include <limits>
#include <queue>
#include <utility>

#include "roads/detail/walk.hpp"
#include "roads/route.hpp"

namespace clearway::roads {
namespace {

constexpr double unreachable = std::numeric_limits<double>::infinity();

double free_flow_s(const Lane& lane) {
    return lane.speed_limit_mps > 0.0F ? static_cast<double>(lane.length_m) / lane.speed_limit_mps
                                       : unreachable;
}

/// Shortest time along an edge on a lane open to cars.
double edge_time_s(const Network& network, core::EdgeIndex index) {
    const Edge& edge = network.edge(index);
    double best_s = unreachable;
    for (const Lane& lane : network.lanes().subspan(edge.first_lane, edge.lane_count)) {
        if (lane.allows_cars) best_s = std::min(best_s, free_flow_s(lane));
    }
    return best_s;
}

class Dijkstra {
  public:
    Dijkstra(const Network& network, core::EdgeIndex from)
        : network_(network), time_s_(network.edges().size(), unreachable), before_(network.edges().size()) {
        assert(from.exists());
        time_s_[from.value] = 0.0;
        queue_.emplace(0.0, from);
    }

    std::optional<std::vector<core::EdgeIndex>> search(core::EdgeIndex to) {
        while (!queue_.empty()) {
            const auto [time_s, edge] = queue_.top();
            queue_.pop();
            if (time_s > time_s_[edge.value]) continue;
            if (edge == to) return path_to(to);
            relax_from(edge);
        }
        return std::nullopt;
    }

  private:
    using Entry = std::pair<double, core::EdgeIndex>;

    void relax_from(core::EdgeIndex index) {
        const Edge& edge = network_.edge(index);
        for (std::uint32_t row = edge.first_lane; row < edge.first_lane + edge.lane_count; ++row) {
            for (const Connection& connection : network_.connections_from(core::LaneIndex{row})) {
                if (connection.allows_cars) relax(index, connection);
            }
        }
    }

    void relax(core::EdgeIndex from, const Connection& connection) {
        const core::EdgeIndex to = network_.lane(connection.to).edge;
        if (network_.edge(to).internal) return;
        double arrival_s = time_s_[from.value] + edge_time_s(network_, to);
        detail::for_each_inner_lane(network_, connection, [&](core::LaneIndex inner) {
            arrival_s += free_flow_s(network_.lane(inner));
        });
        // Dijkstra takes an edge out of the queue once: no way may shorten what was already final.
        assert(arrival_s >= time_s_[from.value]);
        double& known_s = time_s_[to.value];
        core::EdgeIndex& before = before_[to.value];
        if (arrival_s < known_s) {
            known_s = arrival_s;
            before = from;
            queue_.emplace(arrival_s, to);
        } else if (arrival_s == known_s && time_s_[from.value] < arrival_s && before.exists() &&
                   from < before) {
            before = from;
        }
    }

    std::vector<core::EdgeIndex> path_to(core::EdgeIndex to) const {
        std::vector<core::EdgeIndex> path;
        for (core::EdgeIndex edge = to; edge.exists(); edge = before_[edge.value]) {
            path.push_back(edge);
            assert(path.size() <= before_.size());
        }
        std::ranges::reverse(path);
        return path;
    }

    const Network& network_;
    std::vector<double> time_s_;
    std::vector<core::EdgeIndex> before_;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

std::optional<std::vector<core::EdgeIndex>> fastest_route(const Network& network, core::EdgeIndex from,
                                                          core::EdgeIndex to) {
    if (edge_time_s(network, from) == unreachable || edge_time_s(network, to) == unreachable) {
        return std::nullopt;
    }
    return Dijkstra(network, from).search(to);
}

}  // namespace clearway::roads
