// The part of NetworkBuilder that needs the whole file: it links the elements to each other.
#include <algorithm>
#include <cassert>
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
    list_right_of_way();
    if (!problems_.empty()) throw core::InputError(std::move(problems_));
    return std::move(network_);
}

void NetworkBuilder::group_connections() {
    assert(network_.lanes_.size() == network_.lane_rows_.size());
    assert(network_.edges_.size() == network_.edge_rows_.size());
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

std::vector<NetworkBuilder::Row> NetworkBuilder::ways_by_incoming_order(const Junction& junction) const {
    std::vector<Row> ways;
    for (const std::string& id : junction.incoming_lanes) {
        const auto lane = network_.find_lane(id);
        if (!lane) continue;
        const Lane& from = network_.lane(*lane);
        for (Row row = from.first_connection; row < from.first_connection + from.connection_count; ++row)
            ways.push_back(row);
    }
    return ways;
}

std::vector<NetworkBuilder::Row> NetworkBuilder::ways_by_request(const Junction& junction) const {
    if (junction.inner_lanes.empty()) return ways_by_incoming_order(junction);
    std::map<core::LaneIndex, Row> by_inner_lane;
    for (const Row row : ways_by_incoming_order(junction))
        by_inner_lane[inner_lane_of(network_.connections_[row])] = row;
    std::vector<Row> ways(junction.inner_lanes.size(), no_row);
    for (std::size_t request = 0; request < ways.size(); ++request) {
        const auto lane = network_.find_lane(junction.inner_lanes[request]);
        const auto found = lane ? by_inner_lane.find(*lane) : by_inner_lane.end();
        if (found != by_inner_lane.end()) ways[request] = found->second;
    }
    return ways;
}

void NetworkBuilder::list_right_of_way() {
    for (Signal& signal : network_.signals_) {
        signal.foes.assign(signal.links.size(), std::vector<bool>(signal.links.size(), false));
    }
    std::vector<std::vector<Row>> prior(network_.connections_.size());
    for (const Junction& junction : junctions_) {
        line_ = junction.line;
        const std::vector<Row> ways = ways_by_request(junction);
        const bool fits = ways.size() == junction.foes.size();
        if (fits && junction.has_signal)
            list_foes(junction, ways);
        else if (fits)
            list_prior(junction, ways, prior);
        else if (junction.has_signal)
            add_problem(fmt::format("junction has {} requests", junction.foes.size()),
                        fmt::format("one for each of its {} ways", ways.size()));
    }
    store_prior(prior);
}

void NetworkBuilder::list_foes(const Junction& junction, const std::vector<Row>& ways) {
    for (std::size_t request = 0; request < ways.size(); ++request) {
        const std::string& letters = junction.foes[request];
        for (std::size_t other = 0; other < std::min(ways.size(), letters.size()); ++other) {
            const bool crossing = letters[letters.size() - 1 - other] == '1';
            if (!crossing || ways[request] == no_row || ways[other] == no_row) continue;
            const Connection& left = network_.connections_[ways[request]];
            const Connection& right = network_.connections_[ways[other]];
            if (!left.signal.exists() || left.signal != right.signal) continue;
            if (left.signal_link == right.signal_link) continue;
            auto& foes = network_.signals_[left.signal.value].foes;
            foes[left.signal_link][right.signal_link] = true;
            foes[right.signal_link][left.signal_link] = true;
        }
    }
}

void NetworkBuilder::list_prior(const Junction& junction, const std::vector<Row>& ways,
                                std::vector<std::vector<Row>>& prior) const {
    for (std::size_t request = 0; request < ways.size(); ++request) {
        if (ways[request] == no_row) continue;
        const std::string& letters = junction.responses[request];
        for (std::size_t other = 0; other < std::min(ways.size(), letters.size()); ++other) {
            const bool yields = letters[letters.size() - 1 - other] == '1';
            if (yields && ways[other] != no_row && network_.connections_[ways[other]].allows_cars)
                prior[ways[request]].push_back(ways[other]);
        }
    }
}

void NetworkBuilder::store_prior(const std::vector<std::vector<Row>>& prior) {
    for (Row row = 0; row < prior.size(); ++row) {
        network_.connections_[row].first_prior = static_cast<std::uint32_t>(network_.prior_.size());
        network_.connections_[row].prior_count = static_cast<std::uint32_t>(prior[row].size());
        network_.prior_.insert(network_.prior_.end(), prior[row].begin(), prior[row].end());
    }
}

}  // namespace clearway::roads
