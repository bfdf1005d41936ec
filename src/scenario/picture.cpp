#include "scenario/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/labels.hpp"
#include "core/markup.hpp"
#include "core/terminal.hpp"
#include "scenario/signal_sheet.hpp"

namespace clearway::scenario {
namespace {

constexpr double picture_width = 960.0;   // user units of the SVG
constexpr double picture_height = 540.0;  // at most; flat networks get less
constexpr double margin = 30.0;
constexpr double bar_height = 20.0;

/// A network with a smaller ratio of height to width is stretched in y, or its lanes would merge into one
/// line; at most by the factor below.
constexpr double flattest = 0.1;
constexpr double largest_stretch = 10.0;

/// From the network's metres (y up) to the picture's units (y down).
struct Frame {
    double scale = 1.0;
    double stretch = 1.0;  ///< Of y relative to x; above 1 for flat networks only.
    double left = margin;  ///< Left edge of the drawing, which is centred.
    double left_m = 0.0;
    double top_m = 0.0;
    double height = 0.0;

    double x(double metres) const { return left + (metres - left_m) * scale; }
    double y(double metres) const { return margin + (top_m - metres) * scale * stretch; }
};

core::Extent extent_of(const roads::Network& network) {
    core::Extent extent;
    for (const roads::Lane& lane : network.lanes())
        for (const roads::Point& point : lane.shape)
            extent.add(point.x_m, point.y_m);
    return extent;
}

core::Extent extent_of(const std::vector<SignalSheet>& sheets) {
    core::Extent extent;
    for (const SignalSheet& sheet : sheets)
        extent.add(sheet.place.x_m, sheet.place.y_m);
    return extent;
}

Frame frame_of(const core::Extent& extent) {
    Frame frame;
    const double width_m = std::max(1.0, extent.width());
    const double height_m = std::max(1.0, extent.height());
    frame.stretch = std::clamp(flattest * width_m / height_m, 1.0, largest_stretch);
    frame.scale = std::min((picture_width - 2 * margin) / width_m,
                           (picture_height - 2 * margin) / (height_m * frame.stretch));
    frame.left = 0.5 * (picture_width - width_m * frame.scale);
    frame.left_m = extent.left;
    frame.top_m = extent.top;
    frame.height = height_m * frame.stretch * frame.scale + 2 * margin + bar_height;
    return frame;
}

void draw_lanes(const roads::Network& network, const Frame& frame, std::string& svg) {
    auto out = std::back_inserter(svg);
    for (const roads::Lane& lane : network.lanes()) {
        const bool internal = network.edge(lane.edge).internal;
        const double width = std::max(0.7, 0.85 * lane.width_m * frame.scale * frame.stretch);
        fmt::format_to(out, "<polyline class=\"{}\" stroke-width=\"{:.2f}\" points=\"",
                       internal ? "junction" : "lane", internal ? 0.5 * width : width);
        for (const roads::Point& point : lane.shape) {
            fmt::format_to(out, "{:.1f},{:.1f} ", frame.x(point.x_m), frame.y(point.y_m));
        }
        fmt::format_to(out, "\"/>\n");
    }
}

void draw_signals(const roads::Network& network, const Frame& frame, std::string& svg) {
    std::set<core::LaneIndex> stop_lines;
    for (const roads::Signal& signal : network.signals()) {
        for (const auto& link : signal.links) {
            for (const roads::SignalLink& way : link) {
                stop_lines.insert(way.from);
            }
        }
    }
    for (const core::LaneIndex lane : stop_lines) {
        const roads::Point end = network.lane(lane).shape.back();
        fmt::format_to(std::back_inserter(svg),
                       "<circle class=\"signal\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/>\n", frame.x(end.x_m),
                       frame.y(end.y_m));
    }
}

/// The longest of 1, 2 or 5 x 10^n metres that takes at most a fifth of the width.
double scale_bar_m(const Frame& frame) {
    const double longest = picture_width / 5.0 / frame.scale;
    const double power = std::pow(10.0, std::floor(std::log10(longest)));
    for (const double factor : std::array{5.0, 2.0}) {
        if (factor * power <= longest) return factor * power;
    }
    return power;
}

void draw_scale_bar(const Frame& frame, std::string& svg) {
    const double metres = scale_bar_m(frame);
    const double y = frame.height - 14.0;
    fmt::format_to(
        std::back_inserter(svg),
        "<path class=\"bar\" d=\"M{0:.1f} {1:.1f}h{2:.1f}\"/>"
        "<text x=\"{3:.1f}\" y=\"{4:.1f}\">{5:g} m{6}</text>\n",
        margin, y, metres * frame.scale, margin + metres * frame.scale + 6.0, y + 4.0, metres,
        frame.stretch > 1.0 ? fmt::format("; drawn {:.1f} times as wide across", frame.stretch) : "");
}

/// At the right of the scale bar.
std::string credit_of(const Frame& frame, const std::string& credit) {
    if (credit.empty()) return "";
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                       picture_width - margin, frame.height - 10.0, core::escaped(credit));
}

/// The opening of a picture, with its title and style.
std::string opened(const Frame& frame, const std::string& title) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {:.0f} {:.0f}\" "
        "class=\"network\">\n"
        "<title>{}</title>\n<style>.network polyline{{fill:none;stroke:currentColor;stroke-linejoin:round}}"
        ".network .lane{{opacity:.75}}.network .junction{{opacity:.3}}.network .signal{{fill:#d55e00}}"
        ".network .bar{{stroke:currentColor;stroke-width:2}}.network text{{font:12px "
        "sans-serif;fill:currentColor}}"
        ".network .name{{paint-order:stroke;stroke:#fff;stroke-width:3px}}</style>\n",
        picture_width, frame.height, core::escaped(title));
}

