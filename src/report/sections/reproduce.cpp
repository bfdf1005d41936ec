#include <fmt/format.h>

#include "report/sections/sections.hpp"

namespace clearway::report::detail {

void reproduce_section(const StudyFacts& study, Writer& writer) {
    std::string html;
    if (!study.command.empty()) html += fmt::format("<pre><code>{}</code></pre>\n", escaped(study.command));
    if (!study.study_file.empty())
        html += fmt::format(
            "<p>The study file, which the run folder keeps as <code>study.toml</code>:</p>\n"
            "<pre><code>{}</code></pre>\n",
            escaped(study.study_file));
    html += "<dl class=\"facts\">\n";
    for (const auto& [name, value] : study.provenance) {
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(value));
    }
    html += "</dl>\n<h3>Conditions</h3>\n<dl class=\"facts\">\n";
    if (!study.scenarios.empty()) {
        for (const ConditionFacts& condition : study.scenarios.front().conditions) {
            html += fmt::format("<dt>{} <code>{}</code></dt><dd>{}</dd>\n", condition_label(condition),
                                escaped(condition.name()), escaped(condition.recipe));
        }
    }
    writer.markup(html + "</dl>\n");
}

}  // namespace clearway::report::detail
