#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace clearway::core {

/// Whether a text may name a scenario, a condition or a run. Such names become folder names, shell words and
/// entries of SUMO's file lists, which are separated by commas and spaces. Allowed: 1 to 100 ASCII letters,
/// digits and `_-.+=`, not starting with `.`; file names built from them must stay below 255 bytes.
bool is_folder_name(std::string_view name);

/// `text` with `_` in place of each character that a folder name cannot have, and of `=` and `+`, which
/// separate fields in names.
std::string as_folder_name(std::string text);

/// Adds a problem at `where` unless `name` is a folder name. Every name that becomes part of a path passes
/// this check where it is read, so that no folder of others leads out of the one that is written.
void check_folder_name(const std::string& where, const std::string& name, std::vector<Problem>& problems);

}  // namespace clearway::core
