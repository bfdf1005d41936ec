#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/settings.hpp"
#include "experiment/condition.hpp"
#include "study/detail/read_settings.hpp"

namespace clearway::study::detail {

/// One value of a factor.
struct FactorValue {
    std::string text;                ///< As a person writes it: `B5`, `0.3`; lists joined by `.`.
    std::string toml;                ///< As TOML writes it: `"B5"`, `0.3`.
    std::vector<std::string> words;  ///< The elements of a list.
    core::Settings settings;         ///< The settings of a table: several at a time.
};

/// A parameter and the values it takes.
struct Factor {
    std::string group;  ///< condition, scenario, set, a component of experiment/settings.hpp, or
                        ///< a part in Python.
    std::string key;    ///< Below the group: `failure`, `mean_outage_s`, `demand.human`.
    std::string where;  ///< Position in the study file, for messages.
    std::vector<FactorValue> values;
};

/// One combination: each factor with one of its values.
using Assignment = std::vector<std::pair<const Factor*, const FactorValue*>>;

/// Which combinations of factors are run.
enum class Design : std::uint8_t {
    all_combinations,
    one_at_a_time,  ///< No factor at all, then each value of each factor alone.
};

/// `[factors]` of a study.
struct Factors {
    std::vector<Factor> list;
    Design design = Design::all_combinations;
};

/// Reads `[factors]`. Adds problems (unknown group, no list, an empty list, a value that is not a number,
/// text, truth value or list of texts, an unknown setting) to `problems`.
Factors read_factors(const toml::table& table, const SettingsPlace& settings,
                     std::vector<core::Problem>& problems);

/// What a factor changes.
enum class Subject : std::uint8_t { scenarios, conditions };

/// All combinations of the design, the last factor varying fastest; one empty combination without factors.
std::vector<Assignment> combinations(const Factors& factors, Subject subject);
/// Their number, or the greatest number where it is greater; makes none of them.
std::uint64_t count_combinations(const Factors& factors, Subject subject);

/// The factors of an assignment that concern the condition under it: settings of a policy or predictor that
/// it does not have change nothing.
Assignment concerning(const experiment::ConditionSpec& condition, const Assignment& assignment);

/// `+failure=B5+mean_outage_s=20`, with full keys where short ones would be ambiguous.
std::string name_of(const Assignment& assignment, const Factors& factors);

/// Values by name as in the study file, `failure.mean_outage_s`.
core::Settings factors_of(const Assignment& assignment);

/// The condition with a combination applied. Adds what is wrong with it to `problems`.
experiment::ConditionSpec with(experiment::ConditionSpec condition, const Assignment& assignment,
                               std::vector<core::Problem>& problems);

/// Whether a factor sets something of the environment, which baselines have too.
bool is_environment(const Factor& factor);

/// Whether factors of conditions change anything: baselines and solo runs have no sensing, predictor or
/// policy.
bool is_varied(const experiment::ConditionSpec& condition);

}  // namespace clearway::study::detail
