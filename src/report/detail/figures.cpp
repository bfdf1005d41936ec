#include "report/detail/figures.hpp"

#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "report/detail/style.hpp"

namespace clearway::report::detail {
namespace {

/// The four numbers of a view box; zeros without one.
std::array<double, 4> view_box(const std::string& drawing) {
    constexpr std::string_view name = "viewBox=\"";
    std::array<double, 4> box = {};
    const std::size_t at = drawing.find(name);
    if (at == std::string::npos) return box;
    const char* next = drawing.c_str() + at + name.size();
    for (double& number : box) {
        char* end = nullptr;
        number = std::strtod(next, &end);
        next = end;
    }
    return box;
}

}  // namespace

std::string standalone(const std::string& drawing) {
    const std::size_t inside = drawing.find('>');
    if (inside == std::string::npos) return drawing;
    const auto [left, top, width, height] = view_box(drawing);
    std::string head = drawing.substr(0, inside);
    if (head.find("xmlns=") == std::string::npos) head += " xmlns=\"http://www.w3.org/2000/svg\"";
    const bool styled = drawing.find("<style>") != std::string::npos;
    return fmt::format(
        "{} width=\"{:g}\" height=\"{:g}\"{}>{}<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" "
        "fill=\"#fff\"/>{}",
        head, width, height, styled ? "" : " font-family=\"Liberation Sans, Helvetica, Arial, sans-serif\"",
        styled ? "" : "<style>" + drawing_style() + "</style>", left, top, width, height,
        drawing.substr(inside + 1));
}

std::vector<Figure> figures_of(const StudyFacts& study,
                               const std::function<Figure(const ScenarioFacts&)>& figure) {
    std::vector<Figure> figures;
    figures.reserve(study.scenarios.size());
    for (const ScenarioFacts& scenario : study.scenarios)
        figures.push_back(figure(scenario));
    return figures;
}

}  // namespace clearway::report::detail
