#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include <fmt/format.h>

#include "core/csv.hpp"
#include "report/detail/json.hpp"
#include "report/links.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using analysis::Measured;
using detail::Json;
using links::LinkGain;
using links::LinkMeasures;
using links::LinkResult;
using links::LinkSubset;

constexpr std::size_t failure_width = 9;
constexpr std::size_t predictor_width = 22;  ///< With the columns, a row takes 80.
constexpr std::size_t column_width = 8;

const LinkResult* pooled(const LinkFacts& facts, links::Exits exits, const std::string& failure,
                         const std::string& predictor) {
    const auto found = std::ranges::find_if(facts.results, [&](const LinkResult& result) {
        return result.exits == exits && result.failure == failure && result.predictor == predictor &&
               (result.scenario.empty() || facts.scenarios.size() == 1);
    });
    return found == facts.results.end() ? nullptr : &*found;
}

/// `.984`, `1.000`; a dash if undefined.
std::string share(const std::optional<double>& value, int decimals = 4) {
    if (!value) return "-";
    std::string text = fmt::format("{:.{}f}", *value, decimals);
    return text.starts_with("0.") ? text.substr(1) : text;
}

std::string metres(const std::optional<double>& value) {
    return value ? fmt::format("{:.1f}", *value) : "-";
}

std::string percent(const Measured& measured) {
    if (!measured.value) return "-";
    if (*measured.value < -9.99) return "below -999";
    std::string text = fmt::format("{:.0f}", 100.0 * *measured.value);
    if (measured.interval) {
        text +=
            fmt::format(" [{:.0f}, {:.0f}]", 100.0 * measured.interval->low, 100.0 * measured.interval->high);
    }
    return text;
}

/// A table of failures by predictors.
void append_matrix(const LinkFacts& facts, const std::vector<std::string>& predictors, std::size_t width,
                   const std::function<std::string(const std::string&, const std::string&)>& cell,
                   std::string& text) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{:<{}}", "", failure_width);
    for (const std::string& predictor : predictors)
        fmt::format_to(out, "  {:>{}}", predictor, std::max(width, predictor.size()));
    text += '\n';
    for (const std::string& failure : facts.failures) {
        fmt::format_to(out, "{:<{}}", failure, failure_width);
        for (const std::string& predictor : predictors)
            fmt::format_to(out, "  {:>{}}", cell(failure, predictor), std::max(width, predictor.size()));
        text += '\n';
    }
}

void append_gains(const LinkFacts& facts, links::Exits exits, const char* what, Measured LinkGain::*measure,
                  std::string& text) {
    std::vector<std::string> others;
    std::ranges::copy_if(facts.predictors, std::back_inserter(others),
                         [&](const std::string& name) { return name != facts.against; });
    if (facts.against.empty() || others.empty()) return;
    fmt::format_to(std::back_inserter(text), "\n{} below that of {}, %, exits {}{}\n", what, facts.against,
                   core::name(exits), facts.exploratory_gains ? " (exploratory)" : "");
    append_matrix(
        facts, others, 14,
        [&](const std::string& failure, const std::string& predictor) {
            const auto found = std::ranges::find_if(facts.gains, [&](const LinkGain& gain) {
                return gain.exits == exits && gain.failure == failure && gain.predictor == predictor;
            });
            return found == facts.gains.end() ? "-" : percent((*found).*measure);
        },
        text);
}

const char* comparisons_are(const LinkFacts& facts) {
    return facts.confirmatory ? "confirmatory" : "exploratory: a part of the benchmark";
}

void append_row(std::string_view failure, std::string_view predictor, const std::vector<std::string>& cells,
                std::string& text) {
    auto out = std::back_inserter(text);
    if (failure.size() > failure_width) {
        fmt::format_to(out, "{}\n", failure);
        failure = "";
    }
    fmt::format_to(out, "{:<{}} {:<{}}", failure, failure_width, predictor, predictor_width);
    for (const std::string& cell : cells)
        fmt::format_to(out, "{:>{}}", cell, column_width);
    text += '\n';
}

/// A table of the pooled results, one row each, with the failure at its first predictor.
void append_rows(const LinkFacts& facts, links::Exits exits, const std::vector<std::string>& head,
                 const std::function<std::vector<std::string>(const LinkResult&)>& cells, std::string& text) {
    append_row("failure", "predictor", head, text);
    for (const std::string& failure : facts.failures) {
        std::string_view shown = failure;
        for (const std::string& predictor : facts.predictors) {
            const LinkResult* const result = pooled(facts, exits, failure, predictor);
            if (result == nullptr) continue;
            append_row(shown, predictor, cells(*result), text);
            shown = "";
        }
    }
}

