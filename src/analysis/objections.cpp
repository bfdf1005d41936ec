#include "analysis/objections.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"

namespace clearway::analysis {
namespace {

using results::RunRecord;

void count(const metrics::VehicleRow& vehicle, OutcomeCounts& counts) {
    switch (vehicle.outcome) {
        case metrics::VehicleOutcome::arrived:
            ++counts.arrived;
            break;
        case metrics::VehicleOutcome::running_at_end:
            ++counts.running_at_end;
            break;
        case metrics::VehicleOutcome::teleported:
            ++counts.teleported;
            break;
        case metrics::VehicleOutcome::not_inserted:
            ++counts.not_inserted;
            break;
        case metrics::VehicleOutcome::removed:
            ++counts.removed;
            break;
    }
}

/// The paired difference of counts if its interval lies above 0, else nothing.
MaybeEstimate surplus(const detail::Pairs& counts, double level) {
    MaybeEstimate difference = estimate_count_difference(counts.condition, counts.baseline, level);
    const bool more = difference && difference->interval && difference->interval->low > 0.0;
    return more ? difference : std::nullopt;
}

double emergency_collisions(const RunRecord& run) {
    return static_cast<double>(run.metrics.emergency_collisions +
                               run.metrics.emergency_pedestrian_collisions);
}

std::string amount(const Estimate& more) {
    return fmt::format("{:+.1f} per run [{:.1f}, {:.1f}]", more.mean, more.interval->low,
                       more.interval->high);
}

/// `12 teleported, 1 still on the road`; empty if all arrived.
std::string endings(const OutcomeCounts& counts) {
    std::vector<std::string> words;
    const auto add = [&](std::uint64_t number, const char* how) {
        if (number > 0) words.push_back(fmt::format("{} {}", number, how));
    };
    add(counts.teleported, "teleported");
    add(counts.running_at_end, "still on the road at the end");
    add(counts.not_inserted, "not inserted");
    add(counts.removed, "removed");
    return core::listed(words);
}

}  // namespace

OutcomeCounts emergency_outcomes(const RunRecord& run) {
    OutcomeCounts counts;
    for (const metrics::VehicleRow& vehicle : run.vehicles) {
        if (vehicle.vehicle_class == traffic::VehicleClass::emergency) count(vehicle, counts);
    }
    return counts;
}

OutcomeCounts other_outcomes(const RunRecord& run) {
    const metrics::RunMetrics& all = run.metrics;
    const OutcomeCounts emergency = emergency_outcomes(run);
    const auto rest = [](std::uint64_t whole, std::uint64_t part) { return whole - std::min(whole, part); };
    const std::uint64_t teleported =
        rest(all.vehicle_count, all.arrived + all.unfinished + all.not_inserted + all.removed);
    return {.arrived = rest(all.arrived, emergency.arrived),
            .running_at_end = rest(all.unfinished, emergency.running_at_end),
            .teleported = rest(teleported, emergency.teleported),
            .not_inserted = rest(all.not_inserted, emergency.not_inserted),
            .removed = rest(all.removed, emergency.removed)};
}

Objections objections_to(const detail::Runs& condition, const detail::Runs& baseline,
                         traffic::SafetyChecks safety_checks, double level) {
    Objections objections;
    objections.unchecked = safety_checks == traffic::SafetyChecks::off;
    detail::Pairs collisions;
    detail::Pairs teleported;
    detail::Pairs not_inserted;
    for (std::size_t row = 0; row < std::min(condition.size(), baseline.size()); ++row) {
        if (condition[row] == nullptr || baseline[row] == nullptr) continue;
        objections.emergency += emergency_outcomes(*condition[row]);
        objections.baseline_emergency += emergency_outcomes(*baseline[row]);
        const OutcomeCounts with = other_outcomes(*condition[row]);
        const OutcomeCounts without = other_outcomes(*baseline[row]);
        collisions.add(emergency_collisions(*condition[row]), emergency_collisions(*baseline[row]));
        teleported.add(static_cast<double>(with.teleported), static_cast<double>(without.teleported));
        not_inserted.add(static_cast<double>(with.not_inserted), static_cast<double>(without.not_inserted));
    }
    objections.collisions = surplus(collisions, level);
    objections.teleported = surplus(teleported, level);
    objections.not_inserted = surplus(not_inserted, level);
    return objections;
}

std::string lost_words(const Objections& objections) {
    const OutcomeCounts& lost = objections.emergency;
    const OutcomeCounts& baseline = objections.baseline_emergency;
    if (lost.lost() + baseline.lost() == 0) return {};
    const bool none = lost.lost() == 0;
    return fmt::format("lost {} of {} emergency vehicle{} ({}baseline {})",
                       none ? "none" : std::to_string(lost.lost()), lost.total(),
                       lost.total() == 1 ? "" : "s", none ? "" : endings(lost) + "; ",
                       baseline.lost() == 0 ? "0" : endings(baseline));
}

std::string emergency_objections(const Objections& objections) {
    std::vector<std::string> found;
    if (objections.loses_emergency()) found.push_back(lost_words(objections));
    if (objections.collisions)
        found.push_back(fmt::format("collided more often with an emergency vehicle ({})",
                                    amount(*objections.collisions)));
    if (objections.unchecked) found.emplace_back("ran without safety checks");
    return fmt::format("{}", fmt::join(found, " and "));
}

std::string other_objections(const Objections& objections) {
    std::vector<std::string> found;
    if (objections.teleported)
        found.push_back(fmt::format("more other vehicles teleported ({})", amount(*objections.teleported)));
    if (objections.not_inserted)
        found.push_back(
            fmt::format("more other vehicles not inserted ({})", amount(*objections.not_inserted)));
    return fmt::format("{}", fmt::join(found, "; "));
}

std::string emergency_objection_word(const Objections& objections) {
    if (objections.loses_emergency()) return "lost EVs";
    if (objections.collisions) return "hit EVs";
    return objections.unchecked ? "unchecked" : "";
}

}  // namespace clearway::analysis
