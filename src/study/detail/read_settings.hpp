#pragma once

#include <optional>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/settings.hpp"

namespace clearway::study::detail {

/// The text of a TOML value as `experiment::set` takes it: a number, a text or a truth value. Empty for
/// others.
std::optional<std::string> setting_value(const toml::node& node);

/// The file where settings stand, and the names of parts in Python that may have settings there.
struct SettingsPlace {
    const std::string& file;
    std::vector<std::string> parts;
};

/// Reads a table of settings, `{ "preempt_signals.lead_s" = 12 }` or `{ preempt_signals = { lead_s = 12 } }`.
/// Adds problems, including unknown names and values out of range, to `problems` with their position.
core::Settings read_settings(const toml::table& table, const SettingsPlace& place,
                             std::vector<core::Problem>& problems);

}  // namespace clearway::study::detail
