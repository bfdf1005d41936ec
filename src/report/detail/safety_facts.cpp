#include "report/detail/safety_facts.hpp"

#include <array>

namespace clearway::report::detail {
namespace {

struct Row {
    const char* metric;
    const char* title;
};

constexpr std::array rows = {
    Row{"collisions", "Collisions, on lanes and at junctions"},
    Row{"junction_collisions", "Collisions at junctions"},
    Row{"emergency_collisions", "Collisions with an EV"},
    Row{"emergency_junction_collisions", "Collisions with an EV at junctions"},
    Row{"emergency_brakings", "Emergency brakings (9 m/s\u00b2; trucks and buses 7)"},
    Row{"teleports", "Teleports"},
    Row{"emergency_conflicts", "Conflicts near an EV (time to collision below 1.5 s)"},
    Row{"emergency_least_ttc_s", "Least time to collision near an EV, s"},
    Row{"emergency_greatest_drac_mps2", "Greatest deceleration to avoid a crash near an EV, m/s\u00b2"},
    Row{"emergency_red_passages", "EVs past a red signal"},
    Row{"others_red_passages", "Others past a red signal"},
    Row{"others_hard_brakings", "Hard brakings of others (3.4 m/s\u00b2)"},
    Row{"others_jerk_mps3", "Jerk of others, root mean square, m/s\u00b3"},
    Row{"signal_throughput_per_hour", "Vehicles past stop lines of signals, per hour"},
    Row{"signal_queue_vehicles", "Queue on an approach to a signal, mean, vehicles"},
    Row{"signal_longest_queue_vehicles", "Longest queue, vehicles"},
    Row{"worst_approach_delay_s", "Time lost on the worst approach, s per vehicle"},
    Row{"cross_street_delay_s",
        "Time lost on cross streets in the 15 min after an EV, vehicle-s per passage"},
};

/// Shown only if signals were asked for green.
constexpr std::array signal_rows = {
    Row{"signal_calls", "Requests that reached a signal"},
    Row{"signal_calls_granted", "Requests granted"},
    Row{"held_greens_useless", "Greens held whose EV did not pass in them"},
    Row{"signal_entry_delay_s", "From request to transition, s"},
    Row{"signal_time_to_service_s", "From request to green, s"},
    Row{"signal_dwell_s", "Hold, s"},
    Row{"signal_recovery_s", "From the end of a hold until back in program and step, s"},
};

/// Shown only if there are pedestrians.
constexpr std::array pedestrian_rows = {
    Row{"pedestrian_collisions", "Collisions with a pedestrian"},
    Row{"emergency_pedestrian_collisions", "Collisions of an EV with a pedestrian"},
    Row{"pedestrian_count", "Walks of pedestrians"},
    Row{"pedestrian_time_loss_s", "Time lost on a walk over a crossing, s"},
};

double total(const analysis::Values& values) {
    double sum = 0.0;
    for (const std::optional<double>& value : values)
        sum += value.value_or(0.0);
    return sum;
}

}  // namespace

Estimate estimate_from(const std::optional<analysis::Estimate>& estimate) {
    if (!estimate) return {};
    Estimate result{estimate->mean, std::nullopt, std::nullopt, estimate->n};
    if (estimate->interval) {
        result.low = estimate->interval->low;
        result.high = estimate->interval->high;
    }
    return result;
}

std::vector<SafetyFacts> safety_of(const analysis::ConditionSummary& summary) {
    std::vector<SafetyFacts> facts;
    if (summary.complete_runs == 0) return facts;
    const double driven_km = total(summary.metric("vehicle_km").values);
    const bool has_pedestrians = total(summary.metric("pedestrian_count").values) > 0.0;
    std::vector<Row> shown(rows.begin(), rows.end());
    if (total(summary.metric("signal_calls").values) > 0.0)
        shown.insert(shown.end(), signal_rows.begin(), signal_rows.end());
    if (has_pedestrians) shown.insert(shown.end(), pedestrian_rows.begin(), pedestrian_rows.end());
    for (const Row& row : shown) {
        const analysis::MetricSummary& metric = summary.metric(row.metric);
        SafetyFacts fact{row.metric, row.title, estimate_from(metric.estimate), {}, std::nullopt};
        if (metric.comparison) fact.difference = estimate_from(metric.comparison->difference);
        if (metric.metric.kind == analysis::MetricKind::count && driven_km > 0.0)
            fact.per_1000_km = total(metric.values) / driven_km * 1000.0;
        facts.push_back(fact);
    }
    return facts;
}

}  // namespace clearway::report::detail
