#pragma once

#include <string>

#include "report/detail/markup.hpp"

namespace clearway::report::detail {

/// A table as CSV (RFC 4180, lines end with \n), for programs: plain minus signs, no thousands separators, no
/// signs before positive numbers, missing values empty. A column with intervals, `1.2 [0.9, 1.5]`, becomes
/// three. The page's script writes the same bytes.
std::string to_csv(const DataTable& table);

/// A table as LaTeX: a `tabular` with the lines of the package booktabs. All cells are escaped. The page's
/// script writes the same bytes.
std::string to_latex(const DataTable& table);

}  // namespace clearway::report::detail
