#include "metrics/recorder.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/match_rows.hpp"
#include "metrics/detail/conflict_watch.hpp"
#include "metrics/detail/considered_watch.hpp"
#include "metrics/detail/cross_watch.hpp"
#include "metrics/detail/elements.hpp"
#include "metrics/detail/flow_watch.hpp"
#include "metrics/detail/hold_watch.hpp"
#include "metrics/detail/lock_watch.hpp"
#include "metrics/detail/mean.hpp"
#include "metrics/detail/signal_log.hpp"
#include "metrics/detail/trace_hash.hpp"
#include "metrics/detail/traffic_watch.hpp"
#include "metrics/link_comparison.hpp"
#include "metrics/restricted_time.hpp"
#include "metrics/signal_measures.hpp"
#include "traffic/obstacle.hpp"

namespace clearway::metrics {
namespace {

using detail::Mean;
using traffic::VehicleClass;

/// The walks of pedestrians, from the tripinfo files.
class Walks {
  public:
    void take(const detail::Element& walk) {
        ++count_;
        if (walk.number("arrival") >= 0.0) time_loss_s_.add(walk.number("timeLoss"));
    }
    void describe(RunMetrics& metrics) const {
        metrics.pedestrian_count = count_;
        metrics.pedestrians_unfinished = count_ - time_loss_s_.count;
        metrics.pedestrian_time_loss_s = time_loss_s_.value();
    }

  private:
    std::uint64_t count_ = 0;
    Mean time_loss_s_;
};

/// Rows of a run while the tripinfo files are read.
class RowTable {
  public:
    explicit RowTable(const std::vector<PlannedVehicle>& planned) {
        rows_.reserve(planned.size());
        for (const PlannedVehicle& vehicle : planned) {
            VehicleRow row;
            row.id = vehicle.id;
            row.key = core::vehicle_key(vehicle.id);
            row.vehicle_class = vehicle.vehicle_class;
            row.kind = vehicle.kind;
            row.planned_depart_s = vehicle.depart_s;
            row.outcome = VehicleOutcome::not_inserted;
            if (!row_of_.emplace(row.key, rows_.size()).second) {
                throw core::SimulatorError(fmt::format("vehicle {} is planned twice", vehicle.id));
            }
            rows_.push_back(std::move(row));
        }
    }

    void read(const std::filesystem::path& tripinfo) {
        try {
            detail::for_each_element(tripinfo, [this](const detail::Element& element) {
                if (element.name() == "tripinfo" && !element.text("id").starts_with(traffic::obstacle_prefix))
                    take(element);
                if (element.name() == "walk") walks_.take(element);
            });
        } catch (const std::runtime_error& error) {
            throw core::SimulatorError(error.what());
        }
    }

    void set_teleports(const std::unordered_map<core::VehicleKey, std::uint32_t>& teleports) {
        for (const auto& [vehicle, count] : teleports) {
            VehicleRow& row = planned(vehicle, "teleported");
            row.teleports = count;
            row.outcome = VehicleOutcome::teleported;
        }
    }

    void set_met(const std::map<core::VehicleKey, double>& met_s) {
        for (const auto& [vehicle, time_s] : met_s)
            planned(vehicle, "met an incident").incident_met_s = time_s;
    }

    /// SUMO leaves planned stops out of both measures. A stop that a policy commanded is time lost.
    void add_stops(const std::unordered_map<core::VehicleKey, double>& stopped_s) {
        for (const auto& [vehicle, seconds] : stopped_s) {
            const auto found = row_of_.find(vehicle);
            if (found == row_of_.end() || !rows_[found->second].depart_s) continue;
            VehicleRow& row = rows_[found->second];
            row.time_loss_s = row.time_loss_s.value_or(0.0) + seconds;
            row.waiting_time_s = row.waiting_time_s.value_or(0.0) + seconds;
        }
    }

    const Walks& walks() const { return walks_; }

    std::vector<VehicleRow> take_rows() {
        std::ranges::sort(rows_, {},
                          [](const VehicleRow& row) { return std::tie(row.planned_depart_s, row.id); });
        return std::move(rows_);
    }

