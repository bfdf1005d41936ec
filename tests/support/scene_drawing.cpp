#include "support/scene_drawing.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace clearway::support {
namespace {

constexpr double lane_width_m = 3.2;
constexpr std::string_view signal_letters = "GgyrRuosO";

[[noreturn]] void refuse(const std::string& reason) {
    throw std::invalid_argument("scene: " + reason);
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return "";
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    std::istringstream stream{std::string(text)};
    for (std::string line; std::getline(stream, line);) {
        if (!trimmed(line).empty()) lines.push_back(trimmed(line));
    }
    return lines;
}

void read_header(const std::string& header, Drawing& drawing) {
    bool speed_given = false;
    std::istringstream parts(header);
    for (std::string part; std::getline(parts, part, ',');) {
        double value = 0.0;
        int end = 0;
        const std::string clean = trimmed(part);
        const auto matches = [&](const char* pattern) {
            end = 0;
            return std::sscanf(clean.c_str(), pattern, &value, &end) == 1 &&
                   end == static_cast<int>(clean.size());
        };
        if (matches("%lf m per cell%n")) {
            drawing.cell_m = value;
        } else if (matches("limit %lf m/s%n")) {
            drawing.limit_mps = value;
        } else if (matches("speed %lf m/s%n")) {
            drawing.speed_mps = value;
            speed_given = true;
        } else {
            refuse("what is \"" + clean + "\" in the first line?");
        }
    }
    if (drawing.cell_m <= 0.0) refuse("the first line lacks \"10 m per cell\"");
    if (!speed_given) drawing.speed_mps = drawing.limit_mps;
}

/// A stretch of columns between two marks.
struct Stretch {
    std::size_t first = 0;
    std::size_t last = 0;  ///< One past its end.
    bool signal_follows = false;
};

std::vector<Stretch> stretches_of(const std::string& line) {
    std::vector<Stretch> stretches(1);
    for (std::size_t column = 0; column < line.size(); ++column) {
        const bool signal = line[column] == '|';
        if (!signal && line[column] != '+') continue;
        stretches.back().last = column;
        stretches.back().signal_follows = signal;
        column += signal ? 1 : 0;
        stretches.push_back({.first = column + 1});
    }
    stretches.back().last = line.size();
    return stretches;
}

void check_marks(const std::vector<std::string>& lines, const std::vector<Stretch>& stretches) {
    for (const std::string& line : lines) {
        if (line.size() != lines.front().size()) refuse("lanes differ in length: " + line);
        const auto marks = std::ranges::count_if(line, [](char cell) { return cell == '|' || cell == '+'; });
        if (marks != std::ssize(stretches) - 1) refuse("marks differ between lanes: " + line);
        for (const Stretch& stretch : stretches) {
            if (stretch.first >= stretch.last) refuse("an edge without cells: " + line);
            if (stretch.last == line.size()) continue;
            const char mark = stretch.signal_follows ? '|' : '+';
            if (line[stretch.last] != mark) refuse("marks differ between lanes: " + line);
            if (stretch.signal_follows &&
                (stretch.last + 1 >= line.size() ||
                 signal_letters.find(line[stretch.last + 1]) == std::string_view::npos)) {
                refuse("no signal letter after |: " + line);
            }
        }
    }
}

void read_cells(const std::string& line, std::size_t row, const std::vector<Stretch>& stretches,
                std::map<char, int>& counts, Drawing& drawing) {
    for (std::size_t number = 0; number < stretches.size(); ++number) {
        const Stretch& stretch = stretches[number];
        Drawing::Edge& edge = drawing.edges[number];
        const std::string cells = line.substr(stretch.first, stretch.last - stretch.first);
        edge.has_row[row] = cells.find_first_not_of('#') != std::string::npos;
        if (edge.has_row[row] && cells.find('#') != std::string::npos)
            refuse("a lane ends inside an edge: " + line);
        if (stretch.signal_follows) edge.letters[row] = line[stretch.last + 1];
        for (std::size_t column = 0; column < cells.size(); ++column) {
            const char cell = cells[column];
            if (cell == '.' || cell == '#') continue;
            if (cell != 'h' && cell != 'a' && cell != 'e') refuse(fmt::format("what is '{}'?", cell));
            drawing.vehicles.push_back({fmt::format("{}{}", cell, ++counts[cell]), row, number,
                                        (static_cast<double>(column) + 0.5) * drawing.cell_m});
        }
    }
}

std::string lane_text(const std::string& edge, std::size_t number, double limit_mps, double length_m,
                      const std::string& shape) {
    return fmt::format("<lane id=\"{}_{}\" index=\"{}\" speed=\"{}\" length=\"{}\" shape=\"{}\"/>\n", edge,
                       number, number, limit_mps, length_m, shape);
}

std::string edge_text(const Drawing& drawing, std::size_t number) {
    const Drawing::Edge& edge = drawing.edges[number];
    const std::string id = fmt::format("road_{}", number);
    std::string text =
        fmt::format("<edge id=\"{}\" from=\"node_{}\" to=\"node_{}\">\n", id, number, number + 1);
    for (std::size_t row = 0; row < drawing.rows; ++row) {
        if (!edge.has_row[row]) continue;
        const double y_m = lane_width_m * static_cast<double>(row);
        const std::string shape =
            fmt::format("{},{} {},{}", edge.start_m, y_m, edge.start_m + edge.length_m, y_m);
        text += lane_text(id, edge.lane_number(row), drawing.limit_mps, edge.length_m, shape);
    }
    return text + "</edge>\n";
}

/// The crossing street of the signal at the end of edge `number`.
std::string cross_text(const Drawing& drawing, std::size_t number, std::size_t signal) {
    const double x_m = drawing.edges[number].start_m + drawing.edges[number].length_m;
    const double top_m = lane_width_m * static_cast<double>(drawing.rows);
    std::string text;
    text += fmt::format("<edge id=\"cross_{}_in\" from=\"below_{}\" to=\"node_{}\">\n", signal, signal,
                        number + 1);
    text += lane_text(fmt::format("cross_{}_in", signal), 0, drawing.limit_mps, 100.0,
                      fmt::format("{},-100 {},0", x_m, x_m));
    text += fmt::format("</edge>\n<edge id=\"cross_{}_out\" from=\"node_{}\" to=\"above_{}\">\n", signal,
                        number + 1, signal);
    text += lane_text(fmt::format("cross_{}_out", signal), 0, drawing.limit_mps, 100.0,
                      fmt::format("{},{} {},{}", x_m, top_m, x_m, top_m + 100.0));
    return text + "</edge>\n";
}

std::size_t lane_count(const Drawing::Edge& edge) {
    return static_cast<std::size_t>(std::ranges::count(edge.has_row, true));
}

/// Rows that exist before and behind the end of edge `number`.
std::vector<std::size_t> rows_across(const Drawing& drawing, std::size_t number) {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < drawing.rows; ++row) {
        if (drawing.edges[number].has_row[row] && drawing.edges[number + 1].has_row[row]) rows.push_back(row);
    }
    return rows;
}

