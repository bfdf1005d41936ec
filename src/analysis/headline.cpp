#include "analysis/headline.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "analysis/detail/pairing.hpp"

namespace clearway::analysis {
namespace {

using experiment::ConditionSpec;

/// Replications are run in their order, so beyond so many that are not there none is looked for.
constexpr std::size_t most_looks = 1000;

bool is_baseline_of(const ConditionSpec& other, const ConditionSpec& condition) {
    return other.engine == condition.engine && !other.acts() && other.name != condition.name;
}

/// Travel time of the emergency vehicles of a run, against another run's where there is one.
std::optional<double> value_of(const results::RunRecord& run, const results::RunRecord* baseline) {
    if (baseline == nullptr) return run.metrics.emergency_travel_time_s;
    const std::array runs = {&run, baseline};
    const auto common = detail::common_means(runs, &metrics::VehicleRow::travel_time_s);
    if (!common) return std::nullopt;
    return common->means[0] - common->means[1];
}

}  // namespace

Headline::Headline(const results::Store& store) : store_(store) {
    choose();
    for (std::uint32_t replication = 0; replication < store.manifest().replications; ++replication)
        open_.insert(replication);
}

void Headline::choose() {
    const results::Manifest& manifest = store_.manifest();
    scenario_ = manifest.scenarios.front().name;
    condition_ = manifest.conditions.front().name;
    for (const ConditionSpec& condition : manifest.conditions) {
        if (!condition.acts() || condition.engine == experiment::Engine::solo) continue;
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

std::optional<Estimate> Headline::estimate() const {
    return estimate_mean(values_s_);
}

std::string Headline::text() const {
    const auto now = estimate();
    if (!now) return "";
    const std::string mean =
        baseline_.empty() ? fmt::format("{:.1f}", now->mean) : fmt::format("{:+.1f}", now->mean);
    std::string text = fmt::format("{} {}: EV travel time {} s", scenario_, condition_, mean);
    if (now->interval) text += fmt::format(" [{:.1f}, {:.1f}]", now->interval->low, now->interval->high);
    return text + fmt::format(", n {}", now->n);
}

}  // namespace clearway::analysis
