#pragma once

#include <vector>

#include "core/field_page.hpp"

namespace clearway::scenario {

/// Every key of scenario.toml with its full name, table by table.
std::vector<core::FieldTable> key_tables();

/// The overrides as a table of a reference page.
core::FieldTable override_table();

}  // namespace clearway::scenario
