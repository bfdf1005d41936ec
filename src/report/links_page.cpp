#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/detail/axes.hpp"
#include "report/detail/link_figures.hpp"
#include "report/detail/markup.hpp"
#include "report/detail/plain_page.hpp"
#include "report/detail/table_files.hpp"
#include "report/links.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using analysis::Measured;
using detail::DataTable;
using detail::PageSection;
using links::LinkGain;
using links::LinkResult;
using links::LinkSubset;

std::string decimal(const std::optional<double>& value, int decimals) {
    return number_or_dash(value, {decimals, Script::typeset});
}

/// `0.985 [0.981, 0.988]`, scaled by `factor`.
std::string with_interval(const Measured& measured, int decimals, double factor = 1.0) {
    if (!measured.value) return missing(Script::typeset);
    const NumberStyle style{decimals, Script::typeset};
    const std::string text = number(factor * *measured.value, style);
    return measured.interval ? text + " " + interval_text(*measured.interval, style, factor) : text;
}

std::string in_percent(const Measured& measured, int decimals = 1) {
    return with_interval(measured, decimals, 100.0);
}

bool is_pooled(const LinkFacts& facts, const LinkResult& result) {
    return result.scenario.empty() || facts.scenarios.size() == 1;
}

/// Pooled results of one failure, in the order of the predictors.
std::vector<const LinkResult*> pooled(const LinkFacts& facts, links::Exits exits,
                                      const std::string& failure) {
    std::vector<const LinkResult*> found;
    for (const LinkResult& result : facts.results) {
        if (is_pooled(facts, result) && result.exits == exits && result.failure == failure)
            found.push_back(&result);
    }
    return found;
}

/// Line style of each drawn predictor: the best by mean AP, as many as can be told apart.
std::map<std::string, std::size_t> series_of(const LinkFacts& facts) {
    std::map<std::string, double> sums;
    for (const LinkResult& result : facts.results) {
        if (is_pooled(facts, result))
            sums[result.predictor] += result.of(LinkSubset::all).ap.value.value_or(0.0);
    }
    std::vector<std::string> names = facts.predictors;
    std::ranges::stable_sort(names, std::greater{}, [&](const std::string& name) { return sums[name]; });
    constexpr std::size_t most_drawn = 7;  // more lines hide each other
    if (names.size() > most_drawn) names.resize(most_drawn);
    std::map<std::string, std::size_t> series;
    for (const std::string& name : facts.predictors) {
        if (core::contains(names, name)) series.emplace(name, series.size() + 1);
    }
    return series;
}

using Cell = std::function<std::string(const std::string& failure, const std::string& predictor)>;

/// Failures by predictors.
DataTable matrix_of(const LinkFacts& facts, const std::string& left_out, const Cell& cell) {
    DataTable table{{"Failure"}, {}};
    for (const std::string& predictor : facts.predictors) {
        if (predictor != left_out) table.head.push_back(predictor);
    }
    for (const std::string& failure : facts.failures) {
        std::vector<std::string>& row = table.rows.emplace_back();
        row.push_back(failure);
        for (const std::string& predictor : facts.predictors) {
            if (predictor != left_out) row.push_back(cell(failure, predictor));
        }
    }
    return table;
}

std::string matrix(const LinkFacts& facts, links::Exits exits, const std::string& left_out,
                   const Cell& cell) {
    return fmt::format("<h3>Exits {}</h3>\n{}", core::name(exits),
                       detail::to_html(matrix_of(facts, left_out, cell)));
}

/// A cell of a matrix: a measure of pooled results with its interval.
Cell pooled_cell(const LinkFacts& facts, links::Exits exits, int decimals,
                 const std::function<Measured(const LinkResult&)>& measure) {
    return [&facts, exits, decimals, measure](const std::string& failure, const std::string& predictor) {
        for (const LinkResult* const result : pooled(facts, exits, failure)) {
            if (result->predictor == predictor) return with_interval(measure(*result), decimals);
        }
        return missing(Script::typeset);
    };
}

std::string measure_section(const LinkFacts& facts, int decimals,
                            const std::function<Measured(const LinkResult&)>& measure) {
    std::string html;
    for (const links::Exits exits : facts.exits)
        html += matrix(facts, exits, "", pooled_cell(facts, exits, decimals, measure));
    return html;
}