std::string program_text(const Drawing& drawing, std::size_t number, std::size_t signal) {
    const std::size_t lanes = lane_count(drawing.edges[number]);
    std::string text = fmt::format("<tlLogic id=\"signal_{}\" type=\"static\" programID=\"0\">\n", signal);
    for (const auto& [duration_s, along, across] :
         {std::tuple{30, 'G', 'r'}, {3, 'y', 'r'}, {30, 'r', 'G'}, {3, 'r', 'y'}}) {
        text += fmt::format("<phase duration=\"{}\" state=\"{}{}\"/>\n", duration_s,
                            std::string(lanes, along), across);
    }
    return text + "</tlLogic>\n";
}

std::string junction_text(const Drawing& drawing, std::size_t number, std::size_t signal) {
    std::string lanes;
    std::string requests;
    const std::size_t ways = rows_across(drawing, number).size();
    for (std::size_t row = 0, way = 0; row < drawing.rows; ++row) {
        if (!drawing.edges[number].has_row[row]) continue;
        lanes += fmt::format("road_{}_{} ", number, drawing.edges[number].lane_number(row));
        if (!drawing.edges[number + 1].has_row[row]) continue;
        requests += fmt::format("<request index=\"{}\" response=\"0\" foes=\"1{}\"/>\n", way++,
                                std::string(ways, '0'));
    }
    requests +=
        fmt::format("<request index=\"{}\" response=\"0\" foes=\"0{}\"/>\n", ways, std::string(ways, '1'));
    return fmt::format(
        "<junction id=\"node_{}\" type=\"traffic_light\" incLanes=\"{}cross_{}_in_0\" intLanes=\"\">\n"
        "{}</junction>\n",
        number + 1, lanes, signal, requests);
}

