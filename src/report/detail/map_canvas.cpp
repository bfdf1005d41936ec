#include "report/detail/map_canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/terminal.hpp"

namespace clearway::report::detail {
namespace {

constexpr double margin = 12.0;
constexpr double bar_space = 52.0;          // a line for the scale bar, two for the credit
constexpr std::size_t credit_letters = 62;  // that fit in a line
constexpr double most_height = 330.0;
constexpr double flattest = 0.22;  // height over width
constexpr double largest_stretch = 10.0;

struct Box {
    double left, top, right, bottom;
    bool meets(const Box& other) const {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
};

/// `fire station`.
std::string spoken(std::string kind) {
    std::ranges::replace(kind, '_', ' ');
    return kind;
}

/// The name of a station in full, or the kind of one without.
struct StationLabel {
    static constexpr double line_height = 12.0;
    static constexpr double letter_width = 5.8;
    std::vector<std::string> lines;

    explicit StationLabel(const MapStation& station) {
        lines = lines_of(station.name.empty() ? spoken(station.kind) : station.name, 22);
    }
    /// Where it may stand about a sign: right, left, below, above.
    std::vector<Box> sides_of(double x, double y) const {
        constexpr double gap = 8.0;
        std::size_t letters = 0;
        for (const std::string& line : lines)
            letters = std::max(letters, core::characters_in(line));
        const double across = letter_width * static_cast<double>(letters);
        const double high = line_height * static_cast<double>(lines.size());
        const auto box = [&](double left, double top) { return Box{left, top, left + across, top + high}; };
        return {box(x + gap, y - high / 2.0), box(x - gap - across, y - high / 2.0),
                box(x - across / 2.0, y + gap), box(x - across / 2.0, y - gap - high)};
    }
};

core::Extent extent_of(const RoadMap& map) {
    core::Extent extent;
    for (const MapEdge& edge : map.edges)
        for (const auto& [x, y] : edge.shape)
            extent.add(x, y);
    return extent;
}

}  // namespace

std::string station_words(const RoadMap& map) {
    std::string words;
    std::set<std::string> named;
    for (const MapStation& station : map.stations)
        if (named.insert(station.kind).second) words += (words.empty() ? "" : " or ") + spoken(station.kind);
    return words;
}

bool is_drawable(const RoadMap& map) {
    return std::ranges::any_of(map.edges, [](const MapEdge& edge) { return edge.shape.size() > 1; });
}

std::vector<const MapEdge*> all_edges(const RoadMap& map) {
    std::vector<const MapEdge*> edges;
    for (const MapEdge& edge : map.edges)
        edges.push_back(&edge);
    return edges;
}

MapCanvas::Frame MapCanvas::frame_of(const core::Extent& extent) {
    Frame frame;
    const double width_m = std::max(1.0, extent.width());
    const double height_m = std::max(1.0, extent.height());
    frame.stretch = std::clamp(flattest * width_m / height_m, 1.0, largest_stretch);
    frame.scale =
        std::min((width - 2 * margin) / width_m, (most_height - 2 * margin) / (height_m * frame.stretch));
    frame.left = 0.5 * (width - width_m * frame.scale);
    frame.left_m = extent.left;
    frame.top_m = extent.top;
    frame.height = height_m * frame.stretch * frame.scale + 2 * margin + bar_space;
    return frame;
}

MapCanvas::MapCanvas(const std::string& title, const RoadMap& map)
    : MapCanvas(title, frame_of(extent_of(map))) {}

MapCanvas MapCanvas::of_signals(const std::string& title, const RoadMap& map) {
    core::Extent signals;
    for (const MapSignal& signal : map.signals)
        signals.add(signal.place.first, signal.place.second);
    const core::Extent all = extent_of(map);
    const core::Extent part = core::drawn_part(all, signals);
    Frame frame = frame_of(part);
    frame.is_part = part.width() < all.width() || part.height() < all.height();
    return {title, frame};
}

MapCanvas::MapCanvas(const std::string& title, const Frame& frame)
    : Canvas(title, frame.height), frame_(frame) {}

bool MapCanvas::is_inside(double x, double y) const {
    return x >= 0.0 && x <= width && y >= 0.0 && y <= frame_.height - bar_space;
}

std::pair<double, double> MapCanvas::place(const MapPlace& place) const {
    return {frame_.left + (place.first - frame_.left_m) * frame_.scale,
            margin + (frame_.top_m - place.second) * frame_.scale * frame_.stretch};
}

void MapCanvas::edge(const MapEdge& edge, const std::string& style) {
    const MapEdge* const one = &edge;
    edges({&one, 1}, style);
}

void MapCanvas::edges(std::span<const MapEdge* const> edges, const std::string& style) {
    std::string way;
    for (const MapEdge* const edge : edges) {
        const char* command = "M";
        for (const MapPlace& point : edge->shape) {
            const auto [x, y] = place(point);
            way += fmt::format("{}{:.1f} {:.1f}", command, x, y);
            command = "L";
        }
    }
    if (way.empty()) return;
    const std::string path = fmt::format("<path class=\"{}\" d=\"{}\"/>", style, way);
    add(frame_.is_part ? fmt::format("<svg width=\"{:g}\" height=\"{:.1f}\">{}</svg>\n", width,
                                     frame_.height - bar_space, path)
                       : path + "\n");
}

void MapCanvas::scale_bar() {
    const double longest = width / 5.0 / frame_.scale;
    const double power = std::pow(10.0, std::floor(std::log10(longest)));
    double metres = power;
    for (const double factor : std::array{2.0, 5.0}) {
        if (factor * power <= longest) metres = factor * power;
    }
    const double y = frame_.height - 38.0;
    path({{margin, y}, {margin + metres * frame_.scale, y}}, "line s0");
    text(margin + metres * frame_.scale + 6.0, y + 4.0,
         fmt::format(
             "{:g} m{}", metres,
             frame_.stretch > 1.0 ? fmt::format("; drawn {:.1f} times as wide across", frame_.stretch) : ""),
         Anchor::start, "tick");
}

void MapCanvas::stations(const RoadMap& map) {
    std::vector<const MapStation*> labelled;
    std::vector<Box> taken;
    const auto place_of = [&](const MapStation& station) -> std::optional<std::pair<double, double>> {
        const auto edge = map.find_edge(station.edge);
        if (!edge || map.edges[*edge].shape.empty()) return std::nullopt;
        return place(map.edges[*edge].shape.front());
    };
    for (const MapStation& station : map.stations) {
        const auto at = place_of(station);
        if (!at) continue;
        const auto [x, y] = *at;
        if (!is_inside(x, y)) continue;
        add(fmt::format("<path class=\"station\" d=\"M{:.1f} {:.1f}l6 6l-6 6l-6 -6z\"/>\n", x, y - 6.0));
        taken.push_back({x - 6.0, y - 6.0, x + 6.0, y + 6.0});
        labelled.push_back(&station);
    }
    std::ranges::stable_sort(labelled, {}, [](const MapStation* one) { return one->name.empty(); });
    for (const MapStation* const station : labelled) {
        const auto [x, y] = *place_of(*station);
        const StationLabel label(*station);
        std::vector<Box> sides = label.sides_of(x, y);
        if (x >= 0.6 * width) std::swap(sides[0], sides[1]);
        const auto is_free = [&](const Box& side) {
            return side.left >= 0.0 && side.right <= width && side.top >= 0.0 &&
                   std::ranges::none_of(taken, [&](const Box& one) { return one.meets(side); });
        };
        const auto side = std::ranges::find_if(sides, is_free);
        // A name is worth more than a clear map; a kind is in the legend's word for the sign.
        if (side == sides.end() && station->name.empty()) continue;
        const Box& box = side == sides.end() ? sides.front() : *side;
        taken.push_back(box);
        for (std::size_t line = 0; line < label.lines.size(); ++line)
            text(box.left, box.top + StationLabel::line_height * (static_cast<double>(line) + 0.83),
                 label.lines[line], Anchor::start, "halo");
    }
}

void MapCanvas::incidents(const RoadMap& map) {
    for (const MapIncident& one : map.incidents) {
        const auto edge = map.find_edge(one.edge);
        if (!edge || map.edges[*edge].shape.empty()) continue;
        const std::vector<MapPlace>& shape = map.edges[*edge].shape;
        this->edge(map.edges[*edge], "blocked");
        const MapPlace& a = shape[(shape.size() - 1) / 2];
        const MapPlace& b = shape[shape.size() / 2];
        const auto [x, y] = place({(a.first + b.first) / 2.0, (a.second + b.second) / 2.0});
        circle(x, y, 7.0, "block");
        add(fmt::format("<path class=\"blockBar\" d=\"M{:.1f} {:.1f}h8v3h-8z\"/>\n", x - 4.0, y - 1.5));
    }
}

void MapCanvas::credit(const std::string& words) {
    const auto line = [&](double above, const std::string& part) {
        text(width - margin, frame_.height - 6.0 - above, part, Anchor::end, "tick");
    };
    const std::size_t blank = words.rfind(' ', credit_letters);
    if (words.size() <= credit_letters || blank == std::string::npos) {
        if (!words.empty()) line(0.0, words);
        return;
    }
    line(12.0, words.substr(0, blank));
    line(0.0, words.substr(blank + 1));
}

}  // namespace clearway::report::detail
