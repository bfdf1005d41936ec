#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/detail/app.hpp"
#include "experiment/condition.hpp"

namespace clearway::cli {

/// A condition as options describe it.
struct DescribedCondition {
    experiment::ConditionSpec condition;
    std::vector<std::string> settings;  ///< `preempt_signals.lead_s=12`.
    std::string model;                  ///< Model file; empty: the built-in model.
};

/// Declares `--policy`, `--failure`, `--predictor`, `--set`, `--model` and `--safety-checks`. Names are
/// checked later (names.hpp). `usual_policy` is the default that the help shows.
void add_condition_options(App& app, DescribedCondition& described, const std::string& usual_policy);

/// Declares only `--set` and `--model`; `usual` is the default that the help shows for `--model`.
void add_setting_options(App& app, std::vector<std::string>& settings, std::string& model,
                         const std::string& usual);

/// Name and value of `NAME=VALUE`. Throws core::InputError, naming `option`.
std::pair<std::string, std::string> assignment(const std::string& option, const std::string& words,
                                               const std::string& form = "NAME=VALUE");

/// Applies `--set` and `--model` to a condition. Throws core::InputError for words that are not assignments,
/// unknown names, values out of range and a model that cannot be read.
void apply_settings(const std::vector<std::string>& settings, const std::string& model,
                    experiment::ConditionSpec& condition);

/// The condition with its settings and model; the policy `none` is no policy. Throws as apply_settings does.
experiment::ConditionSpec condition_of(const DescribedCondition& described);

/// Gives each model file to the conditions whose predictor it is of. `models`: FILE, or PREDICTOR=FILE where
/// a file fits several predictors. Throws core::InputError for a file that cannot be read or fits none of the
/// conditions' predictors (with the reasons), one that fits several without saying which, a predictor that no
/// condition has, and a condition that has a model already.
void apply_models(const std::vector<std::string>& models, std::vector<experiment::ConditionSpec>& conditions);

/// Declares an option that is `on` or `off`; returns it for its group and text.
template <class Switch>
Option add_switch(App& app, const std::string& name, Switch& value, const std::string& help) {
    return app
        .add_option_function<std::string>(
            name, [&value](const std::string& word) { value = *core::value_from<Switch>(word); }, help)
        .one_of({"on", "off"});
}

/// The conditions that a user names or describes on the command line.
struct ConditionWords {
    std::vector<std::string> names;  ///< Built-in ones.
    DescribedCondition own;          ///< Without a name it is named after its content.
};

/// Declares `--condition`.
void add_condition_words(App& app, ConditionWords& words);
/// Declares the options that describe a condition of one's own.
void add_own_condition_options(App& app, DescribedCondition& described);

/// The conditions that the words mean; may be empty. Throws core::InputError.
std::vector<experiment::ConditionSpec> chosen_conditions(const ConditionWords& words);

/// The only one of `chosen`, or the usual one. Throws core::InputError, naming `what` (an option or verb),
/// for more.
experiment::ConditionSpec shown_condition(const std::vector<experiment::ConditionSpec>& chosen,
                                          const std::string& what);

/// Adds a condition unless one of its name is there.
void add_once(std::vector<experiment::ConditionSpec>& conditions, const experiment::ConditionSpec& condition);

}  // namespace clearway::cli
