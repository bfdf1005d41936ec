#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/equipment.hpp"
#include "campaign/detail/equip_search.hpp"

namespace clearway::campaign::detail {

/// Less time after than before, paired by replication.
analysis::MaybeEstimate less_time(const analysis::Values& before, const analysis::Values& after,
                                  double level = analysis::usual_level);

/// What a race knew when it was interrupted.
struct Look {
    analysis::Values none;  ///< With none equipped, on as many seeds as the first place needed.
    std::vector<analysis::SignalSet> sets;  ///< The first has those that are chosen.
    std::vector<analysis::Values> values;
    std::size_t replications = 0;

    bool is_complete() const { return sets.size() > 1; }
};

/// The candidates that gained most in a look, a line each, and what those gain that were chosen before.
std::string interim_words(const Look& look, const Signals& signals);

/// What a search chose whose fresh seeds were interrupted, and what each candidate gains alone.
std::string chosen_words(const analysis::EquipPlan& plan, const Signals& signals);

}  // namespace clearway::campaign::detail
