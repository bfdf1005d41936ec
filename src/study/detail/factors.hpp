#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/settings.hpp"
#include "experiment/unit.hpp"

namespace clearway::study::detail {

/// One value of a factor.
struct FactorValue {
    std::string text;                ///< As a person writes it: `B5`, `0.3`; lists joined by `.`.
    std::string toml;                ///< As TOML writes it: `"B5"`, `0.3`.
    std::vector<std::string> words;  ///< Of a list.
};

/// A parameter and the values that it takes.
struct Factor {
    std::string group;  ///< condition, failure, loop or scenario.
    std::string key;    ///< Below the group: `failure`, `mean_outage_s`, `demand.human`.
    std::string where;  ///< Place in the study file, for messages.
    std::vector<FactorValue> values;
};

/// One combination: each factor with one of its values.
using Assignment = std::vector<std::pair<const Factor*, const FactorValue*>>;

/// Reads `[factors]`. Problems (unknown group, no list, nothing in it, a value that is neither number, text,
/// truth value nor list of texts) are added to `problems`.
std::vector<Factor> read_factors(const toml::table& table, const std::string& file,
                                 std::vector<core::Problem>& problems);

/// All combinations of the factors of these groups, the last factor fastest; one empty combination when there
/// is no such factor.
std::vector<Assignment> combinations(const std::vector<Factor>& factors,
                                     const std::vector<std::string>& wanted);

/// `+failure=B5+mean_outage_s=20`, with full keys where short ones would mean two factors.
std::string name_of(const Assignment& assignment, const std::vector<Factor>& factors);

/// Names as in the study file, `failure.mean_outage_s`, and values.
core::Settings factors_of(const Assignment& assignment);

/// The condition under a combination. What is wrong with it is added to `problems`.
experiment::ConditionSpec with(experiment::ConditionSpec condition, const Assignment& assignment,
                               std::vector<core::Problem>& problems);

/// Whether factors of conditions change anything: baselines and solo runs have no sensing, predictor or
/// policy.
bool is_varied(const experiment::ConditionSpec& condition);

}  // namespace clearway::study::detail
