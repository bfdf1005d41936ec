#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/detail/condition_options.hpp"
#include "experiment/condition.hpp"

namespace clearway::cli {

/// The conditions that a user names or describes on the command line.
struct ConditionWords {
    std::vector<std::string> names;  ///< Built-in ones.
    DescribedCondition own;          ///< Without a name it is named after its content.
};

/// Declares `--condition`.
void add_condition_words(CLI::App& app, ConditionWords& words);
/// Declares the options that describe a condition of one's own.
void add_own_condition_options(CLI::App& app, DescribedCondition& described);

/// The conditions that the words mean; may be empty. Throws core::InputError.
std::vector<experiment::ConditionSpec> chosen_conditions(const ConditionWords& words);

/// The only one of `chosen`, or the usual one. Throws core::InputError, naming `what` (an option or verb),
/// for more.
experiment::ConditionSpec shown_condition(const std::vector<experiment::ConditionSpec>& chosen,
                                          const std::string& what);

/// Adds a condition unless one of its name is there.
void add_once(std::vector<experiment::ConditionSpec>& conditions, const experiment::ConditionSpec& condition);

}  // namespace clearway::cli
