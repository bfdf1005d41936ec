#pragma once

#include <string>
#include <vector>

#include "core/field_page.hpp"

namespace clearway::cli {

/// A page of docs/reference that is printed from the program's field tables.
struct ReferencePage {
    const char* name;  ///< `columns`: clearway list columns.
    const char* title;
    const char* intro;  ///< What the names are used for, in Markdown.
    core::FieldUse use;
    std::vector<core::FieldTable> tables;
};

/// `columns` and `scenario-keys`.
std::vector<ReferencePage> reference_pages();

/// The file docs/reference/NAME.md.
std::string to_markdown(const ReferencePage& page);

}  // namespace clearway::cli
