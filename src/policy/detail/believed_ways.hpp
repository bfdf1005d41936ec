#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/ids.hpp"
#include "policy/detail/view.hpp"
#include "policy/edge_times.hpp"
#include "policy/policy.hpp"
#include "roads/route.hpp"
#include "roads/route_search.hpp"
#include "traffic/belief.hpp"

namespace clearway::policy {
struct NavigateConfig;
}

namespace clearway::policy::detail {

/// A way that an emergency vehicle could take now.
struct OfferedWay {
    std::vector<core::EdgeIndex> edges;  ///< As traffic::TakeRoute has them.
    double time_s = 0.0;                 ///< Believed, from now to the end of the last edge.
    double length_m = 0.0;               ///< From the vehicle to there, across junctions.
    /// Share of the length of its edges, from the vehicle on, that lies on edges of the present way.
    double common_share = 0.0;
};

/// Ways of emergency vehicles by the times that are believed now: of vehicles seen on the roads, of signals
/// by their programs, of incidents that are known. What Navigate, the agent of an environment and policies in
/// Python have in common. Keeps state between beliefs; one thread.
class BelievedWays {
  public:
    /// The network outlives the object. Of the settings it uses those of beliefs, not those of decisions.
    /// Throws core::InputError where they ask for times of other days, and there are none.
    BelievedWays(const PolicyContext& context, const NavigateConfig& config);
    BelievedWays(const BelievedWays&) = delete;
    BelievedWays& operator=(const BelievedWays&) = delete;

    /// Takes the belief of a moment, once every period. Returns whether what is known of incidents has
    /// changed.
    bool see(const traffic::BelievedGraph& belief);

    /// What may still be changed of a vehicle's way.
    struct Choice {
        std::vector<core::EdgeIndex> before;  ///< Edges that stay, from the one entered last on.
        roads::Trip trip;                     ///< From the last of them to the destination.
        roads::Route present;                 ///< The present way of that trip; as valid as the view.
    };
    /// Nothing where no turn is left, or where the way passes its end before it ends there.
    std::optional<Choice> choice_of(const View& view, const traffic::BelievedVehicle& emergency) const;
    /// The edges of a whole way: those that stay, and a way of the trip.
    static std::vector<core::EdgeIndex> whole(const Choice& choice, roads::Route way);

    /// Times of edges on a trip, as a search asks for them. Whoever is called to a closed road goes there.
    auto edge_times_of(const roads::Trip& trip) const {
        return [this, to = trip.to, pace = trip.pace](core::EdgeIndex edge, double entered_s) {
            return edge != to && is_closed(edge) ? roads::no_way_s : open_s(edge, entered_s, pace);
        };
    }
    roads::RouteSearch& search() { return search_; }

    /// Up to `count` ways that the vehicle could take now, the fastest first; at equal times as
    /// roads::RouteSearch::ways finds them. Its present way may be among them. Allocates.
    std::vector<OfferedWay> offers(const View& view, const traffic::BelievedVehicle& emergency,
                                   std::size_t count);

    /// Time along an edge for an emergency vehicle that enters it now and drives at the limit where the road
    /// is free, s; no_way_s where none may drive, inside junctions, and where a known incident closes it.
    double now_s(core::EdgeIndex edge) const {
        return is_closed(edge) ? roads::no_way_s : open_s(edge, 0.0, 1.0);
    }

  private:
    /// Each vehicle on the road that its own is taken for.
    void see_spoiled(const traffic::BelievedGraph& belief);
    bool is_closed(core::EdgeIndex edge) const { return traffic::closes(known_, edge); }
    /// Past an incident that leaves a lane open, no faster than its limit.
    double open_s(core::EdgeIndex edge, double entered_s, double pace) const;
    OfferedWay offer(const View& view, const traffic::BelievedVehicle& emergency, const Choice& choice,
                     roads::Route way) const;

    const roads::Network& network_;
    core::Seconds period_;
    bool observes_, heeds_incidents_;
    std::vector<core::EdgeIndex> taken_for_;  ///< By edge; empty: each for itself.
    roads::RouteSearch search_;
    EdgeTimes times_;
    std::vector<traffic::KnownIncident> known_;  ///< Of the last belief.
};

}  // namespace clearway::policy::detail
