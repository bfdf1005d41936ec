#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/resampling.hpp"
#include "links/compared_pair.hpp"
#include "links/link_judgement.hpp"

namespace clearway::links {

/// One comparison that a benchmark names in advance, under one failure, pooled over all scenarios.
struct LinkComparison {
    /// The predictor's measure minus the opponent's.
    struct Difference {
        analysis::Measured difference;
        std::optional<double> p;  ///< Two-sided, from the bootstrap over runs (analysis::RunResampling::p).
        std::optional<double> holm_p;  ///< Adjusted for all tests of all comparisons (analysis::holm).
    };
    std::string failure;
    Exits exits = Exits::known;
    ComparedPair pair;
    Difference ap;
    Difference f1;
};

/// Compares the pairs of predictors that a benchmark names. Has resamples of its own, more than
/// LinkJudgement, so that p-values remain below usual levels after the correction: 500 for each test, at
/// least 10,000.
class LinkComparisons {
  public:
    /// `runs_by_scenario` as for LinkJudgement; `cases` are failures x exits.
    LinkComparisons(const std::vector<std::size_t>& runs_by_scenario, std::vector<ComparedPair> pairs,
                    std::size_t cases);

    /// Adds a predictor's runs; those of predictors that are in no pair are ignored.
    void add(const LinkRuns& runs);
    /// By pair, each by case. Pairs of which a predictor was not added are left out.
    std::vector<LinkComparison> results() const;

  private:
    struct Measures {
        std::string failure;
        Exits exits = Exits::known;
        std::optional<double> ap, f1;
        std::vector<double> ap_draws, f1_draws;
    };
    LinkComparison compared(const ComparedPair& pair, const Measures& one, const Measures& other) const;

    std::vector<ComparedPair> pairs_;
    std::optional<analysis::RunResampling> resampling_;      ///< Empty without pairs.
    std::map<std::string, std::vector<Measures>> measures_;  ///< By predictor; one for each case.
};

}  // namespace clearway::links
