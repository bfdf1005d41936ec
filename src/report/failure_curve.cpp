#include "report/failure_curve.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "core/number.hpp"
#include "experiment/settings.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

constexpr std::string_view share_field = "dark_share=";
constexpr const char* perfect = "perfect";

/// The text of a failure, split into the share of time dark and the rest.
struct FailureText {
    std::optional<double> dark_share;
    std::string rest;
};

FailureText take_apart(std::string_view text) {
    FailureText result;
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        std::string item(text.substr(0, comma));
        text.remove_prefix(std::min(comma + 1, text.size()));
        std::erase(item, ' ');
        const auto share = item.starts_with(share_field)
                               ? core::number_from(std::string_view(item).substr(share_field.size()))
                               : std::nullopt;
        if (share) {
            result.dark_share = *share;
        } else {
            result.rest += (result.rest.empty() ? "" : ",") + item;
        }
    }
    return result;
}

FailurePoint point_of(double dark_share, const analysis::ConditionSummary& condition) {
    FailurePoint point{dark_share, std::nullopt, std::nullopt, {}};
    if (experiment::reads_links(condition.condition)) point.link_f1 = condition.metric("links_f1").estimate;
    const auto& comparison = condition.metric(analysis::primary_metric).comparison;
    if (comparison) point.travel_time = comparison->difference;
    point.objections = condition.objections;
    return point;
}

bool shows_benefit(const FailurePoint& point) {
    return !point.objections.on_emergency() && point.travel_time &&
           point.travel_time->n >= analysis::fewest_for_interval && point.travel_time->interval &&
           point.travel_time->interval->high < 0.0;
}

std::string benefit_word(const FailurePoint& point) {
    if (point.objections.on_emergency()) return analysis::emergency_objection_word(point.objections);
    return shows_benefit(point) ? "shown" : "not shown";
}

void finish(FailureLine& line) {
    std::ranges::stable_sort(line.points, {}, &FailurePoint::dark_share);
    const auto first = std::ranges::find_if_not(line.points, shows_benefit);
    if (first != line.points.end()) line.break_even = static_cast<std::size_t>(first - line.points.begin());
}

/// The first element that `fits`; if there is none, `fresh` is appended.
template <class Element, class Fits>
Element& find_or_add(std::vector<Element>& elements, const Fits& fits, Element fresh) {
    const auto found = std::ranges::find_if(elements, fits);
    if (found != elements.end()) return *found;
    return elements.emplace_back(std::move(fresh));
}

std::string policy_of(const experiment::ConditionSpec& condition) {
    std::string text = fmt::format("{}", fmt::join(condition.policies, " + "));
    if (condition.traffic_model != experiment::TrafficModel::standard)
        text += fmt::format(" ({})", experiment::name(condition.traffic_model));
    const std::string settings = experiment::settings_text(condition);
    return settings.empty() ? text : fmt::format("{}, {}", text, settings);
}

bool is_compared(const analysis::ConditionSummary& condition) {
    return !condition.baseline.empty() && !condition.condition.policies.empty();
}

void add_conditions(const analysis::ScenarioSummary& scenario, std::vector<FailureCurve>& curves) {
    for (const analysis::ConditionSummary& condition : scenario.conditions) {
        const FailureText failure = take_apart(condition.condition.failure);
        if (!is_compared(condition) || !failure.dark_share) continue;
        const std::string policy = policy_of(condition.condition);
        FailureCurve& curve = find_or_add(
            curves,
            [&](const FailureCurve& one) { return one.policy == policy && one.failure == failure.rest; },
            {scenario.scenario, policy, failure.rest, {}});
        FailureLine& line = find_or_add(
            curve.lines, [&](const FailureLine& one) { return one.repair == condition.condition.predictor; },
            {condition.condition.predictor, {}, std::nullopt});
        line.points.push_back(point_of(*failure.dark_share, condition));
    }
}

std::set<double> shares_of(const FailureCurve& curve) {
    std::set<double> shares;
    for (const FailureLine& line : curve.lines) {
        for (const FailurePoint& point : line.points) {
            shares.insert(point.dark_share);
        }
    }
    return shares;
}

void add_perfect(const analysis::ScenarioSummary& scenario, FailureCurve& curve) {
    for (const analysis::ConditionSummary& condition : scenario.conditions) {
        if (!is_compared(condition) || condition.condition.failure != perfect ||
            policy_of(condition.condition) != curve.policy)
            continue;
        FailureLine line{perfect, {}, std::nullopt};
        for (const double share : shares_of(curve)) {
            line.points.push_back(point_of(share, condition));
        }
        curve.lines.push_back(std::move(line));
        return;
    }
}

}  // namespace

std::vector<FailureCurve> failure_curves(const analysis::Summary& summary) {
    std::vector<FailureCurve> all;
    for (const analysis::ScenarioSummary& scenario : summary.scenarios) {
        std::vector<FailureCurve> curves;
        add_conditions(scenario, curves);
        std::erase_if(curves, [](const FailureCurve& curve) { return shares_of(curve).size() < 2; });
        for (FailureCurve& curve : curves) {
            add_perfect(scenario, curve);
            std::ranges::for_each(curve.lines, finish);
        }
        std::ranges::move(curves, std::back_inserter(all));
    }
    return all;
}

std::string failure_table(const std::vector<FailureCurve>& curves) {
    std::string text;
    auto out = std::back_inserter(text);
    for (const FailureCurve& curve : curves) {
        fmt::format_to(out, "{:=<80}\nBenefit against failure: {}, policy {}{}{}\n\n", "", curve.scenario,
                       curve.policy, curve.failure.empty() ? "" : "; failure ", curve.failure);
        fmt::format_to(out, "{:<22}{:>6}  {:<20}{:<20}{}\n{:-<80}\n", "Repair", "dark", "EV time, diff., s",
                       "link F1", "benefit", "");
        for (const FailureLine& line : curve.lines) {
            for (std::size_t at = 0; at < line.points.size(); ++at) {
                const FailurePoint& point = line.points[at];
                fmt::format_to(out, "{:<22}{:>4.0f} %  {:<20}{:<20}{}{}\n", at == 0 ? line.repair : "",
                               100.0 * point.dark_share,
                               estimate(point.travel_time, {.decimals = 1, .sign = Sign::ends_too}),
                               estimate(point.link_f1, {.decimals = 3}), benefit_word(point),
                               line.break_even == at ? "*" : "");
            }
        }
        text += "*: break-even, the first share at which no benefit is shown\n\n";
    }
    return text;
}

}  // namespace clearway::report
