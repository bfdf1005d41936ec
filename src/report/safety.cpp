#include "report/safety.hpp"

#include <array>
#include <utility>

namespace clearway::report {
namespace {

using Titled = std::pair<const char*, const char*>;  // metric, title

constexpr std::array rows = {
    Titled{"collisions", "Collisions, on lanes and at junctions"},
    Titled{"junction_collisions", "Collisions at junctions"},
    Titled{"emergency_collisions", "Collisions with an EV"},
    Titled{"emergency_junction_collisions", "Collisions with an EV at junctions"},
    Titled{"emergency_brakings", "Emergency brakings (9 m/s\u00b2; trucks and buses 7)"},
    Titled{"teleports", "Teleports"},
    Titled{"emergency_conflicts", "Conflicts near an EV (time to collision below 1.5 s)"},
    Titled{"emergency_least_ttc_s", "Least time to collision near an EV, s"},
    Titled{"emergency_greatest_drac_mps2", "Greatest deceleration to avoid a crash near an EV, m/s\u00b2"},
    Titled{"emergency_red_passages", "EVs past a red signal"},
    Titled{"others_red_passages", "Others past a red signal"},
    Titled{"others_hard_brakings", "Hard brakings of others (3.4 m/s\u00b2)"},
    Titled{"others_jerk_mps3", "Jerk of others, root mean square, m/s\u00b3"},
    Titled{"signal_throughput_per_hour", "Vehicles past stop lines of signals, per hour"},
    Titled{"signal_queue_vehicles", "Queue on an approach to a signal, mean, vehicles"},
    Titled{"signal_longest_queue_vehicles", "Longest queue, vehicles"},
    Titled{"worst_approach_delay_s", "Time lost on the worst approach, s per vehicle"},
    Titled{"cross_street_delay_s",
           "Time lost on cross streets in the 15 min after an EV, vehicle-s per passage"},
};

/// Shown only if signals were asked for green.
constexpr std::array signal_rows = {
    Titled{"signal_calls", "Requests that reached a signal"},
    Titled{"signal_calls_granted", "Requests granted"},
    Titled{"held_greens_useless", "Greens held in which the EV did not pass"},
    Titled{"signal_entry_delay_s", "From request to transition, s"},
    Titled{"signal_time_to_service_s", "From request to green, s"},
    Titled{"signal_dwell_s", "Hold, s"},
    Titled{"signal_recovery_s", "From the end of a hold to the program in step again, s"},
};

/// Shown only if there are pedestrians.
constexpr std::array pedestrian_rows = {
    Titled{"pedestrian_collisions", "Collisions with a pedestrian"},
    Titled{"emergency_pedestrian_collisions", "Collisions of an EV with a pedestrian"},
    Titled{"pedestrian_count", "Walks of pedestrians"},
    Titled{"pedestrian_time_loss_s", "Time lost on a walk over a crossing, s"},
};

}  // namespace

bool collide_by_model(std::uint64_t collisions, std::uint64_t vehicles) {
    constexpr std::uint64_t many = 100;
    return vehicles > 0 && many * collisions > vehicles;
}

std::vector<SafetyRow> safety_rows(const analysis::ConditionSummary& summary) {
    std::vector<SafetyRow> facts;
    if (summary.complete_runs == 0) return facts;
    const double driven_km = summary.total("vehicle_km");
    std::vector<Titled> shown(rows.begin(), rows.end());
    if (summary.total("signal_calls") > 0.0)
        shown.insert(shown.end(), signal_rows.begin(), signal_rows.end());
    if (summary.total("pedestrian_count") > 0.0)
        shown.insert(shown.end(), pedestrian_rows.begin(), pedestrian_rows.end());
    for (const auto& [name, title] : shown) {
        SafetyRow& row = facts.emplace_back(SafetyRow{&summary.metric(name), title, std::nullopt});
        if (row.metric->metric.kind == analysis::MetricKind::count && driven_km > 0.0)
            row.per_1000_km = summary.total(name) / driven_km * 1000.0;
    }
    return facts;
}

}  // namespace clearway::report
