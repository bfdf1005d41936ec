#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "analysis/estimate.hpp"
#include "analysis/objections.hpp"
#include "core/settings.hpp"
#include "results/store.hpp"

namespace clearway::analysis {

/// The main result of a study while it runs, in the first scenario: restricted mean EV travel time of the
/// first condition that has a baseline, minus that of the baseline. If nothing is compared, the mean of the
/// first condition. Each pair of runs is read once.
class Headline {
  public:
    /// `titles` of conditions, by name, are what `text` calls them.
    explicit Headline(const results::Store& store, core::Settings titles = {});

    /// Reads what has been completed since the last call. Throws core::InputError for a damaged record.
    void refresh();
    /// Nothing before the first pair.
    MaybeEstimate estimate() const;
    const std::string& scenario() const { return scenario_; }
    const std::string& condition() const { return condition_; }
    /// Empty if nothing is compared.
    const std::string& baseline() const { return baseline_; }
    /// `EV travel time -28.5 s [-33.2, -23.7], n 20: city graph_simulation`, then the objections on the side
    /// of emergency vehicles, if any; empty before the first pair.
    std::string text() const;

  private:
    void choose();
    /// False when the pair is not complete.
    bool read(std::uint32_t replication);

    results::Store store_;
    core::Settings titles_;
    std::string scenario_;
    std::string condition_;
    std::string baseline_;
    std::set<std::uint32_t> open_;  ///< Replications not read yet.
    std::vector<double> values_s_;
    Objections objections_;  ///< As far as they follow from the runs one by one.
};

}  // namespace clearway::analysis
