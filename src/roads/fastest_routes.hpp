#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "roads/detail/search.hpp"
#include "roads/network.hpp"

namespace clearway::roads {

/// The fastest routes for cars by free-flow travel time, time across junctions included. A* on edges (Hart,
/// Nilsson and Raphael 1968); of equally fast ways before an edge, that from the edge with the lowest index
/// is taken, so the answers are those of Dijkstra (1959) and do not depend on the order of the search. After
/// the first search only the routes are allocated. Keeps a reference to the network; one thread.
class FastestRoutes {
  public:
    explicit FastestRoutes(const Network& network);

    /// `from` and `to` included; nothing when `to` cannot be reached or one of the two is closed to cars.
    std::optional<std::vector<core::EdgeIndex>> between(core::EdgeIndex from, core::EdgeIndex to);

  private:
    /// A way from the end of an edge to the end of the next.
    struct Way {
        core::EdgeIndex to;
        std::uint32_t first_inner = 0, inner_count = 0;  ///< Times across the junction, in inner_s_.
    };
    struct Label {
        double arrival_s = unreachable_s;
        double rest_s = 0.0;  ///< At least, to the end of the destination.
        core::EdgeIndex before;
        std::uint64_t search = 0;  ///< That it belongs to.
    };

    void add_ways_from(core::EdgeIndex index);
    void add_way(const Connection& connection);
    std::span<const Way> ways_from(core::EdgeIndex edge) const;
    std::span<const double> inner_s(const Way& way) const;
    double least_pace() const;
    double distance_m(core::EdgeIndex from, core::EdgeIndex to) const;
    Label& label(core::EdgeIndex edge, core::EdgeIndex destination);
    void relax(core::EdgeIndex from, const Way& way, core::EdgeIndex destination);
    std::vector<core::EdgeIndex> path_to(core::EdgeIndex to) const;

    static constexpr double unreachable_s = std::numeric_limits<double>::infinity();

    const Network& network_;
    std::vector<double> edge_s_;  ///< By edge: least time along it on a lane open to cars.
    std::vector<Way> ways_;
    std::vector<std::uint32_t> first_way_;  ///< By edge.
    std::vector<double> inner_s_;
    double pace_s_per_m_ = 0.0;  ///< No way gets nearer to a place, as the crow flies, in less time.
    std::vector<Label> labels_;
    detail::LeastFirst queue_;  ///< By the least time at the destination.
    std::uint64_t searches_ = 0;
};

}  // namespace clearway::roads
