#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "roads/detail/search.hpp"
#include "roads/exits.hpp"
#include "roads/network.hpp"

namespace clearway::roads {

/// A trip that is to be found a way for: by somebody who leaves the end of `from` at `leaving_s` from now,
/// and drives up to `pace` times the limit.
struct Trip {
    core::EdgeIndex from;
    core::EdgeIndex to;
    double leaving_s = 0.0;
    double pace = 1.0;  ///< At least 1.
};

/// Whether a way passes its last edge before it ends there, so that a search to that edge would cut it short.
inline bool passes_its_end(std::span<const core::EdgeIndex> way) {
    return std::ranges::count(way, way.back()) > 1;
}

/// What a search answers that found no way.
inline constexpr double no_way_s = std::numeric_limits<double>::infinity();

/// Fastest ways where the time of an edge depends on when it is entered. A* forward over edges, bounded by
/// one backward tree of free-flow times per destination (Hart, Nilsson and Raphael 1968). Exact where a later
/// entry never leaves an edge earlier (FIFO) and no edge is faster than free flow. Turns and permissions are
/// those of the network's connections. After the first search to a destination nothing is allocated but the
/// way itself. Keeps a reference to the network; one thread.
class RouteSearch {
  public:
    RouteSearch(const Network& network, Driver driver);

    /// Time along an edge at the limit of its fastest lane that is open to the driver, s; `no_way_s` where
    /// none is.
    double free_s(core::EdgeIndex edge) const { return free_s_[edge.value]; }

    /// The fastest way of a trip: `way` gets the edges from its first to its last one. Returns when the end
    /// of the last one is reached, s from now; `no_way_s`, and an empty way, if it cannot be. `edge_s(edge,
    /// entered_s)` is the time along an edge that is entered then, at least `free_s` / pace, `no_way_s` for a
    /// closed one.
    template <class EdgeTime>
    double search(const Trip& trip, const EdgeTime& edge_s, std::vector<core::EdgeIndex>& way);

    /// When the end of a way is reached, s from now, by somebody who leaves its first edge at `leaving_s`;
    /// `no_way_s` if its edges do not follow each other.
    template <class EdgeTime>
    double time_of(std::span<const core::EdgeIndex> way, double leaving_s, const EdgeTime& edge_s) const;

    /// Up to `count` different ways, the fastest first, each found where edges of those before it take
    /// `again` times as long: the penalty method (de la Barra and others 1993). `edge_s` as in `search`.
    template <class EdgeTime>
    std::vector<std::vector<core::EdgeIndex>> ways(const Trip& trip, const EdgeTime& edge_s,
                                                   std::size_t count, double again = 1.4);

  private:
    struct Arc {
        core::EdgeIndex to;
        double inner_s = 0.0;  ///< Across the junction.
    };
    struct Label {
        double leaves_s = no_way_s;
        core::EdgeIndex before;
        std::uint64_t search = 0;  ///< That it belongs to.
    };

    std::span<const Arc> arcs_from(core::EdgeIndex edge) const {
        return std::span(arcs_).subspan(first_arc_[edge.value],
                                        first_arc_[edge.value + 1] - first_arc_[edge.value]);
    }
    const Arc* arc(core::EdgeIndex from, core::EdgeIndex to) const;
    /// By edge: least time from its end to the end of the destination, s.
    const std::vector<double>& bounds_to(core::EdgeIndex destination);
    void begin();
    Label& label(core::EdgeIndex edge);
    double finish(core::EdgeIndex to, std::vector<core::EdgeIndex>& way) const;

    std::vector<double> free_s_;
    std::vector<Arc> arcs_;
    std::vector<std::uint32_t> first_arc_;
    std::map<core::EdgeIndex, std::vector<double>> bounds_;
    std::vector<Label> labels_;
    detail::LeastFirst queue_;  ///< By the least time at the destination.
    std::uint64_t searches_ = 0;
};

template <class EdgeTime>
double RouteSearch::search(const Trip& trip, const EdgeTime& edge_s, std::vector<core::EdgeIndex>& way) {
    way.clear();
    const std::vector<double>& bounds = bounds_to(trip.to);
    if (bounds[trip.from.value] == no_way_s) return no_way_s;
    begin();
    label(trip.from).leaves_s = trip.leaving_s;
    queue_.push(trip.leaving_s + bounds[trip.from.value] / trip.pace, trip.from);
    while (!queue_.empty()) {
        const auto [at_least_s, row] = queue_.pop();
        const core::EdgeIndex edge{row};
        const double leaves_s = label(edge).leaves_s;
        if (at_least_s > leaves_s + bounds[row] / trip.pace) continue;  // a better one was there before
        if (edge == trip.to) return finish(trip.to, way);
        for (const Arc& arc : arcs_from(edge)) {
            if (bounds[arc.to.value] == no_way_s) continue;
            const double entered_s = leaves_s + arc.inner_s;
            const double left_s = entered_s + edge_s(arc.to, entered_s);
            Label& known = label(arc.to);
            if (left_s >= known.leaves_s) continue;
            known.leaves_s = left_s;
            known.before = edge;
            queue_.push(left_s + bounds[arc.to.value] / trip.pace, arc.to);
        }
    }
    return no_way_s;
}

template <class EdgeTime>
double RouteSearch::time_of(std::span<const core::EdgeIndex> way, double leaving_s,
                            const EdgeTime& edge_s) const {
    double now_s = way.empty() ? no_way_s : leaving_s;
    for (std::size_t i = 1; i < way.size(); ++i) {
        const Arc* const onward = arc(way[i - 1], way[i]);
        if (onward == nullptr) return no_way_s;
        now_s += onward->inner_s;
        now_s += edge_s(way[i], now_s);
    }
    return now_s;
}

template <class EdgeTime>
std::vector<std::vector<core::EdgeIndex>> RouteSearch::ways(const Trip& trip, const EdgeTime& edge_s,
                                                            std::size_t count, double again) {
    std::vector<std::vector<core::EdgeIndex>> found;
    std::map<core::EdgeIndex, double> penalty;
    const auto penalised = [&](core::EdgeIndex edge, double entered_s) {
        const auto known = penalty.find(edge);
        return edge_s(edge, entered_s) * (known == penalty.end() ? 1.0 : known->second);
    };
    std::vector<core::EdgeIndex> way;
    const std::size_t most_searches = 3 * count;
    for (std::size_t tries = 0; tries < most_searches && found.size() < count; ++tries) {
        if (search(trip, penalised, way) == no_way_s) break;
        if (std::ranges::find(found, way) == found.end()) found.push_back(way);
        for (const core::EdgeIndex edge : way)
            penalty.try_emplace(edge, 1.0).first->second *= again;
    }
    return found;
}

}  // namespace clearway::roads
