#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "links/link_comparisons.hpp"
#include "links/link_judgement.hpp"

namespace clearway::report {

/// What `clearway links evaluate` found. Texts may come from the user's files; printers escape them.
struct LinkFacts {
    std::string title;  ///< `eval_v1`, or the scenarios.
    std::string command;
    std::string split;  ///< `test` or `validation`.
    std::uint64_t study_seed = 0;
    std::string seeds;     ///< `study seed 1, replications 0 to 9; F1 thresholds chosen on 1000 to 1004`.
    std::size_t runs = 0;  ///< Test runs over all scenarios.
    std::vector<std::string> scenarios;
    std::vector<std::string> failures;
    std::vector<links::Exits> exits;
    std::vector<std::string> predictors;
    std::string against;  ///< Predictor that gains refer to; may be empty.
    std::vector<std::pair<std::string, std::string>> provenance;  ///< Names and values, as shown.
    std::vector<links::LinkResult> results;
    std::vector<links::LinkGain> gains;
    std::vector<links::LinkComparison> comparisons;  ///< Those that the benchmark names in advance.
    bool confirmatory = false;  ///< Whether they are made on the whole benchmark, as it says.
    bool exploratory_gains =
        false;  ///< Whether there are such comparisons, so that `gains` are not among them.
};

/// The measures by failure and predictor, comparisons named in advance, and errors against the opponent. No
/// row of the measures is longer than 80 columns.
std::string links_console(const LinkFacts& facts);

/// Everything but curves, as one JSON object. Intervals are `_low_95` and `_high_95` beside each measure.
std::string links_json(const LinkFacts& facts);

/// The same fields as CSV, one row per result.
std::string links_csv(const LinkFacts& facts);

/// AP and F1 of pooled results, failures by predictors, as LaTeX: a table for each and for each exits.
std::string links_latex(const LinkFacts& facts);

/// One self-contained page, as write_html of html.hpp: tables, precision-recall, reliability and age curves.
void write_links_page(const LinkFacts& facts, std::ostream& page);

}  // namespace clearway::report
