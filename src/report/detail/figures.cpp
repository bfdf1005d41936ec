#include "report/detail/figures.hpp"

namespace clearway::report::detail {

std::vector<Figure> figures_of(const StudyFacts& study,
                               const std::function<Figure(const ScenarioFacts&)>& figure) {
    std::vector<Figure> figures;
    figures.reserve(study.scenarios.size());
    for (const ScenarioFacts& scenario : study.scenarios)
        figures.push_back(figure(scenario));
    return figures;
}

}  // namespace clearway::report::detail
