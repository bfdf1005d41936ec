#pragma once

#include <string>
#include <vector>

#include "core/settings.hpp"
#include "report/facts.hpp"

namespace clearway::report::detail {

/// What tables and figures call conditions. A title of the study file comes first, then the name in the
/// dissertation, then that of the predictor which repairs the graph, then the name. A condition that factors
/// made adds their values: `corridor+failure=B10+lead_s=4` -> `corridor, B10, lead 4 s`. A factor of policies
/// takes the place of the name, which follows where the study varies the policies of several conditions:
/// `b20+policy=corridor` -> `corridor, b20`.
class ConditionTitles {
  public:
    /// `given` holds the titles of the study file, by condition and by text that a factor gives one.
    explicit ConditionTitles(core::Settings given) : given_(std::move(given)) {}

    /// Titles the conditions of one scenario. Those that would share a title keep their names.
    void give(std::vector<ConditionFacts>& conditions) const;

  private:
    enum class Bases { one, several };  ///< Of the conditions whose policy a factor varies.
    std::string of(const experiment::ConditionSpec& condition, Bases bases) const;
    /// Of the condition before its factors.
    std::string base_of(const experiment::ConditionSpec& condition) const;
    /// The policies, as a factor of the study or their parts call them.
    std::string policy_text(const experiment::ConditionSpec& condition) const;
    /// All that a condition has, in words: ConditionFacts::aspects.
    core::Settings aspects_of(const experiment::ConditionSpec& condition) const;
    std::string value_text(const std::string& factor, const std::string& value) const;

    core::Settings given_;
};

}  // namespace clearway::report::detail
