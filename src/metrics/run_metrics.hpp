#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "metrics/incident_counts.hpp"
#include "metrics/lease_row.hpp"
#include "metrics/signal_event.hpp"
#include "metrics/traffic_tables.hpp"
#include "metrics/tried_choices.hpp"
#include "metrics/vehicle_row.hpp"
#include "traffic/request_counts.hpp"

namespace clearway::metrics {

/// Believed links against true ones, counted over the report rounds with a decision.
struct LinkCounts {
    std::uint64_t true_positive = 0;
    std::uint64_t false_positive = 0;
    std::uint64_t false_negative = 0;

    bool operator==(const LinkCounts&) const = default;
    /// Each is empty where its denominator is 0.
    std::optional<double> precision() const;
    std::optional<double> recall() const;
    std::optional<double> f1() const;
};

/// What became of the leases and commands of a run. `refused` counts leases, not reasons.
struct LeaseTotals {
    std::uint64_t issued = 0;  ///< New leases, including refused ones; without renewals.
    std::uint64_t renewed = 0;
    std::uint64_t refused = 0;
    std::uint64_t expired = 0;
    std::vector<LeaseRow> rows = {};     ///< The same by policy and action.
    std::uint64_t commands_skipped = 0;  ///< To vehicles that had left the road.
    std::uint64_t commands_refused = 0;  ///< To stop, when that was no longer possible.
    traffic::RequestCounts requests = {};
    traffic::SignalRequestCounts signal_requests = {};
    traffic::HeldGreenCounts greens = {};
    TriedChoices ways = {};
    TriedChoices holds = {};

    bool operator==(const LeaseTotals&) const = default;
};

/// The numbers of one run. The restricted mean travel time is over all emergency vehicles of the demand.
/// Other means of travel time, and the time loss of emergency vehicles, are over vehicles that arrived. Means
/// of waiting time and depart delay, and the time loss of others, are over all vehicles that were inserted,
/// so vehicles still on the road count with what they lost so far. The counts next to the means tell how many
/// were left out. Empty where there was no vehicle to average over.
struct RunMetrics {
    std::optional<double> emergency_restricted_travel_time_s;
    std::optional<double> emergency_travel_time_s;
    std::optional<double> emergency_time_loss_s;
    std::optional<double> emergency_waiting_time_s;
    std::optional<double> emergency_depart_delay_s;
    std::optional<double> depart_delay_s;
    std::optional<double> others_depart_delay_s;
    std::optional<double> waiting_time_s;
    std::optional<double> others_travel_time_s;
    std::optional<double> others_time_loss_s;
    std::optional<double> others_waiting_time_s;

    std::uint64_t emergency_count = 0;
    std::uint64_t emergency_arrived = 0;
    std::uint64_t vehicle_count = 0;
    std::uint64_t arrived = 0;
    std::uint64_t unfinished = 0;
    std::uint64_t not_inserted = 0;
    std::uint64_t removed = 0;
    std::uint64_t teleports = 0;
    std::uint64_t collisions = 0;
    std::uint64_t junction_collisions = 0;
    std::uint64_t emergency_collisions = 0;
    std::uint64_t emergency_junction_collisions = 0;
    std::uint64_t emergency_brakings = 0;
    std::uint64_t pedestrian_count = 0;
    std::uint64_t pedestrians_unfinished = 0;
    std::optional<double> pedestrian_time_loss_s;
    std::uint64_t pedestrian_collisions = 0;
    std::uint64_t emergency_pedestrian_collisions = 0;

    // From the fork of the conditions on.
    std::uint64_t locks = 0;
    std::uint64_t locked_vehicles = 0;
    std::uint64_t locked_emergency_vehicles = 0;
    double locked_vehicle_s = 0.0;
    double longest_lock_s = 0.0;
    std::optional<double> emergency_least_ttc_s;
    std::uint64_t emergency_conflicts = 0;
    std::optional<double> emergency_greatest_drac_mps2;
    std::uint64_t emergency_red_passages = 0;
    std::uint64_t others_red_passages = 0;
    std::uint64_t others_hard_brakings = 0;
    std::optional<double> others_jerk_mps3;
    std::optional<double> signal_throughput_per_hour;
    std::optional<double> signal_queue_vehicles;
    std::optional<double> signal_longest_queue_vehicles;
    std::optional<double> worst_approach_delay_s;
    std::optional<double> cross_street_delay_s;
    double vehicle_km = 0.0;  ///< Of the whole run.

