#pragma once

#include <cstdint>

#include "core/spellings.hpp"

namespace clearway::traffic {

/// Why a lease is not carried out now, by the alphabet, as in tables. It is judged again at every step until
/// it expires, unless it can never be carried out or its target is gone.
enum class Refusal : std::uint8_t {
    above_allowed_speed,       ///< Faster than the road limit or the vehicle allows.
    cannot_stop_comfortably,   ///< The stop needs more than the vehicle's usual deceleration.
    closed,                    ///< A way over a road that is known to be closed.
    exit_phase,                ///< The signal has an exit phase of its own (traffic::Preemption).
    expired_on_arrival,        ///< Never legal.
    hold_cap,                  ///< The hold lasted as long as holds may.
    lane_does_not_continue,    ///< Neither a best lane for the route nor drivable for over 300 m.
    lane_not_allowed,          ///< The lane is closed to this vehicle.
    lockout,                   ///< The signal's own program runs for a while between holds.
    no_links,                  ///< Never legal: a request for green that names no link.
    no_phase_serves,           ///< No phase of the program shows green for any of the links.
    no_room_beside,            ///< The vehicle itself would not change lanes now.
    no_such_edge,              ///< Never legal.
    no_such_lane,              ///< The edge has fewer lanes.
    no_such_link,              ///< Never legal.
    no_such_signal,            ///< Never legal.
    not_an_emergency_vehicle,  ///< Only emergency vehicles pass red and are sent other ways.
    not_controllable,          ///< Human drivers follow no leases unless they comply.
    on_a_junction,             ///< There are no lanes to choose from, and no stop line.
    outdated,                  ///< A newer request was there before it.
    outranked,                 ///< Another lease for the same target goes first.
    own_link_not_held,         ///< Never legal: own links that are not among those to hold.
    past_decision,             ///< Too near the junction to take another way there.
    preemption_delay,          ///< The signal's controller waits before it grants (traffic::Preemption).
    preemption_off,            ///< The signal's controller grants nothing.
    priority,                  ///< Below the least priority of the signal's controller.
    route_elsewhere,           ///< A way that does not begin where the vehicle is, or ends elsewhere.
    route_gap,                 ///< A way whose edges do not follow each other for an emergency vehicle.
    signal_gone,               ///< SUMO no longer has the signal.
    speed_negative,            ///< Never legal.
    speed_not_finite,          ///< Never legal.
    stood_back,                ///< The policy itself: the situation is not one that it is for.
    unheard,                   ///< The message with the request was lost.
    unknown_program,  ///< The signal runs a program other than its initial one, or SUMO's controller NEMA.
    unreachable,      ///< Commands do not reach the vehicle now.
    vehicle_does_not_answer,  ///< The simulator told nothing of it.
    vehicle_gone,             ///< Not on the road (any more).
    wrong_target,             ///< Never legal: a signal cannot drive, a vehicle shows no green.
};
constexpr core::Spellings<Refusal, 38> spellings(Refusal) {
    using R = Refusal;
    return {{{R::above_allowed_speed, "above_allowed_speed"},
             {R::cannot_stop_comfortably, "cannot_stop_comfortably"},
             {R::closed, "closed"},
             {R::exit_phase, "exit_phase"},
             {R::expired_on_arrival, "expired_on_arrival"},
             {R::hold_cap, "hold_cap"},
             {R::lane_does_not_continue, "lane_does_not_continue"},
             {R::lane_not_allowed, "lane_not_allowed"},
             {R::lockout, "lockout"},
             {R::no_links, "no_links"},
             {R::no_phase_serves, "no_phase_serves"},
             {R::no_room_beside, "no_room_beside"},
             {R::no_such_edge, "no_such_edge"},
             {R::no_such_lane, "no_such_lane"},
             {R::no_such_link, "no_such_link"},
             {R::no_such_signal, "no_such_signal"},
             {R::not_an_emergency_vehicle, "not_an_emergency_vehicle"},
             {R::not_controllable, "not_controllable"},
             {R::on_a_junction, "on_a_junction"},
             {R::outdated, "outdated"},
             {R::outranked, "outranked"},
             {R::own_link_not_held, "own_link_not_held"},
             {R::past_decision, "past_decision"},
             {R::preemption_delay, "preemption_delay"},
             {R::preemption_off, "preemption_off"},
             {R::priority, "priority"},
             {R::route_elsewhere, "route_elsewhere"},
             {R::route_gap, "route_gap"},
             {R::signal_gone, "signal_gone"},
             {R::speed_negative, "speed_negative"},
             {R::speed_not_finite, "speed_not_finite"},
             {R::stood_back, "stood_back"},
             {R::unheard, "unheard"},
             {R::unknown_program, "unknown_program"},
             {R::unreachable, "unreachable"},
             {R::vehicle_does_not_answer, "vehicle_does_not_answer"},
             {R::vehicle_gone, "vehicle_gone"},
             {R::wrong_target, "wrong_target"}}};
}
using core::name;

}  // namespace clearway::traffic
