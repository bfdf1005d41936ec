#include "report/detail/json.hpp"

#include "report/console.hpp"
#include "report/controls.hpp"
#include "report/published.hpp"
#include "report/safety.hpp"
#include "report/shared_sentences.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

using detail::Json;
using detail::json_of;

/// `count` is known also where there is no mean.
Json to_json(const MaybeEstimate& estimate, const char* count_name, std::optional<std::size_t> count = {}) {
    Json object = {{"mean", json_of(mean_of(estimate))}};
    detail::put_ends(object, shown_interval(estimate));
    object[count_name] = count ? *count : estimate ? estimate->n : 0;
    return object;
}

/// The same with the interval of however few values; null where there is no mean.
Json with_ends(const MaybeEstimate& estimate, const char* low, const char* high) {
    if (!estimate) return nullptr;
    Json object = {{"mean", estimate->mean}};
    detail::put_ends(object, detail::pointer_to(estimate->interval), low, high);
    return object;
}

Json with_count(const MaybeEstimate& estimate) {
    Json object = with_ends(estimate, "low_95", "high_95");
    if (estimate) object["replications"] = estimate->n;
    return object;
}

Json to_json(const analysis::OutcomeCounts& outcomes) {
    return {{"arrived", outcomes.arrived},
            {"running_at_end", outcomes.running_at_end},
            {"teleported", outcomes.teleported},
            {"not_inserted", outcomes.not_inserted},
            {"removed", outcomes.removed}};
}

Json paired_json(const analysis::Comparison& paired) {
    Json object = {{"complete_pairs", paired.complete_pairs},
                   {"incomplete_pairs", paired.incomplete_pairs},
                   {"vehicles_left_out", paired.vehicles_left_out}};
    detail::put_ends(object, detail::pointer_to(paired.bootstrap), "bca_low_95", "bca_high_95");
    object["median"] = json_of(paired.median);
    detail::put_ends(object, detail::pointer_to(paired.median_interval), "median_low_95", "median_high_95");
    object["locked_pairs"] = paired.locked_pairs;
    object["mean_without_locks"] = json_of(mean_of(paired.unlocked));
    detail::put_ends(object, shown_interval(paired.unlocked), "without_locks_low_95",
                     "without_locks_high_95");
    object["effect_size_dz"] = json_of(paired.effect_size);
    object["t_p"] = json_of(paired.t_p);
    object["holm_p"] = json_of(paired.holm_p);
    object["wilcoxon_p"] = json_of(paired.wilcoxon_p);
    return object;
}

Json events_of(const ConditionFacts& condition) {
    Json object;
    for (const char* const metric : event_metrics)
        object[metric] = condition.count(metric);
    return object;
}

Json safety_of(const ConditionFacts& condition) {
    Json result = Json::object();
    for (const SafetyRow& row : safety_rows(condition)) {
        Json& entry = result[row.metric->metric.name] = to_json(row.metric->estimate, "replications");
        if (row.difference()) entry["difference"] = to_json(row.difference(), "pairs");
        if (row.per_1000_km) entry["per_1000_vehicle_km"] = *row.per_1000_km;
    }
    return result;
}

Json to_json(const analysis::Objections& objections) {
    return {{"emergency_vehicles", objections.emergency.total()},
            {"emergency_lost", objections.emergency.lost()},
            {"baseline_emergency_lost", objections.baseline_emergency.lost()},
            {"more_emergency_collisions", objections.collisions.has_value()},
            {"more_others_teleported", objections.teleported.has_value()},
            {"more_others_not_inserted", objections.not_inserted.has_value()},
            {"safety_checks_off", objections.unchecked}};
}

Json to_json(const std::vector<metrics::LeaseRow>& leases) {
    Json rows = Json::array();
    for (const metrics::LeaseRow& lease : leases) {
        rows.push_back({{"policy", lease.policy},
                        {"action", name(lease.action)},
                        {"issued", lease.issued},
                        {"renewed", lease.renewed},
                        {"acted", lease.acted},
                        {"expired", lease.expired},
                        {"refused", lease.refused_words()}});
    }
    return rows;
}