    // From the event logs of the signals.
    std::uint64_t signal_calls = 0;
    std::uint64_t signal_calls_granted = 0;
    std::optional<double> signal_entry_delay_s;
    std::optional<double> signal_time_to_service_s;
    std::optional<double> signal_dwell_s;
    std::optional<double> signal_recovery_s;

    std::uint64_t leases_issued = 0;
    std::uint64_t leases_renewed = 0;
    std::uint64_t leases_refused = 0;
    std::uint64_t leases_expired = 0;
    std::uint64_t commands_skipped = 0;
    std::uint64_t commands_refused = 0;

    std::uint64_t way_decisions = 0;
    std::uint64_t way_decisions_best = 0;
    std::uint64_t ways_tried = 0;
    std::optional<double> way_regret_s;
    std::uint64_t hold_decisions = 0;
    std::uint64_t hold_decisions_best = 0;
    std::uint64_t holds_tried = 0;
    std::optional<double> hold_regret_s;

    std::uint64_t units_sent = 0;
    std::uint64_t units_missing = 0;
    std::uint64_t unit_decisions = 0;
    std::optional<double> wrong_unit_share;
    std::optional<double> unit_regret_s;

    std::uint64_t emergency_met_incident = 0;
    std::uint64_t emergency_turned_round = 0;
    std::uint64_t emergency_cut_off = 0;
    std::uint64_t others_rerouted = 0;
    std::optional<double> incident_delay_s;

    std::uint64_t requests_sent = 0;
    std::uint64_t requests_heard = 0;
    std::uint64_t requests_relayed = 0;
    std::uint64_t requests_needed = 0;
    std::uint64_t requests_useless = 0;
    std::uint64_t requests_missed = 0;
    std::uint64_t request_messages = 0;
    std::uint64_t vehicles_asked = 0;
    std::uint64_t signal_requests_sent = 0;
    std::uint64_t signal_requests_heard = 0;
    std::uint64_t signal_request_messages = 0;
    std::uint64_t signal_request_updates = 0;
    std::uint64_t signal_request_cancellations = 0;
    std::uint64_t signal_answers_sent = 0;
    std::uint64_t signal_answers_heard = 0;
    std::uint64_t signal_told_requested = 0;
    std::uint64_t signal_told_processing = 0;
    std::uint64_t signal_told_watch_other_traffic = 0;
    std::uint64_t signal_told_granted = 0;
    std::uint64_t signal_told_rejected = 0;
    std::uint64_t signal_told_max_presence = 0;
    std::uint64_t signal_told_reservice_locked = 0;
    std::optional<double> signal_granted_after_s;
    std::uint64_t held_greens = 0;
    std::uint64_t held_greens_useless = 0;
    double held_greens_useless_s = 0.0;

    std::uint64_t links_true_positive = 0;
    std::uint64_t links_false_positive = 0;
    std::uint64_t links_false_negative = 0;
    std::optional<double> links_f1;
    std::uint64_t dark_links_true_positive = 0;
    std::uint64_t dark_links_false_positive = 0;
    std::uint64_t dark_links_false_negative = 0;
    std::optional<double> dark_links_f1;

    double simulated_s = 0.0;
    std::uint64_t vehicle_steps = 0;

    bool operator==(const RunMetrics&) const = default;