void append_measures(const LinkFacts& facts, links::Exits exits, std::string& text) {
    auto out = std::back_inserter(text);
    fmt::format_to(out,
                   "Links, exits {}: over the candidates; the candidates' share of all failed\n"
                   "links (recall); and over all failed links\n",
                   core::name(exits));
    append_rows(
        facts, exits, {"AP", "F1", "recall", "AP all", "F1 all"},
        [](const LinkResult& result) -> std::vector<std::string> {
            const LinkMeasures& all = result.of(LinkSubset::all);
            return {share(all.ap.value), share(all.f1.value), share(result.failed.candidate_recall.value),
                    share(result.failed.ap.value), share(result.failed.f1.value)};
        },
        text);
    fmt::format_to(out,
                   "\nCalibration; dark vehicles: share believed, place error in m; next vehicle ahead\nin "
                   "the lane; exits {}\n",
                   core::name(exits));
    append_rows(
        facts, exits, {"ECE", "Brier", "known", "median", "95 %", "next"},
        [](const LinkResult& result) -> std::vector<std::string> {
            const LinkMeasures& all = result.of(LinkSubset::all);
            const links::LinkDark& dark = result.dark;
            return {share(all.ece.value),           share(all.brier.value),
                    share(dark.believed.value),     metres(dark.place_median_m.value),
                    metres(dark.place_p95_m.value), share(dark.next_ahead.value)};
        },
        text);
}

/// `+.0042 [+.0031, +.0052]  p .004`, with the adjusted p-value.
std::string difference_text(const links::LinkComparison::Difference& test) {
    if (!test.difference.value) return "-";
    const auto signed_share = [](double value) { return (value < 0.0 ? "-" : "+") + share(std::abs(value)); };
    std::string text = signed_share(*test.difference.value);
    if (test.difference.interval)
        text += fmt::format(" [{}, {}]", signed_share(test.difference.interval->low),
                            signed_share(test.difference.interval->high));
    if (!test.holm_p) return text + "  p -";
    return text + (*test.holm_p < 0.001 ? "  p<.001" : "  p " + share(test.holm_p, 3));
}

void append_comparisons(const LinkFacts& facts, links::Exits exits, std::string& text) {
    auto out = std::back_inserter(text);
    std::optional<links::ComparedPair> pair;
    for (const links::LinkComparison& one : facts.comparisons) {
        if (one.exits != exits) continue;
        if (!pair)
            fmt::format_to(out,
                           "\nComparisons named in advance, exits {} ({}): difference of AP, then\n"
                           "of F1; p adjusted by Holm for all {} tests\n",
                           core::name(exits), comparisons_are(facts), 2 * facts.comparisons.size());
        if (pair != one.pair) fmt::format_to(out, "{} minus {}\n", one.pair.predictor, one.pair.against);
        pair = one.pair;
        if (one.failure.size() > failure_width) fmt::format_to(out, "{}\n", one.failure);
        fmt::format_to(out, "{:<{}} {:<34} {}\n", one.failure.size() > failure_width ? "" : one.failure,
                       failure_width, difference_text(one.ap), difference_text(one.f1));
    }
}

void append_exits(const LinkFacts& facts, links::Exits exits, std::string& text) {
    append_measures(facts, exits, text);
    append_comparisons(facts, exits, text);
    append_gains(facts, exits, "1 - AP", &LinkGain::ap_error_reduction, text);
    append_gains(facts, exits, "1 - F1", &LinkGain::f1_error_reduction, text);
}

void put(Json& object, const std::string& name, const Measured& measured) {
    object[name] = detail::json_of(measured.value);
    detail::put_ends(object, detail::pointer_to(measured.interval), name + "_low_95", name + "_high_95");
}

void put_measures(Json& object, const std::string& prefix, const LinkMeasures& measures) {
    object[prefix + "pairs"] = measures.pairs;
    object[prefix + "true_links"] = measures.true_links;
    put(object, prefix + "ap", measures.ap);
    put(object, prefix + "auc", measures.auc);
    put(object, prefix + "f1", measures.f1);
    put(object, prefix + "log_loss", measures.log_loss);
    put(object, prefix + "ece", measures.ece);
    put(object, prefix + "brier", measures.brier);
}

void put_failed(Json& object, const links::LinkFailed& failed) {
    object["failed_links"] = failed.links;
    object["failed_links_seen"] = failed.seen;
    put(object, "candidate_recall", failed.candidate_recall);
    put(object, "candidate_recall_seen", failed.candidate_recall_seen);
    put(object, "ap_failed", failed.ap);
    put(object, "f1_failed", failed.f1);
}

void put_dark(Json& object, const links::LinkDark& dark) {
    object["dark_vehicles"] = dark.vehicles;
    object["dark_never_seen"] = dark.never_seen;
    put(object, "dark_believed", dark.believed);
    put(object, "place_error_median_m", dark.place_median_m);
    put(object, "place_error_p95_m", dark.place_p95_m);
    object["next_ahead_cases"] = dark.next_cases;
    put(object, "next_ahead_accuracy", dark.next_ahead);
}

