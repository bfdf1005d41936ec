#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "report/detail/json.hpp"
#include "report/detail/markup.hpp"
#include "report/facts.hpp"

namespace clearway::report::detail {

/// A share of 1; printed in percent.
struct Share {
    double value = 0.0;
};

/// Nothing, a count, a text from a file, whether an effect is shown, a share, or an estimate in seconds.
using SheetCell = std::variant<std::monostate, std::size_t, std::string, bool, Share, MaybeEstimate>;

struct SheetColumn {
    std::string key;    ///< In JSON and CSV; ends in `_s` for estimates. Empty: not there.
    std::string title;  ///< In tables for people.
    enum class Shown : std::uint8_t {
        everywhere,
        not_on_terminal,
        in_data,  ///< JSON and CSV.
    } shown = Shown::everywhere;
};

/// Rows that are declared once and printed as text, page, JSON and CSV. Each has a cell for each column.
struct Sheet {
    std::vector<SheetColumn> columns;
    std::vector<std::vector<SheetCell>> rows;
};

/// `{"mean", "pairs", "low", "high"}`; null for a missing estimate.
Json estimate_json(const MaybeEstimate& estimate);
/// One object a row.
Json json_of(const Sheet& sheet);
/// An estimate `gain_s` becomes the columns gain_s, gain_low_s and gain_high_s.
std::string csv_of(const Sheet& sheet);
/// For a terminal of 80 columns: long texts are cut, at least to 8 characters.
std::string text_of(const Sheet& sheet);
/// For a page: texts are cut to 60 characters.
DataTable data_table_of(const Sheet& sheet);

}  // namespace clearway::report::detail
