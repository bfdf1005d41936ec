#pragma once

#include <string>
#include <vector>

#include "campaign/printing.hpp"
#include "core/json.hpp"

namespace clearway::campaign {

/// A column of a table. JSON knows its values by `key`, which ends in their unit; text by `title`. JSON
/// leaves a column without a key out, text one without a title.
struct Column {
    std::string key;
    std::string title;
};

struct Row {
    std::vector<core::Json> cells;        ///< One for each column.
    std::vector<std::string> below = {};  ///< Lines of text under the row.
};

/// Rows that a verb prints. In text, numbers stand to the right, null is `-`, lists are joined by
/// `+`, an object is `key=value key=value`, and a last column of words keeps to core::help_columns.
struct Table {
    std::string key;  ///< Of the list of rows in JSON; empty: the list is all that is printed.
    std::vector<Column> columns;
    std::vector<Row> rows;
};

std::string text_of(const Table& table);

/// What a verb prints: as text `head`, the tables, then `text`; as JSON the facts, then the tables.
struct Printout {
    core::Json facts = core::Json::object();
    std::vector<Table> tables = {};
    std::string text = {};
    std::string head = {};
};

/// Prints on standard output.
void print(const Printout& printout, Printing printing);

}  // namespace clearway::campaign
