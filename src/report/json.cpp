#include <nlohmann/json.hpp>

#include "report/console.hpp"
#include "report/detail/factors_json.hpp"
#include "report/published.hpp"
#include "report/verdict.hpp"

namespace clearway::report {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json to_json(const Estimate& estimate, const char* count_name) {
    return {{"mean", number_or_null(estimate.mean)},
            {"low_95", estimate.has_interval() ? Json(*estimate.low) : Json(nullptr)},
            {"high_95", estimate.has_interval() ? Json(*estimate.high) : Json(nullptr)},
            {count_name, estimate.count}};
}

Json to_json(const Endings& endings) {
    return {{"arrived", endings.arrived},
            {"running_at_end", endings.running},
            {"teleported", endings.teleported},
            {"not_inserted", endings.not_inserted},
            {"removed", endings.removed}};
}

Json to_json(const PairedStatistics& paired) {
    return {{"complete_pairs", paired.complete_pairs},
            {"incomplete_pairs", paired.incomplete_pairs},
            {"vehicles_left_out", paired.vehicles_left_out},
            {"bca_low_95", number_or_null(paired.bootstrap.low)},
            {"bca_high_95", number_or_null(paired.bootstrap.high)},
            {"median", number_or_null(paired.median.mean)},
            {"median_low_95", number_or_null(paired.median.low)},
            {"median_high_95", number_or_null(paired.median.high)},
            {"effect_size_dz", number_or_null(paired.effect_size)},
            {"t_p", number_or_null(paired.t_p)},
            {"holm_p", number_or_null(paired.holm_p)},
            {"wilcoxon_p", number_or_null(paired.wilcoxon_p)}};
}

Json to_json(const Events& events) {
    return {{"leases_issued", events.leases_issued},
            {"leases_refused", events.leases_refused},
            {"leases_expired", events.leases_expired},
            {"collisions", events.collisions},
            {"emergency_collisions", events.emergency_collisions},
            {"teleports", events.teleports}};
}

Json to_json(const std::vector<SafetyFacts>& safety) {
    Json result = Json::object();
    for (const SafetyFacts& row : safety) {
        Json entry = to_json(row.value, "replications");
        if (row.difference.mean) entry["difference"] = to_json(row.difference, "pairs");
        if (row.per_1000_km) entry["per_1000_vehicle_km"] = *row.per_1000_km;
        result[row.metric] = std::move(entry);
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
                        {"action", lease.action},
                        {"issued", lease.issued},
                        {"renewed", lease.renewed},
                        {"acted", lease.acted},
                        {"expired", lease.expired},
                        {"refused", lease.refused}});
    }
    return rows;
}

