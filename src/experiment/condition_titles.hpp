#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/settings.hpp"
#include "experiment/condition.hpp"

namespace clearway::experiment {

/// What people call conditions. A title of the study file comes first, then the name in the dissertation,
/// then that of the predictor which repairs the graph, then the name. A condition that factors made adds
/// their values: `corridor+failure=B10+lead_s=4` -> `corridor, B10, lead 4 s`. A factor of policies takes the
/// place of the name, which follows where the study varies the policies of several conditions:
/// `b20+policy=corridor` -> `corridor, b20`.
class ConditionTitles {
  public:
    /// `given` holds the titles of the study file, by condition and by text that a factor gives one.
    explicit ConditionTitles(core::Settings given) : given_(std::move(given)) {}

    /// By the names of the conditions of one study. Those that would share a title keep their names.
    core::Settings of(const std::vector<ConditionSpec>& conditions) const;
    /// Of a condition before its factors.
    std::string base_of(const ConditionSpec& condition) const;
    /// The policies, as a factor of the study or their parts call them.
    std::string policy_text(const ConditionSpec& condition) const;
    /// What a factor, or a setting, gives: `preempt_signals.lead_s`, `4` -> `lead 4 s`.
    std::string value_text(const std::string& factor, const std::string& value) const;
    /// As it was given.
    const core::Settings& given() const { return given_; }

  private:
    enum class Bases { one, several };  ///< Of the conditions whose policy a factor varies.
    std::string one(const ConditionSpec& condition, Bases bases) const;

    core::Settings given_;
};

/// The name that the study file gave: what follows `+` was added by factors.
std::string name_before_factors(const ConditionSpec& condition);

/// `preempt_signals.lead_s`, `4` -> `lead 4 s`.
std::string setting_text(const std::string& setting, const std::string& value);

}  // namespace clearway::experiment
