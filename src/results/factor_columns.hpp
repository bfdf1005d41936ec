#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "results/manifest.hpp"

namespace clearway::results {

/// The factors of a study as columns of its tables: one for each factor that a scenario or a condition has,
/// named as in the study file (`failure.dark_share`), in alphabetical order.
class FactorColumns {
  public:
    explicit FactorColumns(const Manifest& manifest);

    const std::vector<std::string>& names() const { return names_; }
    /// Whether every value of a column is a number. A database sorts and sums those; all others are texts.
    bool is_number(const std::string& name) const { return !texts_.contains(name); }
    /// Value of each column for the runs of a condition in a scenario; empty where neither has the factor.
    std::vector<std::string> values(const std::string& scenario, const std::string& condition) const;
    /// The same as pairs of name and value, without empty values.
    core::Settings settings(const std::string& scenario, const std::string& condition) const;

  private:
    std::vector<std::string> names_;
    std::set<std::string> texts_;
    std::map<std::string, core::Settings> of_scenarios_;
    std::map<std::string, core::Settings> of_conditions_;
};

}  // namespace clearway::results