  private:
    /// The row of a vehicle of which something is told.
    VehicleRow& planned(core::VehicleKey vehicle, const char* what) {
        const auto found = row_of_.find(vehicle);
        if (found == row_of_.end())
            throw core::SimulatorError(fmt::format("a vehicle {} that is not in the demand", what));
        return rows_[found->second];
    }

    void take(const detail::Element& element) {
        const std::string id(element.text("id"));
        const auto found = row_of_.find(core::vehicle_key(id));
        if (found == row_of_.end())
            throw std::runtime_error(fmt::format("vehicle {} is not in the demand", id));
        VehicleRow& row = rows_[found->second];
        if (row.depart_s) throw std::runtime_error(fmt::format("vehicle {} is listed twice", id));
        const double depart_s = element.number("depart");
        if (depart_s < 0.0) return;  // Listed by SUMO as never inserted.
        row.depart_s = depart_s;
        row.depart_delay_s = element.number("departDelay");
        row.travel_time_s = element.number("duration");
        row.time_loss_s = element.number("timeLoss");
        row.waiting_time_s = element.number("waitingTime");
        row.waiting_count = static_cast<std::uint32_t>(element.number("waitingCount"));
        row.route_length_m = element.number("routeLength");
        const double arrival_s = element.number("arrival");
        const std::string_view vaporized = element.text("vaporized");
        if (!vaporized.empty() && vaporized != "end") {
            row.outcome = VehicleOutcome::removed;
        } else if (arrival_s < 0.0) {
            row.outcome = VehicleOutcome::running_at_end;
        } else {
            row.outcome = VehicleOutcome::arrived;
            row.arrival_s = arrival_s;
        }
    }

    std::vector<VehicleRow> rows_;
    std::unordered_map<core::VehicleKey, std::size_t> row_of_;
    Walks walks_;
};

void count_outcomes(const std::vector<VehicleRow>& rows, RunMetrics& metrics) {
    metrics.vehicle_count = rows.size();
    for (const VehicleRow& row : rows) {
        const bool arrived = row.outcome == VehicleOutcome::arrived;
        if (row.vehicle_class == VehicleClass::emergency) {
            ++metrics.emergency_count;
            if (arrived) ++metrics.emergency_arrived;
        }
        if (arrived) ++metrics.arrived;
        if (row.outcome == VehicleOutcome::running_at_end) ++metrics.unfinished;
        if (row.outcome == VehicleOutcome::not_inserted) ++metrics.not_inserted;
        if (row.outcome == VehicleOutcome::removed) ++metrics.removed;
    }
}

/// Means of one group of vehicles.
struct GroupMeans {
    Mean travel_time_s;        ///< Of those that arrived.
    Mean arrived_time_loss_s;  ///< Of those that arrived.
    Mean time_loss_s;          ///< Of those inserted.
    Mean waiting_time_s;       ///< Of those inserted.
    Mean depart_delay_s;       ///< Of those inserted.

