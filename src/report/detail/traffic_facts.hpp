#pragma once

#include <map>
#include <vector>

#include "report/facts.hpp"
#include "results/store.hpp"

namespace clearway::report::detail {

/// All traffic tables of the runs that are asked for, each read once.
class RunTraffic {
  public:
    /// The store outlives the reader.
    explicit RunTraffic(const results::Store& store) : store_(store) {}
    const metrics::TrafficTables& of(const experiment::RunKey& key);

  private:
    const results::Store& store_;
    std::map<experiment::RunKey, metrics::TrafficTables> tables_;
};

/// One emergency vehicle's journey under the baseline, the condition of the headline and those that help
/// most: of those that were kept, or of those of them that arrived, pass signals and gain at least half of
/// the headline's mean, if any does, the one whose gain is nearest to that mean. Empty if none was kept.
std::vector<JourneyFacts> journeys_in(RunTraffic& traffic, const StudyFacts& study,
                                      const ScenarioFacts& scenario);

}  // namespace clearway::report::detail
