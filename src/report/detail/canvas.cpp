#include "report/detail/canvas.hpp"

#include <array>
#include <sstream>

#include <fmt/format.h>

#include "core/terminal.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr double letter_width = 6.3;  // of text of 12 units, mean; from Liberation Sans
constexpr double bold = 1.15;         // wider than that
constexpr double legend_row = 18.0;
constexpr double legend_left = 8.0;
constexpr double legend_gap = 6.0;  // behind the mark
constexpr std::size_t longest_entry = 56;

// Without common divisors in pairs, so that all of their combinations occur before the first one returns.
constexpr std::size_t colours = 6;
constexpr std::size_t dashes = 5;
constexpr std::size_t marks = 4;

/// Each counted from 1; 0: none.
struct Look {
    std::size_t colour = 0;
    std::size_t dash = 0;
    std::size_t mark = 0;
};

Look look_of(const Series& series) {
    const auto cycled = [](std::size_t number, std::size_t kinds) {
        return number == 0 ? 0 : (number - 1) % kinds + 1;
    };
    if (series.levels) {
        const std::size_t colour = cycled(series.levels->colour, Series::most_levels);
        return {colour, colour == 0 ? 0 : colour + 1, cycled(series.levels->mark, Series::most_levels)};
    }
    return {cycled(series.number, colours), cycled(series.number, dashes), cycled(series.number, marks)};
}

double behind_mark(const LegendEntry& entry) {
    return entry.mark.empty() ? 0.0 : entry.width + legend_gap;
}

std::vector<double> widths_of(const std::vector<LegendEntry>& entries) {
    std::vector<double> widths;
    for (const LegendEntry& entry : entries) {
        const auto letters = static_cast<double>(core::characters_in(shortened(entry.words, longest_entry)));
        const double factor = entry.weight == Series::Weight::lead ? bold : 1.0;
        widths.push_back(behind_mark(entry) + factor * letter_width * letters + 12.0);
    }
    return widths;
}

/// Whether the entry `at` of a legend begins a line, where `used` of the present one is taken.
bool breaks_before(std::size_t at, double used, double indent, double entry_width, double room) {
    return at > 0 && used > indent && used + entry_width > room;
}

std::size_t rows_of(const std::vector<double>& widths, double indent, double room) {
    std::size_t rows = 1;
    double used = 0.0;
    for (std::size_t at = 0; at < widths.size(); ++at) {
        if (breaks_before(at, used, indent, widths[at], room)) {
            used = indent;
            ++rows;
        }
        used += widths[at];
    }
    return rows;
}

/// The width at which a legend needs no more lines than in all of the room: its lines are about equally
/// long, and none holds one last entry alone without need.
double narrowest_room(const std::vector<double>& widths, double indent, double room) {
    constexpr double step = 4.0;
    const std::size_t rows = rows_of(widths, indent, room);
    while (room > step && rows_of(widths, indent, room - step) == rows)
        room -= step;
    return room;
}

}  // namespace

std::string colour_of(const Series& series) {
    return fmt::format("s{}", look_of(series).colour);
}

std::string line_style(const Series& series) {
    const Look look = look_of(series);
    return fmt::format("line s{}{}{}", look.colour, look.dash == 0 ? "" : fmt::format(" d{}", look.dash - 1),
                       series.weight == Series::Weight::lead ? " lead" : "");
}

std::string mark_of(const Series& series, double x, double y, double radius, const std::string& more) {
    const std::size_t mark = look_of(series).mark;
    if (mark == 0) return {};
    // Circle, square, triangle, diamond; for levels also a triangle on its tip and a cross.
    constexpr std::array<const char*, Series::most_levels> shapes = {
        "m{0:.1f} 0a{1:.1f} {1:.1f} 0 1 0 -{2:.1f} 0a{1:.1f} {1:.1f} 0 1 0 {2:.1f} 0z",
        "m-{1:.1f} -{1:.1f}h{2:.1f}v{2:.1f}h-{2:.1f}z",
        "m0 -{1:.1f}l{1:.1f} {2:.1f}h-{2:.1f}z",
        "m0 -{1:.1f}l{1:.1f} {1:.1f}l-{1:.1f} {1:.1f}l-{1:.1f} -{1:.1f}z",
        "m0 {1:.1f}l{1:.1f} -{2:.1f}h-{2:.1f}z",
        "m-{3:.1f} "
        "-{1:.1f}h{4:.1f}v{5:.1f}h{5:.1f}v{4:.1f}h-{5:.1f}v{5:.1f}h-{4:.1f}v-{5:.1f}h-{5:.1f}v-{4:.1f}h{5:."
        "1f}"
        "z"};
    const std::size_t shape = mark - 1;
    const double size = shape == 1 ? 0.87 * radius : shape == 3 ? 1.2 * radius : radius;
    return fmt::format(
        "<path class=\"dot {}{}\" d=\"M{:.1f} {:.1f}{}\"/>", colour_of(series), more, x, y,
        fmt::format(fmt::runtime(shapes[shape]), size, size, 2.0 * size, 0.3 * size, 0.6 * size, 0.7 * size));
}