std::string connections_text(const Drawing& drawing, std::size_t number, std::size_t signal) {
    const Drawing::Edge& edge = drawing.edges[number];
    const auto control = [&](std::size_t link) {
        if (edge.letters.empty()) return std::string();
        return fmt::format(" tl=\"signal_{}\" linkIndex=\"{}\"", signal, link);
    };
    std::string text;
    for (const std::size_t row : rows_across(drawing, number)) {
        text += fmt::format(
            "<connection from=\"road_{}\" to=\"road_{}\" fromLane=\"{}\" toLane=\"{}\" dir=\"s\"{}/>\n",
            number, number + 1, edge.lane_number(row), drawing.edges[number + 1].lane_number(row),
            control(edge.lane_number(row)));
    }
    if (!edge.letters.empty()) {
        text += fmt::format(
            "<connection from=\"cross_{}_in\" to=\"cross_{}_out\" fromLane=\"0\" toLane=\"0\" "
            "dir=\"s\"{}/>\n",
            signal, signal, control(lane_count(edge)));
    }
    return text;
}

}  // namespace

std::size_t Drawing::Edge::lane_number(std::size_t row) const {
    return static_cast<std::size_t>(
        std::count(has_row.begin(), has_row.begin() + static_cast<std::ptrdiff_t>(row), true));
}

Drawing parse_drawing(std::string_view text) {
    std::vector<std::string> lines = lines_of(text);
    if (lines.size() < 2) refuse("needs a line with the scale and a lane");
    Drawing drawing;
    read_header(lines.front(), drawing);
    lines.erase(lines.begin());
    const std::vector<Stretch> stretches = stretches_of(lines.front());
    check_marks(lines, stretches);
    drawing.rows = lines.size();
    double start_m = 0.0;
    for (const Stretch& stretch : stretches) {
        const double length_m = drawing.cell_m * static_cast<double>(stretch.last - stretch.first);
        drawing.edges.push_back({length_m, start_m, std::vector<bool>(drawing.rows),
                                 stretch.signal_follows ? std::string(drawing.rows, ' ') : std::string()});
        start_m += length_m;
    }
    std::map<char, int> counts;
    for (std::size_t line = 0; line < lines.size(); ++line) {
        read_cells(lines[line], lines.size() - 1 - line, stretches, counts, drawing);
    }
    for (const Drawing::Edge& edge : drawing.edges) {
        if (lane_count(edge) == 0) refuse("an edge without lanes");
    }
    return drawing;
}

std::string network_text(const Drawing& drawing) {
    std::string edges;
    std::string programs;
    std::string junctions;
    std::string connections;
    std::size_t signal = 0;
    for (std::size_t number = 0; number < drawing.edges.size(); ++number) {
        edges += edge_text(drawing, number);
        if (number + 1 == drawing.edges.size()) break;
        connections += connections_text(drawing, number, signal);
        if (drawing.edges[number].letters.empty()) continue;
        edges += cross_text(drawing, number, signal);
        programs += program_text(drawing, number, signal);
        junctions += junction_text(drawing, number, signal);
        ++signal;
    }
    return "<net version=\"1.9\">\n<location netOffset=\"0,0\" convBoundary=\"0,0,1,1\" "
           "projParameter=\"!\"/>\n" +
           edges + programs + junctions + connections + "</net>\n";
}

char cross_letter(const Drawing::Edge& edge) {
    for (std::size_t row = 0; row < edge.letters.size(); ++row) {
        if (edge.has_row[row] && edge.letters[row] != 'r') return 'r';
    }
    return 'G';
}

}  // namespace clearway::support