Json measures_of(const ScenarioFacts& scenario, const ConditionFacts& condition) {
    Json result = Json::object();
    for (const MeasureInfo& measure : measures()) {
        const Outcome& outcome = condition.outcome(measure.measure);
        Json entry = to_json(outcome.value, "replications");
        if (condition.is_compared()) {
            entry["difference"] = to_json(outcome.difference, "pairs");
            entry["effect"] = core::name(effect_of(condition, measure.measure));
            if (outcome.paired) entry["paired"] = to_json(*outcome.paired);
        }
        if (is_published(measure.measure)) {
            entry["published"] =
                number_or_null(published_value(scenario.published_as, condition.name, measure.measure));
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
    Json result = {
        {"name", condition.name},
        {"title", condition.title},
        {"compared_with",
         condition.is_compared() ? Json(scenario.conditions[*condition.baseline].name) : Json(nullptr)},
        {"safety_checks", condition.safety_checks_off ? "off" : "on"},
        {"runs", condition.runs},
        {"failed_runs", std::move(failed)},
        {"measures", measures_of(scenario, condition)},
        {"emergency_travel_time_median_s", to_json(condition.travel_time_median, "replications")},
        {"emergency_travel_time_percentile_95_s",
         to_json(condition.travel_time_percentile_95, "replications")},
        {"response_percentile_90_s", to_json(condition.response_percentile_90.value, "replications")},
        {"response_in_time_1", to_json(condition.response_in_time.value, "replications")},
        {"events", to_json(condition.events)},
        {"safety", to_json(condition.safety)},
        {"emergency_outcomes", to_json(condition.emergency)},
        {"other_outcomes", to_json(condition.others)}};
    if (condition.is_compared()) {
        result["response_percentile_90_s"]["difference"] =
            to_json(condition.response_percentile_90.difference, "pairs");
        result["response_in_time_1"]["difference"] = to_json(condition.response_in_time.difference, "pairs");
    }
    if (condition.leases) result["leases"] = to_json(*condition.leases);
    if (!condition.factors.empty()) result["factors"] = detail::factors_json(condition.factors);
    if (condition.precision) {
        const bool open = effect_of(condition, Measure::emergency_restricted_time) == Effect::none_shown;
        result["precision"] = {
            {"deviation_s", condition.precision->deviation_s},
            {"replications_needed", open ? Json(condition.precision->needed) : Json(nullptr)}};
    }
    if (condition.is_compared()) result["objections"] = to_json(condition.objections);
    if (condition.is_compared()) result["verdict"] = verdict(scenario, condition, Script::plain);
    return result;
}

Json to_json(const std::vector<WideEdge>& edges) {
    Json rows = Json::array();
    for (const WideEdge& edge : edges) {
        rows.push_back({{"edge", edge.edge}, {"street", edge.street}, {"car_lanes", edge.car_lanes}});
    }
    return rows;
}

Json to_json(const std::optional<analysis::Estimate>& estimate) {
    if (!estimate) return nullptr;
    const auto& interval = estimate->interval;
    return {{"mean", estimate->mean},
            {"low_95", interval ? Json(interval->low) : Json(nullptr)},
            {"high_95", interval ? Json(interval->high) : Json(nullptr)},
            {"replications", estimate->n}};
}

Json to_json(const FailureCurve& curve) {
    Json repairs = Json::array();
    for (const FailureLine& line : curve.lines) {
        Json points = Json::array();
        for (const FailurePoint& point : line.points) {
            points.push_back({{"dark_share", point.dark_share},
                              {"emergency_restricted_travel_time_difference_s", to_json(point.travel_time)},
                              {"objections", analysis::emergency_objections(point.objections)},
                              {"link_f1", to_json(point.link_f1)}});
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
                 {"emergency_travel_time_difference_s", to_json(level.emergency)},
                 {"others_time_loss_difference_s", to_json(level.others)},
                 {"objection", level.objection.empty() ? Json(nullptr) : Json(level.objection)}});
        settings.push_back({{"setting", row.setting},
                            {"shipped", row.shipped.empty() ? Json(nullptr) : Json(row.shipped)},
                            {"levels", std::move(levels)}});
    }
    return {{"scenario", sensitivity.scenario},
            {"condition", sensitivity.condition},
            {"settings", std::move(settings)}};
}

/// The interval has the level of the plan.
Json with_bounds(const std::optional<analysis::Estimate>& estimate) {
    if (!estimate) return nullptr;
    const auto& interval = estimate->interval;
    return {{"mean", estimate->mean},
            {"low", interval ? Json(interval->low) : Json(nullptr)},
            {"high", interval ? Json(interval->high) : Json(nullptr)}};
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
                            {"difference_s", with_bounds(finding.difference)},
                            {"p", number_or_null(finding.p)},
                            {"holm_p", number_or_null(finding.holm_p)},
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
                             {"replications", scenario.replications},
                             {"least_relevant_s", scenario.least_relevant_s},
                             {"response_threshold_s", scenario.response_threshold_s},
                             {"conditions", std::move(conditions)}});
        if (scenario.wide_edges) scenarios.back()["wide_edges"] = to_json(*scenario.wide_edges);
    }
    Json result = {
        {"title", study.title}, {"headline", headline(study)}, {"scenarios", std::move(scenarios)}};
    if (study.plan) result["plan"] = plan_json(study);
    for (const FailureCurve& curve : study.failure_curves) {
        result["failure_curves"].push_back(to_json(curve));
    }
    for (const Sensitivity& sensitivity : study.sensitivities) {
        result["sensitivities"].push_back(to_json(sensitivity));
    }
    return result.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace clearway::report
