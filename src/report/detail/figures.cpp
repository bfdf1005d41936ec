#include "report/detail/figures.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/detail/style.hpp"
#include "report/overview.hpp"
#include "report/verdict.hpp"

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

/// Whether a condition has a colour and a mark. Those that others are compared with have them too, so that
/// looks do not change with what is compared.
bool is_crossed(const ConditionFacts& condition) {
    return condition.is_compared() || !condition.condition.policies.empty();
}

/// What these conditions are, in their order; nothing if a setting was turned alone.
std::vector<const ConditionFacts*> crossed_conditions(const StudyFacts& study,
                                                      const ScenarioFacts& scenario) {
    std::vector<const ConditionFacts*> crossed;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!is_crossed(condition)) continue;
        if (reference_of(study, scenario, condition) != nullptr) return {};
        crossed.push_back(&condition);
    }
    return crossed;
}

const std::string& aspect_of(const ConditionFacts& condition, const std::string& name) {
    static const std::string shipped = "as shipped";
    const auto found = condition.aspects.find(name);
    return found == condition.aspects.end() ? shipped : found->second;
}

/// `outages, repaired`: what a condition has of these aspects.
std::string level_words(const ConditionFacts& condition, const std::vector<std::string>& names) {
    std::vector<std::string> words;
    for (const std::string& name : names) {
        const std::string& word = aspect_of(condition, name);
        if (!word.empty()) words.push_back(word);
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

Crossing::Aspect aspect_with(std::vector<std::string> names,
                             const std::vector<const ConditionFacts*>& conditions) {
    Crossing::Aspect aspect{std::move(names), {}};
    for (const ConditionFacts* const condition : conditions)
        if (aspect.level_of(*condition) == 0) aspect.levels.push_back(level_words(*condition, aspect.names));
    return aspect;
}

/// Those with several levels: the policy first, then those with most levels.
std::vector<Crossing::Aspect> varied_aspects(const std::vector<const ConditionFacts*>& conditions) {
    std::set<std::string> names;
    for (const ConditionFacts* const condition : conditions)
        for (const auto& aspect : condition->aspects)
            names.insert(aspect.first);
    std::vector<Crossing::Aspect> varied;
    for (const std::string& name : names) {
        Crossing::Aspect aspect = aspect_with({name}, conditions);
        if (aspect.levels.size() > 1) varied.push_back(std::move(aspect));
    }
    std::ranges::stable_sort(varied, std::greater{}, [](const Crossing::Aspect& aspect) {
        return std::pair(aspect.names.front() == "policy", aspect.levels.size());
    });
    return varied;
}

}  // namespace

std::size_t Crossing::Aspect::level_of(const ConditionFacts& condition) const {
    const auto found = std::ranges::find(levels, level_words(condition, names));
    return found == levels.end() ? 0 : static_cast<std::size_t>(found - levels.begin()) + 1;
}

std::optional<Crossing> crossing_of(const StudyFacts& study, const ScenarioFacts& scenario) {
    constexpr std::size_t fewest = 6;  // below, numbers seldom hide each other
    const std::vector<const ConditionFacts*> conditions = crossed_conditions(study, scenario);
    if (conditions.size() < fewest) return std::nullopt;
    const std::vector<Crossing::Aspect> varied = varied_aspects(conditions);
    if (varied.size() < 2) return std::nullopt;
    std::vector<std::string> others;
    for (auto aspect = varied.begin() + 1; aspect != varied.end(); ++aspect)
        others.push_back(aspect->names.front());
    const Crossing crossing{varied.front(), aspect_with(std::move(others), conditions)};
    std::set<std::pair<std::size_t, std::size_t>> levels;
    for (const ConditionFacts* const condition : conditions)
        levels.emplace(crossing.colour.level_of(*condition), crossing.mark.level_of(*condition));
    const bool told_apart = levels.size() == conditions.size() &&
                            crossing.colour.levels.size() <= Series::most_levels &&
                            crossing.mark.levels.size() <= Series::most_levels;
    return told_apart ? std::optional(crossing) : std::nullopt;
}

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

std::string standalone(const std::string& drawing, const std::string& title, const std::string& note) {
    const auto [left, top, width, height] = view_box(drawing);
    if (width <= 0.0 || !drawing.starts_with("<svg")) return standalone(drawing);
    // As large beside the drawing as they are beside one that is as wide as those of the page.
    const double size = width / Canvas::width;
    std::string words;
    double y = 4.0 * size;
    const auto write = [&](const std::string& text, std::size_t letters, double height_of_line,
                           const char* style) {
        for (const std::string& line : lines_of(text, letters)) {
            y += height_of_line * size;
            words += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {} font-size=\"{:.1f}\">{}</text>\n",
                                 6.0 * size, y, style, (height_of_line - 4.0) * size, escaped(line));
        }
    };
    write(title, 54, 17.0, "font-weight=\"bold\"");
    const double drawing_top = y + 8.0 * size;
    y = drawing_top + height;
    write(note, 92, 13.0, "fill=\"#555\"");
    std::string inner = standalone(drawing);
    inner.insert(4, fmt::format(" x=\"0\" y=\"{:.1f}\"", drawing_top));  // behind `<svg`
    y += 6.0 * size;
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:.1f}\" width=\"{0:g}\" "
        "height=\"{1:.1f}\" font-family=\"Liberation Sans, Helvetica, Arial, sans-serif\">\n<rect "
        "width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{2}{3}</svg>\n",
        width, y, words, inner);
}

Looks looks_of(const StudyFacts& study, const ScenarioFacts& scenario) {
    const ConditionFacts* const featured =
        study.headline_leads ? featured_condition(study, scenario) : nullptr;
    std::size_t beside = 0;  // what is not compared, in the colour of the text with the marks left over
    Looks looks;
    looks.crossing = crossing_of(study, scenario);
    const std::optional<Crossing>& crossing = looks.crossing;
    for (const ConditionFacts& condition : scenario.conditions) {
        Series& series = looks.emplace_back();
        series.number = looks.size() - 1;
        if (&condition == featured) series.weight = Series::Weight::lead;
        if (!crossing || series.number == 0) continue;
        series.levels = is_crossed(condition) ? Series::Levels{crossing->colour.level_of(condition),
                                                               crossing->mark.level_of(condition)}
                                              : Series::Levels{0, crossing->mark.levels.size() + ++beside};
    }
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
