// The part of NetworkBuilder that needs the whole file: it links the elements to each other.
#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "roads/detail/network_builder.hpp"

namespace clearway::roads {
namespace {

/// Limit on the lanes of one way through a junction, against cyclic files; netconvert writes 1 or 2.
constexpr int most_inner_lanes = 16;

}  // namespace

Network NetworkBuilder::finish() {
    line_ = 1;
    if (network_.edges_.empty() && problems_.empty()) {
        add_problem("has no edges", "", "Make the network with netconvert");
    }
    if (!problems_.empty()) throw core::InputError(std::move(problems_));
    group_connections();
    list_successors();
    list_signal_links();
    list_foes();
    if (!problems_.empty()) throw core::InputError(std::move(problems_));
    return std::move(network_);
}

void NetworkBuilder::group_connections() {
    std::ranges::stable_sort(network_.connections_, {}, &Connection::from);
    for (std::uint32_t row = 0; row < network_.connections_.size(); ++row) {
        Lane& lane = network_.lanes_[network_.connections_[row].from.value];
        if (lane.connection_count == 0) lane.first_connection = row;
        ++lane.connection_count;
    }
}

void NetworkBuilder::list_successors() {
    network_.first_successor_.push_back(0);
    std::vector<core::EdgeIndex> reached;
    for (const Edge& edge : network_.edges_) {
        reached.clear();
        for (std::uint32_t lane = edge.first_lane; lane < edge.first_lane + edge.lane_count; ++lane) {
            for (const Connection& connection : network_.connections_from(core::LaneIndex{lane})) {
                const core::EdgeIndex to = network_.lane(connection.to).edge;
                if (connection.allows_cars && !network_.edge(to).internal) reached.push_back(to);
            }
        }
        std::ranges::sort(reached);
        const auto repeated = std::unique(reached.begin(), reached.end());
        network_.successors_.insert(network_.successors_.end(), reached.begin(), repeated);
        network_.first_successor_.push_back(static_cast<std::uint32_t>(network_.successors_.size()));
    }
}

void NetworkBuilder::list_signal_links() {
    for (Signal& signal : network_.signals_)
        signal.crossings.assign(signal.links.size(), false);
    for (const Connection& connection : network_.connections_) {
        if (!connection.signal.exists()) continue;
        Signal& signal = network_.signals_[connection.signal.value];
        signal.links[connection.signal_link].push_back({connection.from, connection.to, connection.via});
        if (network_.edge(network_.lane(connection.to).edge).crossing)
            signal.crossings[connection.signal_link] = true;
    }
}

/// The lane that stands for a connection in its junction's `intLanes`: the last one inside the junction, or,
/// for a pedestrian crossing, the lane that it leads to.
core::LaneIndex NetworkBuilder::inner_lane_of(const Connection& connection) const {
    if (!connection.via.exists()) return connection.to;
    core::LaneIndex lane = connection.via;
    for (int hop = 0; hop < most_inner_lanes; ++hop) {
        const auto onward = network_.connections_from(lane);
        if (onward.empty() || !onward.front().via.exists()) break;
        lane = onward.front().via;
    }
    return lane;
}

std::vector<NetworkBuilder::LinkPlace> NetworkBuilder::links_by_incoming_order(
    const Junction& junction) const {
    std::vector<LinkPlace> places;
    for (const std::string& id : junction.incoming_lanes) {
        const auto lane = network_.find_lane(id);
        if (!lane) continue;
        for (const Connection& connection : network_.connections_from(*lane)) {
            places.push_back({connection.signal, connection.signal_link});
        }
    }
    return places;
}

std::vector<NetworkBuilder::LinkPlace> NetworkBuilder::links_by_request(const Junction& junction) const {
    if (junction.inner_lanes.empty()) return links_by_incoming_order(junction);
    std::map<core::LaneIndex, LinkPlace> by_inner_lane;
    for (const std::string& id : junction.incoming_lanes) {
        const auto lane = network_.find_lane(id);
        if (!lane) continue;
        for (const Connection& connection : network_.connections_from(*lane)) {
            by_inner_lane[inner_lane_of(connection)] = {connection.signal, connection.signal_link};
        }
    }
    std::vector<LinkPlace> places(junction.inner_lanes.size());
    for (std::size_t request = 0; request < places.size(); ++request) {
        const auto lane = network_.find_lane(junction.inner_lanes[request]);
        const auto found = lane ? by_inner_lane.find(*lane) : by_inner_lane.end();
        if (found != by_inner_lane.end()) places[request] = found->second;
    }
    return places;
}

void NetworkBuilder::list_foes() {
    for (Signal& signal : network_.signals_) {
        signal.foes.assign(signal.links.size(), std::vector<bool>(signal.links.size(), false));
    }
    for (const Junction& junction : junctions_) {
        line_ = junction.line;
        const std::vector<LinkPlace> places = links_by_request(junction);
        if (places.size() != junction.foes.size()) {
            add_problem(fmt::format("junction has {} requests", junction.foes.size()),
                        fmt::format("one for each of its {} ways", places.size()));
            continue;
        }
        for (std::size_t request = 0; request < places.size(); ++request) {
            const std::string& letters = junction.foes[request];
            for (std::size_t other = 0; other < std::min(places.size(), letters.size()); ++other) {
                const LinkPlace left = places[request];
                const LinkPlace right = places[other];
                const bool crossing = letters[letters.size() - 1 - other] == '1';
                if (!crossing || !left.signal.exists() || left.signal != right.signal) continue;
                if (left.link == right.link) continue;
                auto& foes = network_.signals_[left.signal.value].foes;
                foes[left.link][right.link] = true;
                foes[right.link][left.link] = true;
            }
        }
    }
}

}  // namespace clearway::roads
