#include "report/text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/terminal.hpp"

namespace clearway::report {
namespace {

/// Bytes of the first line of a text that is broken at `columns` characters.
std::size_t line_end(const std::string& text, std::size_t columns) {
    const std::size_t end = core::cut_to_columns(text, columns).size();
    if (end == text.size() || text[end] == ' ') return end;
    if (const std::size_t space = text.rfind(' ', end); space != std::string::npos) return space;
    const std::size_t sign = text.find_last_of("+=,_-/:", end - 1);
    return sign == std::string::npos ? end : sign + 1;
}

}  // namespace

std::string short_signal_name(const std::string& id) {
    constexpr std::size_t most = 24;
    if (core::characters_in(id) <= most) return printable(id);
    return printable(core::cut_to_columns(id, most - 3) + "...");
}

std::string signal_words(const std::string& id, const std::string& streets) {
    return streets.empty() ? short_signal_name(id) : printable(streets);
}

std::string printable(const std::string& text) {
    std::string result;
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        result += code < 0x20 || code == 0x7f ? '?' : letter;
    }
    return result;
}

std::string table_row(const std::string& label, std::size_t columns, const std::string& figures) {
    const std::size_t indent = std::min(label.find_first_not_of(' '), label.size());
    std::size_t margin = indent;
    std::string rest = label.substr(indent);
    std::string text;
    do {
        const std::size_t end = line_end(rest, columns - 1 - margin);
        std::string line = std::string(margin, ' ') + rest.substr(0, end);
        if (text.empty()) {
            line += std::string(columns - core::characters_in(line), ' ') + figures;
            line.erase(line.find_last_not_of(" \n") + 1);
        }
        text += line + '\n';
        rest.erase(0, std::min(rest.find_first_not_of(' ', end), rest.size()));
        margin = indent + 2;
    } while (!rest.empty());
    return text;
}

std::string replications_words(std::uint64_t replications) {
    return replications > most_replications_asked ? fmt::format("more than {}", most_replications_asked)
                                                  : grouped(replications);
}

std::string asked_words(std::uint64_t replications) {
    return (replications > most_replications_asked ? "" : "about ") + replications_words(replications);
}

std::string missing(Script script) {
    return script == Script::plain ? "-" : "\u2013";
}

std::string number(double value, NumberStyle style) {
    if (!std::isfinite(value)) return missing(style.script);
    std::string digits = fmt::format("{:.{}f}", std::abs(value), style.decimals);
    const bool is_zero = digits.find_first_not_of("0.") == std::string::npos;
    if (is_zero) return digits;
    if (value < 0.0) return (style.script == Script::plain ? "-" : "\u2212") + digits;
    return style.sign == Sign::negative_only ? digits : "+" + digits;
}

std::string number_or_dash(const std::optional<double>& value, NumberStyle style) {
    return value ? number(*value, style) : missing(style.script);
}

std::string p_words(const std::optional<double>& p, Script script) {
    if (p && *p < 0.001) return "<0.001";
    return number_or_dash(p, {.decimals = 3, .script = script});
}

std::string estimate(const MaybeEstimate& estimate, NumberStyle style, double factor) {
    if (!estimate) return missing(style.script);
    std::string text = number(estimate->mean * factor, style);
    const analysis::Interval* const interval = shown_interval(estimate);
    if (interval == nullptr) return text;
    return text + " " + interval_text(*interval, style, factor);
}

std::pair<std::string, std::string> interval_ends(const analysis::Interval& interval, NumberStyle style,
                                                  double factor) {
    if (style.sign == Sign::always) style.sign = Sign::negative_only;
    constexpr int most_decimals = 4;
    const auto end = [&](double value) {
        NumberStyle finer = style;
        const auto is_hidden = [&] { return std::abs(value) < 0.5 * std::pow(10.0, -finer.decimals); };
        while (!interval.contains(0.0) && is_hidden() && finer.decimals < most_decimals)
            ++finer.decimals;
        return number(value, finer);
    };
    return {end(interval.low * factor), end(interval.high * factor)};
}

std::string interval_text(const analysis::Interval& interval, NumberStyle style, double factor) {
    const auto [low, high] = interval_ends(interval, style, factor);
    return fmt::format("[{}, {}]", low, high);
}

int decimals_of(const ScenarioFacts& scenario, Measure measure) {
    if (info(measure).printed_factor != 1.0) return 0;
    double largest = 0.0;
    for (const ConditionFacts& condition : scenario.conditions) {
        largest = std::max(largest, std::abs(mean_of(condition.value(measure)).value_or(0.0)));
    }
    return largest < 10.0 ? 2 : 1;
}

std::string wide_edges_sentence(const ScenarioFacts& scenario) {
    if (!scenario.wide_edges) return {};
    if (scenario.wide_edges->empty()) return "No edge has three or more lanes for cars.";
    int most = 0;
    for (const WideEdge& edge : *scenario.wide_edges) {
        most = std::max(most, edge.car_lanes);
    }
    return fmt::format(
        "{} with three or more lanes for cars, {} at most (listed in report.html and in JSON).",
        counted(scenario.wide_edges->size(), "edge"), most);
}

std::string programs_words(const std::string& attribution) {
    if (attribution.find("OpenStreetMap") == std::string::npos) return "";
    return "signal programs made up for the map, which has none, unless yours were entered";
}

}  // namespace clearway::report
