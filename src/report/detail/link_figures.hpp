#pragma once

#include <string>
#include <vector>

#include "report/links.hpp"

namespace clearway::report::detail {

/// Pooled result of a predictor under one failure, with the index of its line style.
struct DrawnResult {
    const links::LinkResult* result = nullptr;
    std::size_t series = 0;
};

// Each function returns a whole <figure> with the data behind it. Empty text if there is nothing to draw.

/// Precision over recall, where both are above 0.5.
std::string precision_recall_figure(const std::vector<DrawnResult>& drawn);

/// Share of true links minus stated probability, by stated probability.
std::string reliability_figure(const std::vector<DrawnResult>& drawn);

/// Average precision by the age of the older report of a pair.
std::string age_figure(const std::vector<DrawnResult>& drawn);

}  // namespace clearway::report::detail
