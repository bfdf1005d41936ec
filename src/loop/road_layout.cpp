#include "loop/road_layout.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/ids.hpp"
#include "roads/route.hpp"
#include "roads/signal_numbers.hpp"

namespace clearway::loop {
namespace {

/// The signal at the end of an edge, or none.
core::SignalIndex signal_after(const roads::Network& network, const roads::Edge& edge) {
    for (std::uint32_t number = 0; number < edge.lane_count; ++number) {
        for (const roads::Connection& connection :
             network.connections_from(core::LaneIndex{edge.first_lane + number})) {
            if (connection.signal.exists()) return connection.signal;
        }
    }
    return core::SignalIndex::none();
}

void add_approaches(const roads::Network& network, std::span<const metrics::EdgeCount> counts,
                    metrics::RoadLayout& layout) {
    std::set<std::string> counted;
    for (const metrics::EdgeCount& count : counts)
        counted.insert(count.edge);
    const bool without_signals = network.signals().empty();
    layout.approach_of_lane.assign(network.lanes().size(), metrics::RoadLayout::no_approach);
    for (const roads::Edge& edge : network.edges()) {
        if (edge.internal) continue;
        const core::SignalIndex signal = signal_after(network, edge);
        if (!signal.exists() && !without_signals && !counted.contains(edge.id)) continue;
        for (std::uint32_t number = 0; number < edge.lane_count; ++number)
            layout.approach_of_lane[edge.first_lane + number] =
                static_cast<std::int32_t>(layout.approaches.size());
        layout.approaches.push_back({edge.id, signal});
    }
}

void add_signal_ways(const roads::Network& network, metrics::RoadLayout& layout) {
    for (std::uint32_t lane = 0; lane < network.lanes().size(); ++lane) {
        for (const roads::Connection& connection : network.connections_from(core::LaneIndex{lane})) {
            if (!connection.signal.exists()) continue;
            layout.signal_ways.push_back(
                {connection.to, connection.from, connection.signal, connection.signal_link});
            if (connection.via.exists())
                layout.signal_ways.push_back(
                    {connection.via, core::LaneIndex::none(), connection.signal, connection.signal_link});
        }
    }
    std::ranges::stable_sort(layout.signal_ways, {}, &metrics::SignalWay::to);
}

void add_signal_heads(const roads::Network& network, metrics::RoadLayout& layout) {
    for (const roads::Signal& signal : network.signals()) {
        const roads::SignalNumbers numbers = roads::signal_numbers(network, signal);
        assert(numbers.phase.size() == signal.links.size() && signal.foes.size() == signal.links.size());
        std::vector<metrics::SignalHead>& heads = layout.signal_heads.emplace_back();
        for (std::size_t link = 0; link < signal.links.size(); ++link) {
            heads.push_back({numbers.phase[link], numbers.approach[link], signal.crossings[link], {}});
            for (std::size_t other = 0; other < signal.links.size(); ++other)
                if (signal.foes[link][other]) heads.back().foes.push_back(static_cast<std::uint16_t>(other));
        }
    }
}

/// The junction of a crossing's edge `:J_c0`.
std::string junction_of(const std::string& crossing) {
    return crossing.substr(1, crossing.rfind("_c") - 1);
}

void add_crossings(const roads::Network& network, metrics::LaneChain& chain) {
    std::map<std::string, std::vector<core::LaneIndex>> crossings;
    for (const roads::Edge& edge : network.edges())
        if (edge.crossing) crossings[junction_of(edge.id)].push_back(core::LaneIndex{edge.first_lane});
    for (const std::string& junction : chain.junctions) {
        const auto found = crossings.find(junction);
        chain.crossings.push_back(found == crossings.end() ? std::vector<core::LaneIndex>{} : found->second);
    }
}

/// The lanes inside a junction that a way across it takes.
std::vector<core::LaneIndex> lanes_inside(const roads::Network& network, const roads::Connection& way) {
    std::vector<core::LaneIndex> lanes;
    for (core::LaneIndex lane = way.via; lane.exists();) {
        lanes.push_back(lane);
        const auto onwards = network.connections_from(lane);
        lane = onwards.empty() ? core::LaneIndex::none() : onwards.front().via;
    }
    return lanes;
}

/// Gives the lanes inside a junction the edge from which a way across it starts.
void add_approach(const roads::Network& network, core::LaneIndex from, metrics::LaneChain& chain) {
    for (const roads::Connection& start : network.connections_from(from))
        for (const core::LaneIndex inside : lanes_inside(network, start))
            chain.approach[inside.value] = chain.edge[from.value];
}

/// The lanes of `other` cross or join the way of `one`.
void add_foe(const roads::Network& network, const roads::Connection& one, const roads::Connection& other,
             metrics::LaneChain& chain) {
    const std::vector<core::LaneIndex> across = lanes_inside(network, other);
    for (const core::LaneIndex lane : lanes_inside(network, one))
        chain.foes[lane.value].insert(chain.foes[lane.value].end(), across.begin(), across.end());
}

void add_prior(const roads::Network& network, const roads::Connection& way, core::LaneIndex from,
               metrics::LaneChain& chain) {
    for (const core::LaneIndex lane : lanes_inside(network, way))
        chain.prior[lane.value].push_back(from);
}

/// At a signal every conflicting link may go before: which one does depends on what it shows.
void add_signal_foes(const roads::Network& network, const roads::Connection& way, metrics::LaneChain& chain) {
    const roads::Signal& signal = network.signal(way.signal);
    for (std::size_t link = 0; link < signal.links.size(); ++link) {
        if (!signal.foes[way.signal_link][link]) continue;
        for (const roads::SignalLink& foe : signal.links[link]) {
            if (signal.crossings[link] || !foe.via.exists()) continue;
            for (const roads::Connection& other : network.connections_from(foe.from)) {
                if (other.via != foe.via) continue;
                add_foe(network, way, other, chain);
                add_prior(network, way, other.from, chain);
            }
        }
    }
}

void add_foes(const roads::Network& network, metrics::LaneChain& chain) {
    chain.foes.resize(network.lanes().size());
    chain.prior.resize(network.lanes().size());
    for (std::uint32_t lane = 0; lane < network.lanes().size(); ++lane) {
        if (network.edge(chain.edge[lane]).internal) continue;
        for (const roads::Connection& way : network.connections_from(core::LaneIndex{lane})) {
            if (way.signal.exists()) add_signal_foes(network, way, chain);
            for (const std::uint32_t row : network.prior_to(way)) {
                const roads::Connection& prior = network.connection(row);
                add_foe(network, way, prior, chain);
                add_foe(network, prior, way, chain);
                add_prior(network, way, prior.from, chain);
            }
        }
    }
}

metrics::LaneChain lane_chain(const roads::Network& network) {
    metrics::LaneChain chain;
    for (std::uint32_t lane = 0; lane < network.lanes().size(); ++lane) {
        const core::LaneIndex from{lane};
        std::vector<metrics::LaneWay>& ways = chain.ways.emplace_back();
        for (const roads::Connection& connection : network.connections_from(from))
            ways.push_back({network.lane(connection.to).edge,
                            connection.via.exists() ? connection.via : connection.to, connection.signal,
                            connection.signal_link});
        chain.edge.push_back(network.lane(from).edge);
        chain.length_m.push_back(network.lane(from).length_m);
    }
    chain.approach = chain.edge;
    for (std::uint32_t lane = 0; lane < network.lanes().size(); ++lane)
        if (!network.edge(chain.edge[lane]).internal) add_approach(network, core::LaneIndex{lane}, chain);
    for (const roads::Edge& edge : network.edges()) {
        chain.edge_ids.push_back(edge.id);
        chain.junctions.push_back(edge.internal ? "" : edge.to_junction);
    }
    add_crossings(network, chain);
    add_foes(network, chain);
    return chain;
}

/// To the end of the edge of lane `last`, at the speed limits.
double least_time_s(const roads::Network& network, const std::vector<core::EdgeIndex>& route,
                    core::LaneIndex last) {
    double time_s = 0.0;
    for (const core::EdgeIndex edge : route) {
        double limit_mps = 0.1;
        for (std::uint32_t number = 0; number < network.edge(edge).lane_count; ++number)
            limit_mps =
                std::max<double>(limit_mps, network.lane(network.lane_of(edge, number)).speed_limit_mps);
        time_s += network.edge(edge).length_m / limit_mps;
        if (edge == network.lane(last).edge) break;
    }
    return time_s;
}

metrics::WatchedRoute watched_route(const roads::Network& network, const metrics::RoadLayout& layout,
                                    const traffic::EmergencyDeparture& departure) {
    metrics::WatchedRoute watched{core::vehicle_key(departure.id), departure.id, {}, {}, {}, {}, {}};
    std::vector<core::EdgeIndex> route;
    for (const std::string& id : departure.edges) {
        const auto edge = network.find_edge(id);
        if (!edge) break;
        route.push_back(*edge);
        const double length_m = network.edge(*edge).length_m;
        watched.edges.push_back(id);
        watched.edge_start_m.push_back(roads::route_length(network, route).value - length_m);
        watched.edge_length_m.push_back(length_m);
        watched.approach.push_back(layout.approach_of_lane[network.edge(*edge).first_lane]);
    }
    if (route.empty()) return watched;
    traffic::MotionState start;
    start.lane = network.lane_of(route.front(), 0);
    constexpr core::Metres to_the_end{1e9};
    for (const roads::StopLine& line : roads::signals_ahead(network, route, start, to_the_end)) {
        const roads::Signal& signal = network.signal(line.signal);
        assert(!line.links.empty() && !signal.links[line.links.front()].empty());
        const core::LaneIndex from = signal.links[line.links.front()].front().from;
        watched.signals.push_back({line.signal, signal.id, line.links, line.distance.value,
                                   departure.depart.value + least_time_s(network, route, from),
                                   layout.approach_of_lane[from.value]});
    }
    return watched;
}

}  // namespace

metrics::RoadLayout road_layout(const roads::Network& network,
                                std::span<const traffic::EmergencyDeparture> emergency,
                                std::span<const metrics::EdgeCount> counts) {
    metrics::RoadLayout layout;
    add_approaches(network, counts, layout);
    add_signal_ways(network, layout);
    add_signal_heads(network, layout);
    layout.chain = lane_chain(network);
    for (const roads::Signal& signal : network.signals())
        layout.signals.push_back(signal.id);
    for (const roads::Lane& lane : network.lanes()) {
        layout.internal_lane.push_back(network.edge(lane.edge).internal ? 1 : 0);
        layout.limit_of_lane_mps.push_back(lane.speed_limit_mps);
    }
    for (const traffic::EmergencyDeparture& departure : emergency)
        layout.routes.push_back(watched_route(network, layout, departure));
    layout.on_way = [&network](const metrics::RoadLayout& known, const metrics::WatchedRoute& route,
                               std::span<const core::EdgeIndex> edges) {
        traffic::EmergencyDeparture departure;
        departure.id = route.id;
        for (const core::EdgeIndex edge : edges)
            departure.edges.push_back(network.edge(edge).id);
        return watched_route(network, known, departure);
    };
    return layout;
}

}  // namespace clearway::loop