std::string gains_section(const LinkFacts& facts, Measured LinkGain::*measure) {
    std::string html;
    for (const links::Exits exits : facts.exits) {
        html += matrix(
            facts, exits, facts.against, [&](const std::string& failure, const std::string& predictor) {
                for (const LinkGain& gain : facts.gains) {
                    if (gain.exits == exits && gain.failure == failure && gain.predictor == predictor)
                        return in_percent(gain.*measure, 0);
                }
                return missing(Script::typeset);
            });
    }
    return html;
}

std::string curves_of(const LinkFacts& facts, links::Exits exits, const std::string& failure,
                      const std::map<std::string, std::size_t>& series) {
    std::vector<detail::DrawnResult> drawn;
    for (const LinkResult* const result : pooled(facts, exits, failure)) {
        const auto found = series.find(result->predictor);
        if (found != series.end()) drawn.push_back({result, found->second});
    }
    const std::string figures = detail::precision_recall_figure(drawn) + detail::reliability_figure(drawn) +
                                detail::age_figure(drawn);
    if (figures.empty()) return {};
    return fmt::format("<h3>{}</h3>\n<div class=\"figures\">\n{}</div>\n", escaped(failure), figures);
}

std::string curves_section(const LinkFacts& facts) {
    const std::map<std::string, std::size_t> series = series_of(facts);
    std::string html;
    if (series.size() < facts.predictors.size()) {
        html += fmt::format("<p class=\"note\">The {} predictors with the best mean AP are drawn.</p>\n",
                            series.size());
    }
    for (const links::Exits exits : facts.exits) {
        std::string figures;
        for (const std::string& failure : facts.failures)
            figures += curves_of(facts, exits, failure, series);
        html += fmt::format("<details{}><summary>Exits {}</summary>\n{}</details>\n",
                            exits == facts.exits.front() ? " open" : "", core::name(exits), figures);
    }
    return html;
}

std::string grouped_share(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return missing(Script::typeset);
    return number(100.0 * static_cast<double>(part) / static_cast<double>(whole), {1, Script::typeset});
}

std::string end_to_end_section(const LinkFacts& facts) {
    std::string html;
    for (const links::Exits exits : facts.exits) {
        DataTable table{{"Failure, predictor", "precision", "recall", "F1", "policy\u2019s links found, %",
                         "lost: never seen, %", "outside, %", "predicted away, %", "ghosts per report",
                         "\u00b5s per report", "vehicles"},
                        {}};
        for (const std::string& failure : facts.failures) {
            for (const LinkResult* const result : pooled(facts, exits, failure)) {
                const links::LinkEndToEnd& all = result->end_to_end;
                table.rows.push_back({failure + ", " + result->predictor, decimal(all.precision.value, 3),
                                      decimal(all.recall.value, 3), decimal(all.f1.value, 3),
                                      in_percent(all.policy_recall),
                                      grouped_share(all.truth.never_seen, all.truth.true_links),
                                      grouped_share(all.truth.outside, all.truth.true_links),
                                      grouped_share(all.predicted_away(), all.truth.true_links),
                                      decimal(all.ghosts_per_report(), 1), decimal(result->report_us, 0),
                                      decimal(result->report_vehicles, 0)});
            }
        }
        html += fmt::format("<details><summary>Exits {}</summary>\n{}</details>\n", core::name(exits),
                            detail::to_html(table));
    }
    return html;
}

/// One row per failure and predictor, one table for each exits.
std::string results_section(const LinkFacts& facts, const std::vector<std::string>& head,
                            const std::function<std::vector<std::string>(const LinkResult&)>& cells) {
    std::string html;
    for (const links::Exits exits : facts.exits) {
        DataTable table{{"Failure, predictor"}, {}};
        table.head.insert(table.head.end(), head.begin(), head.end());
        for (const std::string& failure : facts.failures) {
            for (const LinkResult* const result : pooled(facts, exits, failure)) {
                std::vector<std::string>& row = table.rows.emplace_back();
                row.push_back(failure + ", " + result->predictor);
                std::ranges::move(cells(*result), std::back_inserter(row));
            }
        }
        html += fmt::format("<h3>Exits {}</h3>\n{}", core::name(exits), detail::to_html(table));
    }
    return html;
}

