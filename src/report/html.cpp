#include "report/html.hpp"

#include <fmt/format.h>

#include "report/detail/sections.hpp"
#include "report/detail/style.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"

namespace clearway::report {

void write_html(const StudyFacts& study, std::ostream& page, const Replays& replays) {
    const std::string title = escaped(study.title);
    page << "<!DOCTYPE html>\n"
            "<html lang=\"en\">\n"
            "<head>\n"
            "<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
            "'unsafe-inline'; img-src data:"
         << (replays.markup.empty() ? "" : " blob:; script-src " + replays.script_source)
         << "\">\n"
            "<link rel=\"icon\" href=\"data:,\">\n"
            "<title>"
         << title << "</title>\n<style>" << detail::style_sheet << "</style>\n</head>\n<body>\n<header>\n<h1>"
         << title << "</h1>\n<p class=\"lead\">" << escaped(headline(study)) << "</p>\n";

    std::string navigation;
    for (const detail::Section& section : detail::sections()) {
        if (section.applies(study))
            navigation += fmt::format("<a href=\"#{}\">{}</a>", section.id, section.title);
    }
    if (!replays.markup.empty()) navigation += "<a href=\"#replays\">Replays</a>";
    page << "<nav aria-label=\"Sections\">" << navigation << "</nav>\n</header>\n<main>\n";
    for (const detail::Section& section : detail::sections()) {
        if (!section.applies(study)) continue;
        page << "<section id=\"" << section.id << "\">\n<h2>" << section.title << "</h2>\n"
             << section.body(study) << "</section>\n";
    }
    if (!replays.markup.empty())
        page << "<section id=\"replays\">\n<h2>Replays</h2>\n<p>Of each scenario the trip of an emergency "
                "vehicle "
                "with the median gain, the best and the worst, beside the baseline of the same seed.</p>\n"
             << replays.markup << "</section>\n";
    page << "</main>\n<footer>Means of replications with 95 % intervals. EV: emergency vehicle.</footer>\n"
            "</body>\n</html>\n";
}

}  // namespace clearway::report