std::string roads_of(const roads::Network& network, const Frame& frame) {
    std::string svg;
    draw_lanes(network, frame, svg);
    draw_signals(network, frame, svg);
    return svg;
}

/// Of a name that has no room in full; units of the picture.
constexpr std::size_t longest_cut = 25;
constexpr double width_of_letter = 7.0;
constexpr double height_of_text = 12.0;

/// The words beside a disc.
struct NameBox {
    double left = 0.0;
    double bottom = 0.0;
    double width = 0.0;

    bool meets(const NameBox& other) const {
        return left < other.left + other.width && other.left < left + width &&
               std::abs(bottom - other.bottom) < height_of_text;
    }
    bool meets(const core::Spot& disc) const {
        return disc.x + core::disc_radius > left && disc.x - core::disc_radius < left + width &&
               disc.y + core::disc_radius > bottom - height_of_text && disc.y - core::disc_radius < bottom;
    }
};

/// The signals of a picture and where their marks are drawn.
struct SignalMarks {
    std::vector<SignalSheet> sheets;
    std::vector<core::Spot> places;
    std::vector<core::Spot> spots;
};

SignalMarks marks_of(const std::vector<SignalSheet>& sheets, const Frame& frame) {
    SignalMarks marks{sheets, {}, {}};
    for (const SignalSheet& sheet : marks.sheets)
        marks.places.push_back({frame.x(sheet.place.x_m), frame.y(sheet.place.y_m)});
    marks.spots = core::spread(marks.places, std::vector(marks.places.size(), core::Mark::disc),
                               {picture_width, frame.height - bar_height});
    return marks;
}

/// Where the name of a signal lies upon no number and no name in `taken`; nothing if there is no such place.
std::optional<NameBox> room_for_name(const SignalMarks& marks, std::size_t row, std::size_t letters,
                                     const std::vector<NameBox>& taken) {
    const double width = width_of_letter * static_cast<double>(letters);
    for (const double right : {12.0, -12.0 - width}) {
        for (const double down : {4.0, -8.0, 18.0}) {
            const NameBox box{marks.spots[row].x + right, marks.spots[row].y + down, width};
            const auto meets = [&](const auto& other) { return box.meets(other); };
            const bool is_inside = box.left >= 0.0 && box.left + width <= picture_width;
            if (is_inside && std::ranges::none_of(marks.spots, meets) && std::ranges::none_of(taken, meets))
                return box;
        }
    }
    return std::nullopt;
}

/// A line leads from a disc that had to give way to its signal.
void draw_labels(const std::vector<SignalSheet>& sheets, const Frame& frame, std::string& svg) {
    auto out = std::back_inserter(svg);
    const SignalMarks marks = marks_of(sheets, frame);
    std::vector<NameBox> names;
    for (std::size_t row = 0; row < marks.sheets.size(); ++row) {
        const core::Spot& place = marks.places[row];
        const core::Spot& spot = marks.spots[row];
        const std::string number = fmt::format("#{}", row + 1);
        fmt::format_to(out, "<g fill=\"#000\"><title>{}: {}</title>", number,
                       core::escaped(marks.sheets[row].signal));
        if (spot != place)
            fmt::format_to(out,
                           "<path d=\"M{0:.1f} {1:.1f}L{2:.1f} {3:.1f}\" stroke=\"#d55e00\"/>"
                           "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"2.5\" fill=\"#d55e00\"/>",
                           place.x, place.y, spot.x, spot.y);
        fmt::format_to(out,
                       "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"{2:g}\" fill=\"#d55e00\"/>"
                       "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\" "
                       "style=\"font-size:{4:g}px;fill:#fff\">{5}</text>",
                       spot.x, spot.y, core::disc_radius, spot.y + 3.5, 0.9 * core::disc_text_size(number),
                       number);
        const std::string streets = streets_of(marks.sheets[row]);
        const std::string& full = streets.empty() ? marks.sheets[row].signal : streets;
        for (const std::string& name : {full, core::cut_to_columns(full, longest_cut) + "..."}) {
            const auto box = room_for_name(marks, row, core::characters_in(name), names);
            if (!box) continue;
            const bool is_left = box->left < spot.x;
            fmt::format_to(out, "<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>",
                           box->left + (is_left ? box->width : 0.0), box->bottom,
                           is_left ? " text-anchor=\"end\"" : "", core::escaped(name));
            names.push_back(*box);
            break;
        }
        svg += "</g>\n";
    }
}

}  // namespace

std::string network_picture(const roads::Network& network, const std::string& title,
                            const std::string& credit) {
    const Frame frame = frame_of(extent_of(network));
    std::string svg = opened(frame, title) + roads_of(network, frame);
    draw_scale_bar(frame, svg);
    return svg + credit_of(frame, credit) + "</svg>\n";
}

std::string signals_picture(const roads::Network& network, const std::string& title,
                            const std::string& credit) {
    const std::vector<SignalSheet> sheets = signal_sheets(network, {});
    const Frame frame = frame_of(core::drawn_part(extent_of(network), extent_of(sheets)));
    std::string svg = opened(frame, title);
    svg += fmt::format("<rect width=\"{:.0f}\" height=\"{:.0f}\" fill=\"#fff\"/>\n<g color=\"#444\">\n",
                       picture_width, frame.height);
    // Roads that go on beyond the frame are cut off above the scale bar.
    svg += fmt::format("<svg width=\"{:.0f}\" height=\"{:.0f}\">\n{}</svg>\n", picture_width,
                       frame.height - bar_height, roads_of(network, frame));
    draw_scale_bar(frame, svg);
    svg += credit_of(frame, credit) + "</g>\n";
    draw_labels(sheets, frame, svg);
    return svg + "</svg>\n";
}

}  // namespace clearway::scenario
