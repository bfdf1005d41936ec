#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/summary.hpp"
#include "core/error.hpp"
#include "experiment/condition.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

/// The problem of a `name` at `where` that is not in `known`; lists them, if they are few, and suggests the
/// nearest. `listed_by` is the command that describes them.
core::Problem unknown_name(const std::string& where, const std::string& name,
                           const std::vector<std::string>& known,
                           const std::string& listed_by = "clearway list");

/// The name of the condition of a run folder that a word at `where` calls by its name or its title; empty for
/// an empty word. Throws core::InputError for others.
std::string condition_called(const std::string& word, const results::Store& store,
                             const std::string& where = "--condition");

/// What `--against` names: nothing, a condition or its title, or levels of factors, `policy=corridor` or
/// `condition.policy=corridor,condition.failure=B10`. Throws core::InputError for what the study does not
/// have; `folder` is its run folder.
analysis::Reference reference_from(const std::string& against,
                                   const std::vector<experiment::ConditionSpec>& conditions,
                                   const std::filesystem::path& folder);

std::vector<std::string> failure_names();

/// Adds the problems of a failure given at `where`: a preset or fields (failures::failure_from).
void check_failure(const std::string& where, const std::string& failure,
                   std::vector<core::Problem>& problems);

/// Checks failure, predictor, policies, settings and model of every condition before anything runs. Throws
/// core::InputError with every problem.
void check_names(const std::vector<experiment::ConditionSpec>& conditions);

}  // namespace clearway::campaign
