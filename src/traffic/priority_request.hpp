#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.hpp"
#include "core/spellings.hpp"
#include "core/units.hpp"
#include "traffic/observation.hpp"

namespace clearway::traffic {

/// What a message does to a request (J2735 PriorityRequestType).
enum class RequestType : std::uint8_t { request, update, cancellation };
constexpr core::Spellings<RequestType, 3> spellings(RequestType) {
    return {{{RequestType::request, "priorityRequest"},
             {RequestType::update, "priorityRequestUpdate"},
             {RequestType::cancellation, "priorityCancellation"}}};
}

/// What a signal answers to a request: J2735's PrioritizationResponseStatus, of which an SSM has one for each
/// open request. ETSI's twin is the SSEM (TS 103 301).
enum class RequestStatus : std::uint8_t {
    requested,            ///< Heard; nothing is done about it yet.
    processing,           ///< In transition, or behind another request.
    watch_other_traffic,  ///< Green, but a way of the requestor has to yield.
    granted,              ///< Green.
    rejected,             ///< The signal cannot show the green, or runs a program that is not known.
    max_presence,         ///< The longest hold is over.
    reservice_locked,     ///< Too soon after the last one.
};
inline constexpr std::size_t request_status_count = 7;
constexpr core::Spellings<RequestStatus, request_status_count> spellings(RequestStatus) {
    return {{{RequestStatus::requested, "requested"},
             {RequestStatus::processing, "processing"},
             {RequestStatus::watch_other_traffic, "watchOtherTraffic"},
             {RequestStatus::granted, "granted"},
             {RequestStatus::rejected, "rejected"},
             {RequestStatus::max_presence, "maxPresence"},
             {RequestStatus::reservice_locked, "reserviceLocked"}}};
}
using core::name;

/// Role of the requestor (J2735 BasicVehicleRole): all emergency vehicles of a run have this one.
inline constexpr const char* requestor_role = "emergency";
/// Highest level of J2735's RequestImportanceLevel: a life is at stake.
inline constexpr int highest_importance = 14;

/// One request of an emergency vehicle to one signal, in content that of a SignalRequestPackage of SAE
/// J2735's SRM with its RequestorDescription; ETSI's twin is the SREM (TS 103 301). Times are simulation
/// times instead of minutes of the year.
struct PriorityRequest {
    core::VehicleKey vehicle;      ///< Requestor.
    core::SignalIndex signal;      ///< Intersection.
    std::uint32_t request_id = 0;  ///< Of the vehicle: each approach to a signal gets the next number.
    std::uint32_t sequence = 0;    ///< Of the vehicle's messages.
    RequestType type = RequestType::request;
    int importance = highest_importance;
    core::EdgeIndex edge_in;  ///< Approach from which the vehicle comes in, and that to which it goes out.
    core::EdgeIndex edge_out;
    std::vector<std::uint16_t> connections;  ///< Links of the signal between them, ascending.
    double distance_m = 0.0;                 ///< From the vehicle's front to the stop line.
    core::Seconds eta;                       ///< Estimated time of arrival at the stop line.
    core::Seconds window;                    ///< The vehicle may come this much later (J2735: duration).
    core::Seconds sent;                      ///< When place and speed were measured.
    MotionState motion;                      ///< Place, heading and speed of the vehicle at `sent`.
};

}  // namespace clearway::traffic
