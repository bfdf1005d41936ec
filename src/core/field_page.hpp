#pragma once

#include <string>
#include <vector>

#include "core/settings.hpp"

namespace clearway::core {

/// A field table with a heading, for reference pages. Its rows have their names as users write them.
struct FieldTable {
    std::string title;
    std::string summary;  ///< One line, without a full stop.
    std::vector<SettingInfo> rows;
};

/// What a reader does with the fields of a page.
enum class FieldUse {
    set,   ///< Writes them: default, allowed values and reason are shown.
    read,  ///< Reads them: the origin is shown.
};

/// One line for each field that is set: name, default, unit and allowed values.
std::string field_lines(const std::vector<FieldTable>& tables);
/// Every field with unit, meaning and what `use` asks for, in 80 columns.
std::string fields_console(const std::vector<FieldTable>& tables, FieldUse use);
/// A list of objects with `table`, `name`, `unit`, `default`, `minimum` and `maximum` or `words`,
/// `description` and `reason`.
std::string fields_json(const std::vector<FieldTable>& tables);
/// The sections of a reference page: a heading and a table for each.
std::string fields_markdown(const std::vector<FieldTable>& tables, FieldUse use);

}  // namespace clearway::core