    void add(const VehicleRow& row) {
        if (row.outcome == VehicleOutcome::arrived) {
            travel_time_s.add(row.travel_time_s);
            arrived_time_loss_s.add(row.time_loss_s);
        }
        time_loss_s.add(row.time_loss_s);
        waiting_time_s.add(row.waiting_time_s);
        depart_delay_s.add(row.depart_delay_s);
    }
};

void average(const std::vector<VehicleRow>& rows, RunMetrics& metrics) {
    GroupMeans emergency;
    GroupMeans others;
    GroupMeans everybody;
    for (const VehicleRow& row : rows) {
        (row.vehicle_class == VehicleClass::emergency ? emergency : others).add(row);
        everybody.add(row);
    }
    metrics.emergency_travel_time_s = emergency.travel_time_s.value();
    metrics.emergency_time_loss_s = emergency.arrived_time_loss_s.value();
    metrics.emergency_waiting_time_s = emergency.waiting_time_s.value();
    metrics.emergency_depart_delay_s = emergency.depart_delay_s.value();
    metrics.depart_delay_s = everybody.depart_delay_s.value();
    metrics.waiting_time_s = everybody.waiting_time_s.value();
    metrics.others_depart_delay_s = others.depart_delay_s.value();
    metrics.others_travel_time_s = others.travel_time_s.value();
    metrics.others_time_loss_s = others.time_loss_s.value();
    metrics.others_waiting_time_s = others.waiting_time_s.value();
}

void count_collision(const truth::Collision& collision, const traffic::Roster& roster, RunMetrics& counted) {
    const bool with_obstacle = collision.place == truth::CollisionPlace::obstacle;
    if (!with_obstacle && roster.find(collision.victim) == nullptr) {
        ++counted.pedestrian_collisions;
        if (collision.with_emergency_vehicle) ++counted.emergency_pedestrian_collisions;
        return;
    }
    const bool at_junction = collision.place == truth::CollisionPlace::junction;
    ++counted.collisions;
    if (at_junction) ++counted.junction_collisions;
    if (!collision.with_emergency_vehicle) return;
    ++counted.emergency_collisions;
    if (at_junction) ++counted.emergency_junction_collisions;
}

/// `measures` end with those of all signals together.
void describe_signals(const std::vector<SignalMeasures>& measures, RunMetrics& metrics) {
    if (measures.empty()) return;
    const SignalMeasures& all = measures.back();
    metrics.signal_calls = all.calls;
    metrics.signal_calls_granted = all.granted;
    metrics.signal_entry_delay_s = all.entry_delay_s;
    metrics.signal_time_to_service_s = all.time_to_service_s;
    metrics.signal_dwell_s = all.dwell_s;
    metrics.signal_recovery_s = all.recovery_s;
}

void describe_requests(const traffic::RequestCounts& counts, RunMetrics& metrics) {
    metrics.requests_sent = counts.sent;
    metrics.requests_heard = counts.heard;
    metrics.requests_relayed = counts.relayed;
    metrics.requests_needed = counts.needed;
    metrics.requests_useless = counts.useless;
    metrics.requests_missed = counts.missed;
    metrics.request_messages = counts.messages;
    metrics.vehicles_asked = counts.vehicles_asked;
}

/// Requests to signals: those that were messages, and those that were leases.
void describe_signal_requests(const LeaseTotals& totals, RunMetrics& metrics) {
    const traffic::SignalRequestCounts& counts = totals.signal_requests;
    const auto told = [&](traffic::RequestStatus status) {
        return counts.told[static_cast<std::size_t>(status)];
    };
    metrics.signal_requests_sent = totals.requests.signal_sent + counts.sent;
    metrics.signal_requests_heard = totals.requests.signal_heard + counts.heard;
    metrics.signal_request_messages = totals.requests.signal_messages + counts.messages;
    metrics.signal_request_updates = counts.updates;
    metrics.signal_request_cancellations = counts.cancellations;
    metrics.signal_answers_sent = counts.answers_sent;
    metrics.signal_answers_heard = counts.answers_heard;
    metrics.signal_told_requested = told(traffic::RequestStatus::requested);
    metrics.signal_told_processing = told(traffic::RequestStatus::processing);
    metrics.signal_told_watch_other_traffic = told(traffic::RequestStatus::watch_other_traffic);
    metrics.signal_told_granted = told(traffic::RequestStatus::granted);
    metrics.signal_told_rejected = told(traffic::RequestStatus::rejected);
    metrics.signal_told_max_presence = told(traffic::RequestStatus::max_presence);
    metrics.signal_told_reservice_locked = told(traffic::RequestStatus::reservice_locked);
    if (metrics.signal_told_granted > 0)
        metrics.signal_granted_after_s =
            counts.until_granted_s / static_cast<double>(metrics.signal_told_granted);
    metrics.held_greens = totals.greens.greens;
    metrics.held_greens_useless = totals.greens.useless;
    metrics.held_greens_useless_s = totals.greens.useless_s;
}

/// Mean time lost on the worst approach. Rows of one approach are adjacent.
std::optional<double> worst_delay_s(const std::vector<ApproachRow>& rows) {
    // Assumed: a mean of fewer vehicles says more about single drivers than about the street.
    constexpr std::uint64_t least_vehicles = 5;
    std::optional<double> worst;
    for (std::size_t row = 0; row < rows.size();) {
        std::uint64_t vehicles = 0;
        double lost_s = 0.0;
        const std::string& edge = rows[row].edge;
        for (; row < rows.size() && rows[row].edge == edge; ++row) {
            vehicles += rows[row].vehicles;
            lost_s += rows[row].time_loss_s;
        }
        if (vehicles < least_vehicles) continue;
        const double mean_s = lost_s / static_cast<double>(vehicles);
        worst = std::max(worst.value_or(mean_s), mean_s);
    }
    return worst;
}

double driven_km(const std::vector<VehicleRow>& rows) {
    double driven_m = 0.0;
    for (const VehicleRow& row : rows)
        driven_m += row.route_length_m.value_or(0.0);
    return driven_m / 1000.0;
}

}  // namespace

struct Recorder::State {
    RecorderConfig config;
    detail::TraceHash trace;
    LinkComparison links;
    RunMetrics counted;  ///< Counts from events and snapshots so far.
    std::unordered_map<core::VehicleKey, std::uint32_t> teleports;
    std::unordered_map<core::VehicleKey, double> stopped_s;  ///< At stops that were commanded.
    std::optional<double> before_s;                          ///< Time of the step before.
    RoadLayout layout;
    std::vector<core::VehicleKey> keys;     ///< Keys at the step before.
    std::vector<std::uint32_t> row_before;  ///< Row of each vehicle at the step before.
    std::optional<detail::TrafficWatch> traffic;
    std::optional<detail::FlowWatch> flow;
    std::optional<detail::HoldWatch> holds;
    std::optional<detail::LockWatch> locks;
    std::optional<detail::ConsideredWatch> considered;
    std::optional<detail::ConflictWatch> conflicts;
    std::optional<detail::CrossWatch> cross_streets;
    std::optional<detail::SignalLog> signal_log;
};

Recorder::Recorder(RecorderConfig config) : state_(std::make_unique<State>()) {
    state_->config = config;
}
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

void Recorder::configure(RecorderConfig config) {
    state_->config = config;
}

void Recorder::watch(RoadLayout layout, StandingReasons reasons) {
    state_->layout = std::move(layout);
    state_->traffic.emplace(state_->layout);
    state_->flow.emplace(state_->layout);
    state_->holds.emplace(state_->layout);
    state_->locks.emplace(state_->layout, std::move(reasons));
    state_->considered.emplace(state_->layout);
    state_->conflicts.emplace();
    state_->cross_streets.emplace(state_->layout);
}

void Recorder::step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                    const truth::Events& events, std::span<const traffic::Lease> leases) {
    state_->trace.add(snapshot);
    state_->trace.add(leases);
    if (state_->traffic) {
        core::match_rows(snapshot.key, state_->keys, state_->row_before);
        state_->keys = snapshot.key;
        state_->traffic->step(snapshot, roster, state_->row_before);
        state_->flow->step(snapshot, state_->row_before);
        state_->holds->step(snapshot, leases);
        state_->locks->step(snapshot, roster);
        state_->considered->step(roster, leases);
        state_->conflicts->step(snapshot, roster);
        state_->cross_streets->step(snapshot);
    }
    RunMetrics& counted = state_->counted;
    counted.vehicle_steps += snapshot.size();
    counted.teleports += events.teleported.size();
    counted.emergency_brakings += events.emergency_brakings.size();
    for (const truth::Collision& collision : events.collisions)
        count_collision(collision, roster, counted);
    for (const core::VehicleKey vehicle : events.teleported)
        ++state_->teleports[vehicle];
    const double now_s = snapshot.time.value;
    const double step_s = now_s - state_->before_s.value_or(now_s);
    assert(step_s >= 0.0);
    state_->before_s = now_s;
    for (const core::VehicleKey vehicle : snapshot.commanded_stops)
        state_->stopped_s[vehicle] += step_s;
}