std::string shortened(const std::string& text, std::size_t longest) {
    if (text.size() <= longest) return text;
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
        --end;
    return text.substr(0, end) + "\u2026";
}

std::vector<std::string> lines_of(const std::string& text, std::size_t letters) {
    std::vector<std::string> lines;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const bool fits =
            !lines.empty() && core::characters_in(lines.back()) + 1 + core::characters_in(word) <= letters;
        if (fits)
            lines.back() += " " + word;
        else
            lines.push_back(word);
    }
    return lines;
}

LegendEntry line_entry(const Series& series, std::string words) {
    constexpr double line_width = 44.0;
    return {fmt::format("<path class=\"{}\" d=\"M1 5H{:g}\"/>{}", line_style(series), line_width - 1.0,
                        mark_of(series, 6.0, 5.0, 3.6)),
            std::move(words), series.weight, line_width};
}

LegendEntry mark_entry(const Series& series, std::string words, const std::string& more) {
    return {mark_of(series, 20.0, 5.0, 5.0, more), std::move(words), series.weight};
}

LegendEntry stripe_entry(const char* style, std::string words) {
    return {fmt::format("<path class=\"{}\" d=\"M1 5H27\"/>", style), std::move(words)};
}

LegendEntry dot_entry(const std::string& style, std::string words) {
    return {fmt::format("<circle class=\"{}\" cx=\"20\" cy=\"5\" r=\"4.5\"/>", style), std::move(words)};
}

LegendEntry number_entry(const Series& series, std::string words) {
    return {fmt::format(
                "<circle class=\"dot {}\" cx=\"20\" cy=\"5\" r=\"8\"/><text class=\"onDot\" x=\"20\" y=\"9\" "
                "text-anchor=\"middle\">{}</text>",
                colour_of(series), series.number),
            std::move(words), series.weight};
}

Canvas::Canvas(std::string title, double height) : title_(std::move(title)), height_(height) {}

void Canvas::rectangle(double x, double y, double box_width, double box_height, const std::string& style) {
    fmt::format_to(std::back_inserter(svg_),
                   "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
                   style, x, y, box_width, box_height);
}

void Canvas::path(const std::vector<std::pair<double, double>>& points, const std::string& style) {
    auto out = std::back_inserter(svg_);
    fmt::format_to(out, "<polyline class=\"{}\" points=\"", style);
    for (const auto& [x, y] : points)
        fmt::format_to(out, "{:.1f},{:.1f} ", x, y);
    fmt::format_to(out, "\"/>\n");
}

void Canvas::circle(double x, double y, double radius, const std::string& style) {
    fmt::format_to(std::back_inserter(svg_),
                   "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>\n", style, x, y, radius);
}

void Canvas::legend(const std::vector<LegendEntry>& entries) {
    if (entries.empty()) return;
    const std::vector<double> widths = widths_of(entries);
    // Lines after a heading begin behind it.
    const double indent = entries.front().mark.empty() && entries.size() > 1 ? widths.front() : 0.0;
    const double room = narrowest_room(widths, indent, width - legend_left);
    double x = legend_left;
    height_ += legend_row;
    for (std::size_t at = 0; at < entries.size(); ++at) {
        const LegendEntry& entry = entries[at];
        if (breaks_before(at, x - legend_left, indent, widths[at], room)) {
            x = legend_left + indent;
            height_ += legend_row;
        }
        fmt::format_to(std::back_inserter(svg_), "<g transform=\"translate({:.1f} {:.1f})\">{}</g>", x,
                       height_ - 14.0, entry.mark);
        const bool leads = entry.weight == Series::Weight::lead;
        text(x + behind_mark(entry), height_ - 5.0, shortened(entry.words, longest_entry), Anchor::start,
             leads ? "legend lead" : "legend");
        x += widths[at];
    }
}

void Canvas::text(double x, double y, const std::string& words, Anchor anchor, const char* style) {
    const char* const where = anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
    fmt::format_to(std::back_inserter(svg_),
                   "<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", style, x, y,
                   where, escaped(words));
}

std::string Canvas::finish() {
    return fmt::format(
        "<svg class=\"plot\" role=\"img\" viewBox=\"0 0 {:.0f} {:.0f}\" aria-label=\"{}\">\n{}</svg>\n",
        width, height_, escaped(title_), std::exchange(svg_, {}));
}

}  // namespace clearway::report::detail
