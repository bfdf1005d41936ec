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

/// As `clearway scenario signals` counts; `#7` for people, 7 in data.
struct SignalNumber {
    std::size_t value = 0;
};

/// Nothing, a count, a number of a signal, a text from a file, whether an effect is shown, a share, or an
/// estimate in seconds.
using SheetCell =
    std::variant<std::monostate, std::size_t, SignalNumber, std::string, bool, Share, MaybeEstimate>;

struct SheetColumn {
    std::string key;    ///< In JSON and CSV; ends in `_s` for estimates. Empty: not there.
    std::string title;  ///< In tables for people.
    enum class Shown : std::uint8_t {
        everywhere,
        if_room,  ///< On a terminal only if the others leave room for it.
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
/// For a terminal of 80 columns: texts for which there is no room stand in lines of their own below their
/// row.
std::string text_of(const Sheet& sheet);
/// For a page: texts are cut to 100 characters.
DataTable data_table_of(const Sheet& sheet);

}  // namespace clearway::report::detail
