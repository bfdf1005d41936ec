#pragma once

#include <span>
#include <vector>

#include "links/link_run.hpp"

namespace clearway::links::detail {

/// Case `number` of each run.
std::vector<const LinkCase*> cases_of(std::span<const LinkRun> runs, std::size_t number);

/// Summaries of a kind of pairs, one per case.
std::vector<LinkSummary> summaries_of(const std::vector<const LinkCase*>& cases, LinkSubset subset);

/// The F1 threshold of case `number`: the best on all of its candidates in the validation runs together.
double threshold_of(std::span<const LinkRun> validation, std::size_t number);

}  // namespace clearway::links::detail
