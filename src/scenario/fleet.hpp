#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "roads/route_search.hpp"
#include "scenario/call.hpp"

namespace clearway::scenario {

/// From where a call is answered, and on which way.
struct Sending {
    std::size_t station = 0;
    double cost = 0.0;  ///< s, or m in a straight line.
    std::vector<core::EdgeIndex> way = {};
};

/// The units that have not been sent. Each goes once: nobody comes back during a run.
class Fleet {
  public:
    explicit Fleet(std::vector<Station> stations) : stations_(std::move(stations)) {}

    const std::vector<Station>& stations() const { return stations_; }
    bool can_answer(std::size_t station, const PlacedCall& call) const {
        return stations_[station].units > 0 && stations_[station].kind == call.kind;
    }
    void send_from(std::size_t station) { --stations_[station].units; }

    /// Every station that has a unit for the call and leads there, with its fastest way, in the order of the
    /// file. `edge_s` as in roads::RouteSearch; the first edge counts.
    template <class EdgeTime>
    std::vector<Sending> candidates(const PlacedCall& call, roads::RouteSearch& search,
                                    const EdgeTime& edge_s) const {
        std::vector<Sending> found;
        for (std::size_t row = 0; row < stations_.size(); ++row) {
            const core::EdgeIndex from = stations_[row].edge;
            if (!can_answer(row, call)) continue;
            Sending sending{row};
            sending.cost = search.search({from, call.edge, edge_s(from, 0.0)}, edge_s, sending.way);
            if (sending.cost != roads::no_way_s) found.push_back(std::move(sending));
        }
        return found;
    }

  private:
    std::vector<Station> stations_;
};

/// From the start of a station's edge to a call in a straight line, m.
inline double straight_m(const roads::Network& network, const Station& station, const PlacedCall& call) {
    const roads::Point start = network.point_at(network.lane_of(station.edge, 0), core::Metres(0.0));
    const roads::Point end = network.point_at(network.lane_of(call.edge, 0), core::Metres(call.position_m));
    return std::hypot(end.x_m - start.x_m, end.y_m - start.y_m);
}

/// The one with the least cost, the first of equals; nothing of none.
inline const Sending* cheapest(const std::vector<Sending>& candidates) {
    const Sending* best = nullptr;
    for (const Sending& each : candidates)
        if (best == nullptr || each.cost < best->cost) best = &each;
    return best;
}

}  // namespace clearway::scenario