Json measures_of(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    Json result = Json::object();
    for (const MeasureInfo& measure : measures()) {
        Json entry = to_json(condition.value(measure.measure), "replications");
        if (condition.is_compared()) {
            const auto& paired = condition.outcome(measure.measure).comparison;
            entry["difference"] = to_json(condition.difference(measure.measure), "pairs");
            entry["effect"] = core::name(effect_of(condition, measure.measure));
            // Measures that are no metric of a run have no pairs.
            if (paired && paired->complete_pairs + paired->incomplete_pairs > 0)
                entry["paired"] = paired_json(*paired);
        }
        if (is_published(measure.measure)) {
            entry["published"] =
                json_of(published_value(scenario.published_as, condition.name(), measure.measure));
        }
        result[measure.field] = std::move(entry);
    }
    return result;
}

Json to_json(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    Json failed = Json::array();
    for (const FailedRun& run : condition.failed) {
        failed.push_back({{"replication", run.replication}, {"cause", run.cause}});
    }
    const analysis::ResponseTime& response = condition.response;
    Json result = {{"name", condition.name()},
                   {"title", condition.title},
                   {"compared_with", condition.is_compared() ? Json(condition.baseline) : Json(nullptr)},
                   {"safety_checks", condition.is_unchecked() ? "off" : "on"},
                   {"runs", condition.complete_runs},
                   {"failed_runs", std::move(failed)},
                   {"measures", measures_of(scenario, condition)},
                   {"emergency_travel_time_median_s",
                    to_json(condition.travel_time.median, "replications", condition.complete_runs)},
                   {"emergency_travel_time_percentile_95_s",
                    to_json(condition.travel_time.percentile_95, "replications", condition.complete_runs)},
                   {"response_percentile_90_s", to_json(response.percentile_90_s, "replications")},
                   {"response_in_time_1", to_json(response.in_time, "replications")},
                   {"events", events_of(condition)},
                   {"safety", safety_of(condition)},
                   {"locks", detail::locks_json(condition)},
                   {"trips_paired", condition.trip_changes.trips},
                   {"trips_faster", condition.trip_changes.faster},
                   {"trips_slower", condition.trip_changes.slower},
                   {"emergency_outcomes", to_json(condition.emergency)},
                   {"other_outcomes", to_json(condition.others)}};
    if (condition.is_compared()) {
        result["response_percentile_90_s"]["difference"] =
            to_json(response.percentile_90_difference_s, "pairs");
        result["response_in_time_1"]["difference"] = to_json(response.in_time_difference, "pairs");
    }
    if (const analysis::MetIncident& met = condition.met_incident;
        met.vehicles > 0 || !unmet_incident_sentence(scenario, condition).empty())
        result["met_incident"] = {{"emergency_vehicles", met.vehicles},
                                  {"still_meet_it", met.still},
                                  {"travel_time_difference_s", to_json(met.difference_s, "replications")}};
    if (!condition.control_of.empty()) result["control_of"] = condition.control_of;
    for (const Control& control : controls_of(scenario, condition))
        result["controls"].push_back({{"name", control.condition->name()},
                                      {"travel_time_difference_s", to_json(control.difference_s, "pairs")}});
    result["leases"] = to_json(condition.leases);
    if (!condition.factors.empty()) result["factors"] = detail::factors_json(condition.factors);
    if (condition.precision) {
        const bool open = effect_of(condition, Measure::emergency_restricted_time) == Effect::none_shown;
        result["precision"] = {
            {"deviation_s", condition.precision->deviation_s},
            {"replications_needed", open ? Json(condition.precision->needed) : Json(nullptr)}};
        if (const auto& needed = condition.precision->needed_unlocked)
            result["precision"]["replications_needed_without_locks"] = *needed;
    }
    if (condition.is_compared()) result["objections"] = to_json(condition.objections);
    if (condition.is_compared()) result["verdict"] = verdict(scenario, condition, Script::plain).text();
    return result;
}

