#pragma once

#include <optional>
#include <string>
#include <utility>

#include "core/counted.hpp"
#include "core/markup.hpp"
#include "report/facts.hpp"

namespace clearway::report {

/// At most 24 characters of a signal's id for a terminal: those of joined junctions name all their nodes.
std::string short_signal_name(const std::string& id);
/// The streets that meet at a signal; where they have no names, its short name.
std::string signal_words(const std::string& id, const std::string& streets);

using core::escaped;

/// The characters that numbers are written with.
enum class Script : std::uint8_t {
    plain,    ///< ASCII, for terminals.
    typeset,  ///< Minus sign U+2212, for pages.
};

enum class Sign : std::uint8_t {
    negative_only,
    always,  ///< But of an interval's ends only the negative ones.
    ends_too,
};

/// How the numbers of one column are written.
struct NumberStyle {
    int decimals = 1;
    Script script = Script::plain;
    Sign sign = Sign::negative_only;
};

/// A number with fixed decimals. Never prints a signed zero; prints a dash if the value is not finite.
std::string number(double value, NumberStyle style);

/// `12.3 [10.1, 14.5]`; without an interval `12.3`; without a mean a dash (`-` or U+2013).
/// An interval is printed only when it has enough values. `factor` scales to the printed unit.
std::string estimate(const MaybeEstimate& estimate, NumberStyle style, double factor = 1.0);

/// The ends of an interval. One that excludes 0 has none that reads 0.0: -2.0 and -0.03.
std::pair<std::string, std::string> interval_ends(const analysis::Interval& interval, NumberStyle style,
                                                  double factor = 1.0);
/// `[10.1, 14.5]`
std::string interval_text(const analysis::Interval& interval, NumberStyle style, double factor = 1.0);

/// A number, or the text for a missing one.
std::string number_or_dash(const std::optional<double>& value, NumberStyle style);
/// A p-value with three digits after the point; `<0.001` below them.
std::string p_words(const std::optional<double>& p, Script script);

/// Text for a terminal. Control characters become `?`, because names come from files.
std::string printable(const std::string& text);

/// A row of a table for a terminal: `label` in a column of `columns` characters, then `figures`. What is too
/// long for the column goes on below, broken at spaces or behind signs and set in by two more.
std::string table_row(const std::string& label, std::size_t columns, const std::string& figures);

/// The text for a missing number.
std::string missing(Script script);

/// `32`, or `more than 200` where the number asks for too much (most_replications_asked).
std::string replications_words(std::uint64_t replications);
/// `about 24`, or `more than 200`.
std::string asked_words(std::uint64_t replications);

/// Decimals that suit a measure in one scenario: 0 for %, 2 if all of its means are below 10, else 1.
int decimals_of(const ScenarioFacts& scenario, Measure measure);

using core::counted;
using core::grouped;

/// A sentence on the edges with three or more lanes for cars, without names; empty if the folder does not
/// list them.
std::string wide_edges_sentence(const ScenarioFacts& scenario);

/// Where the programs of signals come from if a map with this credit has none; empty for other sources.
std::string programs_words(const std::string& attribution);

}  // namespace clearway::report
