#pragma once

#include <string>
#include <string_view>

namespace clearway::core {

/// Throws InputError, naming file and line, for TOML text with a dotted key of more than 50 parts or a value
/// of more than 50 levels of arrays and tables: toml++ follows both by calling itself. Text that is not TOML
/// passes.
void check_toml_levels(std::string_view text, const std::string& file);

}  // namespace clearway::core
