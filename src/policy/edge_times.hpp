#pragma once

#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "roads/network.hpp"
#include "roads/route_search.hpp"
#include "traffic/belief.hpp"

namespace clearway::policy {

/// How times are believed.
struct EdgeTimesConfig {
    double fade_s = 120.0;      ///< Time constant with which what was seen fades, > 0.
    double prior_s = 10.0;      ///< Weight of the prior, as time of vehicles on the edge, > 0.
    double signal_share = 1.0;  ///< Share of the delay before a signal that counts.
    bool are_asked = false;     ///< Signals are asked for green before emergency vehicles arrive.
    /// What an edge usually takes, s, by core::EdgeIndex, 0 where that is not known; empty: for none. Used by
    /// the constructor alone.
    std::span<const double> mean_times_s = {};
};

/// Believed times along edges. The speed on an edge is the distance over the time of the vehicles that are
/// seen there (Edie 1963), both fading exponentially, with a prior: what the edge usually takes, or, where
/// that is not known, the limit, and before a signal the mean wait of its program (red^2 / (2 cycle), Webster
/// 1958, without its random terms). A signal that is asked is waited for only until it has changed and what
/// stands before it has left.
class EdgeTimes {
  public:
    /// Network and search outlive the object.
    EdgeTimes(const roads::Network& network, const roads::RouteSearch& search, const EdgeTimesConfig& config);

    /// Takes what is believed of vehicles other than emergency vehicles for one `period`.
    void see(const traffic::BelievedGraph& belief, core::Seconds period);
    /// The same vehicle by vehicle: the time, then each on its lane.
    void turn_to(core::Seconds now) { now_s_ = now.value; }
    void add(core::LaneIndex lane, float speed_mps, core::Seconds period);

    /// Time along an edge that is entered `entered_s` from the last `see`, for somebody who drives `pace`
    /// times the limit where the road is free, s. Never below that; FIFO in `entered_s`.
    double at(core::EdgeIndex edge, double entered_s, double pace) const;

  private:
    /// Fading sums of an edge.
    struct Seen {
        double time_s = 0.0;
        double distance_m = 0.0;
        double at_s = 0.0;  ///< When they were last brought up to date.
    };
    double fading(double lasting_s) const;
    double ready_s(core::EdgeIndex edge, double vehicle_s) const;
    double mean_wait_s(core::EdgeIndex index) const;

    const roads::Network& network_;
    const roads::RouteSearch& search_;
    EdgeTimesConfig config_;
    std::vector<double> length_m_;
    std::vector<double> usual_delay_s_;  ///< By edge: against the limit, before anything is seen.
    std::vector<bool> signal_;           ///< By edge: whether it ends at one.
    std::vector<Seen> seen_;
    double now_s_ = 0.0;
};

}  // namespace clearway::policy
