#include "report/detail/figures.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>

#include <fmt/format.h>

#include "report/detail/style.hpp"
#include "report/overview.hpp"

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

Looks looks_of(const StudyFacts& study, const ScenarioFacts& scenario) {
    const ConditionFacts* const featured = featured_condition(study, scenario);
    Looks looks;
    for (const ConditionFacts& condition : scenario.conditions)
        looks.push_back(
            {looks.size(), &condition == featured ? Series::Weight::lead : Series::Weight::usual});
    return looks;
}

std::vector<std::size_t> drawing_order(const Looks& looks) {
    std::vector<std::size_t> places(looks.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    std::stable_partition(places.begin(), places.end(),
                          [&](std::size_t place) { return looks[place].weight == Series::Weight::usual; });
    return places;
}

std::vector<Figure> figures_of(const StudyFacts& study,
                               const std::function<Figure(const ScenarioFacts&, const Looks&)>& figure) {
    std::vector<Figure> figures;
    figures.reserve(study.scenarios.size());
    for (const ScenarioFacts& scenario : study.scenarios)
        figures.push_back(figure(scenario, looks_of(study, scenario)));
    return figures;
}

}  // namespace clearway::report::detail
