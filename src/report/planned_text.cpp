#include "report/planned_text.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "core/terminal.hpp"

namespace clearway::report {
namespace {

using analysis::PlannedFinding;
using analysis::Shown;

std::string title_of(const StudyFacts& study, const std::string& scenario, const std::string& condition) {
    for (const ScenarioFacts& one : study.scenarios) {
        if (one.name != scenario) continue;
        const auto found = std::ranges::find(one.conditions, condition, &ConditionFacts::name);
        if (found != one.conditions.end()) return found->label();
    }
    return condition;
}

bool claims_equivalence(const StudyFacts& study) {
    return std::ranges::any_of(study.planned, [](const PlannedFinding& finding) {
        return finding.comparison.claim == results::Claim::equivalence;
    });
}

constexpr int table_columns = 100;

/// A comparison and what it has shown.
std::string row_of(const StudyFacts& study, const PlannedFinding& finding) {
    constexpr std::size_t width = 38;
    return printable(fmt::format("{} ({})", finding.comparison.name, finding.scenario)) + "\n" +
           table_row("    " + printable(pair_words(study, finding, Script::plain)), width,
                     fmt::format("{:<23}{:>5}  {:>7}  {}",
                                 estimate(finding.difference, {.decimals = 2, .sign = Sign::ends_too}),
                                 finding.pairs, p_words(finding.holm_p, Script::plain),
                                 finding_words(finding, Script::plain)));
}

}  // namespace

std::string pair_words(const StudyFacts& study, const PlannedFinding& finding, Script script) {
    return fmt::format("{} {} {}", title_of(study, finding.scenario, finding.comparison.condition),
                       script == Script::typeset ? "\u2212" : "-",
                       title_of(study, finding.scenario, finding.comparison.against));
}

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
            return finding.comparison.claim == results::Claim::equivalence
                       ? fmt::format("no equivalence within {} s shown", margin)
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
        "Confirmatory: the {} of the plan, in {}, paired. The probability of any false finding is {} at most "
        "(Holm).{}",
        counted(study.planned.size(), "comparison"), study.plan->metric,
        number(study.plan->alpha, {.decimals = 2}),
        claims_equivalence(study) ? " The p of an equivalence is that of two one-sided tests (TOST)." : "");
}

std::string planned_table(const StudyFacts& study) {
    if (!study.plan) return "";
    std::string text = printable(plan_sentence(study)) + "\n\n";
    for (std::size_t at = text.find(". "); at != std::string::npos; at = text.find(". ", at))
        text.replace(at + 1, 1, "\n");  // A line for each sentence.
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "{:<38}{:<23}{:>5}  {:>7}  {}\n{:-<{}}\n", "Comparison", "difference, s", "pairs",
                   "p, Holm", "finding", "", table_columns);
    for (const PlannedFinding& finding : study.planned)
        text += row_of(study, finding);
    return text + "\nExploratory: everything below. Its intervals and p-values confirm nothing.\n\n";
}

}  // namespace clearway::report