void Recorder::signals(const truth::Snapshot& snapshot, std::span<const traffic::SignalStatus> asked) {
    assert(state_->before_s == snapshot.time.value && "after step");
    if (!state_->traffic) return;
    if (!state_->signal_log) state_->signal_log.emplace(state_->layout);
    state_->signal_log->step(snapshot, asked);
}

void Recorder::links(const truth::Snapshot& snapshot, const TrueLinks& truth,
                     const traffic::BelievedGraph& belief) {
    assert(truth.graph().vehicle_count() == snapshot.size());
    state_->links.add(snapshot, truth, belief, state_->config.fresh_age_s);
}

RunSummary Recorder::finish(const RunEnd& end) const {
    RowTable table(end.planned);
    for (const std::filesystem::path& file : end.tripinfo_files)
        table.read(file);
    table.set_teleports(state_->teleports);
    table.add_stops(state_->stopped_s);
    table.set_met(end.incidents.emergency_met_s);

    RunSummary summary;
    summary.vehicles = table.take_rows();
    summary.trace_hash = state_->trace.digest();
    RunMetrics& metrics = summary.metrics;
    metrics = state_->counted;
    if (state_->traffic) {
        summary.traffic = state_->traffic->tables();
        summary.traffic.holds = state_->holds->rows();
        summary.traffic.locks = state_->locks->rows();
        summary.traffic.considered = state_->considered->rows();
        state_->locks->describe(metrics);
        state_->flow->describe(metrics);
        state_->conflicts->describe(metrics);
        metrics.cross_street_delay_s = state_->cross_streets->delay_s();
        if (state_->signal_log) {
            summary.signal_events = state_->signal_log->events();
            describe_signals(signal_measures(*summary.signal_events), metrics);
        }
        metrics.worst_approach_delay_s = worst_delay_s(summary.traffic.approaches);
    }
    table.walks().describe(metrics);
    metrics.vehicle_km = driven_km(summary.vehicles);
    count_outcomes(summary.vehicles, metrics);
    average(summary.vehicles, metrics);
    metrics.emergency_restricted_travel_time_s =
        emergency_restricted_mean_s(summary.vehicles, end.horizon.value);
    metrics.simulated_s = end.time.value;
    summary.leases = end.leases.rows;
    metrics.leases_issued = end.leases.issued;
    metrics.leases_renewed = end.leases.renewed;
    metrics.leases_refused = end.leases.refused;
    metrics.leases_expired = end.leases.expired;
    metrics.commands_skipped = end.leases.commands_skipped;
    metrics.commands_refused = end.leases.commands_refused;
    metrics.emergency_met_incident = end.incidents.emergency_met_s.size();
    metrics.emergency_turned_round = end.incidents.emergency_turned;
    metrics.emergency_cut_off = end.incidents.emergency_cut_off;
    metrics.others_rerouted = end.incidents.others_rerouted;
    metrics.incident_delay_s = end.incidents.delay_s;
    metrics.way_decisions = end.leases.ways.decisions;
    metrics.way_decisions_best = end.leases.ways.best;
    metrics.ways_tried = end.leases.ways.tried;
    metrics.way_regret_s = end.leases.ways.mean_regret_s();
    metrics.hold_decisions = end.leases.holds.decisions;
    metrics.hold_decisions_best = end.leases.holds.best;
    metrics.holds_tried = end.leases.holds.tried;
    metrics.hold_regret_s = end.leases.holds.mean_regret_s();
    metrics.units_sent = end.dispatch.sent;
    metrics.units_missing = end.dispatch.missing;
    metrics.unit_decisions = end.dispatch.units.decisions;
    metrics.wrong_unit_share = end.dispatch.units.wrong_share();
    metrics.unit_regret_s = end.dispatch.units.mean_regret_s();
    describe_requests(end.leases.requests, metrics);
    describe_signal_requests(end.leases, metrics);
    metrics.links_true_positive = link_counts().true_positive;
    metrics.links_false_positive = link_counts().false_positive;
    metrics.links_false_negative = link_counts().false_negative;
    metrics.links_f1 = link_counts().f1();
    metrics.dark_links_true_positive = dark_link_counts().true_positive;
    metrics.dark_links_false_positive = dark_link_counts().false_positive;
    metrics.dark_links_false_negative = dark_link_counts().false_negative;
    metrics.dark_links_f1 = dark_link_counts().f1();
    return summary;
}

const LinkCounts& Recorder::link_counts() const {
    return state_->links.all;
}

const LinkCounts& Recorder::dark_link_counts() const {
    return state_->links.dark;
}

}  // namespace clearway::metrics
