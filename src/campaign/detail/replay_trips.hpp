#pragma once

#include <string>
#include <vector>

#include "experiment/run_key.hpp"
#include "report/facts.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

/// A trip of an emergency vehicle, made under the baseline and under a condition with the same seed.
struct Trip {
    experiment::RunKey baseline, condition;
    std::string baseline_hash, condition_hash;  ///< Of the traces.
    std::string baseline_title = {}, condition_title = {};
    std::string vehicle;                ///< SUMO's id.
    const char* rank = "";              ///< `median`, `best`, `worst`, or `only`.
    double gain_s = 0.0;                ///< Travel time that the condition saves; negative: costs.
    double begin_s = 0.0, end_s = 0.0;  ///< Of both together.

    std::string title() const;
};

/// Of each scenario the trips with the median, the largest and the smallest gain, of those that arrived in
/// both runs; fewer where there are fewer trips. `condition` is a name; empty: the one of the scenario's
/// headline. Of several trips with one gain the first by replication and id.
std::vector<Trip> trips_to_show(const results::Results& results, const report::StudyFacts& study,
                                const std::string& condition);

}  // namespace clearway::campaign
