#include "links/detail/link_cases.hpp"

namespace clearway::links::detail {

std::vector<const LinkCase*> cases_of(std::span<const LinkRun> runs, std::size_t number) {
    std::vector<const LinkCase*> cases;
    for (const LinkRun& run : runs)
        cases.push_back(&run.cases[number]);
    return cases;
}

std::vector<LinkSummary> summaries_of(const std::vector<const LinkCase*>& cases, LinkSubset subset) {
    std::vector<LinkSummary> runs;
    for (const LinkCase* const one : cases)
        runs.push_back(one->scores.of(subset));
    return runs;
}

double threshold_of(std::span<const LinkRun> validation, std::size_t number) {
    LinkSummary pooled;
    for (const LinkSummary& run : summaries_of(cases_of(validation, number), LinkSubset::all))
        pooled.add(run);
    return best_f1_threshold(pooled);
}

}  // namespace clearway::links::detail