std::string comparisons_section(const LinkFacts& facts) {
    DataTable table{{"Comparison", "failure", "exits", "AP, difference", "p", "p (Holm)", "F1, difference",
                     "p", "p (Holm)"},
                    {}};
    for (const links::LinkComparison& one : facts.comparisons) {
        table.rows.push_back({one.pair.predictor + " \u2212 " + one.pair.against, one.failure,
                              std::string(core::name(one.exits)), with_interval(one.ap.difference, 4),
                              p_words(one.ap.p, Script::typeset), p_words(one.ap.holm_p, Script::typeset),
                              with_interval(one.f1.difference, 4), p_words(one.f1.p, Script::typeset),
                              p_words(one.f1.holm_p, Script::typeset)});
    }
    return fmt::format(
        "<p>The benchmark names these comparisons in advance. {} p: two-sided, bootstrap over runs; "
        "p (Holm): adjusted for all {} tests of this table.</p>\n{}",
        facts.confirmatory
            ? "They are confirmatory; all others on this page are exploratory."
            : "Only part of the benchmark was run here, so they are exploratory, like all others.",
        2 * facts.comparisons.size(), detail::to_html(table));
}

std::string failed_section(const LinkFacts& facts) {
    return "<p>A link has failed when it is true and the observation neither knows nor detects it. "
           "Candidates "
           "are a part of the failed links, and no predictor finds the others: here they count as "
           "missed.</p>\n" +
           results_section(facts,
                           {"failed links", "candidates\u2019 share, %", "of those seen, %", "AP over all",
                            "F1 over all"},
                           [](const LinkResult& result) -> std::vector<std::string> {
                               const links::LinkFailed& failed = result.failed;
                               return {grouped(failed.links), in_percent(failed.candidate_recall),
                                       in_percent(failed.candidate_recall_seen), with_interval(failed.ap, 4),
                                       with_interval(failed.f1, 4)};
                           });
}

std::string dark_section(const LinkFacts& facts) {
    return "<p>Dark vehicles are on the road and were not heard just now. The place error is the distance "
           "from "
           "the true to the believed place, of those that are believed. The last columns say how often "
           "the belief is right about which vehicle is next within 100 m ahead in the lane of an emergency "
           "or "
           "automated vehicle, over the cases in which the true or the believed one is dark.</p>\n" +
           results_section(facts,
                           {"dark", "never seen", "believed, %", "place error: median, m", "95 %, m", "cases",
                            "right, %"},
                           [](const LinkResult& result) -> std::vector<std::string> {
                               const links::LinkDark& dark = result.dark;
                               return {grouped(dark.vehicles),
                                       grouped(dark.never_seen),
                                       in_percent(dark.believed),
                                       with_interval(dark.place_median_m, 1),
                                       with_interval(dark.place_p95_m, 1),
                                       grouped(dark.next_cases),
                                       in_percent(dark.next_ahead)};
                           });
}

std::string scenarios_section(const LinkFacts& facts) {
    std::string html;
    for (const std::string& scenario : facts.scenarios) {
        for (const links::Exits exits : facts.exits) {
            DataTable table{
                {"Failure, predictor", "pairs", "true links", "AP", "AUC", "F1", "log loss, nat", "ECE",
                 "Brier", "AP, hard", "AP, policy\u2019s", "candidates\u2019 share, %", "AP, all failed",
                 "F1, all failed", "place error: median, m", "95 %, m", "next ahead right, %"},
                {}};
            for (const LinkResult& result : facts.results) {
                if (result.scenario != scenario || result.exits != exits) continue;
                const links::LinkMeasures& all = result.of(LinkSubset::all);
                table.rows.push_back(
                    {result.failure + ", " + result.predictor, grouped(all.pairs), grouped(all.true_links),
                     with_interval(all.ap, 4), decimal(all.auc.value, 4), with_interval(all.f1, 4),
                     decimal(all.log_loss.value, 3), decimal(all.ece.value, 4), decimal(all.brier.value, 4),
                     decimal(result.of(LinkSubset::hard).ap.value, 4),
                     decimal(result.of(LinkSubset::policy).ap.value, 4),
                     in_percent(result.failed.candidate_recall), with_interval(result.failed.ap, 4),
                     with_interval(result.failed.f1, 4), with_interval(result.dark.place_median_m, 1),
                     with_interval(result.dark.place_p95_m, 1), in_percent(result.dark.next_ahead)});
            }
            html += fmt::format("<details><summary>{}, exits {}</summary>\n{}</details>\n", escaped(scenario),
                                core::name(exits), detail::to_html(table));
        }
    }
    return html;
}

std::string reproduction_section(const LinkFacts& facts) {
    std::string html;
    if (!facts.command.empty()) html += fmt::format("<pre><code>{}</code></pre>\n", escaped(facts.command));
    html += fmt::format("<dl class=\"facts\">\n<dt>Seeds</dt><dd>{}</dd>\n", escaped(facts.seeds));
    for (const auto& [name, value] : facts.provenance)
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(value));
    return html + "</dl>\n";
}