  private:
    static constexpr void travel_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        table(Field{"emergency_restricted_travel_time_s", "s", &M::emergency_restricted_travel_time_s, 0.0,
                    1e9, "EV travel time, mean of all; an EV that did not arrive counts with the horizon",
                    "tripinfo duration; Royston and Parmar 2013"},
              Field{"emergency_travel_time_s", "s", &M::emergency_travel_time_s, 0.0, 1e9,
                    "EV travel time, mean of those that arrived", "tripinfo duration"},
              Field{"emergency_time_loss_s", "s", &M::emergency_time_loss_s, 0.0, 1e9,
                    "EV time loss, mean of those that arrived", "tripinfo timeLoss"},
              Field{"emergency_waiting_time_s", "s", &M::emergency_waiting_time_s, 0.0, 1e9,
                    "EV waiting time, mean of those inserted", "tripinfo waitingTime; TABLES II to IV"},
              Field{"emergency_depart_delay_s", "s", &M::emergency_depart_delay_s, 0.0, 1e9,
                    "EV depart delay, mean of those inserted", "tripinfo departDelay; TABLES II to IV"},
              Field{"depart_delay_s", "s", &M::depart_delay_s, 0.0, 1e9,
                    "Depart delay of all vehicles, mean of those inserted", "tripinfo departDelay"},
              Field{"others_depart_delay_s", "s", &M::others_depart_delay_s, 0.0, 1e9,
                    "Depart delay of all but the EVs, mean of those inserted", "tripinfo departDelay"},
              Field{"waiting_time_s", "s", &M::waiting_time_s, 0.0, 1e9,
                    "Waiting time of all vehicles, mean of those inserted",
                    "tripinfo waitingTime, and stops that a policy commanded; TABLES II to IV"},
              Field{"others_travel_time_s", "s", &M::others_travel_time_s, 0.0, 1e9,
                    "Travel time of all but the EVs, mean of those that arrived", "tripinfo duration"},
              Field{"others_time_loss_s", "s", &M::others_time_loss_s, 0.0, 1e9,
                    "Time loss of all but the EVs, mean of those inserted",
                    "tripinfo timeLoss, and stops that a policy commanded"},
              Field{"others_waiting_time_s", "s", &M::others_waiting_time_s, 0.0, 1e9,
                    "Waiting time of all but the EVs, mean of those inserted",
                    "tripinfo waitingTime, and stops that a policy commanded"},
              Field{"emergency_count", "1", &M::emergency_count, 0.0, 1e9, "EVs of the demand", "demand"},
              Field{"emergency_arrived", "1", &M::emergency_arrived, 0.0, 1e9,
                    "EVs that arrived without a teleport", "tripinfo"},
              Field{"vehicle_count", "1", &M::vehicle_count, 0.0, 1e9, "Vehicles of the demand", "demand"},
              Field{"arrived", "1", &M::arrived, 0.0, 1e9, "Vehicles that arrived without a teleport",
                    "tripinfo"},
              Field{"unfinished", "1", &M::unfinished, 0.0, 1e9, "Vehicles still on the road at the end",
                    "tripinfo"},
              Field{"not_inserted", "1", &M::not_inserted, 0.0, 1e9, "Vehicles that never departed",
                    "demand less tripinfo"},
              Field{"removed", "1", &M::removed, 0.0, 1e9, "Vehicles removed before they arrived",
                    "tripinfo vaporized"});
    }
    static constexpr void safety_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        table(
            Field{"teleports", "1", &M::teleports, 0.0, 1e9, "Teleports", "events"},
            Field{"locks", "1", &M::locks, 0.0, 1e9,
                  "Locks: places where vehicles stood over 60 s with no red, no stop and no queue to a red "
                  "ahead",
                  "docs/reference/metrics.md"},
            Field{"locked_vehicles", "1", &M::locked_vehicles, 0.0, 1e9, "Vehicles that stood in a lock",
                  "docs/reference/metrics.md"},
            Field{"locked_emergency_vehicles", "1", &M::locked_emergency_vehicles, 0.0, 1e9,
                  "EVs that stood in a lock", "docs/reference/metrics.md"},
            Field{"locked_vehicle_s", "s", &M::locked_vehicle_s, 0.0, 1e12,
                  "Time that vehicles stood in locks, summed over vehicles", "docs/reference/metrics.md"},
            Field{"longest_lock_s", "s", &M::longest_lock_s, 0.0, 1e9, "Duration of the longest lock",
                  "docs/reference/metrics.md"},
            Field{"collisions", "1", &M::collisions, 0.0, 1e9, "Collisions, on lanes and at junctions",
                  "events"},
            Field{"junction_collisions", "1", &M::junction_collisions, 0.0, 1e9, "Collisions at junctions",
                  "events"},
            Field{"emergency_collisions", "1", &M::emergency_collisions, 0.0, 1e9,
                  "Collisions that involve an EV", "events"},
            Field{"emergency_junction_collisions", "1", &M::emergency_junction_collisions, 0.0, 1e9,
                  "Collisions at junctions that involve an EV", "events"},
            Field{"emergency_brakings", "1", &M::emergency_brakings, 0.0, 1e9,
                  "Braking events at a type's emergency deceleration (9 m/s2, trucks and buses 7)", "events"},
            Field{"emergency_least_ttc_s", "s", &M::emergency_least_ttc_s, 0.0, 1e9,
                  "Minimum time to collision of vehicles that follow each other within 100 m of an EV",
                  "SSAM's TTC"},
            Field{"emergency_conflicts", "1", &M::emergency_conflicts, 0.0, 1e9,
                  "How often that time fell below 1.5 s", "SSAM's TTC"},
            Field{"emergency_greatest_drac_mps2", "m/s2", &M::emergency_greatest_drac_mps2, 0.0, 1e9,
                  "Greatest deceleration needed to avoid a crash there", "SSAM's DRAC"},
            Field{"emergency_red_passages", "1", &M::emergency_red_passages, 0.0, 1e9,
                  "Stop lines that EVs passed on red", "lanes and signal states"},
            Field{"others_red_passages", "1", &M::others_red_passages, 0.0, 1e9,
                  "Stop lines that other vehicles passed on red", "lanes and signal states"},
            Field{"others_hard_brakings", "1", &M::others_hard_brakings, 0.0, 1e9,
                  "Braking events of other vehicles above 3.4 m/s2", "AASHTO's comfortable deceleration"},
            Field{"others_jerk_mps3", "m/s3", &M::others_jerk_mps3, 0.0, 1e9,
                  "Jerk of other vehicles, root mean square over steps", "change of acceleration by step"},
            Field{"signal_throughput_per_hour", "1/h", &M::signal_throughput_per_hour, 0.0, 1e9,
                  "Vehicles per hour past the stop lines of signals, while demand departs", "lanes"},
            Field{"signal_queue_vehicles", "1", &M::signal_queue_vehicles, 0.0, 1e9,
                  "Vehicles standing on an approach to a signal, mean while demand departs",
                  "speed below 0.1 m/s"},
            Field{"signal_longest_queue_vehicles", "1", &M::signal_longest_queue_vehicles, 0.0, 1e9,
                  "Most vehicles standing on one approach to a signal at once", "speed below 0.1 m/s"},
            Field{"worst_approach_delay_s", "s", &M::worst_approach_delay_s, 0.0, 1e9,
                  "Mean time lost on the worst approach with at least five vehicles", "approaches"},
            Field{"vehicle_km", "km", &M::vehicle_km, 0.0, 1e12, "Distance driven by all vehicles",
                  "tripinfo routeLength"});
    }
    static constexpr void signal_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        table(
            Field{"cross_street_delay_s", "s", &M::cross_street_delay_s, 0.0, 1e12,
                  "Time lost on the cross streets of a signal on an EV's route, in the 15 minutes from when "
                  "the EV could be there, summed over vehicles, mean of the signals on all routes",
                  "approaches"},
            Field{"signal_calls", "1", &M::signal_calls, 0.0, 1e9, "Requests of EVs that reached a signal",
                  "event log"},
            Field{"signal_calls_granted", "1", &M::signal_calls_granted, 0.0, 1e9,
                  "Of them: a hold was shown", "event log"},
            Field{"signal_entry_delay_s", "s", &M::signal_entry_delay_s, 0.0, 1e9,
                  "From a request to the start of the transition, mean", "event log"},
            Field{"signal_time_to_service_s", "s", &M::signal_time_to_service_s, 0.0, 1e9,
                  "From a request to green for the EV, mean of those granted", "event log"},
            Field{"signal_dwell_s", "s", &M::signal_dwell_s, 0.0, 1e9, "How long a hold was shown, mean",
                  "event log"},
            Field{"signal_recovery_s", "s", &M::signal_recovery_s, 0.0, 1e9,
                  "From the end of a hold until the program runs again, in step where it is coordinated, "
                  "mean",
                  "event log"});
    }
    static constexpr void pedestrian_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        table(Field{"pedestrian_count", "1", &M::pedestrian_count, 0.0, 1e9, "Walks of pedestrians",
                    "tripinfo"},
              Field{"pedestrians_unfinished", "1", &M::pedestrians_unfinished, 0.0, 1e9,
                    "Walks that had not ended", "tripinfo"},
              Field{"pedestrian_time_loss_s", "s", &M::pedestrian_time_loss_s, 0.0, 1e9,
                    "Time lost on a walk, including waiting at crossings, mean of those that ended",
                    "tripinfo timeLoss"},
              Field{"pedestrian_collisions", "1", &M::pedestrian_collisions, 0.0, 1e9,
                    "Collisions of vehicles with pedestrians, not counted in the collisions", "events"},
              Field{"emergency_pedestrian_collisions", "1", &M::emergency_pedestrian_collisions, 0.0, 1e9,
                    "Collisions of EVs with pedestrians", "events"});
    }
    static constexpr void decision_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        table(
            Field{"leases_issued", "1", &M::leases_issued, 0.0, 1e12, "New leases, carried out or not",
                  "actuation"},
            Field{"leases_renewed", "1", &M::leases_renewed, 0.0, 1e12, "Leases that renewed an earlier one",
                  "actuation"},
            Field{
                "leases_refused", "1", &M::leases_refused, 0.0, 1e12,
                "Leases refused at some time, once for each reason; most are judged again and may act later",
                "actuation"},
            Field{"leases_expired", "1", &M::leases_expired, 0.0, 1e12, "Leases that expired", "actuation"},
            Field{"commands_skipped", "1", &M::commands_skipped, 0.0, 1e12,
                  "Commands not given to SUMO, because the vehicle had left the road", "commands"},
            Field{
                "commands_refused", "1", &M::commands_refused, 0.0, 1e12,
                "Commands to stop that SUMO did not carry out, because the vehicle could no longer brake in "
                "time on its lane, and to take a way that SUMO does not know for the vehicle",
                "commands"},
            Field{"way_decisions", "1", &M::way_decisions, 0.0, 1e9,
                  "Moments at which other ways of EVs were driven to their ends in copies of the run",
                  "setting loop.ways_tried"},
            Field{"way_decisions_best", "1", &M::way_decisions_best, 0.0, 1e9,
                  "Of these: no other way was more than 1 s faster", "copies of the run"},
            Field{"ways_tried", "1", &M::ways_tried, 0.0, 1e9, "Ways that were tried at them",
                  "copies of the run"},
            Field{"way_regret_s", "s", &M::way_regret_s, 0.0, 1e9,
                  "Time that EVs lost against the fastest of these ways, mean of the moments",
                  "copies of the run"},
            Field{
                "hold_decisions", "1", &M::hold_decisions, 0.0, 1e9,
                "Signals that EVs came near, for which other times of a hold were tried in copies of the run",
                "setting loop.holds_tried"},
            Field{"hold_decisions_best", "1", &M::hold_decisions_best, 0.0, 1e9,
                  "Of these: no other time was more than 1 s faster", "copies of the run"},
            Field{"holds_tried", "1", &M::holds_tried, 0.0, 1e9, "Times that were tried at them",
                  "copies of the run"},
            Field{"hold_regret_s", "s", &M::hold_regret_s, 0.0, 1e9,
                  "Time that EVs lost against the best of these times, mean of the signals",
                  "copies of the run"});
    }
    static constexpr void incident_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        constexpr const char* from = "incidents of the scenario";
        table(Field{"emergency_met_incident", "1", &M::emergency_met_incident, 0.0, 1e9,
                    "EVs that came to a road which an incident closed to them", from},
              Field{"emergency_turned_round", "1", &M::emergency_turned_round, 0.0, 1e9,
                    "Of these: their crews saw it and took another way", from},
              Field{"emergency_cut_off", "1", &M::emergency_cut_off, 0.0, 1e9,
                    "Of these: their crews found no other way", from},
              Field{"others_rerouted", "1", &M::others_rerouted, 0.0, 1e9,
                    "Other vehicles that took another way because of an incident", from},
              Field{"incident_delay_s", "s", &M::incident_delay_s, 0.0, 1e9,
                    "Longest time from an incident's start until all its lanes were blocked", from});
    }
    static constexpr void call_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        constexpr const char* from = "copies of the run, setting loop.units_tried";
        table(
            Field{"units_sent", "1", &M::units_sent, 0.0, 1e9, "EVs that calls sent out",
                  "calls of the scenario"},
            Field{"units_missing", "1", &M::units_missing, 0.0, 1e9,
                  "EVs called for that no station could send", "calls of the scenario"},
            Field{"unit_decisions", "1", &M::unit_decisions, 0.0, 1e9,
                  "EVs sent, judged by units left out, which were driven there in copies of the run", from},
            Field{
                "wrong_unit_share", "1", &M::wrong_unit_share, 0.0, 1.0,
                "Share of these: with a unit left out, the first, second, ... EV would have been there more "
                "than 1 s earlier",
                from},
            Field{"unit_regret_s", "s", &M::unit_regret_s, 0.0, 1e9,
                  "Time lost against the fastest of all these units, mean of these", from});
    }
    static constexpr void request_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        table(
            Field{"requests_sent", "1", &M::requests_sent, 0.0, 1e12,
                  "Requests of EVs to other vehicles, one for each message that carries it", "channel"},
            Field{"requests_heard", "1", &M::requests_heard, 0.0, 1e12,
                  "Of those sent: the vehicle heard it, itself or by a relay", "channel"},
            Field{"requests_relayed", "1", &M::requests_relayed, 0.0, 1e12,
                  "Of those heard: only a relay brought it", "channel"},
            Field{
                "requests_needed", "1", &M::requests_needed, 0.0, 1e12,
                "Requests that the same policies would have made with perfect sensors, at the same messages",
                "the same policies on the truth"},
            Field{"requests_useless", "1", &M::requests_useless, 0.0, 1e12,
                  "Of those sent: not among those needed", "the same policies on the truth"},
            Field{"requests_missed", "1", &M::requests_missed, 0.0, 1e12,
                  "Of those needed: not sent or not heard", "the same policies on the truth"},
            Field{"request_messages", "1", &M::request_messages, 0.0, 1e12,
                  "Transmissions of requests to vehicles, those of relays included", "channel"},
            Field{"vehicles_asked", "1", &M::vehicles_asked, 0.0, 1e9,
                  "Different vehicles that heard a request", "channel"},
            Field{"signal_requests_sent", "1", &M::signal_requests_sent, 0.0, 1e12,
                  "Requests of EVs to signals, one for each message that carries it", "channel"},
            Field{"signal_requests_heard", "1", &M::signal_requests_heard, 0.0, 1e12,
                  "Of those sent to signals: the signal heard it", "channel"},
            Field{"signal_request_messages", "1", &M::signal_request_messages, 0.0, 1e12,
                  "Transmissions of requests to signals", "channel"});
    }
    static constexpr void answer_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        constexpr const char* told = "SSM";
        table(Field{"signal_request_updates", "1", &M::signal_request_updates, 0.0, 1e12,
                    "Of those sent to signals: updates of an earlier one", "SRM"},
              Field{"signal_request_cancellations", "1", &M::signal_request_cancellations, 0.0, 1e12,
                    "Of those sent to signals: cancellations, after the EV has passed or turned off", "SRM"},
              Field{"signal_answers_sent", "1", &M::signal_answers_sent, 0.0, 1e12,
                    "Answers of signals, one for each message and open request", "SSM"},
              Field{"signal_answers_heard", "1", &M::signal_answers_heard, 0.0, 1e12,
                    "Of those: the EV heard it", "SSM"},
              Field{"signal_told_requested", "1", &M::signal_told_requested, 0.0, 1e9,
                    "Requests whose EV was told `requested` at least once", told},
              Field{"signal_told_processing", "1", &M::signal_told_processing, 0.0, 1e9,
                    "The same for `processing`", told},
              Field{"signal_told_watch_other_traffic", "1", &M::signal_told_watch_other_traffic, 0.0, 1e9,
                    "The same for `watchOtherTraffic`", told},
              Field{"signal_told_granted", "1", &M::signal_told_granted, 0.0, 1e9, "The same for `granted`",
                    told},
              Field{"signal_told_rejected", "1", &M::signal_told_rejected, 0.0, 1e9,
                    "The same for `rejected`", told},
              Field{"signal_told_max_presence", "1", &M::signal_told_max_presence, 0.0, 1e9,
                    "The same for `maxPresence`", told},
              Field{"signal_told_reservice_locked", "1", &M::signal_told_reservice_locked, 0.0, 1e9,
                    "The same for `reserviceLocked`", told},
              Field{"signal_granted_after_s", "s", &M::signal_granted_after_s, 0.0, 1e9,
                    "Time from an EV's first request to the first `granted` that it heard, mean", told},
              Field{"held_greens", "1", &M::held_greens, 0.0, 1e9,
                    "Greens that signals held for an EV, whichever policy asked", "actuation"},
              Field{"held_greens_useless", "1", &M::held_greens_useless, 0.0, 1e9,
                    "Of those: the EV did not pass in it", "actuation and routes"},
              Field{"held_greens_useless_s", "s", &M::held_greens_useless_s, 0.0, 1e9,
                    "Their duration, summed", "actuation and routes"});
    }
    static constexpr void link_fields(const auto& table) {
        using M = RunMetrics;
        using core::Field;
        table(Field{"links_true_positive", "1", &M::links_true_positive, 0.0, 1e12,
                    "Links believed that are true", "link comparison by key"},
              Field{"links_false_positive", "1", &M::links_false_positive, 0.0, 1e12,
                    "Links believed that are not true", "link comparison by key"},
              Field{"links_false_negative", "1", &M::links_false_negative, 0.0, 1e12,
                    "True links that are not believed", "link comparison by key"},
              Field{"links_f1", "1", &M::links_f1, 0.0, 1.0, "F1 of the believed links", "2TP/(2TP+FP+FN)"},
              Field{"dark_links_true_positive", "1", &M::dark_links_true_positive, 0.0, 1e12,
                    "The same where an end was not heard at the newest report", "link comparison by key"},
              Field{"dark_links_false_positive", "1", &M::dark_links_false_positive, 0.0, 1e12,
                    "The same where an end was not heard at the newest report", "link comparison by key"},
              Field{"dark_links_false_negative", "1", &M::dark_links_false_negative, 0.0, 1e12,
                    "The same where an end was not heard at the newest report", "link comparison by key"},
              Field{"dark_links_f1", "1", &M::dark_links_f1, 0.0, 1.0,
                    "F1 of the believed links with an end not heard at the newest report", "2TP/(2TP+FP+FN)"},
              Field{"simulated_s", "s", &M::simulated_s, 0.0, 1e9, "Simulated time", "clock"},
              Field{"vehicle_steps", "1", &M::vehicle_steps, 0.0, 1e15,
                    "Vehicles on the road, summed over steps", "snapshots"});
    }

  public:
    static constexpr void fields(const auto& table) {
        travel_fields(table);
        safety_fields(table);
        signal_fields(table);
        pedestrian_fields(table);
        decision_fields(table);
        incident_fields(table);
        call_fields(table);
        request_fields(table);
        answer_fields(table);
        link_fields(table);
    }
};

/// Everything that a run leaves to be stored.
struct RunSummary {
    RunMetrics metrics;
    std::vector<VehicleRow> vehicles;  ///< By planned departure, then id.
    std::string trace_hash;            ///< 32 hex digits over every snapshot and every lease, in order.
    TrafficTables traffic;             ///< Empty unless Recorder::watch was called.
    std::vector<LeaseRow> leases;      ///< By policy, then action; only those that were used.
    /// By time, then signal. Nothing unless Recorder::signals was called.
    std::optional<std::vector<SignalEvent>> signal_events = {};
};

/// Whether locks say more about a run than its policy: an EV or more than one vehicle in a hundred stood in
/// one.
bool is_held_up(const RunMetrics& run);

}  // namespace clearway::metrics