Json to_json(const std::vector<WideEdge>& edges) {
    Json rows = Json::array();
    for (const WideEdge& edge : edges) {
        rows.push_back({{"edge", edge.edge}, {"street", edge.street}, {"car_lanes", edge.car_lanes}});
    }
    return rows;
}

Json to_json(const FailureCurve& curve) {
    Json repairs = Json::array();
    for (const FailureLine& line : curve.lines) {
        Json points = Json::array();
        for (const FailurePoint& point : line.points) {
            points.push_back(
                {{"dark_share", point.dark_share},
                 {"emergency_restricted_travel_time_difference_s", with_count(point.travel_time)},
                 {"objections", analysis::emergency_objections(point.objections)},
                 {"link_f1", with_count(point.link_f1)}});
        }
        repairs.push_back({{"repair", line.repair},
                           {"break_even_dark_share",
                            line.break_even ? Json(line.points[*line.break_even].dark_share) : Json(nullptr)},
                           {"points", std::move(points)}});
    }
    return {{"scenario", curve.scenario},
            {"policy", curve.policy},
            {"failure", curve.failure},
            {"repairs", std::move(repairs)}};
}

Json to_json(const Sensitivity& sensitivity) {
    Json settings = Json::array();
    for (const SensitivityRow& row : sensitivity.rows) {
        Json levels = Json::array();
        for (const SensitivityLevel& level : row.levels)
            levels.push_back(
                {{"condition", level.condition},
                 {"value", level.value},
                 {"emergency_travel_time_difference_s", with_count(level.emergency)},
                 {"others_time_loss_difference_s", with_count(level.others)},
                 {"objection", level.objection.empty() ? Json(nullptr) : Json(level.objection)}});
        settings.push_back({{"setting", row.setting},
                            {"shipped", row.shipped.empty() ? Json(nullptr) : Json(row.shipped)},
                            {"levels", std::move(levels)}});
    }
    return {{"scenario", sensitivity.scenario},
            {"condition", sensitivity.condition},
            {"settings", std::move(settings)}};
}

Json plan_json(const StudyFacts& study) {
    Json findings = Json::array();
    for (const analysis::PlannedFinding& finding : study.planned) {
        findings.push_back({{"name", finding.comparison.name},
                            {"scenario", finding.scenario},
                            {"condition", finding.comparison.condition},
                            {"against", finding.comparison.against},
                            {"claim", results::name(finding.comparison.claim)},
                            {"pairs", finding.pairs},
                            {"difference_s", with_ends(finding.difference, "low", "high")},
                            {"p", json_of(finding.p)},
                            {"holm_p", json_of(finding.holm_p)},
                            {"margin_s", finding.margin_s},
                            {"shown", analysis::name(finding.shown)}});
    }
    return {{"metric", study.plan->metric}, {"alpha", study.plan->alpha}, {"confirmatory", findings}};
}

}  // namespace

std::string json_tables(const StudyFacts& study) {
    Json scenarios = Json::array();
    for (const ScenarioFacts& scenario : study.scenarios) {
        Json conditions = Json::array();
        for (const ConditionFacts& condition : scenario.conditions) {
            conditions.push_back(to_json(scenario, condition));
        }
        scenarios.push_back({{"name", scenario.name},
                             {"assumptions", scenario.assumptions},
                             {"replications", scenario.replications},
                             {"least_relevant_s", scenario.least_relevant_s},
                             {"response_threshold_s", scenario.response_threshold_s},
                             {"conditions", std::move(conditions)}});
        if (scenario.wide_edges) scenarios.back()["wide_edges"] = to_json(*scenario.wide_edges);
    }
    Json result = {{"title", study.title}};
    if (study.plan) result["plan"] = plan_json(study);
    result["headline"] = headline(study);
    result["scenarios"] = std::move(scenarios);
    for (const FailureCurve& curve : study.failure_curves) {
        result["failure_curves"].push_back(to_json(curve));
    }
    for (const Sensitivity& sensitivity : study.sensitivities) {
        result["sensitivities"].push_back(to_json(sensitivity));
    }
    return detail::to_text(result);
}

}  // namespace clearway::report
