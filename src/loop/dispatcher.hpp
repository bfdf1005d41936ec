#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/ids.hpp"
#include "core/units.hpp"
#include "experiment/condition.hpp"
#include "loop/trials.hpp"
#include "metrics/dispatch_counts.hpp"
#include "policy/edge_times.hpp"
#include "roads/route_search.hpp"
#include "scenario/fleet.hpp"
#include "scenario/incident.hpp"
#include "traffic/belief.hpp"
#include "traffic/departure.hpp"
#include "truth/snapshot.hpp"

namespace clearway::loop {

class ClosedLoop;

/// What a dispatcher is to do.
struct DispatchOrders {
    experiment::Dispatch by = experiment::Dispatch::free_flow;
    scenario::Calls calls;
    std::vector<scenario::PlacedIncident> incidents;
    /// The vehicles that may be sent, each with the call that it answers.
    std::vector<traffic::EmergencyDeparture> vehicles = {};
    core::Seconds period{0.5};          ///< Between two decisions, and two looks at the truth.
    int units_tried = 0;                ///< See experiment::LoopConfig.
    std::filesystem::path folder = {};  ///< For copies of the run; removed.
};

/// Answers the calls of a scenario: decides, when a call comes in, from which stations vehicles go, and gives
/// each the way by which it was chosen. In a straight line and by free flow nothing of the traffic is asked;
/// by believed and by true times, those of policy::EdgeTimes, and incidents that are known, or that last.
///
/// With `units_tried`, units of stations that the choice leaves out are driven to the call in copies of the
/// run, whose future is the true one, in place of the last one sent; what the first of all would have saved
/// is the regret of the choice, of several units by their order of arrival.
class Dispatcher {
  public:
    /// The network outlives it.
    Dispatcher(const roads::Network& network, DispatchOrders orders);

    /// Whether somebody must believe something for it.
    bool reads_belief() const { return orders_.by == experiment::Dispatch::believed; }
    /// Takes the belief of a decision.
    void see(const traffic::BelievedGraph& belief);
    /// After each step of `loop`: sends vehicles to the calls that have come in. Throws as `in_copy` and
    /// sumo::Session do.
    void step(ClosedLoop& loop, core::Seconds horizon);
    /// From now on no unit is tried: in a copy of the run, which tries one already.
    void try_none() { orders_.units_tried = 0; }
    /// Whether a call is still to come.
    bool is_waiting() const { return next_call_ < orders_.calls.calls.size(); }
    /// Once the run is over; a vehicle that did not arrive counts with `horizon`.
    metrics::DispatchCounts result(core::Seconds horizon) const;

  private:
    void note(const truth::Snapshot& snapshot);
    std::vector<scenario::Sending> candidates(const scenario::PlacedCall& call);
    void answer(ClosedLoop& loop, core::Seconds horizon);
    void try_units(ClosedLoop& loop, core::Seconds horizon, const scenario::Sending& chosen,
                   std::vector<scenario::Sending> others);
    /// The same stations on their ways by free flow, where these are others: one yardstick for all rules.
    void add_free_ways(const scenario::PlacedCall& call, std::vector<scenario::Sending>& others);
    void send(ClosedLoop& loop, const scenario::Sending& sending);
    bool is_closed(core::EdgeIndex edge) const;

    const roads::Network& network_;
    DispatchOrders orders_;
    scenario::Fleet fleet_;
    roads::RouteSearch search_;
    policy::EdgeTimes times_;
    std::vector<traffic::KnownIncident> known_;
    std::size_t next_call_ = 0;
    std::uint32_t next_unit_ = 0;
    core::Seconds now_, noted_;
    metrics::DispatchCounts counts_;
    Trials trials_;
};

}  // namespace clearway::loop
