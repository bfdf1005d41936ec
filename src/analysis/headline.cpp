#include "analysis/headline.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "experiment/related_conditions.hpp"

namespace clearway::analysis {
namespace {

using experiment::ConditionSpec;

/// Runs are made in the order of the replications, so the search stops after this many missing ones.
constexpr std::size_t most_looks = 1000;

bool is_baseline_of(const ConditionSpec& other, const ConditionSpec& condition) {
    return !other.acts() && other.name != condition.name && experiment::same_environment(other, condition);
}

/// Restricted travel time of the emergency vehicles of a run, minus that of the baseline's run if there is
/// one.
std::optional<double> value_of(const results::RunRecord& run, const results::RunRecord* baseline) {
    const std::optional<double>& time_s = run.metrics.emergency_restricted_travel_time_s;
    if (baseline == nullptr || !time_s) return time_s;
    const std::optional<double>& without_s = baseline->metrics.emergency_restricted_travel_time_s;
    return without_s ? std::optional(*time_s - *without_s) : std::nullopt;
}

}  // namespace

Headline::Headline(const results::Store& store, core::Settings titles)
    : store_(store), titles_(std::move(titles)) {
    choose();
    for (std::uint32_t replication = 0; replication < store.manifest().replications; ++replication)
        open_.insert(replication);
}

void Headline::choose() {
    const results::Manifest& manifest = store_.manifest();
    scenario_ = manifest.scenarios.front().name;
    condition_ = manifest.conditions.front().name;
    for (const ConditionSpec& condition : manifest.conditions) {
        if (!condition.acts() || condition.traffic_model == experiment::TrafficModel::free_flow) continue;
        const auto baseline = std::ranges::find_if(
            manifest.conditions, [&](const auto& other) { return is_baseline_of(other, condition); });
        if (baseline == manifest.conditions.end()) continue;
        condition_ = condition.name;
        baseline_ = baseline->name;
        return;
    }
}

bool Headline::read(std::uint32_t replication) {
    const experiment::RunKey with{scenario_, condition_, replication};
    const experiment::RunKey without{scenario_, baseline_, replication};
    if (!store_.complete(with) || (!baseline_.empty() && !store_.complete(without))) return false;
    const auto run = store_.read(with);
    const auto baseline = baseline_.empty() ? std::nullopt : store_.read(without);
    if (const auto value = value_of(*run, baseline ? &*baseline : nullptr)) values_s_.push_back(*value);
    if (!baseline) return true;
    objections_.unchecked = run->condition.safety_checks == traffic::SafetyChecks::off;
    objections_.emergency += emergency_outcomes(*run);
    objections_.baseline_emergency += emergency_outcomes(*baseline);
    return true;
}

void Headline::refresh() {
    std::size_t not_there = 0;
    for (auto open = open_.begin(); open != open_.end() && not_there < most_looks;) {
        if (read(*open)) {
            open = open_.erase(open);
        } else {
            ++open;
            ++not_there;
        }
    }
}

MaybeEstimate Headline::estimate() const {
    return estimate_mean(values_s_);
}

std::string Headline::text() const {
    const auto now = estimate();
    if (!now) return "";
    const std::string mean =
        baseline_.empty() ? fmt::format("{:.1f}", now->mean) : fmt::format("{:+.1f}", now->mean);
    std::string text = fmt::format("EV travel time {} s", mean);
    if (now->interval && now->n >= fewest_for_interval)
        text += fmt::format(" [{:.1f}, {:.1f}]", now->interval->low, now->interval->high);
    const auto title = titles_.find(condition_);
    text +=
        fmt::format(", n {}: {} {}", now->n, scenario_, title == titles_.end() ? condition_ : title->second);
    if (objections_.on_emergency()) text += "; " + emergency_objections(objections_);
    return text;
}

}  // namespace clearway::analysis
