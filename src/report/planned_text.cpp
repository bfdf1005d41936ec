#include "report/planned_text.hpp"

#include <iterator>

#include <fmt/format.h>

namespace clearway::report {
namespace {

using analysis::PlannedFinding;
using analysis::Shown;

std::string four_digits(const std::optional<double>& p) {
    if (!p) return "-";
    return *p < 0.0001 ? "<.0001" : fmt::format("{:.4f}", *p);
}

}  // namespace

std::string finding_words(const PlannedFinding& finding, Script script) {
    const std::string margin = number(finding.margin_s, {.decimals = 1, .script = script});
    switch (finding.shown) {
        case Shown::better:
            return "shown: less time";
        case Shown::worse:
            return "shown: more time";
        case Shown::equivalent:
            return fmt::format("equivalent within {} s", margin);
        case Shown::not_shown:
            return finding.comparison.claim == results::Claim::equivalence ? "no equivalence shown"
                                                                           : "no difference shown";
        case Shown::ruled_out:
            return "ruled out: lost EVs";
        case Shown::incomplete:
            break;
    }
    return "runs are missing";
}

std::string plan_sentence(const StudyFacts& study) {
    return fmt::format(
        "Confirmatory: the {} of the plan, in {}, paired. All claims hold together with probability {} "
        "(Holm).",
        counted(study.planned.size(), "comparison"), study.plan->metric,
        number(1.0 - study.plan->alpha, {.decimals = 2}));
}

std::string planned_table(const StudyFacts& study) {
    if (!study.plan) return "";
    std::string text = printable(plan_sentence(study)) + "\n\n";
    text.replace(text.find(". ") + 1, 1, "\n");  // A line for each sentence.
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "{:<38}{:<23}{:>5}  {:>7}  {}\n{:-<100}\n", "Comparison", "difference, s", "pairs",
                   "p, Holm", "finding", "");
    for (const PlannedFinding& finding : study.planned) {
        const results::PlannedComparison& comparison = finding.comparison;
        fmt::format_to(out, "{}\n    {:<33} {:<23}{:>5}  {:>7}  {}\n",
                       printable(fmt::format("{} ({})", comparison.name, finding.scenario)),
                       printable(fmt::format("{} - {}", comparison.condition, comparison.against)),
                       estimate(finding.difference, {.decimals = 2, .sign = Sign::ends_too}), finding.pairs,
                       four_digits(finding.holm_p), finding_words(finding, Script::plain));
    }
    return text + "\nExploratory: everything below. Its intervals and p-values confirm nothing.\n\n";
}

}  // namespace clearway::report
