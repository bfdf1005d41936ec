#pragma once

#include <string>
#include <vector>

#include "report/facts.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {

/// A plain table: the first column holds names, the others numbers. All cells are escaped here.
struct DataTable {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
    enum class Cells { numbers, words } cells = Cells::numbers;
};
std::string to_html(const DataTable& table);

/// A <figure>. `drawing` and `legend` are markup, the other texts are escaped.
struct Figure {
    std::string caption;
    std::string drawing;
    std::string legend;
    std::string note;
    DataTable data;
};
std::string to_html(const Figure& figure);

/// A legend as markup. Each entry is a style index and a name, which is escaped here.
std::string legend(const std::vector<std::pair<std::size_t, std::string>>& entries);

/// The title as markup, escaped, with a mark if safety checks were off.
std::string condition_label(const ConditionFacts& condition);

}  // namespace clearway::report::detail
