#pragma once

#include <string>

#include "report/detail/markup.hpp"

namespace clearway::report::detail {

/// A table as CSV (RFC 4180, lines end with \n), for programs: plain minus signs, no thousands separators, no
/// signs before positive numbers, missing values empty. A column with intervals, `1.2 [0.9, 1.5]`, becomes
/// three: `T`, `low 95 %` and `high 95 %`, or with several such columns `T`, `T low 95 %` and `T high 95 %`.
/// The page's script writes the same bytes.
std::string to_csv(const DataTable& table);

/// A table as LaTeX, for the packages booktabs, graphicx and siunitx: a `table` no wider than the text, a
/// wide one on its side (package rotating), one that would be too small there in parts by columns, `tab:NAME`
/// and `tab:NAME-2`, each with its caption and label. Heads are set in lines as wide as their columns.
/// Numbers stand in columns of type S; the interval of `1.2 [0.9, 1.5]` has a column of its own. All text is
/// escaped. The page's script writes the same bytes.
std::string to_latex(const Table& table);

/// Text with what is special in LaTeX escaped.
std::string latex_escaped(const std::string& text);

}  // namespace clearway::report::detail