void put_end_to_end(Json& object, const links::LinkEndToEnd& end_to_end) {
    object["reports"] = end_to_end.truth.reports;
    object["all_true_links"] = end_to_end.truth.true_links;
    put(object, "end_to_end_precision", end_to_end.precision);
    put(object, "end_to_end_recall", end_to_end.recall);
    put(object, "end_to_end_f1", end_to_end.f1);
    object["lost_never_seen"] = end_to_end.truth.never_seen;
    object["lost_outside_candidates"] = end_to_end.truth.outside;
    object["lost_predicted_away"] = end_to_end.predicted_away();
    object["policy_links"] = end_to_end.truth.policy_links;
    put(object, "policy_recall", end_to_end.policy_recall);
    object["ghosts_per_report"] = detail::json_of(end_to_end.ghosts_per_report());
}

/// Every field of a result, flat.
Json row_of(const LinkResult& result) {
    Json row = {{"scenario", result.scenario.empty() ? Json(nullptr) : Json(result.scenario)},
                {"failure", result.failure},
                {"exits", core::name(result.exits)},
                {"predictor", result.predictor}};
    put_measures(row, "", result.of(LinkSubset::all));
    row["f1_threshold"] = result.threshold;
    put_measures(row, "hard_", result.of(LinkSubset::hard));
    put_measures(row, "policy_", result.of(LinkSubset::policy));
    put_end_to_end(row, result.end_to_end);
    put_failed(row, result.failed);
    put_dark(row, result.dark);
    row["us_per_report"] = result.report_us;
    row["vehicles_per_report"] = result.report_vehicles;
    return row;
}

Json gain_of(const LinkGain& gain) {
    Json row = {{"failure", gain.failure},
                {"exits", core::name(gain.exits)},
                {"predictor", gain.predictor},
                {"against", gain.against}};
    put(row, "ap_difference", gain.ap_difference);
    put(row, "ap_error_reduction", gain.ap_error_reduction);
    put(row, "f1_error_reduction", gain.f1_error_reduction);
    return row;
}

void put(Json& object, const std::string& name, const links::LinkComparison::Difference& test) {
    put(object, name + "_difference", test.difference);
    object[name + "_p"] = detail::json_of(test.p);
    object[name + "_p_holm"] = detail::json_of(test.holm_p);
}

Json comparison_of(const links::LinkComparison& comparison) {
    Json row = {{"failure", comparison.failure},
                {"exits", core::name(comparison.exits)},
                {"predictor", comparison.pair.predictor},
                {"against", comparison.pair.against}};
    put(row, "ap", comparison.ap);
    put(row, "f1", comparison.f1);
    return row;
}

std::string csv_cell(const Json& value) {
    if (value.is_null()) return "";
    if (value.is_number_float()) return fmt::format("{}", value.get<double>());
    if (!value.is_string()) return value.dump();
    return core::csv_text(value.get<std::string>());
}

}  // namespace

std::string links_console(const LinkFacts& facts) {
    std::string text = fmt::format("{}: {} seeds ({})\n", facts.title, facts.split, facts.seeds);
    if (facts.runs < facts.scenarios.size() + analysis::fewest_for_interval - 1)
        text += fmt::format("Too few for intervals and tests: {} in {}.\n", counted(facts.runs, "run"),
                            counted(facts.scenarios.size(), "scenario"));
    text += '\n';
    for (const links::Exits exits : facts.exits) {
        append_exits(facts, exits, text);
        text += '\n';
    }
    return text;
}

std::string links_json(const LinkFacts& facts) {
    Json document = {{"title", facts.title}, {"split", facts.split},         {"study_seed", facts.study_seed},
                     {"seeds", facts.seeds}, {"scenarios", facts.scenarios}, {"against", facts.against}};
    Json& results = document["results"] = Json::array();
    for (const LinkResult& result : facts.results)
        results.push_back(row_of(result));
    Json& gains = document["gains"] = Json::array();
    for (const LinkGain& gain : facts.gains)
        gains.push_back(gain_of(gain));
    if (!facts.comparisons.empty()) {
        document["confirmatory"] = facts.confirmatory;
        Json& comparisons = document["comparisons"] = Json::array();
        for (const links::LinkComparison& comparison : facts.comparisons)
            comparisons.push_back(comparison_of(comparison));
    }
    return detail::to_text(document);
}

std::string links_csv(const LinkFacts& facts) {
    std::string text;
    for (const LinkResult& result : facts.results) {
        const Json row = row_of(result);
        std::string head;
        std::string cells;
        for (const auto& [name, value] : row.items()) {
            const char* const comma = head.empty() ? "" : ",";
            head += comma + name;
            cells += comma + csv_cell(value);
        }
        if (text.empty()) text = head + "\n";
        text += cells + "\n";
    }
    return text;
}

}  // namespace clearway::report
