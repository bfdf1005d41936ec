#pragma once

#include <span>
#include <vector>

#include "links/detail/link_draws.hpp"
#include "links/link_judgement.hpp"

namespace clearway::links::detail {

/// `candidates` are the summaries of all candidates, by run; `drawn` are their measures.
LinkFailed failed_measures(const std::vector<const LinkCase*>& cases,
                           const std::vector<LinkSummary>& candidates, const DrawnMeasures& drawn,
                           double threshold, const analysis::RunResampling& resampling);

LinkDark dark_measures(const std::vector<const LinkCase*>& cases, const analysis::RunResampling& resampling);

/// The quantiles `shares` of the pooled errors. Those of resamples are taken on a grid of groups of bins,
/// each with at least 1/500 of all errors, and shifted by the difference between both grids on the whole
/// sample.
std::vector<Drawn> draw_quantiles(const std::vector<PlaceErrors>& runs, std::span<const double> shares,
                                  const analysis::RunResampling& resampling);

}  // namespace clearway::links::detail
