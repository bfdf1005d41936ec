#pragma once

#include <string>
#include <vector>

#include "core/settings.hpp"
#include "core/strict_table.hpp"
#include "scenario/config.hpp"

namespace clearway::scenario {

/// What may be changed of every scenario, whatever its file says. Each is declared once, in overrides.cpp,
/// and has the type, range and meaning of a key of scenario.toml. The readers of `[overrides]` and
/// `[[scenario]]` in study files, factors, the options of the command line, the keywords of clearway.run and
/// clearway.env in Python and the reference page all come from there.
struct Override {
    core::SettingInfo value;  ///< Its name in study files and in Python, unit, range, words and meaning.
    std::string option;       ///< On the command line: `--friction`.
    std::string key;          ///< The key that it sets: `road.friction`.
    /// Keys, or tables of keys, whose value it replaces, whatever that was. One that multiplies has none.
    std::vector<std::string> replaced = {};
    /// Changes the configuration, if it does more than set its key. Appends what is wrong with what was
    /// given.
    void (*apply)(const Override&, const Given&, ScenarioConfig&, std::vector<core::Problem>&) = nullptr;
    bool is_flag = false;  ///< Its option takes no value and sets the last of the words.

    bool is_number() const { return value.words.empty() && !value.unit.empty(); }
};

/// All of them, in the order in which they are applied.
const std::vector<Override>& overrides();

bool is_override(const std::string& name);

/// Whether override `name` with this value replaces whatever else sets `key` of a scenario.
bool replaces(const std::string& name, const std::string& value, const std::string& key);

/// `density 0.8 x 0.8 = 0.64`, what the scenario has, what an override multiplies it by and what is run;
/// empty without such an override.
std::string density_words(const ScenarioConfig& config);

/// Reads those that the table sets. Values are checked when a scenario is loaded; problems then name the
/// place in this table.
void read_overrides(core::StrictTable& table, Options& options);

}  // namespace clearway::scenario
