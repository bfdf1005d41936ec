#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/settings.hpp"
#include "experiment/condition.hpp"

namespace clearway::study::detail {

/// One value of a factor.
struct FactorValue {
    std::string text;                ///< As a person writes it: `B5`, `0.3`; lists joined by `.`.
    std::string toml;                ///< As TOML writes it: `"B5"`, `0.3`.
    std::vector<std::string> words;  ///< Of a list.
    core::Settings settings;         ///< Of a table: several settings at a time.
};

/// A parameter and the values that it takes.
struct Factor {
    std::string group;  ///< condition, scenario, set, or a component of experiment/settings.hpp.
    std::string key;    ///< Below the group: `failure`, `mean_outage_s`, `demand.human`.
    std::string where;  ///< Place in the study file, for messages.
    std::vector<FactorValue> values;
};

/// One combination: each factor with one of its values.
using Assignment = std::vector<std::pair<const Factor*, const FactorValue*>>;

/// Which levels of several factors are run.
enum class Design : std::uint8_t {
    all_combinations,
    one_at_a_time,  ///< Without any factor, and each value of each factor alone.
};

/// `[factors]` of a study.
struct Factors {
    std::vector<Factor> list;
    Design design = Design::all_combinations;
};

/// Reads `[factors]`. Problems (unknown group, no list, nothing in it, a value that is neither number, text,
/// truth value nor list of texts, a setting that does not exist) are added to `problems`.
Factors read_factors(const toml::table& table, const std::string& file, std::vector<core::Problem>& problems);

/// What a factor changes.
enum class Subject : std::uint8_t { scenarios, conditions };

/// All combinations of the design, the last factor fastest; one empty combination when there is no factor.
std::vector<Assignment> combinations(const Factors& factors, Subject subject);

/// Of an assignment those factors that the condition has under it: settings of a policy or predictor that it
/// does not have change nothing.
Assignment concerning(const experiment::ConditionSpec& condition, const Assignment& assignment);

/// `+failure=B5+mean_outage_s=20`, with full keys where short ones would mean two factors.
std::string name_of(const Assignment& assignment, const Factors& factors);

/// Names as in the study file, `failure.mean_outage_s`, and values.
core::Settings factors_of(const Assignment& assignment);

/// The condition under a combination. What is wrong with it is added to `problems`.
experiment::ConditionSpec with(experiment::ConditionSpec condition, const Assignment& assignment,
                               std::vector<core::Problem>& problems);

/// Whether factors of conditions change anything: baselines and solo runs have no sensing, predictor or
/// policy.
bool is_varied(const experiment::ConditionSpec& condition);

}  // namespace clearway::study::detail