const char* const definitions =
    "<p>Candidates are the pairs that may be linked: at least one end is not known, and the two are within "
    "reach of each other by the last reports or by dead reckoning. The rule is the same for every "
    "predictor. F1 uses a threshold chosen on other seeds. Hard pairs are near the link radius by dead "
    "reckoning, or last reports and dead reckoning disagree on them. The policy\u2019s links join an "
    "emergency vehicle with a vehicle ahead on its route. Brackets hold 95 % percentile intervals of a "
    "bootstrap over runs within scenarios.</p>\n";

/// Tables of one measure of a kind of pairs.
std::string subset_section(const LinkFacts& facts, LinkSubset subset,
                           Measured links::LinkMeasures::*measure) {
    return measure_section(facts, 4, [&](const LinkResult& result) { return result.of(subset).*measure; });
}

std::string error_section(const LinkFacts& facts, const char* measure, Measured LinkGain::*reduction) {
    return fmt::format("<p>How much lower 1 \u2212 {} is than that of {}, %.</p>\n", measure,
                       escaped(facts.against)) +
           gains_section(facts, reduction);
}

std::vector<PageSection> sections_of(const LinkFacts& facts) {
    using Measures = links::LinkMeasures;
    const auto of_all = [&](Measured Measures::*measure) {
        return subset_section(facts, LinkSubset::all, measure);
    };
    std::vector<PageSection> sections = {{"ap", "Average precision", definitions + of_all(&Measures::ap)},
                                         {"f1", "F1", of_all(&Measures::f1)}};
    if (!facts.comparisons.empty())
        sections.push_back({"comparisons", "Comparisons named in advance", comparisons_section(facts)});
    if (!facts.gains.empty()) {
        sections.push_back({"ap-error", "Error of AP against the reference",
                            error_section(facts, "AP", &LinkGain::ap_error_reduction)});
        sections.push_back({"f1-error", "Error of F1 against the reference",
                            error_section(facts, "F1", &LinkGain::f1_error_reduction)});
    }
    sections.push_back({"hard", "AP of hard pairs", subset_section(facts, LinkSubset::hard, &Measures::ap)});
    sections.push_back({"calibration", "Calibration error (ECE)", of_all(&Measures::ece)});
    sections.push_back({"brier", "Brier score", of_all(&Measures::brier)});
    sections.push_back({"failed", "All failed links", failed_section(facts)});
    sections.push_back({"dark", "Dark vehicles, and the next vehicle ahead", dark_section(facts)});
    sections.push_back({"curves", "Curves", curves_section(facts)});
    sections.push_back({"end-to-end", "Links end to end", end_to_end_section(facts)});
    if (facts.scenarios.size() > 1)
        sections.push_back({"scenarios", "Scenario by scenario", scenarios_section(facts)});
    sections.push_back({"reproduce", "How to reproduce", reproduction_section(facts)});
    return sections;
}

}  // namespace

std::string links_latex(const LinkFacts& facts) {
    struct Shown {
        const char* name;
        const char* title;
        Measured links::LinkMeasures::*measure;
    };
    constexpr std::array<Shown, 2> all = {
        {{"ap", "average precision", &links::LinkMeasures::ap}, {"f1", "F1", &links::LinkMeasures::f1}}};
    std::string text;
    for (const Shown& shown : all) {
        for (const links::Exits exits : facts.exits) {
            const auto measure = [&](const LinkResult& result) {
                return result.of(LinkSubset::all).*shown.measure;
            };
            text += detail::to_latex(
                {fmt::format("links-{}-{}", shown.name, core::name(exits)),
                 fmt::format("{}: {} of links, exits {}", facts.title, shown.title, core::name(exits)),
                 matrix_of(facts, "", pooled_cell(facts, exits, 3, measure))});
        }
    }
    return text;
}

void write_links_page(const LinkFacts& facts, std::ostream& page) {
    detail::write(
        {"Link prediction: " + facts.title,
         fmt::format("{} predictors under {} sensor failures in {}, on {} seeds.", facts.predictors.size(),
                     facts.failures.size(), fmt::join(facts.scenarios, ", "), facts.split),
         sections_of(facts), "AP: average precision. F1: harmonic mean of precision and recall."},
        page);
}

}  // namespace clearway::report
